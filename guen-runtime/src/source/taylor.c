
/* The series of the motion about a place: x(start + h) is the sum of x[m] (h/scale)^m over m = 0 .. order. */
typedef struct {
    double start, scale;
    int order;
    double x[GUEN_HIGHEST_ORDER + 1][NAME_STATES];
} NAME_expansion;

/* The coefficients at a state, with a scale for which they are finite. */
GUEN_FUNCTION int NAME_expand(
    const double *c, const double *k, const double *u, double time, const double *x, int order, double *scale, NAME_expansion *e,
    guen_adaptive *method)
{
    int trial, m, finite;
    e->start = time;
    e->order = order;
    for (trial = 0; trial < 6; ++trial) {
        e->scale = *scale;
        NAME_series(c, k, time, x, u, e->scale, order, e->x);
        method->evaluations += (unsigned long long)order;
        for (finite = 1, m = 0; m <= order; ++m)
            finite &= NAME_is_finite(e->x[m]);
        if (finite)
            return 0;
        if (!NAME_is_finite(e->x[1]))
            break;
        *scale *= 1.0 / 1048576.0;
        method->rejected += 1;
    }
    return 3;
}

/* The binary logarithm of the longest step, in units of the scale, that the coefficients from one order on allow. */
GUEN_FUNCTION double NAME_allowed(const NAME_expansion *e, const double *w, const guen_adaptive *method, int first)
{
    double ratio = fmax(2.0, -0.7 * guen_linear_log2(fmax(method->rtol, method->atol)) / (double)e->order), shortest = GUEN_INFINITY;
    int i, m;
    for (m = first; m <= e->order; ++m) {
        double largest = 0.0, below = (double)e->order - (double)m, allowed;
        for (i = 0; i < NAME_STATES; ++i) {
            double size = fabs(e->x[m][i]) * w[i];
            largest = size > largest ? size : largest;
        }
        allowed = ratio * (below - 1.0) + 0.6 * fmax(below + 1.0 - 4.0, 0.0);
        shortest = fmin(shortest, (allowed - guen_linear_log2(largest)) / (double)m);
    }
    return shortest;
}

/* The length of the step that the coefficients allow; infinite where all of them vanish. */
GUEN_FUNCTION double NAME_length(const NAME_expansion *e, const double *w, const guen_adaptive *method)
{
    int half = (e->order + 1) / 2;
    double shortest = NAME_allowed(e, w, method, e->order + 1 - (half < 8 ? half : 8));
    if (shortest == GUEN_INFINITY)
        shortest = NAME_allowed(e, w, method, 1);
    return shortest == GUEN_INFINITY ? shortest : guen_linear_exp2(shortest) * e->scale;
}

/* The sums of x[m] s^(m - first) and (m - first) x[m] s^(m - first - 1) over m = first .. last. */
GUEN_FUNCTION void NAME_horner(const NAME_expansion *e, int first, int last, double s, double *sum, double *slope)
{
    int i, m;
    for (i = 0; i < NAME_STATES; ++i) {
        sum[i] = e->x[last][i];
        slope[i] = 0.0;
    }
    for (m = last - 1; m >= first; --m)
        for (i = 0; i < NAME_STATES; ++i) {
            slope[i] = slope[i] * s + sum[i];
            sum[i] = sum[i] * s + e->x[m][i];
        }
}

/* Whether the slope of a series over a length is that of rates, within the tolerance. */
GUEN_FUNCTION int NAME_is_small(const double *slope, const double *rates, double length, const double *w)
{
    int i, small = 1;
    for (i = 0; i < NAME_STATES; ++i)
        small &= fabs(slope[i] - rates[i] * length) * w[i] <= 64.0;
    return small;
}

