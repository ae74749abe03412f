// SPDX-License-Identifier: BSL-1.0
// Long: one reader: a case for each rule of a machine file, all against one example.
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/machine_file/machine_keys.hpp"
#include "quadrant/diagnosis/match.hpp"
#include "quadrant/diagnosis/model/plant_model.hpp"
#include "quadrant/diagnosis/text/text.hpp"
#include "quadrant/diagnosis/write_machine.hpp"
#include "refusal.hpp"

#include <doctest/doctest.h>

#include <ctime>
#include <set>

using namespace quadrant::diagnosis;

namespace {

/// docs/formats.md's example.
const char* const example = R"({
  "schema": "quadrant.machine/1",
  "sample_period_s": 0.0005,
  "excluded_effects": ["backlash"],
  "axes": {
    "x": {
      "plant": {"mass_kg": 340, "force_constant_N_per_V": 1450, "viscous_N_s_per_m": 850, "delay_s": 0.0004,
                "coulomb_N": 122, "static_N": 177, "stribeck_velocity_m_per_s": 0.0022},
      "tolerance": {"mass": 0.02, "force_constant": 0.01, "viscous": 0.10, "coulomb": 0.05, "static": 0.05},
      "encoder": {"resolution_m": 2.5e-7},
      "actuator": {"limit_V": 10, "dac_bits": 16, "dac_range_V": 20},
      "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 150, "velocity_gain_V_s_per_m": 60,
                     "velocity_integral_V_per_m": 450, "velocity_filter_Hz": 150, "velocity_feedforward": 1,
                     "acceleration_feedforward_V_s2_per_m": 0.2345, "viscous_feedforward_V_s_per_m": 0.586,
                     "coulomb_feedforward_V": 0, "notch": {"frequency_Hz": 330, "width": 0.06}}
    }
  }
})";

/// The example with the value at a JSON pointer replaced (or added).
std::string with(const std::string& pointer, const std::string& value) {
    auto json = nlohmann::json::parse(example);
    json[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    return json.dump();
}
std::string without(const std::string& parent, const std::string& key) {
    auto json = nlohmann::json::parse(example);
    json[nlohmann::json::json_pointer(parent)].erase(key);
    return json.dump();
}

std::string refusal(const std::string& text) {
    return refusal_of([&] { read_machine(text, "machine.json"); });
}
std::string refused_value(const std::string& pointer, const std::string& value) {
    return refusal(with(pointer, value));
}

const std::string plant = "/axes/x/plant", controller = "/axes/x/controller", actuator = "/axes/x/actuator";

} // namespace

TEST_CASE("read_machine: the format's example comes out as it stands") {
    const auto machine = read_machine(std::string_view(example), "machine.json");
    CHECK(machine.file == "machine.json");
    CHECK(machine.sample_period_s == 0.0005);
    CHECK(machine.excluded_effects == std::vector<std::string>{"backlash"});
    REQUIRE(machine.axes.size() == 1);
    const auto& x = machine.axes[0];
    CHECK(x.name == "x");
    CHECK(x.command_unit == "V");
    CHECK(x.plant.mass_kg == 340);
    CHECK(x.plant.force_constant_N_per_V == 1450);
    CHECK(x.plant.viscous_N_s_per_m == 850);
    CHECK(x.plant.delay_s == 0.0004);
    CHECK(x.plant.coulomb_N == 122);
    CHECK(x.plant.static_N == 177);
    CHECK(x.plant.stribeck_velocity_m_per_s == 0.0022);
    CHECK_FALSE(x.plant.constant_force_N);
    CHECK(x.tolerance.of("mass") == 0.02);
    CHECK(x.tolerance.of("viscous") == 0.1);
    CHECK(x.tolerance.of("delay") == 0.05);
    CHECK(x.encoder.resolution_m == 2.5e-7);
    CHECK(x.actuator.limit_V == 10);
    CHECK(x.actuator.dac_bits == 16);
    CHECK(x.actuator.dac_range_V == 20);
    REQUIRE(x.controller);
    CHECK(x.controller->number("position_gain_per_s") == 150);
    CHECK(x.controller->number("velocity_gain_V_s_per_m") == 60);
    CHECK(x.controller->number("velocity_integral_V_per_m") == 450);
    CHECK_FALSE(x.controller->has("velocity_estimator"));
    CHECK(x.controller->number("velocity_filter_Hz") == 150);
    CHECK(x.controller->number("velocity_feedforward") == 1);
    CHECK(x.controller->number("acceleration_feedforward_V_s2_per_m") == 0.2345);
    CHECK(x.controller->number("viscous_feedforward_V_s_per_m") == 0.586);
    CHECK(x.controller->number("coulomb_feedforward_V") == 0);
    CHECK(x.controller->number("notch.frequency_Hz") == 330);
    CHECK(x.controller->number("notch.width") == 0.06);
}

