// SPDX-License-Identifier: BSL-1.0
// What follows its set-points late: a mill that is logged ten times a second, and a servo that is slow, too.
#include "claims.hpp"
#include "refusal.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/match.hpp>
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

/// Lines of a part program, with corners that are rounded within 0.1 s, followed with a first-order lag of
/// 8 ms by an axis that is logged ten times a second in steps of 0.1 mm.
std::string milled() {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> u(0, 1);
    constexpr double h = 1e-3, lag = 8e-3;
    std::string out = "t_s,y_ref_m,y_pos_m\n";
    double asked = 0, speed = 0, wanted = 0, reached = 0;
    for (int k = 0; k < 100000; ++k) {
        if (k % 700 == 0) wanted = (asked > 0 ? -1 : 1) * (k % 1400 == 0 ? 0.048 : 0.005 + 0.03 * u(random));
        speed += std::clamp(wanted - speed, -0.5 * h, 0.5 * h);
        reached += h / lag * (asked - reached);
        asked += speed * h;
        if (k % 100) continue;
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.4f,%.4f\n", k * h, asked, reached);
        out += row;
    }
    return out;
}
/// Strokes, some of them faster than 30 mm/s, which a follower does not pass; rows of 10 ms, counts of half a
/// micrometre, and each row read up to 0.4 ms late.
std::string limited() {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> u(0, 1);
    constexpr double h = 1e-4, limit = 0.03, count = 5e-7;
    std::string out = "t_s,y_ref_m,y_pos_m\n";
    double asked = 0, speed = 0, wanted = 0, reached = 0, read = 0;
    int late = 0;
    for (int k = 0; k < 600000; ++k) {
        if (k % 7000 == 0)
            wanted = (asked > 0.01 ? -1 : asked < -0.01 ? 1 : u(random) - 0.5) * (0.01 + 0.04 * u(random));
        if (k % 100 == 0) late = static_cast<int>(5 * u(random));
        speed += std::clamp(wanted - speed, -0.4 * h, 0.4 * h);
        reached += std::clamp(asked - reached, -limit * h, limit * h);
        if (k % 100 == late) read = reached;
        if (k % 100 == 5) {
            char row[80];
            std::snprintf(row, sizeof row, "%.4f,%.9f,%.9f\n", (k - 5) * h, asked - 5 * h * speed,
                          std::round(read / count) * count);
            out += row;
        }
        asked += speed * h;
    }
    return out;
}
machine_description mill(const std::string& drive, const std::string& count = "1e-4") {
    return read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 0.1, "axes": {"y": {"drive": {)" + drive +
            R"(}, "encoder": {"resolution_m": )" + count + "}}}}",
        "machine.json");
}
diagnosis_result diagnosed(const machine_description& machine) {
    std::istringstream log(milled());
    return diagnose(machine, read_log(log, "log.csv"));
}

} // namespace

TEST_CASE(
    "positions: a lag of a tenth of a row is found from a gain that is far off, and stands as it is applied") {
    for (const char* described :
         {R"("position_gain_per_s": 20)", R"("position_gain_per_s": 40)", R"("command_delay_s": 0.1)"}) {
        const auto machine = mill(described);
        const auto d = diagnosed(machine);
        CAPTURE(described);
        CAPTURE(said(d));
        REQUIRE(d.causes.size() == 1);
        CHECK(d.causes[0].group_probability > 0.9);
        const auto& found = d.causes[0].parameters.at(0);
        const double late =
            found.key == "drive.command_delay_s" ? found.values[0].value : 1 / found.values[0].value;
        CHECK(late == doctest::Approx(8e-3).epsilon(0.1));
        CHECK(d.axes[0].calibrated.empty());
        const auto again = diagnosed(apply(machine, d));
        CHECK(again.axes[0].gap.position_rms_m ==
              doctest::Approx(d.axes[0].gap_after.position_rms_m).epsilon(0.05));
    }
}

TEST_CASE("positions: a delay and a gain that are not there are taken off, and one that is there stays" *
          doctest::test_suite("all")) {
    struct truth {
        double delay, lag; // [s]
    };
    const auto followed = [](truth t, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> noise(0, 2e-5);
        std::string out = "t_s,y_ref_m,y_pos_m\n";
        double reached = 0;
        const auto asked = [](double s) { return 0.05 * std::sin(1.7 * s) + 0.02 * std::sin(5.1 * s + 1); };
        for (int k = 0; k < 60000; ++k) {
            const double s = 1e-3 * k, then = asked(std::max(0.0, s - t.delay));
            reached = t.lag > 0 ? reached + 1e-3 / t.lag * (then - reached) : then;
            if (k % 20) continue;
            char row[80];
            std::snprintf(row, sizeof row, "%.6f,%.7f,%.4f\n", s, asked(s), reached + noise(random));
            out += row;
        }
        return out;
    };
    for (const char* described : {R"("command_delay_s": 0.05)", R"("position_gain_per_s": 20)",
                                  R"("command_delay_s": 0.05, "position_gain_per_s": 20)"})
        for (const truth t : {truth{0, 0}, truth{0.03, 0}, truth{0, 0.03}})
            for (const std::uint64_t seed : {1U, 2U, 3U}) {
                auto machine = mill(described);
                machine.sample_period_s = 0.02;
                std::istringstream log(followed(t, seed));
                const auto d = diagnose(machine, read_log(log, "log.csv"));
                CAPTURE(described);
                CAPTURE(t.delay);
                CAPTURE(t.lag);
                CAPTURE(said(d));
                CHECK(d.axes[0].verdict == verdict::explained);
                CHECK(d.axes[0].gap_after.position_rms_m < 1.5 * d.axes[0].gap.noise_floor_position_rms_m);
                const auto applied = apply(machine, d).axes[0].drive;
                const double later = applied.command_delay_s.value_or(0) +
                                     (applied.position_gain_per_s ? 1 / *applied.position_gain_per_s : 0);
                CHECK(std::abs(later - t.delay - t.lag) < 2e-3);
            }
}

