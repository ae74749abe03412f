// SPDX-License-Identifier: BSL-1.0
// Situation: moves that ask for more than the amplifier has; meanwhile the velocity loop must not wind up.
// From: an anti-windup switch that changed nothing (control_toolbox #38, #298), hunting (Tinymovr #166);
// field.md 6.13.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using stock = cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>>;
using machine = linear_motor<stribeck<>>;

/// The stock axis with another velocity loop.
template <class AntiWindup> struct axis_with : stock {
    using loop = proportional_integral<signal::velocity, signal::voltage, AntiWindup>;
    axis_with(const parameters& p, const typename loop::parameters& l) : stock(p, Ts), velocity_loop(l, Ts) {}
    loop velocity_loop; // hides the stock one
};
static_assert(axis_boxes<axis_with<back_calculation>>);

const auto amplifier = 0.5_V; // 725 N for 340 kg
const stock::parameters tuning{.position_gain = 150.0 / 1_s,
                               .velocity_gain = 60_V / 1_mps,
                               .velocity_integral = 450_V / 1_m,
                               .estimator = {.corner = 150_Hz},
                               .velocity_feedforward = 0,
                               .notch = {},
                               .limit = amplifier};
const machine::parameters table{.mass = 340_kg,
                                .force_constant = 1450_N / 1_V,
                                .friction = {.coulomb = 122_N,
                                             .static_level = 177_N,
                                             .stribeck_velocity = 2.2_mmps,
                                             .viscous = 950_N / 1_mps},
                                .delay = 0.4_ms,
                                .limit = amplifier,
                                .dac_step = {},
                                .encoder_step = 250_nm};

struct outcome {
    std::array<double, 4> overshoot{}; ///< of each move [mm]
    double settled = 0;                ///< of the last: within 10 um after so many seconds
    bool limited = false;
};
/// Four steps of 20 mm to and fro, one second each.
template <class AntiWindup>
outcome to_and_fro(const AntiWindup& rule, quantity<si::electric_potential> limit = amplifier,
                   decltype(tuning.velocity_integral) integral = tuning.velocity_integral) {
    cascade<axis_with<AntiWindup>> axis{
        .box = {
            tuning,
            {.gain = tuning.velocity_gain, .integral_gain = integral, .limit = limit, .anti_windup = rule}}};
    machine motor{table, Ts};
    quantity<si::length> reading{};
    outcome found;
    for (std::size_t move = 0; move < 4; ++move) {
        const bool out = move % 2 == 0;
        const auto target = out ? 20_mm : 0_mm;
        for (int k = 0; k < 2000; ++k) {
            reading = motor(axis(target, reading));
            found.limited = found.limited || axis.limited();
            const double beyond = 1e3 * (out ? reading - target : target - reading).value();
            found.overshoot[move] = std::max(found.overshoot[move], beyond);
            if (move == 3 && std::abs(beyond) > 10e-3) found.settled = (k + 1) * Ts.value();
        }
    }
    CHECK_FALSE(axis.faulted());
    return found;
}
const auto infinite = std::numeric_limits<double>::infinity() * 1_V;
const back_calculation tracking{.tracking_time = 133_ms}; // gain over integral gain, [Astrom1995] ch. 3.5

/// Pushed with 725 N up to the target, braked with 725 N from there: what a loop with no wound-up integral
/// stays below. Friction is against the push and with the brake; viscous friction left out. 14.2 mm.
const double braking_at_the_target = 20 * (725.0 - 122) / (725 + 122);
} // namespace

TEST_CASE("saturation: with each rule the axis overshoots less than one that brakes only at the target") {
    for (const outcome& found :
         {to_and_fro(integral_clamp{}), to_and_fro(conditional_integration{}), to_and_fro(tracking)}) {
        CHECK(found.limited);
        for (const double mm : found.overshoot) CHECK(mm < 0.6 * braking_at_the_target);
    }
}
TEST_CASE("saturation: with each rule the overshoot does not grow from move to move, and the axis settles, to "
          "10 um") {
    for (const outcome& found :
         {to_and_fro(integral_clamp{}), to_and_fro(conditional_integration{}), to_and_fro(tracking)}) {
        for (const double mm : found.overshoot)
            CHECK(mm == doctest::Approx(found.overshoot[0]).epsilon(0.01)); // 0.1 mm
        CHECK(found.settled < 0.75);
    }
}
TEST_CASE("saturation: without a rule the axis is still pushed beyond the target, and every move is worse") {
    const outcome found = to_and_fro(integral_clamp{}, infinite);
    CHECK(found.overshoot[0] > 2 * braking_at_the_target);
    for (std::size_t move = 1; move < 4; ++move) CHECK(found.overshoot[move] > 1.2 * found.overshoot[move - 1]);
    CHECK(found.settled == doctest::Approx(1)); // that is, not at all
}
TEST_CASE(
    "saturation: two rules cost no more than a loop without an integral, the clamp up to its own charge") {
    // The clamp lets the integral stand at the whole limit when braking should begin: late by its unloading,
    // some ms.
    const double none = to_and_fro(integral_clamp{}, amplifier, {}).overshoot[0];
    const double conditional = to_and_fro(conditional_integration{}).overshoot[0];
    const double tracked = to_and_fro(tracking).overshoot[0],
                 clamped = to_and_fro(integral_clamp{}).overshoot[0];
    CHECK(std::abs(conditional - none) < 0.1); // mm
    CHECK(std::abs(tracked - none) < 0.1);
    CHECK(clamped > conditional);
    CHECK(clamped < conditional + 0.3);
}
TEST_CASE("saturation: a shorter tracking time unwinds the integral beyond zero: no overshoot, and slower by "
          "half at least") {
    const outcome quick = to_and_fro(back_calculation{20_ms}), even = to_and_fro(tracking);
    CHECK(quick.overshoot[3] < 0.01);
    CHECK(quick.settled > 1.5 * even.settled);
}
TEST_CASE("saturation: the loop learns of what feedforward took from the amplifier") {
    // Pressed against a stop that takes any force: 1 um behind for ten seconds, with 90 % of the amplifier fed
    // forward.
    const auto charge = [](auto rule) {
        auto p = tuning;
        p.coulomb_feedforward = 0.45_V;
        using rule_type = decltype(rule);
        cascade<axis_with<rule_type>> axis{.box = {p,
                                                   {.gain = tuning.velocity_gain,
                                                    .integral_gain = tuning.velocity_integral,
                                                    .limit = amplifier,
                                                    .anti_windup = rule}}};
        for (int k = 0; k < 20000; ++k) axis((1 + 1e-3 * k) * 1_um, 0_um);
        return axis.box.velocity_loop.now().integral.value();
    };
    CHECK(charge(conditional_integration{}) < 0.06); // what was left of 0.5 V
    CHECK(charge(tracking) < 0.06);
    CHECK(charge(integral_clamp{}) == 0.5); // knows its own limit only
}
