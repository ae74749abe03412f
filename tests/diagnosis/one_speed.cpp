// SPDX-License-Identifier: BSL-1.0
// A motor that turns one way at one speed: Coulomb friction, viscous friction and a constant torque are one
// there, and what repeats with the position repeats in time.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/effect/repeating.hpp>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/axis_case.hpp>
#include <quadrant/diagnosis/which/one_speed.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <sstream>

using namespace quadrant::diagnosis;

namespace {

constexpr double pi = 3.14159265358979, period = 0.002, inertia = 2.5e-4, coulomb = 0.15, cogging = 0.1;

/// 4 rad/s by a PI loop, from a ramp of 0.2 s, in fine steps; cogging of 7 and 14 a turn; torque measured.
std::string turning() {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 0.002);
    std::string out = "t_s,q_pos_rad,q_cmd_Nm\n";
    double q = 0, v = 0, integral = 0;
    constexpr int fine = 100;
    for (int k = 0; k < 4000; ++k) {
        const double t = k * period, asked = 4 * std::min(1.0, t / 0.2), error = asked - v;
        integral += 0.2 * error * period;
        const double torque = 0.02 * error + integral;
        const double read = std::round(q / 1e-4) * 1e-4;
        for (int i = 0; i < fine; ++i) {
            const double h = period / fine;
            const double net = torque - coulomb * std::tanh(v / 0.005) - cogging * std::sin(7 * q + 0.6) -
                               0.03 * std::sin(14 * q + 1.1);
            v += h * net / inertia;
            q += h * v;
        }
        char row[80];
        std::snprintf(row, sizeof row, "%.6f,%.9f,%.6f\n", t, read, torque + noise(random));
        out += row;
    }
    return out;
}

machine_description motor() {
    return read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.002, "axes": {"q": {
        "plant": {"inertia_kg_m2": 2.5e-4}, "tolerance": {"inertia": 0.3},
        "encoder": {"resolution_rad": 1e-4}, "actuator": {"command_is": "measured"}}}})"),
        "motor.json");
}

/// What effects see of a motion at `speed` whose residual is `residual(t, x)`.
struct seen {
    plant_description plant{};
    tolerance_description tolerance{};
    axis_record record{};
    plant_model leader{};
    std::vector<double> position, residual, innovation, time;

    template <class Speed, class Residual> seen(Speed speed, Residual law) {
        record.period = period;
        double x = 0;
        for (int k = 0; k < 4000; ++k) {
            const double t = k * period;
            time.push_back(t);
            position.push_back(x);
            record.velocity.push_back(speed(t));
            residual.push_back(law(t, x));
            x += period * speed(t);
        }
        record.position = position;
    }
    seen(const seen&) = delete; // the record refers to its position
    bool bound(double repeats) const {
        const screening s{plant, tolerance, record, leader, residual, innovation};
        return quadrant::diagnosis::detail::bound_to_position(s, repeats, time);
    }
};

} // namespace

TEST_CASE("diagnose: friction of a motor at one speed is named once, beside the cogging that it turns over" *
          doctest::test_suite("all")) {
    std::istringstream file(turning());
    const auto d = diagnose(motor(), read_log(file, "turning.csv"));
    CAPTURE(workshop::said(d));
    const std::set<std::string> one{"coulomb_friction", "viscous_friction", "constant_force"};
    const auto claimed = [](const cause& c) { return c.group_probability >= 0.5; };
    const auto is_friction = [&](const cause& c) { return one.contains(c.effect) && claimed(c); };
    CHECK(std::count_if(d.causes.begin(), d.causes.end(), is_friction) == 1); // no two of them that cancel
    const auto friction = std::find_if(d.causes.begin(), d.causes.end(), is_friction);
    REQUIRE(friction != d.causes.end());
    std::set<std::string> names(friction->confusable_with.begin(), friction->confusable_with.end());
    names.insert(friction->effect);
    CHECK(names.contains("coulomb_friction"));
    const auto torque =
        std::find_if(d.causes.begin(), d.causes.end(), [](const cause& c) { return c.effect == "cogging"; });
    REQUIRE(torque != d.causes.end());
    CHECK(claimed(*torque));
    CHECK(workshop::near(workshop::value_of(*torque, "cogging_period_rad").value, 2 * pi / 7, 0.01));
}

TEST_CASE("process: what a motor shows at its positions is bound to them, what a spindle makes is not") {
    const auto wanders = [](double t) { return 4 + 0.3 * std::sin(0.9 * t) + 0.2 * std::sin(2.3 * t); };
    const double mean = 4;
    const auto by_position = [](double, double x) { return std::sin(7 * x); };
    const auto by_time = [&](double t, double) { return std::sin(7 * mean * t); };
    CHECK(seen(wanders, by_position).bound(2 * pi / (7 * mean)));
    CHECK_FALSE(seen(wanders, by_time).bound(2 * pi / (7 * mean)));
    const auto there_and_back = [](double t) { return 4 * std::cos(3 * t); };
    CHECK_FALSE(seen(there_and_back, by_position).bound(2 * pi / (7 * mean)));
}

