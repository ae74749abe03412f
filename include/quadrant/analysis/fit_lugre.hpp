// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction/lugre.hpp"
#include "estimated.hpp"
#include "minimise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Whether LuGre friction can give energy away, and what to do about it.
struct lugre_passivity {
    bool passive;
    std::string warning; ///< names the rule and its figures; empty when passive
    lugre<>::parameters
        falling; ///< the same with a damping that falls just early enough; as given when passive
};

/// The rule of [Barahanov2000]: constant damping needs viscous >= damping (Fs - Fc)/Fc. Bristles that are
/// damped more in the fast than they dissipate swing by themselves in a simulation. A damping that falls with
/// the speed is passive with
/// hardly any viscous friction: `falling` has the largest damping_velocity, to 1 %, at which it is.
/// Throws what `lugre` throws.
inline lugre_passivity check_passivity(const lugre<>::parameters& p) {
    lugre<>(p, duration::from_value(1));
    if (lugre<>::passive(p)) return {true, {}, p};
    const double needed =
        p.damping.value() * (p.curve.static_level.value() - p.curve.coulomb.value()) / p.curve.coulomb.value();
    lugre<>::parameters falling = p;
    double low = 0, high = p.damping_velocity.value() > 0 ? p.damping_velocity.value()
                                                          : 1000 * p.curve.stribeck_velocity.value();
    for (double v = high; low == 0 && v > 1e-6 * high; v /= 2) {
        falling.damping_velocity = quantity_of<signal::velocity>::from_value(v);
        if (lugre<>::passive(falling))
            low = v;
        else
            high = v;
    }
    while (low > 0 && high > 1.01 * low) {
        falling.damping_velocity = quantity_of<signal::velocity>::from_value(std::sqrt(low * high));
        (lugre<>::passive(falling) ? low : high) = std::sqrt(low * high);
    }
    falling.damping_velocity = quantity_of<signal::velocity>::from_value(low);
    const quadrant::detail::rule words =
        "not passive: constant damping needs viscous >= damping (Fs - Fc)/Fc = " +
        quadrant::detail::shortest(needed) + " N s/m and has " +
        quadrant::detail::shortest(p.curve.viscous.value()) + "; ";
    if (low == 0)
        return {false, std::string(words) + "no damping that falls with the speed is passive either", p};
    return {false,
            std::string(words + "passive with damping_velocity = " + quadrant::detail::shortest(low) + " m/s"),
            falling};
}

/// sigma0 and sigma1 of `lugre`, with intervals of 95 %.
struct lugre_fit {
    estimated<gain_rate_of<signal::force, signal::velocity>> stiffness; ///< sigma0
    estimated<gain_of<signal::force, signal::velocity>> damping;        ///< sigma1
    lugre<>::parameters friction;                                       ///< the curve given, with these
    double rms;                ///< of recorded minus simulated command, in its unit
    lugre_passivity passivity; ///< of `friction`
    bool converged;
};

namespace detail {
/// How far two parameters that were fitted to several runs may lie off, by what the single runs would want.
struct slope_spread {
    std::array<std::array<double, 2>, 2> inverse{}; ///< of the curvature of the cost
    std::array<std::array<double, 2>, 2> scatter{}; ///< of what each run pulls
    std::array<double, 2> pull{}; ///< of all runs; not 0 where a parameter stands at its bound
    std::size_t runs = 0;

    /// Half the interval of 95 % of parameter j.
    double reach(std::size_t j) const {
        double variance = 0;
        for (std::size_t a = 0; a < 2; ++a)
            for (std::size_t b = 0; b < 2; ++b) variance += inverse[j][a] * scatter[a][b] * inverse[b][j];
        const double n = double(runs);
        return student_95(n - 1) * std::sqrt(variance * n / (n - 1));
    }
};
/// `slope[j][i]` of residual `left[i]` by parameter j; run r ends before sample ends[r].
inline slope_spread spread_of_runs(const std::array<std::vector<double>, 2>& slope,
                                   const std::vector<double>& left, const std::vector<std::size_t>& ends) {
    std::array<std::array<double, 2>, 2> curvature{};
    slope_spread out;
    out.runs = ends.size();
    for (std::size_t r = 0, i = 0; r < ends.size(); ++r) {
        std::array<double, 2> pull{};
        for (; i < ends[r]; ++i)
            for (std::size_t j = 0; j < 2; ++j) {
                pull[j] += slope[j][i] * left[i];
                for (std::size_t l = 0; l < 2; ++l) curvature[j][l] += slope[j][i] * slope[l][i];
            }
        for (std::size_t j = 0; j < 2; ++j)
            for (std::size_t l = 0; l < 2; ++l) out.scatter[j][l] += pull[j] * pull[l];
        for (std::size_t j = 0; j < 2; ++j) out.pull[j] += pull[j];
    }
    const double determinant = curvature[0][0] * curvature[1][1] - curvature[0][1] * curvature[0][1];
    require(determinant > 1e-12 * curvature[0][0] * curvature[1][1], "fit_lugre.runs (determinant)",
            determinant,
            "must be above 0: stiffness and damping have to make a difference to the command, each its own");
    out.inverse = {{{curvature[1][1] / determinant, -curvature[0][1] / determinant},
                    {-curvature[0][1] / determinant, curvature[0][0] / determinant}}};
    return out;
}
} // namespace detail

