// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/import/check_physics.hpp"
#include "quadrant/diagnosis/read_log.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

#include <sstream>

using namespace quadrant::diagnosis;
using workshop::near;

namespace {

const std::string examples = QUADRANT_SOURCE_DIR "/examples/import/";

const char* const semicolons =
    R"({"schema": "quadrant.import/1", "separator": ";", "decimal": ",", "header": "Zeit", "end": "EOF",
  "time": {"column": "Zeit", "unit": "ms"},
  "axes": {"x": {"reference": {"column": "Soll", "unit": "mm"}, "position": {"column": "Zaehler", "unit": "m", "scale": 2.5e-7},
                 "command": {"column": "u", "unit": "mV", "scale": -1}}}})";

std::string changed(const char* pointer, const nlohmann::json& to) {
    auto json = nlohmann::json::parse(semicolons);
    json[nlohmann::json::json_pointer(pointer)] = to;
    return json.dump();
}
std::string without(const char* key) {
    auto json = nlohmann::json::parse(semicolons);
    json.erase(key);
    return json.dump();
}

template <class Try> std::string said(Try attempt) {
    try {
        attempt();
    } catch (const bad_input& fault) {
        return fault.what();
    }
    return "accepted";
}
std::string of_map(const std::string& map) {
    return said([&] { read_import_map(map, "map.json"); });
}
std::string of_log(const std::string& log, const std::string& map = semicolons) {
    return said([&] { import_log(read_import_map(map, "map.json"), log, "in.txt"); });
}

const std::string rows =
    "Maschine;17\n\nZeit;Soll;u;Zaehler\nms;mm;mV;-\n10,0;1,25;-500;4\n12,0;1,5;-250;6\n14,0;1,75;100;9\n";

/// A workshop log as an import has it.
imported_log of_workshop(double position_scale = 1, double command_scale = 1) {
    imported_log out;
    out.log = workshop::as_log(workshop::run({}, 6.2));
    for (double& y : out.log.axes[0].position) y *= position_scale;
    for (double& u : out.log.axes[0].command) u *= command_scale;
    return out;
}
} // namespace

TEST_CASE("import: separator, decimal comma, header, scale and unit are the map's; what is between is told") {
    const auto in =
        import_log(read_import_map(std::string_view(semicolons), "map.json"), rows + "EOF\n;\n", "in.txt");
    const auto& x = in.log.axes.at(0);
    CHECK(near(in.log.sample_period_s, 0.002, 1e-5));
    CHECK(x.reference == std::vector<double>{1.25e-3, 1.5e-3, 1.75e-3});
    CHECK(near(x.position[2], 9 * 2.5e-7, 1e-12));
    CHECK(x.command[0] == doctest::Approx(0.5));
    REQUIRE(in.notes.size() == 1);
    CHECK(in.notes[0].find("1 lines") == 0);
    CHECK(in.text == "t_s,x_ref_m,x_pos_m,x_cmd_V\n0.000000000,0.00125,0.0000010000,0.500\n"
                     "0.002000000,0.00150,0.0000015000,0.250\n0.004000000,0.00175,0.0000022500,-0.100\n");
}

TEST_CASE("import: what it writes is what read_log reads, with the rounding that the columns had") {
    std::string text;
    for (int k = 0; k < 400; ++k)
        text += fmt::format("{} {:.4f} {:.3f} {:.2f}\n", k, 10 * std::sin(0.02 * k),
                            10 * std::sin(0.02 * k - 0.01), std::cos(0.02 * k));
    const auto map = read_import_map(
        R"({"schema": "quadrant.import/1", "separator": "blanks", "time": {"column": 1, "unit": "ms"},
            "axes": {"x": {"reference": {"column": 2, "unit": "mm"}, "position": {"column": 3, "unit": "mm"},
                           "command": {"column": 4, "unit": "V"}}}})",
        "map.json");
    const auto in = import_log(map, text, "in.txt");
    std::istringstream written(in.text);
    const auto log = read_log(written, "out.csv");
    CHECK(near(log.axes[0].reference_step, 1e-7, 1e-9));
    CHECK(near(log.axes[0].position_step, 1e-6, 1e-9));
    CHECK(near(log.axes[0].command_step, 1e-2, 1e-9));
    CHECK(near(log.sample_period_s, 1e-3, 1e-5));
    for (std::size_t k = 0; k < log.samples; ++k)
        CHECK(std::abs(log.axes[0].position[k] - in.log.axes[0].position[k]) < 1e-12);
}

TEST_CASE("import: what is wrong in the log is told with file, line and column") {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = rows;
        text.replace(text.find(from), from.size(), to);
        return of_log(text);
    };
    CHECK(with("12,0;1,5", "12,0;1,5x") == "in.txt:6:6: x_ref_m: \"1,5x\" is not a number");
    CHECK(with("12,0;1,5", "12,0;1.5") ==
          "in.txt:6:6: x_ref_m: \"1.5\" has a decimal point where the map has a comma");
    CHECK(with("-250;6", "-250") == "in.txt:6:14: the row has 3 cells; x_pos_m is number 4");
    CHECK(of_log(rows + "16,0;2,0;90;9\n22,0;2,0;90;9\n") == "accepted");
    CHECK(with("14,0", "11,0").find("in.txt:7:1: t_s: ") == 0);
    CHECK(with("\n14,0", "\n\n14,0") == "in.txt:8:1: the line before is blank, inside the log");
    CHECK(with("Soll", "Sol") ==
          "in.txt:3:1: no column \"Soll\"; did you mean Sol? (axes.x.reference of map.json)");
    CHECK(with("u;", "Soll;").find("is there twice") != std::string::npos);
    CHECK(with("Zeit", "Tid") ==
          "in.txt: no line begins with \"Zeit\", as the map says of the names of the columns");
    CHECK(of_log("Zeit;Soll;u;Zaehler\n") == "in.txt: holds no rows of numbers that the map can read");
    CHECK(of_log("") != "accepted");
    const auto overrun =
        of_log("1 1 1 1\noverrun\n3 1 1 1\n", R"({"schema": "quadrant.import/1", "separator": "blanks",
        "time": {"column": 1, "unit": "ms"}, "axes": {"x": {"reference": {"column": 2, "unit": "mm"},
        "position": {"column": 3, "unit": "mm"}, "command": {"column": 4, "unit": "V"}}}})");
    CHECK(overrun == "in.txt:2:1: t_s: \"overrun\" is not a number");
}

