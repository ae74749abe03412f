// SPDX-License-Identifier: BSL-1.0
// Long: one reader: a case for each rule of a log.
#include "quadrant/diagnosis/read_log.hpp"
#include "quadrant/diagnosis/log/wrong_readings.hpp"
#include "refusal.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>

using namespace quadrant::diagnosis;

namespace {

machine_log read(const std::string& text) {
    std::istringstream in(text);
    return read_log(in, "log.csv");
}

std::string refusal(const std::string& text) {
    return refusal_of([&] { read(text); });
}

const std::string header = "t_s,x_ref_m,x_pos_m,x_cmd_V\n";
const std::string good = header + "0.0000,0.000,0.0001,0.5\n"
                                  "0.0005,0.001,0.0002,0.6\n"
                                  "0.0010,0.002,0.0003,0.7\n"
                                  "0.0015,0.003,0.0004,0.8\n";

/// A log of one axis from its stamps.
std::string with_stamps(const std::vector<std::string>& stamps) {
    std::string text = header;
    for (std::size_t k = 0; k < stamps.size(); ++k) text += stamps[k] + ",0," + std::to_string(k) + ",0\n";
    return text;
}

/// The step of a position column, from its cells.
template <class Cell> double position_step(std::size_t rows, Cell cell) {
    std::string text = header;
    for (std::size_t k = 0; k < rows; ++k)
        text += fmt::format("{:.4f},0,{},0\n", 0.0005 * static_cast<double>(k), cell(k));
    return read(text).axes[0].position_step;
}

} // namespace

TEST_CASE("read_log: a plain log comes out as it stands") {
    const auto log = read(good);
    CHECK(log.file == "log.csv");
    CHECK(log.samples == 4);
    CHECK(log.sample_period_s == doctest::Approx(0.0005).epsilon(1e-14));
    CHECK(log.notes.empty());
    REQUIRE(log.axes.size() == 1);
    CHECK(log.axes[0].name == "x");
    CHECK(log.axes[0].command_unit == "V");
    CHECK(log.axes[0].reference == std::vector{0.0, 0.001, 0.002, 0.003});
    CHECK(log.axes[0].position == std::vector{0.0001, 0.0002, 0.0003, 0.0004});
    CHECK(log.axes[0].command == std::vector{0.5, 0.6, 0.7, 0.8});
}

TEST_CASE("read_log: columns come in any order, axes in the order of their names") {
    const auto log = read("y_cmd_A,x_pos_m,t_s,y_pos_m,x_cmd_N,y_ref_m,x_ref_m\n"
                          "1,2,0.0,3,4,5,6\n"
                          "1,2.5,0.1,3.5,4,5,6\n");
    REQUIRE(log.axes.size() == 2);
    CHECK(log.axes[0].name == "x");
    CHECK(log.axes[0].command_unit == "N");
    CHECK(log.axes[0].position == std::vector{2.0, 2.5});
    CHECK(log.axes[1].name == "y");
    CHECK(log.axes[1].command_unit == "A");
    CHECK(log.axes[1].reference == std::vector{5.0, 5.0});
}

TEST_CASE("read_log: unknown columns are ignored with a note, whatever they hold") {
    const auto log = read("t_s,x_ref_m,remark,x_pos_m,x_cmd_V,\n"
                          "0.0,0,\"start, with \"\"care\"\"\",0,0,\n"
                          "0.1,0,nan,1,0,\n");
    CHECK(log.axes[0].position == std::vector{0.0, 1.0});
    REQUIRE(log.notes.size() == 2);
    CHECK(log.notes[0] == "log.csv: column \"remark\" is not part of the format and is ignored.");
    CHECK(log.notes[1] == "log.csv: column \"\" is not part of the format and is ignored.");
}

TEST_CASE("read_log: the velocities of reference and axis are read; other optional columns get a note") {
    const auto log = read("t_s,x_ref_m,x_pos_m,x_cmd_V,x_vel_m_per_s,x_acc_m_per_s2,x_force_N,x_ref_m_per_s,"
                          "x_ref_m_per_s2,y_vel_m_per_s\n"
                          "0.0,0,0,0,1,2,3,4,5,6\n0.1,0,1,0,1.5,2,3,4.5,5.5,6\n");
    CHECK(log.axes.at(0).velocity == std::vector{1, 1.5});
    CHECK(log.axes[0].reference_velocity == std::vector{4, 4.5});
    CHECK(log.axes[0].reference_acceleration == std::vector{5, 5.5});
    REQUIRE(log.notes.size() == 3);
    CHECK(log.notes[0] == "log.csv: column \"x_acc_m_per_s2\" is not used by this version.");
    CHECK(log.notes[1] == "log.csv: column \"x_force_N\" is not used by this version.");
    CHECK(log.notes[2] == "log.csv: column \"y_vel_m_per_s\" belongs to no axis of the log and is ignored.");
    CHECK(refusal("t_s,x_ref_m,x_pos_m,x_cmd_V,x_vel_rad_per_s\n") ==
          "log.csv:1:29: \"x_vel_rad_per_s\": axis x is linear");
    const auto torque = read("t_s,x_ref_m,x_pos_m,x_cmd_m,x_torque_Nm\n0,0,0,0,1\n0.1,0,1,0,2\n");
    CHECK(torque.axes.at(0).effort.empty());
    REQUIRE(torque.notes.size() == 1);
    CHECK(torque.notes[0] ==
          "log.csv: column \"x_torque_Nm\" is not used: axis x is linear; log the motor's current "
          "(x_current_A), which plant.force_constant_N_per_A turns into force.");
}