/// The dynamic parameters of LuGre friction: those with which a simulation of the loop asks for the recorded
/// command. `simulate(friction, run)` gives the commands of the loop along what run number `run` was asked to
/// do, as many as were
/// recorded: with an encoder without steps, so that it answers smoothly. Compared from sample `first` on, when
/// the start is forgotten. Runs: back and forth within and beyond the presliding displacement, with parts fast
/// enough for sigma1 v to be felt beside sigma0 z, each from another place, with gains so low that the counts
/// of the encoder do not shake the axis. All runs are fitted together by `minimise`, sigma0 in its logarithm,
/// sigma1 not below 0. Intervals: the spread of what the single runs would want instead ([Liang1986], Student's
/// t), correlated as their samples are. What is the same in all runs they do not know: a wrong mass, force
/// constant or static curve, and what an encoder's steps do to the mean of the loop. A trial shows whether the
/// motion is enough for the encoder: fit runs simulated with its steps.
/// Source: [LowKeck2003], dynamic parameters by matching simulated and recorded current; there with a genetic
/// algorithm. Throws with fewer than 3 runs, unequal lengths, a start that is not above 0, what `minimise`
/// throws, and when a parameter makes no difference to the command.
template <signal_tag Command, class Simulate>
lugre_fit fit_lugre(const std::vector<std::vector<quantity_of<Command>>>& recorded, const Simulate& simulate,
                    const lugre<>::parameters& start, std::size_t first = 0) {
    const std::size_t runs = recorded.size();
    require(runs >= 3, "fit_lugre.runs", double(runs), "must be 3 or more");
    require_positive("fit_lugre.start.stiffness", start.stiffness);
    require_positive("fit_lugre.start.damping", start.damping);
    std::vector<std::size_t> ends;
    std::size_t samples = 0;
    for (const auto& run : recorded) {
        require(run.size() > first + 2, "fit_lugre.samples", double(run.size()),
                "must be more than 2 after `first`");
        ends.push_back(samples += run.size() - first);
    }
    const auto with = [&](const std::vector<double>& x) {
        lugre<>::parameters p = start;
        p.stiffness = decltype(p.stiffness)::from_value(start.stiffness.value() * std::exp(x[0]));
        p.damping = decltype(p.damping)::from_value(start.damping.value() * std::max(0.0, x[1]));
        return p;
    };
    const auto residuals = [&](const std::vector<double>& x) {
        std::vector<double> off;
        for (std::size_t r = 0; r < runs; ++r) {
            const auto asked = simulate(with(x), r);
            require(asked.size() == recorded[r].size(), "fit_lugre.simulate (samples)", double(asked.size()),
                    "must be as many as were recorded");
            for (std::size_t k = first; k < asked.size(); ++k)
                off.push_back((asked[k] - recorded[r][k]).value());
        }
        return off;
    };
    minimum found = minimise(residuals, {0, 1});
    found.x[1] = std::max(0.0, found.x[1]);

    const auto left = residuals(found.x);
    std::array<std::vector<double>, 2> slope;
    const std::array h{1e-3, 1e-3 * std::max(1.0, found.x[1])};
    for (std::size_t j = 0; j < 2; ++j) {
        auto more = found.x, less = found.x;
        more[j] += h[j], less[j] -= h[j];
        if (j == 1) less[j] = std::max(0.0, less[j]);
        slope[j] = residuals(more);
        const auto below = residuals(less);
        for (std::size_t i = 0; i < samples; ++i) slope[j][i] = (slope[j][i] - below[i]) / (more[j] - less[j]);
    }
    const detail::slope_spread spread = detail::spread_of_runs(slope, left, ends);
    lugre_fit out{{}, {}, with(found.x), std::sqrt(found.cost / double(samples)), {}, found.converged};
    const auto stiffness = out.friction.stiffness;
    out.stiffness = {stiffness, stiffness * std::exp(-spread.reach(0)), stiffness * std::exp(spread.reach(0))};
    const auto damping = [&](double x) { return start.damping * std::max(0.0, x); };
    const double free =
        found.x[1] - spread.inverse[1][0] * spread.pull[0] - spread.inverse[1][1] * spread.pull[1];
    out.damping = {damping(found.x[1]), damping(free - spread.reach(1)), damping(free + spread.reach(1))};
    out.passivity = check_passivity(out.friction);
    return out;
}

} // namespace quadrant::inline v0::analysis