/* Whether it is that, or rates are no better determined: those of neighbouring states differ as much. */
GUEN_FUNCTION int NAME_is_none(
    const double *c, const double *k, const double *u, const NAME_expansion *e, double time, const double *x, double length,
    const double *slope, const double *rates, const double *w)
{
    double near[NAME_STATES], here[NAME_STATES], there[NAME_STATES], most[NAME_STATES], over = length / e->scale, power = 1.0;
    int i, m;
    if (NAME_is_small(slope, rates, length, w))
        return 1;
    for (i = 0; i < NAME_STATES; ++i) {
        double change = x[i] * (2.2204460492503131e-16 * 2.0);
        near[i] = i % 2 ? x[i] - change : x[i] + change;
    }
    NAME_rhs(c, k, time, near, u, here);
    for (i = 0; i < NAME_STATES; ++i) {
        double change = e->x[0][i] * (2.2204460492503131e-16 * 2.0);
        near[i] = i % 2 ? e->x[0][i] - change : e->x[0][i] + change;
        most[i] = 0.0;
    }
    NAME_rhs(c, k, e->start, near, u, there);
    for (m = 0; m <= e->order; ++m) {
        for (i = 0; i < NAME_STATES; ++i)
            most[i] = fmax(most[i], (double)m * fabs(e->x[m][i]) * power);
        power *= fabs(over);
    }
    for (i = 0; i < NAME_STATES; ++i) {
        double at_end = (here[i] - rates[i]) * length, at_begin = there[i] * length - e->x[1][i] * over;
        double rounding = fabs(at_end) + fabs(at_begin) + 2.2204460492503131e-16 * most[i];
        double defect = fabs(slope[i] - rates[i] * length);
        if (!(defect < GUEN_INFINITY && defect <= fmax(64.0 / w[i], 8.0 * rounding)))
            return 0;
    }
    return 1;
}

/* A step of length h from x to `end` at `next`, by the series e. The series there is expanded at once into `after` if it is wanted. Returns 0,
   or why there is no such step: 2, its rates are not those of the series; 3, something is not finite. */
GUEN_FUNCTION int NAME_attempt(
    const double *c, const double *k, const double *u, const NAME_expansion *e, NAME_expansion *after, int inside, double next, double h,
    const double *w, const double *x, const double *rest, double *end, double *end_rest, int *ahead, double *scale, guen_adaptive *method)
{
    double change[NAME_STATES], slope[NAME_STATES], at[NAME_STATES], rates[NAME_STATES], over = h / e->scale, length, s, part;
    int i, wanted = *ahead;
    *ahead = 0;
    NAME_horner(e, 1, e->order, over, change, slope);
    for (i = 0; i < NAME_STATES; ++i) {
        double sum, added;
        slope[i] = (change[i] + slope[i] * over) * over;
        added = change[i] * over + rest[i];
        sum = x[i] + added;
        part = sum - x[i];
        end[i] = sum;
        end_rest[i] = (x[i] - (sum - part)) + (added - part);
    }
    if (!NAME_is_finite(end))
        return 3;
    /* Within the step, by the first terms, and by all of them where these leave a doubt. */
    length = h * 0.45;
    s = length / e->scale;
    {
        double inner[NAME_STATES];
        NAME_horner(e, 0, inside < e->order ? inside : e->order, s, at, inner);
        for (i = 0; i < NAME_STATES; ++i)
            inner[i] *= s;
        method->evaluations += 1;
        NAME_rhs(c, k, e->start + length, at, u, rates);
        if (!NAME_is_small(inner, rates, length, w)) {
            NAME_horner(e, 0, e->order, s, at, inner);
            for (i = 0; i < NAME_STATES; ++i)
                inner[i] *= s;
            method->evaluations += 1;
            NAME_rhs(c, k, e->start + length, at, u, rates);
            if (!NAME_is_none(c, k, u, e, e->start + length, at, length, inner, rates, w))
                return 2;
        }
    }
    if (wanted && NAME_expand(c, k, u, next, end, e->order, scale, after, method) == 0) {
        *ahead = 1;
        part = 1.0 / after->scale;
        if (NAME_is_small(slope, after->x[1], h * part, w))
            return 0;
        for (i = 0; i < NAME_STATES; ++i)
            rates[i] = part * after->x[1][i];
    } else {
        method->evaluations += 1;
        NAME_rhs(c, k, next, end, u, rates);
    }
    if (NAME_is_none(c, k, u, e, next, end, h, slope, rates, w))
        return 0;
    return NAME_is_finite(rates) ? 2 : 3;
}

/* A run of Taylor's method from *t to `until`, with the states at `count` times, as with dop853. The order is 2 to 32, or 0: chosen by the
   tolerances. Returns 0, or what stopped it, with the last good t and x: 1, a setting that makes no sense, such as a first step, which is
   not this method's; 2, steps too small to move t; 3, a state or a rate that is not finite; 4, too many steps. */
