// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// The command acts later (or earlier) than described: u(t - delay). Joins the actuator. Shows as a phase that
/// grows with frequency while the amplitude stays.
inline constexpr effect time_delay{
    .name = "time_delay",
    .label = "time delay",
    .box = "actuator",
    .joins = joint::command,
    .exciting_motion = "multi-sine of 20 to 200 Hz, or sharp starts and stops",
    .shows = "phase that grows with frequency",
    .keys = {machine_key{
        .name = "delay_s",
        .rule = detail::rule::up_to_a_second,
        .meaning = "from the sample instant to the command's first action; the hold is not part of it",
        .at = member<&plant_description::delay_s>,
        .tolerance = true}},
    .prior = {0.6, "buses and sampled drives delay by a period or two that no file mentions"},
    .remedy =
        "Shorten the path of the command, or run the reference ahead by the delay; lower the gains until then.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format(
                "no feedforward takes a delay out of a loop: shorten the way of the command (now {:.3g} "
                "ms), or run the reference ahead by it (preview), so that what is fed forward comes in "
                "time",
                1e3 * p.delay);
        },
    .trial = {.low = 2e-5,
              .high = 0.02,
              .into = [](trial_machine& m) { m.set("delay_s", m.now("delay_s") + m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double t = s.record.period, response = s.record.scale.response(), now = s.leader.delay;
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.delay; };
        // The lower end, inside one period; a delay to which the loop responds; what looking finds: no slope
        // leads over the cycles of a command that is far too late.
        std::vector<double> starts{now + 0.1 * t, now + 0.4 * response}, far;
        for (double times : {1.0, 1.6, 2.5, 4.0, 6.0, 9.0, 13.0}) far.push_back(now + times * response);
        const double best = detail::best_start(s, of, far);
        if (best > far.front()) starts.push_back(best);
        std::vector<std::vector<parameter>> out;
        for (double start : starts)
            out.push_back({{.key = "delay_s",
                            .of = of,
                            .start = start,
                            .low = 0,
                            .high = now + 20 * response,
                            .step = 0.02 * t}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"delay_s", {p.delay}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