TEST_CASE(
    "read_log: CRLF, a byte order mark, quoted headers, spaces and blank lines at the end change nothing") {
    const auto plain = read(good);
    const auto dressed = read("\xEF\xBB\xBF \"t_s\" ,\"x_ref_m\", x_pos_m ,\tx_cmd_V\r\n"
                              " 0.0000 ,0.000,0.0001,0.5\r\n"
                              "+0.0005,\"0.001\", 0.0002,0.6  \r\n"
                              "0.0010,0.002,0.0003,\t0.7\r\n"
                              "0.0015,0.003,0.0004,0.8\r\n"
                              "\r\n \t\r\n\n");
    CHECK(dressed.samples == plain.samples);
    CHECK(dressed.sample_period_s == plain.sample_period_s);
    CHECK(dressed.axes[0].reference == plain.axes[0].reference);
    CHECK(dressed.axes[0].position == plain.axes[0].position);
    CHECK(dressed.axes[0].command == plain.axes[0].command);
    CHECK(dressed.axes[0].position_step == plain.axes[0].position_step);
    CHECK(dressed.notes.empty());
}

TEST_CASE("read_log: the last line needs no line break") {
    CHECK(read(good.substr(0, good.size() - 1)).samples == 4);
}

TEST_CASE("read_log: missing rows are filled in and marked; the note counts rows and pieces") {
    const auto log = read(with_stamps({"0", "0.0005", "0.001", "0.0025", "0.003", "0.0035"}));
    CHECK(log.samples == 8);
    CHECK(std::abs(log.sample_period_s - 0.0005) < 1e-12);
    CHECK(log.axes[0].position == std::vector{0.0, 1.0, 2.0, 2.0 + 1.0 / 3, 2.0 + 2.0 / 3, 3.0, 4.0, 5.0});
    CHECK(log.axes[0].left_out == std::vector<unsigned char>{0, 0, 0, 1, 1, 0, 0, 0});
    REQUIRE(log.notes.size() == 1);
    CHECK(log.notes[0] ==
          "log.csv: 2 rows are missing in 1 places, 0.0015 s at most: the record is read as 2 pieces.");
}

TEST_CASE("read_log: a missing row is found among stamps that jitter as much as they may") {
    std::vector<std::string> stamps;
    for (int k = 0; k < 40; ++k)
        if (k != 21) stamps.push_back(fmt::format("{:.5f}", 1e-3 * k + (k % 2 ? 1.9e-4 : -1.9e-4)));
    const auto log = read(with_stamps(stamps));
    CHECK(log.samples == 40);
    CHECK(std::count(log.axes[0].left_out.begin(), log.axes[0].left_out.end(), 1) == 1);
    CHECK(log.axes[0].left_out[21] == 1);
    CHECK(log.axes[0].position[20] == 20);
    CHECK(log.axes[0].position[22] == 21);
}

TEST_CASE("read_log: a missing row is found among stamps whose last digit is the period") {
    std::vector<std::string> stamps, slower;
    for (int k = 0; k < 3000; ++k) {
        if (k != 1700) stamps.push_back(fmt::format("{:.3f}", 1e-3 * k));
        slower.push_back(fmt::format("{:.3f}", std::round(1.02 * k) / 1000)); // a double step every 50 rows
    }
    const auto log = read(with_stamps(stamps));
    CHECK(log.samples == 3000);
    CHECK(std::count(log.axes[0].left_out.begin(), log.axes[0].left_out.end(), 1) == 1);
    CHECK(log.axes[0].left_out[1700] == 1);
    const auto other = read(with_stamps(slower));
    CHECK(other.samples == 3000);
    CHECK(other.sample_period_s == doctest::Approx(1.02e-3).epsilon(1e-4));
    CHECK(other.axes[0].left_out.empty());
}

