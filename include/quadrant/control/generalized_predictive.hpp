// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "rst.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// What a `generalized_predictive` law weighs.
template <signal_tag Command = signal::voltage> struct predictive_costs {
    /// A change of the command by one costs as much as this position error; > 0. Smaller is faster.
    gain_of<signal::position, Command> effort;
    std::size_t first = 1; ///< period ahead from which errors count; 1 ... Horizon
};

/// Generalized predictive control as an `rst`: of all plans for the next `Moves` changes of the command the
/// first move of the one that is best over the horizon, with the references there known.
///   min over du of  sum_{j = first..Horizon} (x_ref[k+j] - x[k+j])^2 + sum_{i < Moves} (effort du[k+i])^2,   du = 0 after
/// on the model a (1 - z^-1) x = b du: it integrates. Without limits the best plan is linear, so an R, S, T.
/// Source: [Clarke1987], with C = 1: noise of the encoder is not filtered; more effort or a longer horizon
/// makes it less. The law previews Horizon periods. W = 1: after a limit it goes on from what was applied at
/// once.
/// Range: 1 <= Moves <= Horizon, Horizon > 1. Throws "generalized_predictive.<field> = ...: must ..."; a loop
/// that is not stable (short horizons of plants with zeros beyond the unit circle) is refused.
/// With previewed speeds and all moves free: `predictive`.
template <std::size_t Horizon, std::size_t Moves = 1, std::size_t A, std::size_t B, class Number,
          signal_tag Command>
requires(Horizon > 1 && Moves >= 1 && Moves <= Horizon) auto generalized_predictive(
    const sampled_plant<A, B, Number>& plant, const predictive_costs<Command>& costs, duration period) {
    require_positive("generalized_predictive.period", period);
    require_positive("generalized_predictive.effort", costs.effort);
    require(costs.first >= 1 && costs.first <= Horizon, "generalized_predictive.first", double(costs.first),
            "must lie between 1 and the horizon (" + detail::shortest(double(Horizon)) + ")");
    // Every coming position as a row over what is known and what is to be found: positions k ... k - A, changes
    // k - 1 ... k - B + 1, changes k ... k + Moves - 1.
    constexpr std::size_t changes = A + 1, moves = changes + B - 1, columns = moves + Moves;
    const auto a = detail::with_factor<1>(plant.a, -1);
    std::array<std::array<Number, columns>, A + 1 + Horizon> x{}; // [A + j]: j periods ahead
    for (std::size_t i = 0; i <= A; ++i) x[A - i][i] = Number(1);
    for (std::size_t j = 1; j <= Horizon; ++j) {
        auto& row = x[A + j];
        for (std::size_t i = 1; i <= A + 1; ++i)
            for (std::size_t n = 0; n < columns; ++n) row[n] -= a[i] * x[A + j - i][n];
        for (std::size_t i = 1; i <= B; ++i) {
            if (i > j)
                row[changes + (i - j) - 1] += plant.b[i];
            else if (j - i < Moves)
                row[moves + (j - i)] += plant.b[i];
        }
    }
    matrix<Moves, Moves, Number> normal{};
    matrix<Moves, Horizon, Number> weighed{};
    const double effort = costs.effort.value();
    for (std::size_t i = 0; i < Moves; ++i) {
        normal[i][i] += Number(effort * effort);
        for (std::size_t j = costs.first; j <= Horizon; ++j) {
            weighed[i][j - 1] = x[A + j][moves + i];
            for (std::size_t m = 0; m < Moves; ++m) normal[i][m] += x[A + j][moves + i] * x[A + j][moves + m];
        }
    }
    const auto plan = detail::solved(normal, weighed);

    using gain = gain_of<Command, signal::position, Number>;
    rst_polynomials<B, A, Horizon - 1, Command, Number> p;
    z_polynomial<B - 1, Number> r{Number(1)};
    std::array<Number, A + 1> s{};
    Number sum_of_t(0);
    for (std::size_t j = 1; j <= Horizon; ++j) {
        const Number k = plan[0][j - 1];
        p.reference[Horizon - j] = gain::from_value(k);
        sum_of_t += k;
        for (std::size_t i = 0; i <= A; ++i) s[i] += k * x[A + j][i];
        for (std::size_t i = 1; i < B; ++i) r[i] += k * x[A + j][changes + i - 1];
    }
    p.r = detail::with_factor<1>(r, -1);
    s[0] += sum_of_t - detail::at_one(s); // rounding: the prediction of an axis at rest is rest
    for (std::size_t i = 0; i <= A; ++i) p.feedback[i] = gain::from_value(s[i]);
    const double radius = loop_radius(plant, p);
    require(radius < 1, "generalized_predictive.effort", radius,
            "must with the horizon leave the loop stable (largest pole)");
    return p;
}
template <std::size_t Horizon, std::size_t Moves = 1, signal_tag Command, class Number>
auto generalized_predictive(const axis_model<Command, Number>& plant, const predictive_costs<Command>& costs,
                            duration period) {
    return generalized_predictive<Horizon, Moves>(pulse_transfer(plant, period), costs, period);
}
/// The law for that of an `axis_model`; it previews Horizon periods.
template <std::size_t Horizon = 20, class Real = double, signal_tag Command = signal::voltage>
using generalized_predictive_law = rst<2, 2, Horizon - 1, Horizon, Real, Command>;

} // namespace quadrant::inline v0
