// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "conformance/blocks.hpp"
#include "sums.hpp"

#include <quadrant/base/lanes.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// What blocks_count and blocks_time measure: every block of tests/conformance/blocks.hpp, the whole axis of
/// the milling table, and two second-order filters as one would write them without this library.
namespace counted {
using namespace conformance;

/// What is fed in: repeatable, exact in double, never at a switch of a block.
inline std::vector<double> input(double amplitude) {
    noise next;
    std::vector<double> x(20'000);
    for (double& each : x) each = next(amplitude);
    return x;
}

/// One call a sample with everything inlined into it, as in a servo interrupt. The sum stands for a consumer.
template <class Step> [[gnu::noinline, gnu::flatten]] double sample(Step& step, double x) { return step(x); }
template <class Step> double run(Step step, const std::vector<double>& x, std::size_t n) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += sample(step, x[k]);
    return sum;
}
/// What has moved for 1000 samples and then stood for 32 000, its input at zero: what dies out has died out.
template <class Step> Step rested(Step step, const std::vector<double>& x) {
    for (std::size_t k = 0; k < 1000; ++k) sample(step, x[k]);
    for (std::size_t k = 0; k < 32'000; ++k) sample(step, 0.0);
    return step;
}

/// The notch of the conformance list in doubles, transposed direct form II, without any check.
struct biquad_by_hand {
    double b0, b1, b2, a1, a2, s0 = 0, s1 = 0;
    double operator()(double x) {
        const double y = b0 * x + s0;
        s0 = b1 * x - a1 * y + s1;
        s1 = b2 * x - a2 * y;
        return y;
    }
};
/// The same filter as a state space in Eigen's fixed-size matrices: y = C s + D x, s = A s + B x.
struct biquad_by_eigen {
    Eigen::Matrix2d A;
    Eigen::Vector2d B;
    Eigen::RowVector2d C;
    double D;
    Eigen::Vector2d s = Eigen::Vector2d::Zero();
    double operator()(double x) {
        const double y = C * s + D * x;
        s = (A * s + B * x).eval();
        return y;
    }
};
inline biquad_by_hand by_hand() { // 330 Hz, damping 0.1, 500 us
    const double t = std::tan(std::numbers::pi * 330 * 0.0005), a0 = 1 + 0.1 * t + t * t;
    const double ends = (1 + t * t) / a0, middle = 2 * (t * t - 1) / a0;
    return {ends, middle, ends, middle, (1 - 0.1 * t + t * t) / a0};
}
inline biquad_by_eigen by_eigen() {
    const auto f = by_hand();
    biquad_by_eigen e;
    e.A << -f.a1, 1, -f.a2, 0;
    e.B << f.b1 - f.a1 * f.b0, f.b2 - f.a2 * f.b0;
    e.C << 1, 0;
    e.D = f.b0;
    return e;
}

using friction_law = maxwell_slip<4, s::velocity, s::voltage>;
using observer = disturbance_observer<s::voltage, s::position, 2, 0, 2, 0>;
using memory = repetitive<s::position, 1000>; // its stock lengths: 90 taps that learn, 61 that smooth
inline const friction_law::parameters slip{.curve = {0.084_V, 0.122_V, 22_mmps, 0.586_V / 1_mps},
                                           .weights = {0.25, 0.25, 0.25, 0.25},
                                           .forces = {},
                                           .stiffness = {3500_V / 1_m, 900_V / 1_m, 250_V / 1_m, 70_V / 1_m},
                                           .attraction = 27_V / 1_s};
inline const observer::parameters watch{60_Hz, axis_model<s::voltage>{4.526_mps2 / 1_V, 28.57 / 1_s}};

/// An axis of the milling table with these boxes.
template <class... Boxes> auto axis() {
    using boxes = milling_axis_boxes<Boxes...>;
    typename boxes::parameters p{};
    p.position_gain = 150.0 / 1_s;
    p.velocity_gain = 60_V / 1_mps;
    p.velocity_integral = 450_V / 1_m;
    p.estimator_corner = 150_Hz;
    p.notch = {.centre = 330_Hz, .width = 0.06};
    p.plant_gain = 4.526_mps2 / 1_V;
    p.plant_pole = 28.57 / 1_s;
    p.limit = 10_V;
    p.dac_step = 20_V / 65536.0;
    if constexpr (sizeof...(Boxes) > 0) p.friction = slip;
    if constexpr (sizeof...(Boxes) > 1) p.disturbance = watch;
    if constexpr (sizeof...(Boxes) > 2) p.memory = {.cycle = 236_ms};
    return milling_axis<boxes>{.box = {p, T}};
}

/// `axes` equal axes after each other; the reference is `x`, the measurement a tenth less.
template <class Axis, std::size_t axes> struct loop {
    std::array<Axis, axes> axis;
    double operator()(double x) {
        double sum = 0;
        for (auto& each : axis)
            sum += each({.position = quantity_of<s::position>::from_value(x)},
                        quantity_of<s::position>::from_value(0.9 * x))
                       .value();
        return sum;
    }
};
template <class Axis, std::size_t axes> loop(std::array<Axis, axes>) -> loop<Axis, axes>;
template <class... Boxes> auto one() { return loop{std::array{axis<Boxes...>()}}; }
template <class... Boxes> auto two() { return loop{std::array{axis<Boxes...>(), axis<Boxes...>()}}; }

/// What a longer preview costs.
template <std::size_t Horizon> auto predicting() {
    using law = law_on<predictive<Horizon>>;
    return [block = law(
                {.plant = {4.526_mps2 / 1_V, 28.57 / 1_s}, .weights = bryson_weights(9.5_um, 8.8_mmps, 0.09_V)},
                T)](double x) mutable { return block(x * 1_m).value(); };
}

/// Four notches of the library, each with its own centre, and the same in lanes (registers of the build's
/// instruction set).
struct four_notches {
    std::array<notch<s::force>, 4> each{notch<s::force>{{330_Hz, 0.1}, T}, notch<s::force>{{340_Hz, 0.1}, T},
                                        notch<s::force>{{350_Hz, 0.1}, T}, notch<s::force>{{360_Hz, 0.1}, T}};
    double operator()(double x) {
        const auto in = quantity_of<s::force>::from_value(x);
        return (each[0](in) + each[1](in) + each[2](in) + each[3](in)).value();
    }
};
struct notches_in_lanes {
    using number = lanes<4>;
    notch<s::force, number> all{
        {quantity<hertz_unit, number>::from_value(number(std::array{330.0, 340.0, 350.0, 360.0})), number(0.1)},
        T};
    double operator()(double x) {
        const std::array y = all(quantity_of<s::force, number>::from_value(number(x))).value().each();
        return y[0] + y[1] + y[2] + y[3];
    }
};

/// Ways to sum a filter of 90 taps, then ways to have two axes: count(group, name, what makes the step), a
/// group is one filter.
template <class Count> void each_sum(Count&& count) {
    using sums::over_a_window;
    using four = over_a_window<sums::as_in_repetitive, sums::as_in_repetitive::size>;
    using eight = over_a_window<sums::in_sums<8>, sums::in_sums<8>::size>;
    using notches = sums::sections_beside_each_other<biquad_by_hand>;
    const auto taps = sums::repetitive_taps();
    count(0, "~ 90 taps, one sum around a ring", [] { return sums::around_a_ring(); });
    count(0, "~ 90 taps, one sum", [] { return over_a_window<sums::in_sums<1>>(); });
    count(0, "~ 90 taps, four sums (repetitive)", [=] { return four{taps}; });
    count(0, "~ 90 taps, eight sums", [] { return eight(); });
    count(0, "~ 90 taps, half the multiplications", [] { return over_a_window<sums::by_halves>(); });
    count(0, "~ 90 taps, Eigen's dot", [] { return over_a_window<sums::by_eigen>(); });
    count(1, "~ two axes, 90 taps, four sums each", [=] {
        return sums::after_each_other<four>{{taps}, {taps}};
    });
    count(1, "~ two axes in lanes, 90 taps", [] { return sums::taps_beside_each_other(); });
    count(2, "~ two axes, notch by hand", [] {
        return sums::after_each_other<biquad_by_hand>{by_hand(), by_hand()};
    });
    count(2, "~ two axes in lanes, notch by hand", [] { return notches(by_hand()); });
    count(3, "~ four notches, one after the other", [] { return four_notches(); });
    count(3, "~ four notches, lanes<4>", [] { return notches_in_lanes(); });
}

/// count(name, amplitude of the input, what makes the step), always in the same order.
template <class Count> void all(Count&& count) {
    for_each_block([&](const auto& e) {
        count(std::string(e.name).c_str(), e.amplitude, [e] {
            return [block = e(values<double>{})](double x) mutable {
                using block_type = std::remove_cvref_t<decltype(block)>;
                return block(input_of<block_type, double>::from_value(x)).value();
            };
        });
    });
    count("= notch by hand, no checks", 64, by_hand);
    count("= notch as Eigen state space, no checks", 64, by_eigen);
    count("= predictive, horizon 20", 0.125, predicting<20>);
    count("= predictive, horizon 50", 0.125, predicting<50>);
    count("= milling_axis", 1e-5, one<>);
    count("= milling_axis, friction", 1e-5, one<friction_law>);
    count("= milling_axis, friction, observer", 1e-5, one<friction_law, observer>);
    count("= milling_axis, friction, observer, memory", 1e-5, one<friction_law, observer, memory>);
    count("= two axes of milling_axis", 1e-5, two<>);
    count("= two axes of milling_axis, friction, observer, memory", 1e-5, two<friction_law, observer, memory>);
    each_sum([&](int, const char* name, auto make) { count(name, 1, make); });
}

/// The sums of a group are one filter, to rounding: looked at before anything is counted.
inline bool same_sums() {
    bool same = true;
    std::vector<double> first;
    int of = -1;
    each_sum([&](int group, const char*, auto make) {
        auto step = make();
        std::vector<double> y;
        for (const double x : input(1)) y.push_back(step(x));
        if (group != of) first = y;
        of = group;
        for (std::size_t k = 0; k < y.size(); ++k) same = same && std::abs(y[k] - first[k]) < 1e-12;
    });
    return same;
}
/// The three notches are one filter: looked at before anything is counted.
inline bool same_notch() {
    auto typed = notch<s::force>({330_Hz, 0.1}, T);
    auto hand = by_hand();
    auto eigen = by_eigen();
    for (const double x : input(64)) {
        const double y = typed(quantity_of<s::force>::from_value(x)).value();
        if (std::abs(hand(x) - y) > 1e-11 || std::abs(eigen(x) - y) > 1e-11) return false;
    }
    return true;
}
} // namespace counted