TEST_CASE("read_log: of an even clock many rows may be missing") {
    std::vector<std::string> stamps;
    for (int k = 0; k < 300; ++k)
        if (k % 10 != 3 && k % 10 != 4 && k % 7 != 2) stamps.push_back(fmt::format("{:.4f}", 1e-3 * k));
    const auto log = read(with_stamps(stamps));
    CHECK(std::abs(log.sample_period_s / 1e-3 - 1) < 1e-6);
    CHECK(log.samples == 300);
    for (std::size_t k = 0; k < 300; ++k)
        CHECK((log.axes[0].left_out[k] != 0) == (k % 10 == 3 || k % 10 == 4 || k % 7 == 2));
}

TEST_CASE("read_log: a pause as long as it may be costs no more samples than the log has rows") {
    std::vector<std::string> stamps;
    for (int k = 0; k < 100; ++k) stamps.push_back(fmt::format("{:.3f}", 1e-3 * k + (k < 50 ? 0 : 3600)));
    const auto log = read(with_stamps(stamps));
    CHECK(log.samples <= 201);
    CHECK(std::abs(log.sample_period_s - 1e-3) < 1e-9);
    CHECK(log.notes[0].find("rows are missing in 1 places, 3.6e+03 s at most") != std::string::npos);
}

TEST_CASE("read_log: a row whose stamp stands still is dropped, time that runs back is refused") {
    const auto log = read(with_stamps({"0", "0.0005", "0.0005", "0.0010"}));
    CHECK(log.samples == 3);
    CHECK(log.axes[0].position == std::vector{0.0, 1.0, 3.0});
    CHECK(log.notes[0] == "log.csv: 1 rows have the stamp of the row before and are dropped.");
    CHECK(refusal(with_stamps({"0", "0.0005", "-0.001"})) ==
          "log.csv:4:1: t_s: -0.001 does not come after 0.0005");
    CHECK(refusal(with_stamps({"0.5", "0.5", "0.5"}))
              .ends_with("all rows have one stamp: its period cannot be known"));
}

TEST_CASE("read_log: of stamps in whole milliseconds at 1 kHz, a row that stands twice is dropped; at 1.25 kHz "
          "equal stamps are rows of their own") {
    std::vector<std::string> twice, faster;
    for (int k = 0; k < 500; ++k) {
        twice.push_back(fmt::format("{:.3f}", 1e-3 * k));
        if (k == 7 || k == 20 || k == 90 || k == 101 || k == 230 || k == 480) twice.push_back(twice.back());
        faster.push_back(fmt::format("{:.3f}", std::floor(0.8 * k + 1e-9) / 1000));
    }
    const auto log = read(with_stamps(twice));
    CHECK(log.samples == 500);
    CHECK(log.sample_period_s == doctest::Approx(1e-3));
    CHECK(log.notes[0] == "log.csv: 6 rows have the stamp of the row before and are dropped.");
    const auto other = read(with_stamps(faster));
    CHECK(other.samples == 500);
    CHECK(other.sample_period_s == doctest::Approx(0.8e-3).epsilon(1e-3));
    std::vector<std::string> lost; // 2 kHz: every other stamp is equal, and rows are missing
    for (int k = 0; k < 400; ++k)
        if (k != 90 && k != 91 && k != 150 && k != 260 && k != 301)
            lost.push_back(fmt::format("{:.3f}", std::floor(0.5 * k + 1e-9) / 1000));
    CHECK(refusal(with_stamps(lost)).find("several rows have each stamp, and rows are missing") !=
          std::string::npos);
}

TEST_CASE("read_log: stamps may jitter by a fifth of the period, and a note tells the size") {
    std::vector<std::string> stamps;
    for (int k = 0; k < 400; ++k) stamps.push_back(fmt::format("{:.6f}", 1e-3 * k + (k % 3 - 1) * 1.5e-4));
    const auto log = read(with_stamps(stamps));
    CHECK(std::abs(log.sample_period_s / 1e-3 - 1) < 1e-5);
    REQUIRE(log.notes.size() == 1);
    CHECK(log.notes[0] == "log.csv: the stamps jitter by up to 15 % of the sample period.");
    CHECK(log.axes[0].position[7] == 7);
}

TEST_CASE("read_log: steps that are up to half a period off are resampled, larger ones are refused") {
    std::vector<std::string> stamps;
    std::vector<double> moved;
    std::string text = header;
    double t = 0;
    for (int k = 0; k < 400; ++k, t += 1e-3 * (1 + 0.4 * std::sin(1.7 * k)))
        text += fmt::format("{:.7f},0,{:.9f},0\n", t, std::sin(20 * t));
    const auto log = read(text);
    CHECK(log.notes[0].find("resampled onto an even clock") != std::string::npos);
    double most = 0;
    for (std::size_t k = 0; k < log.samples; ++k)
        most = std::max(most, std::abs(log.axes[0].position[k] -
                                       std::sin(20 * static_cast<double>(k) * log.sample_period_s)));
    CHECK(most < 3e-6); // a row taken for its sample would be off by up to 0.02
    std::string late = header;
    for (int k = 0; k < 400; ++k)
        late += fmt::format("{:.6f},0,{},0\n", 1e-3 * k - (k % 10 == 9 ? 7e-4 : 0), k);
    CHECK(refusal(late).find("resample the log with quadrant-gap import --resample") != std::string::npos);
}

