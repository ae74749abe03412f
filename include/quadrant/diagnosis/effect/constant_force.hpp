// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// A force that never changes: gravity on a tilted axis, an amplifier's offset. Joins the force, with the
/// motor's sign. Shows as a residual with a mean.
inline constexpr effect constant_force{
    .name = "constant_force",
    .label = "constant force",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "the same stroke in both directions, and rest after each",
    .equivalent = {"asymmetric_friction"},
    .everyday = true,
    .shows = "a mean",
    .keys = {machine_key{.name = "constant_force_N",
                         .rule = detail::rule::any_number,
                         .meaning = "added to the motor's force",
                         .at = member<&plant_description::constant_force_N>,
                         .of = [](plant_model& p) -> double& { return p.constant_force; },
                         .tolerance = true}},
    .prior = {0.5, "gravity on a tilted axis and the offset of an amplifier are everyday"},
    .compensation = "a constant command",
    .remedy = "Add the constant command found; look for gravity without counterweight, or trim the offset of "
              "the amplifier.",
    .trial = {.low = 1e-4,
              .high = 0.3,
              .into =
                  [](trial_machine& m) {
                      m.set("constant_force_N", m.sign() * m.amplitude * m.around.peak_force);
                  },
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double most = 3 * s.force_scale(); // the command holds it, by a force constant that may be wrong
        const double mean = detail::mean_residual(s, [](std::size_t) { return true; });
        return {{{.key = "constant_force_N",
                  .of = [](plant_model& p) -> double& { return p.constant_force; },
                  .start = std::clamp(s.leader.constant_force - mean, -most, most),
                  .low = -most,
                  .high = most,
                  .step = 1e-6 * s.force_scale()}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"constant_force_N", {p.constant_force}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
