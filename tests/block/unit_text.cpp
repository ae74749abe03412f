// SPDX-License-Identifier: BSL-1.0
// The letters of a unit in messages; expected by hand, from how data sheets write them.
#include <quadrant/base/error.hpp>
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
template <class Value> std::string unit(const Value& value) {
    const char* const letters = detail::unit_of(value);
    return letters != nullptr ? letters : "";
}
} // namespace

TEST_CASE("unit of a value: the SI's own names") {
    CHECK(unit(1_m) == " m");
    CHECK(unit(1_s) == " s");
    CHECK(unit(1_N) == " N");
    CHECK(unit(1_V) == " V");
    CHECK(unit(1_A) == " A");
    CHECK(unit(1_Hz) == " Hz");
    CHECK(unit(1_Nm) == " N m");
    CHECK(unit(1_radps) == " rad/s");
    CHECK(unit(1_kgm2) == " kg m^2");
    CHECK(unit(1_mps2) == " m/s^2");
    CHECK(unit(0.5) == "");
}

TEST_CASE("unit of a value: gains as a data sheet writes them") {
    CHECK(unit(1_V / 1_mps) == " V s/m");
    CHECK(unit(1_V / 1_m) == " V/m");
    CHECK(unit(1_N / 1_V) == " N/V");
    CHECK(unit(1_N / 1_m) == " N/m");
    CHECK(unit(1_N / 1_mps) == " N s/m");
    CHECK(unit(1_V / 1_mps2) == " V s^2/m");
    CHECK(unit(1_mps2 / 1_V) == " m/(V s^2)");
    CHECK(unit(1_V / 1_A) == " V/A");
    CHECK(unit(1.0 / 1_s) == " per s");
    CHECK(unit(1_mps2 / 1_s) == " m/s^3");
}

TEST_CASE("unit of a value: that of every lane, and one that is named where the type has none") {
    using four = lanes<4>;
    CHECK(unit(quantity<si::force, four>::from_value(four(1))) == " N");
    CHECK(unit(detail::in_unit(60, " degrees")) == " degrees");
    CHECK(std::string(detail::shortest(0.5_ms)) == "5e-04 s");
}

TEST_CASE("refused_parameter: block, field, value with its unit, rule; cut off where there is no room") {
    const refused_parameter why{{"notch", ".centre"}, 1200, "must be lower", " Hz"};
    char whole[80], cut[18];
    const std::size_t length = why.write(whole, sizeof whole);
    CHECK(length == std::string(whole).size());
    CHECK(std::string(whole) == "notch.centre = 1200 Hz: must be lower");
    CHECK(why.write(cut, sizeof cut) == length);
    CHECK(std::string(cut) == std::string(whole).substr(0, 17));
}
