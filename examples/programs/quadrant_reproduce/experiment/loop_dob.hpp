// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop_figures.hpp"

#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/q_design.hpp>

namespace thesis {

/// The loop around a plant with the disturbance observer of eqs. (4.6), (4.16): Q of order 2, Gn the axis
/// without delay.
template <analysis::frequency_response Plant> auto loop_with_observer(const Plant& plant, const axis& a) {
    const analysis::q_model<2, 0> q{a.corner};
    analysis::rigid_axis_model<> nominal = model_of(a);
    nominal.delay = 0_s;
    return analysis::p_pi_dob_loop{loop_around(plant, a), q, analysis::q_inverse_model{q, nominal}};
}

/// thesis.loop_dob: margins and bandwidths with the observer, and up to where it helps.
struct loop_dob {
    loop_figures figures;
    analysis::observer_limits limits; ///< against the same loop without observer
};
template <analysis::frequency_response Plant> loop_dob with_observer(const Plant& plant, const axis& a) {
    const auto loop = loop_with_observer(plant, a);
    return {figures_of(loop, a.kf), analysis::limits(loop, servo)};
}
inline loop_dob with_observer(const axis& a) { return with_observer(model_of(a), a); }

/// The rule |Q| <= 1/|Delta|, eq. (4.19), up to 900 Hz: what the thesis' Q leaves of it on a plant, and how far
/// it could go.
struct q_allowed {
    analysis::q_verdict of_thesis; ///< largest |Q Delta| with its corner; above 1 the rule is broken
    frequency highest;             ///< corner of Q with |Q Delta| = 1
    frequency binding;             ///< where that touches
};
template <analysis::frequency_response Plant> q_allowed q_on(const Plant& plant, const axis& a) {
    using box = disturbance_observer<signal::voltage>;
    const quadrant::axis_model<signal::voltage> nominal{a.B, a.A};
    const auto frf = analysis::as_measured(plant, servo);
    const analysis::q_rule rule{.margin = 1, .from = servo.from, .to = servo.to};
    const auto best = analysis::design_q<box>(frf, nominal, period, rule);
    return {analysis::q_mismatch(box({a.corner, nominal}, period), frf, rule), best.parameters.corner,
            best.binding};
}

} // namespace thesis
