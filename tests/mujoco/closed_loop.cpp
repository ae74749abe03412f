// SPDX-License-Identifier: BSL-1.0
// Long: TEST_CASE() draws a machine, writes it, runs both simulators and compares.
// The plant that to_mjcf() writes, in MuJoCo and in closed loop with the machine file's controller, beside
// simulate_closed_loop(): two simulators that share the controller and nothing else.
#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/where/controller_box.hpp>
#include <quadrant/diagnosis/write_mjcf.hpp>

#include <doctest/doctest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>

using namespace quadrant::diagnosis;
using quadrant::in_si;

namespace {

struct simulator {
    std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model{nullptr, &mj_deleteModel};
    std::unique_ptr<mjData, decltype(&mj_deleteData)> data{nullptr, &mj_deleteData};
};

/// The model of an XML text, read from MuJoCo's file system in memory.
simulator loaded(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    REQUIRE(mj_makeEmptyFileVFS(files.get(), "axis.xml", static_cast<int>(xml.size())) == 0);
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    char said[1000] = "";
    simulator out;
    out.model.reset(mj_loadXML("axis.xml", files.get(), said, sizeof said));
    mj_deleteVFS(files.get());
    CAPTURE(said);
    REQUIRE(out.model);
    out.data.reset(mj_makeData(out.model.get()));
    return out;
}

/// Slow and fast strokes with reversals, a smooth one a second, and rest at both ends.
std::vector<double> strokes(double travel, double period, double seconds) {
    std::vector<double> out;
    for (double t = 0; t < seconds; t += period) {
        const double a = 0.4 * std::numbers::pi * t;
        out.push_back(0.5 * travel * (0.7 * (1 - std::cos(a)) + 0.3 * (1 - std::cos(3.3 * a))));
    }
    return out;
}

std::vector<double> in_mujoco(const machine_description& m, const axis_log& log) {
    const axis_description& axis = m.axes[0];
    simulator s = loaded(to_mjcf(m).xml);
    const int substeps = static_cast<int>(std::lround(m.sample_period_s / s.model->opt.timestep));
    const loop_inputs in(loop_columns::of(log), m.sample_period_s);
    const auto controller =
        begun(*made(*axis.controller, axis.actuator, m.sample_period_s), in, log.command[0]);
    s.data->qpos[0] = log.position[0];
    std::vector<double> command;
    double before = log.position[0];
    for (std::size_t k = 0; k < log.reference.size(); ++k) {
        const double x = s.data->qpos[0];
        const double u = k == 0 ? log.command[0]
                                : controller->step(in.asked(static_cast<std::ptrdiff_t>(k)),
                                                   {in_si(x), in_si((x - before) / m.sample_period_s)});
        before = x;
        command.push_back(u);
        s.data->ctrl[0] = u;
        for (int i = 0; i < substeps; ++i) mj_step(s.model.get(), s.data.get());
    }
    return command;
}

double rms(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v * v / static_cast<double>(x.size());
    return std::sqrt(sum);
}

} // namespace

