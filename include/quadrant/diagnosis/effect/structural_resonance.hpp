// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Frequencies at which a small second mass would take most out of the innovations, the best first: one pass
/// for each of a ladder whose rungs are as close as a light damping is wide, and where it leads uphill the gain
/// of a linear step in its mass.
inline std::vector<double> ringing_frequencies(const screening& s, double lowest, double highest,
                                               std::size_t most) {
    constexpr double rung = 1.12;
    const double small = 0.002 * s.leader.mass;
    std::vector<double> ladder;
    for (double f = lowest; f < highest; f *= rung) ladder.push_back(f);
    std::vector<plant_model> plants(ladder.size(), s.leader);
    for (std::size_t i = 0; i < ladder.size(); ++i) plants[i].mode = {small, ladder[i], 0.03};
    const std::vector<double>& here = s.innovation;
    std::vector<std::vector<double>> there(ladder.size());
    s.record.observer.run(plants, there);
    const auto ms = block_ms(here, s.record.score.skip, s.record.score.block);
    std::vector<double> gain(ladder.size());
    for (std::size_t i = 0; i < ladder.size(); ++i) {
        double along = 0, curvature = 1e-300;
        for (std::size_t b = 0; b < ms.size(); ++b) {
            double product = 0, square = 0;
            for (std::size_t k = 0; k < s.record.score.block; ++k) {
                const std::size_t at = s.record.score.skip + b * s.record.score.block + k;
                const double d = there[i][at] - here[at];
                product += d * here[at], square += d * d;
            }
            const double w = 1 / (ms[b] + s.record.score.floor() * s.record.score.floor());
            along -= w * product, curvature += w * square;
        }
        gain[i] = along > 0 ? along * along / curvature : 0;
    }
    std::vector<std::size_t> peaks;
    for (std::size_t i = 0; i < gain.size(); ++i)
        if (gain[i] > 0 && (i == 0 || gain[i] >= gain[i - 1]) &&
            (i + 1 == gain.size() || gain[i] > gain[i + 1]))
            peaks.push_back(i);
    std::stable_sort(peaks.begin(), peaks.end(), [&](auto a, auto b) { return gain[a] > gain[b]; });
    std::vector<double> out;
    for (std::size_t i = 0; i < std::min(most, peaks.size()); ++i) out.push_back(ladder[peaks[i]]);
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// A second mass on a spring, part of the moving mass, that the encoder does not see: anti-resonance at the
/// frequency given (the first mass held), resonance above it [Altintas2012] ch. 3. Joins the inertia. Shows as
/// ringing after each jerk, and in a multi-sine as a phase that turns twice.
inline constexpr effect structural_resonance{
    .name = "structural_resonance",
    .label = "structural resonance",
    .box = "mechanics",
    .joins = joint::transmission,
    .exciting_motion = "multi-sine of 10 to 300 Hz, or a chirp through the suspected frequency",
    // damped as far as is searched, or as slow, it does not ring
    .ends_inside = {"mode_damping", "mode_frequency_Hz"},
    .shows = "ringing, a phase that turns twice",
    .keys = {machine_key{.name = "mode_mass_kg",
                         .rule = detail::rule::positive,
                         .meaning = "second mass on a spring, part of mass_kg",
                         .at = member<&plant_description::mode_mass_kg>,
                         .needs = {"mode_frequency_Hz"},
                         .of = [](plant_model& p) -> double& { return p.mode.mass; },
                         .tolerance = true},
             machine_key{.name = "mode_frequency_Hz",
                         .rule = detail::rule::positive,
                         .meaning = "of it with the first mass held",
                         .at = member<&plant_description::mode_frequency_Hz>,
                         .needs = {"mode_mass_kg"},
                         .of = [](plant_model& p) -> double& { return p.mode.frequency_Hz; },
                         .tolerance = true},
             machine_key{.name = "mode_damping",
                         .rule = detail::rule::relative,
                         .meaning = "of it, a damping ratio",
                         .at = member<&plant_description::mode_damping>,
                         .of = [](plant_model& p) -> double& { return p.mode.damping; },
                         .tolerance = true}},
    .fault = [](const axis_description& a) -> key_fault {
        if (a.plant.mode_mass_kg.value_or(0) >= a.plant.mass_kg)
            return {"mode_mass_kg", "must lie below {}, of which it is a part", "mass_kg"};
        return {};
    },
    .prior = {0.5, "every structure has one; many lie above what the servo excites"},
    .remedy = "Put a notch near the frequency found into the command and command less jerk; a stiffer mount "
              "removes the cause.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format("a notch in the command near {:.3g} Hz and a reference with less jerk",
                               p.mode.frequency_Hz);
        },
    .trial = {.low = 0.003,
              .high = 0.45,
              .into =
                  [](trial_machine& m) {
                      m.set("mode_mass_kg", m.amplitude * m.now("mass_kg"));
                      m.set("mode_frequency_Hz", m.log_uniform(15, std::min(140.0, 0.12 / m.around.period)));
                      m.set("mode_damping", m.log_uniform(0.005, 0.06));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double m = s.leader.mass, corner = s.record.scale.corner_Hz, highest = 0.3 / s.record.period;
        // A mode that a third of its critical damping keeps from ringing does what any force does that the
        // model lacks; so does one far below the corner unless it rings for long, and one of a few cycles.
        const double record = static_cast<double>(s.record.position.size()) * s.record.period;
        const double lowest = std::max(0.01 * corner, 5 / record);
        const double slow = std::max(lowest, 0.25 * corner);
        std::vector<double> frequencies = detail::ringing_frequencies(s, slow, highest, 3);
        for (double f : detail::ringing_frequencies(s, lowest, slow, 1)) frequencies.push_back(f);
        std::vector<std::vector<parameter>> out;
        for (double f : frequencies)
            for (double share : {0.03, 0.2, 0.33, 0.5}) // the axis rings above the frequency of the mode alone
                out.push_back({{.key = "mode_mass_kg",
                                .of = [](plant_model& p) -> double& { return p.mode.mass; },
                                .start = share * m,
                                .low = 0.002 * m,
                                .high = 0.8 * m,
                                .logarithmic = true,
                                .step = 1e-2},
                               {.key = "mode_frequency_Hz",
                                .of = [](plant_model& p) -> double& { return p.mode.frequency_Hz; },
                                .start = f * std::sqrt(1 - share),
                                .low = 0.8 * (f < slow ? lowest : slow),
                                .high = highest,
                                .logarithmic = true,
                                .step = 1e-3},
                               {.key = "mode_damping",
                                .of = [](plant_model& p) -> double& { return p.mode.damping; },
                                .start = 0.05,
                                .low = 0.002,
                                .high = f < slow ? 0.1 : 0.33,
                                .logarithmic = true,
                                .step = 1e-2}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"mode_mass_kg", {p.mode.mass}},
                {"mode_frequency_Hz", {p.mode.frequency_Hz}},
                {"mode_damping", {p.mode.damping}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
