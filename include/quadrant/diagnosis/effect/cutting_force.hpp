// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

#include <algorithm>
#include <set>

namespace quadrant::inline v0::diagnosis::detail {
inline harmonics& cutting_force_harmonics(plant_model& p) { return p.cutting; }
} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Force periodic in time: mean + sum of N_i sin(2 pi i f t + phase_i), a turning cutter or spindle. Joins the
/// force. Shows as lines in the frequency of the residual that no motion shifts. The mean cannot be
/// distinguished from a constant force, and the integral of a drive's loop hides it; the phase begins anew with
/// each log. The fundamental up to three times the corner: above, rounding of the encoder makes limit cycles;
/// four rows a turn at least.
inline constexpr effect cutting_force{
    .name = "cutting_force",
    .label = "cutting force",
    .box = "process",
    .joins = joint::force,
    .exciting_motion = "rest and slow strokes with the process running, and again with it off",
    .holds = "constant_force",
    .shows = "lines in frequency that no motion shifts",
    .keys = {machine_key{.name = "process.fundamental_Hz",
                         .rule = detail::rule::positive,
                         .meaning = "of the process",
                         .at = member<&process_description::fundamental_Hz>,
                         .needs = {"force_N"}},
             machine_key{
                 .name = "process.force_N",
                 .rule = detail::rule::any_number,
                 .meaning = "force: mean + sum of N_i sin(2 pi i f t + phase_i), t from the first row of a log",
                 .at = member<&process_description::force_N>,
                 .needs = {"fundamental_Hz"},
                 .shape = key_shape::harmonics,
                 .components = detail::components_of<detail::cutting_force_harmonics>,
                 .tolerance = true},
             machine_key{.name = "process.phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "of each harmonic",
                         .at = member<&process_description::phase_rad>,
                         .entries_of = "force_N",
                         .shape = key_shape::harmonics},
             machine_key{.name = "process.mean_N",
                         .rule = detail::rule::any_number,
                         .meaning = "mean force",
                         .at = member<&process_description::mean_N>,
                         .of = [](plant_model& p) -> double& { return p.cutting_mean; },
                         .tolerance = true}},
    .prior = {0.1, "only where a process runs while the log is recorded"},
    .remedy =
        "Use a harmonic force observer or repetitive control at the frequency found; balance spindle and tool.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format(
                "a harmonic force observer or repetitive control at {:.4g} Hz: when the process begins is "
                "not known beforehand",
                p.cutting.period > 0 ? 1 / p.cutting.period : 0.0);
        },
    .trial = {.low = 1e-4,
              .high = 0.3,
              .into =
                  [](trial_machine& m) {
                      const int harmonics = m.whole(1, 4);
                      m.set("process.fundamental_Hz",
                            m.log_uniform(8, std::min(120.0, 0.15 / m.around.period)));
                      const double size = m.amplitude * m.around.peak_force;
                      m.set_harmonics("process.force_N", "process.phase_rad", harmonics, size);
                      m.set_untold("process.mean_N", {m.chance(0.3) ? 0.5 * size : 0});
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double duration = detail::recorded_time(s),
                     most = 10 * s.force_scale(); // the loop may be too slow to answer
        const auto time = detail::times_in_their_logs(s);
        const double cycle = 1 / s.record.scale.corner_Hz; // of the corner
        const double shortest = std::max(0.3 * cycle, 4 * s.record.period), longest = 30 * cycle;
        std::vector<std::vector<parameter>> out;
        for (double period :
             detail::comb_periods<4>(s.residual, time, longest, shortest, s.record.score.skip)) {
            if (detail::motion_repeats(s.record.position, period / s.record.period) ||
                detail::strokes_repeat(s.record, period) || detail::bound_to_position(s, period, time))
                continue;
            const auto all = detail::repeating<detail::cutting_force_harmonics, 8>(
                "process.fundamental_Hz", "process.force_N", period, duration, most);
            // Near half of the rows' rate and above a harmonic is another one under a second name.
            const auto held = std::min(8L, static_cast<long>(period / (2.5 * s.record.period)));
            for (const long many : std::set{std::min(4L, held), held})
                out.emplace_back(all.begin(), all.begin() + 1 + 2 * many); // period, then two a harmonic
        }
        // Where a drive's integral begins stands for any mean, unless what the drive gives was measured.
        if (s.leader.drive.has_integral() && !s.record.taps_force(s.leader.drive)) return out;
        for (auto& start : out)
            start.push_back({.key = "process.mean_N",
                             .of = [](plant_model& p) -> double& { return p.cutting_mean; },
                             .start = 0,
                             .low = -most,
                             .high = most,
                             .step = 1e-6 * s.force_scale()});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"process.fundamental_Hz", {1 / p.cutting.period}},
                {"process.force_N", p.cutting.sizes()},
                {"process.phase_rad", p.cutting.phases()},
                {"process.mean_N", {p.cutting_mean}}};
    },
    .join = [](plant_model& p, const screening&) { p.cutting.count = 8; }};

} // namespace quadrant::inline v0::diagnosis::suspect