TEST_CASE("read_log: a wrong reading and a repeated one are left out, an impact and a coarse count are not") {
    const auto logged = [](auto position) {
        std::string text = header;
        for (int k = 0; k < 600; ++k) text += fmt::format("{:.4f},0,{:.7f},0\n", 5e-4 * k, position(k));
        return read(text);
    };
    const auto motion = [](int k) { return 0.05 * std::sin(0.02 * k) + 1e-6 * ((k * 7919) % 13 - 6); };
    const auto count = [](const machine_log& l) {
        return std::count(l.axes[0].left_out.begin(), l.axes[0].left_out.end(), 1);
    };
    CHECK(logged(motion).notes.empty());
    const auto glitch = logged([&](int k) { return k == 300 ? 0.2 : motion(k); });
    CHECK(count(glitch) == 1);
    CHECK(std::abs(glitch.axes[0].position[300] - motion(300)) < 3e-5);
    const auto stale = logged([&](int k) { return motion(k == 10 || k == 331 ? k - 1 : k); });
    CHECK(count(stale) == 2);
    CHECK(stale.axes[0].left_out[331] == 1);
    CHECK(count(logged([&](int k) { return k < 300 ? 1e-4 * k : 0.03 - 8e-5 * (k - 300); })) == 0); // a bounce
    CHECK(count(logged([](int k) { return 1e-4 * std::round(20 * std::sin(0.01 * k)); })) == 0); // coarse count
    CHECK(count(logged([](int k) { return 1e-3 * std::max(0.0, std::sin(0.02 * k)); })) == 0); // sticks at rest
}

TEST_CASE("reading_check: a velocity that jumps, as at the end of a play, is no wrong reading") {
    for (const double jump : {30.0, 40.0, 60.0}) { // counts a sample, at once
        std::vector<double> t, x;
        for (int k = 0; k < 600; ++k) {
            const double run = std::max(0, k - 300);
            t.push_back(5e-4 * k);
            x.push_back(1e-6 * std::round(1.013 * jump * run + 0.713 * run * run));
        }
        CHECK(detail::reading_check(t, x, 1e-6).take().wrong == 0);
        x[450] += 2e-4;
        CHECK(detail::reading_check(t, x, 1e-6).take().wrong == 1);
    }
}

TEST_CASE(
    "read_log: an angle that starts again within one turn goes on, a glitch and a stroke over a turn do not") {
    constexpr double turn = 2 * std::numbers::pi;
    const auto angle = [](int k) { return 7 * std::sin(0.02 * k) + 20; };
    const auto logged = [&](auto position, auto reference) {
        std::string text = "t_s,q_ref_rad,q_pos_rad,q_cmd_Nm\n";
        for (int k = 0; k < 600; ++k)
            text += fmt::format("{:.4f},{:.9f},{:.9f},0\n", 5e-4 * k, reference(k), position(k));
        return read(text);
    };
    for (const double from : {0.0, -turn / 2}) {
        const auto within = [&](int k) { return angle(k) - turn * std::floor((angle(k) - from) / turn); };
        const auto log = logged(within, angle);
        const double whole = log.axes[0].position[0] - angle(0);
        CHECK(std::abs(whole / turn - std::round(whole / turn)) < 1e-8);
        for (int k = 0; k < 600; ++k) {
            CHECK(std::abs(log.axes[0].position[static_cast<std::size_t>(k)] - angle(k) - whole) < 1e-8);
            CHECK(std::abs(log.axes[0].reference[static_cast<std::size_t>(k)] -
                           log.axes[0].position[static_cast<std::size_t>(k)]) < 1e-8);
        }
        REQUIRE(log.notes.size() == 1);
        CHECK(log.notes[0].find("starts again") != std::string::npos);
    }
    // Where rows are missing the angle went on unseen: that step is no reason to leave it as it stands.
    std::string cut = "t_s,q_pos_rad,q_cmd_Nm\n";
    for (int k = 0; k < 600; ++k)
        if (k < 200 || k > 330)
            cut += fmt::format("{:.4f},{:.9f},0\n", 5e-4 * k, angle(k) - turn * std::floor(angle(k) / turn));
    const auto pieces = read(cut);
    CHECK(std::any_of(pieces.notes.begin(), pieces.notes.end(),
                      [](const auto& n) { return n.find("starts again") != n.npos; }));
    const auto& q = pieces.axes[0].position;
    for (std::size_t k = 1; k < q.size(); ++k)
        if (k < 200 || k > 204) CHECK(std::abs(q[k] - q[k - 1]) < 0.2);
    const auto as_it_stands = [&](auto position) {
        const auto log = logged(position, position);
        for (const auto& note : log.notes) CHECK(note.find("starts again") == std::string::npos);
        for (int k = 0; k < 600; k += 7)
            if (k != 301)
                CHECK(std::abs(log.axes[0].position[static_cast<std::size_t>(k)] - position(k)) < 1e-6);
    };
    as_it_stands(angle);
    as_it_stands([](int k) { return std::sin(0.02 * k) + (k == 301 ? 5 : 0); }); // a wrong reading
    as_it_stands([](int k) { return k < 300 ? 0.01 * k : 0.01 * k - 4; });       // a jump inside the turn
    as_it_stands([](int k) { return 3.1 * std::sin(0.9 * k); }); // too fast to distinguish a step from a jump
}

