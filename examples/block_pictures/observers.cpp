// SPDX-License-Identifier: BSL-1.0
// Observers on the x and y axis of the milling table: what they say beside what is so.
#include "families.hpp"
#include "quadrant_reproduce/thesis.hpp"

#include <quadrant/analysis/ferraris_calibration.hpp>
#include <quadrant/compose/absent.hpp>
#include <quadrant/compose/milling_axis_boxes.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>
#include <quadrant/observer/kalman.hpp>
#include <quadrant/observer/lugre_observer.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>
#include <quadrant/sensor/white_noise.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;
using motor = linear_motor<>;

/// An axis of the thesis without friction but the viscous one.
motor linear(const thesis::axis& a, quantity<si::length> encoder = {}) {
    const auto mass = a.kf / a.B;
    return motor{{.mass = mass,
                  .force_constant = a.kf,
                  .friction = {.coulomb = 0_N, .viscous = a.A_gms * mass},
                  .encoder_step = encoder},
                 T};
}
double volts(const thesis::axis& a, double force) { return force / a.kf.value(); }

/// Held at rest against a force over time [s].
template <class Disturbance> struct held_axis {
    using boxes = milling_axis_boxes<absent<s::velocity, s::voltage>, Disturbance>;
    milling_axis<boxes> control;
    motor plant;

    held_axis(const thesis::axis& a, const typename boxes::parameters& p)
        : control{.box = {p, T}}, plant(linear(a)) {}
    quantity<si::length> place() const { return plant.now().x; }
};

picture draw_disturbance_observer() {
    const auto& a = thesis::x;
    using with = disturbance_observer<s::voltage>;
    using without = absent<s::position, s::voltage>;
    auto p = thesis::controller_of<held_axis<with>::boxes>(a);
    p.disturbance = {a.corner, axis_model<s::voltage>{a.B, a.A_gms}};
    held_axis<with> observed(a, p);
    held_axis<without> bare(a, thesis::controller_of<held_axis<without>::boxes>(a));
    curve on("with observer"), off("without"), estimate("observed"), truth("force over force constant", dashed);
    auto y = 0_m, z = 0_m;
    for (int k = 0; k < 500; ++k) {
        const double t = 0.5 * k, force = t < 20    ? 0
                                          : t < 120 ? 500
                                                    : 500 + 300 * std::sin(2 * pi * 8e-3 * (t - 120));
        on.add(t, 1e6 * y.value()), off.add(t, 1e6 * z.value());
        y = observed.plant(observed.control({}, y), force * 1_N);
        z = bare.plant(bare.control({}, z), force * 1_N);
        estimate.add(t, observed.control.wire.disturbance.value());
        truth.add(t, volts(a, force));
    }
    return of("An axis at rest under a force of 500 N and a sine of 8 Hz on top, with and without disturbance "
              "observer",
              {over("", "position [um]", {on, off}), over("time [ms]", "disturbance [V]", {estimate, truth})});
}
picture draw_harmonic_force_observer() {
    const auto& a = thesis::y;
    using observer = harmonic_force_observer<s::voltage, 2>;
    observer tones{{{a.B, a.A_gms}, {46_Hz, 69_Hz}, placed_poles<2>::equal(200.0 / 1_s)}, T};
    using boxes = milling_axis_boxes<>;
    milling_axis<boxes> loop{.box = {thesis::controller_of<boxes>(a), T}};
    motor plant = linear(a);
    curve place("position"), estimate("observed"), truth("force over force constant", dashed);
    auto y = 0_m;
    auto command = 0_V;
    for (int k = 0; k < 600; ++k) {
        const double t = 5e-4 * k, force = 100 * std::sin(2 * pi * 46 * t) + 60 * std::cos(2 * pi * 69 * t);
        const auto d = tones(y, command), wanted = loop({}, y);
        command = t < 0.15 ? wanted : wanted - d; // fed back from 150 ms on
        place.add(1e3 * t, 1e6 * y.value());
        if (t < 0.1) estimate.add(1e3 * t, d.value()), truth.add(1e3 * t, volts(a, force));
        y = plant(command, force * 1_N);
    }
    return of("Forces of 46 and 69 Hz on an axis at rest: as observed in the first 100 ms, and what they do "
              "before and after they are fed back at 150 ms",
              {over("time [ms]", "force [V]", {estimate, truth}), over("time [ms]", "position [um]", {place})});
}

