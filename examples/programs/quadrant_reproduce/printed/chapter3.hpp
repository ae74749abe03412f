// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../experiment/identify.hpp"
#include "../printed.hpp"
#include "../real_cut.hpp"
#include "../thesis.hpp"

#include <quadrant/process/milling_harmonics.hpp>

#include <array>
#include <fmt/format.h>

namespace quadrant_reproduce {

namespace printed_detail {

/// Section 3.3.2 and Tables 3.1 to 3.3.
inline void friction_parameters(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    static constexpr std::array speeds{"0.010", "0.040", "0.080", "0.2", "0.4", "0.5", "1",  "2", "4",
                                       "5",     "8",     "10",    "14",  "16",  "20",  "25", "30"};
    auto section = at("Section 3.3.2");
    for (std::size_t i = 0; i < speeds.size(); ++i)
        section.used(fmt::format("constant speed {}", i + 1), speeds[i], "mm/s",
                     1e3 * thesis::identification::map_speeds[i]);
    auto table = at("Table 3.1");
    struct printed_curve {
        const thesis::axis& of;
        const char *Fc, *Fs, *inverse_Vs, *sigma;
    };
    for (const auto& p : {printed_curve{thesis::x, "122", "177", "0.00045", "0.00095"},
                          printed_curve{thesis::y, "105", "165", "0.001", "0.00004"}}) {
        const std::string axis = p.of.name;
        const auto& c = p.of.curve;
        table.used(axis + ", Fc", p.Fc, "N", c.coulomb.value())
            .used(axis + ", Fs", p.Fs, "N", c.static_level.value())
            .used(axis + ", 1/Vs", p.inverse_Vs, "s/um", 1e-6 / c.stribeck_velocity.value())
            .used(axis + ", sigma", p.sigma, "N s/um", 1e-6 * c.viscous.value())
            .used(axis + ", delta", "1", "", 1);
    }
}

inline void elements(printed_place at, const thesis::axis& a, const std::array<const char*, 4>& alpha,
                     const std::array<const char*, 4>& k) {
    for (std::size_t i = 0; i < 4; ++i)
        at.used(fmt::format("{}, alpha {}", a.name, i + 1), alpha[i], "N", a.alpha[i].value())
            .used(fmt::format("{}, k {}", a.name, i + 1), k[i], "N/um", 1e-6 * a.k[i].value());
}

/// Tables 3.5 and 3.6 letter for letter.
inline void harmonics(printed_list& all) {
    static constexpr std::array hertz{"23.29",  "46.59",  "69.88",  "93.18",  "116.47",
                                      "139.76", "163.06", "186.35", "209.65", "232.94",
                                      "256.24", "279.53", "302.83", "326.12", "349.41"};
    static constexpr std::array xa{"-2.147e+004", "1.45e+004",  "1.544e+005",  "-2.491e+004", "9.209e+003",
                                   "-7.812e+004", "9.260e+002", "-1.589e+004", "3.384e+004",  "8.626e+003",
                                   "1.836e+003",  "6.953e+003", "-4.101e+003", "1.305e+004",  "8.234e+003"},
        xb{"6.615e+004",  "7.434e+004", "-1.353e+005", "-4.705e+004", "1.860e+004",
           "-1.512e+004", "1.460e+004", "5.733e+002",  "7.720e+003",  "-1.410e+003",
           "1.618e+003",  "9.00e+002",  "-1.294e+003", "2.9406e+002", "3.321e+003"},
        ya{"-6.792e+004", "4.497e+003",  "4.833e+004",  "4.546e+004",  "-1.020e+004",
           "9.306e+004",  "-4.213e+003", "1.061e+004",  "-6.261e+004", "-4.878e+003",
           "-6.341e+003", "1.574e+004",  "-5.417e+003", "-3.133e+003", "-8.592e+003"},
        yb{"-1.263e+005", "-7.883e+004", "1.453e+005", "2.417e+004",  "1.563e+004",
           "2.657e+004",  "-1.180e+004", "3.850e+003", "-1.425e+004", "6.895e+003",
           "-2.983e+003", "1.280e+004",  "4.901e+003", "2.225e+003",  "-2.971e+003"};
    namespace mh = quadrant::milling_harmonics;
    const auto write = [&](const char* where, const char* axis, const auto& a, const auto& b,
                           const auto& ours) {
        printed_place at(all, thesis_source, where);
        for (std::size_t i = 0; i < 15; ++i)
            at.used(fmt::format("{}, harmonic {}, frequency", axis, i + 1), hertz[i], "Hz",
                    double(i + 1) * mh::fundamental.value())
                .used(fmt::format("{}, harmonic {}, A", axis, i + 1), a[i], "", ours.real[i])
                .used(fmt::format("{}, harmonic {}, B", axis, i + 1), b[i], "", ours.imaginary[i]);
    };
    write("Table 3.5", "x", xa, xb, mh::x);
    write("Table 3.6", "y", ya, yb, mh::y);
}

/// How the forces were measured.
inline void cutting_process(printed_list& all) {
    const auto shallow = thesis::measured_cutter(1), deep = thesis::measured_cutter(3);
    const double turns = 60 * shallow.spindle.value(), edges = double(thesis::measured_edges);
    printed_place(all, thesis_source, "Table 3.4")
        .used("spindle speed", "1360", "rpm", turns)
        .used("cutter diameter", "10", "mm", 1e3 * shallow.diameter.value())
        .used("feed", "320", "mm/min", 1e3 * shallow.feed_per_tooth.value() * edges * turns)
        .used("edges", "3", "", edges)
        .used("depth of cut", "1", "mm", 1e3 * shallow.axial_depth.value())
        .used("depth of cut", "3", "mm", 1e3 * deep.axial_depth.value())
        .used("sampling frequency", "3000", "Hz", 1 / thesis::measured_period.value())
        .used("feed per tooth", "0.1", "mm", 1e3 * shallow.feed_per_tooth.value())
        .differs("320 mm/min at 1360 rpm and 3 edges is 0.078 mm: the table contradicts itself");
    printed_place(all, thesis_source, "Section 3.5.1")
        .used("fundamental frequency", "23.3", "Hz", quadrant::milling_harmonics::fundamental.value());
}
} // namespace printed_detail

/// Chapter 3 of the thesis.
inline void print_chapter3(printed_list& all) {
    using thesis::x, thesis::y;
    printed_detail::friction_parameters(all);
    printed_place(all, thesis_source, "Section 3.4.2").used("elements", "4", "", double(y.alpha.size()));
    printed_detail::elements({all, thesis_source, "Table 3.2"}, y, {"50", "20", "15", "3.4"},
                             {"99.94", "1.364", "1.081", "0.119"});
    printed_detail::elements({all, thesis_source, "Table 3.3"}, x, {"65", "55", "26", "6.5"},
                             {"61.80", "9.852", "4.490", "0.325"});
    printed_detail::cutting_process(all);
    printed_detail::harmonics(all);
}

} // namespace quadrant_reproduce
