// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// The sine and cosine of the position that the residual force holds, beside friction that is not modelled
/// either:
/// -residual = sine sin q + cosine cos q + viscous v + coulomb sign v.
inline Eigen::Vector2d weight_in_residual(const screening& s) {
    const double fast = 0.01 * s.record.scale.speed;
    Eigen::Matrix4d left = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = s.record.score.skip; k < s.residual.size(); ++k) {
        const double q = s.record.position[k], v = s.record.velocity[k];
        const Eigen::Vector4d row(std::sin(q), std::cos(q), v, v > fast ? 1 : v < -fast ? -1 : 0);
        left += row * row.transpose();
        right -= s.residual[k] * row;
    }
    return solved(left, right).head<2>();
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Torque -m g l sin(q - q0): the weight of an arm, a tilting table, an unbalanced chuck. Joins the force of a
/// rotary axis. Shows as a residual that follows the sine of the position, at rest too. Over a small angle a
/// sine is a constant force and a
/// spring: one group there.
inline constexpr effect gravity{
    .name = "gravity",
    .label = "gravity",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "slow strokes in both directions over half a turn or more, with rest at several angles",
    .equivalent = {"constant_force", "position_spring"},
    .everyday = true,
    .shows = "a sine of the position over one turn",
    .keys = {machine_key{.name = "gravity_torque_Nm",
                         .rule = detail::rule::not_negative,
                         .meaning = "torque -gravity_torque_Nm sin(q - gravity_phase_rad), of a rotary axis",
                         .at = member<&plant_description::gravity_torque_Nm>,
                         .of = [](plant_model& p) -> double& { return p.gravity.torque; },
                         .tolerance = true},
             machine_key{.name = "gravity_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "position at which the weight hangs down, of a rotary axis",
                         .at = member<&plant_description::gravity_phase_rad>,
                         .needs = {"gravity_torque_Nm"}}},
    .rotary_only = true,
    .prior = {1, "arms, tilting tables and unbalanced chucks carry their weight round"},
    .remedy = "Add the torque of the weight at the reference to the command, or balance the axis.",
    .advice =
        [](const plant_model& p, double, std::string_view unit) {
            return fmt::format("{:.3g} {} sin(q - {:.3g} rad) of the reference in the command (not simulated "
                               "here)",
                               p.gravity.torque / p.force_constant, unit, p.gravity.phase);
        },
    .trial = {.low = 0.01,
              .high = 2,
              .into =
                  [](trial_machine& m) {
                      m.set("gravity_torque_Nm", m.changed(m.described("gravity_torque_Nm")));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const auto& now = s.leader.gravity;
        const Eigen::Vector2d missing = detail::weight_in_residual(s);
        const double sine = missing[0] - now.torque * std::cos(now.phase),
                     cosine = missing[1] + now.torque * std::sin(now.phase);
        const double torque = std::hypot(sine, cosine), phase = std::atan2(cosine, -sine);
        if (!(torque > 0)) return {};
        return {{{.key = "gravity_torque_Nm",
                  .of = [](plant_model& p) -> double& { return p.gravity.torque; },
                  .start = torque,
                  .low = 0.01 * torque,
                  .high = s.farthest(20 * torque, s.force_scale()),
                  .logarithmic = true,
                  .step = 1e-3},
                 {.key = "gravity_phase_rad", // a full turn: no bound on the way
                  .of = [](plant_model& p) -> double& { return p.gravity.phase; },
                  .start = phase,
                  .low = phase - std::numbers::pi,
                  .high = phase + std::numbers::pi,
                  .step = 1e-4}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"gravity_torque_Nm", {p.gravity.torque}},
                {"gravity_phase_rad", {std::remainder(p.gravity.phase, 2 * std::numbers::pi)}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