TEST_CASE("positions: init writes no loops that leave more of the path than a gain alone" *
          doctest::test_suite("all")) {
    std::istringstream text(milled());
    const auto log = read_log(text, "log.csv");
    init_request r;
    r.drive = drive_kind::position;
    r.values["mass"][""] = 100;
    const std::string refusal = refusal_of([&] { init_machine(r, &log); });
    CAPTURE(refusal);
    CHECK(refusal.find("is faster than rows of 100 ms show") != std::string::npos);
}

TEST_CASE("positions: what is twice the rounding of the readings is a gap") {
    const auto d = diagnosed(mill(R"("command_delay_s": 0.03)", "1e-3"));
    CAPTURE(said(d));
    const auto& gap = d.axes[0].gap;
    REQUIRE(gap.position_rms_m > 1.6 * gap.noise_floor_position_rms_m);
    REQUIRE(gap.position_rms_m < 2.9 * gap.noise_floor_position_rms_m);
    CHECK(d.axes[0].verdict != verdict::no_gap);
    CHECK(d.axes[0].verdict != verdict::within_tolerance);
}

TEST_CASE("positions: a servo that is slow, late and soft: its fastest speed comes first") {
    constexpr double h = 1e-3, fastest = 4.2, late = 0.03, softness = 0.03, count = 1.534e-3;
    std::string out = "t_s,q_ref_rad,q_pos_rad\n";
    std::vector<double> asked;
    double target = 0, q = 0;
    for (std::size_t k = 0; k < 3000; ++k) { // a chirp from 0.3 to 3 Hz
        const double t = static_cast<double>(k) * h;
        asked.push_back(1.88 * std::sin(2 * std::numbers::pi * (0.3 + 0.45 * t) * t));
        const double then = asked[k - std::min(k, static_cast<std::size_t>(late / h))];
        target += std::clamp(then - target, -fastest * h, fastest * h);
        q += h / softness * (target - q);
        if (k % 20) continue;
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.6f,%.6f\n", t, asked[k], count * std::round(q / count));
        out += row;
    }
    std::istringstream log(out);
    const auto d = diagnose(read_machine(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.02,
        "axes": {"q": {"encoder": {"resolution_rad": 0.001534}}}})",
                                         "machine.json"),
                            read_log(log, "log.csv"));
    CAPTURE(said(d));
    REQUIRE(d.causes.size() >= 2);
    CHECK(d.causes[0].effect == "setpoint_rate_limit");
    // Delay and gain are suspects: the speed that is written stands without them, and its interval says so.
    REQUIRE(d.causes[0].with_suspects.size() == 1);
    CHECK(d.causes[0].with_suspects[0].key == "drive.setpoint_rate_limit_rad_per_s");
    CHECK(d.causes[0].with_suspects[0].values[0].value == doctest::Approx(fastest).epsilon(0.1));
    const estimate written = value_of(d.causes[0], "drive.setpoint_rate_limit_rad_per_s");
    CHECK(written.value == doctest::Approx(fastest).epsilon(0.2));
    CHECK(written.low < fastest);
    CHECK(written.high > fastest);
}

TEST_CASE("positions: a drift has no name, and what is left beside the causes holds it") {
    constexpr double drift = 0.05, late = 0.06, count = 1e-4; // rad over the record, s, rad
    std::string out = "t_s,q_ref_rad,q_pos_rad\n";
    const auto asked = [](double t) { return std::sin(0.7 * t) + 0.4 * std::sin(1.9 * t); };
    for (int k = 0; k < 3000; ++k) {
        const double t = 0.02 * k, q = asked(t - late) + drift * k / 3000;
        out += fmt::format("{:.2f},{:.7f},{:.7f}\n", t, asked(t), count * std::round(q / count));
    }
    std::istringstream log(out);
    const auto d = diagnose(read_machine(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.02,
        "axes": {"q": {"encoder": {"resolution_rad": 1e-4}}}})",
                                         "machine.json"),
                            read_log(log, "log.csv"));
    CAPTURE(said(d));
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("drifts by") != note.npos && note.find("urad over") != note.npos;
    }));
    CHECK(d.axes[0].gap_after.position_rms_m == doctest::Approx(drift / std::sqrt(12.0)).epsilon(0.15));
}

TEST_CASE("positions: set-points that have the name of a command are told how to be named") {
    std::string text = milled();
    text.replace(text.find("y_ref_m"), 7, "y_cmd_m");
    std::istringstream log(text);
    const std::string refusal =
        refusal_of([&] { check_match(mill(R"("command_delay_s": 0.01)"), read_log(log, "log.csv")); });
    CAPTURE(refusal);
    CHECK(refusal.find("name y_cmd_m y_ref_m") != std::string::npos);
}

TEST_CASE("positions: beside a limit of the speed, what it is wrong by as it lets go is no step and no scale") {
    const auto machine = read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"y": {
            "drive": {"command_delay_s": 0}, "encoder": {"resolution_m": 5e-7}}}})",
        "machine.json");
    std::istringstream log(limited());
    const auto d = diagnose(machine, read_log(log, "log.csv"));
    CAPTURE(said(d));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes.front().effect == "setpoint_rate_limit");
    CHECK(workshop::claims(d) == std::vector<std::string>{"setpoint_rate_limit"});
}
