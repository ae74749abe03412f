// SPDX-License-Identifier: BSL-1.0
// A controller that reaches its own limit, stepped by hand: what it does with its integral there is no other
// controller, and no signal that somebody adds.
#include <doctest/doctest.h>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/where/controller_mismatch.hpp>
#include <random>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.001, count = 1e-6, limit = 1.5;
constexpr const char* described = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"x": {
    "plant": {"mass_kg": 50, "force_constant_N_per_V": 100, "viscous_N_s_per_m": 100, "coulomb_N": 10},
    "tolerance": {"mass": 0.02, "force_constant": 0.02, "viscous": 0.1, "coulomb": 0.1},
    "encoder": {"resolution_m": 1e-6}, "actuator": {"limit_V": 1.5},
    "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 40, "velocity_gain_V_s_per_m": 40,
                   "velocity_integral_V_per_m": 400, "velocity_filter_Hz": 150, "velocity_feedforward": 1}}}})";

enum class at_limit { clamps, stands_still };

/// The law of docs/formats.md on a mass with friction that is integrated 50 times a row. Two strokes ask for
/// more than the limit gives. `added`: to the command before its limit, from 2.5 s on [V]. `gain`: of the
/// position [1/s]; `follows`: share of the reference velocity in the demand.
machine_log recorded(at_limit law, double added = 0, double gain = 40, double follows = 1) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> dither(-0.5, 0.5);
    machine_log out;
    out.file = "log.csv";
    out.sample_period_s = period;
    out.axes.emplace_back();
    axis_log& log = out.axes.back();
    log.name = "x";
    log.reference_step = 1e-12;
    log.position_step = count;
    double x = 0, v = 0, read = 0, integral = 0, estimate = 0, before = 0;
    const double corner = 2 * std::numbers::pi * 150;
    for (int k = 0; k < 5000; ++k) {
        const double t = k * period, size = t > 1.2 && t < 3.8 ? 0.2 : 0.02;
        const double r = std::round(size * std::pow(std::sin(std::numbers::pi * t / 1.25), 2) * 1e12) / 1e12;
        const double last = read;
        read = std::round(x / count + dither(random)) * count;
        estimate =
            ((2 - corner * period) * estimate + 2 * corner * (k ? read - last : 0)) / (2 + corner * period);
        const double e = gain * (r - read) + (k ? follows * (r - before) / period : 0) - estimate;
        const double next = integral + 400 * period * e, asked = 40 * e + next + (t >= 2.5 ? added : 0);
        const double u = std::clamp(asked, -limit, limit);
        if (law == at_limit::clamps)
            integral = std::clamp(next, -limit, limit);
        else if (u == asked)
            integral = next;
        log.reference.push_back(before = r);
        log.position.push_back(read);
        log.command.push_back(u);
        for (int i = 0; i < 50; ++i) {
            const double force = 100 * u - 100 * v - 10 * std::tanh(v / 1e-5);
            v += period / 50 * force / 50;
            x += period / 50 * v;
        }
    }
    log.has_reference = true;
    return out;
}
controller_finding judged(const machine_description& m, const machine_log& recorded) {
    const axis_description& axis = m.axes[0];
    const axis_log& log = recorded.axes[0];
    return judge_controller(*axis.controller, axis.actuator, log,
                            prepare(log, period, count, scales_of(axis.plant, log, period, count)), count);
}

} // namespace

TEST_CASE("own limit: an integral that stands still there is no other controller and no added signal") {
    const machine_description machine = read_machine(std::string(described), "machine.json");
    const machine_log log = recorded(at_limit::stands_still);
    const controller_finding found = judged(machine, log);
    CHECK(found.difference_rms > 10 * found.floor_rms); // of a replay that clamps it
    CHECK_FALSE(found.differs);
    REQUIRE(found.limits_otherwise_from);
    const auto& u = log.axes[0].command;
    const auto first = std::find_if(u.begin(), u.end(), [](double v) { return std::abs(v) == limit; });
    CHECK(*found.limits_otherwise_from == doctest::Approx(period * static_cast<double>(first - u.begin())));

    const diagnosis_result d = diagnose(machine, log);
    CHECK(d.causes.empty());
    CHECK(std::count_if(d.notes.begin(), d.notes.end(), [](const std::string& note) {
              return note.find("the controller's integral is another than the described kind's") != note.npos;
          }) == 1);
}
TEST_CASE("own limit: the first integral is that of the rows before the limit, which it does not outlive") {
    const machine_description machine = read_machine(std::string(described), "machine.json");
    machine_log log = recorded(at_limit::clamps);
    auto& x = log.axes[0];
    for (std::vector<double>* column :
         {&x.reference, &x.position, &x.command}) // it begins while the axis moves
        column->erase(column->begin(), column->begin() + 700);
    const controller_finding found = judged(machine, log);
    CHECK_FALSE(found.differs);
    CHECK(found.difference_rms < 2 * found.floor_rms);
}
TEST_CASE(
    "own limit: a controller that clamps as described, another gain and an added signal are told as ever") {
    const machine_description machine = read_machine(std::string(described), "machine.json");
    const controller_finding same = judged(machine, recorded(at_limit::clamps));
    CHECK_FALSE(same.differs);
    CHECK_FALSE(same.limits_otherwise_from);
    for (const at_limit law : {at_limit::clamps, at_limit::stands_still}) {
        machine_description other = machine;
        std::string text = described;
        text.replace(text.find("\"velocity_gain_V_s_per_m\": 40"), 29, "\"velocity_gain_V_s_per_m\": 44");
        other = read_machine(text, "machine.json");
        CHECK(judged(other, recorded(law)).differs);
        CHECK(judged(machine, recorded(law, 0.3)).differs);
    }
}

TEST_CASE("own limit: a wrong gain is found although the integral of its replay runs into the limit") {
    // Without feedforward the position error is the speed over the gain. Replayed with the described gain, the
    // integral adds up a wrong demand while the axis moves, and stands at its limit for most of the record.
    std::string text = described;
    const std::string key = "\"velocity_feedforward\": 1";
    text.replace(text.find(key), key.size(), "\"velocity_feedforward\": 0");
    const machine_description machine = read_machine(text, "machine.json");
    const controller_finding found = judged(machine, recorded(at_limit::clamps, 0, 25.8, 0));
    CHECK(found.differs);
    CHECK(found.mended);
    CHECK(found.key == "position_gain_per_s");
    CHECK(found.value ==
          doctest::Approx(25.8).epsilon(0.005)); // as sure as one controller is the same as another
}
