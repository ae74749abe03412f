// SPDX-License-Identifier: BSL-1.0
// A notch dropped into a loop that somebody else wrote, in bare doubles: one line to make it, one line to use
// it.
//
//   demand --->( )---> P ---> notch ---> amplifier ---> mass, swinging frame --- y ---> difference, low-pass --+
//             -  ^                                                                                            |
//                +--------------------------------------------------------------------------------------------+
//
// Source: the structural mode of the x axis in [Jamaludin2008] ch. 2 (320 to 340 Hz).
// You should see: without the notch the loop rings up until the amplifier clips; with it, the same gain is
// quiet. Volts go in, volts come out; a bare number, or a position, does not compile.
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/notch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {
using namespace quadrant;
using namespace quadrant::literals;
constexpr double T = 500e-6; // [s]

/// Somebody's simulated machine, 20 steps a period: a drive that acts one period late, 340 kg on viscous
/// friction, and a frame that swings at 330 Hz when pushed.
struct machine {
    double x = 0, v = 0, swing = 0, swing_speed = 0, next = 0;
    double operator()(double command) {
        const double volts = next;
        next = command;
        const double w = 2 * 3.141592653589793 * 330, h = T / 20;
        for (int i = 0; i < 20; ++i) {
            const double push = 1450 * volts / 340;
            v += h * (push - 28 * v);
            x += h * v;
            swing_speed += h * (0.6 * push - 2 * 0.01 * w * swing_speed - w * w * swing);
            swing += h * swing_speed;
        }
        return x + swing; // what the encoder on the slide sees
    }
};

/// A step to 10 mm/s; what is left of the error in the second half of 0.4 s, and how often the amplifier
/// clipped.
void run(bool with_notch) {
    notch<signal::voltage> quiet{{330_Hz, 0.3}, 500_us}; // one line to make it
    machine axis;
    double u = 0, before = 0, speed = 0, worst = 0;
    int clipped = 0;
    for (int k = 0; k < 800; ++k) {
        const double y = axis(u);
        speed += 0.376 * ((y - before) / T - speed); // difference and low-pass of 150 Hz
        before = y;
        u = 100 * (0.010 - speed);
        if (with_notch) u = quiet(u * 1_V).value(); // one line to use it
        clipped += std::abs(u) > 10;
        u = std::clamp(u, -10.0, 10.0);
        if (k >= 400) worst = std::max(worst, std::abs(0.010 - speed));
    }
    std::printf("%-15s off by %5.1f mm/s, amplifier clipped %3d times\n",
                with_notch ? "with notch:" : "without notch:", 1e3 * worst, clipped);
}
} // namespace

int main() {
    run(false);
    run(true);
}
