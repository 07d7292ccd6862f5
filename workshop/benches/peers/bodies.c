/* Times functions of shared libraries in turn: bodies ROUNDS {LIBRARY FUNCTION STATES SIZE}..
 *
 * Prints a line for each function: its rates at the first state, hexadecimal. Then a line for each round, in which every function has
 * one batch over all states: nanoseconds of the processor for an evaluation, in the order of the functions. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define BATCH 3e-3
#define MOST 16
#define WIDEST 256

typedef void (*rates_fn)(const double *, double *);

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static double timed(rates_fn rates, const double *states, long count, int size, long times) {
    double out[WIDEST], start = now();
    for (long n = 0; n < times; n++)
        for (long i = 0; i < count; i++) {
            rates(states + i * size, out);
            __asm__ volatile("" : : "r"(out) : "memory");
        }
    return now() - start;
}

static double states[MOST][1 << 17];

int main(int words, char **word) {
    int rounds = atoi(word[1]), programs = (words - 2) / 4, size[MOST];
    long count[MOST], times[MOST];
    rates_fn rates[MOST];
    if (programs > MOST) return 1;
    for (int k = 0; k < programs; k++) {
        char **own = word + 2 + 4 * k;
        void *library = dlopen(own[0], RTLD_NOW);
        if (!library || !(rates[k] = (rates_fn)dlsym(library, own[1]))) return fprintf(stderr, "%s\n", dlerror()), 1;
        FILE *file = fopen(own[2], "rb");
        size[k] = atoi(own[3]);
        if (!file || size[k] > WIDEST) return 1;
        count[k] = fread(states[k], sizeof **states, sizeof *states / sizeof **states, file) / size[k];
        fclose(file);
        double out[WIDEST] = {0};
        rates[k](states[k], out);
        for (int i = 0; i < size[k]; i++) printf("%a ", out[i]);
        puts("");
        for (times[k] = 1; timed(rates[k], states[k], count[k], size[k], times[k]) < BATCH;) times[k] *= 2;
    }
    for (int round = 0; round < rounds; round++) {
        double taken[MOST];
        for (int turn = 0; turn < programs; turn++) {
            int k = round % 2 ? programs - 1 - turn : turn;
            taken[k] = timed(rates[k], states[k], count[k], size[k], times[k]) * 1e9 / (count[k] * times[k]);
        }
        for (int k = 0; k < programs; k++) printf("%.3f ", taken[k]);
        puts("");
    }
    return 0;
}
