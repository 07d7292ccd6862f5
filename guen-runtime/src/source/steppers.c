
#ifdef GUEN_WATCHED
/* Whether one of the functions that must not vanish has no longer the sign that it had in d, or has changed by more than a factor, if that is not
   zero. Writes their values at x into d. */
GUEN_FUNCTION int NAME_is_suspect(const double *c, const double *k, double t, const double *x, double most, double *d)
{
    double now[NAME_DOMAIN + 1];
    int i, suspect = 0;
    NAME_domain(c, k, t, x, now);
    for (i = 0; i < NAME_DOMAIN; ++i) {
        double from = fabs(d[i]), to = fabs(now[i]);
        suspect |= !((d[i] > 0.0 && now[i] > 0.0) || (d[i] < 0.0 && now[i] < 0.0));
        suspect |= most > 0.0 && (to > most * from || from > most * to);
        d[i] = now[i];
    }
    return suspect;
}
#endif

/* One step of the classical Runge-Kutta method of order four, from x at t; h may be negative. */
GUEN_FUNCTION void NAME_rk4_step(
    const double *c, const double *k, const double *u, double t, const double *x, double h, double *end)
{
    double half = h * 0.5, sixth = h * (1.0 / 6.0);
    double at[NAME_STATES], f1[NAME_STATES], f2[NAME_STATES], f3[NAME_STATES], f4[NAME_STATES];
    int i;
    NAME_rhs(c, k, t, x, u, f1);
    for (i = 0; i < NAME_STATES; ++i)
        at[i] = half * f1[i] + x[i];
    NAME_rhs(c, k, t + half, at, u, f2);
    for (i = 0; i < NAME_STATES; ++i)
        at[i] = half * f2[i] + x[i];
    NAME_rhs(c, k, t + half, at, u, f3);
    for (i = 0; i < NAME_STATES; ++i)
        at[i] = h * f3[i] + x[i];
    NAME_rhs(c, k, t + h, at, u, f4);
    for (i = 0; i < NAME_STATES; ++i)
        end[i] = sixth * (f4[i] + (2.0 * (f2[i] + f3[i]) + f1[i])) + x[i];
}

/* A row of a method: x + h sum_j w_j f_j over `count` slopes, of which the j-th is number from[j]. The last `late` of them are added one
   by one, each with the product of h and its weight. */
GUEN_FUNCTION void NAME_row(
    const double *x, double h, int count, int late, const double *w, const int *from, double f[][NAME_STATES], double *at)
{
    int i, j;
    for (i = 0; i < NAME_STATES; ++i) {
        double sum = w[0] * f[from[0]][i];
        for (j = 1; j < count - late; ++j)
            sum += w[j] * f[from[j]][i];
        at[i] = h * sum + x[i];
        for (; j < count; ++j)
            at[i] += h * w[j] * f[from[j]][i];
    }
}

/* The stages of the Runge-Kutta method of order eight from x at t, where the slope is f[0]: the slopes f[1] to f[11], the argument `last` of
   the last of them, and the state at the end. `early` says whether slopes of late stages are added one by one. */
GUEN_FUNCTION void NAME_stages(
    const double *c, const double *k, const double *u, double t, const double *x, double h, int early, double f[][NAME_STATES],
    double *last, double *end)
{
    static const double nodes[11] = { RK8_NODES };
    static const double weights[RK8_COUNT] = { RK8_WEIGHTS };
    /* How many slopes each stage is made of, how many of them are late, and which they are. */
    static const int counts[12] = { 1, 2, 2, 3, 3, 4, 5, 6, 7, 8, 9, 8 };
    static const int late[12] = { 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2 };
    static const int from[RK8_COUNT] = {
        0, 0, 1, 0, 2, 0, 2, 3, 0, 3, 4, 0, 3, 4, 5, 0, 3, 4, 5, 6, 0, 3, 4, 5, 6, 7,
        0, 3, 4, 5, 6, 7, 8, 0, 3, 4, 5, 6, 7, 8, 9, 0, 3, 4, 5, 6, 7, 8, 9, 10, 0, 5, 6, 7, 8, 9, 10, 11
    };
    int stage, place = 0;
    for (stage = 0; stage < 11; ++stage) {
        NAME_row(x, h, counts[stage], early ? late[stage] : 0, weights + place, from + place, f, last);
        place += counts[stage];
        NAME_rhs(c, k, t + nodes[stage] * h, last, u, f[stage + 1]);
    }
    NAME_row(x, h, counts[11], early ? late[11] : 0, weights + place, from + place, f, end);
}

/* One step of the Runge-Kutta method of order eight, from x at t; h may be negative. */
GUEN_FUNCTION void NAME_rk8_step(
    const double *c, const double *k, const double *u, double t, const double *x, double h, double *end)
{
    double at[NAME_STATES], f[12][NAME_STATES];
    NAME_rhs(c, k, t, x, u, f[0]);
    NAME_stages(c, k, u, t, x, h, 0, f, at, end);
}

/* Steps of one size from *t to `until`, at t + h, t + 2 h, ..; the last is shortened. Moves t and x. Returns 0, or what stopped it, with the
   last good t and x: 1, a step that is not positive and finite; 2, steps too small to count or to move t; 3, a state that is not finite. */
GUEN_FUNCTION int NAME_run(
    void (*step)(const double *, const double *, const double *, double, const double *, double, double *),
    const double *c, const double *k, const double *u, double *t, double *x, double until, double size)
{
    double origin = *t, h = until < origin ? -size : size, index, count, next, end[NAME_STATES];
    int i;
#ifdef GUEN_WATCHED
    double d[NAME_DOMAIN + 1];
    NAME_domain(c, k, origin, x, d);
#endif
    if (!(size > 0.0 && guen_is_finite(size)))
        return 1;
    if (until == origin)
        return 0;
    if (!(fabs((until - origin) / size) < 9007199254740992.0))
        return 2;
    count = guen_steps(until - origin, size);
    for (index = 1.0; index <= count; index += 1.0) {
        next = index == count ? until : origin + h * index;
        if (next == *t)
            return 2;
        step(c, k, u, *t, x, next - *t, end);
        for (i = 0; i < NAME_STATES; ++i)
            if (!guen_is_finite(end[i]))
                return 3;
#ifdef GUEN_WATCHED
        if (NAME_is_suspect(c, k, next, end, 2.0, d))
            return 5;
#endif
        for (i = 0; i < NAME_STATES; ++i)
            x[i] = end[i];
        *t = next;
    }
    return 0;
}

GUEN_FUNCTION int NAME_rk4(
    const double *c, const double *k, const double *u, double *t, double *x, double until, double size)
{
    return NAME_run(NAME_rk4_step, c, k, u, t, x, until, size);
}

GUEN_FUNCTION int NAME_rk8(
    const double *c, const double *k, const double *u, double *t, double *x, double until, double size)
{
    return NAME_run(NAME_rk8_step, c, k, u, t, x, until, size);
}
