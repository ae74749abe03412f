// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "own_effect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// The law: one number, one force.
inline constexpr own_law drag{.name = "quadratic_drag",
                              .numbers = {{{.key = "quadratic_N_s2_per_m2"}}},
                              .law = [](const law_point& now, const own_law::values& number, own_law::memory&) {
                                  return -number[0] * now.velocity * std::abs(now.velocity);
                              }};

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// F = -q v |v|: air that a fast table pushes, oil that a way cover squeezes, a fan. Joins the force. Shows as
/// a residual that grows with the square of the speed and turns its sign with it; viscous friction grows with
/// the speed itself.
inline constexpr effect quadratic_drag{
    .name = detail::drag.name,
    .label = "drag with the square of the speed",
    .box = detail::drag.box,
    .joins = detail::drag.joins,
    .exciting_motion = "the same stroke at three speeds, the fastest in use among them",
    .of_speed = true,
    .shows = "grows with the square of the speed",
    .keys = {machine_key{.name = detail::drag.numbers[0].key,
                         .rule = detail::rule::not_negative,
                         .meaning = "force -q v |v|",
                         .of = own_number<detail::drag, 0>,
                         .tolerance = true}},
    .law = &detail::drag,
    .prior = {0.05, "machine tools are too slow for it; fans, covers and axes in oil have it"},
    .remedy = "Add a command that grows with the square of the reference velocity; look for covers that "
              "pump air or oil.",
    .advice =
        [](const plant_model& p, double, std::string_view unit) {
            const double q = own_values<detail::drag>(p)[0].values[0];
            return fmt::format(
                "{:.3g} {} s^2/m^2 times v |v| of the reference in the command (not simulated here)",
                q / p.force_constant, unit);
        },
    .trial = {.low = 1e-3,
              .high = 0.6,
              .into =
                  [](trial_machine& m) {
                      const double speed = m.around.peak_velocity;
                      m.set(detail::drag.numbers[0].key, m.amplitude * m.around.peak_force / (speed * speed));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double ww = 0, wf = 0;
        for (std::size_t k = 0; k < s.residual.size(); ++k) {
            const double w = s.record.velocity[k] * std::abs(s.record.velocity[k]);
            ww += w * w;
            wf += w * s.residual[k];
        }
        const double described = own_values<detail::drag>(s.leader)[0].values[0], speed = s.record.scale.speed;
        std::vector<std::vector<parameter>> out;
        for (const double start : s.beginnings(described, ww > 0 ? wf / ww : 0))
            out.push_back({{.key = std::string(detail::drag.numbers[0].key),
                            .of = own_number<detail::drag, 0>,
                            .start = start,
                            .low = 0.01 * start,
                            .high = s.farthest(20 * start, s.force_scale() / (speed * speed)),
                            .logarithmic = true,
                            .step = 1e-3}});
        return out;
    },
    .read = own_values<detail::drag>};

} // namespace quadrant::inline v0::diagnosis::suspect
