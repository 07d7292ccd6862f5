
/* A thread for each of `count` motions. Constants, prepared values and inputs lie in `numbers`, entries of starts and ends in rows of their
   own, so that threads side by side read and write words side by side. There are as many systems as motions, or one for all. The last row
   of `ends` has times. Row 0 of `work` says what stopped a motion, as the stepper does; then come evaluations, accepted and rejected steps.
   If states at the stops are to be kept, those of a motion lie together, one after the other. */
GUEN_KERNEL void NAME_motions(
    unsigned long long count, unsigned long long systems, const double *numbers, const double *starts, double begin,
    const double *settings, int stops, const double *times, int keep, double *ends, double *samples, unsigned long long *work)
{
    const unsigned long long motion = (unsigned long long)blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned long long system = systems == 1 ? 0 : motion;
    double c[NAME_CONSTANTS + 1], k[NAME_PREPARED + 1], u[NAME_INPUTS + 1], x[NAME_STATES], t = begin;
    guen_adaptive method;
    int i, status;
    if (motion >= count)
        return;
    for (i = 0; i < NAME_CONSTANTS; ++i, numbers += systems)
        c[i] = numbers[system];
    for (i = 0; i < NAME_PREPARED; ++i, numbers += systems)
        k[i] = numbers[system];
    for (i = 0; i < NAME_INPUTS; ++i, numbers += systems)
        u[i] = numbers[system];
    for (i = 0; i < NAME_STATES; ++i)
        x[i] = starts[i * count + motion];
    method.evaluations = method.accepted = method.rejected = 0;
    if (keep)
        samples += motion * (unsigned long long)stops * NAME_STATES;
    status = NAME_motion(c, k, u, &t, x, settings, stops, times, keep, samples, &method);
    for (i = 0; i < NAME_STATES; ++i)
        ends[i * count + motion] = x[i];
    ends[NAME_STATES * count + motion] = t;
    work[motion] = (unsigned long long)status;
    work[count + motion] = method.evaluations;
    work[2 * count + motion] = method.accepted;
    work[3 * count + motion] = method.rejected;
}
