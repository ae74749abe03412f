// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../printed.hpp"
#include "../thesis.hpp"

namespace quadrant_reproduce {

namespace printed_detail {

/// Tables 2.1 and 2.2, the notches and what section 2.2 says of the machine.
inline void machine(printed_list& all) {
    using thesis::x, thesis::y;
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    const double mass_x = (x.kf / x.B).value(), mass_y = (y.kf / y.B).value();
    at("Section 2.2")
        .used("resolution of the encoder", "0.25", "um", 0.25)
        .used("signal period of the encoder", "4", "um", 0.25 * 4 * 4) // interpolation 4, 4 edges
        .used("filter of the velocity", "150", "Hz", thesis::estimator_corner.value())
        .used("y, moving mass", "170", "kg", mass_y)
        .used("x, moving mass", "340", "kg", mass_x)
        .used("controller", "2000", "Hz", 1 / thesis::period.value());
    at("Section 2.3")
        .used("sampling frequency", "2000", "Hz", 1 / thesis::period.value())
        .used("duration", "5", "min", 5)
        .used("samples per window", "2048", "", 2048)
        .used("resolution", "1", "Hz", 1 / (2048 * thesis::period.value()))
        .used("x, anti-resonance", "47", "Hz", 47)
        .used("y, anti-resonance", "44", "Hz", 44);
    at("Table 2.1")
        .used("x, A", "28.57", "1/s", x.A.value())
        .used("x, B", "4.526", "m/(V s2)", x.B.value())
        .used("x, Td", "0.00065", "s", x.delay.value())
        .used("y, A", "20.00", "1/s", y.A.value())
        .used("y, B", "8.916", "m/(V s2)", y.B.value())
        .used("y, Td", "0.00065", "s", y.delay.value());
    at("Section 2.4.1")
        .used("x, force constant", "1450", "N/V", x.kf.value())
        .used("y, force constant", "1470", "N/V", y.kf.value());
    at("Eqs. (2.22-2.24)")
        .used("corner of Vest", "942.5", "rad/s", 2 * thesis::pi_ * thesis::estimator_corner.value())
        .used("x, notch", "4.3e6", "rad2/s2", x.notch_squared)
        .used("x, notch", "125.7", "rad/s", x.notch_damping)
        .used("y, notch", "3.41e6", "rad2/s2", y.notch_squared)
        .used("y, notch", "314.2", "rad/s", y.notch_damping);
    at("Table 2.2")
        .used("x, kp", "0.00006", "V s/um", x.kp.value() * 1e-6)
        .used("x, ki", "0.00045", "V/um", x.ki.value() * 1e-6)
        .used("y, kp", "0.00003", "V s/um", y.kp.value() * 1e-6)
        .used("y, ki", "0.00025", "V/um", y.ki.value() * 1e-6);
    at("Eq. (2.29)").used("kv", "150", "1/s", thesis::position_gain.value());
}

/// Tables 2.3 to 2.6: read off on the measured frequency response.
inline void loops(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    const std::string x = "thesis.loop.x", y = "thesis.loop.y";
    at("Table 2.3")
        .measured("x, gain margin", "12.332", "dB", x, "velocity_gain_margin")
        .measured("x, gain margin at", "315.08", "Hz", x, "velocity_gain_margin_at")
        .measured("x, phase margin", "74.514", "deg", x, "velocity_phase_margin")
        .measured("x, phase margin at", "65.012", "Hz", x, "velocity_phase_margin_at")
        .measured("y, gain margin", "10.311", "dB", y, "velocity_gain_margin")
        .measured("y, gain margin at", "307.63", "Hz", y, "velocity_gain_margin_at")
        .measured("y, phase margin", "73.059", "deg", y, "velocity_phase_margin")
        .measured("y, phase margin at", "34.922", "Hz", y, "velocity_phase_margin_at");
    at("Table 2.4")
        .measured("x, velocity bandwidth", "28.9", "Hz", x, "velocity_bandwidth")
        .measured("y, velocity bandwidth", "28.8", "Hz", y, "velocity_bandwidth");
    at("Table 2.5")
        .measured("x, gain margin", "15.1", "dB", x, "position_gain_margin")
        .measured("x, gain margin at", "100", "Hz", x, "position_gain_margin_at")
        .measured("x, phase margin", "68", "deg", x, "position_phase_margin")
        .measured("x, phase margin at", "21.4", "Hz", x, "position_phase_margin_at")
        .measured("y, gain margin", "16.49", "dB", y, "position_gain_margin")
        .measured("y, gain margin at", "100.62", "Hz", y, "position_gain_margin_at")
        .measured("y, phase margin", "67.18", "deg", y, "position_phase_margin")
        .measured("y, phase margin at", "22.47", "Hz", y, "position_phase_margin_at");
    at("Table 2.6")
        .measured("x, position bandwidth", "26.6", "Hz", x, "position_bandwidth")
        .measured("y, position bandwidth", "27.1", "Hz", y, "position_bandwidth");
    at("Section 2.5.2")
        .measured("x, minimum stiffness", "15", "N/um", x, "min_dynamic_stiffness")
        .measured("y, minimum stiffness", "8", "N/um", y, "min_dynamic_stiffness");
    at("Fig. 2.24")
        .simulated("x, |Ep/Zref| at 10 Hz", "0.441", "", x, "tracking_ratio_10Hz")
        .simulated("y, |Ep/Zref| at 10 Hz", "0.423", "", y, "tracking_ratio_10Hz");
    at("Eq. (2.38)")
        .simulated("y, velocity corner", "267.5", "rad/s", y, "velocity_corner")
        .simulated("y, velocity corner", "42.6", "Hz", y, "velocity_corner", 2 * thesis::pi_);
    at("Fig. 2.28").measured("y, velocity closed loop at -3 dB", "40.9", "Hz", y, "velocity_closed_bandwidth");
    at("Section 2.6")
        .measured("y, velocity closed loop", "41", "Hz", y, "velocity_closed_bandwidth")
        .simulated("y, damping", "0.67", "", y, "damping");
    at("Eq. (2.40)")
        .simulated("y, position corner", "200", "rad/s", y, "position_corner")
        .simulated("y, position corner", "31", "Hz", y, "position_corner", 2 * thesis::pi_);
    at("Fig. 2.29").measured("y, position closed loop at -3 dB", "28", "Hz", y, "position_closed_bandwidth");
}

/// The experiments of section 2.5: a sinusoid of 1 mm and 10 Hz.
inline void feedforward(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    at("Section 2.5.3").used("amplitude", "1", "mm", 1).used("frequency", "10", "Hz", 10);
    at("Fig. 2.23")
        .simulated("x, amplitude of the error", "0.44", "mm", "thesis.feedforward.x", "error_without")
        .simulated("y, amplitude of the error", "0.42", "mm", "thesis.feedforward.y", "error_without");
    at("Fig. 2.26")
        .simulated("x, error with feedforward", "0", "mm", "thesis.feedforward.x", "error_with")
        .simulated("y, error with feedforward", "0", "mm", "thesis.feedforward.y", "error_with");
}
} // namespace printed_detail

/// Chapter 2 of the thesis.
inline void print_chapter2(printed_list& all) {
    printed_detail::machine(all);
    printed_detail::loops(all);
    printed_detail::feedforward(all);
}

} // namespace quadrant_reproduce
