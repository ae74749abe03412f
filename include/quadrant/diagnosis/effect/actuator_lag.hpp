// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// A current loop of first order, 1/(lag s + 1), behind the command. Joins the actuator. Shows as a phase that
/// bends and an amplitude that falls with frequency, where a delay keeps the amplitude.
inline constexpr effect actuator_lag{
    .name = "actuator_lag",
    .label = "current-loop lag",
    .box = "actuator",
    .joins = joint::command,
    .exciting_motion = "multi-sine of 20 to 300 Hz, or sharp starts and stops",
    .ends_inside = {"actuator.lag_s"}, // so long that little of the command passes, it is none
    .shows = "phase that bends, amplitude that falls",
    .keys = {machine_key{.name = "actuator.lag_s",
                         .rule = detail::rule::up_to_a_second,
                         .meaning = "time constant of the current loop, first order",
                         .at = member<&actuator_description::lag_s>,
                         .of = [](plant_model& p) -> double& { return p.lag; },
                         .tolerance = true}},
    .prior = {0.4, "every current loop has one; most are faster than a position log can see"},
    .remedy = "Tune the current loop faster; use lower position and velocity gains until then.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format("a faster current loop (now {:.3g} ms); until then lower gains", 1e3 * p.lag);
        },
    .trial = {.low = 2e-5,
              .high = 0.02,
              .into = [](trial_machine& m) { m.set("actuator.lag_s", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double t = s.record.scale.response();
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.lag; };
        return {{{.key = "actuator.lag_s",
                  .of = of,
                  .start = detail::best_start(s, of, {0.06 * t, 0.2 * t, 0.6 * t, 1.6 * t}),
                  .low = 0.01 * t,
                  .high = 10 * t,
                  .logarithmic = true,
                  .step = 1e-2}}};
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.lag_s", {p.lag}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