TEST_CASE("read_machine: every key of the plant arrives in its field") {
    const auto machine = read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"y": {"plant": {"mass_kg": 1,
            "force_constant_N_per_A": 2, "constant_force_N": -3, "viscous_asymmetry": 0.4, "coulomb_asymmetry": -0.5,
            "cogging_period_m": 0.032, "cogging_N": [6, 7], "cogging_phase_rad": [0.8, -0.9]}}, "x": {"plant": {"mass_kg": 9}}}})",
        "m");
    REQUIRE(machine.axes.size() == 2);
    CHECK(machine.axes[0].name == "x");
    CHECK(machine.axes[0].command_unit == "N");
    CHECK(machine.axes[0].plant.force_constant_N_per_V == 1);
    CHECK(machine.axes[0].tolerance.of("force_constant") == 0);
    const auto& y = machine.axes[1];
    CHECK(y.command_unit == "A");
    CHECK(y.plant.force_constant_N_per_V == 2);
    CHECK(y.plant.constant_force_N == -3);
    CHECK(y.plant.viscous_asymmetry == 0.4);
    CHECK(y.plant.coulomb_asymmetry == -0.5);
    CHECK(y.plant.cogging_period_m == 0.032);
    CHECK(y.plant.cogging_N == std::vector{6.0, 7.0});
    CHECK(y.plant.cogging_phase_rad == std::vector{0.8, -0.9});
}

TEST_CASE("read_machine: a rotary axis has inertia, torques and radians in the same fields") {
    const auto machine = read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"b": {"plant": {"inertia_kg_m2": 9}},
            "c": {"plant": {"inertia_kg_m2": 1, "torque_constant_Nm_per_A": 2, "viscous_Nm_s_per_rad": 3, "static_Nm": 5,
            "coulomb_Nm": 4, "stribeck_velocity_rad_per_s": 6, "constant_torque_Nm": 7, "presliding_angle_rad": 0.25,
            "cogging_period_rad": 0.5, "cogging_Nm": [8], "cogging_phase_rad": [0.75], "mode_inertia_kg_m2": 0.125,
            "mode_frequency_Hz": 50, "backlash_rad": 0.0625, "spring_Nm_per_rad": 10},
            "tolerance": {"inertia": 0.01, "torque_constant": 0.02}, "encoder": {"resolution_rad": 11, "cyclic_rad": 12,
            "cyclic_period_rad": 13, "cyclic_phase_rad": 14}, "process": {"fundamental_Hz": 20, "torque_Nm": [15]},
            "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 1, "velocity_gain_V_s_per_rad": 16,
            "velocity_filter_Hz": 100}}}})",
        "m");
    REQUIRE(machine.axes.size() == 2);
    CHECK(machine.axes[0].command_unit == "Nm");
    CHECK(machine.notes.front().find("axis b: no controller") == 0);
    CHECK(machine.notes[1] == "axis b: no tolerance is given for inertia: 0.05 is assumed.");
    CHECK(machine.notes[2] == "axis b: no torque constant is given: the command is taken for newton metres.");
    const auto& c = machine.axes[1];
    CHECK(c.kind == axis_kind::rotary);
    CHECK(c.command_unit == "A");
    CHECK(c.plant.mass_kg == 1);
    CHECK(c.plant.force_constant_N_per_V == 2);
    CHECK(c.plant.viscous_N_s_per_m == 3);
    CHECK(c.plant.coulomb_N == 4);
    CHECK(c.plant.static_N == 5);
    CHECK(c.plant.stribeck_velocity_m_per_s == 6);
    CHECK(c.plant.constant_force_N == 7);
    CHECK(c.plant.presliding_length_m == 0.25);
    CHECK(c.plant.cogging_period_m == 0.5);
    CHECK(c.plant.cogging_N == std::vector{8.0});
    CHECK(c.plant.cogging_phase_rad == std::vector{0.75});
    CHECK(c.plant.mode_mass_kg == 0.125);
    CHECK(c.plant.backlash_m == 0.0625);
    CHECK(c.plant.spring_N_per_m == 10);
    CHECK(c.tolerance.of("mass") == 0.01);
    CHECK(c.tolerance.of("force_constant") == 0.02);
    CHECK(c.encoder.resolution_m == 11);
    CHECK(c.encoder.cyclic_m == 12);
    CHECK(c.encoder.cyclic_period_m == 13);
    CHECK(c.encoder.cyclic_phase_rad == 14);
    CHECK(c.process.force_N == std::vector{15.0});
    CHECK(c.controller->number("velocity_gain_V_s_per_m") == 16);
}

