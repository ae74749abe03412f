// SPDX-License-Identifier: BSL-1.0
// Logs whose columns were not sampled together, by the controller's replay.
#include "claims.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/where/column_shift.hpp>

#include <cmath>
#include <numbers>

using namespace quadrant::diagnosis;
using workshop::says;
using workshop::stand_later;

namespace {

std::optional<column_shift> shift_of(const axis_log& log, const machine_description& file) {
    const auto& axis = file.axes[0];
    return shift_of_columns(*axis.controller, axis.actuator, log, workshop::period, axis.encoder.resolution_m);
}

} // namespace

TEST_CASE("column shift: reference and command that stand up to two rows off the position are found") {
    const workshop::machine real;
    const auto file = workshop::described(real);
    const auto log = workshop::run(real, workshop::strokes);
    CHECK_FALSE(shift_of(log, file));
    for (int reference = -2; reference <= 2; ++reference)
        for (int command = -2; command <= 2; ++command) {
            if (reference == 0 && command == 0) continue;
            auto moved = log;
            stand_later(moved.reference, reference);
            stand_later(moved.command, command);
            const auto found = shift_of(moved, file);
            REQUIRE(found);
            CHECK(found->reference == reference);
            CHECK(found->command == command);
        }
}
TEST_CASE("column shift: another controller is none, on rows that stand right or not") {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.control.position_gain = 88;
    auto log = workshop::run(real, workshop::strokes);
    CHECK_FALSE(shift_of(log, file));
    stand_later(log.command, 1);
    CHECK_FALSE(shift_of(log, file));
}
TEST_CASE("column shift: a log sampled between the parts of its loop has the causes of the machine" *
          doctest::test_suite("all")) {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.coulomb *= 1.3;
    for (const int reference : {-1, 0, 1})
        for (const int command : {-1, 1}) {
            auto log = workshop::as_log(workshop::run(real));
            stand_later(log.axes[0].reference, reference);
            stand_later(log.axes[0].command, command);
            const auto d = diagnose(file, log);
            workshop::named(d, "coulomb_friction", "coulomb_N", real.coulomb, 0.1);
            CHECK(says(d, command > 0 ? "the command stands 1 row later in the log than the position"
                                      : "the command stands 1 row earlier in the log than the position"));
            CHECK(says(d, "the reference stands") == (reference != 0));
        }
}
TEST_CASE("column shift: a controller that answers a period late is no matter of the log") {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.delay +=
        workshop::period; // of the command that the column has one row later: it acts when it is described to
    auto log = workshop::run(real);
    stand_later(log.command, 1);
    const auto d = diagnose(file, workshop::as_log(log));
    CHECK(says(d, "gives the command 1 row later than the one described, and otherwise the same"));
    CHECK_FALSE(says(d, "the command stands"));
    for (const auto& c : d.causes) CHECK(c.effect != "time_delay");
}
TEST_CASE("columns in time: rows before the controller was on are left out where it would have commanded") {
    const workshop::machine real;
    const auto file = workshop::described(real);
    auto axis = workshop::run(real);
    constexpr std::size_t off = 1000;
    std::vector<double> moves(off);
    for (std::size_t k = 0; k < off; ++k)
        moves[k] = axis.reference[0] + 0.001 * std::sin(std::numbers::pi * static_cast<double>(k) / off);
    axis.reference.insert(axis.reference.begin(), moves.begin(), moves.end());
    axis.position.insert(axis.position.begin(), off, axis.position[0]);
    axis.command.insert(axis.command.begin(), off, 0.0);
    const auto d = diagnose(file, workshop::as_log(axis));
    CHECK(d.causes.empty());
    CHECK(says(d, "nothing is commanded up to 0.5"));
    CHECK_FALSE(says(diagnose(file, workshop::as_log(workshop::run(real))), "nothing is commanded"));
}
TEST_CASE("column shift: without a described controller a whole row is a delay, and the report says what looks "
          "the same") {
    const workshop::machine real;
    auto file = workshop::described(real);
    file.axes[0].controller.reset();
    for (const int rows : {-1, 1}) {
        auto log = workshop::as_log(workshop::run(real));
        stand_later(log.axes[0].position, rows);
        const auto d = diagnose(file, log);
        CHECK(workshop::claims(d) == std::vector<std::string>{"time_delay"});
        CHECK(says(d, rows > 0 ? "the delay is longer by one row of the log"
                               : "the delay is shorter by one row of the log"));
    }
}
