// SPDX-License-Identifier: BSL-1.0
// The blocks behind servo_axis.h. Compiles with -fno-exceptions -fno-rtti; needs no heap, no I/O, no start-up
// code.
#include "servo_axis.h"

#include "loops.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/base/make.hpp>

#ifndef SERVO_LOOP
#    define SERVO_LOOP with_memory
#endif

using namespace quadrant;

namespace {
using chosen = loops::SERVO_LOOP<servo_number>;
using loop = milling_axis<chosen::boxes>;
made<loop> axes[SERVO_AXES]; // zeros at the start: no constructor runs
} // namespace

int servo_axis_init(int axis, const servo_tuning* t, double period_s) {
    // One at a time, and static: the parameters of a memory are too large for a small stack.
    static chosen::boxes::parameters p;
    chosen::machine(p);
    p.position_gain = in_si(t->position_gain);
    p.velocity_gain = in_si(t->velocity_gain);
    p.velocity_integral = in_si(t->velocity_integral);
    p.estimator_corner = in_si(t->estimator_corner);
    p.notch = {.centre = in_si(t->notch_centre), .width = 0.06};
    p.limit = in_si(t->limit);
    return axes[axis].make(p, in_si(period_s));
}
size_t servo_axis_why(int axis, char* text, size_t size) { return axes[axis].why().write(text, size); }

servo_number servo_axis_step(int axis, const servo_motion* r, servo_number measured) {
    return (*axes[axis])({in_si(r->position), in_si(r->velocity), in_si(r->acceleration)}, in_si(measured))
        .value();
}
int servo_axis_faulted(int axis) { return axes[axis]->faulted(); }
int servo_axis_limited(int axis) { return axes[axis]->limited(); }
void servo_axis_settle(int axis, servo_number position, servo_number hold) {
    axes[axis]->settle(in_si(position), in_si(hold));
}
