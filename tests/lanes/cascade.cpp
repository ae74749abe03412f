// SPDX-License-Identifier: BSL-1.0
#include "blocks.hpp"

#include <quadrant/base/lanes.hpp>

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <vector>

using namespace lanes_conformance;

namespace {
/// The boxes of cascade_p_pi without its friction, which has a test of its own.
template <class R> struct boxes {
    explicit boxes(own<R> p)
        : reference_velocity({}, T), reference_acceleration({}, T), measured_velocity({p(150_Hz)}, T),
          position_loop({p(41.0 / 1_s)}, T), velocity_feedforward({p(0.9)}, T),
          velocity_loop({p(25_V / 1_mps), p(900_V / 1_m), p(6_V)}, T), resonance({p(330_Hz), p(0.2)}, T),
          acceleration_feedforward({p(0.1_V / 1_mps2)}, T), friction({}, T), amplifier({p(-6_V), p(6_V)}, T),
          dac({p(0.0003_V)}, T) {}

    backward_difference<s::position, s::velocity, R> reference_velocity;
    backward_difference<s::velocity, s::acceleration, R> reference_acceleration;
    filtered_derivative<s::position, s::velocity, R> measured_velocity;
    proportional<s::position, s::velocity, R> position_loop;
    proportional<s::velocity, s::velocity, R> velocity_feedforward;
    proportional_integral<s::velocity, s::voltage, conditional_integration, R> velocity_loop;
    notch<s::voltage, R> resonance;
    proportional<s::acceleration, s::voltage, R> acceleration_feedforward;
    absent<s::velocity, s::voltage, R> friction;
    limiter<s::voltage, R> amplifier;
    quantizer<s::voltage, R> dac;
};
template <class R> using loop_of = cascade<boxes<R>>;
template <class R> quantity_of<s::position, R> at(R x) { return quantity_of<s::position, R>::from_value(x); }
} // namespace

TEST_CASE_TEMPLATE(
    "lanes: a whole cascade steps as W cascades in double do, bit for bit, on every wire and with faults", L,
    lanes<2>, lanes<4>) {
    constexpr std::size_t W = L::size;
    loop_of<L> all{.box = boxes<L>({})};
    std::vector<loop_of<double>> each;
    for (std::size_t i = 0; i < W; ++i) each.push_back({.box = boxes<double>({.which = i})});
    const boxes<L> next({.count = 3});

    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 1e-6);
    bool limited = false, faulted = false;
    for (int k = 0; k < 3000; ++k) {
        std::array<double, W> r, x;
        for (std::size_t i = 0; i < W; ++i) {
            r[i] = 0.03 * std::sin(0.02 * double(i + 1) * k) + (k % 500 > 400 ? 0.01 : 0);
            x[i] = 0.97 * r[i] + noise(random);
        }
        if (k % 90 > 70) r[std::size_t(k) % W] = std::numeric_limits<double>::quiet_NaN();
        if (k % 130 > 110) x[std::size_t(k / 2) % W] = std::numeric_limits<double>::infinity();
        const L u(1.5);
        if (k % 300 == 50 || k % 300 == 75) {
            all.settle(
                {.reference = at(L(r)), .measured = at(L(x)), .command = loop_of<L>::command::from_value(u)});
            for (std::size_t i = 0; i < W; ++i)
                each[i].settle({.reference = at(r[i]), .measured = at(x[i]), .command = 1.5_V});
        } else if (k % 300 >= 150 && k % 300 < 175) {
            all.track(at(L(r)), at(L(x)), loop_of<L>::command::from_value(u));
            for (std::size_t i = 0; i < W; ++i) each[i].track(at(r[i]), at(x[i]), 1.5_V);
        } else if (k == 1000) {
            all.retune(next);
            for (std::size_t i = 0; i < W; ++i) each[i].retune(boxes<double>({.which = i, .count = 3}));
        } else if (k == 2000) {
            all.reset();
            for (auto& one : each) one.reset();
        } else {
            all(at(L(r)), at(L(x)));
            for (std::size_t i = 0; i < W; ++i) each[i](at(r[i]), at(x[i]));
        }
        CAPTURE(k);
        for (std::size_t i = 0; i < W; ++i) {
            CAPTURE(i);
            for (std::size_t wire = 0; wire < all.taps().size(); ++wire) {
                CAPTURE(all.taps()[wire].name);
                REQUIRE(all.taps()[wire].read(all.wire)[i] == each[i].taps()[wire].read(each[i].wire));
            }
            REQUIRE(all.faulted_lanes()[i] == each[i].faulted());
            limited = limited || each[i].limited();
            faulted = faulted || each[i].faulted();
        }
    }
    CHECK(limited); // both happened
    CHECK(faulted);
}
