// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "loop_dob.hpp"
#include "loop_modes.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// One column of what is given for a set of loops; empty where nothing is.
struct given_loop {
    using number = std::optional<double>;
    number velocity_gain, velocity_phase, velocity_bandwidth, position_gain, position_phase, position_bandwidth,
        stiffness{};
};

/// Rows of margins and bandwidths.
inline std::vector<row> margin_rows(const std::string& id, const thesis::loop_figures& f,
                                    const given_loop& reference, const std::string& note) {
    const auto known = [](double v) { return std::isfinite(v) ? std::optional(v) : std::nullopt; };
    const auto figure = [&](const char* quantity, const char* unit, double v, given_loop::number r = {}) {
        return row{id, quantity, unit, known(v), {}, {}, r, note};
    };
    return {figure("velocity_gain_margin", "dB", f.velocity_gain_margin, reference.velocity_gain),
            figure("velocity_gain_margin_at", "Hz", f.velocity_gain_margin_at),
            figure("velocity_phase_margin", "deg", f.velocity_phase_margin, reference.velocity_phase),
            figure("velocity_phase_margin_at", "Hz", f.velocity_phase_margin_at),
            figure("velocity_bandwidth", "Hz", f.velocity_bandwidth, reference.velocity_bandwidth),
            figure("velocity_closed_bandwidth", "Hz", f.velocity_closed_bandwidth),
            figure("position_gain_margin", "dB", f.position_gain_margin, reference.position_gain),
            figure("position_gain_margin_at", "Hz", f.position_gain_margin_at),
            figure("position_phase_margin", "deg", f.position_phase_margin, reference.position_phase),
            figure("position_phase_margin_at", "Hz", f.position_phase_margin_at),
            figure("position_bandwidth", "Hz", f.position_bandwidth, reference.position_bandwidth),
            figure("position_closed_bandwidth", "Hz", f.position_closed_bandwidth)};
}

/// Bode and Nyquist of both open loops, and the sensitivity.
template <class Loop> std::vector<picture> loop_pictures(const thesis::axis& a, const Loop& loop) {
    const auto velocity = [&](quadrant::frequency f) { return loop.open_velocity(f); };
    const auto position = [&](quadrant::frequency f) { return loop.open_position(f); };
    const std::string axis = fmt::format("Axis {}", a.name);
    const band drawn{quadrant::analysis::hertz(1), quadrant::analysis::hertz(900), 250};
    const band near{quadrant::analysis::hertz(4), quadrant::analysis::hertz(900), 100};
    return {
        bode(axis + ": open loops",
             "The gain margin is read where the phase passes -180 degrees, the phase margin at 0 dB.",
             {{"velocity loop", velocity}, {"position loop", position}}, drawn),
        nyquist(axis + ": Nyquist", "How far the open loops stay from -1.",
                {{"velocity loop", velocity}, {"position loop", position}}, near),
        magnitude("Sensitivity",
                  "1/(1 + all that is fed back), eq. (2.33). The bandwidth is where it comes up through -3 dB.",
                  {{"axis " + std::string(a.name), [&](quadrant::frequency f) { return loop.sensitivity(f); }}},
                  drawn),
        bode("Closed loops",
             "Eqs. (2.26) and (2.31): the velocity seen over the one asked for, the position over the "
             "reference.",
             {{"velocity, " + std::string(a.name),
               [&](quadrant::frequency f) { return 1.0 - loop.velocity_sensitivity(f); }},
              {"position, " + std::string(a.name), [&](quadrant::frequency f) { return loop.tracking(f); }}},
             drawn),
        magnitude(
            "Error over reference",
            "Eq. (2.34), nothing fed forward; the thesis marks 0.441 and 0.423 at 10 Hz (-7.1 and -7.5 dB).",
            {{"axis " + std::string(a.name), [&](quadrant::frequency f) { return loop.error_ratio(f); }}},
            drawn)};
}

template <class Loop> picture stiffness_picture(const thesis::axis& a, const Loop& loop) {
    return {"Dynamic stiffness",
            "Force at the motor over deflection. A cutting force does most harm where it is least.",
            {panel{.x_label = "frequency [Hz]",
                   .y_label = "stiffness [N/um]",
                   .lines = {over_frequency("axis " + std::string(a.name),
                                            {quadrant::analysis::hertz(1), quadrant::analysis::hertz(100), 150},
                                            [&](quadrant::frequency f) {
                                                return std::abs(loop.dynamic_stiffness(f, a.kf)) * 1e-6;
                                            })},
                   .log_x = true,
                   .log_y = true}}};
}

