// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "estimated.hpp"
#include "fit_plant.hpp"
#include "modal_search.hpp"
#include "modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Which lines of an FRF, and how many modes.
struct modes_fit_options {
    frequency from, to;                 ///< all modes that matter inside, each with some lines on both sides
    std::optional<std::size_t> modes{}; ///< just so many; empty: as many as pay, up to `most_modes`
    std::size_t most_modes = 4;
    double least_coherence = 0.3; ///< lines below are left out; an anti-resonance has little
    duration period{}; ///< of sampling and hold, to take roll-off and aliases out; 0: a continuous response
    duration longest_delay = duration::from_value(5e-3); ///< as in `fit_plant`
};

/// Rigid axis and modes with intervals of 95 %.
template <signal_tag Command = signal::voltage> struct modes_fit {
    /// One mode beside the rigid axis, as the fit found it.
    struct mode {
        estimated<frequency> centre;
        estimated<double> damping, share; ///< of `flexible_mode`
    };
    estimated<per_second> pole;
    estimated<gain_of<signal::acceleration, Command>> gain;
    estimated<duration> delay; ///< Td, with half a period of hold
    std::vector<mode> modes;   ///< in rising frequency
    std::size_t lines;         ///< used
    double residual;           ///< rms of |ln(model/measured)|
    double surprise;           ///< as in `plant_fit`: far above 1, the model is still too small
    bool converged;
    std::vector<double>
        information; ///< Bayesian criterion with 0, 1, ... modes, as far as tried; the least is best

    flexible_axis_model<Command> model() const {
        flexible_axis_model<Command> out{{pole.value, gain.value, delay.value}, {}};
        for (const mode& m : modes) out.modes.push_back({m.centre.value, m.damping.value, m.share.value});
        return out;
    }
};

namespace detail {
/// What a search found, with intervals of 95 %.
template <signal_tag In> modes_fit<In> with_intervals(const modal_search& best, std::size_t lines, double fastest) {
    const auto variance = best.variances();
    const double wider = 1.96 * std::sqrt(std::max(1.0, best.surprise()));
    const auto spread = [&](std::size_t i) { return wider * std::sqrt(variance[i]); };
    const auto ratio = [&](std::size_t i, double unit) { // an interval of a logarithm
        return std::array{unit * std::exp(best.x[i]), unit * std::exp(best.x[i] - spread(i)),
                          unit * std::exp(best.x[i] + spread(i))};
    };
    const auto linear = [&](std::size_t i, double unit) {
        return std::array{unit * best.x[i], unit * (best.x[i] - spread(i)), unit * (best.x[i] + spread(i))};
    };
    const auto in = []<class Quantity>(const std::array<double, 3>& v, Quantity) {
        return estimated<Quantity>{Quantity::from_value(v[0]), Quantity::from_value(v[1]),
                                   Quantity::from_value(v[2])};
    };
    modes_fit<In> out{in(linear(0, fastest), per_second()),
                      in(ratio(1, 1), gain_of<signal::acceleration, In>()),
                      in(linear(2, 1 / fastest), duration()),
                      {},
                      lines,
                      best.misfit(),
                      best.surprise(),
                      best.converged,
                      {}};
    for (std::size_t i = 3; i < best.x.size(); i += 3) {
        const auto z = ratio(i + 1, 1), share = linear(i + 2, 1);
        out.modes.push_back({in(ratio(i, 1 / (2 * std::numbers::pi)), frequency()),
                             {z[0], z[1], z[2]},
                             {share[0], share[1], share[2]}});
    }
    std::sort(out.modes.begin(), out.modes.end(),
              [](const auto& a, const auto& b) { return a.centre.value < b.centre.value; });
    return out;
}
} // namespace detail

/// Fit of `flexible_axis_model` to a measured FRF: ln of model over measurement, each line weighed by its
/// spread, as `fit_plant`. Modes come one after the other, each where it takes most of the misfit away, and all
/// numbers are fitted together again. How many: given, or the least of the Bayesian criterion
/// 2n ln(mean square) + unknowns ln(2n), a mode counted as four.
/// Source: modal superposition and fit of receptances [Ewins2000] ch. 4; intervals as `fit_plant`'s.
/// Limits: one delay for all; modes nearer than their width run into each other (their intervals say so).
/// Throws as `fit_plant` does, with fewer lines than 8 + 4 for each mode, and when a mode that was asked for is
/// not determined by the lines.
template <signal_tag In = signal::voltage>
modes_fit<In> fit_modes(const measured_frf& frf, const modes_fit_options& options) {
    require_not_negative("fit_modes.period", options.period);
    std::vector<detail::modal_search::point> points;
    for (const auto& line : frf.lines)
        if (line.f >= options.from && line.f <= options.to && line.coherence >= options.least_coherence &&
            std::abs(line.value) > 0 && std::isfinite(line.spread))
            points.push_back({laplace(line.f), line.value, 1 / std::max(line.spread, 1e-6)});
    const auto rigid =
        fit_plant<In>(frf, {options.from, options.to, options.least_coherence, options.longest_delay});
    const std::size_t most = options.modes.value_or(options.most_modes);
    require(points.size() >= 8 + 4 * most, "fit_modes.lines", double(points.size()),
            "must be 8 and 4 for each mode, or more (" + quadrant::detail::shortest(double(8 + 4 * most)) +
                ")");
    const double fastest = points.back().s.imag();
    detail::modal_search now(points, options.period.value(),
                             {std::max(0.0, rigid.pole.value.value()) / fastest,
                              std::log(rigid.gain.value.value()), rigid.delay.value.value() * fastest});
    now.run();
    detail::modal_search best = now;
    std::vector<double> information{now.information()};
    // No noise and nothing left: a mode more would not be determined.
    for (std::size_t i = 0; i < most && (options.modes || now.surprise() > 1e-3); ++i) {
        now.add_mode();
        now.run();
        information.push_back(now.information());
        if (options.modes || information.back() < best.information()) best = now;
    }

    auto out = detail::with_intervals<In>(best, points.size(), fastest);
    out.information = information;
    return out;
}

} // namespace quadrant::inline v0::analysis
