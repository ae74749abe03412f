// SPDX-License-Identifier: BSL-1.0
// Drives with loops of their own.
#include "families.hpp"

#include <quadrant/drive/position_loop.hpp>
#include <quadrant/drive/position_servo.hpp>
#include <quadrant/drive/set_point_line.hpp>

namespace block_pictures {
namespace {
constexpr double h = 1e-4; // step of the simulations [s]

/// A mass under Coulomb friction, moved by a force for one step.
struct body {
    double mass, coulomb, viscous = 0, x = 0, v = 0;

    void push(double force) {
        v += h * (force - viscous * v) / mass;
        const double stop = h * coulomb / mass;
        v -= std::clamp(v, -stop, stop);
        x += h * v;
    }
};

picture draw_set_point_line() {
    const double period = 4e-3;
    curve asked("set-points", dashed), held("held"), line("line"), cubic("cubic");
    for (auto [c, kind] : {std::pair{&held, interpolation::hold}, std::pair{&line, interpolation::linear},
                           std::pair{&cubic, interpolation::cubic}}) {
        const set_point_line<> follow(kind);
        auto s = set_point_line<>::state::at(0);
        for (int k = 0; k < 16; ++k) {
            const double r = std::sin(2 * std::numbers::pi * k / 15.0);
            follow.arrive(s, r);
            if (c == &held) asked.add(1e3 * period * k, r);
            for (int i = 0; i < 10; ++i) c->add(1e3 * period * (k + 0.1 * i), follow(s, 0.1 * i));
        }
    }
    return of("Set-points of a sine every 4 ms, and what a drive follows: held, as a line, as a cubic",
              {over("time [ms]", "position [mm]", {held, line, cubic, asked})});
}
picture draw_velocity_loop() {
    curve p("P"), pi("PI"), force_p("P"), force_pi("PI");
    for (const bool integral : {false, true}) {
        const velocity_loop<> loop({.gain = 5000, .integral = integral ? 150000.0 : 0.0}, h);
        auto s = velocity_loop<>::state::at(0);
        body m{100, 30};
        for (int k = 0; k < 2500; ++k) {
            const double force = loop(s, k < 200 ? 0 : 0.02, m.v);
            m.push(force);
            (integral ? pi : p).add(1e3 * k * h, 1e3 * m.v);
            (integral ? force_pi : force_p).add(1e3 * k * h, force);
        }
    }
    return of(
        "Velocity and force of a mass of 100 kg under a P and a PI loop that are asked for a step of velocity "
        "against 30 N of friction",
        {over("", "velocity [mm/s]", {p, pi}), over("time [ms]", "force [N]", {force_p, force_pi})});
}
picture draw_position_loop() {
    curve without("no feedforward"), with("velocity feedforward");
    for (const double share : {0.0, 1.0}) {
        const position_loop<> loop(
            {.gain = 40, .velocity_feedforward = share, .velocity = {.gain = 25000, .integral = 1.2e6}}, h);
        position_loop<>::state s;
        body m{100, 30};
        double r = 0;
        for (int k = 0; k < 6000; ++k) {
            const double speed = k > 500 && k < 4500 ? 0.05 : 0;
            m.push(loop(s, r, speed, m.x, m.v));
            r += h * speed;
            if (k % 5 == 0) (share > 0 ? with : without).add(1e3 * k * h, 1e3 * (r - m.x));
        }
    }
    return of("Following error of a mass of 100 kg on a ramp of 50 mm/s, without and with velocity feedforward",
              {over("time [ms]", "error [mm]", {without, with})});
}
picture draw_position_servo() {
    curve fast("no profile"), slow("4 rad/s"), duty_fast("no profile"), duty_slow("4 rad/s");
    for (const bool limited : {false, true}) {
        position_servo<>::parameters p{.gain = 4};
        if (limited) p.rate = 4;
        const position_servo<> servo(p, h);
        auto s = position_servo<>::state::at(0);
        body m{0.004, 0.03, 0.06};
        for (int k = 0; k < 6000; ++k) {
            const double duty = servo(s, k < 500 ? 0 : 0.8, m.x);
            m.push(duty * 12 * 0.1);
            if (k % 5 != 0) continue;
            (limited ? slow : fast).add(1e3 * k * h, m.x);
            (limited ? duty_slow : duty_fast).add(1e3 * k * h, duty);
        }
    }
    return of("Position and duty of a servo that is asked for a step, with and without a profile velocity",
              {over("", "position [rad]", {fast, slow}), over("time [ms]", "duty", {duty_fast, duty_slow})});
}
} // namespace

family drives() {
    return {{"set_point_line", draw_set_point_line},
            {"velocity_loop", draw_velocity_loop},
            {"position_loop", draw_position_loop},
            {"position_servo", draw_position_servo}};
}
} // namespace block_pictures
