// SPDX-License-Identifier: BSL-1.0
#include <quadrant/filter/second_order.hpp>
#include <quadrant/literals.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr double most = std::numeric_limits<double>::max();
struct section {
    second_order_coefficients<double> c;
    second_order_state<signal::force, double> state{};
    held_output<quantity<si::force>> out{};
    double operator()(double x) { return step(c, state, out, x * 1_N).value(); }
};
} // namespace

TEST_CASE("second_order: the difference equation, bit for bit where its numbers are exact") {
    section f{{.b0 = 0.5, .b1 = 0.25, .b2 = -1, .a1 = -0.5, .a2 = 0.25}};
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    for (int k = 0; k < 8; ++k) {
        const double x = k % 3 - 0.5, y = 0.5 * x + 0.25 * x1 - x2 + 0.5 * y1 - 0.25 * y2;
        CHECK(f(x) == y);
        x2 = x1, x1 = x, y2 = y1, y1 = y;
    }
}
TEST_CASE("second_order: a sample that overflows a state alone is refused as a whole") {
    // y = x is finite, but the state would be 4 x
    section first{{.b0 = 1, .b1 = 4}}, second{{.b0 = 1, .b2 = 4}};
    for (section* f : {&first, &second}) {
        (*f)(1);
        CHECK((*f)(most / 2) == 1);
        CHECK(f->out.faulted());
    }
    CHECK(first(1) == 5); // 1 + 4 of the sample before the bad one
    CHECK(second(1) == 1);
    CHECK(second(1) == 5);
}