TEST_CASE("read_log: without a position reference the motion is that of its speed, or of the axis") {
    const auto alone = read("t_s,x_pos_m,x_cmd_V\n0,0,0\n0.1,1,0\n0.2,2,0\n");
    CHECK(!alone.axes[0].has_reference);
    CHECK(alone.axes[0].reference == alone.axes[0].position);
    CHECK(alone.notes[0] == "log.csv: axis x has no position reference: nothing is said of the controller.");
    const auto speed = read("t_s,x_pos_m,x_ref_m_per_s,x_cmd_V\n0,5,2,0\n0.5,6,4,0\n1,8,0,0\n");
    CHECK(speed.axes[0].reference == std::vector{5.0, 6.0, 8.0});
    CHECK(read(good).axes[0].has_reference);
}

TEST_CASE("read_log: a measured current or torque is the command where there is no other") {
    const auto torque = read("t_s,q_pos_rad,q_torque_Nm\n0,0,1\n0.1,1,2\n");
    CHECK(torque.axes[0].command_unit == "Nm");
    CHECK(torque.axes[0].command_is == command_origin::measured);
    const auto both = read("t_s,q_pos_rad,q_current_A,q_cmd_A\n0,0,1,3\n0.1,1,2,4\n");
    CHECK(both.axes[0].command == std::vector{3.0, 4.0});
    CHECK(both.axes[0].command_is == command_origin::asked);
}

TEST_CASE("read_log: rows with the drive off are left out") {
    const auto log =
        read("t_s,x_pos_m,x_cmd_V,x_enabled\n0,0,0,1\n0.1,1,0,1\n0.2,2,0,0\n0.3,2,0,0\n0.4,2,0,1\n");
    CHECK(log.axes[0].left_out == std::vector<unsigned char>{0, 0, 1, 1, 0});
    CHECK(log.notes[0] == "log.csv: axis x: the drive is off in 2 samples (1 stretches): left out.");
}

TEST_CASE("read_log: UTF-16 with its byte order mark is read as UTF-8") {
    std::string little = "\xFF\xFE", big = "\xFE\xFF";
    for (const char c : good) {
        little += c;
        little += '\0';
        big += '\0';
        big += c;
    }
    CHECK(read(little).axes[0].position == read(good).axes[0].position);
    CHECK(read(big).axes[0].position == read(good).axes[0].position);
}

TEST_CASE("read_log: a MAT, HDF5 or Parquet file is refused with the command that makes a log of it") {
    for (const std::string start : {"MATLAB 5.0 MAT-file, a text of 116 bytes", "\x89HDF\r\n\x1a\n", "PAR1"})
        CHECK_THROWS_WITH_AS(read(start + std::string(8, '\0') + "\n"),
                             "log.csv:1:1: is a MAT, Parquet or HDF5 file: make a log of it with quadrant-gap "
                             "import FILE log.csv",
                             bad_input);
}

TEST_CASE("read_log: stamps that are written too coarsely still give the period") {
    std::vector<std::string> stamps; // a quarter of a millisecond in four decimals
    for (int k = 0; k < 400; ++k) stamps.push_back(fmt::format("{:.4f}", 2.5e-4 * k));
    const auto log = read(with_stamps(stamps));
    CHECK(std::abs(log.sample_period_s / 2.5e-4 - 1) < 1e-3);
}

TEST_CASE("read_log: a log may begin at any time") {
    const auto log = read(with_stamps({"1754300000.0005", "1754300000.0010", "1754300000.0015"}));
    CHECK(std::abs(log.sample_period_s / 5e-4 - 1) < 1e-3);
}

