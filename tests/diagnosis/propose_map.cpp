// SPDX-License-Identifier: BSL-1.0
// Maps from the headers that other programs write. Sources of the headers: ODrive's GUI (Plot.vue, exportCSV)
// and its firmware's interface file; the manual of TwinCAT Scope (CSV export) and of its NC axis structure;
// LinuxCNC's manual pages of halscope and halsampler.
#include <quadrant/diagnosis/import/propose_map.hpp>
#include <quadrant/diagnosis/import/read_map.hpp>
#include <quadrant/diagnosis/import_log.hpp>

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <numbers>
#include <string>

using namespace quadrant::diagnosis;

namespace {

std::string shipped(const std::string& name) {
    return quadrant::diagnosis::detail::read_whole(
        std::filesystem::path(QUADRANT_SOURCE_DIR "/examples/import/" + name));
}
bool is_open(const proposed_map& p, std::string_view words) {
    return std::any_of(p.open.begin(), p.open.end(),
                       [&](const auto& each) { return each.find(words) != std::string::npos; });
}
const proposed_map::column* of_role(const proposed_map& p, std::string_view axis, std::string_view role) {
    for (const auto& c : p.columns)
        if (c.axis == axis && c.role == role) return &c;
    return nullptr;
}

/// TwinCAT Scope, a time column before each channel, as its manual shows the header.
std::string scope(const std::string& unit, const std::string& periods = "1\tSampleTime[ms]\t1") {
    return "Name\tYT Project\nFile\tC:\\a.svdx\nStarttime of export\t132959733843760000\tMontag, 2. Mai "
           "2022\t15:56:24.376\n"
           "Endtime of export\t132959733853750000\tMontag, 2. Mai 2022\t15:56:25.375\n\n\n"
           "Name\tActPos\tName\tSetPos\nSymbolComment\t\tSymbolComment\t\nData-Type\tREAL64\tData-"
           "Type\tREAL64\n"
           "SampleTime[ms]\t" +
           periods +
           "\nSymbolName\tGVL.axis.NcToPlc.ActPos\tSymbolName\tGVL.axis.NcToPlc.SetPos\n"
           "Unit\t" +
           unit + "\tUnit\t" + unit + "\n\n0\t0,5\t0\t0,25\n1\t0,75\t1\t0,5\n2\t1\t2\t0,75\nEOF\n";
}

} // namespace

TEST_CASE("propose_map: ODrive's property paths are a whole map, in the units of its firmware") {
    const std::string text =
        "time,axis0.encoder.pos_estimate,axis0.controller.pos_setpoint,axis0.controller.torque_"
        "setpoint,axis0.motor.current_control.Iq_measured,vbus_voltage\n0,1,2,3,4,24\n";
    const auto p = propose_map(text, "plot.csv");
    CHECK(p.tool == "ODrive");
    CHECK(p.open.empty());
    const auto map = read_import_map(p.map().dump(), "guess");
    REQUIRE(map.axes.size() == 1);
    const auto& axis = map.axes[0];
    CHECK(axis.name == "axis0");
    CHECK(axis.find(signal_role::position)->column == "axis0.encoder.pos_estimate");
    CHECK(axis.find(signal_role::position)->factor == doctest::Approx(2 * std::numbers::pi));
    CHECK(axis.find(signal_role::reference)->column == "axis0.controller.pos_setpoint");
    CHECK(axis.find(signal_role::command)->column == "axis0.motor.current_control.Iq_measured");
    CHECK(axis.find(signal_role::command)->si == "A");
    CHECK(axis.command_is == command_origin::measured);
    // What the velocity loop adds is not in torque_setpoint: it is no command, and that is said.
    CHECK(p.notes[0].find("torque_setpoint is left out") != std::string::npos);
    CHECK(p.said().find("the position of axis0 in turn") != std::string::npos);
}

TEST_CASE("propose_map: both axes of an ODrive, the best command of each") {
    const auto p = propose_map("time,axis0.pos_estimate,axis1.pos_estimate,axis1.motor.foc.Iq_measured,"
                               "axis1.motor.foc.Iq_setpoint,axis0.controller.effective_torque_setpoint\n",
                               "plot.csv");
    CHECK(p.open.empty());
    CHECK(of_role(p, "axis0", "command")->unit == "Nm");
    CHECK(of_role(p, "axis1", "command")->name == "axis1.motor.foc.Iq_setpoint");
    CHECK_FALSE(of_role(p, "axis1", "command")->is_measured);
}

TEST_CASE("propose_map: two columns that may be the same role are left to a person") {
    const auto p =
        propose_map("time,axis0.encoder.pos_estimate,axis0.mapper.pos_estimate,axis0.Iq_setpoint\n", "p.csv");
    CHECK(is_open(p, "may both be the position of axis0"));
    const auto without =
        propose_map("time,axis0.encoder.pos_estimate,axis0.controller.pos_setpoint\n", "p.csv");
    CHECK(is_open(without, "which column is the command of axis0"));
}

