// SPDX-License-Identifier: BSL-1.0
// Long: one reader: a case for each key of its map and each thing that a foreign log does.
#include "quadrant/diagnosis/check_physics.hpp"
#include "quadrant/diagnosis/import/own_header.hpp"
#include "quadrant/diagnosis/import/physics.hpp"
#include "quadrant/diagnosis/import/read_map.hpp"
#include "quadrant/diagnosis/read_log.hpp"
#include "refusal.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

#include <array>
#include <nlohmann/json.hpp>
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

std::string of_map(const std::string& map) {
    return refusal_of([&] { read_import_map(map, "map.json"); });
}
std::string of_log(const std::string& log, const std::string& map = semicolons) {
    return refusal_of([&] { import_log(read_import_map(map, "map.json"), log, "in.txt"); });
}

const std::string rows =
    "Maschine;17\n\nZeit;Soll;u;Zaehler\nms;mm;mV;-\n10,0;1,25;-500;4\n12,0;1,5;-250;6\n14,0;1,75;100;9\n";

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

TEST_CASE("import: a command of a few set values keeps their digits") {
    std::string text = "t,q,u\n";
    for (int k = 0; k < 400; ++k)
        text += fmt::format("{:.3f},{:.4f},{}\n", 0.001 * k, 1e-4 * k * k, k < 200 ? "0.05" : "-2.5e-2");
    for (const char* unit : {"Nm", "mNm"}) {
        const auto in = import_log(read_import_map(fmt::format(R"({{"schema": "quadrant.import/1",
            "time": {{"column": "t", "unit": "s"}}, "axes": {{"m": {{"position": {{"column": "q", "unit": "rad"}},
            "command": {{"column": "u", "unit": "{}"}}}}}}}})",
                                                               unit),
                                                   "map.json"),
                                   text, "in.txt");
        std::istringstream written(in.text);
        const auto log = read_log(written, "out.csv");
        CHECK(log.axes[0].command[0] == doctest::Approx(unit[0] == 'm' ? 5e-5 : 0.05));
        CHECK(log.axes[0].command[399] == doctest::Approx(unit[0] == 'm' ? -2.5e-5 : -0.025));
        CHECK(log.axes[0].command_step == 0); // set, not rounded
    }
}

TEST_CASE("import: a command of zeros with an exponent beyond every double is zero") {
    std::string text = "t,q,u\n";
    for (int k = 0; k < 400; ++k) text += fmt::format("{:.3f},{:.4f},0E600\n", 0.001 * k, 1e-4 * k * k);
    const auto in = import_log(read_import_map(R"({"schema": "quadrant.import/1",
        "time": {"column": "t", "unit": "s"}, "axes": {"m": {"position": {"column": "q", "unit": "rad"},
        "command": {"column": "u", "unit": "Nm"}}}})",
                                               "map.json"),
                               text, "in.txt");
    CHECK(in.text.find(",0.000000000000000\n") != in.text.npos); // no digit says where it was rounded
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
    CHECK(of_log("Zeit\tSoll\n1\t2\n2\t3\n",
                 R"({"schema": "quadrant.import/1", "time": {"column": "Zeit", "unit": "ms"},
                     "axes": {"x": {"position": {"column": "Soll", "unit": "mm"},
                                    "command": {"column": "u", "unit": "V"}}}})")
              .find("no column \"Zeit\": the header is one column; is the separator \"tab\"?") !=
          std::string::npos);
    CHECK(with("u;", "current;").find("no column \"u\"; there are Zeit, Soll, current, Zaehler") !=
          std::string::npos);
    CHECK(with("u;", "Soll;").find("is there twice") != std::string::npos);
    CHECK(with("Zeit", "Tid") ==
          "in.txt: no line begins with \"Zeit\", where the map expects the names of the columns");
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
          "map.json: axes.x.command.unit: must be of V, A, N or duty (set-points of a drive: of m/s or m)");
    auto measured = changed("/axes/x/command/unit", "m/s");
    measured.insert(measured.find("\"m/s\"") + 5, ", \"is\": \"measured\"");
    CHECK(of_map(measured) == "map.json: axes.x.command: is a set-point: it is asked for, not measured");
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
    CHECK(of_map(without("header")) == "accepted"); // the first line has the names
    CHECK(of_map(R"({"schema": "quadrant.import/1", "files": [{"time": {"column": "Zeit"}}], "axes": {}})") ==
          "map.json: files[0].time.column: names a column, but the map has no header line: give its number, or "
          "\"header\": 1 where the first line has the names, as of a MAT-file");
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

