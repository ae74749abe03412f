// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chapter3.hpp"

namespace quadrant_reproduce {

namespace printed_detail {

/// Section 4.2: friction fed forward.
inline void friction_feedforward(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    using thesis::x, thesis::y;
    at("Table 4.1")
        .used("x, A", "28.57", "1/s", x.A.value())
        .simulated("x, A'", "2.5", "1/s", "thesis.a_prime.x", "A_prime")
        .used("x, B", "4.526", "m/(V s2)", x.B.value())
        .used("x, B'", "4.526", "m/(V s2)", x.B.value())
        .used("y, A", "20", "1/s", y.A.value())
        .simulated("y, A'", "0.095", "1/s", "thesis.a_prime.y", "A_prime")
        .used("y, B", "8.916", "m/(V s2)", y.B.value())
        .used("y, B'", "8.916", "m/(V s2)", y.B.value());
    at("Section 4.2.2")
        .used("amplitude", "30", "mm", 30)
        .used("largest speed", "100", "mm/s", 100)
        .used("frequency", "0.53", "Hz", 0.1 / 0.03 / (2 * thesis::pi_));
    struct both {
        const char *how, *simulated_x, *simulated_y, *measured_x, *measured_y;
    };
    auto simulated = at("Table 4.2"), measured = at("Table 4.4");
    const std::string id = "thesis.friction.", fast = "quadrant_glitch_100";
    for (const both& b : {both{"none", "15", "31", "15", "35"}, both{"static", "5", "8.3", "5", "13"},
                          both{"gms", "4", "1.2", "4", "10"}}) {
        const std::string how = b.how;
        simulated.simulated("x, " + how, b.simulated_x, "um", id + "x." + how, fast);
        simulated.simulated("y, " + how, b.simulated_y, "um", id + "y." + how, fast);
        measured.measured("x, " + how, b.measured_x, "um", id + "x." + how, fast);
        measured.measured("y, " + how, b.measured_y, "um", id + "y." + how, fast);
    }
    at("Section 4.2.3")
        .measured("y, less with GMS than with none", "71", "%", id + "y.gms", fast)
        .against(reading::reduction, id + "y.none", fast);
    elements(at("Table 4.3a"), y, {"50", "20", "15", "3.4"}, {"99.94", "1.364", "1.081", "0.119"});
    elements(at("Table 4.3b"), thesis::y_adjusted, {"57", "26.5", "15", "3.4"},
             {"110.0", "2.0", "1.5", "0.119"});
}

/// Tables 4.5 to 4.8: the observer in the loop.
inline void observer_loops(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    using thesis::x, thesis::y;
    const auto corner = [](const thesis::axis& a) { return 2 * thesis::pi_ * a.corner.value(); };
    at("Table 4.5")
        .used("x, m", "0", "", 0)
        .used("x, n", "2", "", 2)
        .used("x, wc", "60", "Hz", x.corner.value())
        .used("x, numerator of Q", "1.421e005", "rad2/s2", corner(x) * corner(x))
        .used("x, damping of Q", "754", "rad/s", 2 * corner(x))
        .used("y, m", "0", "", 0)
        .used("y, n", "2", "", 2)
        .used("y, wc", "90", "Hz", y.corner.value())
        .used("y, numerator of Q", "3.198e005", "rad2/s2", corner(y) * corner(y))
        .used("y, damping of Q", "1131", "rad/s", 2 * corner(y));
    const std::string none = "thesis.loop.", with = "thesis.loop_dob.";
    const auto margins = [&](const char* where, const std::string& loop, const std::array<const char*, 8>& p) {
        auto table = at(where);
        std::size_t i = 0;
        for (const std::string axis : {"x", "y"})
            for (const std::string kind : {"gain", "phase"}) {
                const std::string quantity = loop + "_" + kind + "_margin",
                                  unit = kind == "gain" ? "dB" : "deg";
                table.measured(axis + ", " + kind + " margin, no observer", p[i++], unit, none + axis,
                               quantity);
                table.measured(axis + ", " + kind + " margin, with observer", p[i++], unit, with + axis,
                               quantity);
            }
    };
    margins("Table 4.6", "velocity",
            {"12.332", "11.02", "74.514", "67.345", "14.622", "12.938", "71.888", "65.11"});
    margins("Table 4.7", "position",
            {"15.071", "13.621", "67.959", "69.561", "16.331", "13.773", "67.295", "70.113"});
    at("Fig. 4.19")
        .measured("x, velocity bandwidth, no observer", "28.9", "Hz", none + "x", "velocity_bandwidth")
        .measured("x, velocity bandwidth, with observer", "29.9", "Hz", with + "x", "velocity_bandwidth")
        .measured("y, velocity bandwidth, no observer", "28.9", "Hz", none + "y", "velocity_bandwidth")
        .measured("y, velocity bandwidth, with observer", "32", "Hz", with + "y", "velocity_bandwidth");
    at("Section 4.3.2")
        .measured("x, position closed loop, with observer", "40.6", "Hz", with + "x",
                  "position_closed_bandwidth")
        .measured("y, position closed loop, with observer", "43.2", "Hz", with + "y",
                  "position_closed_bandwidth");
    auto section = at("Section 4.3.2");
    for (const std::string axis : {"x", "y"})
        for (const char* loop : {"velocity_closed_bandwidth", "position_closed_bandwidth"})
            section.measured(axis + ", " + loop + ", more with observer", "5", "Hz", with + axis, loop)
                .against(reading::rise, none + axis, loop);
    at("Table 4.8")
        .measured("x, bandwidth, no observer", "26.6", "Hz", none + "x", "position_bandwidth")
        .measured("x, bandwidth, with observer", "29.2", "Hz", with + "x", "position_bandwidth")
        .measured("y, bandwidth, no observer", "27.2", "Hz", none + "y", "position_bandwidth")
        .measured("y, bandwidth, with observer", "34", "Hz", with + "y", "position_bandwidth");
}

/// Tables 4.9 to 4.11: friction with the observer, and circles.
inline void observer_friction(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    const std::string id = "thesis.friction_dob.", fast = "quadrant_glitch_100";
    struct both {
        const char *how, *simulated_x, *simulated_y, *measured_x, *measured_y;
    };
    auto simulated = at("Table 4.9"), measured = at("Table 4.10"), summary = at("Table 4.11");
    const std::array with{both{"none", "9", "8.5", "7", "11"}, both{"static", "5.5", "5", "3", "5"},
                          both{"gms", "1", "1", "2.5", "3"}};
    for (const both& b : with) {
        const std::string how = b.how, named = how == "none" ? "observer alone" : "observer and " + how;
        simulated.simulated("x, " + named, b.simulated_x, "um", id + "x." + how, fast);
        simulated.simulated("y, " + named, b.simulated_y, "um", id + "y." + how, fast);
        measured.measured("x, " + named, b.measured_x, "um", id + "x." + how, fast);
        measured.measured("y, " + named, b.measured_y, "um", id + "y." + how, fast);
    }
    const auto row = [&](const std::string& named, const std::string& of, const std::string& how, const char* x,
                         const char* y, const char* radial, const std::string& circle) {
        summary.measured("x, " + named, x, "um", of + "x." + how, fast)
            .measured("y, " + named, y, "um", of + "y." + how, fast)
            .measured("radial, " + named, radial, "um", "thesis.circle." + circle, "radial_max");
    };
    const std::string bare = "thesis.friction.";
    row("none", bare, "none", "15", "35", "25", "none");
    row("static", bare, "static", "5", "13", "7", "static");
    row("GMS", bare, "gms", "4", "10", "6", "gms");
    row("observer", id, "none", "7", "11", "7", "dob");
    row("observer and static", id, "static", "3", "5", "5", "dob_static");
    row("observer and GMS", id, "gms", "2.5", "3", "3", "dob_gms");
    at("Section 4.3.4").measured("y, observer and GMS", "3", "um", id + "y.gms", fast);
    at("Fig. 4.30")
        .measured("x, rms, observer", "1.13", "um", "thesis.circle.dob", "x_error_rms")
        .measured("y, rms, observer", "1.02", "um", "thesis.circle.dob", "y_error_rms")
        .measured("x, rms, observer and static", "0.666", "um", "thesis.circle.dob_static", "x_error_rms")
        .measured("y, rms, observer and static", "0.675", "um", "thesis.circle.dob_static", "y_error_rms")
        .measured("x, rms, observer and GMS", "0.84", "um", "thesis.circle.dob_gms", "x_error_rms")
        .measured("y, rms, observer and GMS", "0.62", "um", "thesis.circle.dob_gms", "y_error_rms");
}
} // namespace printed_detail

/// Chapter 4 of the thesis.
inline void print_chapter4(printed_list& all) {
    printed_detail::friction_feedforward(all);
    printed_detail::observer_loops(all);
    printed_detail::observer_friction(all);
}

} // namespace quadrant_reproduce
