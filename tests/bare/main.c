/* Runs the bare library for some periods, and prints every state and torque as the bits of its doubles. */
#include "guen_robot.h"

#include <inttypes.h>
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