TEST_CASE(
    "one speed: a motion is of one where its speeds differ by less than a fifth of them, ramps included") {
    const auto moved = [](double wander, double ramp) {
        axis_record r;
        for (int k = 0; k < 4000; ++k) {
            const double phase = k % 2000 / 1000.0, side = phase < 1 ? 1 : -1, in = phase - std::floor(phase);
            const double up = ramp > 0 ? std::min({1.0, in / ramp, (1 - in) / ramp}) : 1;
            r.velocity.push_back(side * 0.4 * up * (1 + wander * std::sin(0.37 * k)));
        }
        return detail::of_one_speed(r);
    };
    CHECK(moved(0, 0));
    CHECK(moved(0.25, 0)); // 0.25 / sqrt 2
    CHECK_FALSE(moved(0.35, 0));
    CHECK(moved(0.1, 0.02));
    CHECK_FALSE(moved(0, 0.5)); // triangles: a law of the speed shows
    CHECK_FALSE(detail::of_one_speed(axis_record{}));
}

TEST_CASE("search: a model without one of its effects has a force, and rivals begin at its other numbers" *
          doctest::test_suite("all")) {
    std::istringstream file(turning());
    const auto machine = motor();
    const auto log = read_log(file, "turning.csv");
    const auto& axis = machine.axes.front();
    const auto& l = log.axes.front();
    std::size_t motions = 0;
    const auto record =
        for_machine(in_pieces(prepare(l, period, 1e-4, scales_of(axis.plant, l, period, 1e-4)), motions), axis,
                    held_by::motion);
    const search models(record, axis, {}, {}, [](const std::string&) {});
    const auto both = models.with({&suspect::coulomb_friction, &suspect::cogging});
    REQUIRE(both.effects.size() == 2);
    CHECK(rms(models.does(both, suspect::cogging)) > 0.5 * cogging / std::sqrt(2.0)); // and finite
    CHECK(models.plant_without(both, suspect::cogging).cogging.count == 0);
    const auto rest = models.without(both, &suspect::coulomb_friction);
    CHECK(rest.effects == std::vector<const effect*>{&suspect::cogging});
    const auto other = models.exchanged(both, &suspect::coulomb_friction, {&suspect::constant_force}).front();
    CHECK(other.total > rest.total + rules{}.margin);
    CHECK(std::abs(other.total - both.total) < 0.1 * (both.total - rest.total)); // one torque under two names
    CHECK(workshop::near(-other.fit.plant.constant_force, both.fit.plant.friction.coulomb, 0.1));
}

TEST_CASE(
    "diagnose: to and fro at one speed, friction is one group of the laws of speed, headed by the commonest, "
    "and the way of a row is no count of the encoder") {
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 0.004);
    std::string log = "t_s,q_pos_rad,q_torque_Nm\n";
    double q = 0, v = 0, to = 0.4;
    for (int k = 0; k < 6000; ++k) {
        to = q > 0.5 ? -0.4 : q < -0.5 ? 0.4 : to;
        const auto acceleration = [&] { return std::clamp((to - v) / 0.05, -8.0, 8.0); };
        const double torque = 0.02 * acceleration() + 0.05 * v + 0.12 * std::tanh(v / 0.01);
        char row[80];
        std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f\n", k * 0.005, q, torque + noise(random));
        log += row;
        for (int i = 0; i < 20; ++i) {
            v += 0.005 / 20 * acceleration();
            q += 0.005 / 20 * v;
        }
    }
    const auto machine = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.005, "axes": {"q": {
        "plant": {"inertia_kg_m2": 0.02, "viscous_Nm_s_per_rad": 0.05}, "tolerance": {"inertia": 0.1, "viscous": 0.2},
        "encoder": {"resolution_rad": 1e-6}, "actuator": {"command_is": "measured"}}}})"),
        "arm.json");
    rules one;
    one.threads = 1;
    const auto d = diagnose(
        machine, read_log_text(log, "arm.csv"), nullptr, [](const std::string&) {}, one);
    REQUIRE(d.causes.size() == 1);
    const cause& friction = d.causes.front();
    CHECK(friction.effect == "coulomb_friction");
    CHECK(friction.group_probability > 0.9);
    CHECK(std::set<std::string>(friction.confusable_with.begin(), friction.confusable_with.end()) ==
          std::set<std::string>{"quadratic_drag", "viscous_friction"});
    CHECK(friction.parameters.front().values.front().value == doctest::Approx(0.12).epsilon(0.05));
}
