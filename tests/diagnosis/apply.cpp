// SPDX-License-Identifier: BSL-1.0
// Long: what is written back: one machine with its diagnosis, a case for each rule.
#include "quadrant/diagnosis/apply.hpp"
#include "quadrant/diagnosis/controller/cascade_p_pi.hpp"
#include "quadrant/diagnosis/machine_file/machine_keys.hpp"
#include "quadrant/diagnosis/model/plant_model.hpp"
#include "quadrant/diagnosis/read_diagnosis.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/write_diagnosis.hpp"
#include "quadrant/diagnosis/write_machine.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

const char* const machine_text = R"({
  "schema": "quadrant.machine/1", "sample_period_s": 0.0005, "excluded_effects": ["backlash"],
  "axes": {
    "y": {"plant": {"force_constant_N_per_A": 90, "mass_kg": 50}},
    "x": {"plant": {"static_N": 177, "mass_kg": 340, "force_constant_N_per_V": 1450, "coulomb_N": 122,
                    "stribeck_velocity_m_per_s": 0.0022},
          "encoder": {"resolution_m": 2.5e-7},
          "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 150, "velocity_gain_V_s_per_m": 60,
                         "velocity_filter_Hz": 150, "notch": {"frequency_Hz": 330, "width": 0.06}}}
  }
})";

parameter_estimate value(const char* key, std::vector<double> numbers) {
    parameter_estimate p{.key = key, .values = {}};
    for (double x : numbers) p.values.push_back({x, x, x});
    return p;
}

cause named(const char* axis, const char* effect, std::vector<parameter_estimate> parameters,
            bool described = false, double probability = 0.9) {
    cause c;
    c.axis = axis;
    c.effect = effect;
    c.described = described;
    c.probability = c.group_probability = probability;
    c.parameters = std::move(parameters);
    return c;
}

diagnosis_result of(std::vector<cause> causes) {
    diagnosis_result d;
    d.verdict = verdict::explained;
    d.axes.resize(2);
    d.axes[0].name = "x";
    d.axes[1].name = "y";
    d.causes = std::move(causes);
    return d;
}

applied_diagnosis applied(const diagnosis_result& d, double at_least = 0.5) {
    return apply(machine_text, "m.json", d, at_least);
}

std::string refusal(const diagnosis_result& d) {
    try {
        applied(d);
    } catch (const bad_input& fault) {
        return fault.what();
    }
    return "accepted";
}

std::string read_back_refusal(const nlohmann::ordered_json& json) {
    try {
        read_diagnosis(json.dump(), "d.json");
    } catch (const bad_input& fault) {
        return fault.what();
    }
    return "accepted";
}

diagnosis_result full() {
    auto d = of({named("x", "cogging",
                       {value("cogging_period_m", {0.03}), value("cogging_N", {4, 2}),
                        value("cogging_phase_rad", {0.1, 0.2})})});
    d.causes[0].confusable_with = {"force_ripple"};
    d.causes[0].readings = {{"force_ripple", {value("ripple", {0.03})}}};
    d.causes[0].shrink = {0.9, 0.8, 0.95};
    d.causes[0].exciting_motion = "slow strokes";
    d.axes[0].where = {{"block", "mechanics", "cogging", {0.8, 0.7, 0.9}, "causes"},
                       {"velocity", "", "fast", {0.2, 0.1, 0.3}, ""}};
    d.axes[0].gap.force_rms_N = 1e-13; // smaller than any value of a machine
    d.axes[0].evaluated_on = "the hold-out log";
    d.share_unexplained = 0.1;
    d.remaining_structure = "some";
    d.next = {"slow strokes", {"cogging", "force_ripple"}, 3};
    d.notes = {"a note"};
    d.causes[0].parameters[0].on_bound = true;
    d.not_seen = {{"x", "a scale error", "a laser interferometer"}};
    d.machine_file = "m.json";
    d.machine_sha256 = std::string(64, 'a');
    return d;
}

} // namespace

TEST_CASE("apply: a missing effect is written, its key order, every other value and their spelling stay") {
    const auto out = applied(of({named("x", "constant_force", {value("constant_force_N", {12.5})})}));
    auto wanted = nlohmann::ordered_json::parse(machine_text);
    wanted["axes"]["x"]["plant"]["constant_force_N"] = 12.5;
    CHECK(out.machine.dump() == wanted.dump());
    REQUIRE(out.changes.size() == 1);
    CHECK(out.changes[0].path == "axes.x.plant.constant_force_N");
    CHECK(out.changes[0].before == "");
    CHECK(out.changes[0].after == "12.5");
    CHECK(out.changes[0].reason == "constant_force");
}

