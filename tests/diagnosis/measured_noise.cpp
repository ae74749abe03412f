// SPDX-License-Identifier: BSL-1.0
// The floor of a measured command and of a coarse count: only what the axis did not follow is noise of the
// measurement, and rounding is a tone only while the axis creeps.
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <string>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.001, inertia = 0.01, count = 1e-3;

axis_description motor() {
    return read_machine(
               std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"inertia_kg_m2": 0.01, "viscous_Nm_s_per_rad": 0.05}, "tolerance": {"inertia": 0.05},
        "encoder": {"resolution_rad": 1e-3}, "actuator": {"command_is": "measured"}}}})"),
               "motor.json")
        .axes.front();
}

/// A motor that swings by a torque of 0.4 N m and white torque on top. `added`: by the measurement, or by
/// what is asked, which moves the motor.
axis_log shaken(double white, bool added, double read_to = count) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0, white);
    axis_log l;
    double q = 0, v = 0;
    for (int k = 0; k < 8000; ++k) {
        const double shake = normal(random);
        const double swing = 0.4 * std::cos(2 * 3.14159265358979 * 0.7 * k * period);
        const double torque = swing + (added ? 0 : shake);
        l.position.push_back(std::round(q / read_to) * read_to);
        l.command.push_back(swing + shake);
        const double a = (torque - 0.05 * v) / inertia;
        q += period * (v + period / 2 * a);
        v += period * a;
    }
    return l;
}

axis_record ready(const axis_description& axis, const axis_log& l) {
    return for_machine(prepare(l, period, count, scales_of(axis.plant, l, period, count)), axis);
}

} // namespace

TEST_CASE("noise of a measured command: what moves the axis is none") {
    const axis_description axis = motor();
    constexpr double white = 0.05;
    const axis_log asked = shaken(white, false), measured = shaken(white, true);
    const axis_record of_asked = ready(axis, asked), of_measured = ready(axis, measured);
    for (std::size_t i = 0; i < of_asked.score.channels.size(); ++i) {
        CAPTURE(i);
        const double whole = command_noise_in(of_measured.score.channels[i], white, inertia, period,
                                              of_measured.observer.pole());
        CHECK(of_measured.score.channels[i].command_noise > 0.7 * whole);
        CHECK(of_measured.score.channels[i].command_noise < 1.1 * whole);
        CHECK(of_asked.score.channels[i].command_noise < 0.4 * whole);
    }
    CHECK(of_asked.command_noise < 0.4 * of_measured.command_noise);
}

TEST_CASE("noise of a measured command: what its acceleration follows is none, before there is a model") {
    const axis_log asked = shaken(0.05, false, count / 100), measured = shaken(0.05, true, count / 100);
    CHECK(white_noise_in(asked.command) > 0.04); // it may be, by the command alone
    CHECK(white_noise_in(asked.command, asked.position) < 0.02);
    CHECK(white_noise_in(measured.command, measured.position) == doctest::Approx(0.05).epsilon(0.1));
}

TEST_CASE("noise of a measured command: a wrong machine leaves more, and none of that is noise") {
    const axis_log asked = shaken(0.05, false, count / 100);
    axis_description half = motor();
    half.plant.mass_kg /= 2;
    axis_record of_half = ready(half, asked);
    std::vector<double> e;
    of_half.observer.run(plant_model(half, of_half.scale.give()), e);
    for (channel& c : of_half.score.channels)
        c.command_noise *= 3; // by what half of the mass leaves, all of that may be
    CHECK(share_added_by_measurement(e, of_half.score.channels, 1e-9) == 1);
}

TEST_CASE("noise of a measured command: no more than the innovations hold in any channel") {
    const axis_description axis = motor();
    const axis_log measured = shaken(0.05, true);
    const axis_record r = ready(axis, measured);
    std::vector<double> e;
    r.observer.run(plant_model(axis, r.scale.give()), e);
    for (double& x : e) x /= 100; // as of an axis that the torque does not shake
    const double share = share_added_by_measurement(e, r.score.channels, 1e-9);
    CHECK(share < 2e-4);
    CHECK(share > 0);
}

TEST_CASE("rounding: a tone only in the rows in which the axis creeps") {
    const axis_description axis = motor();
    axis_log fast, slow, both;
    for (int k = 0; k < 6000; ++k) {
        const auto at = [&](double speed) { return std::round(speed * k * period / count) * count; };
        fast.position.push_back(at(2));
        slow.position.push_back(at(2e-3));
        both.position.push_back(k < 3000 ? at(2) : fast.position[2999]);
        for (axis_log* l : {&fast, &slow, &both}) l->command.push_back(0.1);
    }
    const auto creeping = [&](const axis_log& l, std::size_t i) {
        const axis_record r = ready(axis, l);
        const channel& c = r.score.channels.at(i);
        REQUIRE(c.creeping.size() == c.first_of_block.size());
        return std::pair{c, std::accumulate(c.creeping.begin(), c.creeping.end(), 0.0) /
                                static_cast<double>(c.creeping.size())};
    };
    const auto [of_fast, in_fast] = creeping(fast, 1);
    const auto [of_slow, in_slow] = creeping(slow, 1);
    const auto [of_both, in_both] = creeping(both, 1);
    CHECK(in_fast < 0.05); // the filter that finds the velocity begins at rest
    CHECK(in_slow == 1);
    CHECK(in_both > 0.4);
    CHECK(in_both < 0.6);
    CHECK(of_slow.of_rounding(count, 2) ==
          doctest::Approx(of_slow.rounding * count / 2 * of_slow.rounding * count / 2));
    CHECK(of_fast.of_rounding(count, of_fast.creeping.size() / 2) == 0);
}