TEST_CASE("read_log: what is not a number is refused with its place") {
    const auto with_cell = [](const std::string& cell) {
        return refusal(header + "0,0,0,0\n0.1,0,1," + cell + "\n");
    };
    CHECK(with_cell("1.5") == "accepted");
    CHECK(with_cell("-2.5E-3") == "accepted");
    CHECK(with_cell(".5") == "accepted");
    CHECK(with_cell("1.5abc") == "log.csv:3:9: x_cmd_V: \"1.5abc\" is not a number");
    CHECK(with_cell("1.5 2") == "log.csv:3:9: x_cmd_V: \"1.5 2\" is not a number");
    CHECK(with_cell("0x10") == "log.csv:3:9: x_cmd_V: \"0x10\" is not a number");
    CHECK(with_cell("1e") == "log.csv:3:9: x_cmd_V: \"1e\" is not a number");
    CHECK(with_cell("+-1") == "log.csv:3:9: x_cmd_V: \"+-1\" is not a number");
    CHECK(with_cell("--1") == "log.csv:3:9: x_cmd_V: \"--1\" is not a number");
    CHECK(with_cell("") == "log.csv:3:9: x_cmd_V: \"\" is empty: leave the row out, and it will be filled in");
    CHECK(with_cell("nan") ==
          "log.csv:3:9: x_cmd_V: \"nan\" is not finite: leave the row out, and it will be filled in");
    CHECK(with_cell("\"1,5\"") == "log.csv:3:9: x_cmd_V: \"1,5\" is not a number");
    CHECK(with_cell("1\x1b[31m\xff") == "log.csv:3:9: x_cmd_V: \"1?[31m?\" is not a number");
    CHECK(with_cell(std::string("1\0", 2)) == "log.csv:3:9: x_cmd_V: \"1?\" is not a number");
    CHECK(with_cell(std::string(100, 'x')) ==
          "log.csv:3:9: x_cmd_V: \"" + std::string(40, 'x') + "...\" is not a number");
}

TEST_CASE("read_log: a number that is not finite is refused with its place") {
    const auto with_cell = [](const std::string& cell) {
        return refusal(header + "0,0,0,0\n0.1,0, " + cell + ",0\n");
    };
    CHECK(with_cell("nan") ==
          "log.csv:3:8: x_pos_m: \"nan\" is not finite: leave the row out, and it will be filled in");
    CHECK(with_cell("-inf").starts_with("log.csv:3:8: x_pos_m: \"-inf\" is not finite"));
    CHECK(with_cell("1e999") == "log.csv:3:8: x_pos_m: \"1e999\" is out of range");
    CHECK(with_cell("1e13") == "log.csv:3:8: x_pos_m: \"1e13\" is out of range");
}

TEST_CASE("read_log: the column of a message counts characters, not bytes") {
    CHECK(refusal("t_s,x_ref_m,Bemerkung,x_pos_m,x_cmd_V\n0,0,\xC3\xBC\xE2\x82\xAC,?,0\n") ==
          "log.csv:2:8: x_pos_m: \"?\" is not a number");
}

TEST_CASE("read_log: a ragged row is refused with its place") {
    CHECK(refusal(header + "0,0,0,0\n0.1,0,1\n") == "log.csv:3:8: the row has 3 cells, the header 4");
    CHECK(refusal(header + "0,0,0,0\n0.1,0,1,0,7\n") == "log.csv:3:11: more cells than the 4 of the header");
    CHECK(refusal(header + "0,0,0,0\n\n0.1,0,1,0\n") == "log.csv:3:1: a blank line inside the log");
    CHECK(refusal(header + "0,0,0,0\n0.1,0,1,\"0\n") ==
          "log.csv:3:9: a quote is not closed before the comma or the end of the line");
    CHECK(refusal(header + "0,0,0,0\n0.1,0,1,\"0\"0\n") ==
          "log.csv:3:9: a quote is not closed before the comma or the end of the line");
}

TEST_CASE("read_log: a missing column is refused by name") {
    CHECK(refusal("x_ref_m,x_pos_m,x_cmd_V\n0,0,0\n") == "log.csv:1:24: column t_s is missing");
    CHECK(refusal("t_s,x_ref_m,x_cmd_V\n0,0,0\n") == "log.csv:1:20: column x_pos_m is missing");
    // With a reference the command may be missing: a drive that takes positions needs none (match.hpp refuses
    // the others).
    CHECK(refusal("t_s,x_pos_m\n0,0\n") == "log.csv:1:12: column x_cmd_V is missing (or x_cmd_A, x_cmd_N; "
                                           "measured: x_current_A; of a "
                                           "drive that takes positions: x_ref_m)");
    CHECK(refusal("t_s,a\n0,0\n") ==
          "log.csv:1:6: no axis: columns such as x_ref_m, x_pos_m and x_cmd_V are missing");
    CHECK(refusal("t_s;x_ref_m;x_pos_m\n0;0;0\n") == "log.csv:1:4: cells must be separated by commas: bring "
                                                     "the file in with quadrant-gap import (with --map "
                                                     "where its columns have other names)");
    CHECK(refusal("0,0,0,0\n0.1,0,1,0\n") ==
          "log.csv:1:1: the first line must name the columns (t_s, x_ref_m, ...)");
}