TEST_CASE("read_machine: an axis that mixes linear and rotary keys is refused, with the place and the rule") {
    const auto machine_with = [](std::string_view keys, std::string_view rest = "") {
        return refusal(
            fmt::format("{{\"schema\": \"quadrant.machine/1\", \"sample_period_s\": 0.001,\n\"axes\": "
                        "{{\"c\": {{\n  \"plant\": {{{}}}{}}}}}}}",
                        keys, rest));
    };
    const std::string rule = " (an axis has m, N and kg, or rad, Nm and kg_m2, throughout)";
    CHECK(
        machine_with(R"("inertia_kg_m2": 1, "coulomb_N": 2)") ==
        "machine.json:3:33: axes.c.plant.coulomb_N: belongs to a linear axis; this one is rotary: coulomb_Nm" +
            rule);
    CHECK(machine_with(R"("mass_kg": 1, "coulomb_Nm": 2)") ==
          "machine.json:3:27: axes.c.plant.coulomb_Nm: belongs to a rotary axis; this one is linear, without "
          "inertia_kg_m2: coulomb_N" +
              rule);
    CHECK(machine_with(R"("mass_kg": 1, "inertia_kg_m2": 2)")
              .find("3:13: axes.c.plant.mass_kg: belongs to a linear") != std::string::npos);
    CHECK(machine_with(R"("inertia_kg_m2": 2)", R"(, "encoder": {"resolution_m": 1})").find("resolution_rad") !=
          std::string::npos);
    CHECK(machine_with(R"("inertia_kg_m2": -2)") ==
          "machine.json: axes.c.plant.inertia_kg_m2: must be a number > 0");
    CHECK(machine_with(R"("inertia_kg_m2": 2, "static_Nm": 1)").ends_with("needs stribeck_velocity_rad_per_s"));
    CHECK(machine_with(R"("inertia_kg_m2": 2, "colomb_Nm": 1)").ends_with("did you mean coulomb_Nm?"));
}

TEST_CASE("read_machine: text that is not JSON is refused with its place") {
    CHECK(refusal("{\n  \"schema\": \"quadrant.machine/1\"\n  \"axes\": {}\n}") ==
          "machine.json:3:8: syntax error while parsing object - unexpected string literal; expected '}'");
    CHECK(
        refusal("\xEF\xBB\xBF{\n\"\xC3\xBC\": nan}") ==
        "machine.json:2:7: syntax error while parsing value - invalid literal; last read: '\"\xC3\xBC\": na'");
    CHECK(refusal("") == "machine.json: is empty");
    CHECK(refusal("t_s,x_ref_m\n0,1\n") == "machine.json: is no JSON: it holds no {; is it a log?");
    CHECK(refusal("{} x") == "machine.json:1:4: syntax error while parsing value - invalid literal; last read: "
                             "'{} x'; expected end of input");
    CHECK(refusal("{\"a\": \"\xff\"}")
              .starts_with("machine.json:1:8: syntax error while parsing value - invalid string"));
    CHECK(refusal("{\"a\": \"\n\"}").find('\n') == std::string::npos);
}

TEST_CASE("read_machine: a key that is there twice is refused") {
    CHECK(
        refusal(
            R"({"schema": "quadrant.machine/1", "axes": {"x": {"plant": {"mass_kg": 1, "delay_s": 0, "mass_kg": 2}}}})") ==
        "machine.json: axes.x.plant.mass_kg: is there twice");
    CHECK(refusal(R"({"schema": 1, "schema": 2})") == "machine.json: schema: is there twice");
    CHECK(refusal(R"({"axes": {"x": {}, "y": {}, "x": {}}})") == "machine.json: axes.x: is there twice");
}

TEST_CASE("read_machine: a file of many objects takes time by its size, not by its square") {
    const auto time_of = [](std::size_t axes) { // of the processor
        std::string text = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {)";
        for (std::size_t k = 0; k < axes; ++k)
            text += fmt::format("{}\"a{}\": {{\"plant\": {{\"mass_kg\": 1}}}}", k ? "," : "", k);
        const auto began = std::clock();
        CHECK(read_machine(text + "}}", "machine.json").axes.size() == axes);
        return static_cast<double>(std::clock() - began);
    };
    time_of(100);
    CHECK(time_of(8000) < 16 * time_of(1000)); // 8 by its size, 64 by its square
}

TEST_CASE("read_machine: nesting and size have their limits") {
    CHECK(refusal(std::string(1000000, '[')) == "machine.json: is nested too deeply");
    CHECK(refusal("{\"" + std::string(100000, 'k') + "\": 1}").size() < 600);
}

TEST_CASE("read_machine: another schema is refused before anything else") {
    CHECK(refusal(R"({"schema": "quadrant.diagnosis/1", "verdict": "no_gap"})") ==
          "machine.json: schema: must be \"quadrant.machine/1\"; this file is \"quadrant.diagnosis/1\"");
    CHECK(refusal(R"({"sample_period_s": 1})") == "machine.json: schema: is missing");
    CHECK(refusal(R"({"schema": 1})") == "machine.json: schema: must be a string");
    CHECK(refusal("[]") == "machine.json: must be an object");
    CHECK(refusal("1e999") == "machine.json: must be an object");
}

