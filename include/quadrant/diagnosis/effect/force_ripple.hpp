// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::detail {
inline harmonics& force_ripple_harmonics(plant_model& p) { return p.ripple; }
} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// kf (1 + ripple sin(2 pi x / period + phase)): the force of a motor varies with the magnets. Joins the
/// actuator's gain. Shows as a residual that repeats with position and grows with the command; without command
/// there is none, which distinguishes it from cogging.
inline constexpr effect force_ripple{
    .name = "force_ripple",
    .label = "force ripple",
    .box = "actuator",
    .joins = joint::motor_gain,
    .exciting_motion =
        "strokes over several periods with strong accelerations, or against a load, and the same slowly",
    .ends_inside = {"ripple_period_m"}, // a slope along the travel has no period
    .shows = "periodic in position, grows with the command",
    .keys = {machine_key{.name = "ripple",
                         .rule = detail::rule::asymmetry,
                         .meaning = "of the force constant over the position, relative",
                         .at = member<&plant_description::ripple>,
                         .needs = {"ripple_period_m"},
                         .components = detail::components_of<detail::force_ripple_harmonics>,
                         .tolerance = true,
                         .percent = true},
             machine_key{
                 .name = "ripple_period_m",
                 .rule = detail::rule::positive,
                 .meaning = "of that wave",
                 .at = member<&plant_description::ripple_period_m>,
                 .needs = {"ripple"},
                 .of = [](plant_model& p) -> double& { return detail::force_ripple_harmonics(p).period; },
                 .tolerance = true,
                 .unstated = 0},
             machine_key{.name = "ripple_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "of that wave",
                         .at = member<&plant_description::ripple_phase_rad>}},
    .prior = {0.2, "commutation is never perfect, but a few per cent hide behind friction"},
    .remedy = "Correct the commutation table of the drive: the force constant varies with the position of the "
              "magnets.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format(
                "divide the whole command by 1 + {:.3g} sin(2 pi x/{:.4g} m + {:.3g}), in the drive's "
                "commutation table: it grows with the command, which the reference does not know",
                std::hypot(p.ripple.sine[0], p.ripple.cosine[0]), p.ripple.period,
                std::atan2(p.ripple.cosine[0], p.ripple.sine[0]));
        },
    .trial = {.low = 0.002,
              .high = 0.5,
              .into =
                  [](trial_machine& m) {
                      m.set("ripple_period_m", m.passed_period());
                      m.set_harmonics("ripple", "ripple_phase_rad", 1, m.amplitude);
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double travel = detail::travel(s);
        // The command as the residual sees it: late by the delay, and below the same band.
        const auto late = static_cast<std::size_t>(std::lround(s.leader.delay / s.record.period));
        std::vector<double> command(s.residual.size());
        for (std::size_t k = 0; k < command.size(); ++k) command[k] = s.record.command[k - std::min(k, late)];
        command = zero_phase(command, s.record.bandwidth_Hz, s.record.period);
        for (std::size_t k = 0; k < s.record.left_out.size(); ++k)
            if (s.record.left_out[k]) command[k] = 0;
        std::vector<std::vector<parameter>> out;
        for (double period :
             carried_peaks(s.residual, command, s.record.position, 0.5 * travel,
                           std::max(travel / 400, 8 * s.record.resolution), 2, s.record.score.skip))
            out.push_back(detail::repeating<detail::force_ripple_harmonics, 1>("ripple_period_m", "ripple",
                                                                               period, travel, 0.9));
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"ripple", p.ripple.sizes()},
                {"ripple_period_m", {p.ripple.period}},
                {"ripple_phase_rad", p.ripple.phases()}};
    },
    .join = [](plant_model& p, const screening&) { p.ripple.count = 1; }};

} // namespace quadrant::inline v0::diagnosis::suspect