TEST_CASE(
    "apply: each box gets its keys, arrays stay arrays, and the force constant is that of the column's unit") {
    const auto out = applied(of(
        {named("x", "cogging",
               {value("cogging_period_m", {0.03}), value("cogging_N", {4}), value("cogging_phase_rad", {0.1})}),
         named("x", "encoder_quantization", {value("encoder.resolution_m", {1e-6})}, true),
         named("x", "actuator_lag", {value("actuator.lag_s", {0.001})}),
         named("x", "cutting_force",
               {value("process.fundamental_Hz", {20}), value("process.force_N", {3, 1}),
                value("process.phase_rad", {0, 1}), value("process.mean_N", {2})}),
         named("x", "controller_mismatch", {value("notch.frequency_Hz", {300})}, true),
         named("y", "force_constant", {value("force_constant_N_per_V", {80})}, true)}));
    const auto& x = out.machine["axes"]["x"];
    CHECK(x["plant"]["cogging_N"].dump() == "[4.0]");
    CHECK(x["plant"]["cogging_period_m"] == 0.03);
    CHECK(x["encoder"]["resolution_m"] == 1e-6);
    CHECK(x["actuator"]["lag_s"] == 0.001);
    CHECK(x["process"]["force_N"].dump() == "[3.0,1.0]");
    CHECK(x["controller"]["notch"]["frequency_Hz"] == 300);
    CHECK(x["controller"]["notch"]["width"] == 0.06);
    CHECK(out.machine["axes"]["y"]["plant"].dump() == R"({"force_constant_N_per_A":80.0,"mass_kg":50})");
}

TEST_CASE("apply: a number that a cause gave is not written over by where calibration had taken it") {
    auto d = of({named("x", "mass", {value("mass_kg", {410})}, true)});
    d.axes[0].calibrated = {value("mass_kg", {357}), value("coulomb_N", {125})};
    const auto plant = applied(d).machine["axes"]["x"]["plant"];
    CHECK(plant["mass_kg"] == 410);
    CHECK(plant["coulomb_N"] == 125);
    // A cause that is not sure enough to be written leaves its number to calibration.
    d.causes[0].probability = d.causes[0].group_probability = 0.6;
    CHECK(applied(d, 0.9).machine["axes"]["x"]["plant"]["mass_kg"] == 357);
    // So does an effect of one's own, which has no key in the file.
    d.causes[0].probability = d.causes[0].group_probability = 0.9;
    d.own_effects = {d.causes[0].effect};
    CHECK(applied(d).machine["axes"]["x"]["plant"]["mass_kg"] == 357);
}

TEST_CASE("apply: the excess of static friction stays when the Coulomb level moves, as in the model that was "
          "fitted") {
    const auto out = applied(of({named("x", "coulomb_friction", {value("coulomb_N", {190})}, true)}));
    CHECK(out.machine["axes"]["x"]["plant"]["static_N"] == doctest::Approx(190 + 177 - 122));
    REQUIRE(out.changes.size() == 2);
    CHECK(out.changes[1].reason == "moves with the friction");
    const auto m = apply(read_machine(std::string_view(machine_text), "m.json"),
                         of({named("x", "coulomb_friction", {value("coulomb_N", {190})}, true)}));
    const plant_model before(read_machine(std::string_view(machine_text), "m.json").axes[0], 2e-7),
        after(m.axes[0], 2e-7);
    CHECK(after.friction.coulomb == 190);
    CHECK(after.friction.excess == doctest::Approx(before.friction.excess));
}

TEST_CASE("apply: the way in which friction gives way stays when its level moves") {
    auto json = nlohmann::ordered_json::parse(machine_text);
    json["axes"]["x"]["plant"]["gms_weights"] = {0.25, 0.75};
    json["axes"]["x"]["plant"]["gms_stiffness_N_per_m"] = {1e7, 2e7};
    const auto d = of({named("x", "coulomb_friction", {value("coulomb_N", {190})}, true)});
    const auto before = read_machine(json.dump(), "m.json");
    const auto lengths = [](const machine_description& m) {
        return plant_model(m.axes[0], 2e-7).friction.contact.lengths_as_described;
    };
    const auto a = lengths(before), b = lengths(apply(before, d));
    for (std::size_t i = 0; i < 2; ++i) CHECK(std::abs(b[i] / a[i] - 1) < 1e-12);
}

