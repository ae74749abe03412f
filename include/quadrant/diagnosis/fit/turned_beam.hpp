// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../machine/machine.hpp"
#include "regression.hpp"
#include "scoring.hpp"

#include <fmt/format.h>

namespace quadrant::inline v0::diagnosis {

/// What the forces of two motors on one beam say of its ends. Of a rigid beam that its guides let turn, each
/// end needs its own friction and its share of the mass, and the motors' turn
///   w = (1 - share) u1 - share u2
/// holds what the described share does not: share of the mass, friction by end, and the force with which the
/// two push against each other. Only what is more than a law of friction is wrong by, and sure, is told.
inline std::vector<std::string> told_by_turn(const axis_description& axis, const axis_log& log, double period) {
    std::vector<std::string> out;
    if (!log.turn || log.turn->command.empty()) return out;
    const beam_turn& turn = *log.turn;
    axis_log turned = log;
    turned.command = turn.command;
    const axis_regression all = regress(log, period), w = regress(turned, period);
    const double constant = axis.plant.force_constant_N_per_V, much = law_error * constant * rms(log.command);
    const auto matters = [&](const regressed& r, double size) { return r.sure() && constant * size > much; };
    const std::string unit = key_of("N", axis.kind) == "N" ? "N" : "N m";
    if (matters(w.direction, std::abs(w.direction.value))) {
        const double first = constant * (turn.share * all.direction.value + w.direction.value),
                     second = constant * ((1 - turn.share) * all.direction.value - w.direction.value),
                     error = 2 * constant * std::hypot(w.direction.spread, all.direction.spread);
        out.push_back(
            fmt::format("axis {}: friction is {:.3g} {} at end {} and {:.3g} {} at end {} (each to {:.2g} "
                        "{}), if nothing but friction turns the beam.",
                        axis.name, first, unit, turn.first, second, unit, turn.second, error, unit));
    }
    if (all.acceleration.sure() &&
        matters(w.acceleration,
                std::abs(w.acceleration.value) / std::abs(all.acceleration.value) * rms(log.command))) {
        const double share = turn.share + w.acceleration.value / all.acceleration.value;
        out.push_back(
            fmt::format("axis {}: {:.0f} % of the mass are at end {}, where gantry_pair.share says {:.0f} %.",
                        axis.name, 100 * share, turn.first, 100 * turn.share));
    }
    if (matters(w.mean, std::abs(w.mean.value)))
        out.push_back(
            fmt::format("axis {}: the motors push against each other with {:.3g} {} all the time: the beam "
                        "is held out of square.",
                        axis.name, constant * std::abs(w.mean.value), unit));
    return out;
}

} // namespace quadrant::inline v0::diagnosis
