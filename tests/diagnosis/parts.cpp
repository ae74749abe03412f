// SPDX-License-Identifier: BSL-1.0
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

namespace {
constexpr double two_pi = 2 * std::numbers::pi;

std::vector<double> sine(double frequency, double period, std::size_t n) {
    std::vector<double> x(n);
    for (std::size_t k = 0; k < n; ++k) x[k] = std::sin(two_pi * frequency * period * static_cast<double>(k));
    return x;
}
} // namespace

TEST_CASE(
    "carried_peaks: a wave of the force constant is found through the windows in which there is a command") {
    // Strokes of 110 mm: the command is large where they begin and end, and nearly nothing in between.
    constexpr double period = 0.0086, travel = 0.11;
    std::vector<double> z, command, force;
    for (int stroke = 0; stroke < 6; ++stroke)
        for (int k = 0; k < 2000; ++k) {
            const double t = k / 2000.0, way = travel * (t - std::sin(two_pi * t) / two_pi);
            z.push_back(stroke % 2 == 0 ? way : travel - way);
            const double pull = std::pow(std::sin(two_pi * t), 5) * (stroke % 2 == 0 ? 1 : -1);
            command.push_back(pull);
            force.push_back(pull * (0.3 + 0.2 * std::sin(two_pi * z.back() / period + 0.4)));
        }
    std::vector<double> product(z.size());
    for (std::size_t k = 0; k < z.size(); ++k) product[k] = force[k] * command[k];
    const auto is = [&](double found) { return std::abs(1 / found - 1 / period) * travel < 0.5; };
    const auto found = carried_peaks(force, command, z, travel / 2, travel / 400, 2);
    REQUIRE(!found.empty());
    CHECK(is(found.front()));
    CHECK_FALSE(
        is(spatial_peaks(product, z, travel / 2, travel / 400, 2).front())); // a plain transform is misled
    const std::vector<double> none(z.size(), 0.0);
    CHECK(carried_peaks(force, none, z, travel / 2, travel / 400, 2).empty());
}

TEST_CASE("comb_periods_along: a wave is found on an axis that dwells in one place for most of the record") {
    // A fast stroke of 420 mm over seven waves, and back; then slow ones over a quarter of a wave at one end.
    constexpr double period = 0.0603, travel = 0.42;
    std::vector<double> z, force;
    const auto stands_at = [&](double x) {
        z.push_back(x);
        force.push_back(13 * std::sin(two_pi * x / period + 1.9));
    };
    for (int k = 0; k < 1000; ++k) stands_at(travel / 2 * (1 + std::cos(two_pi * k / 1000.0)));
    for (int k = 0; k < 18000; ++k) stands_at(0.008 * (1 - std::cos(two_pi * k / 6000.0)));
    const auto is = [&](double found) { // the wave, or a multiple of which it is a harmonic
        return std::abs(std::round(found / period) / found - 1 / period) * travel < 0.5;
    };
    const double longest = travel / 2, shortest = travel / 400;
    const auto of_transform = detail::comb_periods<8>(force, z, longest, shortest, 0);
    CHECK(std::none_of(of_transform.begin(), of_transform.end(), is)); // misled by the window
    const auto found = detail::comb_periods_along<8>(force, z, longest, shortest, 0);
    CHECK(found.back() == doctest::Approx(period).epsilon(0.01)); // a fourteenth of a wave over the travel
}

TEST_CASE("harmonics: even ones alone are told as the harmonics of half the period") {
    const auto told = [](std::vector<double> sizes) {
        std::vector<parameter_estimate> out{
            {"cogging_period_m", {{0.06, 0.059, 0.061}}}, {"cogging_N", {}}, {"cogging_phase_rad", {}}};
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            out[1].values.push_back({sizes[i], sizes[i] - 1, sizes[i] + 1});
            out[2].values.push_back({0.1 * static_cast<double>(i), 0, 1});
        }
        detail::in_lowest_terms(out);
        return out;
    };
    const auto half = told({1e-4, 9, 0, 2});
    CHECK(half[0].values[0].value == 0.03);
    CHECK(half[0].values[0].low == 0.0295);
    REQUIRE(half[1].values.size() == 2);
    CHECK(half[1].values[0].value == 9);
    CHECK(half[1].values[1].high == 3);
    CHECK(half[2].values[1].value == 0.1 * 3);
    CHECK(told({0, 0, 0, 3})[0].values[0].value == 0.015);
    CHECK(told({2, 9})[0].values[0].value == 0.06); // the first is there
    CHECK(told({9})[1].values.size() == 1);
}

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