/// 10 mm there and back in half a second, as the encoder of 0.25 um sees it.
struct moving_axis {
    milling_axis<milling_axis_boxes<>> control;
    motor plant;
    quantity<si::length> reading{};
    quantity<si::electric_potential> command{};

    moving_axis()
        : control{.box = {thesis::controller_of<milling_axis_boxes<>>(thesis::x), T}},
          plant(linear(thesis::x, 250_nm)) {}
    void step(double t, double force) {
        const double w = 4 * pi, r = 2e-3;
        command = control({r * (1 - std::cos(w * t)) * 1_m, r * w * std::sin(w * t) * 1_mps,
                           r * w * w * std::cos(w * t) * 1_mps2},
                          reading);
        reading = plant(command, force * 1_N);
    }
};
double pushed(double t) { return t > 0.25 && t < 0.4 ? 100 : 0; }

picture draw_kalman() {
    const auto& a = thesis::x;
    kalman<s::voltage> filter{{.mass = a.kf / a.B,
                               .force_constant = a.kf,
                               .viscous = a.A_gms * (a.kf / a.B),
                               .encoder_noise = 0.07_um,
                               .drift = 200_N},
                              T};
    filtered_derivative<s::position, s::velocity> plain{{150_Hz}, T};
    moving_axis axis;
    curve filtered("kalman"), derived("filtered_derivative, 150 Hz"), force("observed"), truth("force", dashed);
    for (int k = 0; k < 1000; ++k) {
        const double t = 5e-4 * k, d = pushed(t);
        const double v = axis.plant.now().v.value(), of_filter = filter(axis.reading, axis.command).value(),
                     of_plain = plain(axis.reading).value();
        filtered.add(1e3 * t, 1e3 * (of_filter - v));
        derived.add(1e3 * t, 1e3 * (of_plain - v));
        force.add(1e3 * t, filter.disturbance().value());
        truth.add(1e3 * t, d);
        axis.step(t, d);
    }
    return of("A moving axis that 100 N push between 250 and 400 ms: error of the velocity by a Kalman filter "
              "and by a filtered derivative, and the observed force",
              {over("", "velocity error [mm/s]", {filtered, derived}),
               over("time [ms]", "force [N]", {force, truth})});
}
picture draw_reduced_order_observer() {
    const auto& a = thesis::x;
    reduced_order_observer<s::voltage> speed{
        {.mass = a.kf / a.B, .force_constant = a.kf, .viscous = a.A_gms * (a.kf / a.B), .corner = 20_Hz}, T};
    filtered_derivative<s::position, s::velocity> plain{{150_Hz}, T};
    white_noise<s::acceleration> noise{{5e-3 * 1_mps2, 3}, T};
    moving_axis axis;
    curve observed("reduced_order_observer"), derived("filtered_derivative, 150 Hz"), force("observed"),
        truth("force", dashed);
    double was = 0, push = 0;
    for (int k = 0; k < 1000; ++k) {
        const double t = 5e-4 * k, v = axis.plant.now().v.value();
        const auto felt = (v - was) / T.value() * 1_mps2 + noise(); // the sensor, over the last period
        was = v;
        const double of_observer = speed(axis.reading, felt, axis.command).value(),
                     of_plain = plain(axis.reading).value();
        observed.add(1e3 * t, 1e3 * (of_observer - v));
        derived.add(1e3 * t, 1e3 * (of_plain - v));
        force.add(1e3 * t, speed.disturbance().value());
        truth.add(1e3 * t, push);
        axis.step(t, push = pushed(t));
    }
    return of("A moving axis that 100 N push between 250 and 400 ms: error of the velocity from position and "
              "acceleration and by a filtered derivative, and the observed force",
              {over("", "velocity error [mm/s]", {observed, derived}),
               over("time [ms]", "force [N]", {force, truth})});
}
picture draw_ferraris_force_estimator() {
    const auto& a = thesis::y;
    const auto mass = a.kf / a.B;
    const auto with = [&](const char* name, quantity<si::frequency> corner) {
        ferraris_force_estimator<s::voltage> b{{.mass = mass, .force_constant = a.kf, .corner = corner}, T};
        motor plant{{.mass = mass, .force_constant = a.kf}, T}; // free: no friction to tell
        curve c(name);
        double was = 0;
        for (int k = 0; k < 160; ++k) {
            const double t = 0.5 * k, v = plant.now().v.value();
            c.add(t, b((v - was) / T.value() * 1_mps2, 0_V).value());
            was = v;
            plant(0_V, (t < 10 ? 0 : t < 40 ? 100 : 100 + 60 * std::sin(2 * pi * 50e-3 * (t - 40))) * 1_N);
        }
        return c;
    };
    curve truth("force", dashed);
    for (int k = 0; k < 160; ++k) {
        const double t = 0.5 * k;
        truth.hold(t, 0.5, t < 10 ? 0 : t < 40 ? 100 : 100 + 60 * std::sin(2 * pi * 50e-3 * (t - 40)));
    }
    return of(
        "A step of 100 N and a sine of 50 Hz on a free mass, and the force from its acceleration with two "
        "corners",
        {over("time [ms]", "force [N]", {with("corner 90 Hz", 90_Hz), with("corner 300 Hz", 300_Hz), truth})});
}
picture draw_ferraris_calibration() {
    constexpr double gain_of_sensor = 32.98, offset = -8580e-6; // [Jamaludin2008] Appendix B
    std::vector<quantity<si::length>> positions;
    std::vector<quantity<si::electric_potential>> sensor;
    white_noise<s::voltage> noise{{1e-4 * 1_V, 5}, T};
    quantizer<s::position> encoder{{0.25_um}, T};
    curve raw("sensor"), truth("axis", dashed), calibrated("gain times sensor plus offset");
    std::vector<double> acceleration;
    for (int k = 0; k < 8000; ++k) {
        const double t = 5e-4 * k;
        const auto wave = [&](double size, double f) { return size * std::sin(2 * pi * f * t); };
        acceleration.push_back(-std::pow(pi, 2) * wave(5e-3, 0.5) - std::pow(8 * pi, 2) * wave(1e-3, 4));
        positions.push_back(encoder((wave(5e-3, 0.5) + wave(1e-3, 4)) * 1_m));
        sensor.push_back((acceleration.back() - offset) / gain_of_sensor * 1_V + noise());
    }
    const auto found = analysis::calibrate_ferraris(positions, sensor, T);
    for (std::size_t k = 0; k < 2000; ++k) {
        const double t = 0.5 * double(k);
        raw.add(t, 1e3 * sensor[k].value());
        truth.add(t, acceleration[k]);
        calibrated.add(t, (found.gain * sensor[k] + found.offset).value());
    }
    return of("Voltage of an acceleration sensor along a motion of 0.5 and 4 Hz, and the acceleration that its "
              "calibration makes of it",
              {over("", "sensor [mV]", {raw}), over("time [ms]", "acceleration [m/s^2]", {calibrated, truth})});
}
picture draw_lugre_observer() {
    const lugre<>::parameters believed{{8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1.5e6 * 1_N / 1_m};
    lugre_observer<s::force> learns{{believed, 20.0 / 1_s}, T}, model{{believed, 0.0 / 1_s}, T};
    curve v("reference velocity"), with("correction 20 /s"), without("correction 0: the model alone"),
        e("behind");
    for (int k = 0; k < 400;
         ++k) { // rests 10 um behind from 50 ms on, moves on at 120 ms, and is there from 150 ms on
        const double t = 0.5 * k, speed = t < 120 ? 0 : 2e-3, behind = t < 50 || t > 150 ? 0 : 10e-6;
        v.add(t, 1e3 * speed), e.add(t, 1e6 * behind);
        with.add(t, learns(speed * 1_mps, behind * 1_m).value());
        without.add(t, model(speed * 1_mps, behind * 1_m).value());
    }
    return of("Friction by a LuGre observer on an axis that stays 10 um behind from 50 to 150 ms and is sent "
              "on at 120 ms",
              {over("", "behind [um]", {e}), over("", "speed [mm/s]", {v}),
               over("time [ms]", "force [N]", {with, without})});
}
} // namespace

family observers() {
    return {{"disturbance_observer", draw_disturbance_observer},
            {"harmonic_force_observer", draw_harmonic_force_observer},
            {"kalman", draw_kalman},
            {"reduced_order_observer", draw_reduced_order_observer},
            {"ferraris_force_estimator", draw_ferraris_force_estimator},
            {"ferraris_calibration", draw_ferraris_calibration},
            {"lugre_observer", draw_lugre_observer}};
}
} // namespace block_pictures