TEST_CASE("apply: a suspect is left out with a note unless it is asked for") {
    auto d = of({named("x", "constant_force", {value("constant_force_N", {12.5})}, false, 0.4),
                 named("x", "controller_mismatch", {}, true)});
    d.causes[0].gap_before_force_rms_N.value = 14;
    d.causes[0].gap_after_force_rms_N.value = 3;
    const auto out = applied(d);
    CHECK(out.changes.empty());
    REQUIRE(out.notes.size() == 2);
    CHECK(out.notes[0].find("probability 0.40") != std::string::npos);
    CHECK(out.notes[0].find("in the diagnosis it took the force from 14 N to 3 N") != std::string::npos);
    CHECK(out.notes[1].find("no value") != std::string::npos);
    CHECK(applied(d, 0).changes.size() == 1);
}

TEST_CASE("apply: a diagnosis of another machine is refused, and one that was applied before") {
    auto other = of({});
    other.axes[0].name = "z";
    CHECK(refusal(other).find("m.json: axes.z: is missing; the diagnosis is of another machine") == 0);
    CHECK(refusal(of({named("x", "coulomb_friction", {value("coulomb_N", {100})})}))
              .find("has coulomb_friction already") != std::string::npos);
    CHECK(refusal(of({named("y", "controller_mismatch", {value("velocity_filter_Hz", {100})}, true)}))
              .find("axes.y.controller: is missing") != std::string::npos);
    // A Stribeck term that adds nothing is none.
    auto flat = nlohmann::ordered_json::parse(machine_text);
    flat["axes"]["x"]["plant"]["static_N"] = 122;
    CHECK_NOTHROW(
        apply(flat.dump(), "m.json", of({named("x", "stribeck_friction", {value("static_N", {150})})})));
}

TEST_CASE("apply: values that no machine file may hold are refused, with the key") {
    CHECK(refusal(of({named("x", "mass", {value("mass_kg", {-3})}, true)})) ==
          "m.json with the diagnosis applied: axes.x.plant.mass_kg: must be a number > 0");
    CHECK(refusal(of({named("x", "mass", {value("mass_g", {3})}, true)})).find("did you mean mass_kg?") !=
          std::string::npos);
    CHECK_THROWS_AS(apply("{}", "m.json", of({})), bad_input);
}

TEST_CASE(
    "apply: an effect of the caller's own is left out of a file with a note, and the others are written") {
    auto d = of({named("x", "air_drag", {value("air_drag_N_s2_per_m2", {3000})}),
                 named("x", "constant_force", {value("constant_force_N", {12.5})})});
    d.own_effects = {"air_drag"};
    const auto out = applied(d);
    CHECK(out.changes.size() == 1);
    REQUIRE(out.notes.size() == 1);
    CHECK(out.notes[0] ==
          "air_drag of axis x is left out: it is an effect of your own, and a machine file has no key for it");
}

TEST_CASE(
    "apply: the numbers of a controller of the caller's own are corrected in a description, and it stays") {
    auto machine = read_machine(std::string_view(machine_text), "m.json");
    auto& x = machine.axes[0].name == "x" ? machine.axes[0] : machine.axes[1];
    x.controller->own = own_control{{{"gain", 2}, {"lead", 3}}, {}};
    const auto out = apply(machine, of({named("x", "controller_mismatch", {value("lead", {4})}, true)}));
    const auto& keys = (out.axes[0].name == "x" ? out.axes[0] : out.axes[1]).controller->own->keys;
    CHECK(keys[0].value == 2);
    CHECK(keys[1].value == 4);
}