TEST_CASE("zero_phase: -3 dB at the corner, no phase, a constant and a slope pass") {
    const double period = 0.0005;
    const auto x = sine(40, period, 20000), y = zero_phase(x, 40, period);
    double in_phase = 0, quadrature = 0;
    for (std::size_t k = 5000; k < 15000; ++k) { // whole periods, far from the ends
        const double angle = two_pi * 40 * period * static_cast<double>(k);
        in_phase += y[k] * std::sin(angle) / 5000;
        quadrature += y[k] * std::cos(angle) / 5000;
    }
    CHECK(in_phase == doctest::Approx(std::sqrt(0.5)).epsilon(0.01));
    CHECK(std::abs(quadrature) < 1e-9);
    std::vector<double> slope(1000);
    for (std::size_t k = 0; k < slope.size(); ++k) slope[k] = 3 + 0.01 * static_cast<double>(k);
    const auto same = zero_phase(slope, 100, period);
    for (std::size_t k = 0; k < slope.size(); k += 37)
        CHECK(same[k] == doctest::Approx(slope[k]).epsilon(1e-6));
}

TEST_CASE("residual force floor: white noise on the position leaves what is forecast") {
    const double period = 0.0005, sigma = 1e-7, mass = 200;
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, sigma);
    std::vector<double> position(60000);
    for (double& x : position) x = noise(random);
    plant_description d;
    d.mass_kg = mass;
    d.force_constant_N_per_V = 1;
    const auto force = residual_force(plant_model(d, workshop::usual.give()), position,
                                      std::vector<double>(position.size(), 0.0), period, 100);
    CHECK(rms(force) == doctest::Approx(residual_force_floor(mass, sigma, period, 100)).epsilon(0.03));
}

TEST_CASE("noise of a measured command: found under what moves the axis, none where a filter took it off") {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 0.02);
    std::vector<double> command(6000), filtered(6000);
    double held = 0;
    for (std::size_t k = 0; k < command.size(); ++k) {
        const double t = 0.001 * static_cast<double>(k),
                     moves = 3 * std::sin(2 * t) + (k / 700 % 2 ? 1.0 : -1.0);
        const double n = noise(random);
        command[k] = moves + n;
        filtered[k] = moves + (held += 0.1 * (n - held));
    }
    CHECK(white_noise_in(command) / 0.02 == doctest::Approx(1).epsilon(0.05));
    CHECK(white_noise_in(filtered) < 0.0015);                      // its density is down to 1/19^2
    CHECK(white_noise_in(std::span(command).first(400)) == 0);     // too short to decide
    CHECK(white_noise_in(std::vector<double>(2000, 1.5)) < 1e-12); // a standing command has none
}

TEST_CASE("noise of a measured command: leaves in the bands and in the residual force what is forecast") {
    const double period = 0.001, force = 2, mass = 5, pole = 0.9;
    std::mt19937 random(12);
    std::normal_distribution<double> noise(0, force);
    std::vector<double> forces(200000);
    for (double& f : forces) f = noise(random);
    const auto innovation = detail::innovation_of(forces, mass, period, pole, 0);
    for (const std::size_t rows : {1u, 20u, 100u}) {
        CAPTURE(rows);
        channel band;
        band.mean = rows;
        band.command_noise = command_noise_in(band, force, mass, period, pole);
        CHECK(rms(detail::running_means(innovation, rows)) ==
              doctest::Approx(band.command_noise).epsilon(0.05).scale(0));
        CHECK(band.of_noise(0) == doctest::Approx(band.command_noise * band.command_noise).scale(0));
    }
    CHECK(rms(zero_phase(forces, 100, period)) ==
          doctest::Approx(force * white_noise_below(100, period)).epsilon(0.03));
}

TEST_CASE("joint starts: an effect begins beside another where it was found by itself") {
    const parameter mass{.key = "mass_kg",
                         .of = [](plant_model&p) -> double& { return p.mass; },
                         .start = 134,
                         .low = 10,
                         .high = 900},
        constant{.key = "constant_force_N",
                 .of = [](plant_model&p) -> double& { return p.constant_force; },
                 .start = 0,
                 .low = -600,
                 .high = 600};
    plant_description d;
    d.mass_kg = 134;
    d.force_constant_N_per_V = 1;
    fit_result found{.plant = plant_model(d, workshop::usual.give()), .parameters = {constant, mass}};
    found.plant.mass = 165;
    const std::vector<std::vector<parameter>> starts{{mass}};
    const auto begun = detail::begun_where(found, starts);
    REQUIRE(begun);
    CHECK(begun->front().start == 165);
    found.plant.mass = 1000; // a start stays inside its bounds
    CHECK(detail::begun_where(found, starts)->front().start == 900);
    found.plant.mass = 135; // the start that there is
    CHECK_FALSE(detail::begun_where(found, starts));
    found.plant.mass = 165;
    found.parameters = {constant}; // the fit did not move it
    CHECK_FALSE(detail::begun_where(found, starts));
    CHECK_FALSE(detail::begun_where(found, {}));
}

