// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/init.hpp"
#include "quadrant/diagnosis/machine_file/init_fields.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/write_machine.hpp"
#include "refusal.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

init_request request(double mass = 180, double constant = 1100) {
    init_request r;
    r.values["mass"][""] = mass;
    r.values["force-constant"][""] = constant;
    return r;
}

std::string refusal(const init_request& r, const machine_log* log = nullptr) {
    return refusal_of([&] { init_machine(r, log); });
}

machine_log workshop_log() {
    auto log = workshop::as_log(workshop::run({}, 6.2));
    log.file = "log.csv";
    return log;
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
    return std::any_of(notes.begin(), notes.end(), [&](const auto& n) { return n.find(words) != n.npos; });
}

} // namespace

TEST_CASE("init: period, axis, unit and resolution come from the log, and the file passes read_machine") {
    const auto log = workshop_log();
    const auto begun = init_machine(request(), &log);
    const auto machine = read_machine(begun.machine.dump(), "m.json");
    CHECK(machine.sample_period_s == workshop::period);
    REQUIRE(machine.axes.size() == 1);
    CHECK(machine.axes[0].name == "x");
    CHECK(workshop::near(machine.axes[0].encoder.resolution_m, workshop::count, 1e-5));
    CHECK_FALSE(machine.axes[0].controller);
    CHECK(says(begun.notes, "axis x: by the log mass 18")); // 180 kg, to a few per cent
    CHECK(says(begun.notes, "behind the same zero-phase low-pass of"));
    CHECK(begun.comments.find("| `axes.x.plant.mass_kg` | 180 |") != std::string::npos);
    CHECK(begun.comments.find("smallest step of the position in the log") != std::string::npos);
}

TEST_CASE("init: what the numbers of the log leave is said where it is much") {
    auto log = workshop_log();
    CHECK_FALSE(says(init_machine(request(), &log).notes, "that leaves"));
    auto& command = log.axes.at(0).command;
    const double size = rms(command);
    for (std::size_t k = 0; k < command.size(); ++k)
        command[k] += size * std::sin(0.05 * static_cast<double>(k));
    CHECK(says(init_machine(request(), &log).notes, "axis x: that leaves"));
}

TEST_CASE("init: every field goes to its key, each with its line of comment") {
    auto r = request();
    r.sample_period_s = 0.0005;
    r.axes = {"x", "y"};
    for (const init_field& f : init_fields)
        if (!f.rotary_only && !r.values.contains(f.option))
            r.values[f.option][""] = std::string(f.option) == "dac-bits" ? 16 : 0.25;
    r.values["coulomb"]["y"] = 0.2;
    const auto begun = init_machine(r);
    const auto flat = begun.machine.flatten();
    for (const init_field& f : init_fields) {
        if (f.rotary_only) continue;
        CAPTURE(f.option);
        std::string path = fmt::format("/axes/x/{}/{}", f.box, f.key);
        std::replace(path.begin(), path.end(), '.', '/');
        CHECK(flat.contains(path));
        CHECK(begun.comments.find(fmt::format("`axes.x.{}.{}`", f.box, f.key)) != std::string::npos);
    }
    CHECK(flat["/axes/y/plant/coulomb_N"] == 0.2);
    CHECK(flat["/axes/x/controller/kind"] == "cascade_p_pi");
    CHECK(begun.machine["axes"]["x"]["controller"].begin().key() == "kind");
    // What was begun is what a description of it would write.
    CHECK(nlohmann::json(
              to_json(read_machine(begun.machine.dump(), "m.json")))["axes"]["y"]["plant"]["coulomb_N"] == 0.2);
}

TEST_CASE(
    "init: a mass that the log contradicts is refused, one that is missing is asked for with the log's own") {
    const auto log = workshop_log();
    for (double mass : {1.8, 180000.0})
        CHECK(refusal(request(mass), &log).find("contradict this log") != std::string::npos);
    auto r = request();
    r.values.erase("mass");
    const auto said = refusal(r, &log);
    CHECK(said.find("init: axis x: --mass is missing; the log indicates about 1") == 0); // 180 kg
    r = request();
    r.values.erase("force-constant");
    CHECK(refusal(r, &log).find("--force-constant is missing; the log indicates about 1") != std::string::npos);
}

TEST_CASE("init: what does not fit together is refused, what is unusual is asked about") {
    CHECK(refusal(request()).find("--sample-period is missing") != std::string::npos);
    auto r = request(340000);
    r.sample_period_s = 0.0005;
    CHECK(says(init_machine(r).notes, "axes.x.plant.mass_kg = 340000 is unusual"));
    CHECK(says(init_machine(r).notes, "is it in kg?"));
    auto loose = r;
    loose.values["tolerance-mass"][""] = 0.5;
    CHECK(says(init_machine(loose).notes, "is it a share, 0.05 for 5 %?"));
    r.command_unit = "N";
    CHECK(refusal(r) == "init: --force-constant contradicts a command in newtons");
    r.command_unit = "A";
    CHECK(init_machine(r).machine["axes"]["x"]["plant"].contains("force_constant_N_per_A"));
    const auto log = workshop_log();
    CHECK(refusal(r, &log) == "log.csv: the command of axis x is in V, not in A");
    r.axes = {"a b"};
    CHECK(refusal(r).find("an axis is named by letters") != std::string::npos);
    r.axes = {"z"};
    CHECK(refusal(r, &log) == "log.csv: axis z is not in the log");
    r = request();
    r.sample_period_s = 0.0005;
    r.values["static"][""] = 10; // without the velocity at which it fades
    CHECK(refusal(r) == "init: axes.x.plant.static_N: needs stribeck_velocity_m_per_s");
}