/// What section 2.5.2 reads off: the least stiffness, where ours has its own.
inline line published_stiffness(const thesis::axis& a) {
    const double least = &a == &thesis::x ? 15 : 8;
    return {.name = fmt::format("published least, {}", a.name),
            .x = {1, 100},
            .y = {least, least},
            .drawn = line::style::dashed};
}
/// Tables 2.4, 2.6 and 4.8 in a picture of sensitivities: the bandwidth at -3 dB.
inline line published_bandwidth(const std::string& name, double hertz) {
    return {.name = name, .x = {hertz}, .y = {-3}, .drawn = line::style::points};
}

inline std::vector<run_case> both_axes(const std::string& id,
                                       outcome (*run)(const thesis::axis&, const std::string&)) {
    return {{id + ".x", [=] { return run(thesis::x, id + ".x"); }},
            {id + ".y", [=] { return run(thesis::y, id + ".y"); }}};
}

inline experiment loop() {
    return {"The cascade on its model", "[Jamaludin2008] eqs. (2.2), (2.22-2.40), Tables 2.2 to 2.6",
            "P on position, PI on velocity with the notch in the velocity feedback, on G(s) = B e^{-s Td}/(s "
            "(s + A)). The "
            "thesis read its margins off the measured frequency response, which is not public and has base and "
            "structural modes that G has not; hence the distance to the measured column.",
            0.02, both_axes("thesis.loop", [](const thesis::axis& a, const std::string& id) -> outcome {
                const bool x = &a == &thesis::x;
                const auto loop = thesis::loop_around(thesis::model_of(a), a);
                const thesis::loop_figures f = thesis::figures_of(loop, a.kf);
                const auto corner = quadrant::analysis::corners(loop.plant, loop.velocity, loop.position_gain);
                // Reference: shared/reference/thesis.md, "What the model G alone gives".
                outcome out{margin_rows(id, f,
                                        x ? given_loop{15.6, 69.0, 32.7, 15.6, 69.65, 30.1}
                                          : given_loop{14.7, 66.35, 31.2, 15.0, 68.5, 29.3},
                                        ""),
                            loop_pictures(a, loop)};
                if (!x)
                    for (const std::size_t i : {std::size_t(0), std::size_t(2)})
                        out.rows[i].note = "the thesis contradicts itself: Table 4.6 has 14.62 dB and 71.9 deg";
                out.rows.push_back({id,
                                    "tracking_ratio_10Hz",
                                    "1",
                                    f.tracking_ratio_10Hz,
                                    {},
                                    {},
                                    {},
                                    "|Ep/Zref|, no feedforward"});
                out.rows.push_back(
                    {id, "min_dynamic_stiffness", "N/um", f.min_dynamic_stiffness, {}, {}, x ? 13.4 : 6.8, ""});
                out.rows.push_back(
                    {id, "velocity_corner", "rad/s", corner.velocity, {}, {}, {}, "eq. (2.38): |kp B|"});
                out.rows.push_back(
                    {id, "position_corner", "rad/s", corner.position, {}, {}, {}, "eq. (2.40): sqrt(kv w_s)"});
                out.rows.push_back({id,
                                    "damping",
                                    "1",
                                    0.5 * std::sqrt(corner.velocity / loop.position_gain.value()),
                                    {},
                                    {},
                                    {},
                                    "eq. (2.39): sqrt(w_s/kv)/2"});
                out.pictures.push_back(stiffness_picture(a, loop));
                out.pictures.back().panels[0].lines.push_back(published_stiffness(a));
                for (picture& p : out.pictures)
                    if (p.title == "Sensitivity")
                        p.panels[0].lines.push_back(
                            published_bandwidth(fmt::format("published, {}", a.name), x ? 26.6 : 27.1));
                return out;
            })};
}

