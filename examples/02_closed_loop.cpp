// SPDX-License-Identifier: BSL-1.0
// A whole axis: the stock cascade drives a simulated linear motor along a sinusoid of 30 mm, 100 mm/s at most.
//
//   reference --> cascade (P on position, PI on velocity, notch, feedforward, limit, DAC) -- volts --> linear_motor --+
//                    ^                                                                                                |
//                    +------------------------------------ encoder, 0.25 um ------------------------------------------+
//
// Source: x axis of [Jamaludin2008] (340 kg, 1450 N/V, 2 kHz), friction of chapter 3; controller of
// docs/formats.md.
// You should see: below 2 um of error in motion, and twice that where the axis reverses (942.5 ms): friction
// turns round there, and the feedforward knows one Coulomb level while the machine's level falls with speed.
// The last line
// is one row of a log: every wire of the loop has a name and a unit.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <cmath>
#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration period = 500_us;
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
using machine = linear_motor<stribeck<>>;

const boxes::parameters tuning{.position_gain = 150.0 / 1_s,
                               .velocity_gain = 60_V / 1_mps,
                               .velocity_integral = 450_V / 1_m,
                               .estimator = {.corner = 150_Hz},
                               .velocity_feedforward = 1,
                               .acceleration_feedforward = 340_kg / (1450_N / 1_V),
                               .viscous_feedforward = 950_N / 1_mps / (1450_N / 1_V),
                               .coulomb_feedforward = 122_N / (1450_N / 1_V),
                               .notch = {.centre = 330_Hz, .width = 0.06},
                               .limit = 10_V,
                               .dac_step = 20_V / 65536.0};
const stribeck<>::parameters friction{
    .coulomb = 122_N, .static_level = 177_N, .stribeck_velocity = 2.22_mmps, .viscous = 950_N / 1_mps};
const machine::parameters table{.mass = 340_kg,
                                .force_constant = 1450_N / 1_V,
                                .friction = friction,
                                .delay = 0.4_ms,
                                .limit = 10_V,
                                .dac_step = {},
                                .encoder_step = 250_nm};
} // namespace

int main() {
    cascade<boxes> axis{.box = {tuning, period}};
    machine motor{table, period};
    quantity<si::length> reading{};

    std::printf("time [ms]  reference [mm]  error [um]  command [V]\n");
    for (int k = 0; k < 2400; ++k) {
        const quantity<si::time> t = static_cast<double>(k) * period;
        const auto reference = 30_mm * (1 - std::cos(3.3333 / 1_s * t));
        reading = motor(axis(reference, reading));
        if (k % 200 == 100 || k == 1885 || k == 1910)
            std::printf("%9.1f  %14.2f  %10.1f  %11.2f\n", 1e3 * t.value(), 1e3 * reference.value(),
                        1e6 * axis.wire.position_error.value(), axis.wire.command.value());
    }
    std::printf("wires:");
    for_each_tap(axis.wire, axis.taps(), [](const char* name, const char* unit, double value) {
        std::printf(" %s=%.3g[%s]", name, value, unit);
    });
    std::printf("\n");
}
