// SPDX-License-Identifier: BSL-1.0
// Long: one loop by hand, whole: what the typed one is measured against.
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* One axis of the two-axis loop (examples/programs/quadrant_latency/loop.hpp) as one would write it by hand: doubles,
 * SI, one struct, one function. The same arithmetic in the same order, so that both can be compared bit for bit, every wire readable, and the
 * same policy: each box holds its last output, keeps its state and raises its flag when a number is not finite. Left out is what the loop
 * does not use: change of the memory's period, other exponents of the Stribeck curve, other orders of the observer.
 * The numbers of taps are constants: in C they would be macros. */

enum { xy_springs = 4, xy_capacity = 100, xy_ring = 2 * xy_capacity + 2 };

/* A window of inputs and how many sums make one, as in detail::fir_taps: four, the taps padded to a multiple of it. */
constexpr int xy_sums(int taps) { return taps < 4 ? 1 : 4; }
constexpr int xy_window(int taps) { return (taps + xy_sums(taps) - 1) / xy_sums(taps) * xy_sums(taps); }

template <int LearningTaps, int SmoothingTaps> struct xy_parameters {
    double period, position_gain, velocity_gain, velocity_integral, estimator_corner;
    double notch_centre, notch_damping, plant_gain, plant_pole, limit, dac_step;
    double coulomb, static_level, stribeck_velocity, viscous, attraction;
    double forces[xy_springs], stiffness[xy_springs];
    double corner;
    double cycle, weights[2], learning[LearningTaps], smoothing[SmoothingTaps];
    int ahead;
};

/* The last good output of a box and its flag. */
struct xy_held {
    double last;
    bool fault;
};
struct xy_estimator {
    double y, v;
    struct xy_held out;
};
struct xy_notch {
    double ahead, band, input;
    struct xy_held out;
};

template <int LearningTaps, int SmoothingTaps> struct xy_axis {
    /* designed once */
    double lose, take, g, damping, brake, thrust, position_gain, velocity_gain, per_sample, inertia_gain,
        drag_gain, limit, dac_step, rate;
    double coulomb, excess, stribeck_velocity, viscous, attraction_step, share[xy_springs],
        stiffness_step[xy_springs];
    double from_z0, from_z1, from_z2, from_u0, from_u1, from_u2, feedback1, feedback2, solved, from_more0,
        from_more1;
    double weight[2][4], learning[xy_window(LearningTaps)],
        smoothing[xy_window(SmoothingTaps)]; /* newest last */
    size_t oldest[2], ahead;
    /* state */
    struct xy_estimator reference_velocity, measured_velocity;
    struct xy_notch reference_notch, measured_notch;
    double integral, travel_x, force[xy_springs], d0, d1, d_measured, d_command;
    bool slips[xy_springs], stepped;
    double m[2 * xy_window(SmoothingTaps)], p[xy_ring + 3], r[2 * xy_window(LearningTaps)]; /* without a wrap */
    size_t next_m, next_p, next_r;
    /* last outputs, flags */
    struct xy_held memory, position_loop, velocity_loop, inertia, drag, disturbance, travel, friction,
        amplifier, dac;
    bool integral_limited, clipped, fault;
    /* wires */
    double reference, measured, error, learned, rate_wanted, rate_measured, demand, velocity_error, feedback,
        inertia_part, drag_part, linear, disturbing, compensated, speed, rubbing, wanted, limited, command;
};

static inline bool xy_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}
/* What has died out becomes zero, so that an axis at rest computes with no subnormal numbers. */
static inline bool xy_tiny(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7800000000000000u) == 0; /* below 2^-895 */
}
static inline double xy_hold(struct xy_held* out) {
    out->fault = true;
    return out->last;
}
static inline double xy_kept(struct xy_held* out, double y) {
    if (!xy_finite(y)) return xy_hold(out);
    out->last = y;
    return y;
}
static inline size_t xy_forward(size_t at, size_t size) { return at + 1 == size ? 0 : at + 1; }

static inline double xy_estimate(struct xy_estimator* e, double lose, double take, double y) {
    double v = e->v + (take * (y - e->y) - lose * e->v);
    if (!xy_finite(v)) return xy_hold(&e->out);
    if (xy_tiny(v)) v = 0;
    e->y = y;
    e->v = v;
    e->out.last = v;
    return v;
}

