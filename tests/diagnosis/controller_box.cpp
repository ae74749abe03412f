// SPDX-License-Identifier: BSL-1.0
// The controller box: replay of the file's controller and of one of the user's own.
#include "workshop.hpp"

#include <quadrant/diagnosis/controller/cascade_p_pi.hpp>
#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/fit/spatial_spectrum.hpp>
#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/how_far/how_far.hpp>
#include <quadrant/diagnosis/where/controller_floor.hpp>
#include <quadrant/diagnosis/where/places.hpp>
#include <quadrant/diagnosis/which/causes.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

TEST_CASE("replay: where rounding decides the sign of the reference's velocity a Coulomb feedforward is no "
          "mismatch") {
    axis_log log;
    log.reference = {0, 0.001, 0.001, 0.001};
    log.reference_step = 1e-9;
    using quadrant::diagnosis::detail::but_for_the_sign;
    CHECK(but_for_the_sign(0.22, 0.11, 1, log) == 0.22); // in motion it is one
    CHECK(std::abs(but_for_the_sign(0.221, 0.11, 2, log)) < 0.0011);
    CHECK(std::abs(but_for_the_sign(-0.111, 0.11, 3, log)) < 0.0011);
    CHECK(but_for_the_sign(0.03, 0.11, 2, log) == 0.03); // what is no feedforward stays
    CHECK(but_for_the_sign(0.03, 0, 2, log) == 0.03);
}

TEST_CASE(
    "controller box: a log that begins at rest, just after the noise has moved the reading, is replayed") {
    const workshop::machine real;
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto file = workshop::described(real);
    const auto& y = log.position;
    std::size_t begin = 20; // the axis rests for 200 rows
    while (y[begin] != y[begin + 1] || y[begin] == y[begin - 1]) ++begin;
    REQUIRE(begin < 190);
    const auto from = [&](const std::vector<double>& v) { return std::span(v).subspan(begin); };
    const auto replayed = replay_controller(*file.axes[0].controller, file.axes[0].actuator, workshop::period,
                                            from(log.reference), from(y), from(log.command));
    std::vector<double> difference;
    for (std::size_t k = 100; k < replayed.size(); ++k)
        difference.push_back(replayed[k] - log.command[begin + k]);
    CHECK(rms(difference) < workshop::dac);
}

TEST_CASE(
    "controller box: where two rows of a coarse encoder take the first integral beyond the limit, it is found "
    "in rounds") {
    workshop::machine real;
    const auto axis = workshop::described(real).axes[0];
    const auto& c = *axis.controller;
    // A reading of 0.4 mm that dithers: a count a row is 0.8 m/s, 28 V of the velocity gain.
    const std::size_t n = 2000;
    std::vector<double> reference(n, 0.0), reading(n), command(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) reading[k] = k % 97 == 0 ? 4e-4 : 0;
    // What the described controller commands there, from rest; the log begins at a row that dithers.
    const auto all = replay_controller(c, axis.actuator, workshop::period, reference, reading, command);
    const std::size_t begin = 10 * 97;
    const auto from = [&](const std::vector<double>& v) { return std::span(v).subspan(begin); };
    const auto replayed =
        replay_controller(c, axis.actuator, workshop::period, from(reference), from(reading), from(all));
    double worst = 0;
    for (std::size_t k = 100; k < replayed.size(); ++k)
        worst = std::max(worst, std::abs(replayed[k] - all[begin + k]));
    CHECK(worst <= 3 * workshop::dac);
}

TEST_CASE("controller box: replay agrees to one DAC step, from the start and from the middle of a motion") {
    const workshop::machine real;
    const auto log = workshop::run(real);
    const auto file = workshop::described(real);
    const auto& axis = file.axes[0];
    const auto whole = replay_controller(*axis.controller, axis.actuator, workshop::period, log.reference,
                                         log.position, log.command);
    double worst = 0;
    for (std::size_t k = 0; k < whole.size(); ++k) worst = std::max(worst, std::abs(whole[k] - log.command[k]));
    CHECK(worst <= 1.01 * workshop::dac);
    // From 0.5 s on: in the middle of a stroke. Integral and filter are unknown; after 50 ms only rounding is
    // left.
    const auto from = [](const std::vector<double>& v) { return std::span(v).subspan(1000); };
    const auto part = replay_controller(*axis.controller, axis.actuator, workshop::period, from(log.reference),
                                        from(log.position), from(log.command));
    double sum = 0;
    for (std::size_t k = 100; k < part.size(); ++k) sum += std::pow(part[k] - log.command[k + 1000], 2);
    CHECK(std::sqrt(sum / static_cast<double>(part.size() - 100)) < 3 * workshop::dac);
}

