// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The drive gives less force, or less duty, than described at most. Joins the drive. Shows only while its
/// error is large.
inline constexpr effect drive_limit{
    .name = "drive_limit",
    .label = "limit inside the drive",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "the strongest acceleration that the program uses, and half of it",
    .equivalent = {"actuator_saturation"},
    .ends_inside = {"drive.force_limit_N"}, // so low that little of the force is left, it is none
    .shows = "only while the error inside the drive is large",
    .keys = {machine_key{.name = "drive.force_limit_N",
                         .rule = detail::rule::positive,
                         .meaning = "most that the velocity loop gives; absent: no limit",
                         .at = member<&drive_description::force_limit_N>},
             machine_key{.name = "drive.maximum_duty",
                         .rule = detail::rule::duty,
                         .meaning = "largest duty of a position servo; absent: 1",
                         .at = member<&drive_description::maximum_duty>}},
    .prior = {0.2, "limits are set by hand and forgotten"},
    .remedy = "Raise the limit in the drive, or ask for less acceleration.",
    .trial = {.low = 0.01,
              .high = 3,
              .into =
                  [](trial_machine& m) {
                      const double full = m.described("drive.supply_V") * m.described("force_constant_N_per_V");
                      const double most = m.around.peak_force / (1 + m.amplitude);
                      if (full > 0)
                          m.set("drive.maximum_duty", std::min(1.0, most / full));
                      else
                          m.set("drive.force_limit_N", most);
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double most = detail::most_given(s);
        if (!(most > 0)) return {};
        const bool servo = s.leader.drive.kind == drive_kind::position_servo;
        double& (*const of)(plant_model&) =
            servo ? [](plant_model& p) -> double& { return p.drive.maximum_duty; }
                  : [](plant_model& p) -> double& { return p.drive.force_limit; };
        const char* key = servo ? "drive.maximum_duty" : "drive.force_limit_N";
        if (s.record.observer.drive->tapped()) {
            // Without noise and lag the limit is the largest value that was measured: noise makes that larger,
            // a lag behind the limit smaller. No duty is above the largest.
            if (servo) return {{detail::limit_below(s, key, of, most, 0.9, {0.97, 0.99, 1})}};
            const double largest = 0.9;
            return {{detail::limit_below(
                s, key, of, most / largest, 0.9 * largest,
                {0.97 * largest, 0.99 * largest, largest, 1.03 * largest, 1.06 * largest})}};
        }
        if (servo) return {{detail::limit_below(s, key, of, most)}};
        const double taken = detail::most_taken(s) / most; // a law that winds up asks for a multiple of it
        std::vector<double> starts{0.97, 0.9, 0.8, 0.65, 0.5, 0.35, 0.2};
        for (const double share : {1.5, 1.2, 1.0, 0.8, 0.6})
            if (share * taken < starts.back()) starts.push_back(share * taken);
        return {{detail::limit_below(s, key, of, most, std::min(0.05, 0.3 * taken), std::move(starts))}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        if (p.drive.kind == drive_kind::position_servo) return {{"drive.maximum_duty", {p.drive.maximum_duty}}};
        return {{"drive.force_limit_N", {p.drive.force_limit}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