TEST_CASE("read_machine: a missing key is named with its path") {
    CHECK(refusal(without("", "sample_period_s")) == "machine.json: sample_period_s: is missing");
    CHECK(refusal(without("", "axes")) == "machine.json: axes: is missing");
    CHECK(refusal(without("/axes/x", "plant")) == "machine.json: axes.x.plant: is missing");
    CHECK(refusal(without(plant, "mass_kg")) == "machine.json: axes.x.plant.mass_kg: is missing");
    CHECK(refusal(without(controller, "kind")) == "machine.json: axes.x.controller.kind: is missing");
    CHECK(refusal(without(controller, "position_gain_per_s")) ==
          "machine.json: axes.x.controller.position_gain_per_s: is missing");
    CHECK(refusal(without(controller, "velocity_gain_V_s_per_m")) ==
          "machine.json: axes.x.controller.velocity_gain_V_s_per_m: is missing");
    CHECK(refusal(without(controller, "velocity_filter_Hz")) ==
          "machine.json: axes.x.controller.velocity_filter_Hz: is missing");
    CHECK(refusal(without(controller + "/notch", "width")) ==
          "machine.json: axes.x.controller.notch.width: is missing");
    CHECK(refused_value("/axes", "{}") == "machine.json: axes: must name at least one axis");
}

TEST_CASE("read_machine: an unknown key is refused and the nearest known one suggested") {
    CHECK(refused_value(plant + "/mass_g", "340000") ==
          "machine.json: axes.x.plant.mass_g: unknown key; did you mean mass_kg?");
    auto slip = nlohmann::json::parse(example);
    slip["axes"]["x"]["plant"].erase("mass_kg");
    slip["axes"]["x"]["plant"]["mass_g"] = 340000;
    CHECK(refusal(slip.dump()) == "machine.json: axes.x.plant.mass_g: unknown key; did you mean mass_kg?");
    CHECK(
        refused_value(plant + "/force_constant_N_per_v", "1") ==
        "machine.json: axes.x.plant.force_constant_N_per_v: unknown key; did you mean force_constant_N_per_V?");
    CHECK(refused_value(plant + "/temperature_K", "293") ==
          "machine.json: axes.x.plant.temperature_K: unknown key");
    CHECK(refused_value("/sample_period_ms", "0.5") ==
          "machine.json: sample_period_ms: unknown key; did you mean sample_period_s?");
    CHECK(refused_value("/axes/x/controler", "{}") ==
          "machine.json: axes.x.controler: unknown key; did you mean controller?");
    CHECK(refused_value("/axes/x/encoder/resolution_um", "1") ==
          "machine.json: axes.x.encoder.resolution_um: unknown key; did you mean resolution_m?");
    CHECK(refused_value(actuator + "/dac_bit", "16") ==
          "machine.json: axes.x.actuator.dac_bit: unknown key; did you mean dac_bits?");
    CHECK(refused_value(controller + "/position_gain", "1") ==
          "machine.json: axes.x.controller.position_gain: unknown key; did you mean position_gain_per_s?");
    CHECK(refused_value(controller + "/notch/depth", "1") ==
          "machine.json: axes.x.controller.notch.depth: unknown key");
    CHECK(refused_value("/axes/x/tolerance/mass_kg", "0.1") ==
          "machine.json: axes.x.tolerance.mass_kg: unknown key; did you mean mass?");
}

TEST_CASE("read_machine: a value of the wrong kind or size is refused with its rule") {
    for (const char* value : {"0", "-1", "\"340\"", "null", "true", "[340]"})
        CHECK(refused_value(plant + "/mass_kg", value) ==
              "machine.json: axes.x.plant.mass_kg: must be a number > 0");
    CHECK(refused_value(plant + "/mass_kg", "1e13") ==
          "machine.json: axes.x.plant.mass_kg: must lie between 1e-12 and 1e12 in magnitude");
    CHECK(refused_value(plant + "/mass_kg", "1e-300") ==
          "machine.json: axes.x.plant.mass_kg: must lie between 1e-12 and 1e12 in magnitude");
    CHECK(refusal(R"({"schema": "quadrant.machine/1", "axes": {"x": {"plant": {"mass_kg": 1e999}}}})") ==
          "machine.json: axes.x.plant.mass_kg: must be a finite number");
    CHECK(refused_value("/sample_period_s", "0") == "machine.json: sample_period_s: must be a number > 0");
    CHECK(refused_value(plant + "/force_constant_N_per_V", "0") ==
          "machine.json: axes.x.plant.force_constant_N_per_V: must be a number > 0");
    CHECK(refused_value(plant + "/viscous_N_s_per_m", "-1") ==
          "machine.json: axes.x.plant.viscous_N_s_per_m: must be a number >= 0");
    CHECK(refused_value(plant + "/coulomb_N", "-1") ==
          "machine.json: axes.x.plant.coulomb_N: must be a number >= 0");
    CHECK(refused_value(plant + "/constant_force_N", "\"1\"") ==
          "machine.json: axes.x.plant.constant_force_N: must be a number");
    CHECK(refused_value(plant + "/coulomb_asymmetry", "1") ==
          "machine.json: axes.x.plant.coulomb_asymmetry: must be a number between -1 and 1 (relative)");
    CHECK(refused_value("/axes/x/encoder/resolution_m", "-1e-9") ==
          "machine.json: axes.x.encoder.resolution_m: must be a number >= 0");
    CHECK(refused_value(actuator + "/limit_V", "0") ==
          "machine.json: axes.x.actuator.limit_V: must be a number > 0");
    for (const char* value : {"0", "33", "15.5", "\"16\""})
        CHECK(refused_value(actuator + "/dac_bits", value) ==
              "machine.json: axes.x.actuator.dac_bits: must be a whole number from 1 to 32");
    CHECK(refused_value("/axes", "[]") == "machine.json: axes: must be an object");
    CHECK(refused_value("/axes/x", "1") == "machine.json: axes.x: must be an object");
    CHECK(refused_value(plant, "[]") == "machine.json: axes.x.plant: must be an object");
    CHECK(refused_value("/axes/x/tolerance", "0.05") == "machine.json: axes.x.tolerance: must be an object");
    CHECK(refused_value("/axes/x/encoder", "null") == "machine.json: axes.x.encoder: must be an object");
    CHECK(refused_value(controller, "\"cascade_p_pi\"") ==
          "machine.json: axes.x.controller: must be an object");
    CHECK(refused_value("/axes/a b", "{}") ==
          "machine.json: axes: \"a b\": an axis is named by letters, digits, _ and -");
}

