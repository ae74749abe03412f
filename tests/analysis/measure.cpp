// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/measure.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace quadrant;

TEST_CASE("measure: takes loops that return, loops that keep what they made, and lambdas written in the call") {
    struct keeps {
        double y = 0;
        int calls = 0;
        void operator()(double x) noexcept { y = 0.5 * y + x, ++calls; }
    } loop;
    const std::vector<double> in{1, 2, 3};
    CHECK(measure(loop, in, 1000).ns.size() == 1000);
    CHECK(loop.calls == 1003); // the first pass over the inputs is not counted
    CHECK(loop.y > 1);
    int calls = 0;
    const call_times t = measure([&](double x) { return ++calls, x; }, std::array{1.0, 2.0}, 2);
    CHECK(t.ns.size() == 2);
    CHECK(calls == 2);
    CHECK(t.median() <= t.longest());
    CHECK(t.longest() > 0);
}
TEST_CASE("measure: without inputs or calls there are no times, and no figure is made up") {
    const auto loop = [](double x) { return x; };
    CHECK(measure(loop, std::vector<double>{}).ns.empty());
    const call_times none = measure(loop, std::vector<double>{1}, 0);
    CHECK(none.ns.empty());
    CHECK(std::isnan(none.median()));
    CHECK(std::isnan(none.longest()));
}
