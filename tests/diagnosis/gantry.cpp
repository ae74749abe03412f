// SPDX-License-Identifier: BSL-1.0
// Two motors on one beam, from a simulator of their own: the beam's motion is diagnosed as one axis, the
// difference of its ends as two positions.
#include "claims.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace quadrant::diagnosis;
using workshop::said;
using workshop::value_of;

namespace {

/// A beam of 200 kg with a share of it at end 1; each end has a motor, a scale, friction and a loop of its own.
/// It turns against guides of 40 N a micrometre, or of another stiffness.
struct beam_on_two_motors {
    double friction_1 = 20, friction_2 = 20, share = 0.5, scale_2 = 1, fight = 0;
    double stiffness = 4e7; ///< of the guides against the difference of the ends [N/m]
    double gains = 0.5;     ///< of both loops together, at end 1

    std::string log() const {
        constexpr double period = 0.001, mass = 200, turned = 50, count = 1e-6;
        constexpr int fine = 50;
        const double damping = 0.4 * std::sqrt(stiffness * turned), h = period / fine,
                     band = 2 * std::numbers::pi * 15;
        std::string out = "t_s,x1_ref_m,x1_pos_m,x1_cmd_N,x2_ref_m,x2_pos_m,x2_cmd_N\n";
        double x = 0, v = 0, d = 0, rate = 0;
        std::array<double, 2> before{}, given{};
        const auto smooth = [](double speed) { return std::tanh(speed / 2e-4); };
        for (int k = 0; k < 9000; ++k) {
            const double t = k * period, a = 2 * std::numbers::pi * t, grown = std::min(t, 1.0);
            const double asked = grown * (0.06 * std::sin(0.25 * a) + 0.02 * std::sin(0.9 * a));
            const std::array<double, 2> ends{x + (1 - share) * d, scale_2 * (x - share * d)};
            std::array<double, 2> read{};
            for (std::size_t i = 0; i < 2; ++i) {
                read[i] = count * std::round(ends[i] / count);
                const double part = i == 0 ? gains : 1 - gains;
                given[i] =
                    part * mass * band * (band * (asked - read[i]) - 1.8 * (read[i] - before[i]) / period) +
                    (i == 0 ? fight : -fight);
                before[i] = read[i];
            }
            char row[160];
            std::snprintf(row, sizeof row, "%.5f,%.9f,%.9f,%.5f,%.9f,%.9f,%.5f\n", t, asked, read[0], given[0],
                          asked, read[1], given[1]);
            out += row;
            for (int i = 0; i < fine; ++i) {
                const double f1 = given[0] - friction_1 * smooth(v + (1 - share) * rate),
                             f2 = given[1] - friction_2 * smooth(v - share * rate);
                v += h / mass * (f1 + f2 - 60 * v);
                rate += h / turned * ((1 - share) * f1 - share * f2 - stiffness * d - damping * rate);
                x += h * v;
                d += h * rate;
            }
        }
        return out;
    }
};

const std::string described = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {
    "x": {"gantry_pair": {"ends": ["x1", "x2"], "share": 0.5},
          "plant": {"mass_kg": 200, "viscous_N_s_per_m": 60}, "tolerance": {"mass": 0.02, "viscous": 0.3},
          "encoder": {"resolution_m": 1e-6}},
    "x_ends": {"gantry_pair": {"ends": ["x1", "x2"]}, "encoder": {"resolution_m": 1e-6}}}})";

machine_log read(const std::string& csv) {
    std::istringstream text(csv);
    return read_log(text, "gantry.csv");
}
diagnosis_result diagnosed(const beam_on_two_motors& real) {
    const auto machine = read_machine(std::string_view(described), "gantry.json");
    auto log = read(real.log());
    keep_described(machine, log);
    check_match(machine, log);
    return diagnose(machine, log);
}
bool notes(const diagnosis_result& d, const std::string& words) {
    return std::any_of(d.notes.begin(), d.notes.end(),
                       [&](const std::string& n) { return n.find(words) != n.npos; });
}
/// The number that follows these words in a note; nan: there is none.
double number_behind(const diagnosis_result& d, const std::string& words) {
    for (const std::string& n : d.notes)
        if (const auto at = n.find(words); at != n.npos) return std::stod(n.substr(at + words.size()));
    return std::nan("");
}
/// For a message.
std::string told(const diagnosis_result& d) {
    std::string out = said(d);
    for (const auto& n : d.notes) out += "\n" + n;
    return out;
}
std::string refusal(const std::string& machine, const std::string& csv) {
    try {
        const auto m = read_machine(std::string_view(machine), "gantry.json");
        auto log = read(csv);
        keep_described(m, log);
        check_match(m, log);
        diagnose(m, log);
    } catch (const bad_input& e) {
        return e.what();
    }
    return {};
}
std::string exchanged(std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

} // namespace

TEST_CASE("gantry pair: the friction of both ends is the beam's, a scale that counts otherwise shows in their "
          "difference") {
    const auto d = diagnosed({.scale_2 = 1.0002});
    CAPTURE(said(d));
    REQUIRE(workshop::claims(d) == std::vector<std::string>{"coulomb_friction", "scale_error"});
    CHECK(d.causes[0].axis == "x");
    CHECK(value_of(d.causes[0], "coulomb_N").value == doctest::Approx(40).epsilon(0.1));
    CHECK(d.causes[1].axis == "x_ends");
    const double ratio = value_of(d.causes[1], "transmission.travel_per_turn_m").value /
                         value_of(d.causes[1], "transmission.counted_per_turn_m").value;
    CHECK(ratio - 1 == doctest::Approx(2e-4).epsilon(0.1));
    CHECK_FALSE(notes(d, "friction is"));
    CHECK_FALSE(notes(d, "push against each other"));
}