template <class Axis> inline double xy_notched(const Axis* a, struct xy_notch* n, double x) {
    const double ahead = n->ahead + (x - n->input);
    const double half = a->thrust * (ahead - a->brake * n->band), middle = n->band + half;
    const double rise = a->g * middle, y = x - a->damping * middle;
    double left = ahead - (rise + rise), band = middle + half;
    if (!xy_finite(y + (left + band))) return xy_hold(&n->out);
    if (xy_tiny(left) && xy_tiny(band)) left = band = 0;
    n->ahead = left;
    n->band = band;
    n->input = x;
    n->out.last = y;
    return y;
}

template <int Taps> inline double xy_fir(const double* c, const double* x) {
    double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    if (xy_sums(Taps) == 1) {
        for (int i = 0; i < Taps; ++i) s0 += c[i] * x[i];
        return s0;
    }
    for (int i = 0; i < xy_window(Taps); i += 4) {
        s0 += c[i] * x[i];
        s1 += c[i + 1] * x[i + 1];
        s2 += c[i + 2] * x[i + 2];
        s3 += c[i + 3] * x[i + 3];
    }
    return (s0 + s2) + (s1 + s3);
}

template <int LearningTaps, int SmoothingTaps>
inline double xy_remember(struct xy_axis<LearningTaps, SmoothingTaps>* a, double e) {
    enum { size_m = xy_window(SmoothingTaps), size_r = xy_window(LearningTaps) };
    double early = 0;
    for (int i = 0; i < 2; ++i) {
        const size_t by = a->oldest[i];
        const double* at = &a->p[a->next_p >= by ? a->next_p - by : a->next_p + xy_ring - by];
        for (int j = 0; j < 4; ++j) early += a->weight[i][j] * at[3 - j];
    }
    a->r[a->next_r] = a->r[a->next_r + size_r] = early;
    const double m = e + a->r[a->next_r + size_r - a->ahead];
    a->m[a->next_m] = a->m[a->next_m + size_m] = m;
    const double p = xy_fir<SmoothingTaps>(a->smoothing, &a->m[a->next_m + 1]);
    const double y = xy_fir<LearningTaps>(a->learning, &a->r[a->next_r + 1]);
    if (!xy_finite(early + (m + (p + y)))) return xy_hold(&a->memory);
    const double kept = xy_tiny(p) ? 0 : p;
    a->p[a->next_p] = kept;
    if (a->next_p < 3) a->p[a->next_p + xy_ring] = kept;
    a->next_m = xy_forward(a->next_m, size_m);
    a->next_p = xy_forward(a->next_p, xy_ring);
    a->next_r = xy_forward(a->next_r, size_r);
    a->memory.last = y;
    return y;
}

template <class Axis> inline double xy_observe(Axis* a, double measured) {
    const double x = measured - a->d_measured;
    const double unforced = a->d0 + a->from_z0 * x;
    const double d = a->solved * (unforced - a->from_u0 * a->linear), u = a->linear - d;
    double d0 = a->d0 + (a->from_z1 * x - a->from_u1 * u - a->feedback1 * d + a->d1);
    double d1 = a->d1 + (a->from_z2 * x - a->from_u2 * u - a->feedback2 * d);
    a->stepped = xy_finite(measured + (d + u)) && xy_finite(d0) && xy_finite(d1);
    if (!a->stepped) return xy_hold(&a->disturbance);
    if (xy_tiny(d) && xy_tiny(u) && xy_tiny(x) && xy_tiny(d0) && xy_tiny(d1)) d0 = d1 = 0;
    a->d0 = d0;
    a->d1 = d1;
    a->d_measured = measured;
    a->d_command = u;
    a->disturbance.last = d;
    return d;
}

template <class Axis> inline void xy_applied(Axis* a, double u) {
    if (!a->stepped) return;
    const double more = u - a->d_command, d = a->disturbance.last - a->from_u0 * more;
    const double d0 = a->d0 + a->from_more0 * more;
    const double d1 = a->d1 + a->from_more1 * more;
    if (!(xy_finite(u + d) && xy_finite(d0) && xy_finite(d1))) {
        a->disturbance.fault = true;
        return;
    }
    a->d0 = d0;
    a->d1 = d1;
    a->d_command = u;
    a->disturbance.last = d;
}