TEST_CASE("write_machine: what is read from it is what was written, for every key of the format") {
    nlohmann::json all = nlohmann::json::parse(machine_text);
    auto& x = all["axes"]["x"];
    double next = 0.11;
    const auto fill = [&](nlohmann::json& box, const std::string& key, auto value) {
        if (!box.contains(key)) box[key] = value;
    };
    for (const effect* e : every_effect())
        for (const machine_key& key : e->keys) {
            if (e->rotary_only || key.unit_of_command) continue;
            if (key.box() == "drive") continue; // a kind has some of them: below
            auto& box = x[std::string(key.box())];
            if (key.shape == key_shape::number)
                fill(box, std::string(key.key()), key.rule.holds(next + 0.001) ? next += 0.001 : 1 + next);
            else
                fill(box, std::string(key.key()), std::vector<double>{0.25, 0.75});
        }
    for (const char* key : {"backlash_behind_m", "backlash_motor_mass_kg"}) // of another axis: below
        x["plant"].erase(key);
    for (const auto& key : detail::actuator_keys) fill(x["actuator"], key.name, next += 0.001);
    for (const auto& key : controllers::cascade_p_pi.keys)
        if (!key.in_box() && key.form == key_form::number)
            fill(x["controller"], std::string(key.name), next += 0.001);
    for (const auto& t : detail::tolerance_names(axis_kind::linear))
        x["tolerance"][std::string(t.name)] = next += 0.001;
    x["actuator"]["dac_bits"] = 16;
    x["controller"]["velocity_estimator"] = "two_sample_mean";
    const auto machine = read_machine(all.dump(), "m.json");
    nlohmann::json written = to_json(machine);
    written["axes"]["x"]["plant"]["mass_kg"] = 340; // whole numbers come back as floating point
    CHECK(read_machine(written.dump(), "m.json").axes.size() == 2);
    const auto flat_wanted = all.flatten(), flat_written = written.flatten();
    for (const auto& entry : flat_wanted.items()) {
        const std::string path = entry.key();
        CAPTURE(path);
        REQUIRE(flat_written.contains(path));
        if (entry.value().is_number())
            CHECK(flat_written[path].get<double>() == entry.value().get<double>());
        else
            CHECK(flat_written[path] == entry.value());
    }
    auto turning = machine; // the same numbers as rotary axes
    for (auto& axis : turning.axes) axis.kind = axis_kind::rotary;
    auto rotary = to_json(turning);
    auto& arm = rotary["axes"]["x"]; // and what only these have
    arm["plant"].update({{"gravity_torque_Nm", 30}, {"gravity_phase_rad", 0.1}});
    arm["payload"] = {{"mass_kg", 5}, {"arm_m", 0.5}, {"link_mass_kg", 1}};
    arm["tolerance"]["gravity_torque"] = 0.1;
    for (const effect* e : every_effect())
        for (const machine_key& key : e->keys)
            if (e->rotary_only) CHECK(arm[std::string(key.box())].contains(key.key()));
    rotary = to_json(read_machine(rotary.dump(), "c.json"));
    CHECK(nlohmann::json(rotary["axes"]["x"]["payload"]) ==
          nlohmann::json{{"mass_kg", 5}, {"arm_m", 0.5}, {"link_mass_kg", 1}});
    CHECK(rotary["axes"]["x"]["tolerance"]["gravity_torque"] == 0.1);
    CHECK(to_json(read_machine(rotary.dump(), "c.json")) == rotary);
    CHECK(rotary["axes"]["x"]["plant"]["gms_stiffness_Nm_per_rad"].dump() == "[0.25,0.75]");
    CHECK(rotary["axes"]["x"]["controller"].contains("acceleration_feedforward_V_s2_per_rad"));
}

TEST_CASE("write_machine: a play between two masses is written as it was read, linear and rotary") {
    auto file = nlohmann::json::parse(machine_text);
    file["axes"]["x"]["plant"].update(
        {{"backlash_behind_m", 1e-5}, {"backlash_motor_mass_kg", 100}, {"backlash_motor_coulomb_N", 30}});
    auto machine = read_machine(file.dump(), "m.json");
    const auto linear = to_json(machine)["axes"]["x"]["plant"];
    CHECK(linear["backlash_behind_m"] == 1e-5);
    CHECK(linear["backlash_motor_mass_kg"] == 100);
    CHECK(linear["backlash_motor_coulomb_N"] == 30);
    for (auto& axis : machine.axes) axis.kind = axis_kind::rotary;
    const auto rotary = to_json(machine)["axes"]["x"]["plant"];
    CHECK(rotary["backlash_behind_rad"] == 1e-5);
    CHECK(rotary["backlash_motor_inertia_kg_m2"] == 100);
    CHECK(rotary["backlash_motor_coulomb_Nm"] == 30);
}