TEST_CASE("to_mjcf: in closed loop MuJoCo's force agrees with simulate's on 24 machines, within 5 % rms") {
    std::mt19937_64 random(20261123);
    const auto between = [&](double low, double high) {
        return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
    };
    double worst = 0;
    for (int i = 0; i < 24; ++i) {
        const bool turns = i % 3 == 2, weighs = i % 6 == 5, springs = i % 4 == 1, second = i % 5 == 3;
        const double mass = turns ? between(0.01, 2) : between(0.5, 300),
                     travel = turns ? 1.5 : between(0.02, 0.3), period = 5e-4,
                     bandwidth = 2 * std::numbers::pi * between(15, 35), constant = between(0.5, 50);
        const double inertial = mass * travel * 15; // of the strokes, about
        std::string plant = fmt::format(
            R"("{}": {}, "force_constant_N_per_V": {}, "viscous_N_s_per_m": {}, "coulomb_N": {}, "delay_s": 0)",
            turns ? "inertia_kg_m2" : "mass_kg", mass, constant, inertial / travel * between(0.02, 0.3),
            inertial * between(0.05, 1));
        if (weighs)
            plant += fmt::format(R"(, "gravity_torque_Nm": {}, "gravity_phase_rad": 0.4)",
                                 inertial * between(0.3, 2));
        if (springs) plant += fmt::format(R"(, "spring_N_per_m": {})", inertial / travel * between(0.1, 1));
        if (second)
            plant += fmt::format(R"(, "mode_mass_kg": {}, "mode_frequency_Hz": {}, "mode_damping": 0.03)",
                                 0.2 * mass, between(80, 200));
        std::string text = fmt::format(
            R"({{"schema": "quadrant.machine/1", "sample_period_s": {}, "axes": {{"q": {{"plant": {{{}}},
               "controller": {{"kind": "cascade_p_pi", "position_gain_per_s": {}, "velocity_gain_V_s_per_m": {},
                 "velocity_integral_V_per_m": {}, "velocity_filter_Hz": 400, "velocity_feedforward": 1, "acceleration_feedforward_V_s2_per_m": {},
                 "viscous_feedforward_V_s_per_m": 0, "coulomb_feedforward_V": 0}}}}}}}})",
            period, plant, 0.3 * bandwidth, mass * bandwidth / constant,
            mass * bandwidth * bandwidth / constant * 0.1, mass / constant);
        if (turns)
            for (const auto& [linear, rotary] :
                 {std::pair{"force_constant_N_per_V", "torque_constant_Nm_per_V"},
                  {"viscous_N_s_per_m", "viscous_Nm_s_per_rad"},
                  {"coulomb_N", "coulomb_Nm"},
                  {"spring_N_per_m", "spring_Nm_per_rad"},
                  {"mode_mass_kg", "mode_inertia_kg_m2"},
                  {"velocity_gain_V_s_per_m", "velocity_gain_V_s_per_rad"},
                  {"velocity_integral_V_per_m", "velocity_integral_V_per_rad"},
                  {"acceleration_feedforward_V_s2_per_m", "acceleration_feedforward_V_s2_per_rad"},
                  {"viscous_feedforward_V_s_per_m", "viscous_feedforward_V_s_per_rad"}})
                if (const auto at = text.find(linear); at != text.npos)
                    text.replace(at, std::string(linear).size(), rotary);
        CAPTURE(text);
        const machine_description m = read_machine(text, "machine.json");
        axis_log log;
        log.name = "q";
        log.reference = log.position = strokes(travel, period, 6);
        log.command.assign(log.reference.size(), 0.0);
        // At rest where gravity and spring pull the command has to hold.
        const plant_model plant_of(m.axes[0], 1e-6 * travel); // MuJoCo's contact gives way by nothing
        log.command[0] = -plant_of.static_force(log.position[0]) / constant;
        const auto ours =
            simulate_closed_loop(*m.axes[0].controller, m.axes[0], plant_of, period, log, {}, 10, {});
        const auto theirs = in_mujoco(m, log);
        std::vector<double> apart;
        for (std::size_t k = 0; k < theirs.size(); ++k) apart.push_back(theirs[k] - ours.command[k]);
        const double share = rms(apart) / rms(ours.command);
        worst = std::max(worst, share);
        CHECK(share < 0.05);
    }
    MESSAGE("worst of 24 machines: ", 100 * worst, " % rms");
}

TEST_CASE("to_mjcf: what MuJoCo cannot hold is told by key, and a limit becomes the control's range") {
    const auto m =
        read_machine(std::string(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"x": {
        "plant": {"mass_kg": 10, "force_constant_N_per_V": 5, "viscous_N_s_per_m": 1, "coulomb_N": 3, "static_N": 4, "stribeck_velocity_m_per_s": 0.01,
                  "delay_s": 0.002, "backlash_m": 1e-5, "constant_force_N": 2},
        "actuator": {"limit_V": 7}}}})"),
                     "machine.json");
    const auto model = to_mjcf(m);
    REQUIRE(model.notes.size() == 1);
    for (const char* key : {"delay_s", "static_N", "stribeck_velocity_m_per_s", "backlash_m"})
        CHECK(model.notes[0].find(key) != std::string::npos);
    CHECK(model.notes[0].find("mass_kg") == std::string::npos);
    simulator s = loaded(model.xml);
    CHECK(s.model->actuator_ctrlrange[1] == 7);
    // A constant force on a mass: a = (F + 5 u - friction)/m.
    s.data->ctrl[0] = 5;
    for (int i = 0; i < 1000; ++i) mj_step(s.model.get(), s.data.get());
    const double t = 1000 * s.model->opt.timestep, reached = (2 + 25 - 3) / 1.0 * (1 - std::exp(-t * 1 / 10.0));
    CHECK(s.data->qvel[0] == doctest::Approx(reached).epsilon(1e-3));
}