TEST_CASE("read_machine: a delay that is negative or absurd is refused") {
    for (const char* value : {"-0.0001", "1.5"})
        CHECK(refused_value(plant + "/delay_s", value) ==
              "machine.json: axes.x.plant.delay_s: must be a number from 0 to 1 (seconds)");
}

TEST_CASE("read_machine: a tolerance is a relative bound of a known name") {
    for (const char* value : {"-0.01", "2", "\"5 %\""})
        CHECK(
            refused_value("/axes/x/tolerance/mass", value) ==
            "machine.json: axes.x.tolerance.mass: must be a number from 0 to below 1 (relative: 0.05 is 5 %)");
    CHECK(refused_value("/axes/x/tolerance/colour", "0.1") ==
          "machine.json: axes.x.tolerance.colour: unknown key");
}

TEST_CASE("read_machine: an absent tolerance is noted with what is assumed") {
    const auto machine = read_machine(without("/axes/x", "tolerance"), "m");
    REQUIRE(machine.notes.size() == 1);
    CHECK(machine.notes[0] ==
          "axis x: no tolerance is given for coulomb, viscous, static, stribeck_velocity, mass, "
          "force_constant, delay: 0.05 is assumed.");
}

TEST_CASE("read_machine: keys that belong together come together") {
    CHECK(refusal(without(plant, "stribeck_velocity_m_per_s")) ==
          "machine.json: axes.x.plant.static_N: needs stribeck_velocity_m_per_s");
    CHECK(refusal(without(plant, "static_N")) ==
          "machine.json: axes.x.plant.stribeck_velocity_m_per_s: needs static_N");
    CHECK(refused_value(plant + "/static_N", "100") ==
          "machine.json: axes.x.plant.static_N: must not lie below coulomb_N");
    CHECK(refusal(without(actuator, "dac_range_V")) ==
          "machine.json: axes.x.actuator.dac_bits: needs dac_range_V");
    CHECK(refused_value(plant + "/cogging_N", "[1]") ==
          "machine.json: axes.x.plant.cogging_N: needs cogging_period_m");
    CHECK(refused_value(plant + "/cogging_period_m", "0.03") ==
          "machine.json: axes.x.plant.cogging_period_m: needs cogging_N");
    CHECK(refused_value(plant + "/cogging_phase_rad", "[1]") ==
          "machine.json: axes.x.plant.cogging_phase_rad: must have one entry for each of cogging_N");
    CHECK(refused_value(plant + "/cogging_N", "3") ==
          "machine.json: axes.x.plant.cogging_N: must be an array of numbers");
    CHECK(refused_value(plant + "/cogging_N", "[3, \"a\"]") ==
          "machine.json: axes.x.plant.cogging_N[1]: must be a number");
    CHECK(refused_value(plant + "/cogging_N", "[1, 2, 3, 4, 5, 6, 7, 8, 9]") ==
          "machine.json: axes.x.plant.cogging_N: this version simulates 8 harmonics at most");
    CHECK(refused_value(plant + "/force_constant_N_per_A", "1") ==
          "machine.json: axes.x.plant.force_constant_N_per_A: contradicts force_constant_N_per_V: give one of "
          "them");
}