TEST_CASE("propose_map: ODrive's shipped sample is imported as by its own map, but for the axis' name") {
    const std::string text = shipped("odrive.csv");
    const auto guessed = import_log(read_import_map(propose_map(text, "a").map().dump(), "guess"), text, "a");
    const auto mapped = import_log(
        read_import_map(std::filesystem::path(QUADRANT_SOURCE_DIR "/examples/import/odrive.map.json")), text,
        "a");
    CHECK(guessed.log.axes[0].position == mapped.log.axes[0].position);
    CHECK(guessed.log.axes[0].reference == mapped.log.axes[0].reference);
    CHECK(guessed.log.axes[0].command == mapped.log.axes[0].command);
}

TEST_CASE("propose_map: TwinCAT Scope: positions by the NC's names, units where the file has them") {
    const auto p = propose_map(scope("mm (Length)"), "scope.csv");
    CHECK(p.tool == "TwinCAT Scope");
    CHECK(of_role(p, "x", "position")->number == 2);
    CHECK(of_role(p, "x", "position")->unit == "mm");
    CHECK(of_role(p, "x", "reference")->number == 4);
    REQUIRE(p.open.size() == 1);
    CHECK(p.open[0] == "which column is the command of x, in V, A, N or Nm, or a drive's set-points");
    // A map with a reference can do without a command, where the drive takes positions.
    const auto in = import_log(read_import_map(p.map().dump(), "guess"), scope("mm (Length)"), "scope.csv");
    CHECK(in.log.samples == 3);
    CHECK(in.log.axes[0].position[1] == doctest::Approx(0.75e-3));
    CHECK(in.log.axes[0].reference[1] == doctest::Approx(0.5e-3));

    const auto unknown = propose_map(scope("(None)"), "scope.csv");
    CHECK(is_open(unknown, "the unit of GVL.axis.NcToPlc.ActPos"));
    CHECK(unknown.map()["axes"]["x"]["position"]["unit"] == "?");
    CHECK_THROWS_AS(read_import_map(unknown.map().dump(), "guess"), bad_input);
    CHECK(is_open(propose_map(scope("mm (Length)", "1\tSampleTime[ms]\t2"), "scope.csv"),
                  "was sampled every 2 ms"));
    CHECK(is_open(propose_map(shipped("twincat_scope.csv"), "scope.csv"), "(left out: MAIN.nTorqueY)"));
}

TEST_CASE("propose_map: halscope's channels by the names of their pins, in units that nobody says") {
    const std::string head = "Sampling period is 1000000 ns\n";
    const auto p =
        propose_map(head + "joint.0.motor-pos-cmd 0.5 joint.0.motor-pos-fb 0.4 pid.x.output 1\n", "s.log");
    CHECK(p.tool == "halscope");
    CHECK(of_role(p, "x", "reference")->name == "joint.0.motor-pos-cmd");
    CHECK(of_role(p, "x", "position")->name == "joint.0.motor-pos-fb");
    CHECK(of_role(p, "x", "command")->name == "pid.x.output");
    CHECK(p.open.size() == 3);
    CHECK(is_open(p, "the unit of joint.0.motor-pos-fb"));
    const auto columns =
        propose_map("# Sampling period is 1000000 ns\njoint.0.motor-pos-cmd;joint.0.motor-pos-fb\n"
                    "0.5;0.4\n",
                    "s.csv");
    CHECK(columns.tool == "halscope");
    CHECK(of_role(columns, "x", "position")->name == "joint.0.motor-pos-fb");
    CHECK(is_open(propose_map(head + "joint.0.motor-pos-fb 0.5 joint.1.motor-pos-fb 0.4\n", "s.log"),
                  "may both be the position of x"));
}

TEST_CASE("propose_map: halsampler names nothing: no role is guessed") {
    const auto counted = propose_map(shipped("halsampler.txt"), "r.txt");
    CHECK(counted.tool == "halsampler");
    CHECK(counted.columns[0].time);
    CHECK(is_open(counted, "which column is what"));
    const auto bare = propose_map("0.1 0.2 3\n0.1 0.3 4\n", "r.txt");
    CHECK(bare.tool == "halsampler");
    CHECK_FALSE(bare.columns[0].time);
    CHECK_THROWS_AS(read_import_map(bare.map().dump(), "guess"), bad_input);
}

TEST_CASE("propose_map: other files are of no known program, and what is no table has no columns") {
    for (const char* text : {"t_s,x_pos_m,x_cmd_V\n0,0,0\n", "time,position,torque\n0,1,2\n",
                             "Names and numbers\n1 2 3\n", "1 2\n1 2 3\n"}) {
        CHECK_MESSAGE(propose_map(text, "in").tool.empty(), text);
        CHECK_MESSAGE(!propose_map(text, "in").columns.empty(), text);
    }
    for (const char* text : {"", "Name\tValue\na\t1\n", "12\n13\n", "time,\"axis0.pos_estimate\n"})
        CHECK_MESSAGE(propose_map(text, "in").columns.empty(), text);
}

