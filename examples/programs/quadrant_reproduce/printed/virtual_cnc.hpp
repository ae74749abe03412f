// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fuzzy_trial.hpp"
#include "../printed.hpp"
#include "../virtual_cnc.hpp"

#include <array>
#include <fmt/format.h>

namespace quadrant_reproduce {

namespace printed_detail {

/// Tables 2 to 4: where the sets end, and how they overlap.
inline void fuzzy_sets(printed_list& all) {
    const quadrant::analysis::tuning_limits limits;
    static constexpr std::array osc{"1.00", "0.75", "0.50", "0.25"}, phm{"30", "40", "45", "60"},
        tre{"20", "5", "1", "0.1"};
    printed_place at(all, vcnc_source, "Table 2");
    for (std::size_t i = 0; i < 4; ++i)
        at.used(fmt::format("OSC, limit {}", i + 1), osc[i], "", limits.oscillation[i])
            .used(fmt::format("PHM, limit {}", i + 1), phm[i], "deg", limits.phase_margin[i])
            .used(fmt::format("TRE, limit {}", i + 1), tre[i], "mm", 1e3 * limits.tracking_error[i]);
    static constexpr std::array inputs{"1 0.7 0.3 0 0", "0.7 1 0.7 0.3 0", "0.3 0.7 1 0.7 0.3",
                                       "0 0.3 0.7 1 0.7", "0 0 0.3 0.7 1"};
    static constexpr std::array outputs{"1 0.9 0.8 0.7 0.6 0.5 0.4", "0.9 1 0.9 0.8 0.7 0.6 0.5",
                                        "0.8 0.9 1 0.9 0.8 0.7 0.6", "0.7 0.8 0.9 1 0.9 0.8 0.7",
                                        "0.6 0.7 0.8 0.9 1 0.9 0.8", "0.5 0.6 0.7 0.8 0.9 1 0.9",
                                        "0.4 0.5 0.6 0.7 0.8 0.9 1"};
    const auto rows = [&](const char* where, const auto& lines, auto&& ours) {
        printed_place table(all, vcnc_source, where);
        for (std::size_t set = 0; set < lines.size(); ++set) {
            const std::string line = lines[set];
            std::size_t from = 0;
            for (std::size_t in = 0; from < line.size(); ++in) {
                const std::size_t to = std::min(line.find(' ', from), line.size());
                table.used(fmt::format("set {}, column {}", set + 1, in + 1), line.substr(from, to - from), "",
                           ours(set, in));
                from = to + 1;
            }
        }
    };
    using namespace quadrant::analysis::detail;
    rows("Table 3", inputs, [](std::size_t set, std::size_t in) { return as_input(set, in); });
    rows("Table 4", outputs, [](std::size_t set, std::size_t in) { return as_output(int(set), int(in)); });
}

/// Table 7, and Table 9 with its trial.
inline void fuzzy_results(printed_list& all) {
    static constexpr std::array attributes{"OSC", "PHM", "TRE"};
    static constexpr std::array states{"HIUN", "LIUN", "ACCP", "LIOQ", "HIOQ"},
        errors{"EL", "LA", "ME", "SM", "OK"};
    static constexpr std::array gain{"-0.2545", "-0.2456", "0",      "0.1552", "0.2456",
                                     "-0.2456", "-0.1552", "0",      "0",      "0.1552",
                                     "-0.1552", "0",       "0.1552", "0.1552", "0"},
        adaptation{"-0.1552", "0",      "0",       "0",       "0.1552", "-0.2456", "-0.2456", "0",
                   "0.1552",  "0.2456", "-0.2545", "-0.2456", "0.2545", "0.1552",  "0"};
    printed_place table(all, vcnc_source, "Table 7");
    for (std::size_t i = 0; i < 15; ++i) {
        const std::string name = fmt::format("{}_{}", attributes[i / 5], (i < 10 ? states : errors)[i % 5]);
        table.simulated(name + ", Ks", gain[i], "", "vcnc.fuzzy.table", name + "_ks")
            .simulated(name + ", rho", adaptation[i], "", "vcnc.fuzzy.table", name + "_rho");
    }
    printed_place(all, vcnc_source, "Section 4.1")
        .used("lambda", "200", "rad/s", vcnc::sliding_mode_of(vcnc::x_axis).sliding.value())
        .used("travel", "100", "mm", 1e3 * vcnc::fuzzy_trial::way.length)
        .used("feed", "200", "mm/s", 1e3 * vcnc::fuzzy_trial::way.feed);
    struct tuned {
        const char *lambda, *gain0, *gain, *rho0, *rho, *error0, *error;
    };
    static constexpr std::array cases{tuned{"200", "1", "0.363", "100", "47.16", "0.009", "0.009"},
                                      tuned{"200", "0.01", "0.315", "1", "39.12", "0.136", "0.011"},
                                      tuned{"200", "10", "0.269", "10000", "37.16", "", "0.012"}};
    printed_place at(all, vcnc_source, "Table 9");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto& c = cases[i];
        const std::string id = fmt::format("vcnc.fuzzy.case{}", i + 1), name = fmt::format("case {}, ", i + 1);
        at.used(name + "lambda", c.lambda, "rad/s", vcnc::sliding_mode_of(vcnc::x_axis).sliding.value())
            .used(name + "Ks at the start", c.gain0, "V s/mm", vcnc::fuzzy_starts[i].gain)
            .simulated(name + "Ks", c.gain, "V s/mm", id, "ks")
            .used(name + "rho at the start", c.rho0, "V/mm", vcnc::fuzzy_starts[i].adaptation)
            .simulated(name + "rho", c.rho, "V/mm", id, "rho");
        if (*c.error0)
            at.simulated(name + "peak error at the start", c.error0, "mm", id, "peak_error_at_start", 1e3);
        at.simulated(name + "peak error", c.error, "mm", id, "peak_error", 1e3);
    }
}

/// Table 8 and Table 10.
inline void drives(printed_list& all) {
    using vcnc::x_axis, vcnc::y_axis;
    printed_place at(all, vcnc_source, "Table 8");
    const double dac = vcnc::dac_step.value(), limit = vcnc::command_limit.value();
    struct drive_as_printed {
        const vcnc::axis& of;
        std::array<const char*, 12> text; ///< Ka, J, B; Tstat, Tcoul, w1, w2, each + and -
    };
    for (const auto& p : {drive_as_printed{x_axis,
                                           {"6.4898", "0.0077736", "0.019811", "2.6256", "-1.8672", "2.1529",
                                            "-1.4730", "3.88", "-3.51", "4.20", "-3.52", ""}},
                          drive_as_printed{y_axis,
                                           {"7.5768", "0.0098109", "0.028438", "2.7658", "-2.4520", "2.5228",
                                            "-2.3887", "2.37", "-4.41", "3.01", "-4.20", ""}}}) {
        const std::string a = std::string(p.of.name) + ", ";
        const auto& t = p.text;
        const auto d = vcnc::drive(p.of, quadrant::in_si(3e-6));
        const auto &f = p.of.forward, &b = p.of.backward;
        const double noise = d.tachometer_noise.value() * 2 * std::numbers::pi / 10e-3; // rad/s
        const double encoder = 1e3 * d.encoder_step.value();
        at.used(a + "Ka", t[0], "A/V", p.of.amplifier)
            .used(a + "Kt", "0.4769", "N m/A", d.drive.torque_constant.value())
            .used(a + "J", t[1], "kg m2", p.of.inertia)
            .used(a + "B", t[2], "kg m2/s", p.of.viscous)
            .used(a + "pitch", "10", "mm", 1e3 * d.drive.pitch.value())
            .used(a + "rg", "1.5915", "mm/rad", 1e3 * d.drive.pitch.value() / (2 * std::numbers::pi))
            .used(a + "D/A converter", "16", "bit", std::log2(20 / dac))
            .used(a + "range of the D/A chip", "10", "V", 65536 * dac / 2)
            .used(a + "D/A resolution", "3.0518e-4", "V", dac)
            .simulated(a + "its variance", "7.761e-9", "V2", "vcnc.parts", "dac_variance")
            .used(a + "limit", "5", "V", limit)
            .used(a + "encoder", "1.22e-3", "mm", encoder)
            .simulated(a + "its variance", "1.2418e-7", "mm2", "vcnc.parts", "encoder_variance")
            .used(a + "tachometer noise", "50e-3", "(rad/s)2", noise * noise)
            .used(a + "Tstat +", t[3], "N m", f.static_level)
            .used(a + "Tstat -", t[4], "N m", -b.static_level)
            .used(a + "Tcoul +", t[5], "N m", f.coulomb)
            .used(a + "Tcoul -", t[6], "N m", -b.coulomb)
            .used(a + "w1 +", t[7], "rad/s", f.fall)
            .used(a + "w1 -", t[8], "rad/s", -b.fall)
            .used(a + "w2 +", t[9], "rad/s", f.rise)
            .used(a + "w2 -", t[10], "rad/s", -b.rise)
            .used(a + "backlash", "0.003", "mm", 0.003);
    }
    printed_place laws(all, vcnc_source, "Table 10");
    for (const vcnc::axis* a : {&x_axis, &y_axis}) {
        const auto pid = vcnc::pid_of(*a);
        const auto smc = vcnc::sliding_mode_of(*a);
        const std::string name = std::string(a->name) + ", ";
        laws.used(name + "Kp", "70", "V/mm", pid.gain.value() * 1e-3)
            .used(name + "Ki", "800", "V/(mm s)", pid.integral_gain.value() * 1e-3)
            .used(name + "Kd", "0.30", "V s/mm", pid.derivative_gain.value() * 1e-3)
            .used(name + "lambda", "200", "rad/s", smc.sliding.value())
            .used(name + "Ks", "0.30", "V s/mm", smc.gain.value() * 1e-3)
            .used(name + "rho", "30", "V/mm", smc.adaptation.value() * 1e-3);
    }
}

/// Tables 11 and 12: of each row simulation, experiment, difference and deviation.
inline void contours(printed_list& all) {
    printed_place(all, vcnc_source, "Section 4.2")
        .used("control interval", "1", "ms", 1e3 * vcnc::period.value())
        .used("side of the diamond", "50", "mm", 1e3 * vcnc::diamond::side)
        .used("radius of the circle", "50", "mm", 1e3 * vcnc::circle::radius)
        .used("feed", "200", "mm/s", 1e3 * vcnc::circle::feed.feed)
        .used("acceleration", "2000", "mm/s2", 1e3 * vcnc::circle::feed.acceleration)
        .used("jerk", "50000", "mm/s3", 1e3 * vcnc::circle::feed.jerk);
    struct line_as_printed {
        const char *law, *quantity, *simulated, *measured, *difference, *deviation;
    };
    const auto table = [&](const char* where, const std::string& path, const auto& lines) {
        printed_place at(all, vcnc_source, where);
        for (const auto& l : lines) {
            const std::string id = "vcnc." + path + "." + l.law,
                              name = std::string(l.law) + ", " + std::string(l.quantity).substr(0, 1);
            const std::string what =
                l.quantity == std::string("contour_error_max") ? std::string(l.law) + ", contour" : name;
            const double measured = 1e3 * std::strtod(l.measured, nullptr);
            at.simulated(what + ", simulated", l.simulated, "mm", id, l.quantity, 1e3)
                .measured(what + ", measured", l.measured, "mm", id, l.quantity, 1e3)
                .measured(what + ", difference", l.difference, "mm", id, l.quantity, 1e3)
                .against(reading::difference, measured)
                .measured(what + ", deviation", l.deviation, "%", id, l.quantity)
                .against(reading::deviation, measured);
        }
    };
    const char *x = "x_error_max", *y = "y_error_max", *c = "contour_error_max";
    table("Table 11", "diamond",
          std::array{line_as_printed{"pid", x, "0.0375", "0.0376", "0.0001", "0.2659"},
                     line_as_printed{"smc", x, "0.0122", "0.0115", "0.0007", "6.0870"},
                     line_as_printed{"pid", y, "0.0412", "0.0414", "0.0002", "0.4831"},
                     line_as_printed{"smc", y, "0.0074", "0.0070", "0.0004", "5.7143"},
                     line_as_printed{"pid", c, "0.0126", "0.0138", "0.0012", "8.6957"},
                     line_as_printed{"smc", c, "0.0084", "0.0081", "0.0003", "3.7037"}});
    table("Table 12", "circle",
          std::array{line_as_printed{"pid", x, "0.0471", "0.0436", "0.0035", "8.0275"},
                     line_as_printed{"smc", x, "0.0117", "0.0109", "0.0008", "7.3394"},
                     line_as_printed{"pid", y, "0.0223", "0.0220", "0.0003", "1.3636"},
                     line_as_printed{"smc", y, "0.0077", "0.0072", "0.0005", "6.9444"},
                     line_as_printed{"pid", c, "0.0215", "0.0226", "0.0011", "4.8673"},
                     line_as_printed{"smc", c, "0.0117", "0.0108", "0.0009", "8.3333"}});
}
} // namespace printed_detail

/// The Virtual CNC.
inline void print_virtual_cnc(printed_list& all) {
    printed_detail::fuzzy_sets(all);
    printed_detail::fuzzy_results(all);
    printed_detail::drives(all);
    printed_detail::contours(all);
}

} // namespace quadrant_reproduce
