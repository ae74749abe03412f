// SPDX-License-Identifier: BSL-1.0
// Observers on the x and y axis of the milling table: what they say beside what is so.
#include "families.hpp"
#include "quadrant_reproduce/thesis.hpp"

#include <quadrant/block/absent.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>
#include <quadrant/observer/kalman.hpp>
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
} // namespace

family observers() {
    return {
        {"disturbance_observer", draw_disturbance_observer},
        {"harmonic_force_observer", draw_harmonic_force_observer},
        {"kalman", draw_kalman},
        {"reduced_order_observer", draw_reduced_order_observer},
    };
}
} // namespace block_pictures