namespace {

std::string two_files(const char* second) {
    return fmt::format(R"({{"schema": "quadrant.import/1", "header": 1, "time": {{"column": "t", "unit": "s"}},
        "files": [{{}}, {}], "axes": {{"q": {{"position": {{"column": "y", "unit": "rad"}},
        "reference": {{"column": "r", "unit": "mrad", "file": 2}},
        "command": {{"column": "i", "unit": "A", "is": "measured"}}}}}}}})",
                       second);
}

bool told(const imported_log& in, std::string_view words) {
    return std::any_of(in.notes.begin(), in.notes.end(),
                       [&](const auto& note) { return note.find(words) != std::string::npos; });
}

} // namespace

TEST_CASE("import: files with stamps of their own are joined on the clock of the first") {
    foreign_file files[]{{"t,y,i\n", "a.csv"}, {"t;r\n", "b.csv"}};
    for (int k = 0; k < 300; ++k)
        files[0].text += fmt::format("{:.4f},{:.6f},{}\n", 5 + 1e-3 * k, std::sin(0.02 * k), k % 7);
    for (int k = 0; k < 200; ++k) // begins 20 ms later, every 1.7 ms, decimal comma
        files[1].text += fmt::format("{},{:04};{},0\n", 5, 200 + 17 * k, 1000 * (200 + 17 * k));
    const auto map = read_import_map(two_files(R"({"separator": ";", "decimal": ","})"), "map.json");
    const auto in = import_log(map, files);
    const auto& q = in.log.axes.at(0);
    CHECK(in.text.starts_with("t_s,q_pos_rad,q_current_A,q_ref_rad\n"));
    CHECK(q.command_is == command_origin::measured);
    CHECK(near(in.log.sample_period_s, 1e-3, 1e-6));
    CHECK(in.log.samples == 280); // from 20 ms, where the second begins, to the end of the first
    for (std::size_t k = 0; k < in.log.samples; ++k) {
        CHECK(std::abs(q.position[k] - std::sin(0.02 * (static_cast<double>(k) + 20))) < 1e-6);
        CHECK(std::abs(q.reference[k] - (200 + 10 * static_cast<double>(k))) <
              1e-6); // 10 a sample: a straight line
    }
    CHECK(told(in, "the command is a measured one"));
    CHECK(refusal_of([&] { import_log(map, std::span(files).first(1)); }) ==
          "map.json: describes 2 files; 1 are given");
    CHECK(of_map(two_files(R"({"colour": 1})")).find("files[1].colour: unknown key") != std::string::npos);
}

TEST_CASE(
    "import: stamps that jitter are resampled, and the error that is stated bounds the one that is made") {
    std::string text = "t_s,x_pos_m,x_cmd_V\n";
    double t = 0;
    for (int k = 0; k < 2000; ++k, t += 1e-3 * (1 + 0.55 * std::sin(2.3 * k)))
        text += fmt::format("{:.7f},{:.9f},{:.1f}\n", t, 0.1 * std::sin(30 * t), k < 1000 ? 1.0 : -1.0);
    const auto map = map_of_header(text, "in.csv");
    CHECK(refusal_of([&] { import_log(map, text, "in.csv"); }).find("import with --resample") !=
          std::string::npos);
    const auto in = import_log(map, text, "in.csv", {.period_s = 1e-3});
    double sum = 0;
    const auto& x = in.log.axes[0];
    std::size_t judged = 0;
    for (std::size_t k = 0; k < in.log.samples; ++k)
        if (!x.left_out[k]) { // a step of more than one and a half is a missing row
            sum += std::pow(x.position[k] - 0.1 * std::sin(30 * 1e-3 * static_cast<double>(k)), 2);
            ++judged;
        }
    CHECK(judged > in.log.samples / 2);
    CHECK(!told(in, "readings"));
    const double made = std::sqrt(sum / static_cast<double>(judged));
    const auto note = std::find_if(in.notes.begin(), in.notes.end(), [](const auto& n) {
        return n.find("makes an error of at most about") != n.npos;
    });
    REQUIRE(note != in.notes.end());
    const double stated = std::stod(note->substr(note->find("about ") + 6));
    CHECK(made < stated);
    CHECK(stated < 2e-5); // the acceleration is 90 m/s^2: 1/8 of it times (1 ms)^2 at most
    CHECK(x.command[10] == 1);
    CHECK(x.command.back() == -1);
}

