// SPDX-License-Identifier: BSL-1.0
// Readings that come more slowly than the rows of their log: found, and no others taken for such.
#include <quadrant/diagnosis/import/read_map.hpp>
#include <quadrant/diagnosis/import_log.hpp>
#include <quadrant/diagnosis/log/slow_readings.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.003, count = 4e-4;

struct read_joint {
    std::vector<double> t{}, q{}, torque{};
};

double swing(double t) { return 0.6 * std::sin(5 * t) + 0.2 * std::sin(11 * t); }

/// Rows every 3 ms of a joint whose angle and torque arrive together every 6 to 20 ms.
read_joint over_a_bus() {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> pause(0.006, 0.02);
    read_joint out;
    double next = 0, q = 0, torque = 0;
    for (int k = 0; k < 6000; ++k) {
        const double t = period * k;
        if (t >= next) {
            q = count * std::round(swing(t) / count);
            torque = 0.01 * (-25 * 0.6 * std::sin(5 * t) - 121 * 0.2 * std::sin(11 * t));
            next = t + pause(random);
        }
        out.t.push_back(t), out.q.push_back(q), out.torque.push_back(torque);
    }
    return out;
}

detail::slow_readings found_in(const read_joint& j) {
    return detail::slow_reading_check(j.t, j.q, count).take();
}

} // namespace

TEST_CASE("slow readings: a joint that is read over a bus every fourth row or so") {
    const read_joint j = over_a_bus();
    const auto found = found_in(j);
    REQUIRE(found);
    CHECK(found.share > 0.65);
    CHECK(found.share < 0.85);
    CHECK(found.interval == doctest::Approx(0.014).epsilon(0.25));
    CHECK(detail::comes_with(found, j.torque));
    std::vector<double> in_each_row(j.t.size());
    for (std::size_t k = 0; k < j.t.size(); ++k) in_each_row[k] = std::sin(40 * j.t[k]);
    CHECK_FALSE(detail::comes_with(found, in_each_row));
    for (std::size_t k = 1; k < j.q.size(); ++k)
        if (found.repeated[k]) REQUIRE(j.q[k] == j.q[k - 1]);
}

TEST_CASE("slow readings: a coarse encoder, a motor that steps and one that rests have none") {
    read_joint coarse, steps, rests;
    double turned = 0;
    for (int k = 0; k < 6000; ++k) {
        const double t = period * k, speed = 0.2 + 1.5 * std::abs(std::sin(0.3 * t));
        turned += period * speed;
        for (read_joint* j : {&coarse, &steps, &rests}) j->t.push_back(t);
        coarse.q.push_back(0.02 * std::round(swing(t) / 0.02));
        steps.q.push_back(50 * count * std::floor(turned / (50 * count))); // really, in full steps
        const double phase = std::fmod(t, 0.6);                            // moves for 60 ms, rests for 540
        rests.q.push_back(0.1 * std::floor(t / 0.6) + 0.1 * std::min(1.0, phase / 0.06));
    }
    CHECK_FALSE(detail::slow_reading_check(coarse.t, coarse.q, 0.02).take());
    CHECK_FALSE(found_in(steps));
    CHECK_FALSE(found_in(rests));
    read_joint fresh;
    for (double t : coarse.t) fresh.t.push_back(t), fresh.q.push_back(count * std::round(swing(t) / count));
    CHECK_FALSE(found_in(fresh));
}

TEST_CASE("import: of readings that come over a bus the new ones alone are resampled") {
    const read_joint j = over_a_bus();
    std::string csv = "time,q,tau\n";
    for (std::size_t k = 0; k < j.t.size(); ++k)
        csv += fmt::format("{:.6f},{:.9f},{:.9f}\n", j.t[k], j.q[k], j.torque[k]);
    const import_map map = read_import_map(
        std::string_view(
            R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "time", "unit": "s"},
            "axes": {"q": {"position": {"column": "q", "unit": "rad"},
                           "command": {"column": "tau", "unit": "Nm", "is": "measured"}}}})"),
        "map.json");
    const std::vector<foreign_file> files{{csv, "joint.csv"}};
    const imported_log got = import_log(map, files, {.resample = true});
    CHECK(got.log.sample_period_s == doctest::Approx(0.014).epsilon(0.25));
    CHECK(std::any_of(got.notes.begin(), got.notes.end(), [](const std::string& note) {
        return note.find("% of the rows of a motion repeat the reading before; a new one comes every 0.01") !=
               note.npos;
    }));
    const axis_log& axis = got.log.axes.front();
    double worst = 0, off = 0;
    std::size_t rows = 0;
    for (std::size_t k = 2; k + 2 < axis.position.size(); ++k) {
        if (!axis.left_out.empty() && axis.left_out[k]) continue;
        const double e = axis.position[k] - swing(got.log.sample_period_s * static_cast<double>(k));
        worst = std::max(worst, std::abs(e)), off += e * e, ++rows;
    }
    CHECK(rows > 1000);
    CHECK(std::sqrt(off / static_cast<double>(rows)) < 2 * count); // between rows as they are: 15 counts
    CHECK(worst < 12 * count);
}
