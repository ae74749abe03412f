// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop.hpp"
#include "nyquist.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

namespace quadrant::inline v0::analysis {

/// What an open loop has to keep from -1.
struct wanted_margins {
    double gain = 6;      ///< dB, up and (where the loop is conditionally stable) down; > 0
    double phase = 45;    ///< degrees, either way; 0 ... 180
    double modulus = 0.5; ///< min |1 + L| = 1/max |S|; 0 ... 1
};
/// What stops a gain from being higher.
enum class gain_limit { gain_margin, phase_margin, modulus_margin, stability, band };
/// In words, for a message.
constexpr const char* text(gain_limit l) {
    switch (l) {
    case gain_limit::gain_margin:
        return "gain margin";
    case gain_limit::phase_margin:
        return "phase margin";
    case gain_limit::modulus_margin:
        return "modulus margin";
    case gain_limit::stability:
        return "stability";
    case gain_limit::band:
        break;
    }
    return "crossover within the band";
}

/// What both loops have to keep, and what of their phase the integral may take.
struct gain_design_options {
    wanted_margins velocity{}, position{};
    double integral_phase = 3; ///< degrees that ki costs at the velocity crossover; 0 (no integral) ... 45
    int integrators = 1;       ///< of the plant, below the band
};

/// One loop of the design: its margins, and what binds just above its gain.
struct designed_loop {
    stability_margins margins;
    gain_limit limited_by;
    frequency at; ///< where that is
};
/// Gains of a cascade P/PI, and what each of its loops has left with them.
template <signal_tag Command = signal::voltage> struct gain_design {
    pi_model<Command> velocity;
    per_second position_gain; ///< kv [1/s]
    designed_loop velocity_loop, position_loop;
};

namespace detail {

struct too_much {
    gain_limit what;
    frequency at;
};
inline void require_wanted(const wanted_margins& w) {
    require_positive("design_gains.gain", w.gain);
    require(w.phase > 0 && w.phase < 180, "design_gains.phase", quadrant::detail::in_unit(w.phase, " degrees"),
            "must lie between 0 and 180 degrees");
    require(w.modulus > 0 && w.modulus < 1, "design_gains.modulus", w.modulus, "must lie between 0 and 1");
}
/// What the open loop breaks; `whole` is 1 + whole = 0 of the closed system, whose stability counts.
template <class Open, class Whole>
std::optional<too_much> broken(const Open& open, const Whole& whole, int integrators, const wanted_margins& w,
                               const band& b) {
    if (!(std::abs(open(b.to)) < 1) || !(std::abs(whole(b.to)) < 1)) return too_much{gain_limit::band, b.to};
    if (integrators > 0 && !(std::abs(whole(b.from)) > 1)) return too_much{gain_limit::band, b.from};
    const auto m = margins(open, b);
    if (const auto g = m.smallest_gain(); g && std::abs(g->value) < w.gain)
        return too_much{gain_limit::gain_margin, g->at};
    if (const auto p = m.smallest_phase(); p && std::abs(p->value) < w.phase)
        return too_much{gain_limit::phase_margin, p->at};
    if (m.modulus.value < w.modulus) return too_much{gain_limit::modulus_margin, m.modulus.at};
    if (unstable_poles(whole, b, integrators) > 0) return too_much{gain_limit::stability, m.modulus.at};
    return std::nullopt;
}
struct highest_gain {
    double value;
    too_much next;
};
/// The highest gain of a range with nothing broken: down in steps of half a decibel, then by bisection.
template <class Broken> highest_gain highest(const char* field, const Broken& judge, double low, double high) {
    const double step = std::pow(10.0, 0.5 / 20);
    double above = high;
    too_much last{};
    for (double gain = high; gain >= low; above = gain, gain /= step) {
        const std::optional<too_much> now = judge(gain);
        if (now) {
            last = *now;
            continue;
        }
        double good = gain, bad = above;
        for (int i = 0; i < 20 && gain < high; ++i) {
            const double middle = std::sqrt(good * bad);
            if (const auto broken_there = judge(middle))
                bad = middle, last = *broken_there;
            else
                good = middle;
        }
        return {good, last};
    }
    require(false, field, low,
            quadrant::detail::rule("no gain keeps all margins; the lowest tried still breaks: ") +
                text(last.what) + " (at " + quadrant::detail::shortest(last.at.value()) + " Hz)");
    return {};
}
} // namespace detail

/// Gains of a P/PI cascade for stated margins, from the response of its plant: first the highest velocity gain
/// kp, with ki = kp wc tan(integral_phase) where wc is the crossover of kp alone, then the highest position
/// gain kv, each with every crossing of its open loop (L_v, L_p of `p_pi_loop`) outside the wanted margins and
/// the closed loop proven stable by the count of encirclements (`unstable_poles`), not by the margins.
/// Plant in position per command, feedback in velocity per position (estimate, notch, delay): models, a
/// measured `tabulated_response` or blocks; a sampled plant with its hold goes with sampled blocks. The
/// integral is the continuous ki/s; a sampled one differs by w T/2 in the phase of its part only.
/// Limits: holds for the response given, within the band; noise of its lines is not in it, ask for more margin.
/// The axis must be stable but for `integrators`, and |L| below one above the band. The first gain limit is
/// found in steps of 0.5 dB: a window of good gains narrower than that may be missed.
/// Throws "design_gains.velocity_gain" or ".position_gain" with the margin that no gain keeps, and on bad
/// options.
template <signal_tag Command = signal::voltage, frequency_response Plant, frequency_response Feedback>
gain_design<Command> design_gains(const Plant& plant, const Feedback& feedback, const band& b,
                                  const gain_design_options& options = {}) {
    detail::require_wanted(options.velocity);
    detail::require_wanted(options.position);
    require(options.integral_phase >= 0 && options.integral_phase <= 45, "design_gains.integral_phase",
            quadrant::detail::in_unit(options.integral_phase, " degrees"), "must lie between 0 and 45 degrees");
    const double tangent = std::tan(options.integral_phase * std::numbers::pi / 180);
    const auto measured = [&](frequency f) { return complex(plant(f)) * complex(feedback(f)); };
    const auto velocity_of = [&](double kp) -> std::optional<pi_model<Command>> {
        using gain = gain_of<Command, signal::velocity>;
        using rate = gain_rate_of<Command, signal::velocity>;
        const auto crossing = rising_crossings([&](frequency f) { return 1.0 / (kp * measured(f)); }, 1, b);
        if (crossing.empty()) return std::nullopt;
        return pi_model<Command>{gain::from_value(kp),
                                 rate::from_value(kp * laplace(crossing.front()).imag() * tangent)};
    };
    double strongest = 0;
    for (const frequency& f : grid(b)) strongest = std::max(strongest, std::abs(measured(f)));
    const double weakest = std::abs(measured(b.to));
    require_positive("design_gains, response at band.to", weakest);
    // The integrator of the plant meets the zero of the velocity feedback, the integral stays.
    const int inner = options.integrators - 1 + (tangent > 0 ? 1 : 0);
    const auto found = detail::highest(
        "design_gains.velocity_gain",
        [&](double kp) -> std::optional<detail::too_much> {
            const auto velocity = velocity_of(kp);
            if (!velocity) return detail::too_much{gain_limit::band, b.from};
            const auto open = [&](frequency f) { return (*velocity)(f)*measured(f); };
            return detail::broken(open, open, inner, options.velocity, b);
        },
        1 / strongest, 1 / weakest);
    const pi_model<Command> velocity = *velocity_of(found.value);
    p_pi_loop loop{[&](frequency f) { return complex(plant(f)); }, velocity,
                   [&](frequency f) { return complex(feedback(f)); }, per_second::from_value(1)};
    const auto open_position = [&](frequency f) { return loop.open_position(f); };
    const auto whole = [&](frequency f) { return 1.0 / loop.sensitivity(f) - 1.0; };
    double most = 0;
    for (const frequency& f : grid(b)) most = std::max(most, std::abs(open_position(f)));
    const auto outer = detail::highest(
        "design_gains.position_gain",
        [&](double kv) {
            loop.position_gain = per_second::from_value(kv);
            return detail::broken(open_position, whole, options.integrators + (tangent > 0 ? 1 : 0),
                                  options.position, b);
        },
        1 / most, 1 / std::abs(open_position(b.to)));
    loop.position_gain = per_second::from_value(outer.value);
    return {velocity,
            loop.position_gain,
            {margins([&](frequency f) { return loop.open_velocity(f); }, b), found.next.what, found.next.at},
            {margins(open_position, b), outer.next.what, outer.next.at}};
}

} // namespace quadrant::inline v0::analysis
