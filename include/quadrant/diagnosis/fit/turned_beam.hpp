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
/// two push against each other. Only what is more than a law of friction is wrong by, and sure, is told. Guides
/// that hold the beam take any turn: there both shares are how the commands are split.
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
    const auto part = [](const regressed& of_w, const regressed& of_all) { // of the first end, and its error
        return std::pair(of_w.value / of_all.value,
                         std::hypot(of_w.spread, of_all.spread) / std::abs(of_all.value));
    };
    const auto [friction, friction_error] = part(w.direction, all.direction);
    const auto [mass, mass_error] = part(w.acceleration, all.acceleration);
    const bool by_direction = matters(w.direction, std::abs(w.direction.value)),
               by_acceleration =
                   all.acceleration.sure() && matters(w.acceleration, std::abs(mass) * rms(log.command)),
               alike =
                   by_direction && by_acceleration && all.direction.sure() &&
                   std::abs(friction - mass) < std::max(law_error, 3 * std::hypot(friction_error, mass_error));
    if (alike) {
        out.push_back(fmt::format(
            "axis {}: end {} has {:.0f} % of the friction and of the accelerating force, where "
            "gantry_pair.share says {:.0f} %: the commands are split so while guides hold the beam, or "
            "friction and mass lie so.",
            axis.name, turn.first, 100 * (turn.share + mass), 100 * turn.share));
    } else if (by_direction) {
        const double first = constant * (turn.share * all.direction.value + w.direction.value),
                     second = constant * ((1 - turn.share) * all.direction.value - w.direction.value),
                     error = 2 * constant * std::hypot(w.direction.spread, all.direction.spread);
        out.push_back(
            fmt::format("axis {}: friction is {:.3g} {} at end {} and {:.3g} {} at end {} (each to {:.2g} "
                        "{}), if nothing but friction turns the beam.",
                        axis.name, first, unit, turn.first, second, unit, turn.second, error, unit));
    }
    if (by_acceleration && !alike)
        out.push_back(
            fmt::format("axis {}: {:.0f} % of the mass are at end {}, where gantry_pair.share says {:.0f} %.",
                        axis.name, 100 * (turn.share + mass), turn.first, 100 * turn.share));
    if (matters(w.mean, std::abs(w.mean.value)))
        out.push_back(
            fmt::format("axis {}: the motors push against each other with {:.3g} {} all the time: the beam "
                        "is held out of square.",
                        axis.name, constant * std::abs(w.mean.value), unit));
    return out;
}

} // namespace quadrant::inline v0::diagnosis