TEST_CASE("import: one late stamp is named, and a first row that alone is off may be left out") {
    const auto stamped = [](double at_first, double of_row_900) {
        std::string out = "t_s,x_pos_m,x_cmd_V\n";
        for (int k = 0; k < 1000; ++k)
            out += fmt::format("{:.6f},{:.9f},1\n",
                               k == 0     ? at_first
                               : k == 900 ? of_row_900
                                          : 0.01 + 1e-3 * k,
                               0.1 * std::sin(0.03 * k));
        return out;
    };
    const std::string first = stamped(0.0106, 0.91), late = stamped(0.01, 0.9094);
    const auto map = map_of_header(first, "in.csv");
    CHECK(refusal_of([&] { import_log(map, late, "in.csv"); }) ==
          "in.csv:902:1: the step to this stamp is 0.0004 s, and the period 0.001 s: import with --resample");
    CHECK(refusal_of([&] { import_log(map, first, "in.csv"); }) ==
          "in.csv:3:1: the step to this stamp is 0.0004 s, and the period 0.001 s: import with --resample, or "
          "without the first row (--from 0.0004)");
    CHECK(import_log(map, first, "in.csv", {.from_s = 0.0004}).log.samples == 999);
}

TEST_CASE("import: a part of a record is taken by its time, with and without resampling") {
    std::string text = "t_ms;x_pos_mm;x_cmd_mV\n";
    for (int k = 0; k < 100; ++k) text += fmt::format("{};{},5;{}\n", 1000 + 2 * k, k, k);
    const auto map = map_of_header(text, "in.csv");
    for (const bool resample : {false, true}) {
        const auto in = import_log(map, text, "in.csv", {.resample = resample, .from_s = 0.02, .to_s = 0.1});
        CHECK(in.log.samples == 41);
        CHECK(near(in.log.sample_period_s, 2e-3, 1e-6));
        CHECK(std::abs(in.log.axes[0].position[0] - 10.5e-3) < 1e-9);
    }
    CHECK(refusal_of([&] {
              import_log(map, text, "in.csv", {.resample = true, .from_s = 7});
          }).find("the files have no time in common, or --from and --to leave none") != std::string::npos);
}

