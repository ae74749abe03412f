/* SPDX-License-Identifier: BSL-1.0 */
/* Servo axes for a firmware in C. No heap, no I/O; everything lies in static storage. SI units. */
#ifndef SERVO_AXIS_H
#define SERVO_AXIS_H
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SERVO_AXES = 2 };

#ifndef SERVO_NUMBER
#define SERVO_NUMBER float /* or double */
#endif
typedef SERVO_NUMBER servo_number;

struct servo_tuning {
    servo_number position_gain;     /* 1/s */
    servo_number velocity_gain;     /* V s/m */
    servo_number velocity_integral; /* V/m */
    servo_number estimator_corner;  /* Hz */
    servo_number notch_centre;      /* Hz */
    servo_number limit;             /* V */
};

/* Where the reference is: m, m/s, m/s^2. */
struct servo_motion {
    servo_number position, velocity, acceleration;
};

/* 1: the axis is ready, at rest at zero. 0: refused, and servo_axis_why says why. From one thread, never from a step. */
int servo_axis_init(int axis, const struct servo_tuning* tuning, double period_s);
/* "notch.centre = 1200 Hz: must lie between ..."; returns its length. Brings number formatting into the image: leave it out
   where flash is short. */
size_t servo_axis_why(int axis, char* text, size_t size);

/* From here on: a ready axis. Volts; the last ones again when a number is not finite. */
servo_number servo_axis_step(int axis, const struct servo_motion* reference, servo_number measured);
int servo_axis_faulted(int axis);
int servo_axis_limited(int axis);
/* At rest at `position`, held by `hold` volts; clears the fault. */
void servo_axis_settle(int axis, servo_number position, servo_number hold);

#ifdef __cplusplus
}
#endif
#endif