TEST_CASE("read_machine: a file says where the command was taken, asked when it does not") {
    const auto origin = [](const char* word) {
        const auto machine = read_machine(with(actuator + "/command_is", word), "machine.json");
        CHECK(read_machine(to_json(machine).dump(), "again").axes[0].actuator.command_is ==
              machine.axes[0].actuator.command_is);
        return machine.axes[0].actuator.command_is;
    };
    CHECK(read_machine(std::string_view(example), "m").axes[0].actuator.command_is == command_origin::asked);
    CHECK(origin("\"asked\"") == command_origin::asked);
    CHECK(origin("\"measured\"") == command_origin::measured);
    CHECK(refused_value(actuator + "/command_is", "\"guessed\"") ==
          "machine.json: axes.x.actuator.command_is: must be \"asked\" or \"measured\"");
    CHECK(refused_value(actuator + "/command_is", "1") ==
          "machine.json: axes.x.actuator.command_is: must be a string");
}

TEST_CASE("read_machine: a corner above half the sampling rate is refused") {
    CHECK(
        refused_value(controller + "/velocity_filter_Hz", "1000") ==
        "machine.json: axes.x.controller.velocity_filter_Hz: must lie below half the sampling rate (1000 Hz)");
    CHECK(
        refused_value(controller + "/notch/frequency_Hz", "1200") ==
        "machine.json: axes.x.controller.notch.frequency_Hz: must lie below half the sampling rate (1000 Hz)");
}

TEST_CASE("read_machine: the old name of the notch's width is read with a note, and not beside the new one") {
    auto old = nlohmann::json::parse(with(controller + "/notch", R"({"frequency_Hz": 330, "damping": 0.06})"));
    const auto machine = read_machine(old.dump(), "m");
    CHECK(machine.axes[0].controller->number("notch.width") == 0.06);
    CHECK(machine.notes.at(0) == "axis x: axes.x.controller.notch.damping is the old name of width.");
    CHECK(refused_value(controller + "/notch/damping", "1") ==
          "machine.json: axes.x.controller.notch.damping: is the old name of width, which is there too");
}

TEST_CASE("read_machine: the velocity estimator is one of two") {
    CHECK(refused_value(controller + "/velocity_estimator", "\"kalman\"") ==
          "machine.json: axes.x.controller.velocity_estimator: must be \"filtered_derivative\" or "
          "\"two_sample_mean\"");
    const auto machine = read_machine(with(controller + "/velocity_estimator", "\"two_sample_mean\""), "m");
    CHECK(machine.axes[0].controller->number("velocity_estimator") == 1);
    CHECK(machine.notes.at(0) ==
          "axis x: velocity_filter_Hz is not used by the velocity estimator two_sample_mean.");
}

TEST_CASE("read_machine: a chain of positions names the keys of its drive that say nothing of it") {
    const auto chain = read_machine(
        std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.01, "axes": {"x": {
            "encoder": {"resolution_m": 1e-6},
            "drive": {"command_delay_s": 0.02, "set_point_loss": 0.01, "clock_slip": 1e-4}}}})"),
        "m");
    CHECK(chain.notes.at(0) ==
          "axis x: no plant is described: the axis is a chain of positions, and nothing is "
          "said of forces; not used of drive: clock_slip, set_point_loss.");
}

TEST_CASE(
    "read_machine: without a controller, or with one of unknown kind, the axis is read and a note tells") {
    const auto absent = read_machine(without("/axes/x", "controller"), "m");
    CHECK_FALSE(absent.axes[0].controller);
    CHECK(absent.notes.at(0) == "axis x: no controller is described: diagnosed from the command onwards.");
    const auto strange = read_machine(with(controller, R"({"kind": "vendor", "gain": []})"), "m");
    CHECK_FALSE(strange.axes[0].controller);
    CHECK(
        strange.notes.at(0) ==
        "axis x: controller kind \"vendor\" is not known (known: cascade_p_pi, p_velocity, milling_axis, "
        "linuxcnc_pid, pid, p_pi, sliding_mode, lead_lag, pole_placement, zero_phase, generalized_predictive, "
        "state_feedback, predictive): diagnosed from the command onwards.");
    CHECK(refused_value(controller + "/kind", "7") == "machine.json: axes.x.controller.kind: must be a string");
    CHECK(refused_value(controller + "/velocity_feedforward", "\"1\"") ==
          "machine.json: axes.x.controller.velocity_feedforward: must be a number");
}

TEST_CASE("read_machine: what belongs together is given together") {
    const auto said = [](const std::string& path, const char* value) { return refused_value(path, value); };
    const std::string here = "machine.json: axes.x.plant.";
    CHECK(said(plant + "/friction_drift", "0.2") == here + "friction_drift: needs friction_drift_time_s");
    CHECK(said(plant + "/mode_mass_kg", "20") == here + "mode_mass_kg: needs mode_frequency_Hz");
    CHECK(said(plant + "/ripple_period_m", "0.02") == here + "ripple_period_m: needs ripple");
    CHECK(said(plant + "/gms_weights", "[1]") == here + "gms_weights: needs gms_stiffness_N_per_m");
    CHECK(said(plant + "/friction_position_amplitude", "0.2") ==
          here + "friction_position_amplitude: needs friction_position_period_m");
    CHECK(said("/axes/x/encoder/cyclic_m", "1e-7") ==
          "machine.json: axes.x.encoder.cyclic_m: needs cyclic_period_m");
    CHECK(said("/axes/x/process", R"({"fundamental_Hz": 20})") ==
          "machine.json: axes.x.process.fundamental_Hz: needs force_N");
    CHECK(said("/axes/x/process", R"({"fundamental_Hz": 20, "force_N": [1], "phase_rad": [1, 2]})") ==
          "machine.json: axes.x.process.phase_rad: must have one entry for each of force_N");
}

