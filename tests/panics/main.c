/* Calls the functions that CALLED lists, F(name) for each: so that they, and nothing else, are linked. */
#include <stdbool.h>
#define F(name) bool name(const double *, double *, double, double, double);
CALLED
#undef F

static bool (*const all[])(const double *, double *, double, double, double) = {
#define F(name) name,
    CALLED
};

int main(void) {
    enum { LONGEST = 64, COUNT = sizeof all / sizeof all[0] };
    int done = 0;
    for (int k = 0; k < COUNT; k++) {
        double constants[LONGEST], state[LONGEST];
        for (int i = 0; i < LONGEST; i++) {
            constants[i] = 1.0 + 0.125 * i;
            state[i] = 0.5 + 0.0625 * i;
        }
        done += all[k](constants, state, 0.25, 0.001, 0.01);
    }
    /* The number of runs that came to their end. */
    return done;
}
