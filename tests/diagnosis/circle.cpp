// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/circle/ball_bar.hpp>
#include <quadrant/diagnosis/circle/find_circles.hpp>
#include <quadrant/diagnosis/circle/read_radius.hpp>

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
const auto cos2 = [](double a) { return 2 * std::cos(2 * a); };
const auto sin2 = [](double a) { return 2 * std::sin(2 * a); };
const auto one = [](double) { return 1.0; };

} // namespace

// ---- the symmetry table, by simulation alone: no diagnosis in these cases ----

TEST_CASE("circle table: scale is cos 2t and squareness sin 2t, the same both ways and at every feed") {
    machine scale, square;
    scale.geometry = [](double& x, double&, double, double, double) { x *= 1 + 1e-4; };
    square.geometry = [](double& x, double& y, double, double, double) { x -= 1e-4 * y; };
    for (const auto& r : all_runs(scale)) CHECK(near(part(r, cos2), r.radius * 1e-4 / 2, 0.03));
    for (const auto& r : all_runs(square)) CHECK(near(part(r, sin2), -r.radius * 1e-4 / 2, 0.03));
}
TEST_CASE("circle table: servo mismatch is sin 2t, changes its sign with the direction and follows the feed") {
    machine m;
    m.x = lag(50), m.y = lag(60);
    for (const auto& r : all_runs(m))
        CHECK(near(part(r, sin2), r.turning() * r.feed * (1 / 50.0 - 1 / 60.0) / 2, 0.02));
}
TEST_CASE("circle table: the radius changes by v^2/R; lags that differ also make cos 2t of that size, as a "
          "scale does at one feed") {
    machine m;
    m.x = lag(50), m.y = lag(60);
    for (const auto& r : all_runs(m)) {
        const double x = -0.5 / 2500, y = -0.5 / 3600,
                     c = r.feed * r.feed / r.radius; // -tau^2/2, exact to second order
        CHECK(near(part(r, one), c * (x + y) / 2, 0.03));
        CHECK(near(part(r, cos2), c * (x - y) / 2, 0.03));
    }
}
TEST_CASE("circle table: play steps outward by all of it after each reversal and stays; it is mirrored, and "
          "constant with the feed") {
    machine m;
    m.x = with_play(rigid(), 6e-6);
    for (const auto& r : all_runs(m)) {
        const double s = r.turning();
        CHECK(near(at(r, -s * 4) * -1, 3e-6, 0.06)); // before the reversal at x+, whichever way it is passed
        CHECK(near(at(r, s * 6), 3e-6, 0.06));       // after it
        for (const double a : {30.0, 60.0, 120.0})
            CHECK(std::abs(at(r, a) - s * 3e-6 * std::cos(a * pi / 180)) < 1.5e-7);
    }
}
TEST_CASE("circle table: lateral play moves a half turn each way and the other way round clockwise; a bow has "
          "three lobes") {
    machine play, bow;
    play.geometry = [](double&, double& y, double vx, double, double) { y += vx > 0 ? 2e-6 : -2e-6; };
    bow.geometry = [](double& x, double& y, double, double, double) { y += 8e-6 * (1 - x * x / 0.0036); };
    for (const auto& r : all_runs(play)) {
        CHECK(near(at(r, 90), -r.turning() * 2e-6, 0.08));
        CHECK(near(at(r, -90), -r.turning() * 2e-6, 0.08));
        CHECK(std::abs(at(r, 1)) < 2e-7);
    }
    for (const auto& r : all_runs(bow))
        CHECK(near(part(r, [](double a) { return 2 * std::sin(3 * a); }),
                   -8e-6 / 4 * r.radius * r.radius / 0.0036, 0.08));
}
TEST_CASE(
    "circle table: a spike of friction comes after the reversal, outward, both ways, and grows with the feed") {
    machine m = encoders();
    m.x = m.y = mass_with({.coulomb = 0.1}, 100, 200, 8000);
    const auto spike = [&](const circle_run& r,
                           double s) { // the highest of the ten degrees after x+ over the next thirty
        double most = 0;
        for (double a = 1; a < 12; ++a) most = std::max(most, at(r, s * a));
        return most - at(r, s * 40);
    };
    const auto runs = all_runs(m);
    CHECK(spike(runs[0], 1) > 2e-6);
    CHECK(near(spike(runs[0], 1), spike(runs[1], -1), 0.1)); // mirrored
    CHECK(std::abs(at(runs[0], -3) - at(runs[0], -40)) < 3e-7);
    CHECK(spike(runs[2], 1) > 1.15 * spike(runs[0], 1)); // twice the feed
}
TEST_CASE("circle table: an encoder's cyclic error is constant to an instrument, but its own signal shows it "
          "with the feed") {
    // The loop follows what the encoder reads, so the reading hides what is slower than the loop; the table
    // carries it.
    const double period = 4e-3, kv = 60;
    const auto error = [=](double x) { return 2e-6 * std::cos(2 * pi * x / period); };
    const auto amplitude = [&](double feed, bool seen_by_encoder) {
        machine m = encoders();
        m.noise = 0, m.resolution = 0, m.y = lag(kv);
        m.x = [=, loop = lag(kv, error)](double r, double dt) mutable {
            const double reading = loop(r, dt);
            double table = reading;
            for (int k = 0; k < 20; ++k) table = reading - error(table);
            return seen_by_encoder ? reading : table;
        };
        const auto r = drive(m, 0.06, feed, true);
        double cc = 0, c = 0, s = 0;
        for (std::size_t k = 0; k < r.angle.size(); ++k) {
            const double x = r.radius * std::cos(r.angle[k]), along = std::cos(r.angle[k]);
            if (std::abs(along) < 0.1 || std::abs(along) > 0.5)
                continue; // where x is about as fast as the feed
            cc += along * along / 2, c += along * std::cos(2 * pi * x / period) * r.deviation[k];
            s += along * std::sin(2 * pi * x / period) * r.deviation[k];
        }
        return std::hypot(c, s) / cc;
    };
    CHECK(near(amplitude(0.004, false), 2e-6, 0.15));
    CHECK(amplitude(0.004, true) < 0.5e-6);
    CHECK(amplitude(0.2, true) > 1.5e-6);
}

// ---- the diagnosis ----

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
TEST_CASE("ball_bar: every error of geometry alone is the only one named, with its sign and size") {
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
TEST_CASE("ball_bar: what is three times the detection limit is found, what is a third of it is not") {
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

// ---- where the runs come from ----

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