TEST_CASE("propose_map: any other table by the words and units of its columns' names") {
    const std::string text = "recorded by hand\nTime (ms);Soll [mm];Ist [mm];Motor Current (A);temp\n"
                             "0;1,5;1,25;0,5;20\n1;1,75;1,5;0,5;20\n2;2;1,75;0,5;20\n";
    const auto p = propose_map(text, "a.csv");
    CHECK(p.tool.empty());
    CHECK(p.columns[0].time);
    CHECK(of_role(p, "x", "reference")->name == "Soll [mm]");
    CHECK(of_role(p, "x", "position")->name == "Ist [mm]");
    CHECK(of_role(p, "x", "command")->name == "Motor Current (A)");
    CHECK(p.columns[4].role.empty());
    REQUIRE(p.open.size() == 1); // nobody knows where a current was taken
    CHECK(is_open(p, "whether Motor Current (A) is asked by the controller, or was measured"));
    const auto log = import_log(read_import_map(p.map().dump(), "guess"), text, "a.csv").log;
    CHECK(log.sample_period_s == doctest::Approx(1e-3));
    CHECK(log.axes.at(0).reference.at(1) == doctest::Approx(1.75e-3));
    CHECK(log.axes.at(0).position.at(2) == doctest::Approx(1.75e-3));
    CHECK(log.axes.at(0).command.at(0) == doctest::Approx(0.5));
}

TEST_CASE("propose_map: a table of several axes, its units in a line of their own") {
    const auto p = propose_map("t,q1_ref,q1,q2_ref,q2,tau1,tau_act_2,q1Error\n"
                               "[s],[rad],[rad],[rad],[rad],[Nm],[Nm],[rad]\n0,0,0,0,0,0,0,0\n",
                               "arm.csv");
    CHECK(of_role(p, "q1", "reference")->name == "q1_ref");
    CHECK(of_role(p, "q2", "position")->unit == "rad");
    CHECK(of_role(p, "q1", "command") == nullptr); // "1" is no axis that a position has
    CHECK(is_open(p, "which column is the command of q1"));
    CHECK(p.columns[7].role.empty());
}

TEST_CASE("propose_map: empty last cells, as spreadsheets write them, and rows before the first value") {
    const auto sheet = propose_map("time,q3 position [rad],tau,,\n0,0.1,5.6,,\n0.01,0.2,6.0,,\n", "sheet.csv");
    CHECK(sheet.columns.size() == 5);
    CHECK(sheet.columns.at(1).role == "position");
    const auto waiting = propose_map("%remark\n%time,voltage,position,velocity\n%[s],[V],[turns],[turns/s]\n"
                                     "nan,nan,nan,nan;\n0.1,0.0,113.9,0.0;\n0.2,0.5,113.9,0.1;\n",
                                     "chirp.csv");
    CHECK(waiting.layout.at("header") == 2); // not that of the units
    REQUIRE(of_role(waiting, "x", "command"));
    CHECK(of_role(waiting, "x", "command")->name == "voltage");
    REQUIRE(of_role(waiting, "x", "position"));
    CHECK(of_role(waiting, "x", "position")->name == "position");
}

TEST_CASE("propose_map: a table whose columns say too little or too much leaves it to a person") {
    const auto twice = propose_map("time_s,motor position (deg),load position (deg),u\n0,1,2,3\n", "a.csv");
    CHECK(of_role(twice, "motor", "position")->unit == "deg"); // two axes, as far as the names say
    CHECK(of_role(twice, "load", "position") != nullptr);
    CHECK(is_open(twice, "which column is the command of motor"));
    const auto alike = propose_map("time_s,angle (rad),encoder (rad),Voltage (V)\n0,1,2,3\n", "a.csv");
    CHECK(is_open(alike, "angle (rad) and encoder (rad) may both be the position of x"));
    CHECK(of_role(alike, "x", "position") == nullptr);
    const auto counts = propose_map("t [s],Position [counts],PWM,T [degC]\n0,1,2,3\n", "a.csv");
    CHECK(is_open(counts, "the unit of Position [counts]"));
    CHECK(is_open(counts, "the unit of PWM"));
    CHECK(counts.columns[3].role.empty());
    const auto bare = propose_map("0.1,0.2,3\n0.1,0.3,4\n", "a.csv");
    CHECK(is_open(bare, "they go by number"));
    CHECK(is_open(bare, "the column of the time"));
    CHECK(bare.source_of(bare.columns[1]).at("column") == 2);
    CHECK_THROWS_AS(read_import_map(bare.map().dump(), "guess"), bad_input);
    // A bus has a voltage of its own, a column that is there twice goes by its number, a day's time is a stamp.
    const auto drive = propose_map("timestamp,pos [turn],pos [turn],vbus [V],target_speed [rpm]\n"
                                   "12:00:00.001,0,0,24,5\n",
                                   "a.csv");
    CHECK(drive.columns[0].time);
    CHECK(is_open(drive, "may both be the position of x"));
    CHECK(of_role(drive, "x", "supply") != nullptr);
    CHECK(of_role(drive, "x", "reference_velocity")->unit == "rpm");
    CHECK(drive.source_of(drive.columns[2]).at("column") == 3);
}
