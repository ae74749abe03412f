// SPDX-License-Identifier: BSL-1.0
// The parts of quadrant-cnc that a run of the program does not show.
#include <doctest/doctest.h>

#include "quadrant_cnc/contour.hpp"
#include "quadrant_cnc/decimated.hpp"
#include "quadrant_cnc/gap_machine.hpp"
#include "quadrant_cnc/read_cnc.hpp"
#include "quadrant_reproduce/virtual_cnc.hpp"

#include <random>

using namespace quadrant_cnc;
using quadrant::path::arc;
using quadrant::path::line;
using quadrant::path::spline;

namespace {

constexpr double pi = std::numbers::pi;

/// The least distance to `n` places of every piece: another way than `nearest`, a little too long by what lies
/// between.
double searched(const std::vector<segment>& path, point at, int n) {
    double least = HUGE_VAL;
    for (const segment& piece : path)
        for (int i = 0; i <= n; ++i)
            least = std::min(least, distance(at, piece.position(piece.length() * i / n)));
    return least;
}

} // namespace

TEST_CASE("contour: the distance to lines, arcs, helices and splines is the least that a search over the path "
          "finds") {
    const std::vector<segment> path{
        line({0, 0, 0}, {0.02, 0, 0}),
        arc({0.02, 0, 0}, {0.02, 0.01, 0}, pi / 2),
        line({0.03, 0.01, 0}, {0.03, 0.03, 0}),
        arc({0.03, 0.03, 0}, {0.02, 0.03, 0}, 1.5 * pi, 0.004),
        spline::quintic({{0.02, 0.02, 0.004}, {1, 0, 0}, {}}, {{0.05, 0.03, 0.004}, {0, 1, 0}, {}}),
        arc({0.05, 0.03, 0.004}, {0.06, 0.03, 0}, -0.75 * pi)};
    const auto line_of = [](std::size_t piece) {
        return (piece + 1) / 2;
    }; // two pieces of a line of the program
    std::mt19937 random(7);
    std::uniform_real_distribution<double> off(-2e-4, 2e-4);
    contour follow;
    for (std::size_t i = 0; i < path.size(); ++i) follow.add(path[i], line_of(i));
    double longest = 0;
    for (const segment& piece : path) longest = std::max(longest, piece.length());
    for (std::size_t i = 0; i < path.size(); ++i)
        for (int k = 0; k < 60; ++k) { // the last twenty near its end
            const double step = path[i].length() / 40;
            const point reference = path[i].position(k < 40 ? step * k : path[i].length() - 5e-5);
            follow.follow(reference, line_of(i), step);
            CHECK(distance(follow.path_place(), reference) < 1e-9);
            const point at = reference + point{off(random), off(random), off(random)};
            const double found = follow(at).distance(), least = searched(path, at, 2000);
            CHECK(found <= least + 1e-12);
            CHECK(least <=
                  std::hypot(found, 0.51 * longest / 2000)); // half the distance between two places searched
        }
}

TEST_CASE("contour: driven there and back, twice around, and far behind on pieces of a micrometre, it stays "
          "with the reference") {
    contour there_and_back;
    there_and_back.add(line({0, 0, 0}, {0.01, 0, 0}), 1);
    there_and_back.add(line({0.01, 0, 0}, {0, 0, 0}), 2);
    there_and_back.add(line({0, 0, 0}, {0, 0.01, 0}), 3);
    for (int k = 0; k <= 300; ++k) {
        const double s = 1e-4 * (k % 100);
        const point at = k < 100   ? point{s, 0, 0}
                         : k < 200 ? point{0.01 - s, 0, 0}
                                   : point{0, std::min(0.01, 1e-4 * (k - 200)), 0};
        there_and_back.follow(at, k < 100 ? 1 : k < 200 ? 2 : 3, 1e-4);
        CHECK(there_and_back(at + point{3e-6, -4e-6, 0}).distance() <= 5.001e-6);
    }
    CHECK(there_and_back({0, 0.0101, 0}).distance() == doctest::Approx(1e-4));

    contour twice;
    const arc round({0.01, 0, 0}, {0, 0, 0}, 4 * pi);
    twice.add(round, 1);
    for (int k = 0; k <= 1000; ++k) {
        const point at = round.position(round.length() * k / 1000);
        twice.follow(at, 1, round.length() / 1000);
        CHECK(twice(0.9999 * at).distance() == doctest::Approx(1e-6).epsilon(1e-4));
    }

    contour fine;
    for (int k = 0; k < 2000; ++k) {
        fine.add(line({1e-6 * k, 0, 0}, {1e-6 * (k + 1), 0, 0}), std::size_t(k));
        fine.follow({1e-6 * (k + 0.5), 0, 0}, std::size_t(k), 1e-6);
        if (k > 300) CHECK(fine({1e-6 * (k - 200), 2e-6, 0}).distance() == doctest::Approx(2e-6));
    }
}

