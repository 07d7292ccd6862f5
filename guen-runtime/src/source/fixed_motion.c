
/* A motion in steps of one size from *t through all stops. Returns 0, or what stopped it. */
GUEN_FUNCTION int NAME_motion(
    const double *c, const double *k, const double *u, double *t, double *x, const double *settings, int stops, const double *times,
    int keep, double *samples, guen_adaptive *method)
{
    int i, stop;
    for (stop = 0; stop < stops; ++stop) {
        const double until = times[stop], start = *t;
        int status;
        if (!guen_is_finite(start) || !guen_is_finite(until))
            return 1;
        status = NAME_STEPPER(c, k, u, t, x, until, settings[0]);
        if (status)
            return status;
        if (until != start)
            method->accepted += (unsigned long long)guen_steps(until - start, settings[0]);
        if (keep)
            for (i = 0; i < NAME_STATES; ++i)
                samples[stop * NAME_STATES + i] = x[i];
    }
    method->evaluations = method->accepted * EVALUATIONS;
    return 0;
}