namespace {

/// A law of the user's own, no cascade: PID with a lead, the derivative filtered.
struct lead_pid {
    double gain = 3000, lead = 0.02, integral = 20000;
    double last = 0, slope = 0, sum = 0;
    double operator()(double reference, double measured) noexcept {
        const double e = reference - measured;
        slope += 0.5 * ((e - last) / workshop::period - slope);
        last = e;
        sum += integral * workshop::period * e;
        return gain * (e + lead * slope) + sum;
    }
    void settle(const loop_start& row) noexcept {
        last = row.reference - row.measured;
        slope = row.reference_velocity - row.measured_velocity;
        sum = row.command - gain * (last + lead * slope);
    }
};

controller_description keyed(const lead_pid& described) {
    return own_controller({{"gain_V_per_m", described.gain}, {"lead_s", described.lead}, {"offset_V", 0}},
                          [described](std::span<const double> v) {
                              if (!(v[1] > 0.5 * described.lead)) throw std::runtime_error("no such lead");
                              return [law = lead_pid{v[0], v[1], described.integral},
                                      offset = v[2]](double r, double y) mutable { return law(r, y) + offset; };
                          });
}

controller_finding judged(const controller_description& c, const axis_log& log) {
    const auto file = workshop::described({});
    return judge_controller(c, file.axes[0].actuator, log,
                            prepare(log, workshop::period, workshop::count,
                                    scales_of(file.axes[0].plant, log, workshop::period, workshop::count)));
}

} // namespace

TEST_CASE("own controller: the stock cascade behind it is replayed and simulated to the bit as by itself") {
    const workshop::machine real;
    const auto log = workshop::run(real, workshop::three_strokes);
    auto axis = workshop::described(real).axes[0];
    for (const double integral : {300.0, 0.0}) {
        auto& stock = *axis.controller;
        stock.set("velocity_integral_V_per_m", integral);
        const auto own = with_cascade(stock, axis.actuator, workshop::period,
                                      [](const auto& loop) { return own_controller(loop); });
        const auto replay = [&](const controller_description& c) {
            return replay_controller(c, axis.actuator, workshop::period, std::span(log.reference).subspan(1000),
                                     std::span(log.position).subspan(1000),
                                     std::span(log.command).subspan(1000));
        };
        CHECK(replay(own) == replay(stock));
        const plant_model plant(axis, workshop::usual.give());
        const auto a = simulate_closed_loop(own, axis, plant, workshop::period, log),
                   b = simulate_closed_loop(stock, axis, plant, workshop::period, log);
        CHECK(a.position == b.position);
        CHECK(a.command == b.command);
    }
}

TEST_CASE("own controller: another law is replayed; with a gain changed it differs, and the key that is given "
          "is named") {
    workshop::machine real;
    real.law = lead_pid{};
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto right = judged(own_controller(lead_pid{}), log);
    CHECK_FALSE(right.differs);
    CHECK(right.difference_rms < 2 * workshop::dac);

    lead_pid described;
    described.gain = 2400;
    const auto unkeyed = judged(own_controller(described), log);
    CHECK(unkeyed.differs);
    CHECK(unkeyed.key == "");
    CHECK_FALSE(unkeyed.mended);
    const auto named = judged(keyed(described), log);
    CHECK(named.mended);
    CHECK(named.key == "gain_V_per_m");
    CHECK(named.described == 2400);
    CHECK(workshop::near(named.value, 3000, 1e-3));
    CHECK(named.low < named.value);
}

TEST_CASE("own controller: it begins in the middle of a motion, by its own settle") {
    workshop::machine real;
    real.law = lead_pid{};
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto file = workshop::described(real);
    const auto from = [](const std::vector<double>& v) { return std::span(v).subspan(1000); };
    const auto part = replay_controller(own_controller(lead_pid{}), file.axes[0].actuator, workshop::period,
                                        from(log.reference), from(log.position), from(log.command));
    double worst = 0;
    for (std::size_t k = 100; k < part.size(); ++k)
        worst = std::max(worst, std::abs(part[k] - log.command[k + 1000]));
    CHECK(worst < 20 * workshop::dac); // the noise of one reading is in the integral
}

TEST_CASE("own controller: one that runs away is refused with its row") {
    const auto log = workshop::run({}, 1);
    const auto runs_away = [n = 0](double, double) mutable { return ++n < 500 ? 0.0 : std::nan(""); };
    CHECK_THROWS_WITH_AS(judged(own_controller(runs_away), log),
                         "the controller of axis x: its command at row 499 is not finite",
                         std::invalid_argument);
}

TEST_CASE("closed loop: the simulation of the right machine follows its log within a few counts") {
    const workshop::machine real;
    const auto log = workshop::run(real);
    auto file = workshop::described(real);
    auto& plant = file.axes[0].plant;
    plant.mass_kg = real.mass;
    plant.force_constant_N_per_V = real.force_constant;
    plant.viscous_N_s_per_m = real.viscous;
    plant.coulomb_N = real.coulomb;
    const auto out = simulate_closed_loop(*file.axes[0].controller, file.axes[0],
                                          plant_model(plant, workshop::usual.give()), workshop::period, log);
    double sum = 0;
    for (std::size_t k = 0; k < out.position.size(); ++k) sum += std::pow(out.position[k] - log.position[k], 2);
    CHECK(std::sqrt(sum / static_cast<double>(out.position.size())) < 3 * workshop::count);
}
