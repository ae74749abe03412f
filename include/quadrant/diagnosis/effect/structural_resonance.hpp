// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::diagnosis::suspect {

/// A second mass on a spring, part of the moving mass, that the encoder does not see: anti-resonance at the frequency given
/// (the first mass held), resonance above it [Altintas2012] ch. 3. Joins the inertia. Shows as ringing after each jerk, and in
/// a multi-sine as a phase that turns twice.
inline constexpr effect structural_resonance{
    .name = "structural_resonance",
    .box = "mechanics",
    .exciting_motion = "multi-sine of 10 to 300 Hz, or a chirp through the suspected frequency",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double m = s.leader.mass, highest = std::min(600.0, 0.3 / s.record.period);
        std::vector<std::vector<parameter>> out;
        for (double f : {30.0, 75.0, 180.0})
            if (f < highest)
                out.push_back({{.key = "mode_mass_kg",
                                .of = [](plant_model& p) -> double& { return p.mode.mass; },
                                .start = 0.1 * m,
                                .low = 0.002 * m,
                                .high = 0.8 * m,
                                .logarithmic = true,
                                .step = 1e-2},
                               {.key = "mode_frequency_Hz",
                                .of = [](plant_model& p) -> double& { return p.mode.frequency_Hz; },
                                .start = f,
                                .low = 5,
                                .high = highest,
                                .logarithmic = true,
                                .step = 1e-3},
                               {.key = "mode_damping",
                                .of = [](plant_model& p) -> double& { return p.mode.damping; },
                                .start = 0.05,
                                .low = 0.002,
                                .high = 0.6,
                                .logarithmic = true,
                                .step = 1e-2}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"mode_mass_kg", {p.mode.mass}},
                {"mode_frequency_Hz", {p.mode.frequency_Hz}},
                {"mode_damping", {p.mode.damping}}};
    }};

} // namespace quadrant::diagnosis::suspect
