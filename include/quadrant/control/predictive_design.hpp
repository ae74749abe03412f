// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../observer/matrix.hpp"
#include "../observer/nominal_plant.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// The gains of `predictive`. Design only: runs once, may throw, does not allocate.
namespace quadrant::inline v0 {

/// What an error and a change of the command cost, bare numbers in SI; only their ratios matter.
///   J = sum over i = 1 ... horizon of e_i' error e_i + increment du_{i-1}^2,   e = (position error, speed error)
template <class Number = double> struct predictive_weights {
    matrix<2, 2, Number> error; ///< symmetric, positive semidefinite, [0][0] > 0
    Number increment;           ///< > 0
};

/// Bryson's rule: each of these costs as much as the others. An infinite speed is not weighed.
/// Source: [Franklin1998] ch. 9.
template <signal_tag Command = signal::voltage, class Number = double>
predictive_weights<Number> bryson_weights(quantity_of<signal::position, Number> position,
                                          quantity_of<signal::velocity, Number> speed,
                                          quantity_of<Command, Number> increment) {
    const auto over_square = [](const auto& q) { return Number(1) / (q.value() * q.value()); };
    return {{{{over_square(position), Number(0)}, {Number(0), over_square(speed)}}}, over_square(increment)};
}

/// du = sum of to_position[i] (r_i - x) + to_velocity[i] (dr_i - v), less the gains on what changed since the
/// sample before.
template <std::size_t Preview, class Number> struct predictive_gains {
    std::array<Number, Preview> to_position{}, to_velocity{}; ///< [0]: one period ahead
    Number on_position_change{}, on_velocity_change{};
    double radius = 0; ///< of the loop around the model: below 1 it is stable
};

/// The first move of the least J over the horizon, by the Riccati recursion of the model in differences:
///   Dx+ = Dx + a Dv + b1 du,  Dv+ = c Dv + b2 du,  x+ = x + Dx+,  v+ = v + Dv+     (a constant force is not in it)
/// In units of the period and of the way that a command of 1 drives the axis in it: all of order one.
template <std::size_t Preview, signal_tag Command, class Number>
predictive_gains<Preview, Number> design_predictive(const axis_model<Command, Number>& plant,
                                                    const predictive_weights<Number>& weights,
                                                    std::size_t horizon, duration period) {
    using namespace detail;
    const Number T(period.value()), way = plant.gain.value() * T * T;
    const auto axis =
        sampled(matrix<2, 2, Number>{{{Number(0), Number(1)}, {Number(0), -plant.viscous_rate.value() * T}}},
                column<2, Number>{Number(0), Number(1)}, matrix<2, 2, Number>{}, 1.0);
    const Number a = axis.step[0][1], c = axis.step[1][1], b1 = axis.from_input[0], b2 = axis.from_input[1],
                 none(0), one(1);
    const matrix<4, 4, Number> A{
        {{one, a, none, none}, {none, c, none, none}, {one, a, one, none}, {none, c, none, one}}};
    const column<4, Number> B{b1, b2, b1, b2};
    const Number share = way * way / weights.increment;
    matrix<4, 4, Number> Q{};
    Q[2][2] = weights.error[0][0] * share;
    Q[2][3] = Q[3][2] = weights.error[0][1] * share / T;
    Q[3][3] = weights.error[1][1] * share / (T * T);

    std::array<column<4, Number>, Preview> gain{}; // [j]: of the move j periods from now
    matrix<4, 4, Number> P = Q;
    Number under(1);
    for (std::size_t j = horizon; j-- > 0;) {
        column<4, Number> pb{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) pb[i] += P[i][k] * B[k];
        under = one;
        for (std::size_t i = 0; i < 4; ++i) under += B[i] * pb[i];
        matrix<4, 4, Number> rest = A;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) gain[j][i] += pb[k] * A[k][i] / under;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) rest[i][k] -= B[i] * gain[j][k];
        P = added(Q, multiplied(transposed(A), multiplied(P, rest)));
    }

    predictive_gains<Preview, Number> out;
    out.on_position_change = gain[0][0] / way, out.on_velocity_change = gain[0][1] * T / way;
    column<4, Number> w = B; // how the first move moves what is i + 1 periods ahead
    for (Number& each : w) each = each / under;
    for (std::size_t i = 0; i < horizon; ++i) {
        out.to_position[i] = (w[2] * Q[2][2] + w[3] * Q[3][2]) / way;
        out.to_velocity[i] = (w[2] * Q[2][3] + w[3] * Q[3][3]) * T / way;
        if (i + 1 == horizon) break;
        column<4, Number> next{};
        Number du(0);
        for (std::size_t k = 0; k < 4; ++k) du += gain[i + 1][k] * w[k];
        for (std::size_t r = 0; r < 4; ++r) {
            next[r] = -B[r] * du;
            for (std::size_t k = 0; k < 4; ++k) next[r] += A[r][k] * w[k];
        }
        w = next;
    }
    // The loop: (x, v, u) of the sample before, at no reference.
    const column<3, Number> x{one, a, b1}, v{none, c, b2};
    matrix<3, 3, Number> loop{{x, v, {none, none, one}}};
    for (std::size_t k = 0; k < 3; ++k)
        loop[2][k] -= gain[0][2] * x[k] + gain[0][3] * v[k] + gain[0][0] * (x[k] - (k == 0 ? one : none)) +
                      gain[0][1] * (v[k] - (k == 1 ? one : none));
    out.radius = spectral_radius(loop);
    return out;
}

} // namespace quadrant::inline v0
