/* Runs the bare library for some periods, and prints every state and torque as the bits of its doubles; with the word
 * "stack", prints the bytes of stack that a period takes instead. */
#define _POSIX_C_SOURCE 200809L
#include "guen_robot.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print(const double *values, int count) {
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf("%016" PRIx64 " ", bits);
    }
}

static guen_robot_plant used_plant;
static guen_robot_state used_state;
static guen_robot_torques used_torques;
static const guen_robot_gain no_gain;
static const guen_robot_reference no_reference;

static void *nothing(void *unused) { return unused; }

static void *period(void *unused) {
    guen_robot_period(&used_plant, &no_gain, &no_reference, 0.005, &used_state, &used_torques);
    return unused;
}

/* The bytes of a stack of its own that a thread has written to: they are no longer what they were before. */
static size_t written(void *(*work)(void *)) {
    enum { SIZE = 1 << 20, MARK = 0xA5 };
    unsigned char *stack = aligned_alloc(4096, SIZE);
    pthread_attr_t attributes;
    pthread_t thread;
    if (!stack) {
        return 0;
    }
    memset(stack, MARK, SIZE);
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, stack, SIZE);
    if (pthread_create(&thread, &attributes, work, NULL) != 0 || pthread_join(thread, NULL) != 0) {
        return 0;
    }
    size_t untouched = 0;
    while (untouched < SIZE && stack[untouched] == MARK) {
        untouched++;
    }
    free(stack);
    return SIZE - untouched;
}

int main(int count, char **words) {
    const guen_robot_constants constants = {
        {10.0, 1.0, 0.5, 0.3, 0.1, 0.5, 0.4, 0.2, 0.003, 0.005, 0.01, 1.5, 9.81}};
    const guen_robot_gain gain = {{{-2.5, -21.0, -3.0, -1.05, -4.4}, {2.5, -21.0, -3.0, 1.05, -4.4}}};
    const guen_robot_reference reference = {0.3, 0.8, 0.0, 0.08};
    guen_robot_plant plant;
    guen_robot_state state = {{0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.2, 0.1, -0.3}};
    guen_robot_torques torques;
    guen_robot_constants wrong = constants;
    wrong.values[0] = -1.0;
    if (guen_robot_prepare(&wrong, &plant) || !guen_robot_prepare(&constants, &plant)) {
        return EXIT_FAILURE;
    }
    if (count > 1 && strcmp(words[1], "stack") == 0) {
        used_plant = plant;
        printf("%zu\n", written(period) - written(nothing));
        return EXIT_SUCCESS;
    }
    for (int periods = count > 1 ? atoi(words[1]) : 0; periods > 0; periods--) {
        guen_robot_period(&plant, &gain, &reference, 0.005, &state, &torques);
        print(state.values, 9);
        print(torques.values, 3);
        printf("\n");
    }
    guen_robot_rates(&plant, &state, &torques, &state);
    print(state.values, 9);
    printf("\n%" PRIu32 "\n", guen_robot_operations());
    return EXIT_SUCCESS;
}
