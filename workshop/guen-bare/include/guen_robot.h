/* A balancing robot's controller: what the static library of the crate guen-bare offers.
 *
 * Nothing here allocates, fails after guen_robot_prepare, or calls an operating system. All units are SI and radians.
 */
#ifndef GUEN_ROBOT_H
#define GUEN_ROBOT_H

#include <stdbool.h>
#include <stdint.h>

/* m, mw, h, b, r, A, B, C, I, J, c, torque_max, g */
typedef struct { double values[13]; } guen_robot_constants;

/* x, y, heading, tilt, left, right, speed, turn, fall */
typedef struct { double values[9]; } guen_robot_state;

/* of the left and of the right motor, and a push at the chassis, which the controller takes for zero */
typedef struct { double values[3]; } guen_robot_torques;

/* u = torque - K z: for each motor the gains of heading, tilt, speed, turn, fall */
typedef struct { double values[2][5]; } guen_robot_gain;

/* what is aimed at, and the torque of each motor that holds it */
typedef struct { double heading, speed, turn, torque; } guen_robot_reference;

/* The plant with its constants checked and prepared; for guen_robot_prepare to fill. */
#define GUEN_ROBOT_WORDS 128
typedef struct { double words[GUEN_ROBOT_WORDS]; } guen_robot_plant;

/* Returns false, and leaves the plant as it was, if a constant is out of its bound. */
bool guen_robot_prepare(const guen_robot_constants *constants, guen_robot_plant *plant);

/* The torques at the state, inside of their limits, and the state `step` seconds later in place of the state. */
void guen_robot_period(const guen_robot_plant *plant, const guen_robot_gain *gain,
                       const guen_robot_reference *reference, double step, guen_robot_state *state,
                       guen_robot_torques *torques);

/* The rates of a state under given torques. */
void guen_robot_rates(const guen_robot_plant *plant, const guen_robot_state *state,
                      const guen_robot_torques *torques, guen_robot_state *rates);

/* The arithmetic operations of guen_robot_period, the same in every state. */
uint32_t guen_robot_operations(void);

#endif
