/* Times generated right-hand sides on request, one batch for each line that is read:
 *
 *   load SYSTEM FILE CONSTANT..     states in binary, 1024 of them; constants as hexadecimal numbers
 *   rates SYSTEM PROGRAM INDEX      answers with the rates of one state
 *   time SYSTEM PROGRAM MODE        answers with nanoseconds; MODE is throughput or latency
 *
 * The other side, workshop/guen-measure/src/serve.rs, does the same with the declared systems.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define STATES 1024
#define MOST 64
#define LINKS 512
#define BATCH 1.5e-3

typedef void (*rates_fn)(const double *restrict, const double *restrict, double *restrict);

/* What generated code needs beside the arithmetic. */
static inline double sq(double x) { return x * x; }
static inline double casadi_sq(double x) { return x * x; }

#include "generated.c"

static double states[STATES * MOST], constants[32];
static int size;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void run(rates_fn rates, int latency, long times) {
    double out[MOST], x[MOST];
    for (long n = 0; n < times; n++) {
        if (latency) {
            memcpy(x, states, size * sizeof *x);
            for (int i = 0; i < LINKS; i++) {
                rates(constants, x, out);
                for (int j = 0; j < size; j++) {
                    double next = x[j] + 1e-9 * out[j];
                    __asm__ volatile("" : "+m"(next));
                    x[j] = next;
                }
            }
        } else {
            for (int i = 0; i < STATES; i++) {
                rates(constants, states + (long)i * size, out);
                __asm__ volatile("" : : "r"(out) : "memory");
            }
        }
    }
}

static double timed(rates_fn rates, int latency) {
    static rates_fn known[256][2];
    static long counts[256][2];
    int slot = 0;
    while (known[slot][latency] && known[slot][latency] != rates) slot++;
    if (!known[slot][latency]) {
        long times = 1;
        for (;;) {
            double start = now();
            run(rates, latency, times);
            double taken = now() - start;
            if (taken >= BATCH) break;
            times = times * 2;
        }
        known[slot][latency] = rates;
        counts[slot][latency] = times;
    }
    double start = now();
    run(rates, latency, counts[slot][latency]);
    return (now() - start) * 1e9 / (counts[slot][latency] * (double)(latency ? LINKS : STATES));
}

static rates_fn find(const char *system, const char *program) {
    for (int i = 0; PROGRAMS[i].system; i++)
        if (!strcmp(PROGRAMS[i].system, system) && !strcmp(PROGRAMS[i].program, program)) {
            size = PROGRAMS[i].size;
            return PROGRAMS[i].rates;
        }
    fprintf(stderr, "no program %s of %s\n", program, system);
    exit(1);
}

int main(void) {
    char line[4096];
    while (fgets(line, sizeof line, stdin)) {
        char *command = strtok(line, " \n"), *system = strtok(NULL, " \n");
        if (!strcmp(command, "load")) {
            FILE *file = fopen(strtok(NULL, " \n"), "rb");
            if (!file || fread(states, 1, sizeof states, file) == 0) return 1;
            fclose(file);
            char *value;
            for (int i = 0; (value = strtok(NULL, " \n")) && i < 32; i++) constants[i] = strtod(value, NULL);
            puts("ready");
        } else {
            rates_fn rates = find(system, strtok(NULL, " \n"));
            char *argument = strtok(NULL, " \n");
            if (!strcmp(command, "rates")) {
                double out[MOST];
                rates(constants, states + atol(argument) * size, out);
                for (int i = 0; i < size; i++) printf("%.17g ", out[i]);
                puts("");
            } else {
                printf("%.6f\n", timed(rates, !strcmp(argument, "latency")));
            }
        }
        fflush(stdout);
    }
    return 0;
}
