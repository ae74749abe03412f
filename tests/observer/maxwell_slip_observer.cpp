// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/observer/maxwell_slip_observer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using block = maxwell_slip_observer<2>;
using model = maxwell_slip<2>;
const model::parameters friction{.curve = {105_N, 165_N, 1_mmps, 55_N / 1_mps},
                                 .weights = {0.6, 0.4},
                                 .forces = {},
                                 .stiffness = {60e6 * 1_N / 1_m, 2e6 * 1_N / 1_m},
                                 .attraction = 1000_N / 1_s};
const duration T = 500_us;
/// 30 mm to either side, 100 mm/s at most.
quantity<si::velocity> swing(int k) { return 0.1 * std::sin(0.1 / 0.03 * 5e-4 * k) * 1_mps; }
} // namespace

TEST_CASE("maxwell_slip_observer: with nothing left to learn it is the model") {
    block learns({friction, 300_ms}, T);
    model alone(friction, T);
    for (int k = 0; k < 8000; ++k)
        CHECK(learns(swing(k)).value() == doctest::Approx(alone(swing(k)).value()).epsilon(1e-12).scale(100));
    CHECK(learns.level() == 1);
}

TEST_CASE("maxwell_slip_observer: finds by how much the machine's springs are stronger, exponentially") {
    // The machine: the model times 1.3, viscous part the same; an observer says exactly what is missing.
    block learns({friction, 300_ms}, T);
    model machine(friction, T);
    const double truth = 1.3;
    double level = 1; // the same equation, written out
    for (int k = 0; k < 6000; ++k) {
        const auto v = swing(k);
        const double f = machine(v).value() - 55 * v.value();
        const auto left = (truth - learns.level()) * f * 1_N;
        level += 5e-4 / 0.3 * (truth - level) * f * f / (105 * 105);
        learns(v, left);
        CHECK(learns.level() == doctest::Approx(level).epsilon(1e-9));
    }
    CHECK(learns.level() == doctest::Approx(truth).epsilon(1e-4)); // ten time constants
    const auto v = swing(100);
    block again = learns;
    model beside = machine;
    CHECK(again(v).value() ==
          doctest::Approx(truth * (beside(v).value() - 55 * v.value()) + 55 * v.value()).epsilon(1e-4));
}

TEST_CASE("maxwell_slip_observer: a force that does not go with the friction leaves the level where it is") {
    block learns({friction, 300_ms}, T);
    double furthest = 0;
    for (int k = 0; k < 40000; ++k) {
        learns(swing(k), 60 * std::cos(2 * std::numbers::pi * 23.3 * 5e-4 * k) * 1_N);
        furthest = std::max(furthest, std::abs(learns.level() - 1));
    }
    CHECK(furthest < 0.03);
}

TEST_CASE(
    "maxwell_slip_observer: the level stays within its bounds, through settle, and is forgotten by reset") {
    block learns({friction, 300_ms, 0.8, 1.2}, T);
    for (int k = 0; k < 2000; ++k) learns(10_mmps, 200_N);
    CHECK(learns.level() == 1.2);
    learns.settle(10_mmps);
    CHECK(learns.level() == 1.2);
    const double standing = learns(10_mmps).value();
    CHECK(learns(10_mmps).value() == doctest::Approx(standing).epsilon(1e-12));
    block narrower({friction, 300_ms, 0.9, 1.1}, T);
    learns.retune(narrower);
    CHECK(learns.level() == 1.1);
    for (int k = 0; k < 2000; ++k) learns(10_mmps, -200_N);
    CHECK(learns.level() == 0.9);
    learns.reset();
    CHECK(learns.level() == 1);
}

TEST_CASE("maxwell_slip_observer: refuses what it cannot run, and holds through NaN") {
    const auto message = [](const block::parameters& p) -> std::string {
        try {
            block(p, T);
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return {};
    };
    CHECK(message({friction, 0_ms}).find("maxwell_slip_observer.settles_in = 0") == 0);
    CHECK(message({friction, 300_ms, 0, 2}).find("maxwell_slip_observer.lowest = 0") == 0);
    CHECK(message({friction, 300_ms, 0.5, 0.9}).find("maxwell_slip_observer.highest = 0.9") == 0);
    auto bad = friction;
    bad.attraction = {};
    CHECK(message({bad, 300_ms}).find("maxwell_slip.attraction") == 0);
    block learns({friction, 300_ms}, T);
    const auto last = learns(10_mmps, 5_N);
    const double level = learns.level();
    CHECK(learns(10_mmps, std::nan("") * 1_N) == last);
    CHECK(learns.faulted());
    CHECK(learns.level() == level);
}
