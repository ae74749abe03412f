// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/block/taps.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
struct wires {
    quantity<si::length> error;
    quantity<si::force> force;
    quantity<si::force> friction;
};
constexpr std::array every{tap<signal::position, &wires::error>("error"),
                           tap<signal::force, &wires::force>("force"),
                           tap<signal::force, &wires::friction>("friction")};
static_assert(every_wire_has_a_tap(every));
constexpr std::array forgotten{tap<signal::position, &wires::error>("error"),
                               tap<signal::force, &wires::force>("force")};
static_assert(!every_wire_has_a_tap(forgotten));
constexpr std::array twice{tap<signal::position, &wires::error>("error"),
                           tap<signal::force, &wires::force>("force"),
                           tap<signal::force, &wires::force>("friction")};
static_assert(!every_wire_has_a_tap(twice));
} // namespace

TEST_CASE("taps: make a header with units and a row of values, in the order of the list") {
    const wires w{3_um, 4_N, -5_N};
    std::string header, row;
    for_each_tap(w, every, [&](const char* name, const char* unit, double value) {
        header += std::string(name) + " [" + unit + "],";
        row += std::to_string(value) + ",";
    });
    CHECK(header == "error [m],force [N],friction [N],");
    CHECK(row == "0.000003,4.000000,-5.000000,");
}
TEST_CASE("taps: read the struct they are given, not the one they were made beside") {
    wires a{}, b{};
    b.force = 2_N;
    double sum = 0;
    for_each_tap(a, every, [&](auto, auto, double value) { sum += value; });
    CHECK(sum == 0);
    for_each_tap(b, every, [&](auto, auto, double value) { sum += value; });
    CHECK(sum == 2);
}