TEST_CASE("read_machine: every effect that a file describes is in the plant that is simulated") {
    const auto simulated = [](const std::string& path, const char* value) {
        return plant_model(read_machine(with(path, value), "m").axes[0], 2e-7);
    };
    CHECK(simulated(plant + "/backlash_m", "1e-5").backlash == 1e-5);
    CHECK_FALSE(simulated(plant + "/backlash_m", "1e-5").play_has_masses());
    const auto parted = simulated(plant + "/backlash_motor_mass_kg", "1");
    CHECK(parted.mass_before_the_play() == 1);
    CHECK(simulated(plant + "/backlash_motor_coulomb_N", "3").motor_coulomb == 3);
    CHECK(simulated(plant + "/spring_N_per_m", "300").spring == 300);
    CHECK(simulated(plant + "/coupling", "-0.02").coupling == -0.02);
    CHECK(simulated("/axes/x/actuator/lag_s", "0.001").lag == 0.001);
    CHECK(simulated("/axes/x/actuator/drive_limit_V", "4").drive_limit == 4);
    CHECK(simulated("/axes/x/actuator/dead_zone_V", "0.01").dead_zone == 0.01);
    CHECK(simulated("/axes/x/actuator/loss_probability", "0.1").loss == 0.1);
    const auto process =
        simulated("/axes/x/process", R"({"fundamental_Hz": 20, "force_N": [3, 4], "mean_N": 5})");
    CHECK(process.cutting.at(0.0125) ==
          doctest::Approx(3)); // a quarter of the first harmonic, half of the second
    CHECK(process.cutting_mean == 5);
    const auto contact = simulated(plant + "/presliding_length_m", "1e-5").friction.contact;
    CHECK(contact.elements == 4);
    CHECK(contact.share(1e-5) == doctest::Approx(1 - std::exp(-1.0)));
    for (double z : {2e-6, 5e-6, 2e-5, 4e-5}) // four straight pieces stay near the exponential
        CHECK(std::abs(contact.share(z) - (1 - std::exp(-z / 1e-5))) < 0.07);
}

TEST_CASE("read_machine: a play is on one side of the encoder, and what is before it is a part of the mass") {
    CHECK(refused_value(plant + "/backlash_behind_m", "1e-5").find("backlash_motor_mass_kg") !=
          std::string::npos); // it says nothing without
    CHECK(refused_value(plant + "/backlash_motor_mass_kg", "1e6").find("must lie below mass_kg") !=
          std::string::npos);
}

TEST_CASE("read_machine: excluded effects are the format's names") {
    CHECK(refused_value("/excluded_effects", R"(["cogging", "backlsh"])") ==
          "machine.json: excluded_effects[1]: \"backlsh\" is not an effect; did you mean backlash?");
    CHECK(refused_value("/excluded_effects", R"(["gremlins"])") ==
          "machine.json: excluded_effects[0]: \"gremlins\" is not an effect");
    CHECK(refused_value("/excluded_effects", "\"cogging\"") ==
          "machine.json: excluded_effects: must be an array of effect names");
    CHECK(refused_value("/excluded_effects", "[1]") == "machine.json: excluded_effects[0]: must be a string");
}

TEST_CASE("read_machine: a missing file is refused by its name") {
    CHECK_THROWS_WITH_AS(read_machine(std::filesystem::path("/nowhere/machine.json")),
                         "/nowhere/machine.json: no such file", bad_input);
}

TEST_CASE("read_machine: a key is read under its former name, with a note; both names at once are refused") {
    constexpr machine_key key{.name = "gliding_N_s_per_m", .former = {"slip_N_s_per_m"}};
    const auto read = [&](const nlohmann::json& box, axis_kind kind) {
        nlohmann::json content = box;
        std::string noted;
        detail::rename_former(key, {&box, "axes.x.plant", "m.json", kind}, content,
                              [&](const std::string& text) { noted += text; });
        return std::pair(content, noted);
    };
    const auto [linear, noted] = read({{"slip_N_s_per_m", 3}, {"mass_kg", 1}}, axis_kind::linear);
    CHECK(linear == nlohmann::json{{"gliding_N_s_per_m", 3}, {"mass_kg", 1}});
    CHECK(noted == "axes.x.plant.slip_N_s_per_m is now called gliding_N_s_per_m");
    const auto [rotary, told] = read({{"slip_Nm_s_per_rad", 3}}, axis_kind::rotary);
    CHECK(rotary == nlohmann::json{{"gliding_Nm_s_per_rad", 3}});
    CHECK(told == "axes.x.plant.slip_Nm_s_per_rad is now called gliding_Nm_s_per_rad");
    CHECK(read({{"gliding_N_s_per_m", 3}}, axis_kind::linear).second.empty());
    CHECK_THROWS_WITH_AS(
        read({{"slip_N_s_per_m", 3}, {"gliding_N_s_per_m", 4}}, axis_kind::linear),
        "m.json: axes.x.plant.slip_N_s_per_m: is the former name of gliding_N_s_per_m: give one of them",
        bad_input);
}

