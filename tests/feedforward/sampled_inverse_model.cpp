// SPDX-License-Identifier: BSL-1.0
#include "linear_plant.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/sampled_inverse_model.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
constexpr double A = 28.57, B = 4.526; // x axis of [Jamaludin2008]
using block = sampled_inverse_model<signal::voltage>;
const block::parameters x_axis = axis_model<signal::voltage>{B * 1_mps2 / 1_V, A / 1_s};

/// sum d_i s^i / n0 with s = 2 (z - 1) / (T (z + 1)), times ((1 + 1/z) / 2)^N: the other way to write the same
/// filter.
template <std::size_t N> std::complex<double> bilinear(const nominal_plant<N>& p, double f) {
    const double T = 5e-4;
    const std::complex<double> z = std::polar(1.0, 2 * std::numbers::pi * f * T),
                               s = 2.0 / T * (z - 1.0) / (z + 1.0);
    std::complex<double> sum = 0;
    for (std::size_t i = N + 1; i-- > 0;) sum = sum * s + p.denominator[i];
    return sum / p.numerator[0] * std::pow((1.0 + 1.0 / z) / 2.0, double(N));
}
template <std::size_t N> double off(const nominal_plant<N>& p) {
    const sampled_inverse_model<signal::voltage, N> f{p, Ts};
    double worst = 0;
    for (const double at : {1.0, 30.0, 333.0, 950.0}) {
        const auto expected = bilinear(p, at);
        worst = std::max(worst, std::abs(f.response(at * 1_Hz) - expected) / std::abs(expected));
    }
    return worst;
}
std::string refusal(const block::parameters& p) {
    try {
        block{p, Ts};
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "";
}
} // namespace

TEST_CASE("sampled_inverse_model: on a parabola it is the inverse one period late, exactly (1e-9 V)") {
    block f{x_axis, Ts};
    const auto path = [](double t) { return 0.1 + 0.2 * t + 3 * t * t / 2; };
    f.settle(path(0) * 1_m);
    for (int k = 1; k < 400; ++k) {
        const double u = f(path(k * 5e-4) * 1_m).value(), t = (k - 1) * 5e-4;
        if (k > 2) CHECK(std::abs(u - (3 + A * (0.2 + 3 * t)) / B) < 1e-9);
    }
}
TEST_CASE(
    "sampled_inverse_model: one sample's step of 1 um, by hand: 1e-6 (1/T^2 + A/(2T)) / B = 0.890 V, then "
    "-1.768, 0.877, 0") {
    block f{x_axis, Ts};
    f(0_m);
    CHECK(f(1_um).value() == doctest::Approx((4 + 1e-6 * A / 1e-3) / B));
    CHECK(f(0_m).value() == doctest::Approx(-8 / B));
    CHECK(f(0_m).value() == doctest::Approx((4 - 1e-6 * A / 1e-3) / B));
    CHECK(f(0_m) == 0_V);
}
TEST_CASE("sampled_inverse_model: orders 1 to 4 are the bilinear inverse times ((1 + 1/z)/2)^N") {
    CHECK(off<1>({{3}, {2, 0.1}}) < 1e-12);
    CHECK(off<2>(x_axis) < 1e-9);
    CHECK(off<3>({{3}, {0, 20, 0.7, 0.02}}) < 1e-9);
    CHECK(off<4>({{3}, {5, 20, 0.7, 0.02, 1e-4}}) < 1e-9);
}
TEST_CASE("sampled_inverse_model: a reference that stands still, anywhere, needs exactly nothing on an axis") {
    block f{x_axis, Ts};
    f.settle(0.123456789_m);
    for (int k = 0; k < 9; ++k) CHECK(f(0.123456789_m) == 0_V);
    sampled_inverse_model<signal::voltage, 2, signal::position, float> rough{x_axis, Ts};
    rough.settle(quantity<si::length, float>::from_value(0.1234567f));
    for (int k = 0; k < 9; ++k) CHECK(rough(quantity<si::length, float>::from_value(0.1234567f)).value() == 0);
}
TEST_CASE(
    "sampled_inverse_model: drives the plant along the reference, 1.5 periods and the dead time late: 5 Hz to "
    "(w T)^2 of it, and not at all if that is forgotten") {
    const double T = 5e-4, w = 2 * std::numbers::pi * 5;
    block f{x_axis, Ts};
    linear_plant plant(A, B, 1e-3, T);
    const auto path = [&](double t) { return 0.01 * std::pow(std::sin(w * t), 3); }; // starts smoothly
    double worst = 0, forgotten = 0;
    for (int k = 0; k < 4000; ++k) {
        const double y = plant(f(path(k * T) * 1_m).value()), t = (k + 1) * T; // the time of y
        worst = std::max(worst, std::abs(y - path(t - 1.5 * T - 1e-3)));
        forgotten = std::max(forgotten, std::abs(y - path(t)));
    }
    CHECK(worst < 0.01 * std::pow(3 * w * T, 2)); // the highest line is at three times w
    CHECK(forgotten > 10 * worst);
}
TEST_CASE("sampled_inverse_model: refuses a plant without gain, and one whose order is not what it says") {
    CHECK(refusal({{0}, {0, 1, 1}}) == "sampled_inverse_model.numerator = 0: must be finite and not 0");
    CHECK(refusal({{1}, {0, 1, 0}}) ==
          "sampled_inverse_model.denominator = 0: must not be 0 at the highest power");
    CHECK(refusal({{1}, {0, std::numeric_limits<double>::infinity(), 1}}) ==
          "sampled_inverse_model.denominator = inf: must be finite");
    CHECK(refusal(x_axis) == "");
}
