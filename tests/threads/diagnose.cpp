// SPDX-License-Identifier: BSL-1.0
#include "diagnosis/workshop.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <doctest/doctest.h>
#include <thread>

using namespace quadrant::diagnosis;

TEST_CASE("diagnose: two axes of two machines in two threads say what they say one after the other") {
    const workshop::machine plain;
    const auto file = workshop::described(plain);
    workshop::machine heavy = plain, tilted = plain;
    heavy.mass = 225;
    tilted.constant_force = 25;
    const auto a = workshop::as_log(workshop::run(heavy, 3)), b = workshop::as_log(workshop::run(tilted, 3));
    diagnosis_result one, two;
    std::thread first([&] { one = diagnose(file, a); }), second([&] { two = diagnose(file, b); });
    first.join();
    second.join();
    const auto again = diagnose(file, a);
    REQUIRE(!one.causes.empty());
    REQUIRE(!two.causes.empty());
    CHECK(one.causes[0].effect == "mass");
    CHECK(two.causes[0].effect == "constant_force");
    CHECK(one.causes[0].probability == again.causes[0].probability);
    CHECK(one.axes[0].signals.residual_after == again.axes[0].signals.residual_after);
}
