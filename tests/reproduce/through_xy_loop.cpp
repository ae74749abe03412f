// SPDX-License-Identifier: BSL-1.0
// The experiments of one axis, run again as one axis of the whole two-axis loop: the same, to the bit.
#include "quadrant_reproduce/experiment/dob_force.hpp"
#include "quadrant_reproduce/experiment/feedforward.hpp"
#include "quadrant_reproduce/experiment/harmonics_cases.hpp"
#include "quadrant_reproduce/milling_table.hpp"
#include "quadrant_reproduce/push_run.hpp"

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
/// What an experiment of one axis takes: here it is an axis of an `xy_loop` whose other axis swings.
template <class Boxes, class Motor, bool OfY> class axis_of_loop {
    using slide = table_axis_boxes<Motor>;
    using loop_type = xy_loop<Boxes, Boxes, xy_table<slide, slide>, thesis::told_force>;

public:
    using motion = axis_motion<>;
    explicit axis_of_loop(const thesis::one_axis_parameters<Boxes, Motor>& p)
        : loop_({.control = {p.controller, p.controller},
                 .table = {.x = {.motor = p.motor, .encoder_step = p.encoder},
                           .y = {.motor = p.motor, .encoder_step = p.encoder}}},
                thesis::period) {}

    void step(const motion& now, const motion& ahead, quantity_of<signal::force> push = {}) {
        const double t = double(count_++) * thesis::period.value();
        const motion other{1_mm * (1 - std::cos(7 * t)), 7_mmps * std::sin(7 * t),
                           49e-3 * std::cos(7 * t) * 1_mps2};
        (OfY ? loop_.process_y() : loop_.process_x()).now = push;
        sense_other();
        if constexpr (OfY)
            loop_({.x = other, .y = now}, {.x = other, .y = ahead});
        else
            loop_({.x = now, .y = other}, {.x = ahead, .y = other});
    }
    auto now() const {
        const auto& w = wire();
        struct {
            quantity<si::length> x;
            quantity<si::velocity> v;
        } here{w.place, w.velocity};
        return here;
    }
    auto& disturbance() {
        if constexpr (OfY)
            return loop_.control().y().box.disturbance;
        else
            return loop_.control().x().box.disturbance;
    }
    bool stopped() const { return loop_.faulted() || loop_.limited(); }

private:
    template <bool Y> const auto& wire_of() const {
        if constexpr (Y)
            return loop_.table().y().wire;
        else
            return loop_.table().x().wire;
    }
    const auto& wire() const { return wire_of<OfY>(); }
    /// The acceleration sensor of the other axis, as `run_push` reads that of its own.
    void sense_other() {
        const auto v = wire_of<!OfY>().velocity;
        const auto a = (v - before_) / thesis::period;
        before_ = v;
        const auto tell = [&](auto& axis) {
            if constexpr (requires { axis.box.disturbance.sense(a); }) axis.box.disturbance.sense(a);
        };
        if constexpr (OfY)
            tell(loop_.control().x());
        else
            tell(loop_.control().y());
    }
    loop_type loop_;
    quantity<si::velocity> before_{};
    long count_ = 0;
};
template <class Boxes, class Motor> using as_x = axis_of_loop<Boxes, Motor, false>;
template <class Boxes, class Motor> using as_y = axis_of_loop<Boxes, Motor, true>;

template <class Slot> void same_pushes() {
    for (const bool tracking : {false, true}) {
        CAPTURE(tracking);
        const thesis::push p{.harmonics = 3, .tracking = tracking, .seconds = 1};
        const auto one = thesis::pushed<Slot>(p);
        CHECK(one.error.size() > 1900);
        CHECK(one.rms > 0.1);
        CHECK(one.error == thesis::pushed<Slot, as_x>(p).error);
        CHECK(one.error == thesis::pushed<Slot, as_y>(p).error);
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
TEST_CASE(
    "xy_loop: the cutter's harmonics against every observer of chapters 4 and 5 and Appendices C and D are the "
    "same as one axis of the whole loop, bit for bit") {
    same_pushes<thesis::nothing_observed>();
    same_pushes<thesis::by_inverse_model>();
    same_pushes<thesis::by_ferraris>();
    same_pushes<thesis::by_reduced_order>();
    same_pushes<thesis::by_harmonics<2>>();
}
TEST_CASE(
    "xy_loop: the sinusoidal force on the resting axis and the feedforward at 10 Hz are the same as one axis "
    "of the whole loop, bit for bit") {
    using quadrant_reproduce::error_under_push, quadrant_reproduce::follow_sinusoid, quadrant_reproduce::fed;
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        CAPTURE(a->name);
        const auto with = thesis::observer::of(*a);
        for (const double hertz : {1.0, 58.0}) {
            const auto off = error_under_push<thesis::no_observer>(*a, {}, hertz),
                       on = error_under_push<thesis::observer>(*a, with, hertz);
            REQUIRE(off);
            REQUIRE(on);
            CHECK(*off != *on);
            CHECK(off == error_under_push<thesis::no_observer, as_x>(*a, {}, hertz));
            CHECK(on == error_under_push<thesis::observer, as_y>(*a, with, hertz));
        }
        for (const fed how : {fed::model, fed::model_in_advance}) {
            const auto one = follow_sinusoid(*a, how, "");
            CHECK(one.error.y == follow_sinusoid<as_x>(*a, how, "").error.y);
            CHECK(one.largest == follow_sinusoid<as_y>(*a, how, "").largest);
        }
    }
}
TEST_CASE("xy_loop: what the Ferraris estimator says of the force (Fig. 5.10) is the same on one axis of the "
          "whole loop, bit for bit") {
    using quadrant_reproduce::ferraris_run;
    const auto one = ferraris_run();
    REQUIRE(one.estimated.y.size() == 400);
    CHECK(*std::max_element(one.estimated.y.begin(), one.estimated.y.end()) > 20);
    CHECK(one.estimated.y != one.given.y);
    CHECK(one.estimated.y == ferraris_run<as_x>().estimated.y);
    CHECK(one.estimated.y == ferraris_run<as_y>().estimated.y);
}
