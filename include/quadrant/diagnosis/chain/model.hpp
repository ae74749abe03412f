// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "link.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace quadrant::inline v0::diagnosis::chain {

/// What may lie between two readings of one axis.
enum class term {
    rate,
    delay,
    first_order,
    scale,
    play,
    pitch,
    smooth,
    cyclic,
    spring,
    motor_friction,
    steps,
    drift
};
inline constexpr std::array all_terms{term::rate,   term::delay, term::first_order, term::scale,
                                      term::play,   term::pitch, term::smooth,      term::cyclic,
                                      term::spring, term::steps, term::drift,       term::motor_friction};

/// Whether a term is a time by which what was asked is followed later.
constexpr bool of_lateness(term t) { return t == term::delay || t == term::first_order; }

/// The effect that a term is, by its name in the list; empty: no name.
constexpr std::string_view name_of(term t) {
    switch (t) {
    case term::rate:
        return "setpoint_rate_limit";
    case term::delay:
        return "command_delay";
    case term::first_order:
        return "drive_gain";
    case term::scale:
        return "scale_error";
    case term::play:
        return "lost_motion";
    case term::pitch:
        return "pitch_error";
    case term::smooth:
        return "travel_error";
    case term::cyclic:
        return "encoder_cyclic_error";
    case term::spring:
        return "wind_up";
    case term::motor_friction:
        return "motor_friction";
    case term::steps:
        return "missed_steps";
    default:
        return "";
    }
}

/// What is described of a link, and what a model of it frees. Values of freed terms that are no columns stand
/// here too.
struct link_model {
    std::vector<term> freed{};
    double delay = 0;                           ///< of the set-points [s]
    double lag = 0;                             ///< 1 / gain of a position loop [s]
    double rate = 0;                            ///< at most, of what is followed; 0: any [m/s]
    double play = 0;                            ///< [m]
    double compliance = 0;                      ///< 1 / stiffness [m/N]
    double motor_coulomb = 0;                   ///< [N]
    double pitch_period = 0;                    ///< [m]
    int pitch_harmonics = 1;                    ///< of a freed pitch error
    double cyclic_period = 0;                   ///< of a freed error that repeats otherwise [m]
    std::vector<std::size_t> steps{};           ///< rows at which the last reading jumps
    std::vector<double> pitch{}, pitch_phase{}; ///< as described [m], [rad]
    std::vector<double> smooth{};               ///< as described, of order 2 on, see smooth_curve() [m]
    double smooth_from = 0, smooth_to = 0;      ///< [m]

    /// What the set-points x, a row each, make the axis ask for, and what follows that.
    std::vector<double> follows(std::span<const double> x, double period) const {
        return lagged(delayed(rate > 0 ? at_most_as_fast(x, rate * period) : std::vector(x.begin(), x.end()),
                              period, delay),
                      period, lag);
    }
    /// The number of a freed delay or lag.
    double& late(term t) { return t == term::delay ? delay : lag; }
    double late(term t) const { return t == term::delay ? delay : lag; }
    bool has(term t) const { return std::find(freed.begin(), freed.end(), t) != freed.end(); }
};

inline constexpr int smooth_terms = 4; ///< Legendre polynomials of order 2 to 5

/// Legendre polynomial of this order (0 to 5) at u, -1 to 1.
inline double legendre(int order, double u) {
    double before = 1, now = u;
    if (order == 0) return 1;
    for (int n = 1; n < order; ++n) {
        const double next = ((2 * n + 1) * u * now - n * before) / (n + 1);
        before = now;
        now = next;
    }
    return now;
}
/// Sum of the Legendre polynomials of order 2 on over a stretch of the travel.
inline double smooth_curve(const link_model& m, double x) {
    const double u = 2 * (x - m.smooth_from) / (m.smooth_to - m.smooth_from) - 1;
    double out = 0;
    for (std::size_t i = 0; i < m.smooth.size(); ++i) out += m.smooth[i] * legendre(static_cast<int>(i) + 2, u);
    return out;
}

/// What the last reading is beside the first, with all that is described or set taken off, and the columns that
/// explain it.
struct equations {
    std::vector<std::size_t> rows; ///< of the record, that count
    Eigen::VectorXd difference;    ///< [m]
    Eigen::MatrixXd
        columns; ///< those that no cause has come first, then those of the freed terms in their order
    std::vector<std::optional<term>> of; ///< of each column; none: no cause has it
};

} // namespace quadrant::inline v0::diagnosis::chain
