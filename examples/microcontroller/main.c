/* SPDX-License-Identifier: BSL-1.0 */
/* A firmware in C with two axes: a circle of 10 mm in 236 ms, sampled every 500 us, each axis on a model of its motor.
   Prints the commands as bits, so that another processor's can be compared, and the instructions of one sample. */
#include "servo_axis.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { CYCLE = 472, SAMPLES = 10 * CYCLE };
static const double period = 500e-6;

#ifdef __arm__
/* QEMU with -icount shift=0: an instruction is a nanosecond, and SysTick counts every 40 of them. */
static volatile uint32_t* const systick = (uint32_t*)0xE000E010; /* control, reload, value */
static void clock_start(void) { systick[1] = 0xFFFFFF, systick[2] = 0, systick[0] = 5; }
static uint32_t clock_now(void) { return systick[2]; } /* counts down, 24 bits */
#else
static void clock_start(void) {}
static uint32_t clock_now(void) { return 0; }
#endif

/* The motor, x'' = 4.526 u - 28.57 x', in steps that every processor rounds alike. */
struct motor {
    servo_number x, v;
};
static void move(struct motor* m, servo_number u) {
    const servo_number T = (servo_number)period;
    m->v += T * ((servo_number)4.526 * u - (servo_number)28.57 * m->v);
    m->x += T * m->v;
}

static void print(servo_number u) {
    uint64_t bits = 0;
    memcpy(&bits, &u, sizeof u);
    printf(sizeof u == 4 ? "%08llx" : "%016llx", (unsigned long long)bits);
}

int main(void) {
    struct servo_tuning tuning = {150, 60, 450, 150, 1200, 10};
    char why[120];
    if (!servo_axis_init(0, &tuning, period)) {
        servo_axis_why(0, why, sizeof why);
        printf("refused: %s\n", why); /* 1200 Hz is above half the sampling rate */
    }
    tuning.notch_centre = 330;
    for (int axis = 0; axis < SERVO_AXES; ++axis)
        if (!servo_axis_init(axis, &tuning, period)) return 1;

    /* A circle by rotation: no sine, so that all processors see the same reference. */
    const servo_number w = (servo_number)26.6236666, c = (servo_number)0.99991140, s = (servo_number)0.01331144;
    servo_number cosine = 1, sine = 0;
    struct motor motor[SERVO_AXES] = {{0, 0}, {0, 0}};
    servo_number worst[2] = {0, 0}; /* of the first cycle and of the last */
    uint32_t spent = 0;
    clock_start();
    for (int k = 0; k < SAMPLES; ++k) {
        const servo_number R = (servo_number)0.01;
        const struct servo_motion r[SERVO_AXES] = {{R - R * cosine, R * w * sine, R * w * w * cosine},
                                                   {R * sine, R * w * cosine, -R * w * w * sine}};
        servo_number u[SERVO_AXES];
        const uint32_t before = clock_now();
        for (int axis = 0; axis < SERVO_AXES; ++axis) u[axis] = servo_axis_step(axis, &r[axis], motor[axis].x);
        spent += (before - clock_now()) & 0xFFFFFF;
        const servo_number error = r[0].position - motor[0].x, size = error < 0 ? -error : error;
        const int cycle = k < CYCLE ? 0 : k >= SAMPLES - CYCLE ? 1 : -1;
        if (cycle >= 0 && size > worst[cycle]) worst[cycle] = size;
        for (int axis = 0; axis < SERVO_AXES; ++axis) move(&motor[axis], u[axis]);
        printf("%d ", k), print(u[0]), printf(" "), print(u[1]), printf("\n");
        const servo_number turned = cosine * c - sine * s;
        sine = sine * c + cosine * s, cosine = turned;
    }
    printf("worst error of x: %.2f um in the first cycle, %.2f um in the last\n", 1e6 * (double)worst[0], 1e6 * (double)worst[1]);
    printf("faults: %d %d\n", servo_axis_faulted(0), servo_axis_faulted(1));
    printf("instructions per sample and axis: %.0f\n", 40.0 * spent / SAMPLES / SERVO_AXES);
    return 0;
}
