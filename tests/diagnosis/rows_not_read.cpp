// SPDX-License-Identifier: BSL-1.0
// Rows that nobody read, or in which the drive was off, and what goes on behind them.
#include "drive_simulator.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/fit/neighbour.hpp>
#include <quadrant/diagnosis/fit/with_drives.hpp>
#include <quadrant/diagnosis/how_far/driven_loop.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

using namespace quadrant::diagnosis;
using drive_simulator::takes;

namespace {

const drive_simulator::machine pi_drive = [] {
    drive_simulator::machine m{.coulomb = 30, .viscous = 60, .gain = 25132.741, .delay = 1e-3};
    m.integral = 1263309.4;
    m.position_gain = 40;
    m.force_of_current = 50;
    return m;
}();
std::string file_of(const std::string& plant, const std::string& drive) {
    return R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"q": {
        "plant": {"mass_kg": 100, "viscous_N_s_per_m": 60, "coulomb_N": 30)" +
           plant + R"(}, "encoder": {"resolution_m": 1e-6}, "drive": {"command_delay_s": 0.001,
        "velocity_gain_N_s_per_m": 25132.741, "velocity_integral_N_per_m": 1263309.4, )" +
           drive + "}}}}";
}
/// Without the rows from 4000 on.
machine_log without(std::string csv, std::size_t rows) {
    std::istringstream in(csv);
    std::ostringstream out;
    std::string line;
    for (std::size_t k = 0; std::getline(in, line); ++k)
        if (k < 4001 || k >= 4001 + rows) out << line << '\n';
    std::istringstream text(out.str());
    return read_log(text, "log.csv");
}

} // namespace

