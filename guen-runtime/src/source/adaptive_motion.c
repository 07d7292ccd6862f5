
/* A motion by DOP853 from *t to the last stop, with samples at all of them. Returns 0, or what stopped it. */
GUEN_FUNCTION int NAME_motion(
    const double *c, const double *k, const double *u, double *t, double *x, const double *settings, int stops, const double *times,
    int keep, double *samples, guen_adaptive *method)
{
    method->rtol = settings[0];
    method->atol = settings[1];
    method->first_step = settings[2];
    method->max_steps = (unsigned long long)settings[3];
    return NAME_dop853(c, k, u, t, x, stops ? times[stops - 1] : *t, method, keep ? stops : 0, times, samples);
}