TEST_CASE("gantry pair: the motors' forces tell how they push against each other") {
    const auto d = diagnosed({.friction_1 = 32, .friction_2 = 8, .fight = 25});
    CAPTURE(said(d));
    CHECK(workshop::claims(d).front() == "coulomb_friction");
    CAPTURE(told(d));
    CHECK(notes(d, "push against each other with"));
}

TEST_CASE("gantry pair: on a beam that may turn, the notes have the friction of each end, and which end stays "
          "behind at a reversal" *
          doctest::test_suite("all")) {
    const auto d = diagnosed({.friction_1 = 32, .friction_2 = 8, .stiffness = 0});
    CAPTURE(told(d));
    CHECK(number_behind(d, "friction is ") == doctest::Approx(32).epsilon(0.05));
    CHECK(number_behind(d, "at end x1 and ") == doctest::Approx(8).epsilon(0.05));
    // 12 N turn the beam against two loops of 444 N a millimetre of the difference: 27 um either way.
    CHECK(number_behind(d, "after each reversal end x1 stays ") == doctest::Approx(54).epsilon(0.05));
    CHECK(notes(d, R"(write "ends": ["x2", "x1"])"));
    const auto exchanged = diagnosed({.friction_1 = 8, .friction_2 = 32, .stiffness = 0});
    CAPTURE(told(exchanged));
    CHECK(workshop::claims(exchanged) == std::vector<std::string>{"coulomb_friction", "lost_motion"});
    CHECK(number_behind(exchanged, "after each reversal end x2 stays ") == doctest::Approx(54).epsilon(0.05));
    CHECK_FALSE(notes(exchanged, R"(write "ends")"));
}

TEST_CASE("gantry pair: mass at one end is told, and neither friction nor late readings in its place") {
    const auto d = diagnosed({.share = 0.65, .stiffness = 0});
    CAPTURE(told(d));
    CHECK(notes(d, "65 % of the mass are at end x1"));
    CHECK_FALSE(notes(d, "friction is"));
    CHECK_FALSE(notes(d, "is read"));
}

TEST_CASE("gantry pair: where guides hold the beam, a split of the commands is neither mass nor friction, and "
          "both ends are read at once") {
    for (const auto& beam : {beam_on_two_motors{.gains = 0.65}, {.friction_1 = 32, .friction_2 = 8}}) {
        const auto d = diagnosed(beam);
        CAPTURE(told(d));
        CHECK(notes(d, "end x1 has 65 % of the friction and of the accelerating force") == (beam.gains > 0.5));
        CHECK_FALSE(notes(d, "friction is"));
        CHECK_FALSE(notes(d, "of the mass are"));
        CHECK_FALSE(notes(d, "is read"));
    }
}

TEST_CASE("gantry pair: a file is written as it was read, and the difference of the ends is left out of a "
          "simulation") {
    const auto machine = read_machine(std::string_view(described), "gantry.json");
    CHECK(to_json(read_machine(to_json(machine).dump(), "again.json")) == to_json(machine));
    auto log = read(beam_on_two_motors{}.log());
    join_gantry_pairs(machine, log);
    const auto once = log.axes.front().position;
    join_gantry_pairs(machine, log);
    CHECK(log.axes.front().position == once);
    CHECK(simulate(machine, log).axes.size() == 1);
}

TEST_CASE("gantry pair: what no pair is is refused with what to change") {
    const std::string csv = beam_on_two_motors{}.log();
    CHECK(refusal(exchanged(described, "\"x2\"]", "\"x3\"]"), csv) ==
          "gantry.csv: axis x: column x3_pos_m is missing: x3 is an end of axes.x.gantry_pair in gantry.json");
    CHECK(refusal(exchanged(described, "\"x2\"]", "\"x1\"]"), csv) ==
          "gantry.json: axes.x.gantry_pair.ends: must be two axes");
    CHECK(refusal(exchanged(described, "\"share\": 0.5", "\"share\": 1.5"), csv) ==
          "gantry.json: axes.x.gantry_pair.share: must lie between 0 and 1");
    CHECK(refusal(exchanged(described, "\"share\"", "\"shar\""), csv) ==
          "gantry.json: axes.x.gantry_pair.shar: unknown key; did you mean share?");
    CHECK(refusal(described, exchanged(csv, "x2_cmd_N", "x2_cmd_A")) ==
          "gantry.csv: axis x: its two ends have commands of different units: N of x1, A of x2");
    const auto difference =
        read_machine(std::string_view(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {
            "x_ends": {"gantry_pair": {"ends": ["x1", "x2"]}, "encoder": {"resolution_m": 1e-6}}}})"),
                     "gantry.json");
    auto turned = read(csv);
    for (double& y : turned.axes[1].position) y = -y;
    keep_described(difference, turned);
    try {
        diagnose(difference, turned);
        FAIL("accepted");
    } catch (const bad_input& e) {
        CHECK(std::string(e.what()) ==
              "gantry.csv: axis x_ends: end x2 moves -1 times as far as end x1: turn the sign of one of them");
    }
}
