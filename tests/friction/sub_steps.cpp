// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/stick_slip.hpp>
#include <quadrant/friction/stribeck.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

TEST_CASE(
    "stick_slip: a law in sub-steps, which looks ahead, gives the motion of the law itself, through stops and "
    "reversals") {
    std::mt19937 random(7);
    const auto even = [&] { return double(random()) / 4294967296.0; };
    double off = 0;
    int stops = 0, reversals = 0, steps = 0;
    for (int machine = 0; machine < 200; ++machine) {
        const double level = 1 + 200 * even(), mass = std::exp(even() * 7),
                     h = std::exp(std::log(1e-6) + even() * std::log(1e3));
        const stribeck<> law({level * 1_N, level * (1 + even()) * 1_N,
                              std::exp(std::log(1e-4) + even() * std::log(1e3)) * 1_mps, 10_N / 1_mps},
                             500_us);
        quantity_of<signal::velocity> v{}, w{};
        double drive = 0;
        for (int period = 0; period < 40; ++period) {
            drive = period % 7 == 0 ? 0 : level * (8 * even() - 4);
            auto&& ahead = in_sub_steps(law); // as a plant does, anew in each period
            for (int i = 0; i < 25; ++i, ++steps) {
                const auto before = v;
                v = stick_slip<double>(law, mass * 1_kg, v, drive * 1_N, h * 1_s);
                w = stick_slip<double>(ahead, mass * 1_kg, w, drive * 1_N, h * 1_s);
                stops += v.value() == 0 && before.value() != 0;
                reversals += v.value() * before.value() < 0;
                const double size = std::abs(before.value()) + std::abs(drive) * h / mass + std::abs(v.value());
                if (size > 0) off = std::max(off, std::abs((v - w).value()) / size);
                w = v; // each sub-step for itself: what two solutions differ by does not add up
            }
        }
    }
    CHECK(steps == 200'000);
    CHECK(stops > 100);
    CHECK(reversals > 100);
    CHECK(off < 1e-12);
}