TEST_CASE("read_log: a column that is there twice is refused") {
    CHECK(refusal("t_s,x_ref_m,x_pos_m,x_ref_m,x_cmd_V\n") ==
          "log.csv:1:21: column \"x_ref_m\" is there twice");
    CHECK(refusal("t_s,x_ref_m,t_s\n") == "log.csv:1:13: column \"t_s\" is there twice");
    CHECK(refusal("t_s,x_cmd_V,x_cmd_A\n") == "log.csv:1:13: axis x has two commands: x_cmd_V and x_cmd_A");
}

TEST_CASE("read_log: an axis is named so that a message and a key can name it") {
    CHECK(refusal("t_s,my axis_ref_m\n") ==
          "log.csv:1:5: \"my axis_ref_m\": an axis is named by letters, digits, _ and -");
    CHECK(refusal("t_s,_ref_m\n").ends_with("are missing"));
    CHECK(read("t_s,z_2-b_ref_m,z_2-b_pos_m,z_2-b_cmd_N\n0,0,0,0\n1,0,1,0\n").axes[0].name == "z_2-b");
}

TEST_CASE("read_log: a rotary axis is in rad, its command in N m, V or A") {
    const auto log = read("t_s,c_ref_rad,c_pos_rad,c_cmd_Nm,x_ref_m,x_pos_m,x_cmd_A,c_vel_rad_per_s\n"
                          "0,0,0,0.5,0,0,1,0\n1,0,1,0.25,0,1,2,0\n");
    REQUIRE(log.axes.size() == 2);
    CHECK(log.axes[0].kind == axis_kind::rotary);
    CHECK(log.axes[0].command_unit == "Nm");
    CHECK(log.axes[0].command == std::vector{0.5, 0.25});
    CHECK(log.axes[1].kind == axis_kind::linear);
    CHECK(read("t_s,c_ref_rad,c_pos_rad,c_cmd_V\n0,0,0,0\n1,0,1,0\n").axes[0].command_unit == "V");
}

TEST_CASE("read_log: an axis that is half linear and half rotary is refused where it changes") {
    CHECK(refusal("t_s,c_ref_rad,c_pos_m,c_cmd_V\n") ==
          "log.csv:1:15: \"c_pos_m\": axis c is linear (m, N) or rotary (rad, Nm), not both");
    CHECK(refusal("t_s,c_cmd_N,c_ref_rad,c_pos_rad\n") ==
          "log.csv:1:5: axis c is rotary: its command is c_cmd_V, c_cmd_A or c_cmd_Nm");
    CHECK(refusal("t_s,x_ref_m,x_pos_m,x_cmd_Nm\n") ==
          "log.csv:1:21: axis x is linear: its command is x_cmd_V, x_cmd_A or x_cmd_N");
    CHECK(refusal("t_s,c_cmd_Nm\n").ends_with("column c_pos_rad is missing"));
    CHECK(refusal("t_s,c_pos_rad\n")
              .ends_with("(or c_cmd_A, c_cmd_Nm; measured: c_current_A, c_torque_Nm; of a drive that takes "
                         "positions: c_ref_rad)"));
}

TEST_CASE("read_log: a log without motion is refused") {
    CHECK(refusal(header + "0,0.5,0.25,1\n0.1,0.5,0.25,2\n") ==
          "log.csv: axis x does not move: x_pos_m never changes");
    CHECK(refusal(header + "0,0.5,0.25,1\n0.1,0.5,0.26,2\n") == "accepted");
    CHECK(refusal(header + "0,0.5,0.25,1\n0.1,0.6,0.25,2\n") ==
          "log.csv: axis x does not move: x_pos_m never changes although x_ref_m does: is the drive on, the "
          "brake open, the encoder read?");
}

TEST_CASE("read_log: a parked axis beside a moving one is read with a note, two parked ones are refused") {
    const std::string two = "t_s,x_ref_m,x_pos_m,x_cmd_V,y_ref_m,y_pos_m,y_cmd_V\n";
    const auto log = read(two + "0,0,0,0,0.5,0.25,1\n0.1,0.1,0.1,0,0.5,0.25,2\n");
    CHECK(!log.axes.at(0).still);
    CHECK(log.axes.at(1).still);
    CHECK(log.notes.back() == "log.csv: axis y never moves: nothing can be said of it.");
    CHECK(refusal(two + "0,0,0,0,0.5,0.25,1\n0.1,0,0,0,0.5,0.25,2\n") == "log.csv: no axis moves");
}

