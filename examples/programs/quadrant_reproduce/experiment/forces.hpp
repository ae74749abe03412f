// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../milling_table.hpp"
#include "../real_cut.hpp"
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

/// Table 3.4, Figs. 3.12 to 3.16: the forces of the cut that was measured, computed from its chip.
inline outcome chip_case(const std::string& id) {
    using namespace thesis;
    outcome out;
    picture drawn{"The force of the cut of Table 3.4",
                  "Computed from the chip: slot, usual coefficients, no runout; an edge comes every 14.7 ms.",
                  {panel{.x_label = "", .y_label = "x [N]", .lines = {}},
                   panel{.x_label = "time [s]", .y_label = "y [N]", .lines = {}}}};
    for (const int depth : {1, 3}) {
        milling_force<measured_edges> cutter(measured_cutter(depth), measured_period);
        const double tooth = 2 * pi_ * double(measured_edges) * measured_cutter(depth).spindle.value();
        line along{.name = fmt::format("{} mm", depth), .x = {}, .y = {}}, across = along;
        double peak_x = 0, peak_y = 0;
        complex line_x = 0, line_y = 0;
        constexpr int samples = 2250; // 17 turns
        for (int k = 0; k < samples; ++k) {
            const double t = k * measured_period.value();
            const auto f = cutter();
            peak_x = std::max(peak_x, std::abs(f.x.value())), peak_y = std::max(peak_y, std::abs(f.y.value()));
            line_x += std::polar(2.0 / samples, -tooth * t) * f.x.value();
            line_y += std::polar(2.0 / samples, -tooth * t) * f.y.value();
            if (k >= 300) continue;
            along.x.push_back(t), along.y.push_back(f.x.value());
            across.x.push_back(t), across.y.push_back(f.y.value());
        }
        const std::string mm = fmt::format("_{}mm", depth);
        const auto row_of = [&](const std::string& what, double value, const std::string& note) {
            out.rows.push_back({id, what + mm, "N", value, {}, {}, {}, note});
        };
        row_of("peak_x", peak_x, depth == 1 ? "the plot of the record reaches some 150 N" : "");
        row_of("peak_y", peak_y, "");
        const auto of_table = [&](const harmonic_table<15>& h) {
            return depth > 1
                       ? std::string()
                       : fmt::format("Table 3.5 or 3.6 with 2/6053 N: {:.0f} N",
                                     milling_harmonics::scale.value() * std::hypot(h.real[2], h.imaginary[2]));
        };
        row_of("tooth_line_x", std::abs(line_x), of_table(milling_harmonics::x));
        row_of("tooth_line_y", std::abs(line_y), of_table(milling_harmonics::y));
        drawn.panels[0].lines.push_back(std::move(along));
        drawn.panels[1].lines.push_back(std::move(across));
    }
    out.pictures = {std::move(drawn)};
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
            "mm depth not even as harmonics; the tables are sums of a Fourier transform whose scale is not "
            "printed. Beside it the force of the same cut, 1 and 3 mm deep, computed from its chip by Table "
            "3.4: width, coefficients and runout are not printed (ours: a slot, those of the real cut, none).",
            0.10,
            {{"thesis.force.x", [] { return forces_case(thesis::x, "thesis.force.x"); }},
             {"thesis.force.y", [] { return forces_case(thesis::y, "thesis.force.y"); }},
             {"thesis.force.chip", [] { return chip_case("thesis.force.chip"); }}}};
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
