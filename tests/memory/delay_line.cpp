// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/memory/delay_line.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
using late = delay_line<signal::force, 5>;

TEST_CASE("delay_line: of length 3 it gives every sample back three periods later, zeros before") {
    late d{{.length = 3}, 500_us};
    for (int k = 1; k <= 20; ++k) CHECK(d(double(k) * 1_N).value() == (k > 3 ? k - 3 : 0));
}
TEST_CASE("delay_line: every length up to the capacity, 0 being a piece of wire") {
    for (std::size_t n = 0; n <= 5; ++n) {
        late d{{.length = n}, 500_us};
        for (int k = 1; k <= 20; ++k) CHECK(d(double(k) * 1_N).value() == (k > int(n) ? k - int(n) : 0));
    }
    delay_line<signal::force, 0> wire{{.length = 0}, 500_us};
    CHECK(wire(3_N) == 3_N);
}
TEST_CASE("delay_line: a length that changes on the way reads what was put in, never anything else") {
    late d{{.length = 0}, 500_us};
    std::vector<double> in;
    unsigned seed = 1;
    for (int k = 1; k <= 500; ++k) {
        seed = seed * 1664525u + 1013904223u;
        const std::size_t n = (seed >> 16) % 6;
        d.length(n);
        CHECK(d.length() == n);
        in.push_back(k);
        CHECK(d(double(k) * 1_N).value() == (in.size() > n ? in[in.size() - 1 - n] : 0));
    }
}
TEST_CASE("delay_line: after settle a longer delay reads the settled value") {
    late d{{.length = 0}, 500_us};
    d.settle(7_N);
    d.length(5);
    CHECK(d(1_N) == 7_N);
}
TEST_CASE("delay_line: a length above the capacity saturates, and it says so") {
    late d{{.length = 1}, 500_us};
    d.length(6);
    CHECK(d.limited());
    CHECK(d.length() == 5);
    d.length(5);
    CHECK_FALSE(d.limited());
    d.length(9);
    d.reset(); // as new: the length of the parameters
    CHECK(d.length() == 1);
    CHECK_FALSE(d.limited());
}
TEST_CASE("delay_line: refuses to be built longer than its capacity") {
    CHECK_THROWS_WITH_AS((late{{.length = 6}, 1_ms}), "delay_line.length = 6: must not exceed the capacity (5)",
                         invalid_parameter);
}
