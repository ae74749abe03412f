// SPDX-License-Identifier: BSL-1.0
// As stated.cpp: filters, derivatives, delays and sampled systems.
#include "dice.hpp"

#include <quadrant/base/fine_sum.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/drive/velocity_loop.hpp>
#include <quadrant/feedforward/sampled_inverse_model.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>
#include <quadrant/filter/viscous_step.hpp>
#include <quadrant/memory/fractional_delay.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using stated::dice, stated::trials;
frequency hertz(double f) { return frequency::from_value(f); }
auto position_of(double x) { return quantity_of<signal::position>::from_value(x); }
} // namespace

TEST_CASE(
    "notch: the zero sits exactly at the centre; lowpass, butterworth: -3 dB and -45, -90 degrees exactly at "
    "the corner (second_order: bilinear, exact at w)") {
    dice roll;
    int tried = 0;
    double left = 0, // times the width: twice how far the zero is from the centre, as a share of it
        off_first = 0, off_second = 0;
    for (; tried < trials; ++tried) {
        const frequency f = hertz(roll.decades(1e-4, 0.4999) * 1000);
        const double width = roll(0.01, 1.9);
        left = std::max(left, width * std::abs(notch<signal::force>({f, width}, 1_ms).response(f)));
        const std::complex<double> first = lowpass<signal::force>({f}, 1_ms).response(f),
                                   second = butterworth<signal::force>({f}, 1_ms).response(f);
        off_first = std::max(off_first, std::abs(first - std::complex<double>(0.5, -0.5)));
        off_second = std::max(off_second, std::abs(second - std::complex<double>(0, -std::sqrt(0.5))));
    }
    CHECK(tried >= trials);
    CHECK(left < 1e-11);
    CHECK(off_first < 1e-11);
    CHECK(off_second < 1e-11);
}
TEST_CASE("filtered_derivative: the gain of a ramp is exactly one") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        filtered_derivative<signal::position, signal::velocity> block({hertz(roll.decades(1e-2, 2000))}, 1_ms);
        for (int n = 0; n < 20; ++n, ++tried) {
            const double rate = roll(-1, 1), start = roll(-1, 1);
            block.settle(position_of(start), quantity_of<signal::velocity>::from_value(rate));
            for (int k = 1; k <= 5; ++k)
                off = std::max(off, std::abs(block(position_of(start + rate * 1e-3 * k)).value() - rate));
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11); // rounding of positions of a metre, over a period of a millisecond
}
TEST_CASE(
    "two_sample_derivative: late by one period exactly, at all frequencies; sampled_inverse_model: by half of "
    "its order") {
    dice roll;
    double off = 0;
    int tried = 0, tried_model = 0;
    const two_sample_derivative<signal::position, signal::velocity> slope({}, 1_ms);
    for (; tried < trials; ++tried) {
        const double f = roll(1e-6, 0.4999) * 1000, angle = 2 * std::numbers::pi * f * 1e-3;
        const auto slow = slope.response(hertz(f)) / std::complex<double>(0, 1) * std::polar(1.0, angle);
        off = std::max(off, std::abs(slow.imag()) / std::abs(slow));
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-9);
    double off_model = 0;
    for (; tried_model < trials;
         ++tried_model) { // of a pure double integrator 1/s^2 the inverse is real and negative
        const double f = roll(1e-3, 0.4999) * 1000, angle = 2 * std::numbers::pi * f * 1e-3;
        const sampled_inverse_model<signal::voltage, 2> inverse(
            axis_model<signal::voltage>{
                quantity<unit_quotient<si::acceleration, signal::voltage::unit>>::from_value(
                    roll.decades(0.1, 100)),
                0.0 / 1_s},
            1_ms);
        const auto y = inverse.response(hertz(f)) * std::polar(1.0, angle);
        off_model = std::max(off_model, std::abs(y.imag()) / std::abs(y));
    }
    CHECK(tried_model >= trials);
    CHECK(off_model < 1e-9);
}
TEST_CASE("fractional_delay: exact for polynomials up to its order, for any signal at whole periods") {
    dice roll;
    double off = 0, off_whole = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double a = roll(-1, 1), b = roll(-1, 1), c = roll(-1, 1), d = roll(-1, 1), late = roll(1, 8);
        fractional_delay<signal::position, 8, 3> cubic({duration::from_value(late * 1e-3)}, 1_ms);
        fractional_delay<signal::position, 8, 1> line({duration::from_value(late * 1e-3)}, 1_ms);
        const int whole = int(late);
        fractional_delay<signal::position, 8, 3> at_samples({duration::from_value(whole * 1e-3)}, 1_ms);
        double noise[32]{};
        for (int k = 0; k < 14; ++k) {
            const auto at = [&](double t) { return a + t * (b + t * (c + t * d)); };
            const double y = cubic(position_of(at(0.1 * k))).value(),
                         z = line(position_of(a + 0.1 * k * b)).value();
            noise[k] = roll(-1, 1);
            const double same = at_samples(position_of(noise[k])).value();
            if (k < 12) continue;
            off = std::max({off, std::abs(y - at(0.1 * (k - late))), std::abs(z - a - 0.1 * (k - late) * b)});
            off_whole = std::max(off_whole, std::abs(same - noise[k - whole]));
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
    CHECK(off_whole < 1e-12);
}
TEST_CASE("viscous_step, velocity_loop: the exact step: one step is any two") {
    dice roll;
    int tried = 0;
    double off = 0, off_loop = 0;
    for (; tried < trials; ++tried) {
        const double h = roll.decades(1e-6, 1e-1), A = roll.often() ? roll.decades(1e-6, 1e4) : 0,
                     v = roll(-1, 1), u = roll(-1, 1) * std::max(A, 1 / h), share = roll(0.05, 0.95);
        const viscous_step<double> whole(A, h), first(A, share * h), rest(A, (1 - share) * h);
        const double v1 = first.kept * v + first.gained * u, v2 = rest.kept * v1 + rest.gained * u;
        const double x2 = first.gained * v + first.way * u + rest.gained * v1 + rest.way * u;
        const double once = whole.kept * v + whole.gained * u, x = whole.gained * v + whole.way * u;
        off = std::max({off, std::abs(once - v2), std::abs(x - x2) / h});
        const velocity_loop<double>::parameters p{.gain = 1, .filter_Hz = roll.decades(1, 1e4)};
        const double asked = roll(-1, 1), t = roll.decades(1e-5, 1e-2);
        velocity_loop<double>::state one{0, roll(-1, 1)}, two = one;
        velocity_loop<double>(p, t)(one, asked, v);
        const velocity_loop<double> half(p, t / 2);
        half(two, asked, v), half(two, asked, v);
        off_loop = std::max(off_loop, std::abs(one.filtered - two.filtered));
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
    CHECK(off_loop < 1e-11);
}
TEST_CASE("zero_order_hold: exact for an input held over each period: the axis behind its hold") {
    dice roll;
    int tried = 0;
    double off = 0;
    for (; tried < trials; ++tried) { // B/(s (s + A)), against the solution of its differential equation
        const double A = roll.decades(1e-1, 1e3), B = roll(0.1, 10), h = roll.decades(1e-4, 1e-2);
        const auto d = zero_order_hold(continuous<2>{{B, 0, 0}, {0, A, 1}}, duration::from_value(h));
        const double x = A * h, left = std::exp(-x), gone = -std::expm1(-x);
        const double b1 = B / (A * A) * (x - gone), b2 = B / (A * A) * (gone - x * left);
        const double top = d.denominator[0], scale = B * h * h;
        off =
            std::max({off, std::abs(d.numerator[0] / top) / scale, std::abs(d.numerator[1] / top - b1) / scale,
                      std::abs(d.numerator[2] / top - b2) / scale, std::abs(d.denominator[1] / top + 1 + left),
                      std::abs(d.denominator[2] / top - left)});
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-10); // A h = 1e-5 costs the reference's differences five of 16 digits
}
TEST_CASE("fine_sum: x minus the sum is exact where both are close") {
    dice roll;
    int tried = 0;
    int off = 0;
    for (; tried < trials; ++tried) {
        const float x = float(roll(1, 2)), high = float(roll(1, 2)), low = 0;
        const fine_sum<float, true> sum{high, low};
        off += double(sum.below(x)) != double(x) - double(high);
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
