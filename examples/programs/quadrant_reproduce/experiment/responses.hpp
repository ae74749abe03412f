// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../frequency_response.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

inline double degrees_below_zero(const complex& value) {
    const double phase = std::arg(value) * 180 / std::numbers::pi;
    return phase > 0 ? phase - 360 : phase;
}

/// Gain [um/V] and phase of what was measured and of models, from 3 to 300 Hz.
inline picture
response_picture(const std::string& title, const std::string& caption,
                 const std::vector<std::pair<std::string, quadrant::analysis::measured_frf>>& measured,
                 const std::vector<named_response>& models) {
    picture out{title,
                caption,
                {panel{.x_label = "", .y_label = "gain [um/V]", .lines = {}, .log_x = true, .log_y = true},
                 panel{.x_label = "frequency [Hz]", .y_label = "phase [deg]", .lines = {}, .log_x = true}}};
    for (const auto& [name, frf] : measured) {
        line gain{.name = name, .x = {}, .y = {}}, phase = gain;
        for (const auto& l : frf.lines) {
            if (l.f.value() < 3 || l.f.value() > 300) continue;
            gain.x.push_back(l.f.value()), gain.y.push_back(1e6 * std::abs(l.value));
            phase.x.push_back(l.f.value()), phase.y.push_back(degrees_below_zero(l.value));
        }
        out.panels[0].lines.push_back(std::move(gain)), out.panels[1].lines.push_back(std::move(phase));
    }
    const band b{quadrant::analysis::hertz(3), quadrant::analysis::hertz(300), 60};
    for (const auto& m : models) {
        line gain = over_frequency(m.name, b, [&](quadrant::frequency f) { return 1e6 * std::abs(m.at(f)); });
        line phase =
            over_frequency(m.name, b, [&](quadrant::frequency f) { return degrees_below_zero(m.at(f)); });
        gain.drawn = phase.drawn = line::style::dashed;
        out.panels[0].lines.push_back(std::move(gain)), out.panels[1].lines.push_back(std::move(phase));
    }
    return out;
}

/// Table 2.1, Figs. 2.4 to 2.6: identified from five minutes of the simulated axis.
inline outcome frf_case(const thesis::axis& a, const std::string& id) {
    const auto frf = thesis::measured_response<thesis::linear_plant>(a, a.A, 1);
    const auto fit = thesis::fitted(frf);
    const auto figure = [&](const char* quantity, const char* unit, const auto& found, double truth) {
        return row{id,    quantity,
                   unit,  found.value.value(),
                   {},    {},
                   truth, fmt::format("interval {:.4g} to {:.4g}", found.low.value(), found.high.value())};
    };
    outcome out;
    out.rows = {figure("A", "1/s", fit.pole, a.A.value()), figure("B", "m/(V s2)", fit.gain, a.B.value()),
                figure("Td", "s", fit.delay, a.delay.value())};
    out.pictures = {response_picture(
        fmt::format("Axis {}: measured frequency response and model", a.name),
        "Five minutes of white noise at the amplifier, H1 under Hann windows of 2048 samples; dashed the fit.",
        {{"H1", frf}},
        {{"fit of eq. (2.2)",
          quadrant::analysis::rigid_axis_model<>{fit.pole.value, fit.gain.value, fit.delay.value}}})};
    return out;
}

/// Table 4.1 and Fig. 4.3: the pole beside GMS friction.
inline outcome a_prime_case(const thesis::axis& a, const std::string& id) {
    using namespace quadrant::literals;
    // The noise at which the printed A' gives back A: friction damps less the more the axis moves.
    const auto excess = [&](double rms) {
        return thesis::fitted(thesis::measured_response<thesis::gms_beside>(a, a.A_gms, rms, 0.5))
                   .pole.value.value() -
               a.A.value();
    };
    double low = 0.5, high = 2;
    for (int step = 0; step < 7; ++step) {
        const double middle = std::sqrt(low * high);
        (excess(middle) > 0 ? low : high) = middle;
    }
    outcome out;
    out.rows = {{id,
                 "A_prime",
                 "1/s",
                 thesis::pole_beside_gms(a, 1),
                 {},
                 {},
                 {},
                 "with 1 V rms of white noise; the thesis does not print its noise, and A' depends on it"},
                {id,
                 "noise_for_printed_A_prime",
                 "V",
                 std::sqrt(low * high),
                 {},
                 {},
                 {},
                 "rms of the noise at which the printed A' gives back the printed A"}};
    const auto response = [&](quadrant::per_second pole) {
        return thesis::measured_response<thesis::gms_beside>(a, pole, 1, 1);
    };
    out.pictures = {response_picture(fmt::format("Axis {}: the pole beside GMS friction", a.name),
                                     "1 V rms of white noise. With A and GMS friction the phase at low "
                                     "frequencies is not that of the original; "
                                     "with A' it is.",
                                     {{"A and GMS", response(a.A)}, {"A' and GMS", response(a.A_gms)}},
                                     {{"original, eq. (2.2)", thesis::model_of(a)}})};
    return out;
}

inline experiment responses() {
    return {
        "Frequency responses of the simulated axis",
        "[Jamaludin2008] section 2.3, Table 2.1, Figs. 2.4 to 2.6",
        "White noise of 1 V rms at the amplifier for five minutes, encoder of 0.25 um, H1 under a Hann window "
        "of "
        "2048 samples, eq. (2.2) fitted from 3 to 200 Hz. The measured responses of the thesis are not public: "
        "the axis is that of Table 2.1, so the procedure has to give the table back (reference).",
        0.02,
        {{"thesis.frf.x", [] { return frf_case(thesis::x, "thesis.frf.x"); }},
         {"thesis.frf.y", [] { return frf_case(thesis::y, "thesis.frf.y"); }}}};
}
inline experiment a_prime() {
    return {"The pole beside GMS friction",
            "[Jamaludin2008] section 4.2.1, Table 4.1, Figs. 4.2 and 4.3",
            "The axis gets GMS friction beside its pole, and the pole is lowered to A' until the frequency "
            "response "
            "has the pole A of Table 2.1 again. The thesis did that by hand.",
            0.02,
            {{"thesis.a_prime.x", [] { return a_prime_case(thesis::x, "thesis.a_prime.x"); }},
             {"thesis.a_prime.y", [] { return a_prime_case(thesis::y, "thesis.a_prime.y"); }}}};
}

} // namespace quadrant_reproduce