TEST_CASE(
    "import: set-points of a velocity drive in our names are taken, and a column without a name of ours is "
    "told") {
    std::string text = "t_ms,q_cmd_rad_per_s,q_pos_rad,wheel,q_cmd_rpm2\n";
    for (int k = 0; k < 200; ++k)
        text += std::to_string(k) + ',' + std::to_string(std::sin(0.05 * k)) + ',' +
                std::to_string(0.02 * (1 - std::cos(0.05 * k))) + ",7,8\n";
    const imported_log in = import_log(map_of_header(text, "in.csv"), text, "in.csv", {});
    REQUIRE(in.log.axes.size() == 1);
    CHECK(in.log.axes[0].command_unit == "rad_per_s");
    CHECK(in.log.axes[0].command[10] == doctest::Approx(std::sin(0.5)).epsilon(1e-5));
    CHECK(std::count(in.notes.begin(), in.notes.end(),
                     "no name of ours: wheel, q_cmd_rpm2 are left out (say with --map which column is what)") ==
          1);
}
TEST_CASE("import: columns with our names need no map, whatever their units") {
    const auto map =
        map_of_header("time [us]\tq_pos_deg\tq_ref_deg_per_s\tq_torque_Nm\tq_enabled\tnote\n0\t0,5\t", "in");
    CHECK(map.files[0].separator == '\t');
    CHECK(map.files[0].decimal == ',');
    CHECK(map.files[0].time->factor == 1e-6);
    const auto& q = map.axes.at(0);
    CHECK(q.find(signal_role::position)->si == "rad");
    CHECK(q.find(signal_role::torque)->si == "Nm");
    CHECK(q.find(signal_role::enabled));
    CHECK(refusal_of([] { map_of_header("a,b\n1,2\n", "in"); }).starts_with("in:1:1: no column t_s"));
    CHECK(refusal_of([] { map_of_header("a,b\n1,2\n", "in"); }).ends_with("; there are a, b"));
    CHECK(refusal_of([] {
              map_of_header("t_s,b\n1,2\n", "in");
          }).starts_with("in:1:1: no column such as x_pos_m"));
    CHECK(refusal_of([] { map_of_header("", "in"); }) == "in: is empty");
}

TEST_CASE("import: a commanded duty is a share in its own unit, beside a duty that was measured") {
    const auto written = [](const std::string& map, const std::string& log) {
        return import_log(read_import_map(map, "map.json"), log, "in.txt").text;
    };
    const auto own = map_of_header("t_s,q_pos_rad,q_cmd_duty,q_duty\n0,0,0,0\n", "in");
    REQUIRE(own.axes.size() == 1);
    CHECK(own.axes[0].find(signal_role::command)->si == "duty");
    CHECK(own.axes[0].find(signal_role::duty)->si == "1");
    const std::string percent = R"({"schema": "quadrant.import/1", "header": "t", "time": {"column": "t", "unit": "s"},
        "axes": {"q": {"position": {"column": "q", "unit": "rad"}, "command": {"column": "u", "unit": "%"},
                       "duty": {"column": "d", "unit": "duty"}}}})";
    CHECK(written(percent, "t,q,u,d\n0,1,50,0.5\n1,2,-100,-1\n2,3,25,0.25\n") ==
          "t_s,q_pos_rad,q_cmd_duty,q_duty\n0.000000000,1,0.50,0.50\n1.000000000,2,-1.00,-1.00\n"
          "2.000000000,3,0.25,0.25\n");
}

TEST_CASE("import: what halscope saves has its period in the first line and one row too many") {
    const auto map = read_import_map(std::filesystem::path(examples + "halscope.map.json"));
    std::string text = "Sampling period is 1000000 ns \n";
    for (int k = 0; k < 50; ++k)
        text +=
            fmt::format("\njoint.0.motor-pos-cmd {:+.14f} joint.0.motor-pos-fb {:+.14f} pid.x.output {:+.14f} ",
                        0.1 * k, k < 49 ? 0.1 * k - 0.02 : 1e6, 0.5);
    const auto in = import_log(map, text + "\n", "scope.log");
    CHECK(in.log.samples == 49);
    CHECK(near(in.log.sample_period_s, 1e-3, 1e-9));
    CHECK(std::abs(in.log.axes[0].position[48] - 4.78e-3) < 1e-12);
    CHECK(told(in, "the last row is dropped"));
    CHECK(refusal_of([&] {
              import_log(map, "t_s,x\n1,2\n", "scope.log");
          }).find("must be \"Sampling period is N ns\"") != std::string::npos);
    CHECK(refusal_of([&] {
              import_log(map, "Sampling period is 1000 ns \n\na +1.0 \na +2.0 \na +2.0 \n", "scope.log");
          }).find("no column \"joint.0.motor-pos-cmd\"") != std::string::npos);
}

