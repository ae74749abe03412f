// SPDX-License-Identifier: BSL-1.0
// Long: templates that put the experiments of one axis into the loop of two, and their comparison.
// The experiments of one axis, run again as one axis of the whole two-axis loop: the same, to the bit.
#include "quadrant_reproduce/experiment/dob_force.hpp"
#include "quadrant_reproduce/experiment/feedforward.hpp"
#include "quadrant_reproduce/experiment/harmonics_cases.hpp"
#include "quadrant_reproduce/experiment/identify.hpp"
#include "quadrant_reproduce/frequency_response.hpp"
#include "quadrant_reproduce/milling_table.hpp"
#include "quadrant_reproduce/push_run.hpp"
#include "quadrant_reproduce/wrong_y_axis.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace through_xy_loop { // named: templates of the program are made of its types
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

/// What an experiment with instruments takes: an axis of an `xy_loop` that is read through them. The other axis
/// has the same ones and swings.
template <class Boxes, class Motor, class Instruments, bool OfY> class measured_axis_of_loop {
    using slide = table_axis_boxes<Motor>;
    using table = thesis::measured_table<xy_table<slide, slide>, Instruments>;
    using loop_type = xy_loop<Boxes, Boxes, table>;

public:
    measured_axis_of_loop(const typename Boxes::parameters& controller, const typename Motor::parameters& motor,
                          const Instruments& instruments)
        : loop_({.control = {controller, controller},
                 .table = {.table = {.x = {.motor = motor}, .y = {.motor = motor}},
                           .x = instruments,
                           .y = instruments}},
                thesis::period) {}

    void settle(quantity<si::length> at) { loop_.settle({.x = on_x(at), .y = on_y(at)}); }
    void step(const axis_motion<>& now) {
        const double t = double(count_++) * thesis::period.value();
        const axis_motion<> other{1_mm * (1 - std::cos(7 * t)), 7_mmps * std::sin(7 * t),
                                  49e-3 * std::cos(7 * t) * 1_mps2};
        const auto seen = loop_.table().reading();
        reading_ = OfY ? seen.y.plain() : seen.x.plain();
        if constexpr (OfY)
            loop_({.x = other, .y = now});
        else
            loop_({.x = now, .y = other});
    }
    auto& boxes() { return control().box; }
    auto now() const {
        struct {
            quantity<si::length> x;
        } here{OfY ? loop_.table().y().wire.place : loop_.table().x().wire.place};
        return here;
    }
    auto reading() const { return reading_; }
    auto command() { return control().wire.command; }
    bool stopped() const { return loop_.faulted() || loop_.limited(); }

private:
    auto& control() {
        if constexpr (OfY)
            return loop_.control().y();
        else
            return loop_.control().x();
    }
    loop_type loop_;
    quantity<si::length> reading_{};
    long count_ = 0;
};
template <class Boxes, class Motor, class Instruments>
using measured_as_x = measured_axis_of_loop<Boxes, Motor, Instruments, false>;
template <class Boxes, class Motor, class Instruments>
using measured_as_y = measured_axis_of_loop<Boxes, Motor, Instruments, true>;

/// What the measurement of a frequency response drives: an axis of an `xy_table` whose other axis is driven,
/// too.
template <class Friction, bool OfY> class driven_axis {
    using slide = table_axis_boxes<linear_motor<Friction>>;

public:
    driven_axis(const typename linear_motor<Friction>::parameters& p, quantity<si::length> encoder)
        : table_({.x = {.motor = p, .encoder_step = encoder}, .y = {.motor = p, .encoder_step = encoder}},
                 thesis::period) {}
    quantity<si::length> operator()(quantity_of<signal::voltage> u) {
        const auto other = 0.3 * noise_() * 1_V;
        const auto at = table_({.x = on_x(OfY ? other : u), .y = on_y(OfY ? u : other)});
        return OfY ? at.y.plain() : at.x.plain();
    }

private:
    xy_table<slide, slide> table_;
    thesis::white_noise noise_{7};
};
template <class Friction> using driven_x = driven_axis<Friction, false>;
template <class Friction> using driven_y = driven_axis<Friction, true>;

/// The log of a sinusoid of 15 um at 0.1 Hz, seen through noisy instruments.
template <template <class, class, class> class Axis> auto identified_log(const thesis::axis& a) {
    const double w = 2 * thesis::pi_ * 0.1;
    return thesis::identification::rig_of<Axis>(a, 5).follow(
        [=](double t) -> std::array<double, 3> {
            return {15e-6 * (1 - std::cos(w * t)), 15e-6 * w * std::sin(w * t),
                    15e-6 * w * w * std::cos(w * t)};
        },
        10);
}

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
} // namespace through_xy_loop
using namespace through_xy_loop;

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
TEST_CASE(
    "xy_loop: the logs from which friction is identified, with noise of encoder and amplifier, are the same "
    "on one axis of the whole loop, bit for bit") {
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        CAPTURE(a->name);
        const auto one = identified_log<thesis::measured_axis>(*a), as_x = identified_log<measured_as_x>(*a),
                   as_y = identified_log<measured_as_y>(*a);
        REQUIRE(one.position.size() == 20000);
        CHECK(*std::max_element(one.position.begin(), one.position.end()) > 29_um);
        CHECK(one.position == as_x.position);
        CHECK(one.command == as_x.command);
        CHECK(one.position == as_y.position);
        CHECK(one.command == as_y.command);
    }
}
TEST_CASE(
    "xy_loop: a y axis that differs from its tables, with cogging, noise and jitter, errs at its reversals "
    "as one axis of the whole loop does, bit for bit") {
    const thesis::difference d{.level = 1.2,
                               .mass = 1.1,
                               .lag = 2e-4,
                               .dac = 20.0 / 65536,
                               .noise = 1e-7,
                               .jitter = 1e-6,
                               .cogging = 3};
    const auto one = thesis::reversals_with(d), as_x = thesis::reversals_with<measured_as_x>(d),
               as_y = thesis::reversals_with<measured_as_y>(d), without = thesis::reversals_with({});
    REQUIRE((one && as_x && as_y && without));
    CHECK(one->glitch != without->glitch);
    CHECK(one->glitch == as_x->glitch);
    CHECK(one->between == as_x->between);
    CHECK(one->glitch == as_y->glitch);
    CHECK(one->between == as_y->between);
}
TEST_CASE(
    "xy_table: the frequency responses of the thesis, whose loop is open, are the same on one axis of the "
    "whole table, bit for bit") {
    const auto values = [](const quadrant::analysis::measured_frf& frf) {
        std::vector<std::complex<double>> out;
        for (const auto& line : frf.lines) out.push_back(line.value);
        return out;
    };
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        CAPTURE(a->name);
        using thesis::gms_beside, thesis::measured_response;
        const auto one = values(measured_response<gms_beside>(*a, a->A, 1, 0.2));
        REQUIRE(one.size() > 500);
        CHECK(std::abs(one[100]) > 0);
        CHECK(one == values(measured_response<gms_beside, driven_x>(*a, a->A, 1, 0.2)));
        CHECK(one == values(measured_response<gms_beside, driven_y>(*a, a->A, 1, 0.2)));
    }
}
