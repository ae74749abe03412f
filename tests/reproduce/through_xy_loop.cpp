// SPDX-License-Identifier: BSL-1.0
// The experiments of one axis, run again as one axis of the whole two-axis loop: the same, to the bit.
#include "quadrant_reproduce/milling_table.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr std::size_t samples = 6000; // more than a cycle and a half of the sinusoid of 30 mm at 100 mm/s

axis_motion<> sinusoid(std::size_t k) {
    const double amplitude = 0.03, w = 0.1 / amplitude, t = static_cast<double>(k) * thesis::period.value();
    return {amplitude * (1 - std::cos(w * t)) * 1_m, amplitude * w * std::sin(w * t) * 1_mps,
            amplitude * w * w * std::cos(w * t) * 1_mps2};
}

/// Positions of one axis under a milling_axis, from its own loop and motor.
template <class Compensation, class Observer>
std::vector<double> alone(const thesis::axis& a, const thesis::reading& how) {
    thesis::friction_axis<Compensation, Observer> axis(a, how);
    std::vector<double> out;
    for (std::size_t k = 0; k < samples; ++k) {
        out.push_back(axis.position());
        axis.step(sinusoid(k), sinusoid(k));
    }
    return out;
}
/// The same as x, or as y, of an xy_loop whose other axis moves, too.
template <class Compensation, class Observer>
std::vector<double> in_the_loop(const thesis::axis& a, bool of_y, const thesis::reading& how) {
    using configuration = thesis::configuration<Compensation, Observer, thesis::no_memory>;
    using boxes = typename configuration::boxes;
    using motor = linear_motor<maxwell_slip<4>>;
    using slide = table_axis_boxes<motor>;
    using loop_type = xy_loop<boxes, boxes, xy_table<slide, slide>, thesis::told_force>;
    const auto machine = [&](const thesis::axis& of) {
        const quantity<si::mass> mass = of.kf / of.B;
        typename motor::parameters p{
            .mass = mass,
            .force_constant = of.kf,
            .friction = thesis::gms<signal::force>(of, gain_of<signal::force, signal::force>(1.0)),
            .delay = how.delay,
            .substeps = how.substeps};
        p.friction.curve.viscous += of.A_gms * mass;
        return typename slide::parameters{.motor = p, .encoder_step = how.encoder};
    };
    const thesis::axis& other = of_y ? thesis::x : thesis::y;
    const thesis::axis &as_x = of_y ? other : a, &as_y = of_y ? a : other;
    loop_type loop({.control = {configuration::controller(as_x, {}), configuration::controller(as_y, {})},
                    .table = {.x = machine(as_x), .y = machine(as_y)}},
                   thesis::period);
    std::vector<double> out;
    for (std::size_t k = 0; k < samples; ++k) {
        out.push_back((of_y ? loop.table().y().wire.place : loop.table().x().wire.place).value());
        loop({.x = sinusoid(k), .y = sinusoid(k)});
    }
    return out;
}

template <class Compensation, class Observer> void same_in_the_loop() {
    const thesis::reading how{.substeps = 5};
    for (const bool of_y : {false, true}) {
        const thesis::axis& a = of_y ? thesis::y : thesis::x;
        CAPTURE(a.name);
        const auto one = alone<Compensation, Observer>(a, how),
                   two = in_the_loop<Compensation, Observer>(a, of_y, how);
        double moved = 0;
        std::size_t different = 0;
        for (std::size_t k = 0; k < samples; ++k) {
            moved = std::max(moved, one[k]);
            different += one[k] != two[k];
        }
        CHECK(moved > 0.059);
        CHECK(different == 0);
    }
}
} // namespace

TEST_CASE(
    "xy_loop: the friction runs of chapters 3 and 4 are the same as one axis of the whole loop, bit for bit") {
    same_in_the_loop<thesis::no_friction_model, thesis::no_observer>();
    same_in_the_loop<thesis::static_curve, thesis::no_observer>();
    same_in_the_loop<thesis::gms_model, thesis::no_observer>();
    same_in_the_loop<thesis::gms_model, thesis::observer>();
    same_in_the_loop<thesis::learning_model, thesis::observer>();
}
