// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The drive clips below the limit that the controller knows. Joins the actuator. Shows only while the command
/// is large: the axis gets less than it was told, always the same force.
inline constexpr effect actuator_saturation{
    .name = "actuator_saturation",
    .label = "drive limit below the controller's",
    .box = "actuator",
    .joins = joint::command,
    .exciting_motion = "the strongest acceleration that the program uses, and half of it",
    .ends_inside = {"actuator.drive_limit_V"}, // so low that little of the command passes, it is none
    .shows = "only while the command is large",
    .keys = {machine_key{.name = "actuator.drive_limit_V",
                         .rule = detail::rule::positive,
                         .meaning = "limit of the drive, below the controller's own",
                         .at = member<&actuator_description::drive_limit_V>,
                         .of = [](plant_model& p) -> double& { return p.drive_limit; },
                         .neutral = std::numeric_limits<double>::infinity(),
                         .tolerance = true}},
    .prior = {0.2, "current limits are set by hand and forgotten"},
    .remedy = "Command less acceleration or raise the current limit of the drive: what is cut off cannot be "
              "fed forward.",
    .advice =
        [](const plant_model& p, double, std::string_view unit) {
            return fmt::format(
                "a lower acceleration, or a drive that gives more than {:.3g} {}: what is cut off "
                "cannot be fed forward",
                p.drive_limit, unit);
        },
    .trial = {.low = 0.002,
              .high = 0.7,
              .into =
                  [](trial_machine& m) {
                      m.set("actuator.drive_limit_V", m.around.peak_command * (1 - m.amplitude));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double most = detail::largest_command(s);
        if (!(most > 0)) return {};
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive_limit; };
        return {{detail::limit_below(s, "actuator.drive_limit_V", of, most)}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.drive_limit_V", {p.drive_limit}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
