// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/asymmetric_stribeck.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace quadrant;

TEST_CASE(
    "asymmetric_stribeck: in held steps each one adds at most 4e-16 to the relative error, for any speeds") {
    using law = asymmetric_stribeck<>;
    std::mt19937 random(11);
    const auto even = [&] { return double(random()) / 4294967296.0; };
    const auto decades = [&](double low, double high) { return low * std::exp(even() * std::log(high / low)); };
    const auto side = [&] {
        return law::side{quantity_of<signal::torque>::from_value(decades(0.1, 10)),
                         quantity_of<signal::torque>::from_value(decades(0.1, 10)),
                         quantity_of<signal::angular_velocity>::from_value(decades(0.1, 10)),
                         quantity_of<signal::angular_velocity>::from_value(decades(0.1, 10))};
    };
    int steps = 0, reversals = 0, beyond = 0;
    double most = 0; // of the bound
    for (int machine = 0; machine < 20'000; ++machine) {
        const law friction({side(), side(), {}}, quantity<si::time>::from_value(1e-3));
        auto&& held = friction.in_held_steps();
        double w = 4 * even() - 2;
        const double largest = decades(1e-6, 1); // change of speed in a step
        for (int k = 1; k <= 50; ++k, ++steps) {
            const double before = w;
            w += largest * (2 * even() - 1);
            reversals += w * before < 0;
            const auto speed = quantity_of<signal::angular_velocity>::from_value(w);
            const double is = held.slip(speed).value(), should = friction.slip(speed).value();
            const auto& given = w < 0 ? friction.given().backward : friction.given().forward;
            const double parts = given.static_level.value() + given.coulomb.value();
            const double bound = 4e-16 * (k + 1) * parts;
            beyond += !(std::abs(is - should) <= bound);
            most = std::max(most, std::abs(is - should) / bound);
        }
    }
    CHECK(steps == 1'000'000);
    CHECK(reversals > 5'000);
    CHECK(beyond == 0);
    CHECK(most > 0.05); // the sums were used
}
