// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// The gains of the drives, each a number of one kind or two.
inline constexpr std::array<std::pair<const char*, double drive_model::*>, 5> drive_gains{
    {{"drive.velocity_per_V", &drive_model::velocity_per_V},
     {"drive.velocity_gain_N_s_per_m", &drive_model::velocity_gain},
     {"drive.velocity_integral_N_per_m", &drive_model::velocity_integral},
     {"drive.position_gain_per_s", &drive_model::position_gain},
     {"drive.position_gain_per_m", &drive_model::duty_gain}}};

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// A gain inside the drive differs: the velocity of a volt, P or I of the velocity loop, P of the position
/// loop, duty of a position error. Joins the drive. Shows as a force that follows the drive's own error.
inline constexpr effect drive_gain{
    .name = "drive_gain",
    .label = "gain inside the drive",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "strokes at several speeds and accelerations, with a rest against a known load",
    .equivalent = {"supply_voltage", "force_constant"},
    .shows = "follows the error inside the drive",
    .keys = {machine_key{.name = "drive.velocity_per_V",
                         .rule = detail::rule::positive,
                         .meaning = "velocity that a command of one volt asks for",
                         .at = member<&drive_description::velocity_per_V>,
                         .of = [](plant_model& p) -> double& { return p.drive.velocity_per_V; },
                         .neutral = 1,
                         .tolerance = true},
             machine_key{.name = "drive.velocity_gain_N_s_per_m",
                         .rule = detail::rule::positive,
                         .meaning = "P of the velocity loop: force of a velocity error",
                         .at = member<&drive_description::velocity_gain_N_s_per_m>,
                         .of = [](plant_model& p) -> double& { return p.drive.velocity_gain; },
                         .tolerance = true},
             machine_key{.name = "drive.velocity_integral_N_per_m",
                         .rule = detail::rule::positive,
                         .meaning =
                             "I of the velocity loop: growth of the force with a lasting velocity error; "
                             "absent: a P loop",
                         .at = member<&drive_description::velocity_integral_N_per_m>,
                         .of = [](plant_model& p) -> double& { return p.drive.velocity_integral; },
                         .tolerance = true},
             machine_key{.name = "drive.position_gain_per_s",
                         .rule = detail::rule::positive,
                         .meaning = "P of the position loop: velocity asked for by a position error",
                         .at = member<&drive_description::position_gain_per_s>,
                         .of = [](plant_model& p) -> double& { return p.drive.position_gain; },
                         .tolerance = true},
             machine_key{.name = "drive.position_gain_per_m",
                         .rule = detail::rule::positive,
                         .meaning = "duty of a position error, of a position servo",
                         .at = member<&drive_description::position_gain_per_m>,
                         .of = [](plant_model& p) -> double& { return p.drive.duty_gain; },
                         .tolerance = true}},
    .prior = {0.6, "gains are turned at the drive and the file is not"},
    .remedy = "Read the gains out of the drive, or set them to the values found: no command makes up for a "
              "loop that is softer.",
    .trial = {.low = 0.01,
              .high = 2,
              .into =
                  [](trial_machine& m) {
                      std::vector<const char*> there;
                      for (const auto& [key, of] : detail::drive_gains)
                          if (m.described(key) > 0) there.push_back(key);
                      const char* const key =
                          there[static_cast<std::size_t>(m.whole(0, static_cast<int>(there.size()) - 1))];
                      m.set(key, m.changed(m.described(key)));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        std::vector<std::vector<parameter>> out;
        const auto& d = s.leader.drive;
        const auto add = [&](const char* key, double& (*of)(plant_model&)) {
            detail::free_if_there(out, s, key, of);
        };
        if (d.kind == drive_kind::velocity && s.record.observer.drive->in_volts)
            add("drive.velocity_per_V", [](plant_model& p) -> double& { return p.drive.velocity_per_V; });
        if (d.has_velocity_loop()) {
            add("drive.velocity_gain_N_s_per_m",
                [](plant_model& p) -> double& { return p.drive.velocity_gain; });
            add("drive.velocity_integral_N_per_m",
                [](plant_model& p) -> double& { return p.drive.velocity_integral; });
        }
        if (d.kind == drive_kind::position)
            add("drive.position_gain_per_s", [](plant_model& p) -> double& { return p.drive.position_gain; });
        if (d.kind == drive_kind::position_servo)
            add("drive.position_gain_per_m", [](plant_model& p) -> double& { return p.drive.duty_gain; });
        return out;
    },
    .read = [](const plant_model& p) { return detail::farthest(p, detail::drive_gains); }};

} // namespace quadrant::inline v0::diagnosis::suspect
