// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../friction/maxwell_slip.hpp"
#include "minimise.hpp"
#include "virgin_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// Fitted springs of a `maxwell_slip`, knots rising.
template <std::size_t N> struct gms_fit {
    using force = quantity_of<signal::force>;
    std::array<force, N> forces; ///< k_i times its knot: at breakaway of each element
    std::array<displacement, N> knots;
    std::array<gain_rate_of<signal::force, signal::velocity>, N> stiffness; ///< k_i
    double residual;                                                        ///< rms of curve minus fit [N]
    std::string limits;                                ///< what cannot be distinguished; empty: nothing
    std::vector<std::array<double, 2 * N>> without;    ///< knots [m], stiffness [N/m] without one branch each
    std::vector<std::pair<double, double>> systematic; ///< displacement [m], standard error [N]

    /// sum k_i min(way, knot_i), with its interval of 95 %: branches left out one at a time, and the curve's
    /// systematic part.
    estimated<force> at(displacement way) const {
        const double x = way.value();
        double f = 0, mean = 0, squares = 0;
        for (std::size_t i = 0; i < N; ++i) f += stiffness[i].value() * std::min(x, knots[i].value());
        std::vector<double> others;
        for (const auto& each : without) {
            double other = 0;
            for (std::size_t i = 0; i < N; ++i) other += each[N + i] * std::min(x, each[i]);
            others.push_back(other), mean += other / double(without.size());
        }
        for (const double other : others) squares += (other - mean) * (other - mean);
        const double n = double(without.size()), jackknife = std::sqrt((n - 1) / n * squares);
        std::vector<double> ways, errors;
        for (const auto& [w, e] : systematic) ways.push_back(w), errors.push_back(e);
        const double reach =
            std::hypot(student_95(n - 1) * jackknife, student_95(1e6) * detail::interpolated(ways, errors, x));
        return {force::from_value(f), force::from_value(f - reach), force::from_value(f + reach)};
    }
    /// For `maxwell_slip`: shares of the level from here, the level from the friction map.
    typename maxwell_slip<N>::parameters
    parameters(const stribeck<>::parameters& level,
               quantity<unit_quotient<si::force, si::time>> attraction) const {
        typename maxwell_slip<N>::parameters out{};
        out.curve = level;
        double all = 0;
        for (const auto& each : forces) all += each.value();
        for (std::size_t i = 0; i < N; ++i)
            out.weights[i] = forces[i].value() / all, out.stiffness[i] = stiffness[i];
        out.attraction = attraction;
        return out;
    }
};

namespace detail {

/// The curve as columns, each point weighed by its spread, and the model in ln(knot), ln(k knot / largest
/// force).
template <std::size_t N> struct gms_equations {
    static constexpr std::size_t places = 12; ///< that a knot may start from
    static_assert(N < places);
    struct start {
        double cost;
        std::vector<double> x; ///< ln knot, ln (k knot / top)
    };

    double top = 0; ///< largest force
    std::vector<double> way, force, weight;

    explicit gms_equations(const virgin_curve& curve) {
        for (const auto& p : curve.points) top = std::max(top, p.force.value());
        require_positive("fit_gms.force (largest)", top);
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const auto& p = curve.points[i];
            way.push_back(p.way.value()), force.push_back(p.force.value());
            weight.push_back(1 / std::hypot(curve.spread(i).first, p.systematic, 1e-3 * top));
        }
    }

    /// What the model of x leaves of these forces, weighed.
    auto residuals_of(const std::vector<double>& measured) const {
        return [this, &measured](const std::vector<double>& x) {
            std::vector<double> r(way.size());
            for (std::size_t i = 0; i < r.size(); ++i) {
                double f = 0;
                for (std::size_t j = 0; j < N; ++j)
                    f += top * std::exp(x[N + j]) * std::min(1.0, way[i] / std::exp(x[j]));
                r[i] = weight[i] * (f - measured[i]);
            }
            return r;
        };
    }
    /// One start for each choice of N knots out of the places whose elements all pull; the best first.
    std::vector<start> starts() const {
        std::array<double, places> place;
        for (std::size_t j = 0; j < places; ++j)
            place[j] = way[1] * std::pow(way[way.size() - 2] / way[1], double(j) / double(places - 1));
        std::vector<start> out;
        std::array<std::size_t, N> chosen;
        for (std::size_t i = 0; i < N; ++i) chosen[i] = i;
        do {
            std::array<double, N> knots;
            for (std::size_t j = 0; j < N; ++j) knots[j] = place[chosen[j]];
            if (auto s = with_knots(knots)) out.push_back(std::move(*s));
        } while (next_choice(chosen));
        std::sort(out.begin(), out.end(), [](const start& a, const start& b) { return a.cost < b.cost; });
        return out;
    }

private:
    /// With the knots given, the forces follow from linear equations; none if an element would push.
    std::optional<start> with_knots(const std::array<double, N>& knots) const {
        least_squares equations(N);
        for (std::size_t i = 0; i < way.size(); ++i) {
            std::vector<double> row(N);
            for (std::size_t j = 0; j < N; ++j) row[j] = weight[i] * top * std::min(1.0, way[i] / knots[j]);
            equations.add(row, weight[i] * force[i]);
        }
        const auto found = equations.solve();
        if (!(*std::min_element(found.x.begin(), found.x.end()) > 1e-4)) return {};
        start s{found.residual, {}};
        for (const double knot : knots) s.x.push_back(std::log(knot));
        for (std::size_t j = 0; j < N; ++j) s.x.push_back(std::log(found.x[j]));
        return s;
    }
    static bool next_choice(std::array<std::size_t, N>& chosen) {
        for (std::size_t j = N; j-- > 0;)
            if (chosen[j] + (N - j) < places) {
                ++chosen[j];
                for (std::size_t k = j + 1; k < N; ++k) chosen[k] = chosen[k - 1] + 1;
                return true;
            }
        return false;
    }
};