TEST_CASE(
    "import: halscope of LinuxCNC 2.8 and before, in a language with a decimal comma; a pin on two channels") {
    const auto map = read_import_map(std::filesystem::path(examples + "halscope.map.json"));
    std::string text = "Sampling period is 1000000 nSec \n";
    for (int k = 0; k < 50; ++k)
        text +=
            fmt::format("\nahc.ok +1,0 joint.0.motor-pos-cmd +{0},25 ahc.ok +1,0 joint.0.motor-pos-fb +{0},125 "
                        "pid.x.output -0,5 ",
                        k);
    const auto in = import_log(map, text + "\n", "scope.log");
    CHECK(in.log.samples == 49);
    CHECK(near(in.log.sample_period_s, 1e-3, 1e-9));
    CHECK(std::abs(in.log.axes[0].position[48] - 48.125e-3) < 1e-12);
    CHECK(in.log.axes[0].command[3] == -0.5);
}

TEST_CASE("import: halscope of LinuxCNC 2.9 names its channels once, and samples every row that it saves") {
    const auto map = read_import_map(std::filesystem::path(examples + "halscope.map.json"));
    std::string text =
        "# Sampling period is 2000000 ns\njoint.0.motor-pos-cmd;joint.0.motor-pos-fb;pid.x.output\n";
    for (int k = 0; k < 50; ++k) text += fmt::format("{:.14f};{:.14f};{:.14f}\n", 0.1 * k, 0.1 * k - 0.02, 0.5);
    const auto in = import_log(map, text, "scope.csv");
    CHECK(in.log.samples == 50);
    CHECK(near(in.log.sample_period_s, 2e-3, 1e-9));
    CHECK(std::abs(in.log.axes[0].position[49] - 4.88e-3) < 1e-12);
    CHECK(!told(in, "the last row is dropped"));
    // Newer ones write how the channels were drawn; a channel that nobody asks for may be the first.
    const auto drawn =
        import_log(map,
                   "# Sampling period is 2000000 ns\nspindle.on;joint.0.motor-pos-cmd;joint.0.motor-pos-fb;"
                   "pid.x.output\n# Position: 0.5;0.5;0.5;0.5\n# Scale: 0;1;2;3\n"
                   "1;0.1;0.2;0.3\n1;0.4;0.5;0.6\n1;0.7;0.8;0.9\n",
                   "scope.csv");
    REQUIRE(drawn.log.samples == 3);
    CHECK(std::abs(drawn.log.axes[0].position[0] - 2e-4) < 1e-12);
    // One channel alone; the map's decimal sign is not asked.
    const auto alone =
        read_import_map(R"({"schema": "quadrant.import/1", "layout": "halscope", "decimal": ",", "files": [{}],
        "axes": {"x": {"position": {"column": "a", "unit": "mm"}, "command": {"column": "a", "unit": "V"}}}})",
                        "map");
    CHECK(import_log(alone, "# Sampling period is 2000000 ns\na\n0.1\n0.2\n0.4\n", "a.csv").log.samples == 3);
}

TEST_CASE("import: an angle of one turn goes on where rows are missing") {
    std::string text = "t,q,u\n";
    for (int k = 0; k < 600; ++k)
        if (k < 200 || k > 330)
            text += fmt::format("{:.4f},{:.6f},0\n", 0.01 * k, std::fmod(0.1 * k, 6.283185));
    const auto map = read_import_map(R"({"schema": "quadrant.import/1", "header": "t",
        "time": {"column": "t", "unit": "s"}, "axes": {"q": {"position": {"column": "q", "unit": "rad"},
        "command": {"column": "u", "unit": "Nm"}}}})",
                                     "map");
    CHECK(told(import_log(map, text, "log.csv"), "within one turn: it goes on here"));
}