GUEN_FUNCTION int NAME_taylor(
    const double *c, const double *k, const double *u, double *t, double *x, double until, guen_adaptive *method, int order, int count,
    const double *times, double *samples)
{
    static const double loosest[GUEN_HIGHEST_ORDER - 8] = { ORDER_TOLERANCES };
    const double origin = *t;
    NAME_expansion e[2];
    double rest[NAME_STATES], end[NAME_STATES], end_rest[NAME_STATES], w[NAME_STATES], tolerance, scale = 0.0, longest = GUEN_INFINITY;
    int i, m, here = 0, ahead = 0, inside, visited, status;
#ifdef GUEN_WATCHED
    double d[NAME_DOMAIN + 1];
    NAME_domain(c, k, origin, x, d);
#endif
    status = NAME_begin(origin, x, until, method, count, times, samples, &visited);
    if (status >= 0)
        return status;
    if (order < 0 || order == 1 || order > GUEN_HIGHEST_ORDER || method->first_step != 0.0)
        return 1;
    tolerance = fmax(method->rtol, method->atol);
    if (order == 0)
        for (order = 8; order < GUEN_HIGHEST_ORDER && tolerance <= loosest[order - 8];)
            ++order;
    {
        double digits = fmin(log2(tolerance), 0.0);
        inside = (int)((double)order * digits / (digits + (double)order * INSIDE_LOGARITHM));
    }
    for (i = 0; i < NAME_STATES; ++i)
        rest[i] = 0.0;
    while (*t != until) {
        const double time = *t, span = until - time, shortest = guen_shortest(time, origin);
        double step;
        int was_rejected = 0;
        if (method->accepted + method->rejected >= method->max_steps)
            return 4;
        if (!ahead) {
            if (scale == 0.0) {
                double slope[NAME_STATES], guess;
                if (!NAME_is_finite(x))
                    return 3;
                NAME_rhs(c, k, time, x, u, slope);
                method->evaluations += 1;
                if (!NAME_is_finite(slope))
                    return 3;
                NAME_tolerances(method, x, x, w);
                guess = NAME_first_guess(x, slope, w, fabs(span));
                scale = guen_power_of_two(100.0 * guess);
            }
            if (NAME_expand(c, k, u, time, x, order, &scale, &e[here], method))
                return 3;
            ahead = 1;
        }
        NAME_tolerances(method, x, x, w);
        step = fmin(NAME_length(&e[here], w, method), longest);
        for (;;) {
            const int landing = 1.01 * step > fabs(span);
            const double next = landing ? until : time + copysign(step, span), h = next - time;
            const int is_shortest = fmin(step, fabs(span)) <= shortest;
            if (is_shortest && !landing && !was_rejected)
                return 2;
            if (guen_is_finite(step))
                scale = guen_power_of_two(step);
            ahead = !landing && !was_rejected;
            status = NAME_attempt(
                c, k, u, &e[here], &e[here ^ 1], inside, next, h, w, x, rest, end, end_rest, &ahead, &scale, method);
            if (status == 0) {
                longest = 2.0 * (was_rejected ? step : longest);
                method->accepted += 1;
                *t = next;
                break;
            }
            if (is_shortest)
                return status;
            was_rejected = 1;
            method->rejected += 1;
            if (method->accepted + method->rejected >= method->max_steps)
                return 4;
            step = fmax(0.5 * (landing ? fabs(h) : step), shortest);
        }
#ifdef GUEN_WATCHED
        if (NAME_is_suspect(c, k, *t, end, 0.0, d))
            return 5;
#endif
        /* The samples of the step, of which the last may be at its end. */
        for (; visited < count && !guen_earlier(*t, times[visited], span < 0.0); ++visited) {
            double *sample = samples + visited * NAME_STATES, s = (times[visited] - e[here].start) / e[here].scale;
            for (i = 0; i < NAME_STATES; ++i) {
                double sum = e[here].x[order][i];
                for (m = order - 1; m >= 1; --m)
                    sum = sum * s + e[here].x[m][i];
                sample[i] = times[visited] == *t ? end[i] : x[i] + s * sum;
            }
        }
        for (i = 0; i < NAME_STATES; ++i) {
            x[i] = end[i];
            rest[i] = end_rest[i];
        }
        here ^= 1;
    }
    return 0;
}
