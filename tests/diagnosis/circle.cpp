// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/circle/ball_bar.hpp>

#include <doctest/doctest.h>

#include "circle_machine.hpp"

using namespace quadrant::diagnosis;
using namespace circle_machine;

namespace {

const circle_error* find(const circle_result& r, std::string_view name, std::string_view axis = "") {
    for (const circle_error& e : r.errors)
        if (e.name == name && (axis.empty() || e.axis == axis)) return &e;
    return nullptr;
}
/// What was found, in order: "servo_mismatch backlash.x".
std::string found(const circle_result& r) {
    std::string out;
    for (const circle_error& e : r.errors)
        if (e.verdict == circle_verdict::found)
            out += (out.empty() ? "" : " ") + e.name + (e.axis.empty() ? "" : "." + e.axis);
    return out;
}
bool near(double value, double truth, double relative) {
    return std::abs(value - truth) <= relative * std::abs(truth);
}
bool holds(const circle_error* e, double truth) { return e && e->value.low <= truth && truth <= e->value.high; }
machine encoders() {
    machine m;
    m.source = circle_source::encoder;
    return m;
}
const auto one = [](double) { return 1.0; };

} // namespace

TEST_CASE("ball_bar: noise and quantization alone are blamed on nothing") {
    for (const unsigned seed : {1u, 2u})
        for (const circle_source source : {circle_source::instrument, circle_source::encoder}) {
            machine m;
            m.source = source;
            CHECK(found(ball_bar(all_runs(m, {0.05, 0.1}, {0.03, 0.06}, seed))) == "");
        }
    machine coarse;
    coarse.resolution = 2e-6;
    CHECK(found(ball_bar(all_runs(coarse))) == "");
}
TEST_CASE("ball_bar: every error of geometry alone is the only one named, with its sign and size" *
          doctest::test_suite("all")) {
    struct row {
        const char* name;
        double truth;
        decltype(machine::geometry) geometry;
    };
    const row rows[] = {
        {"squareness", 2e-4, [](double& x, double& y, double, double, double) { x -= 2e-4 * y; }},
        {"squareness", -5e-5, [](double& x, double& y, double, double, double) { x += 5e-5 * y; }},
        {"scale_mismatch", 1e-4, [](double& x, double&, double, double, double) { x *= 1 + 1e-4; }},
        {"straightness.x", 8e-6,
         [](double& x, double& y, double, double, double) { y += 8e-6 * (1 - x * x / 0.0036); }},
        {"straightness.y", -8e-6,
         [](double& x, double& y, double, double, double) { x -= 8e-6 * (1 - y * y / 0.0036); }},
        {"lateral_play.x", 4e-6,
         [](double&, double& y, double vx, double, double) { y += vx > 0 ? 2e-6 : -2e-6; }},
        {"lateral_play.y", 4e-6,
         [](double& x, double&, double, double vy, double) { x += vy > 0 ? 2e-6 : -2e-6; }},
        {"cyclic_error.x", 2e-6,
         [](double& x, double&, double, double, double) { x += 2e-6 * std::cos(2 * pi * x / 2e-3 + 1); }},
        {"vibration.y", 2e-6,
         [](double&, double& y, double, double, double t) { y += 2e-6 * std::cos(2 * pi * 45 * t + 1); }},
    };
    for (const row& k : rows) {
        machine m;
        m.geometry = k.geometry;
        const auto r = ball_bar(all_runs(m, {0.05, 0.1}, {0.06}));
        CAPTURE(k.name);
        CHECK(found(r) == k.name);
        CHECK(holds(&r.errors[0], k.truth));
        CHECK(near(r.errors[0].value.value, k.truth, 0.03));
        CHECK(r.errors[0].share == 1);
        if (r.errors[0].name == "cyclic_error") CHECK(near(r.errors[0].period, 2e-3, 0.002));
        if (r.errors[0].name == "cyclic_error")
            CHECK(r.errors[0].effects == std::vector<std::string>{"encoder_cyclic_error"});
        if (r.errors[0].name == "vibration") CHECK(near(r.errors[0].period, 45, 0.01));
    }
}
TEST_CASE(
    "ball_bar: two lags are a servo mismatch and what both do to the radius, never a scale or a squareness") {
    machine m;
    m.x = lag(50), m.y = lag(52);
    const auto r = ball_bar(all_runs(m));
    CHECK(found(r) == "servo_mismatch radius_change amplitude_mismatch");
    CHECK(holds(find(r, "servo_mismatch"), 1 / 50.0 - 1 / 52.0));
    CHECK(near(find(r, "radius_change")->value.value, -0.25 / 2500 - 0.25 / 2704, 0.02));
    CHECK(near(find(r, "amplitude_mismatch")->value.value, -0.5 / 2500 + 0.5 / 2704, 0.05));
    for (const auto& e : r.errors)
        if (e.name == "servo_mismatch") CHECK(e.effects[0] == "controller_mismatch");
}
TEST_CASE("ball_bar: play is a backlash and no spike; where the machine cannot have any, friction is read") {
    machine m;
    m.x = with_play(rigid(), 6e-6), m.y = with_play(rigid(), 3e-6);
    const auto r = ball_bar(all_runs(m, {0.05, 0.1}, {0.06}));
    CHECK(found(r) == "backlash.x backlash.y");
    CHECK(holds(find(r, "backlash", "x"), 6e-6));
    CHECK(holds(find(r, "backlash", "y"), 3e-6));
    CHECK(find(r, "backlash")->effects[0] == "backlash");
    const auto direct = ball_bar(all_runs(m, {0.05, 0.1}, {0.06}), {.excluded_effects = {"backlash"}});
    CHECK(find(direct, "backlash") == nullptr);
    CHECK(found(direct) == "reversal_lag.x reversal_lag.y");
    CHECK(find(direct, "reversal_lag")->effects == std::vector<std::string>{"coulomb_friction"});
}
TEST_CASE("ball_bar: friction of a direct drive in a loop without integral is never called backlash where the "
          "machine "
          "file excludes it, nor does another error stand together with it") {
    machine m = encoders();
    m.x = mass_with({.coulomb = 0.05, .stiffness = 1e6}, 100, 200, 0);
    m.y = mass_with({.coulomb = 0.02, .stiffness = 1e6}, 100, 200, 0);
    const auto all = all_runs(m, {0.05, 0.1}, {0.03});
    CHECK(find(ball_bar(all), "backlash", "x")->verdict ==
          circle_verdict::found); // the same pattern: not excluded
    for (const auto& runs : {all, std::vector{drive(m, 0.03, 0.1, true)}}) {
        const auto r = ball_bar(runs, {.excluded_effects = {"backlash"}});
        for (const auto& e : r.errors) {
            CHECK(e.name != "backlash");
            for (const std::string& other : e.together_with) CHECK_FALSE(other.starts_with("backlash"));
            for (const std::string& effect : e.effects) CHECK(effect != "backlash");
        }
    }
    const auto direct = ball_bar(all, {.excluded_effects = {"backlash"}});
    CHECK(find(direct, "reversal_lag", "x")->verdict == circle_verdict::found);
}
TEST_CASE("ball_bar: presliding friction in a loop is reversal spikes, with their height and width, never a "
          "backlash") {
    machine m = encoders(), free = encoders();
    m.x = mass_with({.coulomb = 0.1}, 100, 200, 8000), m.y = mass_with({.coulomb = 0.05}, 100, 200, 8000);
    free.x = free.y = mass_with({}, 100, 200, 8000);
    const auto r = ball_bar(all_runs(m, {0.05, 0.1}, {0.03}));
    CHECK(found(r) == "reversal_spikes.x radius_change reversal_spikes.y"); // the loop makes the radius larger
    CHECK(find(r, "backlash")->verdict == circle_verdict::below_limit);
    CHECK(find(r, "stick_slip")->verdict == circle_verdict::below_limit);
    // The height beside the same loop without friction and noise.
    m.noise = free.noise = m.resolution = free.resolution = 0;
    CHECK(near(find(r, "radius_change")->value.value * 0.01 / 0.03, part(drive(free, 0.03, 0.1, true), one),
               0.1));
    const auto with = drive(m, 0.03, 0.1, true), without = drive(free, 0.03, 0.1, true);
    double most = 0;
    for (std::size_t k = 0; k < with.angle.size(); ++k)
        if (std::abs(std::remainder(with.angle[k], pi)) < 0.2)
            most = std::max(most, with.deviation[k] - without.deviation[k]);
    CHECK(holds(find(r, "reversal_spikes", "x"), most));
    CHECK(near(find(r, "reversal_spikes", "y")->value.value, most / 2, 0.15));
    for (const auto& d : find(r, "reversal_spikes", "x")->details)
        CHECK((d.width_s > 0.03 && d.width_s < 0.07));
}
TEST_CASE("ball_bar: jumps after the reversals of a slow circle are stick-slip of that axis") {
    machine m = encoders();
    m.x = mass_with({.coulomb = 0.3, .more = 0.7, .stribeck = 5e-4, .stiffness = 2e5}, 100, 100, 3000);
    m.y = mass_with({}, 100, 100, 3000);
    const auto r = ball_bar(all_runs(m, {0.003, 0.05}, {0.01}));
    REQUIRE(find(r, "stick_slip", "x"));
    CHECK(find(r, "stick_slip", "x")->verdict == circle_verdict::found);
    CHECK(find(r, "stick_slip", "y")->verdict == circle_verdict::below_limit);
    CHECK(find(r, "stick_slip", "x")->effects == std::vector<std::string>{"stribeck_friction"});
}
TEST_CASE("ball_bar: three errors at once are all named, each with its size") {
    machine m;
    m.x = with_play(lag(80), 5e-6), m.y = lag(80); // and what the lags do to the radius
    m.geometry = [](double& x, double& y, double, double, double t) {
        x -= 1e-4 * y;
        y += 1e-6 * std::cos(2 * pi * 60 * t);
    };
    const auto r = ball_bar(all_runs(m, {0.05, 0.1}, {0.06}));
    CHECK(holds(find(r, "squareness"), 1e-4));
    CHECK(holds(find(r, "backlash", "x"), 5e-6));
    CHECK(near(find(r, "vibration")->value.value, 1e-6, 0.05));
    CHECK(near(find(r, "radius_change")->value.value, -0.5 / 6400, 0.02));
    CHECK(found(r) == "radius_change squareness backlash.x vibration.y");
    double sum = 0;
    for (const auto& e : r.errors) sum += e.share;
    CHECK(near(sum, 1, 1e-9));
}
TEST_CASE("ball_bar: what is three times the detection limit is found, what is a third of it is not" *
          doctest::test_suite("all")) {
    machine m;
    const double limit = find(ball_bar(all_runs(m)), "squareness")->limit;
    CHECK(limit > 1e-8);
    for (const double times : {3.0, 1 / 3.0}) {
        m.geometry = [&](double& x, double& y, double, double, double) { x -= times * limit * y; };
        CHECK(found(ball_bar(all_runs(m))) == (times > 1 ? "squareness" : ""));
    }
}
TEST_CASE("ball_bar: says what one direction, one feed or an encoder cannot distinguish") {
    machine m;
    m.geometry = [](double& x, double& y, double, double, double) { x -= 2e-4 * y; };
    const auto single = ball_bar({drive(m, 0.06, 0.05, true)});
    CHECK(found(single) == "squareness");
    CHECK(find(single, "squareness")->together_with == std::vector<std::string>{"servo_mismatch"});
    CHECK(find(single, "servo_mismatch")->verdict == circle_verdict::not_separable);
    CHECK(single.notes.size() == 3);
    const auto pair = ball_bar({drive(m, 0.06, 0.05, true), drive(m, 0.06, 0.05, false)});
    CHECK(find(pair, "squareness")->together_with.empty());
    CHECK(find(pair, "servo_mismatch")->verdict == circle_verdict::below_limit);
    CHECK(find(pair, "amplitude_mismatch")->verdict == circle_verdict::not_separable);
    const auto encoder = ball_bar({drive(encoders(), 0.06, 0.05, true)});
    for (const char* hidden : {"squareness", "scale_mismatch", "straightness", "lateral_play"}) {
        CHECK(find(encoder, hidden)->verdict == circle_verdict::not_visible);
        CHECK(find(encoder, hidden)->needs.find("ball-bar") != std::string::npos);
    }
    CHECK_THROWS_AS(ball_bar({}), bad_input);
    CHECK_THROWS_AS(ball_bar({drive(m, 0.06, 0.05, true), drive(encoders(), 0.06, 0.05, true)}), bad_input);
}
