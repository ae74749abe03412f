// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
using sample = axis_motion<>;
sample motion_at(double x, double v, double a) { return {x * 1_m, v * 1_mps, a * 1_mps2}; }
/// Jerk 40 m/s^3 and whatever else a cubic in time has.
sample cubic(double t) {
    return motion_at(0.3 + 0.1 * t - 0.7 * t * t + 40 * t * t * t / 6, 0.1 - 1.4 * t + 20 * t * t,
                     -1.4 + 40 * t);
}
sample sine(double w, double t) {
    return motion_at(0.03 * std::sin(w * t), 0.03 * w * std::cos(w * t), -0.03 * w * w * std::sin(w * t));
}
template <class Block> std::string refusal(typename Block::parameters p) {
    try {
        Block{p, Ts};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "";
}
} // namespace

TEST_CASE("preview: the reference is the trajectory a whole capacity late, bit for bit, whatever the lead") {
    preview<3> p{{0.4_ms}, Ts};
    p.settle(sine(5, 0));
    for (int k = 0; k < 1000; ++k) {
        if (k % 7 == 0) p.lead(double(k % 1500) * 1_us);
        const auto y = p(sine(5, k * 5e-4));
        if (k < 3) continue;
        const auto then = sine(5, (k - 3) * 5e-4);
        CHECK(y.reference.position == then.position);
        CHECK(y.reference.velocity == then.velocity);
        CHECK(y.reference.acceleration == then.acceleration);
    }
}
TEST_CASE(
    "preview: at whole periods `ahead` is a sample of the trajectory, bit for bit; at lead 0 the reference") {
    for (const int n : {0, 1, 2, 3}) {
        preview<3> p{{double(n) * Ts}, Ts};
        p.settle(sine(5, 0));
        for (int k = 0; k < 100; ++k) {
            const auto y = p(sine(5, k * 5e-4));
            if (k < 3) continue;
            const auto then = sine(5, (k - 3 + n) * 5e-4);
            CHECK(y.ahead.position == then.position);
            CHECK(y.ahead.velocity == then.velocity);
            CHECK(y.ahead.acceleration == then.acceleration);
        }
    }
}
TEST_CASE("preview: between samples a cubic in time comes back exactly (1e-15 m, 1e-14 m/s, 1e-10 m/s^2)") {
    for (const double lead : {0.05e-3, 0.4e-3, 0.65e-3, 1.3e-3, 1.4999e-3}) {
        preview<3> p{{lead * 1_s}, Ts};
        p.settle(cubic(0));
        for (int k = 0; k < 200; ++k) {
            const auto y = p(cubic(k * 5e-4)).ahead;
            if (k < 3) continue;
            const auto then = cubic((k - 3) * 5e-4 + lead);
            CHECK(std::abs((y.position - then.position).value()) < 1e-15);
            CHECK(std::abs((y.velocity - then.velocity).value()) < 1e-14);
            CHECK(std::abs((y.acceleration - then.acceleration).value()) < 1e-10);
        }
    }
}
TEST_CASE(
    "preview: between the samples of a sine the position is off by at most (w T)^4 / 384 of it, and no less "
    "than half of that") {
    for (const double hertz : {10.0, 50.0}) {
        const double w = 2 * pi * hertz, bound = 0.03 * std::pow(w * 5e-4, 4) / 384;
        preview<2> p{{0.25_ms}, Ts};
        double worst = 0;
        for (int k = 0; k < 1000; ++k) {
            const auto y = p(sine(w, k * 5e-4)).ahead;
            if (k < 2) continue;
            worst = std::max(worst, std::abs((y.position - sine(w, (k - 2) * 5e-4 + 2.5e-4).position).value()));
        }
        CHECK(worst < 1.001 * bound + 1e-17);
        CHECK(worst > 0.5 * bound);
    }
}
TEST_CASE("preview: at(d) is what a preview with that lead gives") {
    preview<3> p{{0_s}, Ts}, other{{0.85_ms}, Ts};
    for (int k = 0; k < 50; ++k) {
        p(sine(20, k * 5e-4));
        const auto y = other(sine(20, k * 5e-4)).ahead;
        CHECK(p.at(0.85_ms).position == y.position);
        CHECK(p.at(0.85_ms).velocity == y.velocity);
        CHECK(p.at(0.85_ms).acceleration == y.acceleration);
    }
}
TEST_CASE("preview: a jump of acceleration within the period stays within 1/3 of the jump beyond either side") {
    double least = 0, most = 0;
    for (int i = 0; i <= 100; ++i) { // a starts to be 6 m/s^2 at the newest sample
        preview<2> p{{double(i) * 5_us}, Ts};
        p.settle(motion_at(0, 0, 0));
        p(motion_at(0, 0, 0));
        p(motion_at(0, 0, 0));
        const double a = p(motion_at(0, 0, 6)).ahead.acceleration.value();
        CHECK(a == 0); // lead below one period: still before it
        const double b = p.at(0.5_ms + double(i) * 5_us).acceleration.value();
        least = std::min(least, b), most = std::max(most, b);
    }
    CHECK(least > -2.001);
    CHECK(least < -1.99);
    CHECK(most == 6);
}
TEST_CASE(
    "preview: a lead beyond the capacity or below zero saturates and is told; not finite changes nothing") {
    preview<2> p{{0.4_ms}, Ts};
    CHECK_FALSE(p.limited());
    p.lead(1.1_ms);
    CHECK(p.limited());
    for (int k = 0; k < 9; ++k) p(cubic(k * 5e-4));
    CHECK(p(cubic(9 * 5e-4)).ahead.position == cubic(9 * 5e-4).position);
    p.lead(-0.1_ms);
    CHECK(p.limited());
    CHECK(p(cubic(10 * 5e-4)).ahead.position == cubic(8 * 5e-4).position);
    p.lead(0.5_ms);
    CHECK_FALSE(p.limited());
    p.lead(std::numeric_limits<double>::quiet_NaN() * 1_s);
    CHECK(p.faulted());
    CHECK(p(cubic(11 * 5e-4)).ahead.position == cubic(10 * 5e-4).position);
}
TEST_CASE("preview: one member that is not finite holds both motions and is taken in nowhere") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& bad : {motion_at(nan, 0, 0), motion_at(0, nan, 0), motion_at(0, 0, nan)}) {
        preview<2> p{{0.4_ms}, Ts}, twin{{0.4_ms}, Ts};
        for (int k = 0; k < 20; ++k) p(cubic(k * 5e-4)), twin(cubic(k * 5e-4));
        const auto last = p(cubic(20 * 5e-4)), held = p(bad);
        twin(cubic(20 * 5e-4));
        CHECK(held.reference.position == last.reference.position);
        CHECK(held.ahead.acceleration == last.ahead.acceleration);
        CHECK(p.faulted());
        CHECK(p(cubic(21 * 5e-4)).ahead.velocity == twin(cubic(21 * 5e-4)).ahead.velocity);
    }
}
TEST_CASE("preview: feeds a milling_axis with its own motion type") {
    using axis = milling_axis<milling_axis_boxes<>>;
    preview<2, axis::motion> p{{0.65_ms}, Ts};
    const auto y = p({1_mm, 2_mmps, 3_mps2});
    static_assert(std::same_as<decltype(y.reference), axis::motion>);
    CHECK(y.reference.position == 0_m);
    CHECK(p.at(1_ms).acceleration == 3_mps2);
}
TEST_CASE("preview: a dual lead carries its derivative: d ahead / d lead is the velocity") {
    using D = dual<1>;
    using M = axis_motion<D>;
    preview<2, M> p{{quantity<si::time, D>::from_value(D::variable(0.65e-3, 0))}, Ts};
    M y;
    for (int k = 0; k < 10; ++k) {
        const auto c = cubic(k * 5e-4);
        y = p({decltype(M::position)::from_value(c.position.value()),
               decltype(M::velocity)::from_value(c.velocity.value()),
               decltype(M::acceleration)::from_value(c.acceleration.value())})
                .ahead;
    }
    const auto then = cubic(7 * 5e-4 + 0.65e-3);
    CHECK(y.position.value().partial[0] == doctest::Approx(then.velocity.value()).epsilon(1e-9));
    CHECK(y.velocity.value().partial[0] == doctest::Approx(then.acceleration.value()).epsilon(1e-9));
}
TEST_CASE("preview: refuses a lead beyond its capacity and below zero") {
    CHECK(refusal<preview<2>>({1.1_ms}) ==
          "preview.lead = 0.0011 s: must lie between 0 and 0.001 s (capacity)");
    CHECK(refusal<preview<2>>({-0.1_ms}) ==
          "preview.lead = -1e-04 s: must lie between 0 and 0.001 s (capacity)");
    CHECK(refusal<preview<2>>({std::numeric_limits<double>::infinity() * 1_s}) != "");
    CHECK(refusal<preview<2>>({1_ms}) == "");
}
TEST_CASE(
    "preview: whole periods up to its capacity are taken, though 13 periods of 100 us over 100 us are not 13") {
    const auto T = 100_us;
    REQUIRE((13.0 * T).value() / T.value() > 13);
    preview<13> p{{13.0 * T}, T};
    CHECK_FALSE(p.limited());
    for (int k = 0; k < 20; ++k) CHECK(p(motion_at(k, 0, 0)).ahead.position.value() == k);
}
