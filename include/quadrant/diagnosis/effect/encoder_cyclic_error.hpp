// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::inline v0::diagnosis::detail {
inline harmonics& encoder_cyclic_error_harmonics(plant_model& p) { return p.cyclic; }
} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Reading = x + cyclic sin(2 pi x / period + phase): the interpolation error of an encoder, or an eccentric
/// scale. Joins the measurement. Keeps its size in position at every speed, so that as a force it grows with
/// the square of the speed; a periodic force does the reverse.
inline constexpr effect encoder_cyclic_error{
    .name = "encoder_cyclic_error",
    .label = "cyclic encoder error",
    .box = "sensor",
    .joins = joint::reading,
    .exciting_motion = "the same stroke slowly and fast, over several periods",
    .shows = "periodic in position, the same size at every speed",
    .keys = {machine_key{.name = "encoder.cyclic_m",
                         .rule = detail::rule::any_number,
                         .meaning = "reading = x + cyclic sin(2 pi x / period + phase)",
                         .at = member<&encoder_description::cyclic_m>,
                         .needs = {"cyclic_period_m"},
                         .components = detail::components_of<detail::encoder_cyclic_error_harmonics>,
                         .tolerance = true},
             machine_key{.name = "encoder.cyclic_period_m",
                         .rule = detail::rule::positive,
                         .meaning = "of that wave",
                         .at = member<&encoder_description::cyclic_period_m>,
                         .needs = {"cyclic_m"},
                         .of = [](plant_model& p) -> double& {
                             return detail::encoder_cyclic_error_harmonics(p).period;
                         },
                         .tolerance = true,
                         .unstated = 0},
             machine_key{.name = "encoder.cyclic_phase_rad",
                         .rule = detail::rule::any_number,
                         .meaning = "of that wave",
                         .at = member<&encoder_description::cyclic_phase_rad>}},
    .prior = {0.2, "interpolated scales have some tens of nanometres; an eccentric ring has more"},
    .remedy = "Adjust the reading head, or correct the reading by a table over one period; a feedforward would "
              "follow the error.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format(
                "adjust the scale's head, or correct the reading by a table over {:.3g} um of travel: the "
                "loop follows the error, and a feedforward would only help it to",
                1e6 * p.cyclic.period);
        },
    .trial = {.low = 2e-8,
              .high = 1e-4,
              .into =
                  [](trial_machine& m) {
                      m.set("encoder.cyclic_period_m",
                            m.log_uniform(2e-4, std::max(1e-3, m.around.travel / 3)));
                      m.set_harmonics("encoder.cyclic_m", "encoder.cyclic_phase_rad", 1, m.amplitude);
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double travel = detail::travel(s);
        const auto innovation = std::span(s.innovation).first(s.record.position.size()); // of the position
        std::vector<std::vector<parameter>> out;
        // Coarse and fine periods apart: at constant speed the rows themselves are a grating, and alias one
        // into the other.
        const double shortest = std::max(8 * s.record.resolution, travel / 1e5);
        for (double longest = 0.5 * travel; longest > shortest; longest /= 20)
            for (double period : spatial_peaks(innovation, s.record.position, longest,
                                               std::max(shortest, longest / 20), 1, s.record.score.skip))
                out.push_back(detail::repeating<detail::encoder_cyclic_error_harmonics, 1>(
                    "encoder.cyclic_period_m", "encoder.cyclic_m", period, travel,
                    std::min(5e-3 * travel, 0.1 * period)));
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"encoder.cyclic_m", p.cyclic.sizes()},
                {"encoder.cyclic_period_m", {p.cyclic.period}},
                {"encoder.cyclic_phase_rad", p.cyclic.phases()}};
    },
    .join = [](plant_model& p, const screening&) { p.cyclic.count = 1; }};

} // namespace quadrant::inline v0::diagnosis::suspect