TEST_CASE("import: one number of a list that a cell holds") {
    const char* const map =
        R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "stamp", "unit": "us"},
            "files": [{}, {}],
            "axes": {"q": {"position": {"column": "is", "element": 2, "unit": "rad"},
                           "reference": {"column": "want", "element": 1, "unit": "deg", "file": 2}}}})";
    const foreign_file is{"kind,stamp,is\nS,0,\"[0.5, -1.25]\"\nS,1000,\"[0.5, -1.5]\"\nS,2000,\"[0.5, "
                          "-1.75]\"\nS,3000,\"[0.5, -2]\"\n",
                          "is.csv"},
        want{"stamp,want\n0,(90 1)\n1000,(180;2)\n2000,[270]\n3000,360\n", "want.csv"};
    const foreign_file both[]{is, want};
    const auto in = import_log(read_import_map(std::string_view(map), "map.json"), both);
    CHECK(in.log.axes.at(0).position == std::vector<double>{-1.25, -1.5, -1.75, -2});
    CHECK(near(in.log.axes[0].reference[2], 1.5 * std::numbers::pi, 1e-6));
    CHECK(in.log.axes[0].command_unit.empty()); // none is needed where there is a reference
    const foreign_file cut[]{{"kind,stamp,is\nS,0,\"[0.5]\"\nS,1000,\"[0.5]\"\n", "is.csv"}, want};
    CHECK(refusal_of([&] { import_log(read_import_map(std::string_view(map), "map.json"), cut); }) ==
          "is.csv:2:5: \"[0.5]\": the list has 1 entries; q_pos_rad is number 2");
    CHECK(of_map(changed("/axes/x/position/element", 0)) ==
          "map.json: axes.x.position.element: must be the place of a number in the list, from 1");
}

TEST_CASE("import: rows that are missing every other moment are bridged by the period that a note names") {
    std::string text = "t_ms,q_pos_rad,q_cmd_Nm\n";
    for (int k = 0; k < 2000; ++k) // six rows of 2 ms are lost in every ten
        if (k % 10 < 4) text += fmt::format("{},{:.6f},{:.3f}\n", 2 * k, std::sin(0.004 * k), 0.1);
    const auto map = map_of_header(text, "in.csv");
    const auto as_it_is = import_log(map, text, "in.csv", {.resample = true});
    CHECK(
        told(as_it_is, "rows are missing every 4 rows or so: --sample-period 0.0098 bridges most of the gaps"));
    CHECK(told(as_it_is, "the record is read as 200 pieces"));
    const auto bridged = import_log(map, text, "in.csv", {.period_s = 0.0098});
    CHECK(!told(bridged, "pieces"));
    CHECK(!told(bridged, "rows are missing"));
    for (std::size_t k = 0; k < bridged.log.samples; ++k) // a cubic over 14 ms of a slow sine
        CHECK(std::abs(bridged.log.axes.at(0).position[k] -
                       std::sin(0.004 * 0.0098 / 0.002 * static_cast<double>(k))) < 2e-5);
}

TEST_CASE("import: a command is needed where nothing but the position is there; a reference stands in for it") {
    auto json = nlohmann::json::parse(semicolons);
    json["axes"]["x"].erase("command");
    CHECK(of_map(json.dump()) == "accepted");
    json["axes"]["x"].erase("reference");
    CHECK(of_map(json.dump()) == "map.json: axes.x.command: is missing");
}

TEST_CASE("import: where only the speed was recorded its integral is the position, and that is told") {
    std::string text = "t_ms,speed,u\n";
    constexpr double w = 2 * std::numbers::pi;
    for (int k = 0; k < 2000; ++k) text += fmt::format("{},{:.4f},{:.3f}\n", k, std::sin(w * 0.001 * k), 0.1);
    const auto map = read_import_map(
        std::string_view(R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "t_ms"},
            "axes": {"q": {"velocity": {"column": "speed", "unit": "rad/s"},
                           "command": {"column": "u", "unit": "Nm"}}}})"),
        "map.json");
    const auto in = import_log(map, text, "in.csv");
    CHECK(told(in, "axis q: no position: the integral of q_vel_rad_per_s stands for it"));
    CHECK(in.log.axes.at(0).kind == axis_kind::rotary);
    for (int k = 0; k < 2000; k += 100) // the trapezoid, and the digits that are written
        CHECK(std::abs(in.log.axes[0].position[static_cast<std::size_t>(k)] -
                       (1 - std::cos(w * 0.001 * k)) / w) < 2e-6);
    auto json = nlohmann::json::parse(semicolons);
    json["axes"]["x"].erase("position");
    CHECK(of_map(json.dump()) == "map.json: axes.x.position: is missing");
    json["axes"]["x"]["velocity"] = {{"column", "v"}, {"unit", "mm"}};
    CHECK(of_map(json.dump()) == "map.json: axes.x.velocity.unit: must be a speed, of a length or of an angle");
}