TEST_CASE(
    "decimated: of three million samples no peak is lost, in the right order, and what is kept does not grow") {
    decimated d(2);
    for (int k = 0; k < 3'000'000; ++k) {
        const double both[] = {k == 1'234'567 ? 7.0 : k == 1'234'570 ? -8.0 : 0.001 * std::sin(k), double(k)};
        d.add(both);
    }
    d.finish();
    const auto spiky = d.values(0), rising = d.values(1), t = d.times();
    CHECK(t.size() <= 2 * decimated::most);
    CHECK(t.size() == spiky.size());
    const auto high = std::max_element(spiky.begin(), spiky.end()),
               low = std::min_element(spiky.begin(), spiky.end());
    CHECK(*high == 7);
    CHECK(*low == -8);
    CHECK(high < low);
    CHECK(std::is_sorted(rising.begin(), rising.end()));
    CHECK(rising.back() == 2'999'999);
    const double at = t[std::size_t(high - spiky.begin())];
    CHECK(std::abs(at - 1'234'567) <= double(d.width()));

    heaviest<int> h(100);
    for (int k = 0; k < 100'000; ++k) h.add(k, k == 54'321 ? 9 : k % 7);
    h.finish();
    const auto kept = h.samples();
    CHECK(kept.size() <= 100);
    CHECK(std::count(kept.begin(), kept.end(), 54'321) == 1);
}

TEST_CASE("mill.json: X and Y are the printed ones") {
    const cnc_description mill =
        read_cnc(std::filesystem::path(QUADRANT_SOURCE_DIR "/examples/programs/quadrant_cnc/mill.json"));
    REQUIRE(mill.axes.size() == 3);
    CHECK(mill.servo_period_s == vcnc::period.value());
    for (const auto& [axis, printed] : {std::pair{mill.axes[0], vcnc::x_axis}, {mill.axes[1], vcnc::y_axis}}) {
        const auto& d = std::get<ball_screw_description>(axis.drive);
        CHECK(d.amplifier_A_per_V == printed.amplifier);
        CHECK(d.inertia_kg_m2 == printed.inertia);
        CHECK(d.viscous_Nm_s_per_rad == printed.viscous);
        CHECK(d.torque_constant_Nm_per_A == 0.4769);
        CHECK(d.pitch_m == 0.01);
        for (const auto& [ours, theirs] :
             {std::pair{d.forward, printed.forward}, {d.backward, printed.backward}}) {
            CHECK(ours.static_Nm == theirs.static_level);
            CHECK(ours.coulomb_Nm == theirs.coulomb);
            CHECK(ours.fall_rad_per_s == theirs.fall);
            CHECK(ours.rise_rad_per_s == theirs.rise);
        }
        const auto source = vcnc::drive(printed, vcnc::quantity<vcnc::si::length>::from_value(3e-6));
        CHECK(d.backlash_m == source.backlash.value());
        CHECK(axis.sensor.resolution_m == doctest::Approx(source.encoder_step.value()));
        CHECK(axis.sensor.tachometer_noise_m_per_s ==
              doctest::Approx(source.tachometer_noise.value()).epsilon(1e-6));
        CHECK(axis.dac_step() == vcnc::dac_step.value());
        const auto& law = axis.law;
        CHECK(law.kind == "pid");
        const auto gains = vcnc::pid_of(printed);
        CHECK(law.number("gain_V_per_m") == gains.gain.value());
        CHECK(law.number("integral_gain_V_per_m_s") == gains.integral_gain.value());
        CHECK(law.number("derivative_gain_V_s_per_m") == gains.derivative_gain.value());
    }
}

TEST_CASE("gap machine: mass, force and friction of the x axis along the table") {
    const cnc_description mill =
        read_cnc(std::filesystem::path(QUADRANT_SOURCE_DIR "/examples/programs/quadrant_cnc/mill.json"));
    std::vector<std::string> notes;
    const auto machine = gap_machine(mill, notes);
    const auto& x = machine.axes[0].plant;
    const auto model = vcnc::model(vcnc::x_axis); // from the drive itself
    CHECK(x.force_constant_N_per_V / x.mass_kg == doctest::Approx(model.gain.value()));
    CHECK(x.viscous_N_s_per_m / x.mass_kg == doctest::Approx(model.viscous_rate.value()));
    const double radius = 0.01 / (2 * pi); // a newton on the table is so many newton metres
    CHECK(*x.coulomb_N * (1 + *x.coulomb_asymmetry) * radius == doctest::Approx(2.1529));
    CHECK(*x.coulomb_N * (1 - *x.coulomb_asymmetry) * radius == doctest::Approx(1.4730));
    CHECK(*x.static_N * radius == doctest::Approx(0.5 * (2.6256 + 1.8672)));
    CHECK(*x.stribeck_velocity_m_per_s > 2.0 * radius); // 2 rad/s ...
    CHECK(*x.stribeck_velocity_m_per_s <
          4.0 * radius); // ... to 4: the printed curves dip, so they fall faster than w1
    CHECK(notes.empty());
    CHECK(machine.axes[0].controller->kind == "pid");
}
