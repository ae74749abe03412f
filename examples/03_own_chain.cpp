// SPDX-License-Identifier: BSL-1.0
// Your own diagram: a struct of boxes, a struct of wires, and a body in which each line is one arrow.
//
//   r -> estimator -> notch -------- reference speed --+
//   r -> position_loop (r - y) ------------------------+-->( )--> velocity_loop --+--> amplifier --> volts
//                                                        -  ^                     |
//   y -> estimator -> notch -------- measured speed --------+                     |
//   r -> difference -> difference -> inertia -------------------------------------+
//
// Source: the thesis' own loop, [Jamaludin2008] eq. (2.22) to (2.34): the notch sits in the velocity feedback,
// and the reference velocity passes the same filters. The stock cascade has the notch in the command, and plain
// differences.
// You should see: with the same filters on both sides the error is less than a tenth of that with a plain
// difference (thesis: 2.4 um for this motion).
#include <quadrant/quadrant.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration period = 500_us;
using position = quantity<si::length>;
using voltage = quantity<si::electric_potential>;

// Parameters as named constants: a wrong unit is reported on its own line.
const filtered_derivative<signal::position, signal::velocity>::parameters corner{150_Hz}; // 942.5 rad/s
const notch<signal::velocity>::parameters structure{.centre = 330_Hz, .width = 0.06};
const proportional<signal::position, signal::velocity>::parameters kv{150.0 / 1_s};
const proportional_integral<signal::velocity, signal::voltage>::parameters pi_x{
    .gain = 60_V / 1_mps, .integral_gain = 450_V / 1_m, .limit = 10_V};
const proportional<signal::acceleration, signal::voltage>::parameters mass{1_V / 1_mps2 / 4.526};
const proportional<signal::velocity, signal::voltage>::parameters drag{28.57 / 4.526 * 1_V / 1_mps};

/// What is in each box; swap a box by changing its type.
struct thesis_axis {
    filtered_derivative<signal::position, signal::velocity> speed{corner, period},
        reference_speed{corner, period};
    notch<signal::velocity> quiet{structure, period}, reference_quiet{structure, period};
    backward_difference<signal::position, signal::velocity> rate{{}, period};
    backward_difference<signal::velocity, signal::acceleration> rate_of_rate{{}, period};
    proportional<signal::position, signal::velocity> position_loop{kv, period};
    proportional_integral<signal::velocity, signal::voltage> velocity_loop{pi_x, period};
    proportional<signal::acceleration, signal::voltage> inertia{mass, period};
    proportional<signal::velocity, signal::voltage> viscous{drag, period};
    limiter<signal::voltage> amplifier{{.low = -10_V, .high = 10_V}, period};
    bool same_filters = true;

    /// Every wire has a name, and can be looked at after any step.
    struct {
        position error;
        quantity<si::velocity> plain, demand, measured;
        voltage feedback, inertia, command;
    } wire{};

    voltage operator()(position r, position y) noexcept {
        wire.error = r - y;
        wire.plain = rate(r);
        wire.measured = quiet(speed(y));
        wire.demand =
            position_loop(wire.error) + (same_filters ? reference_quiet(reference_speed(r)) : wire.plain);
        wire.feedback = velocity_loop(wire.demand - wire.measured);
        wire.inertia = inertia(rate_of_rate(wire.plain)) + viscous(wire.plain);
        wire.command = wire.feedback + wire.inertia;
        return amplifier(wire.command);
    }
};

/// Largest error in the second of two periods of 30 mm at 0.53 Hz, on the thesis' model B e^(-s Td) / (s (s +
/// A)).
double worst(bool same_filters) {
    thesis_axis axis;
    axis.same_filters = same_filters;
    linear_motor<> motor{{.mass = 1_kg,
                          .force_constant = 4.526_N / 1_V,
                          .friction = {.coulomb = 0_N, .viscous = 28.57_N / 1_mps},
                          .delay = 0.4_ms},
                         period};
    double most = 0;
    position y{};
    for (int k = 0; k < 7540; ++k) {
        y = motor(axis(30_mm * (1 - std::cos(3.3333 * k * period.value())), y));
        if (k > 3770) most = std::max(most, std::abs(axis.wire.error.value()));
    }
    return most;
}
} // namespace

int main() {
    std::printf("plain difference of the reference:      %.1f um\n", 1e6 * worst(false));
    std::printf("the same filters as the measured speed: %.1f um\n", 1e6 * worst(true));
}
