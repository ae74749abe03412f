// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/circle/find_circles.hpp>
#include <quadrant/diagnosis/circle/read_radius.hpp>

#include <doctest/doctest.h>

#include "circle_machine.hpp"

using namespace quadrant::diagnosis;
using namespace circle_machine;

namespace {
bool near(double value, double truth, double relative) {
    return std::abs(value - truth) <= relative * std::abs(truth);
}
} // namespace

TEST_CASE("find_circles: whole circles at constant feed are found among lines, rests and other radii") {
    machine_log log;
    log.file = "a.csv", log.sample_period_s = 1e-3;
    axis_log x, y;
    x.name = "x", y.name = "y";
    const auto go = [&](double px, double py) {
        for (auto [a, p] : {std::pair{&x, px}, std::pair{&y, py}}) {
            a->reference.push_back(1e-7 * std::round(1e7 * p));
            a->position.push_back(p + 1e-6);
        }
    };
    for (int k = 0; k < 500; ++k) go(0.01, -0.03);            // rest
    for (int k = 0; k < 400; ++k) go(0.01 + 5e-5 * k, -0.03); // a line at the same speed
    const auto arc = [&](double radius, double cx, double cy, double from, double turn, double feed) {
        const int n = int(std::abs(turn) * radius / feed * 1000);
        for (int k = 0; k < n; ++k)
            go(cx + radius * std::cos(from + turn * k / n), cy + radius * std::sin(from + turn * k / n));
    };
    arc(0.03, 0.03, 0, -pi / 2, 5.1 * pi, 0.05); // tangential, two and a half turns
    arc(0.01, 0.01, 0, 0, pi, 0.05);             // half a circle of another radius
    for (int k = 0; k < 300; ++k) go(0, 0);
    arc(0.02, -0.02, 0, 0, -2 * pi, 0.1); // one turn clockwise
    for (int k = 0; k < 300; ++k) go(0, 0);
    log.samples = x.reference.size(), x.reference_step = y.reference_step = 1e-7;
    log.axes = {x, y};
    const auto runs = find_circles(log, 3);
    REQUIRE(runs.size() == 2);
    CHECK(near(runs[0].radius, 0.03, 1e-5));
    CHECK(near(runs[0].feed, 0.05, 0.01));
    CHECK(runs[0].counterclockwise);
    CHECK(runs[0].turns == 2);
    CHECK(runs[0].log == 3);
    CHECK(near(std::abs(runs[0].angle.back() - runs[0].angle.front()), 4 * pi, 0.002));
    CHECK(runs[0].start_s > 1.5);                              // half a turn and more is run in
    CHECK(near(at(runs[0], 45), 1e-6 * std::sqrt(2.0), 0.02)); // both axes stand a micrometre off
    CHECK(near(runs[1].radius, 0.02, 1e-5));
    CHECK(!runs[1].counterclockwise);
    CHECK(near(runs[1].feed, 0.1, 0.01));
    log.axes[1].still = true;
    CHECK_THROWS_WITH_AS(find_circles(log), "a.csv: a circle needs two axes that move, here 1 does", bad_input);
    log.axes[1] = log.axes[0], log.axes[1].name = "y";
    CHECK_THROWS_WITH_AS(find_circles(log), "a.csv: axes x and y follow no whole circle at constant feed",
                         bad_input);
}
TEST_CASE("read_radius: runs both ways in one file; what is wrong is refused with its place") {
    std::string text = "t_s,angle_deg,radius_m,nominal_radius_m,note\n";
    int row = 0;
    const auto add = [&](double angle, double radius) {
        text += fmt::format("{:.3f},{:.4f},{:.7f},0.1,\n", 0.01 * row++, std::remainder(angle, 360), radius);
    };
    for (int k = 0; k <= 900; ++k) add(0.5 * k, 0.1 + 1e-6); // a quarter more than a turn
    for (int k = 0; k <= 800; ++k) add(90 - 0.5 * k, 0.1 - 2e-6);
    CHECK(is_radius_file(text));
    CHECK(!is_radius_file("t_s,x_ref_m,x_pos_m,x_cmd_V\n"));
    const auto runs = read_radius(text, "b.csv", 1);
    REQUIRE(runs.size() == 2);
    CHECK(runs[0].counterclockwise);
    CHECK(!runs[1].counterclockwise);
    CHECK(runs[0].source == circle_source::instrument);
    CHECK(near(runs[0].feed, 0.1 * 50 * pi / 180, 0.01));
    CHECK(runs[0].turns == 1);
    CHECK(near(at(runs[0], 100), 1e-6, 1e-6));
    CHECK(near(at(runs[1], 100), -2e-6, 1e-6));
    const auto refuses = [&](std::string changed, const char* words) {
        try {
            read_radius(changed, "b.csv");
            FAIL("accepted: ", words);
        } catch (const bad_input& e) {
            CHECK(std::string(e.what()).find(words) != std::string::npos);
        }
    };
    refuses("t_s,angle_deg,radius_m\n0,0,1\n", "b.csv:1:23: column nominal_radius_m is missing");
    refuses(text.substr(0, 4000) + "\n", "b.csv:");
    std::string bad = text;
    bad.replace(bad.find("0.1000010,0.1", 300), 9, "nan      ");
    refuses(bad, "radius_m: \"nan\" is not finite");
    bad = text;
    bad.replace(bad.find("0.1000010,0.1", 300), 9, "-0.100000");
    refuses(bad, "radius_m must be above 0");
    refuses(text.substr(0, text.find('\n', 8000) + 1), "holds no whole turn");
}
