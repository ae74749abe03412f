// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The servo follows its set-points at most so fast: a profile velocity in its registers. Joins the drive.
/// Shows while the set-points move faster.
inline constexpr effect setpoint_rate_limit{
    .name = "setpoint_rate_limit",
    .label = "profile velocity of the servo",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "strokes at rising speeds, up to the fastest in use",
    .shows = "while the set-points move fast",
    .keys = {machine_key{.name = "drive.setpoint_rate_limit_m_per_s",
                         .rule = detail::rule::positive,
                         .meaning = "at most, of the set-point that the servo follows; absent: no limit",
                         .at = member<&drive_description::setpoint_rate_limit_m_per_s>,
                         .of = [](plant_model& p) -> double& { return p.drive.rate_limit; },
                         .neutral = drive_model::none,
                         .tolerance = true}},
    .prior = {0.2, "profile velocities are set once and forgotten"},
    .remedy = "Read the servo's profile velocity, and raise it or ask for slower motion.",
    .trial = {.low = 0.02,
              .high = 4,
              .into =
                  [](trial_machine& m) {
                      m.set("drive.setpoint_rate_limit_m_per_s", m.around.peak_velocity / (1 + m.amplitude));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (s.leader.drive.kind != drive_kind::position_servo) return {};
        const auto& r = s.record.observer.drive->set_point;
        double most = 0;
        for (double v : derivative(zero_phase(r, s.record.scale.corner_Hz, s.record.period), s.record.period))
            most = std::max(most, std::abs(v));
        if (!(most > 0)) return {};
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive.rate_limit; };
        return {
            {{.key = "drive.setpoint_rate_limit_m_per_s",
              .of = of,
              .start = detail::best_start(s, of, {0.9 * most, 0.7 * most, 0.5 * most, 0.35 * most, 0.2 * most}),
              .low = 0.02 * most,
              .high = 1.5 * most,
              .logarithmic = true,
              .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.setpoint_rate_limit_m_per_s", {p.drive.rate_limit}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