TEST_CASE("init: a rotary axis is begun in rad and N m, from its log or because it is said") {
    init_request r;
    r.values["mass"][""] = 180;
    r.values["coulomb"][""] = 60;
    r.rotary = true;
    r.sample_period_s = 0.0005;
    const auto begun = init_machine(r);
    CHECK(begun.machine["axes"]["x"]["plant"].dump() == R"({"inertia_kg_m2":180.0,"coulomb_Nm":60.0})");
    CHECK(begun.comments.find("moving inertia") != std::string::npos);
    r.command_unit = "N";
    CHECK(refusal(r) == "init: axis x is rotary: its command is in V, A or Nm");
    auto log = workshop_log();
    CHECK(refusal(request(), &log) == "accepted");
    r.command_unit.clear();
    CHECK(refusal(r, &log) == "log.csv: axis x is linear, not rotary");
    log.axes[0].kind = axis_kind::rotary;
    CHECK(init_machine(request(), &log).machine["axes"]["x"]["plant"].contains("torque_constant_Nm_per_V"));
    r.values.clear();
    CHECK(refusal(r, &log).find("axis x: --inertia is missing") != std::string::npos);
}

TEST_CASE("init: unchecked, a mass that the log contradicts makes a note, and the file is written") {
    const auto log = workshop_log();
    auto r = request(1.8);
    r.unchecked = true;
    const auto begun = init_machine(r, &log);
    CHECK(begun.machine["axes"]["x"]["plant"]["mass_kg"] == 1.8);
    CHECK(says(begun.notes, "1.8 kg and 1100 N/V contradict this log"));
}
TEST_CASE("init: a rotary axis takes its gravity by option, a linear one refuses it") {
    init_request r;
    r.values["mass"][""] = 0.17;
    r.values["gravity-torque"][""] = 3.2;
    r.values["gravity-phase"][""] = 0.3;
    r.sample_period_s = 0.001;
    CHECK(refusal(r) == "init: axis x: --force-constant is missing");
    r.command_unit = "N";
    CHECK(refusal(r) == "init: --gravity-torque: axis x is linear");
    r.command_unit.clear();
    r.rotary = true;
    const auto machine = read_machine(init_machine(r).machine.dump(), "m.json");
    CHECK(*machine.axes[0].plant.gravity_torque_Nm == 3.2);
    CHECK(*machine.axes[0].plant.gravity_phase_rad == 0.3);
}

TEST_CASE("init: the command's limit is where it stops, not the largest value that it passes") {
    const auto limit_of = [](double top, double finer = 1) {
        auto log = workshop_log(); // a coarse command, cut at `top` steps
        for (std::size_t k = 0; k < log.samples; ++k) {
            const double u = std::round(60 * finer * std::sin(0.003 * static_cast<double>(k))) / finer;
            log.axes[0].command[k] = 0.05 * std::clamp(u, -top, top);
        }
        auto r = request();
        r.unchecked = true;
        const auto machine = read_machine(init_machine(r, &log).machine.dump(), "m.json");
        return machine.axes[0].actuator.limit_V;
    };
    CHECK(workshop::near(limit_of(40).value_or(0), 2, 1e-9));
    CHECK_FALSE(limit_of(1000));
    CHECK_FALSE(limit_of(45, 1.0 / 30)); // five levels: the highest of them is none
}

TEST_CASE("init: a mass of which the log is not sure is told with its standard deviation") {
    machine_log log;
    log.file = "log.csv";
    log.sample_period_s = 0.01;
    axis_log a;
    a.name = "x";
    a.command_unit = "N";
    a.has_reference = false;
    unsigned noise = 1; // white, far above the 2 kg's force
    for (int k = 0; k < 4000; ++k) {
        noise = noise * 1664525U + 1013904223U;
        const double t = 0.01 * k;
        a.position.push_back(std::sin(t) + 0.3 * std::sin(2.7 * t));
        a.command.push_back(-2 * (std::sin(t) + 2.187 * std::sin(2.7 * t)) +
                            400 * (static_cast<double>(noise >> 8) / 16777216.0 - 0.5));
    }
    a.reference = a.position;
    log.axes = {a};
    log.samples = a.position.size();
    init_request r;
    r.from_log = true;
    const std::string said = refusal(r, &log);
    CHECK(said.find("init: axis x: --mass is missing; the log does not determine it well enough (") == 0);
    CHECK(said.find("kg with a standard deviation of") != std::string::npos);
}

TEST_CASE(
    "init: from a log that goes one way, Coulomb friction and a constant force are one number, and neither "
    "is written") {
    std::vector<double> position, torques;
    double q = 0, v = 0; // it speeds up in steps of the torque
    for (int k = 0; k < 16000; ++k) {
        const double torque = 0.05 + 0.005 * (k / 4000);
        position.push_back(q);
        torques.push_back(torque);
        const double acceleration = (torque - 0.04 - 1e-4 * v) / 1.2e-4;
        q += 0.001 * (v + 0.0005 * acceleration);
        v += 0.001 * acceleration;
    }
    const machine_log log = workshop::torque_log(position, torques, 0.001, 1e-9);
    init_request r;
    r.from_log = true;
    const auto begun = init_machine(r, &log);
    const auto& plant = begun.machine["axes"]["q"]["plant"];
    CHECK(plant["inertia_kg_m2"] == doctest::Approx(1.2e-4).epsilon(0.02));
    CHECK(plant["viscous_Nm_s_per_rad"] == doctest::Approx(1e-4).epsilon(0.02));
    CHECK(!plant.contains("coulomb_Nm"));
    CHECK(
        says(begun.notes, "Coulomb friction and a constant torque together (the axis goes one way) 0.04 N m"));
}
