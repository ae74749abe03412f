// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../printed.hpp"
#include "../real_cut.hpp"
#include "../thesis.hpp"

#include <quadrant/process/milling_harmonics.hpp>

#include <array>
#include <fmt/format.h>

namespace quadrant_reproduce {

namespace printed_detail {

/// Figs. 5.2 and 5.3: a sinusoidal force.
inline void push(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    const std::string y = "thesis.dob_force.y";
    at("Section 5.2.1")
        .used("amplitude", "1", "V", 1)
        .used("the same in newtons", "1450", "N", thesis::y.kf.value())
        .differs("1450 N/V is the x axis; the figures are of y, which has 1470 N/V");
    at("Fig. 5.2")
        .simulated("y, 1 Hz, observer off", "133.9", "um", y, "error_1Hz_off")
        .simulated("y, 1 Hz, observer on", "2.97", "um", y, "error_1Hz_on")
        .simulated("y, 58 Hz, on", "109", "um", y, "error_58Hz_on")
        .simulated("y, 100 Hz, off", "34.91", "um", y, "error_100Hz_off")
        .simulated("y, 100 Hz, on", "56.1", "um", y, "error_100Hz_on");
    at("Fig. 5.3")
        .simulated("y, 1 Hz, off", "133", "um", y, "error_1Hz_off")
        .simulated("y, 1 Hz, on", "2.96", "um", y, "error_1Hz_on")
        .simulated("y, 58.2 Hz, off", "112", "um", y, "error_58Hz_off")
        .simulated("y, 58 Hz, on", "109", "um", y, "error_58Hz_on")
        .simulated("y, 100 Hz, off", "36.4", "um", y, "error_100Hz_off")
        .simulated("y, 100 Hz, on", "57.8", "um", y, "error_100Hz_on");
    at("Section 5.2.1").simulated("y, it helps up to", "60", "Hz", y, "helps_up_to");
}

/// One of Tables 5.1 to 5.3: columns of harmonics, rows off, on and reduction.
inline void harmonics_table(printed_list& all, const char* where, const std::string& id,
                            const std::vector<int>& harmonics, const std::vector<const char*>& off,
                            const std::vector<const char*>& on, const std::vector<const char*>& reduction) {
    printed_place at(all, thesis_source, where);
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
        const std::string h = std::to_string(harmonics[i]);
        at.measured(h + " harmonics, off", off[i], "um", id, "rms_off_" + h)
            .measured(h + " harmonics, on", on[i], "um", id, "rms_on_" + h)
            .measured(h + " harmonics, reduction", reduction[i], "%", id, "rms_on_" + h)
            .against(reading::reduction, id, "rms_off_" + h);
    }
}

inline void against_harmonics(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    harmonics_table(all, "Table 5.1", "thesis.harmonics.observer", {1, 2, 3, 15},
                    {"9.62", "10.83", "13.99", "14.67"}, {"5.63", "6.34", "6.98", "11.11"},
                    {"41.47", "41.45", "50.00", "24.26"});
    at("Section 5.2.2")
        .measured("first harmonic of the error, less with the observer", "60", "%", "thesis.harmonics.observer",
                  "first_harmonic_on")
        .against(reading::reduction, "thesis.harmonics.observer", "first_harmonic_off")
        .measured("circle, largest radial error, off", "20", "um", "thesis.harmonics.circle", "radial_max_off")
        .measured("circle, largest radial error, on", "10", "um", "thesis.harmonics.circle", "radial_max_on");
    harmonics_table(all, "Table 5.2", "thesis.harmonics.ferraris", {1, 2, 3, 15},
                    {"10.76", "12.04", "18.27", "18.53"}, {"7.16", "8.15", "11.57", "11.89"},
                    {"33.46", "32.37", "36.67", "29.77"});
    harmonics_table(all, "Table 5.3", "thesis.harmonics.ferraris_tracking", {1, 3, 15},
                    {"8.96", "10.06", "10.11"}, {"5.67", "6.60", "6.73"}, {"36.72", "34.39", "33.43"});
    at("Section 5.3.3").measured("mean reduction", "33", "%", "thesis.harmonics.ferraris", "mean_reduction");
}

inline void with_memory(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    at("Section 5.4.1")
        .used("order", "2", "", 2)
        .used("uncertainty of the period", "1", "%", 1)
        .used("bandwidth", "200", "Hz", 200)
        .used("fundamental frequency", "23.3", "Hz", quadrant::milling_harmonics::fundamental.value())
        .simulated("gamma_p", "0.063", "", "thesis.repetitive", "gamma_p")
        .simulated("gamma_np", "6", "dB", "thesis.repetitive", "gamma_np");
    at("Table 5.4")
        .measured("case (i)", "7.68", "um", "thesis.cutting.i", "radial_rms")
        .measured("case (ii)", "4.43", "um", "thesis.cutting.ii", "radial_rms")
        .measured("case (iii)", "1.09", "um", "thesis.cutting.iii", "radial_rms");
    at("Section 5.4.2")
        .measured("less in (iii) than in (i)", "85", "%", "thesis.cutting.iii", "radial_rms")
        .against(reading::reduction, "thesis.cutting.i", "radial_rms")
        .used("8th harmonic", "186", "Hz", 8 * quadrant::milling_harmonics::fundamental.value())
        .measured("bandwidth of the position controller", "45", "Hz", "thesis.loop_dob.y",
                  "position_closed_bandwidth")
        .used("observer", "60", "Hz", thesis::x.corner.value());
}

/// Section 5.5: cutting on the table itself.
inline void real_cut(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    const auto& c = thesis::cutter();
    at("Table 5.5")
        .used("cutter diameter", "16", "mm", 1e3 * c.diameter.value())
        .used("edges", "4", "", thesis::edges)
        .used("feed per tooth", "0.1", "mm/tooth", 1e3 * c.feed_per_tooth.value())
        .differs("4 edges, 1360 rpm and the 5 mm/s of the text are 0.055 mm: the text contradicts the table")
        .used("spindle speed", "1360", "rpm", 60 * c.spindle.value())
        .used("axial depth", "4", "mm", 1e3 * c.axial_depth.value())
        .used("radial depth", "1", "mm", 1e3 * c.radial_depth.value())
        .used("sampling frequency", "2000", "Hz", 1 / thesis::period.value());
    at("Section 5.5")
        .used("radius", "25", "mm", 1e3 * thesis::real_circle().radius)
        .used("speed", "5", "mm/s", 1e3 * thesis::real_circle().feed);
    at("Table 5.6")
        .measured("case (i)", "3.04", "um", "thesis.real_cut.i", "radial_rms")
        .measured("case (ii)", "1.72", "um", "thesis.real_cut.ii", "radial_rms")
        .measured("case (iii)", "0.86", "um", "thesis.real_cut.iii", "radial_rms");
    at("Chapter 6")
        .measured("largest glitch before", "27", "um", "thesis.friction.y.none", "quadrant_glitch_100")
        .measured("largest glitch after", "3", "um", "thesis.friction_dob.y.gms", "quadrant_glitch_100")
        .measured("resonance of the base, x", "40", "Hz", "thesis.loop_modes.x", "base_resonance")
        .measured("resonance of the base, y", "45", "Hz", "thesis.loop_modes.y", "base_resonance");
}
} // namespace printed_detail

/// Chapters 5 and 6 of the thesis.
inline void print_chapter5(printed_list& all) {
    printed_detail::push(all);
    printed_detail::against_harmonics(all);
    printed_detail::with_memory(all);
    printed_detail::real_cut(all);
}

} // namespace quadrant_reproduce