TEST_CASE("import: a row without a value that is asked for is missing, whatever stands in the others") {
    const std::string map =
        R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "t", "unit": "s"},
        "axes": {"q": {"reference": {"column": "goal", "unit": "turn"}, "position": {"column": "at", "unit": "turn"},
                       "command": {"column": "torque", "unit": "Nm"}}}})";
    std::string text = "t,goal,at,torque,heat\n0.0,,0.5,0,\n"; // the drive had not answered yet
    for (int k = 1; k < 40; ++k)
        text += fmt::format("{},{},{},{},\n", 0.01 * k, 0.1 * k, 0.1 * k + 0.01, k == 20 ? "nan" : "0.25");
    text += "0.40,,4.01,0.25,\n";
    const auto in = import_log(read_import_map(map, "map.json"), text, "in.csv");
    CHECK(in.log.axes.at(0).position.size() == 39); // the one inside the record is left out of it
    CHECK(in.notes.at(0) == "3 rows lack a value that the map asks for: left out");
    // Without stamps nobody would know that a row is missing.
    const std::string no_time = R"({"schema": "quadrant.import/1", "header": 1, "time": {"period_s": 0.01},
        "axes": {"q": {"position": {"column": "at", "unit": "turn"}, "command": {"column": "torque", "unit": "Nm"}}}})";
    CHECK(of_log("at,torque\n1,2\n1.5,\n2,2\n", no_time).find("is empty") != std::string::npos);
}
TEST_CASE("import: stamps rounded to a digit do not change the period of rows that are even but for a few") {
    const std::string map =
        R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "t", "unit": "s"},
        "axes": {"q": {"position": {"column": "at", "unit": "rad"}, "command": {"column": "torque", "unit": "Nm"}}}})";
    constexpr double tick = 0.015625; // of a clock, written in milliseconds
    std::string text = "t,at,torque\n";
    for (int k = 0; k < 400; ++k)
        if (k % 90 != 45) text += fmt::format("{:.3f},{:.6f},0.25\n", tick * k, std::sin(0.01 * k));
    const auto in = import_log(read_import_map(map, "map.json"), text, "in.csv", {.resample = true});
    CHECK(near(in.log.sample_period_s, tick, 1e-4)); // most steps are 0.016 s
}
TEST_CASE(
    "import: a row that stands twice among stamps in whole milliseconds is dropped, and stamps that have no "
    "clock are refused") {
    const std::string map =
        R"({"schema": "quadrant.import/1", "header": 1, "time": {"column": "t", "unit": "s"},
        "axes": {"q": {"position": {"column": "at", "unit": "rad"}, "command": {"column": "torque", "unit": "Nm"}}}})";
    std::string twice = "t,at,torque\n", lost = twice; // at 1 kHz; at 2 kHz, with rows missing
    const auto row = [](double t, int k) { return fmt::format("{:.3f},{:.6f},0.25\n", t, std::sin(0.01 * k)); };
    for (int k = 0; k < 500; ++k) {
        twice += row(1e-3 * k, k);
        for (const int again : {7, 20, 90, 101, 230, 480})
            if (k == again) twice += row(1e-3 * k, k);
        if (k != 90 && k != 91 && k != 150 && k != 261) lost += row(std::floor(0.5 * k + 1e-9) / 1000, k);
    }
    const auto in = import_log(read_import_map(map, "map.json"), twice, "in.csv");
    CHECK(in.log.samples == 500);
    CHECK(in.notes.at(0) == "6 rows have the stamp of the row before and are dropped");
    CHECK(of_log(lost, map).find("several rows have each stamp, and rows are missing") != std::string::npos);
}