/// The elements of a solution by rising knot, and which of them the curve cannot distinguish.
template <std::size_t N> gms_fit<N> gms_elements(const std::vector<double>& x, double top, double count) {
    gms_fit<N> out{};
    std::array<std::size_t, N> order; // of the knots
    for (std::size_t j = 0; j < N; ++j) order[j] = j;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    for (std::size_t j = 0; j < N; ++j) {
        const double knot = std::exp(x[order[j]]), strength = top * std::exp(x[N + order[j]]);
        out.knots[j] = displacement::from_value(knot);
        out.forces[j] = quantity_of<signal::force>::from_value(strength);
        out.stiffness[j] = gain_rate_of<signal::force, signal::velocity>::from_value(strength / knot);
        const double before = j > 0 ? out.knots[j - 1].value() : 0;
        if (j > 0 && knot - before < std::max(0.5 * count, 0.1 * knot))
            out.limits += "elements " + std::to_string(j) + " and " + std::to_string(j + 1) +
                          " cannot be distinguished: their knots lie within an encoder count or a tenth. ";
    }
    return out;
}

} // namespace detail

/// Piecewise-linear fit F(x) = sum k_i min(x, knot_i), k_i > 0, so concave and never falling: slopes K_j
/// between knots are the sum of the stiffness that still sticks, [Jamaludin2008] eq. (3.9). Weighted least
/// squares; starts from every choice of N knots out of 12 places (the stiffness is then linear), the best three
/// refined in ln(knot), ln(k). Deterministic. `limits` says which knots lie within one encoder count (of the
/// displacement back: half a count here) or a tenth of each other: the curve is then known, the single k_i and
/// forces are not. Throws with fewer than 4 points an element, or for a curve that no N springs in this order
/// fit.
template <std::size_t N> gms_fit<N> fit_gms(const virgin_curve& curve) {
    const std::size_t n = curve.points.size();
    require(n >= 4 * N, "fit_gms.points", double(n), "must be 4 or more for each element");
    const detail::gms_equations<N> equations(curve);
    const auto starts = equations.starts();
    require(!starts.empty(), "fit_gms.starts", 0.0,
            "must be one or more: the curve has fewer bends than elements");
    minimum best{{}, {}, HUGE_VAL, false};
    for (std::size_t s = 0; s < std::min<std::size_t>(3, starts.size()); ++s)
        if (auto each = minimise(equations.residuals_of(equations.force), starts[s].x); each.cost < best.cost)
            best = each;
    gms_fit<N> out = detail::gms_elements<N>(best.x, equations.top, curve.count.value());
    const auto plain = equations.residuals_of(equations.force)(best.x);
    for (std::size_t i = 0; i < n; ++i) {
        out.residual += plain[i] * plain[i] / (equations.weight[i] * equations.weight[i]) / double(n);
        out.systematic.push_back({equations.way[i], curve.points[i].systematic});
    }
    out.residual = std::sqrt(out.residual);
    for (std::size_t b = 0; b < curve.branches.size(); ++b) {
        auto measured = equations.force; // mean without this branch
        for (std::size_t i = 0; i < n; ++i)
            if (const double f = curve.branches[b][i]; std::isfinite(f))
                measured[i] -= (f - equations.force[i]) / curve.spread(i).second;
        const auto x = minimise(equations.residuals_of(measured), best.x).x;
        auto& other = out.without.emplace_back();
        for (std::size_t j = 0; j < N; ++j)
            other[j] = std::exp(x[j]), other[N + j] = equations.top * std::exp(x[N + j] - x[j]);
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