TEST_CASE("apply: a rotary axis gets its keys in rad and N m, and what moves with them") {
    auto turning = read_machine(std::string_view(machine_text), "m.json");
    for (auto& axis : turning.axes) axis.kind = axis_kind::rotary;
    const std::string file = to_json(turning).dump();
    auto d = of({named("x", "coulomb_friction", {value("coulomb_Nm", {190})}, true),
                 named("x", "cogging", {value("cogging_period_rad", {0.1}), value("cogging_Nm", {4})}),
                 named("x", "encoder_quantization", {value("encoder.resolution_rad", {1e-6})}, true),
                 named("y", "force_constant", {value("torque_constant_Nm_per_V", {80})}, true),
                 named("y", "constant_force", {value("constant_torque_Nm", {3})}, false, 0.2)});
    CHECK_THROWS_WITH_AS(apply(file, "m.json", d),
                         "m.json: axes.x: is a rotary axis; the diagnosis is of another machine", bad_input);
    for (auto& axis : d.axes) axis.kind = axis_kind::rotary;
    const auto out = apply(file, "m.json", read_diagnosis(to_json(d).dump(), "d.json"));
    const auto& x = out.machine["axes"]["x"];
    CHECK(x["plant"]["coulomb_Nm"] == 190);
    CHECK(x["plant"]["static_Nm"] == 190 + 177 - 122);
    CHECK(x["plant"]["cogging_Nm"].dump() == "[4.0]");
    CHECK(x["encoder"]["resolution_rad"] == 1e-6);
    CHECK(out.machine["axes"]["y"]["plant"]["torque_constant_Nm_per_A"] == 80);
    REQUIRE(out.notes.size() == 1);
    CHECK(out.notes[0].ends_with("it took the torque from 0 N m to 0 N m"));
}

TEST_CASE("read_diagnosis: what to_json wrote comes back whole") {
    const nlohmann::json json = to_json(full()); // the order of parameters is free
    const nlohmann::json again = to_json(read_diagnosis(json.dump(), "d.json"));
    CHECK(again == json);
    CHECK(json["files"]["machine"]["name"] == "m.json");
    CHECK(json["causes"][0]["parameters"]["cogging_period_m"]["on_bound"] == true);
    CHECK(json["not_seen"][0]["instrument"] == "a laser interferometer");
}

TEST_CASE("read_diagnosis: the fuzzer's seed is a diagnosis that can be applied") {
    const auto d = read_diagnosis(std::filesystem::path(QUADRANT_SOURCE_DIR "/tests/fuzz/diagnosis.json"));
    CHECK(applied(d, 0).changes.size() > 2);
}

TEST_CASE("read_diagnosis: what is wrong is told by its key") {
    const auto with = [](const char* pointer, nlohmann::ordered_json to) {
        auto json = to_json(full());
        json[nlohmann::ordered_json::json_pointer(pointer)] = std::move(to);
        return read_back_refusal(json);
    };
    CHECK(with("/schema", "quadrant.machine/1") ==
          "d.json: schema: must be \"quadrant.diagnosis/1\"; this file is \"quadrant.machine/1\"");
    CHECK(with("/verdict", "perhaps").find("d.json: verdict: must be") == 0);
    CHECK(with("/causes/0/effect", "coging") ==
          "d.json: causes[0].effect: \"coging\" is not an effect; did you mean "
          "cogging?");
    CHECK(with("/causes/0/axis", "z") == "d.json: causes[0].axis: \"z\" is not one of the diagnosis' axes");
    CHECK(with("/causes/0/probability", 1.5).find("causes[0].probability: must be a number from 0 to 1") !=
          std::string::npos);
    CHECK(with("/causes/0/parameters/cogging_N/ci95", nlohmann::ordered_json::array({1, 2})).find("ci95") !=
          std::string::npos);
    CHECK(with("/causes/0/parameters/cogging_period_m/value", "x") ==
          "d.json: causes[0].parameters.cogging_period_m.value: must be a number");
    CHECK(with("/axes/x/gap/force_rms_N", nullptr) == "d.json: axes.x.gap.force_rms_N: must be a number");
    CHECK(with("/notes", "no").find("notes: must be an array") != std::string::npos);
    CHECK(with("/of_a_later_version", 1) == "accepted");
    CHECK(with("/own_effects", nlohmann::ordered_json::array({"gremlins"})) == "accepted");
    auto gremlins = to_json(full());
    gremlins["causes"][0]["effect"] = "gremlins";
    CHECK(read_back_refusal(gremlins).find("\"gremlins\" is not an effect") != std::string::npos);
    gremlins["own_effects"] = {"gremlins"};
    CHECK(read_back_refusal(gremlins) == "accepted");
    auto bare = to_json(full()); // docs/formats.md's keys alone
    for (const char* key :
         {"described", "readings", "gap_before_command_rms_V", "gap_after_command_rms_V", "exciting_motion"})
        bare["causes"][0].erase(key);
    bare["axes"]["x"].erase("gap_after");
    bare.erase("notes");
    CHECK(read_back_refusal(bare) == "accepted");
}