inline experiment loop_modes() {
    return {
        "The cascade on the model with a base mode and a structural mode",
        "[Jamaludin2008] chapter 2, Tables 2.3 to 2.6",
        "The modes are fitted to the published margins, bandwidths and stiffness, within the frequencies that "
        "the thesis "
        "names: not a measurement, but what the machine's modes must have been like. The closed loops' "
        "bandwidths are not among "
        "what was fitted: they are a prediction.",
        0.02, both_axes("thesis.loop_modes", [](const thesis::axis& a, const std::string& id) -> outcome {
            const thesis::mode_fit& fit = thesis::fitted_modes(a);
            const auto loop = thesis::loop_around(fit.plant, a);
            outcome out{margin_rows(id, fit.figures, {}, ""), loop_pictures(a, loop)};
            out.rows.push_back(
                {id, "tracking_ratio_10Hz", "1", fit.figures.tracking_ratio_10Hz, {}, {}, {}, ""});
            out.rows.push_back(
                {id, "min_dynamic_stiffness", "N/um", fit.figures.min_dynamic_stiffness, {}, {}, {}, ""});
            const auto& base = fit.plant.modes.front();
            out.rows.push_back(
                {id,
                 "base_resonance",
                 "Hz",
                 base.centre.value(),
                 {},
                 {},
                 {},
                 "fitted, within 3 Hz of what chapter 2 prints; chapter 6 and Appendix A print it "
                 "again"});
            out.rows.push_back(
                {id, "base_antiresonance", "Hz", base.anti_resonance().value(), {}, {}, {}, "fitted"});
            const auto corner =
                quadrant::analysis::corners(thesis::model_of(a), loop.velocity, loop.position_gain);
            out.rows.push_back({id,
                                "velocity_corner",
                                "rad/s",
                                corner.velocity,
                                {},
                                {},
                                {},
                                "eq. (2.38); modes do not enter"});
            out.rows.push_back({id,
                                "position_corner",
                                "rad/s",
                                corner.position,
                                {},
                                {},
                                {},
                                "eq. (2.40); modes do not enter"});
            out.pictures.push_back(bode(fmt::format("Axis {}: the plant", a.name),
                                        "G of eq. (2.2), and with the fitted modes.",
                                        {{"G", thesis::model_of(a)}, {"with modes", fit.plant}},
                                        {quadrant::analysis::hertz(5), quadrant::analysis::hertz(900), 400}));
            return out;
        })};
}

inline experiment loop_dob() {
    return {"The cascade with the disturbance observer", "[Jamaludin2008] eqs. (4.1-4.20)",
            "Margins of the loops around the observed axis, on the model G. The observer has Q of order 2, 60 "
            "Hz on x and "
            "90 Hz on y; |Q| is -3 dB at 38.6 and 57.9 Hz.",
            0.02, both_axes("thesis.loop_dob", [](const thesis::axis& a, const std::string& id) -> outcome {
                const bool x = &a == &thesis::x;
                const auto loop = thesis::loop_with_observer(thesis::model_of(a), a);
                const auto limits = quadrant::analysis::limits(loop, thesis::servo);
                const auto f = thesis::figures_of(loop, a.kf);
                // Reference: shared/reference/thesis.md, "Disturbance observer".
                outcome out{margin_rows(id, f,
                                        x ? given_loop{{}, {}, {}, 13.7, 71.9, 33.7}
                                          : given_loop{{}, {}, {}, 12.9, 71.0, 38.0},
                                        ""),
                            loop_pictures(a, loop)};
                const std::string until =
                    limits.helps_up_to
                        ? fmt::format("It helps up to {:.1f} Hz; at {:.0f} Hz the error is {:.2f} times as "
                                      "large as without.",
                                      limits.helps_up_to->value(), limits.worst.at.value(), limits.worst.value)
                        : "It helps in the whole band.";
                out.pictures.push_back(magnitude(
                    fmt::format("Axis {}: sensitivity without and with observer", a.name), until,
                    {{"without", [&](quadrant::frequency at) { return loop.without.sensitivity(at); }},
                     {"with", [&](quadrant::frequency at) { return loop.sensitivity(at); }}},
                    {quadrant::analysis::hertz(1), quadrant::analysis::hertz(900), 250}));
                auto& lines = out.pictures.back().panels[0].lines;
                lines.push_back(published_bandwidth("published, without", x ? 26.6 : 27.2));
                lines.push_back(published_bandwidth("published, with", x ? 29.2 : 34));
                return out;
            })};
}

} // namespace quadrant_reproduce
