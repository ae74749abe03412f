// SPDX-License-Identifier: BSL-1.0
// With QUADRANT_TESTS=all. Compiled with -O3 -ffast-math, by which a compiler may take it that there is no NaN:
// the policy of every block still holds.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "../conformance/faults.cpp"
#include "../conformance/standstill.cpp"

TEST_CASE("every block: a NaN parameter is refused, whichever it is") {
    int refused = 0;
    for_each_block([&](const auto& e) {
        CAPTURE(e.name);
        values<double> counter;
        e.make(counter);
        for (std::size_t i = 0; i < counter.count; ++i) {
            CAPTURE(i);
            bool made = true;
            try {
                e(values<double>{.bumped = i, .factor = std::numeric_limits<double>::quiet_NaN()});
            } catch (const invalid_parameter&) {
                made = false;
            }
            CHECK_FALSE(made);
            refused += !made;
        }
    });
    CHECK(refused > 200);
}
