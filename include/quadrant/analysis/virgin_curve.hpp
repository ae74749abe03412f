// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction/stribeck.hpp"
#include "slow_branches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Friction over the displacement from rest, springs relaxed.
struct virgin_curve {
    /// Friction force [N] after one way from rest.
    struct point {
        displacement way; ///< > 0
        quantity_of<signal::force> force;
        double systematic; ///< standard error that all branches share: encoder count, level [N]
        std::size_t run;   ///< index, by amplitude
    };
    std::vector<point> points; ///< displacement rising
    std::vector<std::vector<double>>
        branches;       ///< [branch][point]: force [N]; not a number where it was another run
    displacement count; ///< of the encoder, the least that it moved

    /// Standard error of the mean at a point, from branch to branch, and its degrees of freedom.
    std::pair<double, double> spread(std::size_t at) const {
        double n = 0, mean = 0, squares = 0;
        for (const auto& branch : branches)
            if (const double f = branch[at]; std::isfinite(f)) {
                const double off = f - mean;
                mean += off / ++n;
                squares += off * (f - mean);
            }
        return {std::sqrt(squares / (n * (n - 1))), n - 1};
    }
};

/// What else was in the force and is taken off, and how finely the curve is drawn.
struct virgin_options {
    quantity<si::mass> mass{};                          ///< its inertia is taken off; 0: not
    gain_of<signal::force, signal::velocity> viscous{}; ///< and all viscous friction
    std::optional<stribeck<>::parameters> level{};      ///< s(v) of the friction map: brings the curve to Fs
    std::size_t points = 60;                            ///< of the curve; 10 ... 400
};

namespace detail {
inline double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto above = std::lower_bound(x.begin(), x.end(), at);
    if (above == x.begin()) return y.front();
    if (above == x.end()) return y.back();
    const auto i = std::size_t(above - x.begin());
    return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}
/// The part of a force whose springs have broken away, from the slope of the virgin curve there: where the
/// tangent meets zero displacement.
inline double slipping(double force, double slope, double way) {
    return std::clamp(force - slope * way, 0.0, force);
}
/// The branches of slow runs, by amplitude, and the mean of those of one run.
struct slow_runs {
    std::vector<slow_branches> cut;
    double count = HUGE_VAL; ///< of the encoder, the least that it moved
    std::optional<stribeck<>> level;

