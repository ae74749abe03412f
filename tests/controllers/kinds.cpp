// SPDX-License-Identifier: BSL-1.0
// Every kind of controller of machine files: reading, writing, replay, the closed loop, the key that differs.
#include "shared.hpp"
#include "workshop.hpp"

#include <quadrant/diagnosis/write_machine.hpp>

#include <cstdio>
#include <doctest/doctest.h>

using namespace controllers_workshop;

TEST_CASE("controller kinds: every kind has an axis in the machine of these tests, with all its keys") {
    CHECK(machine().axes.size() == controller_kinds().size());
    for (const controller_kind* kind : controller_kinds()) {
        CAPTURE(kind->name);
        CHECK(axis_of(kind->name).controller->kind == kind->name);
        std::vector<std::string_view> names;
        for (const controller_key& key : kind->keys) {
            CHECK(std::find(names.begin(), names.end(), key.name) == names.end());
            names.push_back(key.name);
            CHECK_FALSE(key.says.empty());
            if (!key.scale_of.empty()) CHECK(kind->key(key.scale_of).needed);
        }
        for (const auto& f : {kind->coulomb, kind->viscous, kind->acceleration})
            if (!f.key.empty()) CHECK(kind->key(f.key).form == key_form::number);
    }
}

TEST_CASE("controller kinds: what is written is what was read, also of a rotary axis") {
    const auto written = to_json(machine());
    const auto again = read_machine(written.dump(), "m.json");
    for (std::size_t i = 0; i < again.axes.size(); ++i) {
        CHECK(again.axes[i].controller->kind == machine().axes[i].controller->kind);
        CHECK(again.axes[i].controller->values == machine().axes[i].controller->values);
    }
    auto turning = machine();
    for (auto& axis : turning.axes) axis.kind = axis_kind::rotary;
    const auto rotary = to_json(turning);
    CHECK(to_json(read_machine(rotary.dump(), "c.json")) == rotary);
    CHECK(rotary["axes"]["pid"]["controller"].contains("gain_V_per_rad"));
    CHECK(rotary["axes"]["linuxcnc_pid"]["controller"]["units_per_rad"] == 1000);
}

TEST_CASE("controller kinds: a key of another kind is refused, a needed one that is missing is named") {
    auto json = nlohmann::json::parse(to_json(machine()).dump());
    for (const controller_kind* kind : controller_kinds()) {
        const std::string name(kind->name);
        CAPTURE(name);
        auto strange = json;
        strange["axes"][name]["controller"]["colour"] = 1;
        CHECK_THROWS_WITH_AS(
            read_machine(strange.dump(), "m"),
            doctest::Contains(fmt::format("axes.{}.controller.colour: unknown key", name).c_str()), bad_input);
        for (const controller_key& key : kind->keys) {
            if (!key.needed || key.in_box()) continue;
            auto less = json;
            less["axes"][name]["controller"].erase(std::string(key.name));
            CHECK_THROWS_WITH_AS(
                read_machine(less.dump(), "m"),
                doctest::Contains(fmt::format("axes.{}.controller.{}: is missing", name, key.name).c_str()),
                bad_input);
        }
    }
}

TEST_CASE("controller kinds: the loop of each follows a smooth motion within half its stroke, and its replay "
          "is the log to "
          "one DAC step") {
    for (const axis_description& axis : machine().axes) {
        CAPTURE(axis.name);
        const auto log = logged(axis, *axis.controller);
        double error = 0, effort = 0;
        for (std::size_t k = 0; k < log.position.size(); ++k) {
            error = std::max(error, std::abs(log.reference[k] - log.position[k]));
            effort = std::max(effort, std::abs(log.command[k]));
        }
        CHECK(error < 0.01);
        CHECK(effort > 0.1);
        CHECK(effort < 10);
        const auto replayed = replay_controller(*axis.controller, axis.actuator, machine().sample_period_s,
                                                loop_columns::of(log));
        double worst = 0;
        for (std::size_t k = 100; k < replayed.size(); ++k)
            worst = std::max(worst, std::abs(replayed[k] - log.command[k]));
        CHECK(worst <= 1.01 * dac(axis));
    }
}

TEST_CASE("controller kinds: a log that begins in the middle of a motion is replayed to rounding, 50 ms on") {
    for (const axis_description& axis : machine().axes) {
        CAPTURE(axis.name);
        auto c = *axis.controller; // what a memory has learnt before the first row no log can show
        std::erase_if(c.values, [](const auto& v) { return v.first.starts_with("memory."); });
        const auto log = cropped(logged(axis, c), 700);
        const auto replayed =
            replay_controller(c, axis.actuator, machine().sample_period_s, loop_columns::of(log));
        std::vector<double> difference;
        for (std::size_t k = 100; k < replayed.size(); ++k) difference.push_back(replayed[k] - log.command[k]);
        CHECK(rms(difference) < 3 * dac(axis));
        CHECK_FALSE(judged(axis, c, log).differs);
    }
}

TEST_CASE(
    "controller kinds: a key that is off by 10 % and shows in the command is found, alone or with those that "
    "correct as well" *
    doctest::test_suite("all")) {
    for (const axis_description& axis : machine().axes) {
        CAPTURE(axis.name);
        const auto& described = *axis.controller;
        bool one_was_seen = false;
        for (const auto& key : detail::searched_keys(described)) {
            CAPTURE(key.key);
            if (one_was_seen && !all_tests()) break;
            auto real = described;
            double& value = key.of(real);
            if (value == 0) continue;
            value *= 1.1;
            const auto found = judged(axis, described, logged(axis, real));
            if (all_tests())
                std::printf("%s %s: %s, %.3g V rms; %s %s, %zu more\n", axis.name.c_str(), key.key.c_str(),
                            found.differs ? "differs" : "not seen", found.difference_rms, found.key.c_str(),
                            found.mended ? "mends" : "does not mend", found.alternatives.size());
            if (!found.differs) continue;
            one_was_seen = true;
            CHECK(found.mended);
            const bool other = std::any_of(found.alternatives.begin(), found.alternatives.end(),
                                           [&](const auto& a) { return a.key == key.key; });
            CHECK((found.key == key.key || other));
            if (found.key == key.key) CHECK(std::abs(found.value / value - 1) < 0.02);
        }
        CHECK(one_was_seen);
    }
}
