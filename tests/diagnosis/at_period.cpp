// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/log/at_period.hpp>

#include <cmath>
#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

TEST_CASE(
    "a log on another period: every column goes with it, what was measured behind a drive and its switch too") {
    constexpr std::size_t rows = 1000;
    constexpr double period = 0.005, other = 0.00507;
    const auto wave = [](double t, double phase) { return std::sin(6 * t + phase); };
    axis_log axis;
    axis.name = "q";
    std::vector<std::vector<double>*> columns{
        &axis.reference, &axis.position, &axis.velocity,         &axis.duty,
        &axis.effort,    &axis.motor,    &axis.controller_reads, &axis.command};
    for (std::size_t i = 0; i < columns.size(); ++i)
        for (std::size_t k = 0; k < rows; ++k)
            columns[i]->push_back(wave(static_cast<double>(k) * period, 0.3 * static_cast<double>(i)));
    axis.drive_off.assign(rows, 0);
    for (std::size_t k = 600; k < 800; ++k) axis.drive_off[k] = 1;
    axis.command_is = command_origin::measured;
    machine_log log;
    log.file = "log.csv";
    log.sample_period_s = period;
    log.samples = rows;
    log.axes = {axis};

    const machine_log out = at_period(log, other);
    axis_log b = out.axes.front();
    const std::vector<std::vector<double>*> found{&b.reference, &b.position, &b.velocity,         &b.duty,
                                                  &b.effort,    &b.motor,    &b.controller_reads, &b.command};
    for (std::size_t i = 0; i < found.size(); ++i) {
        REQUIRE(found[i]->size() == out.samples);
        for (std::size_t k = 2; k + 2 < out.samples; ++k)
            REQUIRE(std::abs((*found[i])[k] -
                             wave(static_cast<double>(k) * other, 0.3 * static_cast<double>(i))) < 1e-5);
    }
    REQUIRE(b.drive_off.size() == out.samples);
    for (std::size_t k = 0; k < out.samples; ++k) {
        const double t = static_cast<double>(k) * other;
        if (t > 600 * period && t < 799 * period) CHECK(b.drive_off[k] == 1);
        if (t < 599 * period || t > 800 * period) CHECK(b.drive_off[k] == 0);
    }
}
TEST_CASE("another sample period: rows that nobody read while the drive was off stay so") {
    constexpr double period = 1e-3, other = 4e-4;
    axis_log axis;
    axis.name = "q";
    for (int k = 0; k < 1000; ++k) axis.position.push_back(std::sin(6 * period * k));
    axis.reference = axis.command = axis.position;
    axis.drive_off.assign(1000, 0);
    for (std::size_t k = 600; k < 800; ++k) axis.drive_off[k] = k >= 650 && k < 700 ? 2 : 1;
    axis.left_out.assign(1000, 0);
    for (std::size_t k = 600; k < 800; ++k) axis.left_out[k] = 1;
    machine_log log;
    log.file = "log.csv";
    log.sample_period_s = period;
    log.samples = 1000;
    log.axes = {axis};
    const axis_log b = at_period(log, other).axes.front();
    const auto at = [&](double row) {
        return static_cast<int>(b.drive_off[std::size_t(row * period / other)]);
    };
    CHECK(at(580) == 0);
    CHECK(at(620) == 1);
    CHECK(at(675) == 2);
    CHECK(at(750) == 1);
}
