// SPDX-License-Identifier: BSL-1.0
// What a project that uses quadrant might begin with. Built twice: by add_subdirectory and by find_package.
#include <quadrant/filter/notch.hpp>
#include <quadrant/literals.hpp>

#include <cstdio>

int main() {
    using namespace quadrant;
    using namespace quadrant::literals;
    notch<signal::force> resonance({.centre = 330_Hz, .damping = 0.4}, 500_us);
    std::printf("gain at 330 Hz: %.3f, at 50 Hz: %.3f\n", std::abs(resonance.response(330_Hz)),
                std::abs(resonance.response(50_Hz)));
}