template <class Axis> inline double xy_rub(Axis* a, double v) {
    const bool forward = v >= 0, moves = v != 0;
    const double speed = forward ? v : -v;
    const double level = a->coulomb + a->excess * exp(-fabs(v / a->stribeck_velocity));
    const double kept = exp(-(a->attraction_step / level));
    double y = a->viscous * v, force[xy_springs];
    bool slips[xy_springs];

    for (int i = 0; i < xy_springs; ++i) {
        const double along = forward ? a->force[i] : -a->force[i];
        const double share = a->share[i] * level, reached = along + a->stiffness_step[i] * speed;
        if (moves && a->slips[i] && along > 0) {
            force[i] = share + (along - share) * kept;
            slips[i] = true;
        } else if (!moves || reached < share) {
            force[i] = reached;
            slips[i] = false;
        } else {
            force[i] = share + (along > share ? along - share : 0) * kept;
            slips[i] = true;
        }
        if (!forward) force[i] = -force[i];
        y += force[i];
    }
    if (!xy_finite(v + y)) return xy_hold(&a->friction);
    memcpy(a->force, force, sizeof force);
    memcpy(a->slips, slips, sizeof slips);
    a->friction.last = y;
    return y;
}

struct xy_motion {
    double position, velocity, acceleration, measured;
};

/* Below 2^199 in sum: places, speeds and accelerations of a machine. A NaN is not. */
static inline bool xy_sensible(const struct xy_motion* x, const struct xy_motion* y) {
    const double sum = ((fabs(x->position) + (fabs(x->velocity) + fabs(x->acceleration))) +
                        (fabs(y->position) + (fabs(y->velocity) + fabs(y->acceleration)))) +
                       (fabs(x->measured) + fabs(y->measured));
    const double most = 0x1p199;
    uint64_t bits, limit;
    memcpy(&bits, &sum, sizeof bits);
    memcpy(&limit, &most, sizeof limit);
    return bits < limit;
}

template <int LearningTaps, int SmoothingTaps>
inline double xy_step(struct xy_axis<LearningTaps, SmoothingTaps>* a, const struct xy_motion* in) {
    double y;

    if (!xy_finite(in->position + (in->position + (in->velocity + (in->acceleration + in->measured))))) {
        a->fault = true;
        return a->command;
    }
    a->reference = in->position;
    a->measured = in->measured;
    a->rate_wanted =
        xy_notched(a, &a->reference_notch, xy_estimate(&a->reference_velocity, a->lose, a->take, in->position));
    a->rate_measured =
        xy_notched(a, &a->measured_notch, xy_estimate(&a->measured_velocity, a->lose, a->take, in->measured));
    a->error = in->position - in->measured;
    a->learned = xy_remember(a, a->error);
    a->demand = xy_kept(&a->position_loop, a->position_gain * (a->error + a->learned)) + a->rate_wanted;
    a->velocity_error = a->demand - a->rate_measured;

    {
        const double part = a->velocity_gain * a->velocity_error;
        const double open = a->integral + a->per_sample * a->velocity_error;
        const double integral = open > a->limit ? a->limit : open < -a->limit ? -a->limit : open;
        y = part + integral;
        if (xy_finite(y + integral)) {
            a->integral_limited = integral != open;
            a->integral = integral;
            a->velocity_loop.last = y;
        } else
            y = xy_hold(&a->velocity_loop);
    }
    a->feedback = y;

    a->inertia_part = xy_kept(&a->inertia, a->inertia_gain * in->acceleration);
    a->drag_part = xy_kept(&a->drag, a->drag_gain * in->velocity);
    a->linear = a->feedback + a->inertia_part + a->drag_part;
    a->disturbing = xy_observe(a, in->measured);
    a->compensated = a->linear - a->disturbing;

    y = a->rate * (in->position - a->travel_x);
    if (xy_finite(y)) {
        a->travel_x = in->position;
        a->travel.last = y;
    } else
        y = xy_hold(&a->travel);
    a->speed = y;
    a->rubbing = xy_rub(a, a->speed);
    a->wanted = a->compensated + a->rubbing;

    if (xy_finite(a->wanted)) {
        y = a->wanted > a->limit ? a->limit : a->wanted < -a->limit ? -a->limit : a->wanted;
        a->clipped = a->wanted > a->limit || a->wanted < -a->limit;
        a->amplifier.last = y;
    } else
        y = xy_hold(&a->amplifier);
    a->limited = y;

    y = a->dac_step > 0 ? round(a->limited / a->dac_step) * a->dac_step : a->limited;
    if (xy_finite(a->limited + y))
        a->dac.last = y;
    else
        y = xy_hold(&a->dac);
    a->command = y;
    xy_applied(a, a->compensated + (a->command - a->wanted));
    return a->command;
}

