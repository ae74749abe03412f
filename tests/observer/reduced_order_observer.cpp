// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
namespace s = quadrant::signal;
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
using observer = reduced_order_observer<s::voltage>;
static_assert(maps<observer, s::position, s::velocity>); // may stand where a cascade has its differentiator
const observer::parameters y{
    .mass = 170_kg, .force_constant = 1470_N / 1_V, .viscous = 3400_N / 1_mps, .corner = 20_Hz};
} // namespace

TEST_CASE("reduced_order_observer: exact while the acceleration is constant, from any start") {
    observer ob{y, T};
    ob.settle(0.2_m, 0.1_mps);
    CHECK(ob.disturbance().value() == Approx(340));           // holds it against viscous friction
    ob(0.2_m + 0.1_mps * T + 0.5 * (3_mps2 * T * T), 3_mps2); // takes a for straight between the samples
    for (int k = 2; k < 2000; ++k) {
        const auto t = double(k) * T;
        const auto v = ob(0.2_m + 0.1_mps * t + 0.5 * (3_mps2 * t * t), 3_mps2);
        if (k > 1000) CHECK(v.value() == Approx((0.1_mps + 3_mps2 * t).value()).epsilon(1e-12));
    }
}
TEST_CASE("reduced_order_observer: a wrong start dies out with l1, by its one gain") {
    observer ob{y, T};
    ob.settle(0_m, 0.1_mps); // it stands still
    double last = 0.1;
    const double h = pi * 20 * T.value(), ratio = (1 - h) / (1 + h);
    for (int k = 0; k < 100; ++k) {
        last *= ratio;
        CHECK(ob(0_m).value() == Approx(last).epsilon(1e-12));
    }
    CHECK(ratio == Approx(std::exp(-2 * pi * 20 * T.value())).epsilon(1e-4));
}
TEST_CASE("reduced_order_observer: position and acceleration add up to the derivative, without lag") {
    const observer ob{y, T};
    for (const double f : {1.0, 20.0, 100.0}) {
        const std::complex<double> jw(0, 2 * pi * f);
        const auto sum = (ob.response(f * 1_Hz) + ob.response_to_acceleration(f * 1_Hz) * jw * jw) / jw;
        CHECK(std::abs(sum - 1.0) < 0.01); // (w T)^2 / 12 of the trapezoids: 0.8 % at 100 Hz
        CHECK(std::abs(std::arg(sum)) < 4e-3);
    }
}
TEST_CASE("reduced_order_observer: finds a force that the command does not know of, at once") {
    observer ob{y, T};
    double x = 0, v = 0, a = 0, u = 0;
    const double m = 170, c = 3400, e = std::exp(-c / m * T.value());
    for (int k = 0; k < 4000; ++k) {
        const double push = k < 2000 ? 0 : 80;
        ob(x * 1_m, a * 1_mps2, u * 1_V);                                           // z^-1: u of the last cycle
        if (k == 2001) CHECK(ob.disturbance().value() == Approx(80).epsilon(0.02)); // v settles from there
        if (k == 3999) CHECK(ob.disturbance().value() == Approx(80).epsilon(1e-3));
        u = 0.1 + 0.02 * std::sin(0.01 * k);
        const double to = (1470 * u + push) / c;
        x += to * T.value() + (v - to) * (1 - e) * m / c;
        v = to + (v - to) * e;
        a = (1470 * u + push - c * v) / m;
    }
    CHECK(ob.velocity().value() == Approx(v).epsilon(1e-3).scale(0));
}
TEST_CASE(
    "reduced_order_observer: behind an encoder of 0.25 um it is 5 times quieter than a derivative of 150 Hz") {
    observer ob{y, T};
    filtered_derivative<s::position, s::velocity> derivative{{150_Hz}, T};
    quantizer<s::position> encoder{{0.25_um}, T};
    double noise = 0, rough = 0;
    for (int k = 0; k < 20000; ++k) { // 1.59 mm/s, 0.5 Hz
        const double w = 2 * pi * 0.5, t = k * T.value();
        const auto reading = encoder(5e-4 * std::sin(w * t) * 1_m);
        const double v = 5e-4 * w * std::cos(w * t), a = -5e-4 * w * w * std::sin(w * t);
        const double off = ob(reading, a * 1_mps2).value() - v, other = derivative(reading).value() - v;
        if (k > 4000) noise += off * off, rough += other * other;
    }
    CHECK(std::sqrt(rough / noise) > 5);
}
TEST_CASE("reduced_order_observer: an offset Z of the acceleration leaves Z / l1 in the velocity") {
    observer ob{y, T};
    for (int k = 0; k < 1000; ++k) ob(0_m, 0.00858_mps2);
    CHECK(ob.velocity().value() == Approx(0.00858 / (2 * pi * 20)).epsilon(1e-9));
}
TEST_CASE("reduced_order_observer: at rest far from zero nothing moves; a bad argument of the three holds") {
    observer ob{y, T};
    ob.settle(0.7_m);
    for (int k = 0; k < 10; ++k) CHECK(ob(0.7_m) == 0_mps);
    const auto last = ob(0.701_m, 2_mps2);
    const auto before = ob.now();
    CHECK(ob(std::nan("") * 1_m) == last);
    CHECK(ob(0.7_m, std::nan("") * 1_mps2) == last);
    CHECK(ob(0.7_m, 0_mps2, std::nan("") * 1_V) == last);
    CHECK(ob.faulted());
    CHECK(ob.now().position == before.position);
    CHECK(ob.now().accelerated == before.accelerated);
}
TEST_CASE("reduced_order_observer: refuses what no axis has") {
    const auto with = [](auto change) {
        auto p = y;
        change(p);
        return observer(p, T);
    };
    CHECK_THROWS_WITH_AS(
        with([](auto& p) { p.corner = 1_kHz; }),
        "reduced_order_observer.corner = 1000 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
        invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.mass = 0_kg; }), invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.force_constant = -1_N / 1_V; }), invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.viscous = -1_N / 1_mps; }), invalid_parameter);
    CHECK_THROWS_AS(observer(y, 0_s), invalid_parameter);
}
