// SPDX-License-Identifier: BSL-1.0
// Long: a function for each picture.
// Machines and what happens to them: motors, play, cogging, modes, cutting.
#include "families.hpp"

#include <quadrant/friction/slip_contact.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/backlash.hpp>
#include <quadrant/plant/ball_screw_drive.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/force_ripple.hpp>
#include <quadrant/plant/linear_motor.hpp>
#include <quadrant/plant/servo_axis.hpp>
#include <quadrant/plant/three_phase_drive.hpp>
#include <quadrant/process/cutting_force.hpp>
#include <quadrant/process/milling_force.hpp>
#include <quadrant/process/milling_harmonics.hpp>
#include <quadrant/sensor/cyclic_error.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

picture draw_backlash() {
    backlash<> b{{3_um}, T};
    curve in("drive", dashed), out("driven side"), loop("");
    for (int k = 0; k <= 500; ++k) {
        const auto x = 10_um * std::sin(2 * pi * k / 250.0);
        const auto y = b(x);
        in.add(0.5 * k, 1e6 * x.value());
        out.add(0.5 * k, 1e6 * y.value());
        loop.add(1e6 * x.value(), 1e6 * y.value());
    }
    return of("A sine of 10 um through a play of 3 um, in time and driven over driving position",
              {over("time [ms]", "position [um]", {out, in}), over("drive [um]", "driven [um]", {loop})});
}
picture draw_cogging_force() {
    cogging_force<3> b{{30_mm, {8_N, -3_N, 1_N}, {0.4, -2.0, 1.0}}, T};
    curve force("");
    for (int i = 0; i <= 600; ++i) force.add(0.15 * i, b(0.15 * i * 1_mm).value());
    return of("Cogging force over position with three harmonics of 30 mm",
              {over("position [mm]", "force [N]", {force})});
}
picture draw_force_ripple() {
    force_ripple<s::force> b{{30_mm, {0.05}, {pi / 2}}, T};
    curve large("100 N asked"), small("50 N asked");
    for (int i = 0; i <= 450; ++i) {
        large.add(0.2 * i, b(100_N, 0.2 * i * 1_mm).value());
        small.add(0.2 * i, b(50_N, 0.2 * i * 1_mm).value());
    }
    return of("Force over position for 100 N and 50 N asked, with 5 % of ripple over 30 mm",
              {over("position [mm]", "force [N]", {large, small})});
}
picture draw_cyclic_error() {
    cyclic_error<> b{{4_um, {0.1_um}, {0}}, T};
    curve read("reading - position");
    for (int i = 0; i <= 400; ++i) read.add(0.03 * i, 1e3 * (1e6 * b(0.03 * i * 1_um).value() - 0.03 * i));
    return of("What a cyclic error of 0.1 um over 4 um adds to the position",
              {over("position [um]", "added [nm]", {read})});
}
picture draw_flexible_modes() {
    const auto compliance = [](std::string name, double share) { // of rigid axis and mode
        curve c(std::move(name));
        const flexible_modes<1> b{{340_kg, {{{47_Hz, 0.02, share}}}}, 125_us};
        for (const double f : frequencies(10, 200, 400)) {
            const std::complex<double> p(0, 2 * pi * f), rigid = 1.0 / (340.0 * p * p);
            c.add(f, 1e9 * std::abs(rigid + std::complex<double>(b.continuous_response(hertz(f)))));
        }
        return c;
    };
    line rigid = compliance("rigid axis", 0);
    rigid.drawn = dashed;
    panel p = gains_alone({compliance("share 0.2", 0.2), compliance("share -0.3", -0.3), rigid},
                          "compliance [um/kN]");
    p.log_y = true;
    return of("Compliance over frequency of an axis of 340 kg with a mode at 47 Hz, share 0.2 and share -0.3",
              {p});
}
/// Four springs with the attraction of the thesis' table.
template <class Parameters> void give_way(Parameters& friction) {
    friction.weights = {0.4, 0.3, 0.2, 0.1};
    const std::array<double, 4> newtons_per_um{12, 5, 2, 0.6};
    for (std::size_t i = 0; i < 4; ++i) friction.stiffness[i] = newtons_per_um[i] * 1_N / 1_um;
    friction.attraction = 2000_N / 1_s;
}
picture draw_servo_axis() {
    servo_axis<>::parameters p;
    p.mass = 340;
    p.force_constant = 1450;
    p.play = 30e-6;
    p.friction.level = 122_N;
    p.friction.excess = 55_N;
    p.friction.stribeck_velocity = 1_mps / 450.0;
    p.friction.viscous = 950_N / 1_mps;
    give_way(p.friction);
    const double h = 1e-4;
    const servo_axis<> plant(p, h);
    auto s = servo_axis<>::state::at(0);
    curve motor("motor", dashed), load("load"), friction("springs of the friction");
    for (int k = 0; k < 10000; ++k) {
        const double x = 100e-6 * std::sin(2 * pi * 2 * k * h),
                     v = 100e-6 * 4 * pi * std::cos(2 * pi * 2 * k * h);
        plant.advance(s, 40 * (x - s.x) * 100 + 30 * (v - s.v), {});
        if (k % 20 != 0) continue;
        motor.add(1e3 * k * h, 1e6 * s.x);
        load.add(1e3 * k * h, 1e6 * plant.reading(s));
        double sum = 0;
        for (const double f : s.friction.force) sum += f;
        friction.add(1e3 * k * h, sum);
    }
    return of("Position, and friction, of an axis with presliding friction and play that is pushed to and fro",
              {over("", "position [um]", {load, motor}), over("time [ms]", "force [N]", {friction})});
}
picture draw_slip_contact() {
    slip_contact<4>::parameters p;
    p.level = 122_N;
    give_way(p);
    curve large("60 um"), small("15 um");
    for (curve* c : {&large, &small}) {
        const double h = 1e-3, amplitude = c == &large ? 60e-6 : 15e-6, heavy = 1e9;
        const slip_contact<4> guide(p, heavy, h);
        slip_contact<4>::state s;
        for (int k = 0; k < 2500; ++k) { // a heavy mass: it moves as it is told
            const double v = 2 * pi * amplitude * std::cos(2 * pi * k * h);
            guide(s, heavy * v, v);
            double sum = 0;
            for (const double f : s.force) sum += f;
            if (k % 5 == 0) c->add(1e6 * amplitude * std::sin(2 * pi * k * h), sum);
        }
    }
    return of("Friction over displacement of a guide that is moved to and fro by 60 um and by 15 um",
              {over("displacement [um]", "force [N]", {large, small})});
}
picture draw_linear_motor() {
    using machine = linear_motor<stribeck<>>;
    machine m{{.mass = 340_kg,
               .force_constant = 1450_N / 1_V,
               .friction = {122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps},
               .delay = 0.4_ms,
               .encoder_step = 250_nm},
              T};
    curve u("command"), v("velocity"), x("position");
    for (int k = 0; k < 400; ++k) {
        const double t = 0.5 * k, volts = t < 60 ? 0.25 * t / 60 : t < 110 ? 0.25 : 0;
        u.hold(t, 0.5, volts);
        v.add(t, 1e3 * m.now().v.value());
        x.add(t, 1e3 * m.now().x.value());
        m(volts * 1_V);
    }
    return of("A linear motor on Stribeck friction: command that rises to 0.25 V and stops, velocity, position",
              {over("", "command [V]", {u}), over("", "velocity [mm/s]", {v}),
               over("time [ms]", "position [mm]", {x})});
}
picture draw_ball_screw_drive() {
    using screw = ball_screw_drive<>;
    screw m{{.inertia = 0.0077736_kgm2,
             .viscous = 0.019811_Nm / 1_radps,
             .torque_constant = 0.4769_Nm / 1_A,
             .pitch = 10_mm,
             .friction = {{2.6256_Nm, 2.1529_Nm, 3.88_radps, 4.20_radps},
                          {1.8672_Nm, 1.4730_Nm, 3.51_radps, 3.52_radps},
                          {}}},
            1_ms};
    curve i("current"), v("velocity"), forward("breakaway forward", dashed),
        backward("breakaway backward", dashed);
    for (int k = 0; k < 1000; ++k) {
        const double t = k, amps = 6.5 * std::sin(2 * pi * t / 500);
        i.add(t, amps);
        v.add(t, 1e3 * m.now().v.value());
        m(amps * 1_A);
    }
    for (const double t : {0.0, 1000.0}) forward.add(t, 2.6256 / 0.4769), backward.add(t, -1.8672 / 0.4769);
    return of("The x axis of a virtual CNC under a sine of current, with its breakaway currents",
              {over("", "current [A]", {i, forward, backward}), over("time [ms]", "velocity [mm/s]", {v})});
}
picture draw_three_phase_drive() {
    const three_phase_drive<>::parameters good{.force_constant = 40_N / 1_A,
                                               .resistance = 2_V / 1_A,
                                               .time_constant = 4_ms,
                                               .pole_pair = 30_mm,
                                               .bus = 150_V,
                                               .current_limit = 8_A,
                                               .bandwidth = 300_Hz,
                                               .steps = 20};
    auto bad = good;
    bad.gain_error = 0.03;
    constexpr double dt = 1e-4;
    three_phase_drive<> a{good, 100_us}, step{good, 100_us}, off{bad, 100_us};
    curve demand("asked", dashed), force("force"), ripple("sensor of phase a 3 % off"),
        even("all sensors right");
    for (int k = 0; k < 60; ++k) {
        const double t = 1e3 * dt * k;
        const auto i = k < 5 ? 0_A : 3_A;
        demand.hold(t, 0.1, 40 * i.value());
        force.add(t + 0.1, step(i).value());
    }
    for (int k = -1500; k < 3000; ++k) { // 0.2 m/s
        const double x = 0.2 * dt * k;
        const double f = a(3_A, x * 1_m, 0.2 * 1_mps).value(), g = off(3_A, x * 1_m, 0.2 * 1_mps).value();
        if (k >= 0) even.add(1e3 * x, f), ripple.add(1e3 * x, g);
    }
    return of(
        "Force of a three-phase drive after a step of 3 A, and along the travel with a current sensor that is "
        "off",
        {over("time [ms]", "force [N]", {force, demand}), over("position [mm]", "force [N]", {ripple, even})});
}
picture draw_cutting_force() {
    namespace measured = milling_harmonics;
    cutting_force<15> b{{.fundamental = measured::fundamental,
                         .scale = measured::scale,
                         .harmonics = measured::x,
                         .entry = 20_ms},
                        T};
    curve force("force");
    b.settle(0_s, false);
    for (int k = 0; k < 500; ++k) {
        if (k == 80) b.engage(true);
        if (k == 400) b.engage(false);
        force.add(0.5 * k, b().value());
    }
    return of(
        "Cutting force of 15 measured harmonics of 23.294 Hz: the tool enters at 40 ms and leaves at 200 ms",
        {over("time [ms]", "force [N]", {force})});
}
picture draw_milling_force() {
    milling_force<4> b{{.spindle = 12.5_Hz,
                        .diameter = 16_mm,
                        .feed_per_tooth = 0.1_mm,
                        .axial_depth = 4_mm,
                        .radial_depth = 1_mm,
                        .tangential = 8e8 * 1_N / (1_m * 1_m),
                        .radial = 1.7e8 * 1_N / (1_m * 1_m),
                        .runout = 10_um},
                       100_us};
    curve x("x, along the feed"), y("y, across it");
    for (int k = 0; k < 1600; ++k) {
        const auto f = b();
        x.add(0.1 * k, f.x.value());
        y.add(0.1 * k, f.y.value());
    }
    return of("Force of a four-edged cutter of 16 mm over two turns, 1 mm wide, with 10 um of runout",
              {over("time [ms]", "force on the table [N]", {x, y})});
}
} // namespace

family plants() {
    return {{"backlash", draw_backlash},
            {"cogging_force", draw_cogging_force},
            {"force_ripple", draw_force_ripple},
            {"cyclic_error", draw_cyclic_error},
            {"flexible_modes", draw_flexible_modes},
            {"linear_motor", draw_linear_motor},
            {"servo_axis", draw_servo_axis},
            {"slip_contact", draw_slip_contact},
            {"ball_screw_drive", draw_ball_screw_drive},
            {"three_phase_drive", draw_three_phase_drive},
            {"cutting_force", draw_cutting_force},
            {"milling_force", draw_milling_force}};
}
} // namespace block_pictures