TEST_CASE("residual force: a force that the model lacks is seen with its size and sign") {
    // A free mass under 10 N that the model does not know; residual force is what the model pushes too much.
    const double period = 0.0005, mass = 50;
    std::vector<double> position(4000), command(4000, 0.0);
    for (std::size_t k = 0; k < position.size(); ++k) {
        const double t = static_cast<double>(k) * period;
        position[k] = 0.5 * 10 / mass * t * t;
    }
    plant_description d;
    d.mass_kg = mass;
    d.force_constant_N_per_V = 1;
    const auto force = residual_force(plant_model(d, workshop::usual.give()), position,
                                      std::vector<double>(4000, 0.0), period, 100);
    CHECK(force[2000] == doctest::Approx(-10).epsilon(1e-4));
}

TEST_CASE("predictor: a right model leaves nothing, a missing force leaves d T^2 / (M (1 - z)^2)") {
    const double period = 0.0005, mass = 100, force = 5;
    plant_description d;
    d.mass_kg = mass;
    d.force_constant_N_per_V = 100;
    d.delay_s = 0.0003;
    d.viscous_N_s_per_m = 40;
    plant_model real(d, workshop::usual.give());
    real.constant_force = force;
    std::vector<double> position, command;
    const auto boxes = axis_parameters(real);
    const plant_axis older(boxes, 0.0003), newer(boxes, period - 0.0003);
    plant_axis::state s;
    for (std::size_t k = 0; k < 6000; ++k) {
        position.push_back(s.x);
        command.push_back(std::sin(0.01 * static_cast<double>(k)));
        older.advance(s, command[k > 0 ? k - 1 : 0], {});
        newer.advance(s, command[k], {});
    }
    const predictor observer{.period = period, .corner_Hz = 60, .position = position, .command = command};
    std::vector<double> e;
    observer.run(real, e);
    CHECK(rms(std::span(e).subspan(1000)) < 1e-12);
    observer.run(plant_model(d, workshop::usual.give()), e);
    const double w = two_pi * observer.corner_Hz;
    const double z = std::exp(-w * period); // at rest L2 e makes up for d T / M in each period
    CHECK(workshop::near(e[5000], force / mass * std::pow(period / (1 - z), 2), 0.005));
}

TEST_CASE("plant model: moves as the library's linear motor does, and sticks") {
    namespace q = quadrant;
    plant_description d;
    d.mass_kg = 200;
    d.force_constant_N_per_V = 1000;
    d.viscous_N_s_per_m = 300;
    d.coulomb_N = 60;
    d.static_N = 90;
    d.stribeck_velocity_m_per_s = 0.003;
    const plant_model model(d, workshop::usual.give());
    q::linear_motor<q::stribeck<>> motor{
        {.mass = q::quantity<q::si::mass>::from_value(200),
         .force_constant = q::gain_of<q::signal::force, q::signal::voltage>::from_value(1000),
         .friction = {.coulomb = q::quantity<q::si::force>::from_value(60),
                      .static_level = q::quantity<q::si::force>::from_value(90),
                      .stribeck_velocity = q::quantity<q::si::velocity>::from_value(0.003),
                      .viscous = q::gain_of<q::signal::force, q::signal::velocity>::from_value(300)},
         .substeps = 20},
        q::duration::from_value(0.0005)};
    const plant_axis axis(axis_parameters(model), 0.0005 / 20);
    plant_axis::state s;
    for (int k = 0; k < 4000; ++k) {
        const double u = 0.2 * std::sin(0.004 * k);
        motor(q::quantity<q::si::electric_potential>::from_value(u));
        for (int i = 0; i < 20; ++i) axis.advance(s, u, {});
    }
    // 65 mm of motion; two contacts that give and break away otherwise differ by 50 um behind four reversals.
    CHECK(std::abs(s.x - motor.now().x.value()) < 1e-4);
    s = {};
    for (int k = 0; k < 40000; ++k)
        axis.advance(s, 0.085 * std::min(1.0, k / 20000.0), {}); // up to 85 N, below the 90 N that break away
    CHECK(std::abs(s.v) < 1e-9);
    CHECK(s.x < 3e-7);
}

