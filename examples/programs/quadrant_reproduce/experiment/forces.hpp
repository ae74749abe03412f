// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../milling_table.hpp"
#include "loop_dob.hpp"
#include "loop_modes.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// Figs. 3.15 to 3.17: the synthesized force and its lines.
inline outcome forces_case(const thesis::axis& a, const std::string& id) {
    using namespace thesis;
    const auto& table = a.name == std::string("x") ? milling_harmonics::x : milling_harmonics::y;
    cutting_force<15> cutter({milling_harmonics::fundamental, milling_harmonics::scale, table}, period);
    line force{.name = "15 harmonics", .x = {}, .y = {}},
        lines{.name = "amplitude", .x = {}, .y = {}, .drawn = line::style::points};
    double peak = 0, squares = 0;
    for (int k = 0; k < 400; ++k) {
        const double f = cutter().value();
        force.x.push_back(k * period.value()), force.y.push_back(f);
        peak = std::max(peak, std::abs(f)), squares += f * f;
    }
    for (std::size_t i = 0; i < 15; ++i) {
        lines.x.push_back(double(i + 1) * milling_harmonics::fundamental.value());
        lines.y.push_back(milling_harmonics::scale.value() * std::hypot(table.real[i], table.imaginary[i]));
    }
    outcome out;
    out.rows = {{id,
                 "peak",
                 "N",
                 peak,
                 {},
                 {},
                 {},
                 "with 2/6053 N, ours; the thesis does not print the scale, its plot reaches about 100 N"},
                {id, "rms", "N", std::sqrt(squares / 400), {}, {}, {}, ""}};
    out.pictures = {
        {fmt::format("Axis {}: the synthesized cutting force", a.name),
         "Eq. (3.10) with the 15 harmonics printed for 1 mm depth, and their amplitudes.",
         {panel{.x_label = "time [s]", .y_label = "force [N]", .lines = {std::move(force)}},
          panel{.x_label = "frequency [Hz]", .y_label = "amplitude [N]", .lines = {std::move(lines)}}}}};
    return out;
}

/// Fig. 4.14: Q below 1/Delta, on G and on the model with the fitted modes.
inline outcome q_limit_case(const thesis::axis& a, const std::string& id) {
    using quadrant::analysis::hertz;
    const quadrant::analysis::q_model<2, 0> q{a.corner};
    auto nominal = thesis::model_of(a);
    nominal.delay = {};
    const auto& fit = thesis::fitted_modes(a);
    const band b{hertz(10), hertz(900), 100};
    const auto limit = [&](const std::string& name, const auto& plant) {
        return over_frequency(name, b, [&](quadrant::frequency f) {
            return quadrant::analysis::decibel(1 / std::abs(complex(plant(f)) / complex(nominal(f)) - 1.0));
        });
    };
    const auto of_g = thesis::q_on(thesis::model_of(a), a), of_modes = thesis::q_on(fit.plant, a);
    outcome out;
    out.rows = {
        {id,
         "largest_q_delta",
         "1",
         of_g.of_thesis.worst,
         {},
         {},
         {},
         "largest |Q Delta| on G: below 1 is robustly stable, eq. (4.12)"},
        {id,
         "largest_q_delta_with_modes",
         "1",
         of_modes.of_thesis.worst,
         {},
         {},
         {},
         "on the model with the fitted modes"},
        {id, "highest_corner", "Hz", of_g.highest.value(), {}, {}, {}, "corner of Q at which that is 1, on G"},
        {id,
         "highest_corner_with_modes",
         "Hz",
         of_modes.highest.value(),
         {},
         {},
         {},
         "the same on the model with the fitted modes"}};
    out.pictures = {
        {fmt::format("Axis {}: Q and 1/Delta", a.name),
         "The observer is robustly stable while Q lies below 1/Delta, eq. (4.12).",
         {panel{.x_label = "frequency [Hz]",
                .y_label = "gain [dB]",
                .lines = {over_frequency("Q", b,
                                         [&](quadrant::frequency f) {
                                             return quadrant::analysis::decibel(std::abs(complex(q(f))));
                                         }),
                          limit("1/Delta of G", thesis::model_of(a)), limit("1/Delta with modes", fit.plant)},
                .log_x = true,
                .y_range = std::pair{-50.0, 40.0}}}}};
    return out;
}

inline experiment forces() {
    return {"The synthesized cutting force",
            "[Jamaludin2008] section 3.5, eq. (3.10), Tables 3.5 and 3.6, Figs. 3.12 to 3.17",
            "The sum of 15 harmonics as the tables print them. The measured forces are not public, those of 3 "
            "mm depth not "
            "even as harmonics; the tables are sums of a Fourier transform whose scale is not printed.",
            0.10,
            {{"thesis.force.x", [] { return forces_case(thesis::x, "thesis.force.x"); }},
             {"thesis.force.y", [] { return forces_case(thesis::y, "thesis.force.y"); }}}};
}
inline experiment q_limit() {
    return {"How far the observer's filter may reach",
            "[Jamaludin2008] section 4.3.1, eqs. (4.8-4.12), Fig. 4.14",
            "|Q| against 1/|Delta|, Delta the relative distance of the plant from B/(s(s+A)): of G, which has "
            "the delay more, "
            "and of the model with the fitted modes. The thesis has the measured response instead, which is "
            "not public.",
            0.10,
            {{"thesis.q_limit.x", [] { return q_limit_case(thesis::x, "thesis.q_limit.x"); }},
             {"thesis.q_limit.y", [] { return q_limit_case(thesis::y, "thesis.q_limit.y"); }}}};
}

} // namespace quadrant_reproduce