TEST_CASE("rows not read: the replayed integral of a drive is found again behind them") {
    const struct {
        std::string what;
        takes kind;
        std::string file;
    } drives[] = {
        {"velocity", takes::volts, file_of("", R"("kind": "velocity", "velocity_per_V": 0.02)")},
        {"velocity, its current measured", takes::volts,
         file_of(R"(, "force_constant_N_per_A": 50)", R"("kind": "velocity", "velocity_per_V": 0.02)")},
        {"position", takes::set_points,
         file_of("", R"("kind": "position", "position_gain_per_s": 40, "interpolation": "linear")")}};
    for (const auto& d : drives) {
        CAPTURE(d.what);
        const auto machine = read_machine(d.file, "machine.json");
        const std::string csv = drive_simulator::log(d.kind, pi_drive, 0.001, 1, 1, "m");
        const auto whole =
            with_drives(machine, without(csv, 0)).axes[0].drive->given(drive_model(machine.axes[0].drive));
        for (const std::size_t rows : {2U, 5U, 20U, 100U, 300U}) {
            CAPTURE(rows);
            const auto axis = with_drives(machine, without(csv, rows)).axes[0];
            const auto given = axis.drive->given(drive_model(machine.axes[0].drive));
            REQUIRE(given.size() == whole.size());
            double most = 0, size = 0;
            for (std::size_t k = 4000 + rows + 100; k + 10 < whole.size(); ++k) {
                most = std::max(most, std::abs(given[k] - whole[k]));
                size = std::max(size, std::abs(whole[k]));
            }
            CHECK(size > 300);
            CHECK(most < 10);
        }
    }
}
TEST_CASE("rows not read: a recorder that pauses while the drive is off leaves them out") {
    auto m = pi_drive;
    m.enabled_column = true;
    m.off_from = 3.9;
    m.off_until = 4.3;
    const auto machine =
        read_machine(file_of("", R"("kind": "velocity", "velocity_per_V": 0.02)"), "machine.json");
    const auto axis =
        with_drives(machine, without(drive_simulator::log(takes::volts, m, 0.001, 1, 1, "m"), 100)).axes[0];
    REQUIRE(!axis.left_out.empty());
    for (const std::size_t k : {4000U, 4050U, 4099U}) CHECK(axis.left_out[k] == 1);
    for (const std::size_t k : {3850U, 3950U, 4200U, 4400U}) CHECK(axis.left_out[k] == 0);
    CHECK(axis.drive->is_off(3950));
    CHECK(axis.drive->is_off(4050));
}
TEST_CASE("rows not read: no simulation is compared with them, and its loop begins anew behind them") {
    const workshop::machine m;
    auto log = workshop::as_log(workshop::run(m, workshop::strokes));
    const auto machine = workshop::described(m);
    const auto gap_of = [&] { return simulate(machine, log).axes[0].gap; };
    const auto before = gap_of();
    auto& axis = log.axes[0];
    const std::size_t rows = axis.position.size();
    axis.left_out.assign(rows, 0);
    for (std::size_t k = rows / 2; k < rows / 2 + rows / 10; ++k) {
        axis.left_out[k] = 1;
        axis.reference[k] += 1e-3; // as it stood
    }
    const auto after = gap_of();
    CHECK(before.position_rms_m > 0);
    CHECK(after.position_peak_m < 1.5 * before.position_peak_m);
    CHECK(after.position_rms_m < 1.2 * before.position_rms_m);
}
TEST_CASE("a residual force is that of all that moves, a payload that was found with it") {
    plant_description d;
    d.mass_kg = 0.1;
    d.force_constant_N_per_V = 1;
    plant_model p(d, 1e-6);
    const std::vector<double> still(400, 0.0), asked(400, 2.0); // [rad/s^2]
    const double alone = residual_force(p, still, asked, 0.001, 20)[200];
    p.payload.mass = 1;
    p.payload.arm = 0.3;
    CHECK(p.moving_mass() == doctest::Approx(0.1 + 1 * 0.3 * 0.3));
    CHECK(residual_force(p, still, asked, 0.001, 20)[200] == doctest::Approx(1.9 * alone).epsilon(1e-6));
}
TEST_CASE("the acceleration of a neighbour is that between two rows, as a plant takes it") {
    constexpr double period = 0.001, turn = 2 * std::numbers::pi * 25; // 40 rows a cycle
    machine_log log;
    for (const char* name : {"x", "y"}) {
        axis_log axis;
        axis.name = name;
        for (int k = 0; k < 2000; ++k)
            axis.position.push_back(*name == 'x' ? 1e-6 * k : 1e-3 * std::sin(turn * period * k));
        axis.reference = axis.position;
        log.axes.push_back(axis);
    }
    const auto a = detail::with_neighbour(log, log.axes[0], period, 100).other_acceleration;
    for (const std::size_t k : {800U, 807U, 1013U}) {
        const double middle = -1e-3 * turn * turn * std::sin(turn * period * (static_cast<double>(k) + 0.5));
        CHECK(std::abs(a[k] - middle) < 0.02 * 1e-3 * turn * turn);
    }
}
TEST_CASE("a servo that switched off in the first of two logs did not in the second") {
    plant_description d;
    d.mass_kg = 0.02;
    d.force_constant_N_per_V = 0.12;
    plant_model p(d, 1e-6);
    p.friction = {};
    p.friction.viscous_slope = 0.1;
    p.drive.kind = drive_kind::position_servo;
    p.drive.duty_gain = 1.2;
    p.drive.supply = 7.4;
    p.drive.off_from = 0.5;
    p.drive.off_until = 0.8;
    driven_motion m;
    m.period = 0.005;
    for (int k = 0; k < 400; ++k) m.set_point.push_back(k % 200 < 50 ? 0.1 : 0.5);
    m.position.assign(400, 0.1);
    m.velocity.assign(400, 0.0);
    m.begins.push_back({200, 0});
    const auto command = run_closed(p, m, m.period, 0, {}, [](std::size_t, double, const auto&) {});
    CHECK(command[120] == 0);
    CHECK(std::abs(command[70]) > 0.1);
    for (const std::size_t k : {260U, 320U, 345U}) CHECK(std::abs(command[k]) > 1e-3);
}
TEST_CASE(
    "set-points of four rows: a drive takes them where the column changes, whatever row a recorder begins in") {
    drive_model d;
    d.kind = drive_kind::position;
    d.velocity_gain = 1000;
    d.position_gain = 40;
    d.set_point_period = 0.004;
    driven_motion whole;
    whole.period = 0.001;
    for (int k = 0; k < 400; ++k) whole.set_point.push_back(0.01 * std::sin(0.05 * (k - k % 4)));
    whole.position.assign(400, 0.0);
    whole.find_velocity();
    const auto given = whole.given(d);
    for (const std::size_t cut : {1U, 2U, 3U, 4U}) {
        CAPTURE(cut);
        driven_motion late;
        late.period = whole.period;
        late.set_point.assign(whole.set_point.begin() + static_cast<std::ptrdiff_t>(cut),
                              whole.set_point.end());
        late.position.assign(late.set_point.size(), 0.0);
        late.find_velocity();
        const auto there = late.given(d);
        std::size_t wrong = 0;
        for (std::size_t k = 8; k < there.size(); ++k) wrong += std::abs(there[k] - given[k + cut]) > 1e-9;
        CHECK(wrong == 0);
    }
}
