// SPDX-License-Identifier: BSL-1.0
// The least firmware around servo_axis.h: linked without a C library's start-up, files or heap, to see what an axis costs.
#include "servo_axis.h"

static const struct servo_tuning tuning = {150, 60, 450, 150, 330, 10};
static struct servo_motion reference[SERVO_AXES];
static volatile servo_number sensor[SERVO_AXES], output[SERVO_AXES];
static char text[120];

void _start(void) {
    for (int axis = 0; axis < SERVO_AXES; ++axis)
        if (!servo_axis_init(axis, &tuning, 500e-6)) {
            servo_axis_why(axis, text, sizeof text);
            return;
        }
    for (;;)
        for (int axis = 0; axis < SERVO_AXES; ++axis)
            output[axis] = servo_axis_step(axis, &reference[axis], sensor[axis]);
}