TEST_CASE("motion segments: cut where the motion changes, none shorter than five blocks") {
    const double period = 0.001;
    std::vector<double> x;
    for (int k = 0; k < 6000; ++k)
        x.push_back(0.05 * std::sin(two_pi * 0.5 * period * k)); // a reversal a second
    const auto segment = motion_segments(x, period, workshop::usual);
    CHECK(segment.back() + 1 == 7); // half a second up to the first reversal, then each second
    std::size_t begun = 0;
    for (std::size_t k = 1; k < segment.size(); ++k)
        if (segment[k] != segment[k - 1]) {
            CHECK(k - begun >= 250);
            CHECK(std::abs(std::abs(x[k]) - 0.05) < 1e-4);
            begun = k;
        }
}

TEST_CASE("observed count: the step in which a position really moves") {
    std::vector<double> x;
    for (int k = 0; k < 5000; ++k) x.push_back(2e-6 * std::round(0.01 * std::sin(0.003 * k) / 2e-6));
    CHECK(workshop::near(observed_count(x, 1e-9), 2e-6, 0.001));
    CHECK(observed_count(std::vector<double>(100, 0.5), 1e-9) == 0);
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

TEST_CASE("regimes: Coulomb friction lies in velocity, cogging in position, each above nine tenths") {
    axis_log log;
    log.name = "x";
    const double period = 0.001;
    for (int k = 0; k < 16000; ++k) {
        log.position.push_back(0.05 * std::sin(two_pi * 0.25 * period * k));
        log.reference.push_back(log.position.back());
        log.command.push_back(0);
    }
    const auto record = prepare(log, period, 1e-7, workshop::usual);
    std::vector<double> coulomb, cogging;
    for (std::size_t k = 0; k < log.position.size(); ++k) {
        coulomb.push_back(record.velocity[k] > 0 ? 20.0 : -20.0);
        cogging.push_back(20 * std::sin(two_pi * log.position[k] / 0.02));
    }
    const auto share = [&](const std::vector<double>& force, const std::string& view) {
        for (const auto& p : regimes(force, record))
            if (p.view == view) return p.share;
        return estimate{};
    };
    CHECK(share(coulomb, "velocity").value > 0.9);
    CHECK(share(coulomb, "position").value < 0.1);
    CHECK(share(cogging, "position").value > 0.9);
    CHECK(share(cogging, "velocity").value < 0.1);
    for (const auto& p : regimes(cogging, record)) {
        CHECK(p.share.low <= p.share.value);
        CHECK(p.share.value <= p.share.high);
    }
}

TEST_CASE("calibration: a constant force and the asymmetries of friction move inside their tolerances, of "
          "either sign; "
          "what the file does not describe stays") {
    axis_description axis;
    axis.plant.mass_kg = 10;
    const auto moving = [&](std::string_view key) {
        std::optional<parameter> out;
        for (parameter& p : calibration(axis, workshop::usual.give()))
            if (p.key == key) out = std::move(p);
        return out;
    };
    CHECK_FALSE(moving("constant_force_N"));
    for (const double sign : {-1, 1}) {
        axis.plant.constant_force_N = sign * 4;
        axis.plant.coulomb_N = 5;
        axis.plant.coulomb_asymmetry = sign * 0.2;
        axis.plant.viscous_asymmetry = sign * 0.1;
        for (const auto& [key, value] :
             {std::pair{"constant_force_N", 4.0}, std::pair{"coulomb_asymmetry", 0.2},
              std::pair{"viscous_asymmetry", 0.1}}) {
            CAPTURE(key);
            const auto p = moving(key);
            REQUIRE(p);
            plant_model plant(axis, workshop::usual.give());
            CHECK(workshop::near(p->of(plant), sign * value, 1e-12));
            CHECK(workshop::near(p->low, sign * value - 0.05 * value, 1e-12)); // no tolerance is given
            CHECK(workshop::near(p->high, sign * value + 0.05 * value, 1e-12));
            CHECK(workshop::near(p->from_fit(p->expected), sign * value, 1e-12));
            CHECK(p->spread > 0);
        }
    }
}

TEST_CASE(
    "calibration: a contact described as giving way stays as described, one that gives way a little may move") {
    plant_description d;
    d.mass_kg = 200;
    d.coulomb_N = 60;
    const auto calibrated = [&] { // the machine file as calibration begins with it
        plant_model plant(d, workshop::usual.give());
        bool moves = false;
        axis_description axis;
        axis.plant = d;
        for (const parameter& p : calibration(axis, workshop::usual.give())) {
            p.of(plant) = p.start;
            moves |= p.key == "presliding_length_m";
        }
        return std::pair(plant.friction.contact, moves);
    };
    CHECK(calibrated().second);
    d.presliding_length_m = 1e-5;
    CHECK(workshop::near(calibrated().first.way_to_63_percent(), 1e-5, 1e-9));
    CHECK_FALSE(calibrated().second);
    d.presliding_length_m.reset();
    for (double stiffness : {60 / 1e-6, 60 / 1e-5}) { // one element: of 1 um, of 10 um
        d.gms_weights = {1};
        d.gms_stiffness_N_per_m = {stiffness};
        const auto [contact, moves] = calibrated();
        CHECK(workshop::near(contact.lengths()[0], 60 / stiffness, 1e-9));
        CHECK(moves == (60 / stiffness < 2e-6));
    }
    d.gms_weights = {0.5, 0.5};
    d.gms_stiffness_N_per_m = {3e7, 3e6};
    const auto [contact, moves] = calibrated();
    CHECK(workshop::near(contact.lengths()[0], 1e-6, 1e-9));
    CHECK(workshop::near(contact.lengths()[1], 1e-5, 1e-9));
    CHECK_FALSE(moves);
    d.coulomb_N = 0; // nothing gives way, and no length comes of it
    CHECK(calibrated().first.length > 0);
}

TEST_CASE("fit: bounds hold, and a value beyond them is found once it is free") {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.mass = 225;
    const auto log = workshop::run(real);
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
    const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
    CHECK(models.calibrated().fit.plant.mass <= 180 * 1.012 * 1.02 * (1 + 1e-9));
    CHECK(models.with({&suspect::mass}).fit.plant.mass == doctest::Approx(225).epsilon(0.02));
}

TEST_CASE("diagnose: a value that stopped at the end of its range is marked, one inside is not") {
    candidate c;
    c.fit.parameters = {{.key = "mass_kg", .low = 1, .high = 4, .logarithmic = true},
                        {.key = "spring_N_per_m", .low = 0, .high = 10}};
    c.fit.x = Eigen::Vector2d(std::log(4.0), 5);
    std::vector<parameter_estimate> found{{"mass_kg", {{4, 3, 5}}}, {"spring_N_per_m", {{5, 4, 6}}}};
    mark_bounds(c, found);
    CHECK(found[0].on_bound);
    CHECK_FALSE(found[1].on_bound);
    c.fit.x[1] = 0;
    mark_bounds(c, found);
    CHECK(found[1].on_bound);
}

TEST_CASE("doubt_by_loop: claims with which the loop goes further from the log are suspects") {
    const auto left = [](std::vector<double> said, const std::vector<double>& errors) {
        std::vector<cause> causes(said.size());
        for (std::size_t i = 0; i < said.size(); ++i)
            causes[i].probability = causes[i].group_probability = said[i];
        doubt_by_loop(causes, errors);
        for (std::size_t i = 0; i < said.size(); ++i) {
            CHECK(causes[i].probability == causes[i].group_probability);
            said[i] = causes[i].probability;
        }
        return said;
    };
    using probabilities = std::vector<double>;
    CHECK(left({0.9}, {1, 0.1}) == probabilities{0.9});
    CHECK(left({0.9}, {1, 1.05}) == probabilities{0.9}); // no clear difference
    CHECK(left({0.9}, {1, 1.2}) == probabilities{0.4});
    CHECK(left({0.9, 0.8}, {1, 1.5, 0.1}) == probabilities{0.9, 0.8}); // both together correct it
    CHECK(left({0.9, 0.8}, {1, 0.1, 0.2}) == probabilities{0.9, 0.4});
    CHECK(left({0.9, 0.1}, {1, 0.1, 0.2}) == probabilities{0.9, 0.1}); // only a suspect
    CHECK(left({0.9}, {}) == probabilities{0.9});                      // no loop
}

TEST_CASE("search: a law holds another in its place, beside the same names") {
    const auto with = [](std::vector<const effect*> some) { return candidate{.effects = std::move(some)}; };
    const effect *cutting = effect_named("cutting_force"), *constant = effect_named("constant_force"),
                 *coulomb = effect_named("coulomb_friction");
    CHECK(search::holds(with({cutting}), with({constant})));
    CHECK(search::holds(with({coulomb, cutting}), with({constant, coulomb})));
    CHECK_FALSE(search::holds(with({constant}), with({cutting})));
    CHECK_FALSE(search::holds(with({cutting}), with({coulomb})));
    CHECK_FALSE(search::holds(with({cutting}), with({cutting})));
    CHECK_FALSE(search::holds(with({cutting, coulomb}), with({constant})));
    CHECK_FALSE(search::holds(with({cutting, constant}), with({cutting, coulomb})));
}
