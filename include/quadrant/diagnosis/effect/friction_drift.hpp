// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Fc (1 + drift (1 - exp(-t / time))) sign(v): the Coulomb level changes over the log, as the guides warm up.
/// Joins the force, in the friction box. Shows as the same stroke that needs another force later.
inline constexpr effect friction_drift{
    .name = "friction_drift",
    .label = "friction that drifts with time",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "the same stroke repeated for longer than the machine takes to warm up",
    .shows = "friction whose level changes over the log",
    .keys = {machine_key{.name = "friction_drift",
                         .rule = detail::rule::above_minus_one,
                         .meaning = "Coulomb level times 1 + drift (1 - exp(-t / time))",
                         .at = member<&plant_description::friction_drift>,
                         .needs = {"friction_drift_time_s"},
                         .percent = true},
             machine_key{.name = "friction_drift_time_s",
                         .rule = detail::rule::positive,
                         .meaning = "time in which it has changed by 1 - 1/e",
                         .at = member<&plant_description::friction_drift_time_s>,
                         .needs = {"friction_drift"}}},
    .prior = {0.1, "machines warm up, but a log of seconds is short against that"},
    .remedy = "Warm the machine up before it works, or add a disturbance observer; one level of feedforward is "
              "right at one time only.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "warm up, or a disturbance observer: a feedforward of one level is right at one time only";
    },
    .trial = {.low = 0.01,
              .high = 2,
              .into =
                  [](trial_machine& m) {
                      const double drift = m.chance(0.7)
                                               ? -m.amplitude / (1 + m.amplitude) // warming oil: less friction
                                               : m.amplitude;
                      m.set("friction_drift", drift);
                      m.set("friction_drift_time_s", m.around.seconds * m.log_uniform(0.15, 1));
                  },
              .needs_coulomb = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (!(s.leader.friction.coulomb > 0)) return {};
        const auto n = static_cast<double>(detail::rows_of_first_log(s));
        const double duration = n * s.record.period;
        const auto level = [&](double from, double to) {
            double sum = 0, count = 0;
            for (auto k = static_cast<std::size_t>(from * n); k < static_cast<std::size_t>(to * n); ++k)
                if (const double v = s.record.velocity[k]; v != 0) {
                    sum += v > 0 ? s.residual[k] : -s.residual[k];
                    ++count;
                }
            return count > 0 ? sum / count : 0;
        };
        // Share of the whole change that lies between the first third and the last.
        const auto shows = [](double time) {
            const auto gone = [&](double at) { return std::exp(-at / time); };
            return 3 * time * ((gone(0) - gone(1.0 / 3)) - (gone(2.0 / 3) - gone(1)));
        };
        const double change = (level(0.67, 1) - level(0, 0.33)) / s.leader.friction.coulomb;
        std::vector<std::vector<parameter>> out;
        for (double time : {0.15, 2.0}) {
            const double drift = std::clamp(change / shows(time), -0.9, 10.0);
            out.push_back({{.key = "friction_drift",
                            .of = [](plant_model& p) -> double& { return p.friction.drift_rate; },
                            .start = drift / (time * duration),
                            .low = -20 / duration,
                            .high = 100 / duration,
                            .step = 1e-3 / duration},
                           {.key = "friction_drift_time_s",
                            .of = [](plant_model& p) -> double& { return p.friction.drift_time; },
                            .start = time * duration,
                            .low = 0.02 * duration,
                            .high = 10 * duration,
                            .logarithmic = true,
                            .step = 1e-2}});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"friction_drift", {p.friction.drift()}}, {"friction_drift_time_s", {p.friction.drift_time}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