TEST_CASE("read_log: empty and nearly empty files are refused") {
    CHECK(refusal("") == "log.csv: is empty");
    CHECK(refusal("\xEF\xBB\xBF\r\n\n ") == "log.csv: is empty");
    CHECK(refusal(header) == "log.csv: holds no sample");
    CHECK(refusal(header + "0,0,0,0\n") == "log.csv: holds one sample only: its period cannot be known");
}

TEST_CASE("read_log: a file that cannot be read is refused by its name") {
    const auto said = [](const std::filesystem::path& path) { return refusal_of([&] { read_log(path); }); };
    CHECK(said("/nowhere/log.csv") == "/nowhere/log.csv: no such file");
    CHECK(said("/tmp") == "/tmp: is a directory");
    std::istringstream broken(good);
    broken.setstate(std::ios::badbit);
    CHECK_THROWS_WITH_AS(read_log(broken, "pipe"), "pipe: cannot be read", bad_input);
}

TEST_CASE("read_log: a message stays one line whatever the names hold") {
    std::istringstream in("t_s,x\n");
    CHECK_THROWS_WITH_AS(read_log(in, "a\nb\x1b.csv"),
                         "a?b?.csv:1:6: no axis: columns such as x_ref_m, x_pos_m and x_cmd_V are missing",
                         bad_input);
}

TEST_CASE("read_log: the step of a column is the decimal unit that it is written in") {
    const auto wave = [](std::size_t k) { return 0.03 * std::sin(0.01 * static_cast<double>(k)); };
    CHECK(position_step(1000, [&](auto k) { return fmt::format("{:.9f}", wave(k)); }) == 1e-9);
    CHECK(position_step(1000, [&](auto k) { return fmt::format("{:.3f}", wave(k)); }) == 1e-3);
    CHECK(position_step(2, [](auto k) { return k ? "0.00000745" : "0.00000000"; }) == 1e-8);
    CHECK(position_step(2, [](auto k) { return k ? "7.45e-6" : "0"; }) == 1e-8);
    CHECK(position_step(2, [](auto k) { return k ? "25E+2" : "1E+1"; }) == 10);
}

TEST_CASE("read_log: the step of a column that drops trailing zeros is its finest digit") {
    CHECK(position_step(1000, [](auto k) { return fmt::format("{}", static_cast<double>(k) / 400); }) == 1e-4);
    CHECK(position_step(1000, [](auto k) {
              return k % 7 == 0 ? "10" : fmt::format("{}", static_cast<double>(k) / 1e3);
          }) == 1e-3);
}

TEST_CASE("read_log: the step of a column of so many significant digits is that of its large values") {
    const auto wave = [](std::size_t k) { return 0.03 * std::sin(0.01 * static_cast<double>(k)); };
    CHECK(position_step(1000, [&](auto k) { return fmt::format("{:.6g}", wave(k)); }) == 1e-7);
    CHECK(position_step(1000, [&](auto k) { return fmt::format("{:.8e}", wave(k)); }) == 1e-10);
    CHECK(position_step(1000, [&](auto k) { return fmt::format("{}", wave(k)); }) < 1e-16);
}

TEST_CASE("read_log: a set value that hardly ever changes is not taken for a rounded one") {
    CHECK(position_step(1000, [](auto k) { return k < 500 ? "0" : "0.5"; }) == 0);
    CHECK(position_step(1000, [](auto k) { return std::to_string(k); }) == 0);
}

TEST_CASE("read_log: wide files take time by their size, not by its square") {
    std::string wide = "t_s,x_ref_m,x_pos_m,x_cmd_V", row = ",0,1,0";
    for (int k = 0; k < 100000; ++k) {
        wide += fmt::format(",a{}_force_N", k);
        row += ",1";
    }
    const auto log = read(wide + "\n0.0" + row + "\n0.1,0,2,0" + row.substr(6) + "\n");
    CHECK(log.notes.size() == 100000);
}

TEST_CASE("read_log: a duty in per cent is refused, with the factor") {
    CHECK(
        refusal("t_s,q_ref_rad,q_pos_rad,q_duty\n0,0,0,0.5\n0.1,0,1,1.0\n0.2,0,2,-37\n") ==
        "log.csv: axis q: q_duty reaches -37: a duty is a share of the supply, -1 to 1 (per cent: times 0.01)");
    CHECK(refusal("t_s,q_ref_rad,q_pos_rad,q_duty\n0,0,0,0.5\n0.1,0,1,1.0\n0.2,0,2,-1.0\n") == "accepted");
}
