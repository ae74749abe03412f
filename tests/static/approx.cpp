// SPDX-License-Identifier: BSL-1.0
// The comparison that the other tests use (tests/CMakeLists.txt).
#include <doctest/doctest.h>

TEST_CASE("Approx compares by the size of the numbers, however small they are") {
    CHECK(1.00001e-6 == doctest::Approx(1e-6));
    CHECK(1.001e-6 != doctest::Approx(1e-6));
    CHECK(1.04e-12 == doctest::Approx(1e-12).epsilon(0.05));
    CHECK(1.06e-12 != doctest::Approx(1e-12).epsilon(0.05));
    CHECK(0.0 == doctest::Approx(0));
    CHECK(1e-9 != doctest::Approx(0));
    CHECK(1e-9 == doctest::Approx(0).scale(1));
}
