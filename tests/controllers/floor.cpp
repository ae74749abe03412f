// SPDX-License-Identifier: BSL-1.0
// What rounding makes of a replay: no right controller is blamed for it, and a wrong one a few times above is.
#include "workshop.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/where/controller_floor.hpp>

using namespace controllers_workshop;

namespace {

/// How a log is written: digits of its columns, count of its encoder, bits of its converter.
struct writing {
    const char* name;
    double reference_step, count, position_step, command_step;
    int bits;
};
constexpr writing writings[]{
    {"fine", 1e-12, 2.5e-7, 1e-12, 0, 16},
    {"nanometres", 1e-9, 2.5e-7, 1e-9, 0, 16},
    {"in whole counts", 2.5e-7, 2.5e-7, 5e-8, 0, 16},
    {"coarse count", 1e-9, 5e-6, 1e-7, 0, 16},
    {"no count described, ten nanometres", 1e-9, 0, 1e-8, 0, 16},
    {"coarse converter", 1e-9, 1e-6, 1e-7, 0, 12},
    {"command in four digits", 1e-10, 1e-6, 1e-8, 1e-4, 16},
    {"no converter", 1e-8, 1e-6, 1e-8, 1e-6, 0},
};

double rounded(double x, double step) { return step > 0 ? std::round(x / step) * step : x; }

axis_description under(axis_description axis, const writing& w) {
    axis.encoder.resolution_m = w.count;
    axis.actuator.dac_bits = w.bits ? std::optional<int>(w.bits) : std::nullopt;
    return axis;
}
/// The log of a controller, which had the reference in full and the position in counts.
axis_log written(const axis_description& axis, const controller_description& c, const writing& w) {
    axis_log log = asked(2.2);
    if (w.reference_step == w.count)
        for (double& r : log.reference) r = rounded(r, w.count); // the trajectory itself is in counts
    const auto run = simulate_closed_loop(c, axis, plant_model(axis, 2e-7), machine().sample_period_s, log);
    for (double& r : log.reference) r = rounded(r, w.reference_step);
    log.position = run.position;
    for (double& y : log.position) y = rounded(y, w.position_step);
    log.command = run.command;
    for (double& u : log.command) u = rounded(u, w.command_step);
    log.reference_step = w.reference_step == w.count ? w.position_step : w.reference_step;
    log.position_step = w.position_step;
    log.command_step = w.command_step;
    return log;
}
controller_finding judged_as(const axis_description& axis, const controller_description& c,
                             const axis_log& log) {
    const double T = machine().sample_period_s, count = axis.encoder.resolution_m;
    return judge_controller(c, axis.actuator, log, prepare(log, T, count, scales_of(axis.plant, log, T, count)),
                            count);
}

} // namespace

TEST_CASE("replay floor: no right controller of 13 kinds is blamed, however its log is written" *
          doctest::test_suite("all")) {
    std::size_t cases = 0, blamed = 0;
    for (const writing& w : writings)
        for (const axis_description& described : machine().axes) {
            const auto axis = under(described, w);
            CAPTURE(w.name);
            CAPTURE(axis.name);
            const auto found = judged_as(axis, *axis.controller, written(axis, *axis.controller, w));
            CAPTURE(found.difference_rms);
            CAPTURE(found.floor_rms);
            CAPTURE(found.key);
            CHECK_FALSE(found.differs);
            ++cases;
            blamed += found.differs;
        }
    CHECK(cases >= 100);
    CHECK(blamed == 0);
}

TEST_CASE("replay floor: a position in whole counts is not rounded, one in other digits is") {
    using namespace detail;
    const std::vector<double> counts{0, 2.5e-7, -7.5e-7, 1.25e-6}, between{0, 2.5e-7, 3.1e-7};
    CHECK(in_whole_counts(counts, 5e-8, 2.5e-7));
    CHECK_FALSE(in_whole_counts(between, 1e-8, 2.5e-7));
    CHECK_FALSE(in_whole_counts(counts, 5e-8, 0));
    const double turn = 2 * std::numbers::pi / 8192; // a count that no number of digits writes exactly
    std::vector<double> angles;
    for (int i = 0; i < 3000; ++i) angles.push_back(std::round(turn * i * 1e6) / 1e6);
    axis_log log;
    log.position = log.reference = angles;
    log.position_step = log.reference_step = 1e-6;
    const auto read = as_controlled(log, turn);
    CHECK(read.position_step == 0);
    CHECK(read.position[2999] == doctest::Approx(turn * 2999).epsilon(1e-14));
}

TEST_CASE("replay floor: a gain that shows at a few times the floor is found where the position is in counts") {
    // Carried as a worst case, half a digit of the position would explain all of this difference.
    const auto axis = under(axis_of("cascade_p_pi"), {"", 1e-9, 5e-6, 1e-6, 0, 16});
    auto real = *axis.controller;
    real.set("velocity_gain_V_s_per_m", 36.0);
    const auto log = written(axis, real, {"", 1e-9, 5e-6, 1e-6, 0, 16});
    const auto found = judged_as(axis, *axis.controller, log);
    CHECK(found.differs);
    CHECK(found.difference_rms > 2 * found.floor_rms);
    CHECK(found.mended);
    CHECK(found.key == "velocity_gain_V_s_per_m");
    CHECK(found.value == doctest::Approx(36).epsilon(0.002));
    const double worst = 35 * 0.5e-6 * (110 + 2 / machine().sample_period_s);
    CHECK(found.difference_rms < 2 * worst);
}

TEST_CASE("replay: a Coulomb feedforward that the file lacks is found from a few converter steps up" *
          doctest::test_suite("all")) {
    for (const char* kind : {"cascade_p_pi"})
        for (const double volts : {0.005, 0.05, 0.5}) {
            CAPTURE(volts);
            const auto& axis = axis_of(kind);
            auto real = *axis.controller, described = *axis.controller;
            real.set("coulomb_feedforward_V", volts);
            described.values.erase("coulomb_feedforward_V");
            const auto found = judged(axis, described, logged(axis, real));
            CHECK(found.mended);
            CHECK(found.key == "coulomb_feedforward_V");
            CHECK(found.value == doctest::Approx(volts).epsilon(0.03));
        }
}
