// SPDX-License-Identifier: BSL-1.0
// Long: one loop by hand, whole: what the typed one is measured against.
#pragma once
#include <math.h>
#include <stdint.h>
#include <string.h>

/* The axis loop of axis_loop.hpp as one would write it by hand: doubles, SI, one struct, one function for the controller
 * and one for the machine. The same arithmetic in the same order, so that both can be compared bit for bit.
 * Checked: each box holds its last output, keeps its state and raises its flag when a number is not finite, as the blocks
 * do. Not checked: without that policy, to see what it costs. */

enum { hand_capacity = 4 }; /* commands that the machine remembers */

struct hand_parameters {
    double period;
    double position_gain, velocity_feedforward, velocity_gain, velocity_integral, estimator_corner;
    double acceleration_feedforward, viscous_feedforward, coulomb_feedforward;
    double notch_frequency, notch_damping, limit, dac_step;
    double mass, force_constant, viscous, coulomb, delay, drive_limit, encoder_step;
    int substeps;
};

struct hand_controller {
    /* designed once */
    double rate, lose, take, position_gain, velocity_feedforward, velocity_gain, integral_per_sample;
    double notch_g, notch_damping, notch_brake, notch_thrust;
    double acceleration_feedforward, viscous_feedforward, coulomb_feedforward, limit, dac_step;
    /* state */
    double reference_x, reference_v, measured_y, measured_v, integral, notch_ahead, band, notch_input;
    /* last good output of each box, and its flags */
    double reference_velocity_last, reference_acceleration_last, measured_velocity_last, position_loop_last;
    double velocity_feedforward_last, velocity_loop_last, notch_last, inertia_last, friction_last, limiter_last, dac_last;
    bool reference_velocity_fault, reference_acceleration_fault, measured_velocity_fault, position_loop_fault;
    bool velocity_feedforward_fault, velocity_loop_fault, notch_fault, inertia_fault, friction_fault, limiter_fault,
        dac_fault, fault;
    bool integral_limited, limited;
    /* wires */
    double reference, measured, position_error, reference_velocity, measured_velocity, demand, velocity_error;
    double reference_acceleration, feedback, damped, inertia, friction, wanted, clipped, command;
};

struct hand_machine {
    /* designed once */
    double mass, force_constant, viscous, coulomb, limit, dac_step, encoder_step, h, fraction;
    size_t whole;
    int substeps;
    /* state */
    double x, v, past[hand_capacity + 1];
    double last;
    bool fault, limited;
};

inline void hand_design(const struct hand_parameters* p, struct hand_controller* c, struct hand_machine* m) {
    const double pi = 3.141592653589793238462643383279502884;
    const double wc = 2 * pi * p->estimator_corner, wt = wc * p->period;
    const double t = tan(pi * p->period * p->notch_frequency);
    const double periods = p->delay / p->period;

    memset(c, 0, sizeof *c);
    c->rate = 1 / p->period;
    c->lose = 2 * wt / (2 + wt);
    c->take = 2 * wc / (2 + wt);
    c->position_gain = p->position_gain;
    c->velocity_feedforward = p->velocity_feedforward;
    c->velocity_gain = p->velocity_gain;
    c->integral_per_sample = p->velocity_integral * p->period;
    c->notch_g = t;
    c->notch_damping = p->notch_damping;
    c->notch_brake = t + p->notch_damping;
    c->notch_thrust = t / (1 + t * (t + p->notch_damping));
    c->acceleration_feedforward = p->acceleration_feedforward;
    c->viscous_feedforward = p->viscous_feedforward;
    c->coulomb_feedforward = p->coulomb_feedforward;
    c->limit = p->limit;
    c->dac_step = p->dac_step;

    memset(m, 0, sizeof *m);
    m->mass = p->mass;
    m->force_constant = p->force_constant;
    m->viscous = p->viscous;
    m->coulomb = p->coulomb;
    m->limit = p->drive_limit;
    m->encoder_step = p->encoder_step;
    m->h = p->period / p->substeps;
    m->whole = (size_t)periods;
    m->fraction = periods - (double)m->whole;
    m->substeps = p->substeps;
}

inline bool hand_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}

/* What has died out becomes zero, so that an axis at rest computes with no subnormal numbers. */
inline bool hand_tiny(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7800000000000000u) == 0; /* below 2^-895 */
}

inline double hand_rounded(double x, double step) { return step > 0 ? round(x / step) * step : x; }

/* What a box without state does with its output. */
template <bool Checked> inline double hand_kept(bool good, double y, double* last, bool* fault) {
    if (!Checked) return y;
    if (!good) {
        *fault = true;
        return *last;
    }
    *last = y;
    return y;
}

