// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction/stribeck.hpp"
#include "friction_map.hpp"
#include "minimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Fitted eq. (3.5) with intervals of 95 %.
struct stribeck_fit {
    using force = quantity_of<signal::force>;
    estimated<force> coulomb;                     ///< Fc
    std::optional<estimated<force>> static_level; ///< Fs; none: no speed was slow enough to see it
    std::optional<estimated<quantity_of<signal::velocity>>> stribeck_velocity; ///< Vs; with Fs only
    estimated<gain_of<signal::force, signal::velocity>> viscous; ///< all of it: sigma and the plant's own
    double surprise; ///< sum of squares over what the points' errors explain; far above 1: another curve
    bool converged;
    double shape = 1;   ///< delta, as given
    std::string limits; ///< what the map cannot identify; empty: nothing

    /// For `stribeck`, `maxwell_slip`; without Fs the level is Coulomb's, and vs does not matter.
    stribeck<>::parameters parameters() const {
        return {coulomb.value, static_level ? static_level->value : coulomb.value,
                stribeck_velocity ? stribeck_velocity->value : quantity_of<signal::velocity>::from_value(1),
                viscous.value < decltype(viscous.value)() ? decltype(viscous.value)() : viscous.value, shape};
    }
};

namespace detail {
/// The points of a friction map as eq. (3.5) is fitted to them, forces in units of the largest one.
struct stribeck_points {
    const std::vector<friction_map::point>& points;
    double shape, level, fastest;

    double error(const friction_map::point& p) const {
        return std::max(p.standard_error.value(), 1e-3 * level);
    }
    /// Fc, viscous, and the fall unless vs is 0; in units of level and level/fastest.
    least_squares::solution line(double vs) const {
        least_squares out(vs > 0 ? 3 : 2);
        for (const auto& p : points) {
            const double w = level / error(p), v = p.speed.value();
            std::vector<double> row{w, w * v / fastest};
            if (vs > 0) row.push_back(w * std::exp(-std::pow(v / vs, shape)));
            out.add(row, w * p.friction.value() / level);
        }
        return out.solve();
    }
    /// x: Fc, viscous, Fs, ln Vs.
    std::vector<double> residuals(const std::vector<double>& x) const {
        std::vector<double> r;
        for (const auto& p : points) {
            const double v = p.speed.value(), fall = x[2] - x[0];
            const double f = x[0] + x[1] * v / fastest + fall * std::exp(-std::pow(v / std::exp(x[3]), shape));
            r.push_back((f * level - p.friction.value()) / error(p));
        }
        return r;
    }
    /// Where a fit of all four numbers starts; the fall is seen in none of these curves: 0.
    double best_velocity(double straight) const {
        double best = HUGE_VAL, start = 0;
        for (double vs = 0.5 * points.front().speed.value(); vs < 2 * fastest; vs *= 1.3)
            if (const auto each = line(vs); each.residual < best && each.x[2] > 0)
                best = each.residual, start = vs;
        return best < straight ? start : 0;
    }
};
} // namespace detail

/// Fit of [Jamaludin2008] eq. (3.5), F = Fc + (Fs - Fc) exp(-(v/Vs)^shape) + viscous v, v > 0, by weighted
/// nonlinear least squares; starts on a grid of Vs (the rest is linear), then Levenberg-Marquardt. Each point
/// counts by its standard error, none of them better than a thousandth of the force. Intervals: of the map's
/// own errors, widened by `surprise` above 1; they do not speak of a curve of another shape.
/// Fs is an extrapolation to standstill. It is given only where the fall is seen: two speeds or more below the
/// fitted Vs, the fall itself outside its own interval; else only Fc + viscous v, and `limits` says so: with
/// one rising line Fc is then whatever level it starts from.
/// Throws with fewer than 4 speeds, or speeds within a factor of 3.
inline stribeck_fit fit_stribeck(const friction_map& map, double shape = 1) {
    require(shape >= 0.25 && shape <= 4, "fit_stribeck.shape", shape, "must lie between 0.25 and 4");
    const auto& points = map.points;
    require(points.size() >= 4, "fit_stribeck.speeds", double(points.size()),
            "must be 4 or more, each driven both ways");
    const double slowest = points.front().speed.value(), fastest = points.back().speed.value();
    require(fastest > 3 * slowest, "fit_stribeck.speeds (fastest over slowest)", fastest / slowest,
            "must be above 3");
    double level = 0;
    for (const auto& p : points) level = std::max(level, std::abs(p.friction.value()));
    require_positive("fit_stribeck.friction (largest)", level);
    const detail::stribeck_points fitted{points, shape, level, fastest};
    const auto widening = [&](double surprise, std::size_t unknowns) { // of the standard errors, to 95 %
        const double t = student_95(map.freedom);
        return surprise <= 1 ? t
                             : std::max(t, student_95(double(points.size() - unknowns))) * std::sqrt(surprise);
    };
    const auto about = [](auto unit, double value, double reach) {
        using quantity = decltype(unit);
        return estimated<quantity>{quantity::from_value(value), quantity::from_value(value - reach),
                                   quantity::from_value(value + reach)};
    };
    using viscosity = gain_of<signal::force, signal::velocity>;
    using speed = quantity_of<signal::velocity>;
    const auto straight = fitted.line(0);
    stribeck_fit out{};
    out.shape = shape;
    out.limits = "Fs is not visible: no fall of the friction with two speeds or more below it";
    out.converged = true;
    out.surprise = straight.residual / double(points.size() - 2);
    const double wide_line = widening(out.surprise, 2);
    out.coulomb = about(stribeck_fit::force(), level * straight.x[0],
                        wide_line * level * std::sqrt(straight.inverse_diagonal[0]));
    out.viscous = about(viscosity(), level / fastest * straight.x[1],
                        wide_line * level / fastest * std::sqrt(straight.inverse_diagonal[1]));
    if (points.size() < 5) {
        out.limits = "Fs is not visible: 4 speeds settle no curve of 4 parameters, record 5 or more";
        return out;
    }
    const double start = fitted.best_velocity(straight.residual);
    if (start == 0) return out;
    const auto at = fitted.line(start).x;
    const auto fit = minimise([&](const auto& x) { return fitted.residuals(x); },
                              {at[0], at[1], at[0] + at[2], std::log(start)});
    const double vs = std::exp(fit.x[3]);
    const double surprise = fit.cost / double(points.size() - 4);
    const double wide = widening(surprise, 4);
    const auto reach = [&](std::size_t i) { return wide * std::sqrt(fit.variance[i]); };
    const bool seen =
        points[1].speed.value() < vs && fit.x[2] - fit.x[0] > std::hypot(reach(0), reach(2)) && reach(3) < 1;
    if (!seen) return out;
    out.limits.clear();
    out.surprise = surprise, out.converged = fit.converged;
    out.coulomb = about(stribeck_fit::force(), level * fit.x[0], level * reach(0));
    out.viscous = about(viscosity(), level / fastest * fit.x[1], level / fastest * reach(1));
    out.static_level = about(stribeck_fit::force(), level * fit.x[2], level * reach(2));
    out.stribeck_velocity = {speed::from_value(vs), speed::from_value(vs * std::exp(-reach(3))),
                             speed::from_value(vs * std::exp(reach(3)))};
    return out;
}

} // namespace quadrant::inline v0::analysis
