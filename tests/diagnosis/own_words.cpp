// SPDX-License-Identifier: BSL-1.0
#include <doctest/doctest.h>
#include <quadrant/diagnosis/verdict/own_words.hpp>

using namespace quadrant::diagnosis;

TEST_CASE("an interval ends at zero where the key of the machine file does") {
    std::vector<parameter_estimate> found{{.key = "coulomb_N", .values = {{1.1, -0.1, 2.3}}},
                                          {.key = "mode_damping", .values = {{0.3, -5, 5.6}}},
                                          {.key = "constant_force_N", .values = {{0.5, -0.1, 1.1}}},
                                          {.key = "viscous_asymmetry", .values = {{-0.1, -0.3, 0.1}}}};
    detail::put_in_words(axis_kind::rotary, found);
    CHECK(found[0].key == "coulomb_Nm");
    CHECK(found[0].values[0].low == 0);
    CHECK(found[1].values[0].low == 0);
    CHECK(found[2].values[0].low == -0.1);
    CHECK(found[3].values[0].low == -0.3);
    for (const auto& p : found) CHECK(p.values[0].high > 0.05);
}
