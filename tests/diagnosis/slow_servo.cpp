// SPDX-License-Identifier: BSL-1.0
// A hobby servo between two positions, asked and reached, a few rows a second: what it was asked bends within a
// row wherever it moves.
#include "claims.hpp"

#include <quadrant/diagnosis/chain/readings.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using namespace quadrant::diagnosis;
using workshop::said;
using workshop::value_of;

namespace {

constexpr double period = 0.1, count = 0.00153398;

/// How a servo follows, in steps of a millisecond.
struct servo {
    double late, fastest, softness; ///< [s], [rad/s], 1 / gain [s]
    double shortest_move = 0.2;     ///< [s]
};

/// A hand that trembles leads it: moves of all speeds, and rests. The servo is late, never faster than it can,
/// and behind a soft loop.
std::string led_by_hand(const servo& s, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    constexpr double h = 1e-3;
    std::vector<double> asked;
    double at = 0;
    while (asked.size() < 40000) {
        const double to = 0.8 * (u(random) - 0.5);
        const double lasts = s.shortest_move * (1 + 2 * u(random)), rests = 0.3 + 0.9 * u(random);
        for (double t = 0; t < lasts; t += h) {
            const double part = t / lasts, trembles = std::sin(3.1 * 2 * std::numbers::pi * t);
            asked.push_back(at + (to - at) * (3 - 2 * part) * part * part +
                            0.008 * trembles * std::sin(std::numbers::pi * part));
        }
        at = to;
        for (double t = 0; t < rests; t += h) asked.push_back(at);
    }
    std::string out = "t_s,q_ref_rad,q_pos_rad\n";
    double target = 0, q = 0;
    for (std::size_t k = 0; k < 40000; ++k) {
        const double then = asked[k - std::min(k, static_cast<std::size_t>(s.late / h))];
        target += std::clamp(then - target, -s.fastest * h, s.fastest * h);
        q = s.softness > 0 ? q + h / s.softness * (target - q) : target;
        if (k % 100) continue;
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.6f,%.8f\n", static_cast<double>(k) * h, asked[k],
                      count * std::round(q / count));
        out += row;
    }
    return out;
}
diagnosis_result diagnosed_servo(const servo& s, const std::string& drive = "") {
    const std::string file = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.1, "axes": {"q": {)" +
                             drive + R"("encoder": {"resolution_rad": 0.00153398}}}})";
    std::istringstream log(led_by_hand(s, 3));
    return diagnose(read_machine(file, "machine.json"), read_log(log, "log.csv"));
}

} // namespace

TEST_CASE("positions: what a servo is asked bends in every row that moves, and it is late: a gap") {
    const auto d = diagnosed_servo({0.13, 1e3, 0, 0.1});
    CAPTURE(said(d));
    REQUIRE(!d.causes.empty());
    CHECK(d.axes.at(0).gap.position_rms_m > 0.03);
    CHECK(d.causes[0].group_probability > 0.5);
}

TEST_CASE("positions: rows in which what is asked bends count where the axis moves in no others") {
    // Ramps of six rows and long rests, followed one row later.
    chain::position_link link{.period = period, .first = {}, .last = {}, .last_count = count};
    link.asked = true;
    const auto asked = [](int k) {
        return 0.02 * (std::max(k, 0) / 40 * 6 + std::min(std::max(k, 0) % 40, 6));
    };
    for (int k = 0; k < 400; ++k) {
        link.first.push_back(asked(k));
        link.last.push_back(asked(k - 1));
    }
    const auto late = [&] {
        const chain::readings r(link);
        return std::count_if(r.rows().begin(), r.rows().end(),
                             [&](std::size_t k) { return std::abs(link.last[k] - link.first[k]) > 0.01; });
    };
    CHECK(late() > 40);
    // Behind a long smooth motion the same ramps are left out.
    std::vector<double> smooth;
    for (int k = 0; k < 800; ++k) smooth.push_back(9 * (std::cos(0.01 * k) - std::cos(8.0)));
    for (auto* side : {&link.first, &link.last}) side->insert(side->begin(), smooth.begin(), smooth.end());
    CHECK(late() < 10);
}

TEST_CASE("positions: a servo that is late and never faster than its profile velocity") {
    const auto d = diagnosed_servo({0.22, 1.2, 0});
    CAPTURE(said(d));
    REQUIRE(d.causes.size() >= 2);
    for (const cause& c : d.causes) {
        if (c.probability < 0.5) continue;
        if (c.effect == "setpoint_rate_limit")
            CHECK(value_of(c, "drive.setpoint_rate_limit_rad_per_s").value ==
                  doctest::Approx(1.2).epsilon(0.1));
        else {
            CHECK(c.effect == "command_delay");
            CHECK(value_of(c, "drive.command_delay_s").value == doctest::Approx(0.22).epsilon(0.15));
        }
    }
    const auto has = [&](const char* effect) {
        return std::any_of(d.causes.begin(), d.causes.end(),
                           [&](const cause& c) { return c.effect == effect && c.group_probability > 0.5; });
    };
    CHECK(has("setpoint_rate_limit"));
    CHECK(has("command_delay"));
    // With both described nothing is left to say.
    const auto again = diagnosed_servo({0.22, 1.2, 0}, R"("drive": {"command_delay_s": 0.22,
        "setpoint_rate_limit_rad_per_s": 1.2}, )");
    CAPTURE(said(again));
    CHECK(again.verdict <= verdict::within_tolerance);
}

TEST_CASE("positions: a servo that does not keep up has no wrong ratio, and no pitch that turns it back") {
    const auto d = diagnosed_servo({0.1, 0.7, 0.25});
    CAPTURE(said(d));
    CHECK(d.verdict != verdict::no_gap);
    for (const cause& c : d.causes) {
        if (c.probability < 0.5) continue;
        CHECK(c.effect != "scale_error");
        CHECK(c.effect != "pitch_error");
        CHECK(c.effect != "travel_error");
    }
}

TEST_CASE("positions: a profile velocity is of the set-points, whatever the screw makes of them") {
    // Counted as half of what it travels: 1.2 rad/s asked are 2.4 of the load.
    const std::string log = led_by_hand({0.22, 1.2, 0}, 3);
    std::string twice = "t_s,q_ref_rad,q_pos_rad\n";
    std::istringstream rows(log.substr(log.find('\n') + 1));
    for (std::string row; std::getline(rows, row);) {
        double t = 0, asked = 0, q = 0;
        std::sscanf(row.c_str(), "%lf,%lf,%lf", &t, &asked, &q);
        char out[80];
        std::snprintf(out, sizeof out, "%.6f,%.6f,%.8f\n", t, asked, 2 * q);
        twice += out;
    }
    const auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.1, "axes": {"q": {
        "drive": {"command_delay_s": 0.22, "setpoint_rate_limit_rad_per_s": 1.2},
        "transmission": {"counted_per_turn_rad": 0.5, "travel_per_turn_rad": 1},
        "encoder": {"resolution_rad": 0.00306796}}}})"),
        "machine.json");
    std::istringstream file(twice);
    const auto d = diagnose(machine, read_log(file, "log.csv"));
    CAPTURE(said(d));
    CHECK(d.verdict <= verdict::within_tolerance);
    CHECK(d.causes.empty());
}
