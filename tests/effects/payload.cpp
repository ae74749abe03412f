// SPDX-License-Identifier: BSL-1.0
#include "arm.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

using namespace arms;

namespace {

/// A rotor with an arm of 0.06 kg and a mass at its end, by the formulas of a point and a slender rod.
struct load {
    double mass = 0.35, length = 0.4, rotor = 0.02;
    static constexpr double link = 0.06;

    arm on() const {
        return {.inertia = rotor + (mass + link / 3) * length * length,
                .gravity = (mass + link / 2) * 9.80665 * length};
    }
};
machine_description file_of(const load& l) {
    auto out = described(l.on());
    out.axes[0].plant.gravity_torque_Nm = l.on().gravity;
    out.axes[0].payload = {.mass_kg = l.mass, .arm_m = l.length, .link_mass_kg = load::link};
    return out;
}
std::vector<std::string> group(const diagnosis_result& d) {
    if (d.causes.empty() || d.causes[0].group_probability < 0.5) return {};
    auto out = d.causes[0].confusable_with;
    out.push_back(d.causes[0].effect);
    std::sort(out.begin(), out.end());
    return out;
}
bool contains(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

} // namespace

TEST_CASE("payload_mass: one mass changes inertia and gravity, and apply moves both") {
    load real;
    const auto file = file_of(real);
    real.mass = 0.5;
    const auto d = diagnose(file, run(real.on()));
    named(d, "payload_mass", "payload.mass_kg", 0.5, 0.03);
    const auto better = apply(file, d);
    CHECK(*better.axes[0].payload.mass_kg == doctest::Approx(0.5).epsilon(0.03));
    CHECK(better.axes[0].plant.mass_kg == doctest::Approx(real.on().inertia).epsilon(0.03));
    CHECK(*better.axes[0].plant.gravity_torque_Nm == doctest::Approx(real.on().gravity).epsilon(0.03));
}
TEST_CASE("payload_mass: a payload that was taken off is found to be none" * doctest::test_suite("all")) {
    load real;
    const auto file = file_of(real);
    real.mass = 0;
    const auto d = diagnose(file, run(real.on()));
    CAPTURE(said(d));
    REQUIRE(claims(d) == std::vector<std::string>{"payload_mass"});
    CHECK(value_of(d.causes[0], "payload.mass_kg").value < 0.01);
}
TEST_CASE("arm_length: another length is not called another mass" * doctest::test_suite("all")) {
    load real;
    const auto file = file_of(real);
    real.length = 0.5;
    named(diagnose(file, run(real.on())), "arm_length", "payload.arm_m", 0.5, 0.03);
}
TEST_CASE("effects of a rotary axis alone: their labels have no word that a rotary axis replaces") {
    for (const effect* e : every_effect())
        if (e->rotary_only) CHECK(text_of(e->label, axis_kind::rotary) == e->label);
}
TEST_CASE("payload_mass, arm_length: one group where the inertia of the payload does not show" *
          doctest::test_suite("all")) {
    load real;
    real.rotor = 0.3; // behind a gear; its owner knows the inertia to a tenth
    auto file = file_of(real);
    file.axes[0].tolerance.given["mass"] = 0.1;
    real.mass = 0.5;
    const auto d = diagnose(file, run(real.on()));
    CAPTURE(said(d));
    CHECK(contains(group(d), "payload_mass"));
    CHECK(contains(group(d), "arm_length"));
}
TEST_CASE("payload_mass: a payload as described is nobody's fault, and one in a level plane has no weight" *
          doctest::test_suite("all")) {
    const load real;
    const auto d = diagnose(file_of(real), run(real.on()));
    CAPTURE(said(d));
    CHECK(d.verdict <= verdict::within_tolerance);
    load heavy;
    heavy.mass = 0.5;
    arm level = real.on(), turning = heavy.on();
    level.gravity = turning.gravity = 0;
    auto file = described(level);
    file.axes[0].payload = file_of(real).axes[0].payload;
    const auto seen = diagnose(file, run(turning));
    CAPTURE(said(seen));
    CHECK(contains(group(seen), "payload_mass"));
    for (const auto& p : seen.causes[0].parameters) CHECK(p.key != "gravity_torque_Nm");
}
TEST_CASE("payload_mass: a file with more payload than inertia or gravity is refused, and so is one on a "
          "linear axis") {
    auto file = to_json(file_of({}));
    auto& axis = file["axes"]["q"];
    CHECK(to_json(read_machine(file.dump(), "m.json"))["axes"]["q"]["payload"]["link_mass_kg"] == 0.06);
    axis["payload"]["arm_m"] = 1.0;
    CHECK_THROWS_WITH_AS(read_machine(file.dump(), "m.json"), doctest::Contains("makes a larger inertia"),
                         bad_input);
    axis["payload"]["arm_m"] = 0.4;
    axis["plant"]["gravity_torque_Nm"] = 1.0;
    CHECK_THROWS_WITH_AS(read_machine(file.dump(), "m.json"),
                         doctest::Contains("than gravity_torque_Nm, of which it is a part"), bad_input);
    axis["payload"].erase("arm_m");
    CHECK_THROWS_WITH_AS(read_machine(file.dump(), "m.json"), "m.json: axes.q.payload.mass_kg: needs arm_m",
                         bad_input);
}