template <int LearningTaps, int SmoothingTaps>
inline bool xy_faulted(const struct xy_axis<LearningTaps, SmoothingTaps>* a) {
    return a->fault || a->reference_velocity.out.fault || a->measured_velocity.out.fault ||
           a->reference_notch.out.fault || a->measured_notch.out.fault || a->memory.fault ||
           a->position_loop.fault || a->velocity_loop.fault || a->inertia.fault || a->drag.fault ||
           a->disturbance.fault || a->travel.fault || a->friction.fault || a->amplifier.fault || a->dac.fault;
}

template <int LearningTaps, int SmoothingTaps>
inline void xy_design(const struct xy_parameters<LearningTaps, SmoothingTaps>* p,
                      struct xy_axis<LearningTaps, SmoothingTaps>* a) {
    const double pi = 3.141592653589793238462643383279502884, h = p->period;
    const double we = 2 * pi * p->estimator_corner, wt = we * h;
    const double t = tan(pi * h * p->notch_centre);
    const double wc = 2 * pi * p->corner, k = 2 / h, low = wc * wc * p->plant_gain;
    double sum = 0;

    memset((void*)a, 0, sizeof *a);
    a->lose = 2 * wt / (2 + wt);
    a->take = 2 * we / (2 + wt);
    a->g = t;
    a->damping = p->notch_damping;
    a->brake = t + p->notch_damping;
    a->thrust = t / (1 + t * (t + p->notch_damping));
    a->position_gain = p->position_gain;
    a->velocity_gain = p->velocity_gain;
    a->per_sample = p->velocity_integral * h;
    a->inertia_gain = 1 / p->plant_gain;
    a->drag_gain = p->plant_pole / p->plant_gain;
    a->limit = p->limit;
    a->dac_step = p->dac_step;
    a->rate = 1 / h;

    a->coulomb = p->coulomb;
    a->excess = p->static_level - p->coulomb;
    a->stribeck_velocity = p->stribeck_velocity;
    a->viscous = p->viscous;
    a->attraction_step = p->attraction * h;
    for (int i = 0; i < xy_springs; ++i) sum += p->forces[i];
    for (int i = 0; i < xy_springs; ++i) {
        a->share[i] = p->forces[i] / sum;
        a->stiffness_step[i] = p->stiffness[i] * h;
    }

    { /* (s + wc)^2 B over k^2 (D + 2)^2, s = k D/(D + 2), D = z - 1; z enters by its differences, (D + 1) D/(D + 2) */
        const double c0 = low * pow(k, -2), c1 = (wc + wc) * p->plant_gain * pow(k, -1), c2 = p->plant_gain;
        const double under0 = c0 + c1 + c2, i1 = wc * wc * p->plant_pole * pow(k, -1), i2 = wc * wc;
        a->from_z0 = (i1 + i2) / under0;
        a->from_z1 = (3 * i1 + i2) / under0;
        a->from_z2 = 2 * i1 / under0;
        a->from_u0 = c0 / under0;
        a->from_u1 = 4 * c0 / under0;
        a->from_u2 = 4 * c0 / under0;
        a->feedback1 = (4 * c0 + 2 * c1) / under0;
        a->feedback2 = 4 * c0 / under0;
        a->from_more0 = a->feedback1 * a->from_u0 - a->from_u1;
        a->from_more1 = a->feedback2 * a->from_u0 - a->from_u2;
        a->solved = 1 / (1 - a->from_u0);
    }

    for (int i = 0; i < LearningTaps; ++i) a->learning[xy_window(LearningTaps) - 1 - i] = p->learning[i];
    for (int i = 0; i < SmoothingTaps; ++i) a->smoothing[xy_window(SmoothingTaps) - 1 - i] = p->smoothing[i];
    a->ahead = (size_t)p->ahead;
    for (int i = 0; i < 2; ++i) {
        const double delay = (i + 1) * (p->cycle / h), whole = floor(delay), u = delay - whole;
        const double left = 1 + u, right = 1 - u, far = 2 - u, half = 1.0 / 2, sixth = 1.0 / 6;
        a->oldest[i] = (size_t)whole - a->ahead - SmoothingTaps / 2 + 2;
        a->weight[i][0] = p->weights[i] * -(u * right * far * sixth);
        a->weight[i][1] = p->weights[i] * (left * right * far * half);
        a->weight[i][2] = p->weights[i] * (left * u * far * half);
        a->weight[i][3] = p->weights[i] * -(left * u * right * sixth);
    }
}