TEST_CASE("read_machine: an attraction of the contact needs its elements") {
    constexpr const char* key = "/axes/x/plant/gms_attraction_N_per_s";
    CHECK(refused_value(key, "1000") == "machine.json: axes.x.plant.gms_attraction_N_per_s: needs gms_weights");
}

TEST_CASE("read_machine: the schema in docs names the keys that the reader knows, and no others") {
    const auto schema = nlohmann::json::parse(
        detail::read_whole(std::filesystem::path(QUADRANT_SOURCE_DIR "/docs/schema/machine.schema.json")));
    const auto in_schema = [&](const std::string& name) {
        std::set<std::string> out;
        const auto& object = name.empty() ? schema : schema["$defs"][name];
        for (const auto& [key, value] : object["properties"].items()) out.insert(key);
        return out;
    };
    const auto in_reader = [](const auto& numbers, const auto& others) {
        std::set<std::string> out(others.begin(), others.end());
        for (const auto& key : numbers) out.insert(std::string(key.name));
        return out;
    };
    const std::array<detail::tolerance_name, 0> none{};
    std::vector<std::string_view> boxes = detail::boxes_of_effects();
    boxes.insert(boxes.end(), detail::axis_other_keys.begin(), detail::axis_other_keys.end());
    CHECK(in_schema("") == in_reader(none, detail::machine_file_keys));
    CHECK(in_schema("axis") == in_reader(none, boxes));
}

TEST_CASE("check_match: a log of another machine is refused") {
    const auto machine = read_machine(std::string_view(example), "machine.json");
    const auto log = [](double period, const std::vector<std::string>& axes, const std::string& unit) {
        machine_log out;
        out.file = "log.csv";
        out.sample_period_s = period;
        for (const auto& name : axes) {
            auto& axis = out.axes.emplace_back();
            axis.name = name;
            axis.command_unit = unit;
        }
        return out;
    };
    const auto said = [&](const machine_description& m, const machine_log& l) {
        return refusal_of([&] { check_match(m, l); });
    };
    CHECK(said(machine, log(0.0005, {"x"}, "V")) == "accepted");
    CHECK(said(machine, log(0.000504, {"x"}, "V")) == "accepted");
    CHECK(
        said(machine, log(0.00025, {"x"}, "V")) ==
        "log.csv: the sample period is 0.00025 s, sample_period_s of machine.json is 0.0005: correct that, or "
        "import the log with --sample-period 0.0005");
    CHECK(said(machine, log(0.0005, {"x", "y"}, "V")) == "log.csv: axis y is not described in machine.json");
    CHECK(said(machine, log(0.0005, {}, "V")) == "machine.json: axes.x: is not recorded in log.csv");
    CHECK(said(machine, log(0.0005, {"x"}, "A")) ==
          "machine.json: axes.x.plant.force_constant_N_per_V: the command column of log.csv is x_cmd_A");
    auto turning = log(0.0005, {"x"}, "V");
    turning.axes[0].kind = axis_kind::rotary;
    CHECK(said(machine, turning) == "log.csv: axis x is rotary in the log, linear in machine.json");
    const auto newtons = read_machine(without(plant, "force_constant_N_per_V"), "machine.json");
    CHECK(said(newtons, log(0.0005, {"x"}, "N")) == "accepted");
    CHECK(said(newtons, log(0.0005, {"x"}, "V")) == "machine.json: axes.x.plant.force_constant_N_per_V: is "
                                                    "missing; the command column of log.csv is x_cmd_V");
}

TEST_CASE("keep_described: axes that the machine file says nothing of are left out, with a note") {
    const auto machine = read_machine(std::string_view(example), "machine.json");
    machine_log log;
    log.file = "log.csv";
    for (const char* name : {"w", "x", "y"}) log.axes.emplace_back().name = name;
    log.notes = {"log.csv: axis y has no position reference.", "log.csv: axis x has no position reference."};
    keep_described(machine, log);
    REQUIRE(log.axes.size() == 1);
    CHECK(log.axes[0].name == "x");
    CHECK(log.notes ==
          std::vector<std::string>{"log.csv: axis x has no position reference.",
                                   "log.csv: left out, not described in machine.json: axis w, y."});
    keep_described(machine, log);
    CHECK(log.notes.size() == 2);
    machine_log stranger; // no axis in common: check_match says so
    stranger.axes.emplace_back().name = "u";
    keep_described(machine, stranger);
    CHECK(stranger.axes.size() == 1);
    CHECK(stranger.notes.empty());
}
