// SPDX-License-Identifier: BSL-1.0
// Control laws of a feed drive on one axis (trial_axis.hpp): steps, moves, a force that pushes.
#include "families.hpp"
#include "trial_axis.hpp"

#include <quadrant/control/acceleration_feedback.hpp>
#include <quadrant/control/linuxcnc_pid.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/predictive.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/control/state_feedback.hpp>

namespace block_pictures {
namespace {
const auto& G = trial_model;
const duration T = trial_period;
/// Held at rest, and pushed.
const run push{0.25, [](double) { return at_rest(0); }, 500, 0.02};

picture draw_proportional_integral() {
    curve error("error"), clamped("integral_clamp"), conditional("conditional_integration"),
        back("back_calculation, 20 ms"), limit("limit", dashed);
    const auto loop = [&]<class Rule>(Rule rule, curve& out) {
        proportional_integral<s::velocity, s::voltage, Rule> b{{60_V / 1_mps, 450_V / 1_m, 10_V, rule}, 500_us};
        for (int k = 0; k < 1200; ++k) {
            const auto e = k < 100 ? 0_mps : k < 500 ? 100_mmps : -20_mmps;
            const auto u = b(e);
            b.applied(u > 10_V ? 10_V : u < -10_V ? -10_V : u);
            out.hold(0.5 * k, 0.5, u.value());
        }
    };
    loop(integral_clamp{}, clamped), loop(conditional_integration{}, conditional),
        loop(back_calculation{20_ms}, back);
    for (const auto& [t, e] :
         {std::pair{0.0, 0.0}, {50.0, 0.0}, {50.0, 100.0}, {250.0, 100.0}, {250.0, -20.0}, {600.0, -20.0}})
        error.add(t, e);
    limit.add(0, 10), limit.add(600, 10);
    return of(
        "A velocity error of 100 mm/s that turns to -20 mm/s, and the PI with its three rules against windup",
        {over("", "error [mm/s]", {error}),
         over("time [ms]", "output [V]", {clamped, conditional, back, limit})});
}
picture draw_pid() {
    pid<>::parameters p{
        .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};
    auto soft = p;
    soft.position_weight = 0;
    const record a = ran("position_weight 1", trial_axis<pid<>>(p), step_and_push),
                 b = ran("position_weight 0", trial_axis<pid<>>(soft), step_and_push);
    return of("A PID after a step of 50 um, and a force of 500 N from 200 ms on, with position weight 1 and 0",
              {over("", "position [um]", {a.place, b.place, asked(step_and_push)}),
               over("time [ms]", "command [V]", {a.command, b.command})});
}
picture draw_linuxcnc_pid() {
    linuxcnc_pid<>::parameters p{.pgain = 70e3 * 1_V / 1_m,
                                 .igain = 800e3 * 1_V / (1_m * 1_s),
                                 .dgain = 300_V / 1_mps,
                                 .ff1 = 0.04_V / 1_mmps,
                                 .ff2 = 1.6_V / 1_mps2,
                                 .error_previous_target = false};
    auto previous = p;
    previous.error_previous_target = true;
    const record a = ran("error-previous-target 0", trial_axis<linuxcnc_pid<>>(p), move_and_push),
                 b = ran("error-previous-target 1", trial_axis<linuxcnc_pid<>>(previous), move_and_push);
    return of("LinuxCNC's pid along a move of 20 mm, and a force of 500 N from 400 ms on, with both errors",
              {over("", "position [um]", {a.place, b.place, asked(move_and_push)}),
               over("time [ms]", "error [um]", {a.error, b.error})});
}
picture draw_p_pi() {
    auto p = place_p_pi(G, {.natural = 20_Hz, .position = 0.25}, T);
    p_pi<>::parameters late = p;
    late.velocity_weight = 0, late.acceleration_gain = {};
    const record a = ran("with feedforward", trial_axis<p_pi<>>(p), move_and_push),
                 b = ran("velocity_weight 0", trial_axis<p_pi<>>(late), move_and_push);
    return of(
        "A P-PI law along a move of 20 mm, and a force of 500 N from 400 ms on, with feedforward and without",
        {over("", "position [um]", {a.place, b.place, asked(move_and_push)}),
         over("time [ms]", "error [um]", {a.error, b.error})});
}
picture draw_sliding_mode() {
    const sliding_mode<>::parameters p{
        .plant = G, .sliding = 200.0 / 1_s, .gain = 300_V / 1_mps, .adaptation = 30e3 * 1_V / 1_m};
    auto wrong = p;
    wrong.plant.gain = 1.3 * p.plant.gain;
    const record a = ran("plant as it is", trial_axis<sliding_mode<>>(p), move_and_push),
                 b = ran("plant believed 30 % lighter", trial_axis<sliding_mode<>>(wrong), move_and_push);
    return of(
        "Error of a sliding mode law along a move of 20 mm, and a force of 500 N from 400 ms on",
        {over("", "error [um]", {a.error, b.error}), over("time [ms]", "command [V]", {a.command, b.command})});
}
picture draw_acceleration_feedback() {
    using law = acceleration_feedback<pid<>>;
    const pid<>::parameters of_pid{
        .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};
    const auto with = [&](const char* name, double heavier) {
        auto gains = of_pid; // in proportion to what the axis now weighs
        gains.gain *= 1 + heavier, gains.integral_gain *= 1 + heavier, gains.derivative_gain *= 1 + heavier;
        return ran(name, trial_axis<law>({.law = gains, .gain = heavier / G.gain, .corner = 150_Hz}), push);
    };
    const record a = with("PID alone", 0), b = with("gain B = 0.5", 0.5), c = with("gain B = 1", 1);
    return of("An axis at rest under a PID, pushed by 500 N from 20 ms on, with and without its accelerometer",
              {over("", "position [um]", {a.place, b.place, c.place}),
               over("time [ms]", "command [V]", {a.command, b.command, c.command})});
}
picture draw_predictive() {
    const predictive<>::parameters p{
        .plant = G, .weights = bryson_weights<s::voltage>(1_um, 2_mmps, 0.05_V), .horizon = 10};
    const record a = ran("position", trial_axis<predictive<>>(p), step_and_push);
    curve due("reference, as it is due", dashed);
    for (const auto& [t, x] : {std::pair{0.0, 0.0}, {30.0, 0.0}, {30.0, 50.0}, {400.0, 50.0}}) due.add(t, x);
    return of(
        "A predictive law with a horizon of 10 ms at a step of 50 um, and a force of 500 N from 200 ms on",
        {over("", "position [um]", {a.place, due}), over("time [ms]", "command [V]", {a.command})});
}
picture draw_state_feedback() {
    auto p = place_state_feedback(G, {.natural = 25_Hz, .damping = 0.7, .encoder_noise = 0.35_um}, 10_V, T);
    trial_axis<state_feedback<>> axis(p);
    curve error("position error"), estimate("estimated disturbance"),
        truth("force over force constant", dashed);
    for (int k = 0; k < 400; ++k) {
        const double force = k < 100 ? 0 : k < 250 ? 500 : -250;
        axis.step(at_rest(0), force * 1_N);
        error.add(k, 1e6 * axis.wire().position_error.value());
        estimate.add(k, axis.law().now().disturbance.value());
        truth.hold(k, 1, force / (3000 * 0.6336));
    }
    return of("State feedback that holds an axis against a force of 500 N, then of -250 N: error and estimated "
              "disturbance",
              {over("", "error [um]", {error}), over("time [ms]", "disturbance [V]", {estimate, truth})});
}
picture draw_axis_law() {
    const pid<>::parameters of_pid{
        .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};
    const sliding_mode<>::parameters of_sliding{
        .plant = G, .sliding = 200.0 / 1_s, .gain = 300_V / 1_mps, .adaptation = 30e3 * 1_V / 1_m};
    return of(
        "An axis at rest, pushed by 500 N from 20 ms on, under six laws",
        {over(
            "time [ms]", "position [um]",
            {ran("pid", trial_axis<pid<>>(of_pid), push).place,
             ran("sliding_mode", trial_axis<sliding_mode<>>(of_sliding), push).place,
             ran("p_pi", trial_axis<p_pi<>>(place_p_pi(G, {.natural = 20_Hz, .position = 0.25}, T)), push)
                 .place,
             ran("state_feedback",
                 trial_axis<state_feedback<>>(place_state_feedback(
                     G, {.natural = 25_Hz, .damping = 0.7, .encoder_noise = 0.35_um}, 10_V, T)),
                 push)
                 .place,
             ran("rst, pole placement",
                 trial_axis<pole_placement<>>(place_rst(G, {.natural = 20_Hz, .observer = 30_Hz}, T)), push)
                 .place,
             ran("predictive",
                 trial_axis<predictive<>>(
                     {.plant = G, .weights = bryson_weights<s::voltage>(1_um, 2_mmps, 0.05_V), .horizon = 10}),
                 push)
                 .place})});
}
} // namespace

family laws() {
    return {{"proportional_integral", draw_proportional_integral},
            {"pid", draw_pid},
            {"linuxcnc_pid", draw_linuxcnc_pid},
            {"p_pi", draw_p_pi},
            {"sliding_mode", draw_sliding_mode},
            {"acceleration_feedback", draw_acceleration_feedback},
            {"predictive", draw_predictive},
            {"state_feedback", draw_state_feedback},
            {"axis_law", draw_axis_law}};
}
} // namespace block_pictures
