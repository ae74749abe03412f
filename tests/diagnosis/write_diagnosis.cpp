// SPDX-License-Identifier: BSL-1.0
// Long: one writer; TEST_CASE() of the format checks one field after the other.
#include "quadrant/diagnosis/write_diagnosis.hpp"

#include <csignal>
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <fstream>
#include <limits>
#include <sstream>

using namespace quadrant::diagnosis;

namespace {

diagnosis_result one_cause() {
    diagnosis_result d;
    d.verdict = verdict::explained;
    d.share_unexplained = 0.125;
    d.remaining_structure = "nothing";
    d.next = {"Move slowly.", {"mass", "force_constant"}, 1.5, 0.25, "simulated", "x"};
    d.next.period_s = 0.5;
    d.next.reference = {0.1, 0.125};
    d.notes = {"a note"};
    axis_result a;
    a.name = "x";
    a.verdict = verdict::explained;
    a.gap = {1, 2, 3, 4, 5, 6};
    a.gap_after = {.force_rms_N = 0.5};
    a.where = {{"block", "mechanics", "friction", {0.75, 0.5, 1}, "causes"},
               {"velocity", "", "a step", {0.5, 0.25, 0.75}, ""}};
    a.evaluated_on = "holdout.csv";
    d.axes = {a};
    cause c;
    c.axis = "x";
    c.effect = "cogging";
    c.probability = 0.875;
    c.group_probability = 0.9375;
    c.confusable_with = {"force_ripple"};
    c.parameters = {{"cogging_period_m", {{0.03125, 0.03, 0.0325}}}, {"cogging_N", {{3, 2, 4}, {1, 0, 2}}}};
    c.readings = {{"force_ripple", {{"ripple", {{0.5, 0.25, 0.75}}}}}};
    c.gap_before_force_rms_N = {4, 3, 5};
    c.gap_after_force_rms_N = {0.5, 0.25, 0.75};
    c.gap_before_position_rms_m = {1, 0, 2};
    c.gap_after_position_rms_m = {0.125, 0, 1};
    c.gap_before_command_rms_V = {3, 2, 4};
    c.gap_after_command_rms_V = {0.25, 0, 1};
    c.shrink = {0.875, 0.75, 1};
    c.exciting_motion = "slow strokes";
    d.causes = {c};
    return d;
}

std::filesystem::path scratch() {
    static const auto folder = [] {
        auto path = std::filesystem::temp_directory_path() / fmt::format("quadrant_write_aside_{}", getpid());
        std::filesystem::create_directory(path);
        return path;
    }();
    return folder;
}

std::string contents(const std::filesystem::path& path) {
    std::ostringstream out;
    out << std::ifstream(path).rdbuf();
    return out.str();
}

} // namespace

TEST_CASE("to_json: a diagnosis comes out key by key as the format says") {
    CHECK(to_json(one_cause()).dump(1) == R"({
 "schema": "quadrant.diagnosis/1",
 "verdict": "explained",
 "axes": {
  "x": {
   "verdict": "explained",
   "kind": "linear",
   "command_unit": "V",
   "gap": {
    "position_rms_m": 1.0,
    "position_peak_m": 2.0,
    "command_rms_V": 3.0,
    "force_rms_N": 4.0,
    "noise_floor_force_rms_N": 5.0,
    "bandwidth_Hz": 6.0
   },
   "gap_after": {
    "position_rms_m": 0.0,
    "position_peak_m": 0.0,
    "command_rms_V": 0.0,
    "force_rms_N": 0.5,
    "noise_floor_force_rms_N": 0.0,
    "bandwidth_Hz": 0.0
   },
   "where": [
    {
     "view": "block",
     "block": "mechanics",
     "finding": "friction",
     "share": 0.75,
     "share_ci95": [
      0.5,
      1.0
     ],
     "basis": "causes"
    },
    {
     "view": "velocity",
     "finding": "a step",
     "share": 0.5,
     "share_ci95": [
      0.25,
      0.75
     ]
    }
   ],
   "calibrated": {},
   "calibrated_with_suspects": {},
   "evaluated_on": "holdout.csv"
  }
 },
 "causes": [
  {
   "axis": "x",
   "effect": "cogging",
   "described": false,
   "probability": 0.875,
   "group_probability": 0.9375,
   "confusable_with": [
    "force_ripple"
   ],
   "parameters": {
    "cogging_period_m": {
     "value": 0.03125,
     "ci95": [
      0.03,
      0.0325
     ]
    },
    "cogging_N": {
     "value": [
      3.0,
      1.0
     ],
     "ci95": [
      [
       2.0,
       4.0
      ],
      [
       0.0,
       2.0
      ]
     ]
    }
   },
   "with_suspects": {},
   "readings": [
    {
     "effect": "force_ripple",
     "parameters": {
      "ripple": {
       "value": 0.5,
       "ci95": [
        0.25,
        0.75
       ]
      }
     }
    }
   ],
   "gap_before_force_rms_N": 4.0,
   "gap_after_force_rms_N": 0.5,
   "gap_before_position_rms_m": 1.0,
   "gap_after_position_rms_m": 0.125,
   "gap_before_command_rms_V": 3.0,
   "gap_after_command_rms_V": 0.25,
   "shrink": 0.875,
   "shrink_ci95": [
    0.75,
    1.0
   ],
   "exciting_motion": "slow strokes"
  }
 ],
 "remaining": {
  "share_of_gap_unexplained": 0.125,
  "structure": "nothing"
 },
 "next_experiment": {
  "motion": "Move slowly.",
  "separates": [
   "mass",
   "force_constant"
  ],
  "expected_gain": 1.5,
  "gain_of_log": 0.25,
  "finding": "simulated",
  "axis": "x"
 },
 "not_seen": [],
 "notes": [
  "a note"
 ]
})");
}

