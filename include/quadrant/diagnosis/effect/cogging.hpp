// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::detail {
inline harmonics& cogging_harmonics(plant_model& p) { return p.cogging; }
} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Force periodic in position: sum of N_i sin(2 pi i x / period + phase_i), the magnets' pitch of a motor or
/// one turn of a screw. Joins the force. Shows as a residual that repeats with position whatever the speed; as
/// a motion it fades with the square of the speed, which distinguishes it from an encoder's cyclic error.
/// Periods up to
/// half the travel: a longer one is a slope or an offset by another name.
inline constexpr effect cogging{
    .name = "cogging",
    .label = "cogging",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "slow strokes in both directions over several periods",
    .ends_inside = {"cogging_period_m"}, // a slope, a bend, or one bump along the travel has no period
    .shows = "periodic in position, up to half the travel",
    .keys = {machine_key{.name = "cogging_period_m",
                         .rule = detail::rule::positive,
                         .meaning = "of the fundamental",
                         .at = member<&plant_description::cogging_period_m>,
                         .needs = {"cogging_N"},
                         .of = [](plant_model& p) -> double& { return detail::cogging_harmonics(p).period; },
                         .tolerance = true,
                         .unstated = 0},
             machine_key{.name = "cogging_N",
                         .rule = detail::rule::any_number,
                         .meaning = "force: sum of N_i sin(2 pi i x / period + phase_i)",
                         .at = member<&plant_description::cogging_N>,
                         .needs = {"cogging_period_m"},
                         .shape = key_shape::harmonics,
                         .components = detail::components_of<detail::cogging_harmonics>,
                         .tolerance = true},
             machine_key{.name = "cogging_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "of each harmonic",
                         .at = member<&plant_description::cogging_phase_rad>,
                         .entries_of = "cogging_N",
                         .shape = key_shape::harmonics}},
    .prior = {0.5, "every motor with iron has it; ironless motors do not"},
    .compensation = "cogging_harmonics at the reference",
    .remedy = "Feed the cogging forward over the position (cogging_harmonics), after the axis knows its "
              "absolute position.",
    .trial = {.low = 1e-4,
              .high = 0.5,
              .into =
                  [](trial_machine& m) {
                      const int harmonics = m.whole(1, 6);
                      m.set("cogging_period_m", m.passed_period());
                      m.set_harmonics("cogging_N", "cogging_phase_rad", harmonics,
                                      m.amplitude * m.around.peak_force);
                  },
              .slow_shows_it = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double travel = detail::travel(s);
        std::vector<std::vector<parameter>> out;
        const double shortest = std::max(travel / 400, 8 * s.record.resolution);
        const auto& x = s.record.position;
        for (double period :
             detail::comb_periods_along<8>(s.residual, x, 0.5 * travel, shortest, s.record.score.skip)) {
            const auto repeats = detail::holds_more_than_three(s, period)
                                     ? detail::repeating<detail::cogging_harmonics, 8>
                                     : detail::repeating<detail::cogging_harmonics, 3>;
            out.push_back(repeats("cogging_period_m", "cogging_N", period, travel, s.force_scale()));
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"cogging_period_m", {p.cogging.period}},
                {"cogging_N", p.cogging.sizes()},
                {"cogging_phase_rad", p.cogging.phases()}};
    },
    .join = [](plant_model& p, const screening&) { p.cogging.count = harmonics::most; }};

} // namespace quadrant::inline v0::diagnosis::suspect
