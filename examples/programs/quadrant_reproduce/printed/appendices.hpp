// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../experiment/ferraris.hpp"
#include "../printed.hpp"

namespace quadrant_reproduce {

/// Appendices A to D of the thesis.
inline void print_appendices(printed_list& all) {
    const auto at = [&](const char* where) { return printed_place(all, thesis_source, where); };
    at("Appendix A")
        .measured("resonance, bolted", "45", "Hz", "thesis.loop_modes.y", "base_resonance")
        .cannot(
            origin::measured, "resonance, bolts removed", "12", "Hz",
            "what stiffness the ground alone gives the base is not printed, and nothing else that is printed "
            "was measured without bolts");
    at("Appendix B")
        .used("lowest frequency", "0.2", "Hz", 0.2)
        .used("highest frequency", "100", "Hz", 100)
        .measured("uniform up to", "40", "Hz", "thesis.ferraris_calibration", "uniform_up_to")
        .used("G", "3.298e7", "um/(V s2)", 1e6 * ferraris_gain)
        .used("Z", "-8580", "um/s2", 1e6 * ferraris_offset);
    const std::string observer = "thesis.harmonic_observer";
    const char* zero =
        "an exact zero of eq. (D.15): the digits are rounding, and that rounding agrees says nothing. "
        "Ours, one digit of the frequency beside it, are rows of the section";
    at("Fig. D.3")
        .used("one harmonic", "46", "Hz", 46)
        .used("the other", "69", "Hz", 69)
        .cannot(origin::simulated, "one harmonic, |S| at 46 Hz", "-307", "dB", zero)
        .cannot(origin::simulated, "two harmonics, |S| at 46 Hz", "-346", "dB", zero)
        .cannot(origin::simulated, "two harmonics, |S| at 69 Hz", "-310", "dB", zero);
    at("Fig. D.4")
        .simulated("error at 23 Hz, simulated", "782", "um", observer, "error_23Hz")
        .simulated("error at 23 Hz, by eq. (D.14)", "783", "um", observer, "error_23Hz_response");
    at("Fig. D.6")
        .used("force", "23.3", "Hz", 23.3)
        .used("force", "40", "Hz", 40)
        .used("observer", "46.6", "Hz", 46.6);
    at("Fig. D.10")
        .measured("1 harmonic, rms without", "3.1", "um", observer, "rms_off_1")
        .measured("1 harmonic, rms with", "0.66", "um", observer, "rms_on_1")
        .measured("3 harmonics, rms without", "7.12", "um", observer, "rms_off_3")
        .measured("3 harmonics, rms with", "3.90", "um", observer, "rms_on_3");
}

} // namespace quadrant_reproduce