    template <signal_tag Command>
    slow_runs(const std::vector<test_run<Command>>& runs, duration period,
              gain_of<signal::force, Command> force_constant, const virgin_options& options) {
        for (const auto& run : runs) {
            require(run.position.size() == run.command.size(), "test_run.position", double(run.position.size()),
                    "must hold as many samples as command (" +
                        quadrant::detail::shortest(double(run.command.size())) + ")");
            const double here = count_of(run.position);
            cut.push_back(cut_at_reversals(run, period.value(), force_constant.value(), options.mass.value(),
                                           options.viscous.value(), here));
            require(cut.back().way.size() >= 3, "find_virgin_curve.branches", double(cut.back().way.size()),
                    "must be 3 or more after the run in: record another cycle");
            count = std::min(count, here);
        }
        std::sort(cut.begin(), cut.end(),
                  [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
        if (options.level) level.emplace(*options.level, period);
    }
    double mean_of(std::size_t r, const std::vector<std::vector<double>>& values, double way) const {
        double sum = 0;
        for (std::size_t b = 0; b < values.size(); ++b)
            sum += interpolated(cut[r].way[b], values[b], way) / double(values.size());
        return sum;
    }
    /// Of the curve; over a fifth either way, two counts at least.
    double slope(std::size_t r, double way) const {
        const double reach = std::max(0.2 * way, 2 * count), start = std::max(0.0, way - reach);
        return (mean_of(r, cut[r].force, way + reach) - mean_of(r, cut[r].force, start)) /
               (way + reach - start);
    }
    /// By what factor the force is lifted to Fs.
    double lifted(std::size_t r, double way) const {
        const double force = mean_of(r, cut[r].force, way);
        if (!level || !(force > 0)) return 1.0;
        const double at_rest = level->breakaway().value();
        const double here =
            level->slip(quantity_of<signal::velocity>::from_value(mean_of(r, cut[r].speed, way))).value();
        const double slips = slipping(force, slope(r, way), way);
        return 1 + slips * (2 * at_rest / (at_rest + here) - 1) / force;
    }
    /// Relative, of neighbouring runs, in the last octave that both reach.
    double disagreement() const {
        double disagree = 0, compared = 0;
        for (std::size_t r = 0; r + 1 < cut.size(); ++r)
            for (double share = 0.45; share < 0.9; share += 0.05, ++compared) {
                const double way = share * cut[r].amplitude;
                disagree += mean_of(r, cut[r].force, way) * lifted(r, way) /
                                (mean_of(r + 1, cut[r + 1].force, way) * lifted(r + 1, way)) -
                            1;
            }
        return compared > 0 ? std::abs(disagree / compared) : disagree;
    }
};
} // namespace detail

/// Virgin curve from runs along a slow sinusoid in a closed loop, 0.1 Hz with 15 um and with 450 um on the
/// milling table: by Masing's rule a branch that starts at a reversal from F0 is the virgin curve twice as
/// large,
///   F_virgin(d/2) = (F0 - F(d))/2,   F = kf u - mass a - viscous v,
/// as long as what friction remembers is the last reversal. Each place takes the run of the smallest amplitude
/// that
/// reaches it: the slowest. Source: [Jamaludin2008] eq. (3.9); docs/derivations/maxwell_slip.md for the rule.
/// `level`: a branch runs at some speed, where what slips has fallen to s(v) < Fs. What slips is where the
/// tangent of the curve meets zero displacement (exact for springs that stick and slip); that part is brought
/// to Fs, and half of the correction counts as error. Without `level` the curve is that of the speed of the
/// run.
/// Errors: from branch to branch; and what all share: half an encoder count at the reversal, the correction of
/// level, the difference of two runs where both reach. A command that acts late by 1 ms is late by less than
/// 0.3 um in these runs, at their slow ends by nothing.
/// Throws for runs with fewer than 3 branches (2.5 cycles with the run in), and for what is not finite.
template <signal_tag Command = signal::voltage>
virgin_curve find_virgin_curve(const std::vector<test_run<Command>>& runs, duration period,
                               gain_of<signal::force, Command> force_constant,
                               const virgin_options& options = {}) {
    require_positive("find_virgin_curve.period", period);
    require_positive("find_virgin_curve.force_constant", force_constant);
    require_not_negative("virgin_options.mass", options.mass);
    require_not_negative("virgin_options.viscous", options.viscous);
    require(options.points >= 10 && options.points <= 400, "virgin_options.points", double(options.points),
            "must lie between 10 and 400");
    require(!runs.empty() && 5 * runs.size() <= options.points, "find_virgin_curve.runs", double(runs.size()),
            "must be one or more, and no more than a fifth of virgin_options.points (" +
                quadrant::detail::shortest(double(options.points)) + ")");
    const detail::slow_runs run_of(runs, period, force_constant, options);
    const auto& cut = run_of.cut;
    const double count = run_of.count;
    virgin_curve out{{}, {}, displacement::from_value(count)};
    // Places: evenly in their logarithm, as many for each run; to 0.9 of its amplitude, where a branch ends.
    std::vector<double> ways;
    std::vector<std::size_t> source;
    double from = std::max(0.5 * count, 0.01 * cut.front().amplitude);
    for (std::size_t r = 0; r < cut.size(); ++r) {
        const double to = 0.9 * cut[r].amplitude;
        const std::size_t share = options.points / cut.size();
        for (std::size_t i = r == 0 ? 0 : 1; to > from && i <= share; ++i)
            ways.push_back(from * std::pow(to / from, double(i) / double(share))), source.push_back(r);
        from = std::max(from, to);
    }
    const std::size_t n = ways.size();
    const double disagree = run_of.disagreement();
    std::vector<double> factors;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t r = source[i];
        const double factor = factors.emplace_back(run_of.lifted(r, ways[i])),
                     force = factor * run_of.mean_of(r, cut[r].force, ways[i]);
        const double steepest =
            std::max(run_of.slope(r, ways[i]), run_of.slope(r, std::max(0.0, ways[i] - 2 * count)));
        const double place = steepest * count / (2 * std::sqrt(12.0)); // uniform over a count of the whole path
        out.points.push_back({displacement::from_value(ways[i]), quantity_of<signal::force>::from_value(force),
                              std::hypot(place, 0.5 * (1 - 1 / factor) * force, disagree * force), r});
    }
    for (std::size_t r = 0; r < cut.size(); ++r)
        for (std::size_t b = 0; b < cut[r].way.size(); ++b) {
            std::vector<double> forces(n, NAN);
            for (std::size_t i = 0; i < n; ++i)
                if (source[i] == r)
                    forces[i] = factors[i] * detail::interpolated(cut[r].way[b], cut[r].force[b], ways[i]);
            out.branches.push_back(forces);
        }
    return out;
}

} // namespace quadrant::inline v0::analysis