template <bool Checked>
inline double hand_control(struct hand_controller* c, double reference, double measured) {
    double y;

    if (Checked && !hand_finite(reference + measured)) {
        c->fault = true;
        return c->command;
    }
    c->reference = reference;
    c->measured = measured;

    y = c->rate * (reference - c->reference_x);
    if (Checked && !hand_finite(y)) {
        c->reference_velocity_fault = true;
        y = c->reference_velocity_last;
    } else {
        c->reference_x = reference;
        if (Checked) c->reference_velocity_last = y;
    }
    c->reference_velocity = y;

    y = c->rate * (c->reference_velocity - c->reference_v);
    if (Checked && !hand_finite(y)) {
        c->reference_acceleration_fault = true;
        y = c->reference_acceleration_last;
    } else {
        c->reference_v = c->reference_velocity;
        if (Checked) c->reference_acceleration_last = y;
    }
    c->reference_acceleration = y;

    y = c->measured_v + (c->take * (measured - c->measured_y) - c->lose * c->measured_v);
    if (Checked && !hand_finite(y)) {
        c->measured_velocity_fault = true;
        y = c->measured_velocity_last;
    } else {
        if (Checked && hand_tiny(y)) y = 0;
        c->measured_y = measured;
        c->measured_v = y;
        if (Checked) c->measured_velocity_last = y;
    }
    c->measured_velocity = y;

    c->position_error = reference - measured;
    y = c->position_gain * c->position_error;
    const double proportional = hand_kept<Checked>(hand_finite(y), y, &c->position_loop_last, &c->position_loop_fault);
    y = c->velocity_feedforward * c->reference_velocity;
    c->demand = proportional + hand_kept<Checked>(hand_finite(y), y, &c->velocity_feedforward_last,
                                                  &c->velocity_feedforward_fault);
    c->velocity_error = c->demand - c->measured_velocity;

    {
        const double part = c->velocity_gain * c->velocity_error;
        const double open = c->integral + c->integral_per_sample * c->velocity_error;
        const double integral = open > c->limit ? c->limit : open < -c->limit ? -c->limit : open;
        y = part + integral;
        if (Checked && !hand_finite(y + integral)) {
            c->velocity_loop_fault = true;
            y = c->velocity_loop_last;
        } else {
            c->integral_limited = integral != open;
            c->integral = integral;
            if (Checked) c->velocity_loop_last = y;
        }
    }
    c->feedback = y;

    {
        const double x = c->feedback, ahead = c->notch_ahead + (x - c->notch_input);
        const double half = c->notch_thrust * (ahead - c->notch_brake * c->band), middle = c->band + half;
        const double rise = c->notch_g * middle;
        double left = ahead - (rise + rise), band = middle + half;
        y = x - c->notch_damping * middle;
        if (Checked && !hand_finite(y + (left + band))) {
            c->notch_fault = true;
            y = c->notch_last;
        } else {
            if (Checked && hand_tiny(left) && hand_tiny(band)) left = band = 0;
            c->notch_ahead = left;
            c->band = band;
            c->notch_input = x;
            if (Checked) c->notch_last = y;
        }
    }
    c->damped = y;

    y = c->acceleration_feedforward * c->reference_acceleration;
    c->inertia = hand_kept<Checked>(hand_finite(y), y, &c->inertia_last, &c->inertia_fault);
    y = (c->reference_velocity > 0   ? c->coulomb_feedforward
         : c->reference_velocity < 0 ? -c->coulomb_feedforward
                                     : 0) +
        c->viscous_feedforward * c->reference_velocity;
    c->friction = hand_kept<Checked>(hand_finite(y), y, &c->friction_last, &c->friction_fault);
    c->wanted = c->damped + c->inertia + c->friction;

    y = c->wanted > c->limit ? c->limit : c->wanted < -c->limit ? -c->limit : c->wanted;
    if (Checked && !hand_finite(c->wanted)) {
        c->limiter_fault = true;
        y = c->limiter_last;
    } else {
        c->limited = c->wanted > c->limit || c->wanted < -c->limit;
        if (Checked) c->limiter_last = y;
    }
    c->clipped = y;

    y = hand_rounded(c->clipped, c->dac_step);
    c->command = hand_kept<Checked>(hand_finite(c->clipped + y), y, &c->dac_last, &c->dac_fault);
    return c->command;
}

inline bool hand_faulted(const struct hand_controller* c) {
    return c->fault || c->reference_velocity_fault || c->reference_acceleration_fault || c->measured_velocity_fault ||
           c->position_loop_fault || c->velocity_feedforward_fault || c->velocity_loop_fault || c->notch_fault ||
           c->inertia_fault || c->friction_fault || c->limiter_fault || c->dac_fault;
}

template <bool Checked> inline double hand_move(struct hand_machine* m, double u) {
    const double external = 0; /* newtons; the block has it as an argument */
    const bool beyond = m->limit > 0 && (u > m->limit || u < -m->limit);
    m->past[0] = hand_rounded(beyond ? (u > 0 ? m->limit : -m->limit) : u, m->dac_step);
    const double newer = m->past[m->whole], older = m->past[m->whole + 1];
    double x = m->x, v = m->v;

    for (int i = 0; i < m->substeps; ++i) {
        const double late = m->fraction * m->substeps - i;
        const double share = late < 0 ? 1 : late >= 1 ? 0 : 1 - late;
        const double acting = newer * share + older * (1 - share);
        const double push = m->mass * v / m->h + (m->force_constant * acting + external);
        const double slope = m->mass / m->h + m->viscous;
        const bool forward = push > 0;
        const double size = forward ? push : -push;
        double next = 0;
        if (size > m->coulomb) next = forward ? (size - m->coulomb) / slope : -((size - m->coulomb) / slope);
        x += (v + next) * (m->h * 0.5);
        v = next;
    }

    const double reading = hand_rounded(x, m->encoder_step);
    if (Checked && !hand_finite(u + external + reading)) {
        m->past[0] = m->past[1];
        m->fault = true;
        return m->last;
    }
    m->x = x;
    m->v = Checked && hand_tiny(v) ? 0 : v;
    for (int i = hand_capacity; i > 0; --i) m->past[i] = m->past[i - 1];
    m->limited = beyond;
    if (Checked) m->last = reading;
    return reading;
}