TEST_CASE("reference_csv: time and position of the axis that moves, as in a log") {
    CHECK(reference_csv(one_cause().next, axis_kind::linear) ==
          "t_s,x_ref_m\n0,0.100000000000\n0.5,0.125000000000\n");
}

TEST_CASE("to_json: the same diagnosis gives the same bytes") {
    CHECK(to_json(one_cause()).dump() == to_json(one_cause()).dump());
}

TEST_CASE("to_json: without causes the lists are there and empty") {
    const auto json = to_json(diagnosis_result{});
    CHECK(json["verdict"] == "no_gap");
    CHECK(json["axes"].dump() == "{}");
    CHECK(json["causes"].dump() == "[]");
    CHECK(json["next_experiment"]["separates"].dump() == "[]");
    CHECK(json["notes"].dump() == "[]");
    diagnosis_result bare;
    bare.causes = {cause{}};
    CHECK(to_json(bare)["causes"][0]["confusable_with"].dump() == "[]");
    CHECK(to_json(bare)["causes"][0]["parameters"].dump() == "{}");
}

TEST_CASE("to_json: a number that is not finite shows as null") {
    auto d = one_cause();
    d.share_unexplained = std::numeric_limits<double>::quiet_NaN();
    d.causes[0].shrink.high = std::numeric_limits<double>::infinity();
    const auto json = nlohmann::json::parse(to_json(d).dump());
    CHECK(json["remaining"]["share_of_gap_unexplained"].is_null());
    CHECK(json["causes"][0]["shrink_ci95"][1].is_null());
}

TEST_CASE("write_aside: the file is there whole, an older one replaced, and nothing beside it") {
    const auto path = scratch() / "diagnosis.json";
    write_aside(path, "first, and longer");
    write_aside(path, "second");
    CHECK(contents(path) == "second");
    CHECK(std::distance(std::filesystem::directory_iterator(scratch()), {}) == 1);
    std::filesystem::remove_all(scratch());
}

TEST_CASE("write_aside: what cannot be written is refused by its name and leaves nothing behind") {
    CHECK_THROWS_WITH_AS(write_aside("/nowhere/d.json", "x"),
                         "/nowhere/d.json: cannot be written: no such folder", bad_input);
    const auto folder =
        std::filesystem::temp_directory_path() / fmt::format("quadrant_write_aside_folder_{}", getpid());
    std::filesystem::create_directories(folder / "taken" / "inside");
    CHECK_THROWS_WITH_AS(write_aside(folder / "taken", "x"),
                         ((folder / "taken").string() + ": is a directory").c_str(), bad_input);
    CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
    std::filesystem::remove_all(folder);
}

TEST_CASE("write_aside: a full disk is noticed and the old file stays") {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("quadrant_full_{}", getpid());
    std::filesystem::create_directories(folder);
    const auto path = folder / "d.json";
    write_aside(path, "old");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto on_signal = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{2, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    std::string said;
    try {
        write_aside(path, "new");
    } catch (const bad_input& fault) {
        said = fault.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, on_signal);
    CHECK(said.starts_with(path.string() + ": cannot be written: "));
    CHECK(contents(path) == "old");
    CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
    std::filesystem::remove_all(folder);
}

TEST_CASE("write_aside: a device is written to, and says when it is full" *
          doctest::skip(!std::filesystem::exists("/dev/full"))) {
    CHECK_THROWS_AS(write_aside("/dev/full", "x"), bad_input);
    CHECK(std::filesystem::is_character_file("/dev/full"));
}
