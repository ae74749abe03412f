// SPDX-License-Identifier: BSL-1.0
// One link of a chain of positions, judged alone: two readings whose difference is written down here.
#include <quadrant/diagnosis/chain/outcome.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

using namespace quadrant::diagnosis;
using namespace quadrant::diagnosis::chain;

namespace {

constexpr double period = 0.01, travel = 0.08, count = 1e-7, turn = 0.01;

/// A motion to and fro over the whole travel, and shorter ones, at three speeds.
std::vector<double> moves() {
    std::vector<double> x{0};
    const auto go = [&](double to, double speed) {
        const double from = x.back();
        const auto rows = static_cast<int>(std::abs(to - from) / (speed * period));
        for (int k = 1; k <= rows; ++k) x.push_back(from + (to - from) * k / rows);
    };
    for (int round = 0; round < 4; ++round) {
        go(travel, 0.02);
        go(0.3 * travel, 0.035);
        go(0.7 * travel, 0.011);
        go(0, 0.03);
    }
    return x;
}
/// A scale that reads the first position and what `beside` adds to it in each row, in whole counts.
position_link read_beside(const std::vector<double>& first, const std::function<double(std::size_t)>& beside) {
    position_link l{.period = period, .first = first, .first_count = count, .last_count = count, .turn = turn};
    for (std::size_t k = 0; k < first.size(); ++k)
        l.last.push_back(count * std::round((first[k] + beside(k)) / count));
    return l;
}
std::vector<double> behind_a_play(const std::vector<double>& x, double width) {
    return play_of(x, width).offset;
}
answer found_on(const position_link& l) { return seeker(readings(l), {}, {}, rules()).find(); }

} // namespace

TEST_CASE("link: a wave of 0.49 turns is no error of the screw, one of half a turn is") {
    const auto x = moves();
    for (const double part : {0.49, 0.5}) {
        const answer a = found_on(read_beside(x, [&](std::size_t k) {
            return 4e-6 * std::sin(2 * std::numbers::pi * x[k] / (part * turn) + 1);
        }));
        REQUIRE(a.findings.size() == 1);
        CHECK(a.findings[0].what == (part == 0.5 ? term::pitch : term::cyclic));
        CHECK(a.findings[0].probability > 0.9);
    }
}

TEST_CASE("link: no play is narrower than nothing, in the middle of the travel or at its ends") {
    const auto x = moves();
    const auto play = behind_a_play(x, 6e-6);
    const auto with_play = [&](const std::function<double(std::size_t)>& times) {
        const readings r(read_beside(x, [&](std::size_t k) { return times(k) * play[k]; }));
        return with_term(r, fit_columns(r, {}), term::play, rules().margin).model.has(term::play);
    };
    CHECK(with_play([](std::size_t) { return 1; }));
    CHECK(with_play([&](std::size_t k) { return 0.5 + x[k] / travel; })); // worn at one end
    CHECK_FALSE(with_play([](std::size_t) { return -1; }));               // a lead after each reversal
    CHECK_FALSE(with_play([&](std::size_t k) { return -1 + 4 * x[k] / travel; }));
}

TEST_CASE("link: what jumps from one row to the next is a missed step, what comes in two seconds is none") {
    const auto x = moves();
    const auto jumps = [&](double seconds) {
        const readings r(read_beside(x, [&](std::size_t k) {
            return 2e-5 * std::clamp((static_cast<double>(k) * period - 10) / seconds, 0.0, 1.0);
        }));
        return with_steps(r, fit_columns(r, {}), rules().margin).model.steps;
    };
    const auto at = jumps(1e-9);
    REQUIRE(at.size() == 1);
    CHECK(std::abs(static_cast<double>(at[0]) * period - 10) <= period);
    CHECK(jumps(2).empty());
}

TEST_CASE("link: described play and delay are moved inside their tolerances, and one that ends there is held "
          "while the other is found") {
    const auto x = moves();
    axis_description axis;
    axis.name = "x";
    axis.transmission.backlash_m = 2e-5;
    axis.drive.command_delay_s = 0.04;
    axis.tolerance.given = {{"backlash", 0.1}, {"command_delay", 0.1}};
    for (const double wider : {1.06, 1.5}) {
        const auto late = delayed(x, period, 1.05 * 0.04);
        const auto play = behind_a_play(late, wider * 2e-5);
        described_link d{.readings = read_beside(x, [&](std::size_t k) { return late[k] + play[k] - x[k]; }),
                         .described = {}};
        d.readings.asked = true;
        d.described.play = 2e-5;
        d.described.delay = 0.04;
        std::vector<parameter_estimate> moved;
        const described_link out = calibrated_link(readings(d.readings), d, axis, rules(), moved);
        // The part of the play that its tolerance does not hold looks like lateness, at the slowest speed most.
        const double late_by_play = (wider - std::min(wider, 1.1)) * 2e-5 / 2 / 0.011;
        CHECK(std::abs(out.described.delay - 1.05 * 0.04) < 0.002 * 0.04 + late_by_play);
        CHECK(std::abs(out.described.play / (std::min(wider, 1.1) * 2e-5) - 1) < 0.01);
        CHECK(moved.size() == 2);
    }
}
