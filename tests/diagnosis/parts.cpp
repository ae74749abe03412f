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
