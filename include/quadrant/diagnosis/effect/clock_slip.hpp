// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_suspect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The drive's clock runs slower or faster than the controller's: now and then a set-point never arrives, or
/// comes twice, and between these moments its age grows or shrinks by a period. Joins the drive.
inline constexpr effect clock_slip{
    .name = "clock_slip",
    .label = "clocks that slip",
    .box = "drive",
    .joins = joint::command,
    .exciting_motion = "a long record with fast strokes: at 50 ppm and 1 kHz a set-point is lost every 20 s",
    .equivalent = {"set_point_loss", "command_delay"},
    .shows = "a delay that grows by one period of the set-points and jumps back, over and over",
    .keys = {machine_key{
        .name = "drive.clock_slip",
        .rule = detail::rule::asymmetry,
        .meaning = "share that a period of the drive's clock is longer than the controller's; signed; "
                   "absent: 0",
        .at = member<&drive_description::clock_slip>}},
    .prior = {0.1, "a bus without synchronous clocks; with distributed clocks none"},
    .remedy =
        "Synchronise the clocks of bus and controller (distributed clocks, or the reference clock of the bus).",
    .trial = {.low = 2e-5,
              .high = 2e-4,
              .into = [](trial_machine& m) { m.set("drive.clock_slip", m.sign() * m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const auto& d = s.leader.drive;
        if (d.kind != drive_kind::position && d.kind != drive_kind::position_servo) return {};
        const double every = d.set_point_period > 0 ? d.set_point_period : s.record.period;
        const double set_points = static_cast<double>(s.record.position.size()) * s.record.period / every;
        constexpr double quartz = 2e-4; // no two of them differ by more
        // A third of a period over the record: a slope leads from one to the next. A slip of less is a delay.
        const double step = 0.3 / set_points;
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.drive.clock_slip; };
        std::vector<std::vector<parameter>> out;
        for (const double sign : {1.0, -1.0}) {
            std::vector<double> values;
            for (double slip = step; slip < quartz; slip += step) values.push_back(sign * slip);
            if (values.empty()) return {};
            const double ends[] = {sign * step, sign * 1.5 * quartz};
            out.push_back({{.key = "drive.clock_slip",
                            .of = of,
                            .start = detail::best_start(s, of, values),
                            .low = std::min(ends[0], ends[1]),
                            .high = std::max(ends[0], ends[1]),
                            .step = 0.1 * step}});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"drive.clock_slip", {p.drive.clock_slip}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
