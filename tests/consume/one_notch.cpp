// SPDX-License-Identifier: BSL-1.0
// What a project that uses quadrant might begin with. Built in every way in which one can get at the headers.
#ifdef SINGLE_FILE
#    include <quadrant_single.hpp>
#else
#    include <quadrant/base/literals.hpp>
#    include <quadrant/filter/notch.hpp>
#endif

#include <cstdio>

int main() {
    using namespace quadrant;
    using namespace quadrant::literals;
    notch<signal::force> resonance({.centre = 330_Hz, .width = 0.4}, 500_us);
    std::printf("gain at 330 Hz: %.3f, at 50 Hz: %.3f\n", std::abs(resonance.response(330_Hz)),
                std::abs(resonance.response(50_Hz)));
}
