// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../observer/disturbance_observer.hpp"
#include "frf.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// How a Q filter is judged against a measured axis.
struct q_rule {
    double margin = 0.5;          ///< largest |Q Delta|; 0 ... 1, 1 is the bound itself
    frequency from, to;           ///< lines of the FRF that count
    double least_coherence = 0.8; ///< lines below are left out, and reported
    double deviations = 2;        ///< of the lines' spread, added to |Delta|; >= 0
};
/// How near a Q filter comes to the bound 1/|Delta| of the axis that was measured, and on which lines that was
/// judged.
struct q_verdict {
    double worst = 0; ///< largest |Q| (|Delta| with the deviations of its spread)
    frequency at{};   ///< where
    std::size_t lines = 0;
    std::vector<frequency> left_out{}; ///< lines with too little coherence: nothing is known there
    double beyond = 0;                 ///< |Q| at the last line: what could still break the rule above it
};

namespace detail {
inline void require_rule(const q_rule& r) {
    require(r.margin > 0 && r.margin <= 1, "q_rule.margin", r.margin, "must lie between 0 and 1");
    require_not_negative("q_rule.from", r.from);
    require(std::isfinite(r.to.value()) && r.to > r.from, "q_rule.to", r.to,
            "must be finite and above q_rule.from (" + quadrant::detail::shortest(r.from) + ")");
    require_not_negative("q_rule.deviations", r.deviations);
}
/// The lines that count.
inline std::vector<measured_frf::line> judged(const measured_frf& frf, const q_rule& rule,
                                              std::vector<frequency>& left_out) {
    require_rule(rule);
    std::vector<measured_frf::line> out;
    for (const auto& line : frf.lines) {
        if (line.f < rule.from || line.f > rule.to) continue;
        if (line.coherence >= rule.least_coherence && std::isfinite(line.spread))
            out.push_back(line);
        else
            left_out.push_back(line.f);
    }
    require(out.size() >= 2, "q_rule.lines", double(out.size()),
            "must be two or more between q_rule.from and .to with enough coherence");
    return out;
}
/// Q Delta = G Q/Gn - Q with both as they run.
template <class Observer>
q_verdict judge(const Observer& observer, const std::vector<measured_frf::line>& lines, double deviations) {
    q_verdict out{.lines = lines.size()};
    for (const auto& line : lines) {
        const complex q = observer.q(line.f), through = line.value * observer.inverse(line.f);
        const double now = std::abs(through - q) + deviations * line.spread * std::abs(through);
        require(std::isfinite(now), "q_rule, response at f", line.f, "must be finite");
        if (now > out.worst) out.worst = now, out.at = line.f;
    }
    out.beyond = std::abs(observer.q(lines.back().f));
    return out;
}
} // namespace detail

/// A model as an FRF without noise, for what takes a measured one.
template <frequency_response R> measured_frf as_measured(const R& response, const band& b) {
    measured_frf out{{}, 1};
    for (const frequency& f : grid(b)) out.lines.push_back({f, complex(response(f)), 1, 0});
    return out;
}

/// |Q Delta| of an observer on a measured axis, not judged. [Jamaludin2008] (4.19); Q and 1/Gn sampled, as the
/// block runs them.
template <class Observer>
q_verdict q_mismatch(const Observer& observer, const measured_frf& frf, const q_rule& rule) {
    std::vector<frequency> left_out;
    q_verdict out = detail::judge(observer, detail::judged(frf, rule, left_out), rule.deviations);
    out.left_out = std::move(left_out);
    return out;
}

/// Refuses an observer whose |Q| exceeds margin/|Delta| anywhere, Delta = (G - Gn)/Gn: with margin 1 the loop
/// of observer and axis is robustly stable (sufficient, not necessary).
template <class Observer>
q_verdict check_q(const Observer& observer, const measured_frf& frf, const q_rule& rule) {
    q_verdict out = q_mismatch(observer, frf, rule);
    require(out.worst <= rule.margin, "check_q: largest |Q Delta|", out.worst,
            "must not be above q_rule.margin (" + quadrant::detail::shortest(rule.margin) + "), is at " +
                quadrant::detail::shortest(out.at.value()) +
                " Hz: lower disturbance_observer.corner or correct the nominal plant");
    return out;
}

/// Parameters of an observer with the highest corner that the rule allows, all lower corners allowed too.
template <class Observer> struct q_design {
    typename Observer::parameters parameters;
    q_verdict verdict;
    frequency binding{}; ///< the line that stops a higher corner; 0: none up to half the sampling rate
};
/// Limits: lines left out and frequencies outside [from, to] are not judged (`left_out`, `beyond`); the rule is
/// about the loop of observer and axis by itself, the cascade around it needs its own margins
/// (`p_pi_dob_loop`). A nominal plant without
/// delay against a sampled axis: the hold counts as mismatch, as it must.
/// Throws "design_q.corner" when even a corner at the first line breaks the rule: lower ones the lines do not
/// show.
template <class Observer>
q_design<Observer> design_q(const measured_frf& frf, const decltype(Observer::parameters::plant)& plant,
                            duration period, const q_rule& rule) {
    require_positive("design_q.period", period);
    std::vector<frequency> left_out;
    const auto lines = detail::judged(frf, rule, left_out);
    const auto with = [&](double corner) {
        return detail::judge(Observer({hertz(corner), plant}, period), lines, rule.deviations);
    };
    const auto holds = [&](double corner) { return with(corner).worst <= rule.margin; };
    const double highest = 0.49 / period.value();
    double good = lines.front().f.value(), bad = good;
    require(good < highest && holds(good), "design_q.corner", good,
            "must leave |Q Delta| below q_rule.margin (" + quadrant::detail::shortest(rule.margin) +
                "): the nominal plant does not fit the axis, or begin lower");
    while (bad < highest && holds(bad)) good = bad, bad = std::min(1.02 * bad, highest);
    if (holds(bad)) good = bad;
    for (int i = 0; i < 40 && good < bad; ++i) {
        const double middle = 0.5 * (good + bad);
        (holds(middle) ? good : bad) = middle;
    }
    q_design<Observer> out{{hertz(good), plant}, with(good)};
    out.verdict.left_out = std::move(left_out);
    if (good < bad) out.binding = with(bad).at;
    return out;
}

} // namespace quadrant::inline v0::analysis
