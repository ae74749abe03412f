// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"
#include "rules.hpp"

#include <functional>

namespace quadrant::inline v0::diagnosis::detail {

/// Whether one gain is above another by more than a margin, and not in a few places only: the scatter of the
/// places where either has a say leaves one chance in a hundred.
inline bool everywhere(const std::vector<double>& gain, const std::vector<double>& other) {
    std::vector<double> more;
    for (std::size_t i = 0; i < gain.size(); ++i)
        if (std::abs(gain[i]) + std::abs(other[i]) > 0.1) more.push_back(gain[i] - other[i]);
    const double sum = std::accumulate(more.begin(), more.end(), 0.0), n = static_cast<double>(more.size());
    double squares = 0;
    for (double g : more) squares += (g - sum / n) * (g - sum / n);
    return n >= 4 && sum >= rules{}.margin && sum >= 2.33 * std::sqrt(squares * n / (n - 1));
}

/// The probability of a loss, counted and not fitted, where pulses in most places speak for losses clearly more
/// than for none and than for pulses of half or twice the size or turned over. `with`: what is found with
/// pulses of a size.
inline std::vector<std::vector<parameter>> counted_losses(const char* key, double& (*of)(plant_model&),
                                                          const std::function<lossy_commands(double)>& with) {
    const lossy_commands found = with(1);
    const double p = found.probability;
    if (found.told < 50 || p > 0.4) return {}; // no drive runs like that: something else makes the pulses
    if (!everywhere(found.gain_by_place, std::vector<double>(found.gain_by_place.size(), 0.0))) return {};
    for (double other : {-1.0, 0.5, 2.0})
        if (!everywhere(found.gain_by_place, with(other).gain_by_place)) return {};
    return {{{.key = key,
              .of = of,
              .start = p,
              .low = p / 2,
              .high = 2 * p,
              .logarithmic = true,
              .step = 1e-2,
              .expected = std::log(p),
              .spread = std::sqrt((1 - p) / (p * found.told))}}};
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// In some periods the drive keeps the previous command: a bus telegram that came too late. Joins the actuator.
/// Shows as pulses as large as what the command changed by in that period; see model/sample_loss.hpp for how
/// they are found. They are in most places: losses know nothing of the motion.
inline constexpr effect sample_loss{
    .name = "sample_loss",
    .label = "loss of command samples",
    .box = "actuator",
    .joins = joint::command,
    .exciting_motion = "multi-sine of 50 to 200 Hz: the command must change much in each period",
    .shows = "pulses as large as the command's change",
    .keys = {machine_key{.name = "actuator.loss_probability",
                         .rule = detail::rule::relative,
                         .meaning = "of a period in which the drive keeps the previous command",
                         .at = member<&actuator_description::loss_probability>,
                         .percent = true}},
    .prior = {0.03, "a healthy bus loses nothing; one with a bad plug or without real time does"},
    .remedy = "Repair the connection between controller and drive: plugs, shielding, real time of the host.",
    .advice = [](const plant_model&, double, std::string_view) -> std::string {
        return "repair the transmission: which periods lose their command is not known beforehand";
    },
    .trial = {.low = 0.001,
              .high = 0.2,
              .into = [](trial_machine& m) { m.set("actuator.loss_probability", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        plant_model plant = s.leader;
        plant.loss = 0;
        std::vector<double> without;
        if (s.leader.loss > 0) s.record.observer.run(plant, without);
        const auto& innovation = s.leader.loss > 0 ? without : s.innovation;
        return detail::counted_losses(
            "actuator.loss_probability", [](plant_model& q) -> double& { return q.loss; },
            [&](double size) {
                return s.record.observer.commands_with_loss(plant, innovation, {.learned = true, .size = size});
            });
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"actuator.loss_probability", {p.loss}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
