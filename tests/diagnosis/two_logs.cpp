// SPDX-License-Identifier: BSL-1.0
// Where the searches for effects begin in the record of a servo that holds two logs, and how far they go.
#include <doctest/doctest.h>
#include <quadrant/diagnosis/effect/effects.hpp>

#include <cmath>
#include <numbers>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.005;

/// Strokes to and fro in two logs of 800 and 500 rows, a residual force that each of them has by its own time,
/// and what the searches of an effect begin with.
struct two_logs {
    driven_motion drive{};
    std::vector<double> position{};
    axis_record record;
    std::vector<double> residual{};
    plant_model leader{};
    plant_description described{};
    tolerance_description tolerance{};

    template <class Force> explicit two_logs(const Force& force) {
        drive.begins.push_back({800, 0});
        for (int k = 0; k < 1300; ++k) {
            const double t = period * (k < 800 ? k : k - 800), turn = 2 * std::numbers::pi * 0.5 * t;
            position.push_back(0.1 * std::sin(turn));
            record.velocity.push_back(0.1 * std::numbers::pi * std::cos(turn));
            residual.push_back(force(t, record.velocity.back()));
        }
        record.position = position;
        record.period = period;
        record.bandwidth_Hz = 40;
        record.scale = {.travel = 0.2, .speed = 0.3, .command = 1, .count = 1e-5, .corner_Hz = 20};
        record.observer.drive = &drive;
        leader.force_constant = 1;
        leader.friction.coulomb = 0.01;
    }
    two_logs(const two_logs&) = delete; // the record looks at its parts
    two_logs& operator=(const two_logs&) = delete;
    std::vector<std::vector<parameter>> of(const effect& e) const {
        return e.starts({described, tolerance, record, leader, residual, residual});
    }
};

} // namespace

TEST_CASE("starts in two logs: a process force has the time of each log, and is found with its frequency") {
    const two_logs both(
        [](double t, double) { return 0.05 * std::sin(2 * std::numbers::pi * 14.2 * t + 0.4); });
    bool found = false;
    for (const auto& start : both.of(suspect::cutting_force))
        found = found || std::abs(1 / start.front().start - 14.2) < 0.05;
    CHECK(found);
    const auto time = detail::times_in_their_logs(
        {both.described, both.tolerance, both.record, both.leader, both.residual, both.residual});
    CHECK(time[799] == doctest::Approx(799 * period));
    CHECK(time[800] == 0);
    CHECK(time[1299] == doctest::Approx(499 * period));
}

TEST_CASE("starts in two logs: a friction that falls as the axis warms is looked for in the first one") {
    // Down by half with a time of 0.6 s, in both.
    const two_logs both([](double t, double v) { return std::copysign(0.005 * (1 - std::exp(-t / 0.6)), -v); });
    const auto starts = both.of(suspect::friction_drift);
    REQUIRE(starts.size() == 2);
    // 0.15 of the duration, which is that of the first log.
    CHECK(starts[0][1].start == doctest::Approx(0.15 * 800 * period));
    CHECK(starts[0][0].start * starts[0][1].start == doctest::Approx(-0.5).epsilon(0.1));
}

TEST_CASE("starts: static friction is searched up to what the motor can give") {
    const two_logs both([](double, double) { return 0.0; });
    for (const auto& start : both.of(suspect::stribeck_friction))
        CHECK(start[0].high >= both.leader.force_constant * both.record.scale.command);
}

TEST_CASE("a tap's channels: where the axis moves, a mean counts as exactly as it averages the rounding") {
    constexpr double count = 1e-3;
    std::vector<channel> channels{{.mean = 1, .block = 100, .floor = 0.4 * count},
                                  {.mean = 25, .block = 100, .floor = 0.2 * count}};
    for (channel& c : channels) {
        c.first_of_block = {0, 100};
        c.creeping = {1, 0}; // at rest, and in motion
    }
    const auto all = detail::and_tap(channels, 200, count);
    REQUIRE(all.size() == 4);
    CHECK(all[2].least(0) == all[2].least(1)); // row by row no better than the floor
    CHECK(all[2].least(1) == doctest::Approx(0.16e-6));
    CHECK(all[3].least(0) == doctest::Approx(0.04e-6 + 1e-6 / 12 / 25));
    CHECK(all[3].least(1) == doctest::Approx(1e-6 / 12 / 25));
    CHECK(channels[1].least(0) == doctest::Approx(0.04e-6)); // of the position as before
}
