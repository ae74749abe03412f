// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "friction.hpp"
#include "quadrant/diagnosis/text/axis_words.hpp"
#include "random.hpp"

/// Machines of the trial with two positions an axis: a motor and what it carries, or a counter and a scale.
/// Values in units of the load; a rotary axis has rad for m.
namespace quadrant_gap::trial {

/// What lies between motor and load. Written from docs/formats.md.
struct gears_truth {
    double turn = 0.01;                          ///< travel of the load for one turn of the motor, as described
    double lead = 0;                             ///< relative error of that travel
    double play = 0, stiffness = 0;              ///< stiffness 0: rigid
    double bend = 0, bend_phase = 0;             ///< smooth error: a wave longer than the travel
    double bend_line = 0, bend_mean = 0;         ///< the straight part of that wave, which belongs to the lead
    double bend_from = 0, bend_over = 1;         ///< where the travel begins, and how long it is
    wave pitch{};                                ///< repeats with a fraction of the turn
    double softer_along = 0;                     ///< growth of the compliance along the travel; in no list
    double dent = 0, dent_at = 0, dent_over = 1; ///< an error at one place; in no list

    /// The wave of the smooth error at u, 0 to 1 along the travel.
    double bent(double u) const { return std::cos(0.8 * std::numbers::pi * u + bend_phase); }
    /// With another phase, its straight part taken off.
    void bend_with(double size, double phase) {
        constexpr int places = 200;
        bend = size, bend_phase = phase, bend_mean = bend_line = 0;
        for (int i = 0; i <= places; ++i) {
            const double u = static_cast<double>(i) / places;
            bend_mean += bent(u) / (places + 1);
            bend_line += 12 * (u - 0.5) * bent(u) / (places + 1);
        }
    }
    /// Where a load without play and wind-up is while the motor is at x.
    double carried(double x) const {
        const double u = (x - bend_from) / bend_over, d = (x - dent_at) / dent_over;
        return x * (1 + lead) + bend * (bent(u) - bend_line * (u - 0.5) - bend_mean) +
               dent * std::exp(-d * d / 2) + at(pitch, x);
    }
};

/// How the motor follows what is asked, and what happens to the readings over time.
struct following_truth {
    double late = 0, lag = 0; ///< [s]
    struct jump {
        double at = 0, by = 0; ///< [s], and the load's travel that is lost
    };
    std::vector<jump> jumps{};
    double warmth = 0, warmth_time = 1; ///< the scale moves away; in no list
    double swing = 0, swing_Hz = 1;     ///< the scale's head swings; in no list

    double scale_moves(double t) const {
        return warmth * (1 - std::exp(-t / warmth_time)) +
               swing * std::sin(2 * std::numbers::pi * swing_Hz * t);
    }
};

/// Which positions a record holds.
enum class positions_recorded { counter_and_scale, asked_and_scale, all_three };

/// An axis whose readings are two positions. `motor` and `friction` matter where forces are known.
struct chain_truth {
    quadrant::diagnosis::axis_kind kind = quadrant::diagnosis::axis_kind::linear;
    gears_truth gears{};
    following_truth follows{};
    encoder_truth motor_encoder{}, scale{};
    positions_recorded recorded = positions_recorded::counter_and_scale;
    // With forces.
    double mass = 0, motor_mass = 0; ///< motor_mass: part of mass
    double force_constant = 0, constant_force = 0, delay = 0;
    friction_truth guide{}, motor_friction{};
    double position_gain = 0, velocity_gain = 0, integral = 0, filter_Hz = 0, acceleration_feedforward = 0,
           limit = 10; ///< [V]
};

/// One row a period.
struct chain_record {
    std::vector<double> reference, motor, scale, command;
    bool ran_away = false;
};

} // namespace quadrant_gap::trial