TEST_CASE("import: what is wrong in the map is told by its key") {
    CHECK(of_map(semicolons) == "accepted");
    CHECK(of_map(changed("/axes/x/command/unit", "N m"))
              .find("map.json: axes.x.command.unit: \"N m\" is not a unit") == 0);
    CHECK(of_map(changed("/axes/x/command/unit", "Nm")) ==
          "map.json: axes.x.command.unit: must be of V, A or N");
    CHECK(of_map(changed("/axes/x/reference/unit", "deg")) ==
          "map.json: axes.x.reference.unit: must be of the same kind as that of the position");
    CHECK(of_map(changed("/axes/x/position/scale", 0)) ==
          "map.json: axes.x.position.scale: must be a number, not 0");
    CHECK(of_map(changed("/axes/x/colour", 0)).find("axes.x.colour: unknown key") != std::string::npos);
    CHECK(of_map(changed("/separator", ",")) ==
          "map.json: decimal: cannot be the separator of the columns too");
    CHECK(of_map(changed("/separator", "|")).find("map.json: separator: must be") == 0);
    CHECK(of_map(changed("/time/unit", "mm")) == "map.json: time.unit: must be a unit of time");
    CHECK(of_map(changed("/time", {{"period_s", 0}})) == "map.json: time.period_s: must be a number > 0");
    CHECK(of_map(without("header")) ==
          "map.json: time.column: names a column, but the map has no header line: give its number");
    CHECK(of_map(without("axes")) == "map.json: axes: is missing");
    CHECK(of_map("[]") == "map.json: must be an object");
}

TEST_CASE("import: without a time column the rows are taken as they come, and that is said") {
    const auto in =
        import_log(read_import_map(changed("/time", {{"period_s", 0.002}}), "map.json"), rows, "in.txt");
    CHECK(in.log.sample_period_s == 0.002);
    CHECK(std::any_of(in.notes.begin(), in.notes.end(),
                      [](const auto& n) { return n.find("no time column") == 0; }));
}

TEST_CASE("import: a position in another unit than the reference is refused") {
    auto good = of_workshop();
    CHECK_NOTHROW(check_physics(good));
    auto bad = of_workshop(1000);
    CHECK(said([&] { check_physics(bad); }).find("moves 1e+03 times the distance of the reference") !=
          std::string::npos);
}

TEST_CASE("import: a command that drives against the acceleration is refused, one of another size when the "
          "mass is known") {
    auto turned = of_workshop(1, -1);
    CHECK(said([&] { check_physics(turned); }).find("drives against the acceleration") != std::string::npos);
    const workshop::machine m;
    auto right = of_workshop();
    CHECK_NOTHROW(check_physics(right, {m.mass, m.force_constant}));
    auto millivolts = of_workshop(1, 1000);
    CHECK_NOTHROW(check_physics(millivolts));
    CHECK(said([&] {
              check_physics(millivolts, {m.mass, m.force_constant});
          }).find("times the mass of 180") != std::string::npos);
    // The regression itself, against the machine's numbers.
    const auto c = check_units(right.log.axes[0], workshop::period);
    CHECK(near(c.command_per_acceleration, m.mass / m.force_constant, 0.1));
}

TEST_CASE("import: the maps that are shipped read their samples, and the machine behind each is found") {
    const auto taken = [](const std::string& name, const std::string& ending) {
        const auto map = read_import_map(std::filesystem::path(examples + name + ".map.json"));
        auto in = import_log(map, std::filesystem::path(examples + name + ending));
        check_physics(in);
        return in;
    };
    const auto per_acceleration = [](const imported_log& in) {
        return check_units(in.log.axes[0], in.log.sample_period_s).command_per_acceleration;
    };
    const auto hal = taken("halsampler", ".txt"), odrive = taken("odrive", ".csv"),
               scope = taken("twincat_scope", ".csv");
    CHECK(near(hal.log.sample_period_s, 0.001, 1e-5));
    CHECK(near(per_acceleration(hal), 80.0 / 400, 0.05)); // V per m/s^2
    CHECK(odrive.log.axes[0].name == "c");
    CHECK(odrive.text.find("t_s,c_ref_rad,c_pos_rad,c_cmd_Nm\n") == 0);
    CHECK(near(per_acceleration(odrive), 0.002, 0.05)); // kg m^2
    CHECK(near(scope.log.sample_period_s, 0.002, 1e-5));
    CHECK(near(per_acceleration(scope), 120.0 / 350, 0.05)); // A per m/s^2
}