TEST_CASE("import: clock times of ISO 8601 are stamps in seconds, over midnight and in any zone") {
    const auto map = read_import_map(std::string_view(R"({"schema": "quadrant.import/1",
        "time": {"column": "timestamp", "unit": "s"}, "axes": {"x": {"reference": {"column": "asked", "unit": "m"},
        "position": {"column": "read", "unit": "m"}}}})"),
                                     "map.json");
    const auto log_of = [&](const std::string& a, const std::string& b, const std::string& c) {
        return "timestamp,asked,read\n" + a + ",0.1,0.11\n" + b + ",0.2,0.21\n" + c + ",0.3,0.32\n";
    };
    const std::array ways{
        log_of("2025-12-31T23:59:59.850Z", "2025-12-31T23:59:59.950Z", "2026-01-01T00:00:00.050Z"),
        log_of("2025-12-31 23:59:59.850", "2025-12-31 23:59:59.950", "2026-01-01 00:00:00.050"),
        log_of("2026-01-01T00:59:59.850+01:00", "2026-01-01T00:59:59.950+01:00",
               "2025-12-31T19:00:00.050-0500"),
        log_of("09:27:03.748", "09:27:03.848", "09:27:03.948")};
    for (const std::string& log : ways) {
        CAPTURE(log);
        const auto in = import_log(map, log, "in.csv");
        CHECK(in.log.sample_period_s == doctest::Approx(0.1).epsilon(1e-9));
        CHECK(in.text.find("t_s,x_ref_m,x_pos_m\n0.000000000,0.1") == 0);
    }
    // Whole seconds, several rows in each, stand on an even clock; two files count from one day.
    std::string coarse = "timestamp,asked,read\n";
    for (int k = 0; k < 60; ++k) coarse += fmt::format("09:27:{:02d},{},{}\n", k / 5, 0.1 * k, 0.1 * k + 0.01);
    CHECK(import_log(map, coarse, "in.csv", {.resample = true}).log.samples > 50);
    const auto both =
        read_import_map(std::string_view(R"({"schema": "quadrant.import/1", "header": 1, "files": [
        {"time": {"column": "timestamp", "unit": "s"}}, {"time": {"column": "timestamp", "unit": "s"}}],
        "axes": {"x": {"reference": {"column": "asked", "unit": "m"}, "position": {"column": "read", "unit": "m", "file": 2}}}})"),
                        "map.json");
    std::string utc = "timestamp,asked,read\n", east = utc;
    for (int k = 0; k < 40; ++k) { // over midnight, in one of two zones
        const int ms = 100 * k, second = 58 + ms / 1000;
        const auto stamp = [&](int shift) {
            const bool next = second >= 60;
            return fmt::format("{}T{:02d}:{:02d}:{:02d}.{:03d}", next || shift ? "2026-01-01" : "2025-12-31",
                               (next ? 0 : 23) + (shift ? (next ? 1 : -23) : 0), next ? 0 : 59, second % 60,
                               ms % 1000);
        };
        utc += fmt::format("{}Z,{},{}\n", stamp(0), 0.1 * k, 0.1 * k);
        east += fmt::format("{}+01:00,{},{}\n", stamp(1), 0.1 * k, 0.1 * k);
    }
    const std::array<foreign_file, 2> parts{foreign_file{utc, "a.csv"}, foreign_file{east, "b.csv"}};
    CHECK(import_log(both, parts).log.samples > 35);
    // What is no stamp is told by its cell; a unit that a clock does not have, too.
    CHECK(refusal_of([&] {
              import_log(map, log_of("09:27:03.748", "09:61:03.848", "09:27:04"), "in.csv");
          }).find(R"(in.csv:3:1: t_s: "09:61:03.848")") == 0);
    const auto ms = read_import_map(std::string_view(R"({"schema": "quadrant.import/1", "header": 1,
        "time": {"column": "timestamp", "unit": "ms"}, "axes": {"x": {"reference": {"column": "asked", "unit": "m"},
        "position": {"column": "read", "unit": "m"}}}})"),
                                    "map.json");
    CHECK(refusal_of([&] { import_log(ms, ways[0], "in.csv"); }).find("is a clock time: its unit is s") !=
          std::string::npos);
}
