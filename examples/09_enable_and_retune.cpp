// SPDX-License-Identifier: BSL-1.0
// An axis as an integrator needs it: enabled on the move, tuned while it runs, stopped in an emergency.
//
//   stream --> stream_limiter --> axis_enable --reference--> cascade --volts--> linear_motor --+
//                                    ^ buttons, trip            ^ track, retune                |
//                                 following_error <-------------+------------------------------+
//
// First another controller has the axis, and the cascade tracks what that one puts out. At 200 ms it is
// enabled: the command goes on where it was. At 400 ms the thread that tunes has offered other boxes, and they
// are taken whole between two samples. At 1000 ms somebody hits the mushroom: a ramp of 2 m/s^2, the brake,
// off, and the cascade tracks zero volts.
// You should see: the command moves by millivolts where the axis is enabled and tuned, and the stop takes
// v^2/(2 a) = 2.3 mm.
#include <quadrant/base/literals.hpp>
#include <quadrant/block/parameter_swap.hpp>
#include <quadrant/control/axis_enable.hpp>
#include <quadrant/control/following_error.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>
#include <quadrant/trajectory/stream_limiter.hpp>

#include <cmath>
#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration period = 500_us;
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;

const boxes::parameters soft{.position_gain = 80.0 / 1_s,
                             .velocity_gain = 40_V / 1_mps,
                             .velocity_integral = 300_V / 1_m,
                             .estimator = {.corner = 150_Hz},
                             .velocity_feedforward = 1,
                             .acceleration_feedforward = 340_kg / (1450_N / 1_V),
                             .viscous_feedforward = 950_N / 1_mps / (1450_N / 1_V),
                             .notch = {.centre = 330_Hz, .width = 0.06},
                             .limit = 10_V};
boxes::parameters with(per_second kv, boxes::parameters p) {
    p.position_gain = kv;
    return p;
}
} // namespace

int main() {
    cascade<boxes> axis{.box = {soft, period}}, other{.box = {with(40.0 / 1_s, soft), period}};
    parameter_swap<boxes> tuning(axis.box);
    trajectory::stream_limiter<100> smooth({.velocity = 0.2_mps, .acceleration = 1_mps2}, period);
    axis_enable<> power(
        {.velocity = 0.2_mps, .deceleration = 1_mps2, .emergency_deceleration = 2_mps2, .brake_time = 20_ms},
        period);
    following_error<> guard({.window = 100_um, .per_speed = 20_ms}, period);
    linear_motor<> motor({.mass = 340_kg,
                          .force_constant = 1450_N / 1_V,
                          .friction = {.coulomb = 40_N, .viscous = 950_N / 1_mps},
                          .delay = 0.4_ms,
                          .encoder_step = 250_nm},
                         period);
    quantity<si::length> measured{};
    quantity<si::electric_potential> command{};

    std::printf("time [ms]     power  reference [mm]  error [um]  command [mV]\n");
    for (int k = 0; k < 2200; ++k) {
        const duration t = static_cast<double>(k) * period;
        const power_request buttons{
            .enable = t >= 200_ms, .emergency_stop = t >= 1000_ms, .trip = guard.tripped()};
        const auto stream = smooth(20_mm * (1 - std::cos(5.0 / 1_s * t))); // 100 mm/s at most
        const auto reference = power(buttons, stream);

        if (k == 790) tuning.offer(boxes{with(150.0 / 1_s, soft), period}); // in a machine: by another thread
        if (k == 800)
            if (const boxes* next = tuning.take()) axis.retune(*next);

        if (power.on()) {
            guard(reference - measured, power.now().speed);
            command = axis(reference, measured);
        } else {
            guard.reset();
            command = t < 200_ms ? other(reference, measured) : 0_V; // another controller; no power
            axis.track(reference, measured, command);
        }
        bool shown = false;
        for (const int event : {400, 800, 2000, 2137}) shown = shown || (k >= event - 2 && k < event + 2);
        if (shown)
            std::printf("%9.1f  %8s  %14.3f  %10.1f  %12.1f\n", 1e3 * t.value(),
                        power.power() == power_state::on         ? "on"
                        : power.power() == power_state::stopping ? "stopping"
                                                                 : "off",
                        1e3 * reference.value(), 1e6 * (reference - measured).value(), 1e3 * command.value());
        measured = motor(command);
    }
}
