
/* The weights of errors in the entries of a state, by the larger of two. */
GUEN_FUNCTION void NAME_tolerances(const guen_adaptive *method, const double *x, const double *y, double *w)
{
    int i;
    for (i = 0; i < NAME_STATES; ++i) {
        double a = fabs(x[i]), b = fabs(y[i]);
        w[i] = 1.0 / (method->atol + method->rtol * (a > b ? a : b));
    }
}

/* The sum of the squares of weighted entries, in four parts. */
GUEN_FUNCTION double NAME_squares(const double *x, const double *w)
{
    double parts[4] = { 0.0, 0.0, 0.0, 0.0 };
    int i;
    for (i = 0; i < NAME_STATES; ++i) {
        double entry = x[i] * w[i];
        parts[i % 4] += entry * entry;
    }
    return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

/* The root of that sum; where it is beyond the range of doubles the largest entry. */
GUEN_FUNCTION double NAME_size(const double *x, const double *w)
{
    double sum = NAME_squares(x, w), most = 0.0;
    int i;
    if (guen_is_finite(sum))
        return sqrt(sum);
    for (i = 0; i < NAME_STATES; ++i)
        most = fmax(most, fabs(x[i]) * w[i]);
    return most;
}

GUEN_FUNCTION int NAME_is_finite(const double *x)
{
    int i, finite = 1;
    for (i = 0; i < NAME_STATES; ++i)
        finite &= guen_is_finite(x[i]);
    return finite;
}

/* A first step that moves x by about a hundredth of its size, at most the longest one. */
GUEN_FUNCTION double NAME_first_guess(const double *x, const double *slope, const double *w, double longest)
{
    double slopes = NAME_squares(slope, w), states = NAME_squares(x, w);
    if (slopes <= 1e-10 || states <= 1e-10)
        return fmin(1e-6, longest);
    if (guen_is_finite(slopes) && guen_is_finite(states))
        return fmin(0.01 * sqrt(states / slopes), longest);
    return fmin(0.01 * (NAME_size(x, w) / NAME_size(slope, w)), longest);
}

/* A first step from x at t over a span, where the slope is `slope`: one of explicit Euler's method tells how fast that changes. */
GUEN_FUNCTION double NAME_first_step(
    const double *c, const double *k, const double *u, double t, const double *x, const double *slope, double span,
    guen_adaptive *method)
{
    double w[NAME_STATES], at[NAME_STATES], ahead[NAME_STATES], longest = fabs(span), slope_size, guess, h, size, step;
    int i;
    NAME_tolerances(method, x, x, w);
    slope_size = NAME_size(slope, w);
    guess = NAME_first_guess(x, slope, w, longest);
    h = copysign(guess, span);
    for (i = 0; i < NAME_STATES; ++i)
        at[i] = h * slope[i] + x[i];
    NAME_rhs(c, k, t + h, at, u, ahead);
    method->evaluations += 1;
    for (i = 0; i < NAME_STATES; ++i)
        ahead[i] = ahead[i] - slope[i];
    if (!NAME_is_finite(ahead))
        return guess;
    size = fmax(NAME_size(ahead, w) / guess, slope_size);
    step = size <= 1e-15 ? fmax(1e-6, 1e-3 * guess) : guen_rough_root(0.01 / size, 8);
    if (!(step > 0.0))
        step = guess;
    return fmin(fmin(step, 100.0 * guess), longest);
}

/* The terms r of the motion over an accepted step of DOP853 from x at t to `end`, with the slopes f[0] to f[12] of its stages and its end:
   x(t + s h) = r0 + s (r1 + (1 - s) (r2 + s (r3 + (1 - s) (r4 + s (r5 + (1 - s) (r6 + s r7)))))). */
GUEN_FUNCTION void NAME_terms(
    const double *c, const double *k, const double *u, double t, const double *x, double h, const double *end,
    double f[][NAME_STATES], double r[][NAME_STATES])
{
    static const double nodes[3] = { DENSE_NODES };
    static const double weights[24] = { DENSE_WEIGHTS };
    static const double terms[48] = { DENSE_TERMS };
    static const int from[24] = { 0, 6, 7, 8, 9, 10, 11, 12, 0, 5, 6, 7, 10, 11, 12, 13, 0, 5, 6, 7, 8, 12, 13, 14 };
    double at[NAME_STATES];
    int i, j, m;
    for (m = 0; m < 3; ++m) {
        NAME_row(x, h, 8, 0, weights + 8 * m, from + 8 * m, f, at);
        NAME_rhs(c, k, t + nodes[m] * h, at, u, f[13 + m]);
    }
    for (i = 0; i < NAME_STATES; ++i) {
        double change = end[i] - x[i], bend = h * f[0][i] - change;
        r[0][i] = x[i];
        r[1][i] = change;
        r[2][i] = bend;
        r[3][i] = change - h * f[12][i] - bend;
        for (m = 0; m < 4; ++m) {
            double sum = terms[12 * m] * f[0][i];
            for (j = 1; j < 12; ++j)
                sum += terms[12 * m + j] * f[j + 4][i];
            r[4 + m][i] = h * sum;
        }
    }
}

/* Begins a run that chooses its steps: no work is done yet, and the samples at the start are written, `visited` of them. Returns -1, or the
   status of a run without a step: 0, it is at its end; 1, times or tolerances make no sense. */
GUEN_FUNCTION int NAME_begin(
    double origin, const double *x, double until, guen_adaptive *method, int count, const double *times, double *samples, int *visited)
{
    int i;
    method->evaluations = method->accepted = method->rejected = 0;
    if (!guen_is_finite(origin) || !guen_is_finite(until) || !guen_in_order(origin, until, count, times))
        return 1;
    for (*visited = 0; *visited < count && times[*visited] == origin; ++*visited)
        for (i = 0; i < NAME_STATES; ++i)
            samples[*visited * NAME_STATES + i] = x[i];
    if (until == origin)
        return 0;
    if (!(method->rtol >= 0.0 && guen_is_finite(method->rtol) && method->atol > 0.0 && guen_is_finite(method->atol)))
        return 1;
    return -1;
}

/* A run of DOP853 from *t to `until`, with the states at `count` times, which run in order from *t to `until` and may repeat: entry i at
   the j-th time is samples[j * NAME_STATES + i]. Moves t and x, and writes the work. Returns 0, or what stopped it, with the last good t and
   x: 1, a setting that makes no sense; 2, steps too small to move t; 3, a state or a rate that is not finite; 4, too many steps. */
GUEN_FUNCTION int NAME_dop853(
    const double *c, const double *k, const double *u, double *t, double *x, double until, guen_adaptive *method, int count,
    const double *times, double *samples)
{
    static const double error5[8] = { ERROR5_WEIGHTS };
    static const double error3[8] = { ERROR3_WEIGHTS };
    const double origin = *t;
    double f[16][NAME_STATES], r[8][NAME_STATES], w[NAME_STATES], last[NAME_STATES], end[NAME_STATES], e5[NAME_STATES], e3[NAME_STATES];
    double ready = method->first_step, level = 0.0;
    int i, j, has_level = 0, visited, has_terms, status;
#ifdef GUEN_WATCHED
    double d[NAME_DOMAIN + 1];
    NAME_domain(c, k, origin, x, d);
#endif
    status = NAME_begin(origin, x, until, method, count, times, samples, &visited);
    if (status >= 0)
        return status;
    if (!NAME_is_finite(x))
        return 3;
    NAME_rhs(c, k, origin, x, u, f[0]);
    method->evaluations += 1;
    if (!NAME_is_finite(f[0]))
        return 3;
    if (!(ready >= 0.0 && guen_is_finite(ready)))
        return 1;
    if (ready == 0.0)
        ready = NAME_first_step(c, k, u, origin, x, f[0], until - origin, method);
    while (*t != until) {
        const double time = *t, span = until - time, shortest = guen_shortest(time, origin);
        double step = ready < shortest ? shortest : ready;
        int was_rejected = 0;
        for (;;) {
            double next, h, size, trend, allowed, found, five, three, margin, factor;
            int landing, defined, finite;
            if (method->accepted + method->rejected >= method->max_steps)
                return 4;
            landing = 1.01 * step > fabs(span);
            next = landing ? until : time + copysign(step, span);
            h = next - time;
            size = fabs(h);
            trend = has_level ? 16.0 * guen_rough_log2(size) - level : 0.0;
            NAME_stages(c, k, u, time, x, h, 1, f, last, end);
            method->evaluations += 11;
            /* Of the slopes 0 and 5 to 11. */
            for (i = 0; i < NAME_STATES; ++i) {
                e5[i] = error5[0] * f[0][i];
                e3[i] = error3[0] * f[0][i];
                for (j = 1; j < 8; ++j) {
                    e5[i] += error5[j] * f[j + 4][i];
                    e3[i] += error3[j] * f[j + 4][i];
                }
            }
            NAME_tolerances(method, x, last, w);
            five = NAME_squares(e5, w);
            three = NAME_squares(e3, w);
            allowed = (double)NAME_STATES * (five + 0.01 * three) + 1e-150;
            found = size * five * (size * five);
            defined = NAME_is_finite(end);
            finite = defined && guen_is_finite(found) && guen_is_finite(allowed);
            if (finite && found <= allowed) {
                NAME_rhs(c, k, next, end, u, f[12]);
                method->evaluations += 1;
                defined = NAME_is_finite(f[12]);
                if (defined) {
                    margin = guen_rough_log2(allowed) - guen_rough_log2(found);
                    factor = guen_factor(margin + fmin(margin + trend, 0.0));
                    ready = size * (factor < 0.333 ? 0.333 : factor > 6.0 ? 6.0 : factor);
                    if (was_rejected)
                        ready = fmin(ready, size);
                    level = fmin(margin, 26.6) + 16.0 * guen_rough_log2(size);
                    has_level = 1;
                    method->accepted += 1;
                    *t = next;
                    break;
                }
            }
            method->rejected += 1;
            was_rejected = 1;
            factor = finite && defined ? fmax(0.333, guen_factor(guen_rough_log2(allowed) - guen_rough_log2(found))) : 0.333;
            if (step <= shortest)
                return defined ? 2 : 3;
            step = fmax(size * factor, shortest);
            /* A step of a few spacings of numbers that ends where the one before did would be refused for ever. */
            if (time + copysign(step, span) == next)
                step = shortest;
        }
#ifdef GUEN_WATCHED
        if (NAME_is_suspect(c, k, *t, end, 0.0, d))
            return 5;
#endif
        /* The samples of the step, of which the last may be at its end. */
        for (has_terms = 0; visited < count && !guen_earlier(*t, times[visited], span < 0.0); ++visited) {
            double *sample = samples + visited * NAME_STATES, h = *t - time, s, factor;
            if (times[visited] == *t) {
                for (i = 0; i < NAME_STATES; ++i)
                    sample[i] = end[i];
                continue;
            }
            if (!has_terms) {
                NAME_terms(c, k, u, time, x, h, end, f, r);
                method->evaluations += 3;
                has_terms = 1;
            }
            s = (times[visited] - time) / h;
            for (i = 0; i < NAME_STATES; ++i)
                sample[i] = r[7][i];
            for (j = 6; j >= 0; --j) {
                factor = j % 2 ? 1.0 - s : s;
                for (i = 0; i < NAME_STATES; ++i)
                    sample[i] = r[j][i] + factor * sample[i];
            }
        }
        for (i = 0; i < NAME_STATES; ++i) {
            x[i] = end[i];
            f[0][i] = f[12][i];
        }
    }
    return 0;
}
