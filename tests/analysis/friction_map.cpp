// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/fit_stribeck.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const stribeck<>::parameters truth{122_N, 177_N, 2.2_mmps, 1750_N / 1_mps};
const auto kf = 1450_N / 1_V;
const auto T = 500_us;

double force_at(double v, double shape = 1) {
    return 122 + 55 * std::exp(-std::pow(v / 2.2e-3, shape)) + 1750 * v;
}
/// Noise of standard deviation `sigma`, its neighbours correlated by `rho`.
class noise {
public:
    noise(unsigned seed, double sigma, double rho) : random_(seed), sigma_(sigma), rho_(rho) {}
    double operator()() {
        last_ = rho_ * last_ + std::sqrt(1 - rho_ * rho_) * sigma_ * gauss_(random_);
        return last_;
    }

private:
    std::mt19937 random_;
    std::normal_distribution<double> gauss_;
    double sigma_, rho_, last_ = 0;
};
/// Speeds up for 0.3 s, runs 4 s with a force that settles, brakes for 0.2 s; pushed by 8 N whichever way it
/// goes.
test_run<> run(double v, unsigned seed, double shape = 1) {
    test_run<> out;
    noise n(seed, 2, 0.9);
    double x = 0;
    for (int i = 0; i < 9000; ++i) {
        const double t = i * 5e-4, now = v * std::min({1.0, t / 0.3, std::max(0.0, (4.5 - t) / 0.2)});
        x += now * 5e-4;
        const double way = v > 0 ? 1 : -1, a = t < 0.3 ? v / 0.3 : t > 4.3 ? -v / 0.2 : 0;
        const double force =
            way * force_at(std::abs(now), shape) * (1 + 0.1 * std::exp(-t / 0.2)) + 320 * a + 8 + n();
        out.position.push_back(displacement::from_value(0.25e-6 * std::round(x / 0.25e-6)));
        out.command.push_back(force / 1450 * 1_V);
    }
    return out;
}
std::vector<test_run<>> runs(std::initializer_list<double> speeds, unsigned seed, double shape = 1) {
    std::vector<test_run<>> out;
    for (const double v : speeds)
        for (const double way : {1.0, -1.0}) out.push_back(run(way * v, seed++, shape));
    return out;
}
/// Points of eq. (3.5) with errors of `sigma`, as a map would give them.
friction_map map_of(std::initializer_list<double> speeds, double sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    friction_map out{{}, 15, {}};
    for (const double v : speeds)
        out.points.push_back({v * 1_mps, (force_at(v) + sigma * gauss(random)) * 1_N, sigma * 1_N, 0_N});
    return out;
}
} // namespace

TEST_CASE("settle_mean: the standard error counts correlation: intervals of 95 % hold the mean in 95 of 100 "
          "records") {
    const auto held = [](double rho) {
        int out = 0;
        for (unsigned seed = 1; seed <= 400; ++seed) {
            noise n(seed, 1, rho);
            for (int i = 0; i < 1000; ++i) n();
            std::vector<double> x(4000);
            for (double& each : x) each = 5 + n();
            const auto found = settle_mean(x);
            out += std::abs(found.mean - 5) < student_95(found.freedom) * found.standard_error;
        }
        return out;
    };
    for (const double rho : {0.0, 0.9, 0.98}) { // over up to 50 samples
        CAPTURE(rho);
        CHECK(held(rho) >= 360); // 380 +- 4.4; the rule looks for the stretch of least spread, which costs some
        CHECK(held(rho) <= 397);
    }
    CHECK(held(0.995) >= 300); // over 200 of 4000 samples: too few are independent, 320 of 400
}
TEST_CASE("settle_mean: drops the run in, and says when there was nothing but run in") {
    noise n(1, 0.1, 0.5);
    std::vector<double> x, drift;
    for (int i = 0; i < 2000; ++i) x.push_back(3 + 10 * std::exp(-i / 100.0) + n()), drift.push_back(i);
    const auto found = settle_mean(x);
    CHECK(found.first > 300);
    CHECK(found.first < 1000);
    CHECK(found.settled);
    CHECK(std::abs(found.mean - 3) < 0.05);
    CHECK_FALSE(settle_mean(drift).settled);
    CHECK_THROWS_AS(settle_mean(std::vector<double>(63)), invalid_parameter);
}
TEST_CASE("student_95: table values within 1 %") {
    for (const auto& [n, t] : {std::pair{1., 12.706},
                               {2., 4.303},
                               {3., 3.182},
                               {4., 2.776},
                               {5., 2.571},
                               {10., 2.228},
                               {15., 2.131},
                               {30., 2.042},
                               {1e6, 1.960}})
        CHECK(student_95(n) == doctest::Approx(t).epsilon(0.01));
}
TEST_CASE("friction map: mean of both directions at constant speed, run in and braking left out, the push of 8 "
          "N beside it") {
    const auto map = map_friction<>(runs({0.0003, 0.001, 0.003, 0.01}, 1), T, kf);
    REQUIRE(map.points.size() == 4);
    CHECK(map.unused.empty());
    for (const auto& p : map.points) {
        const double v = p.speed.value(), error = p.standard_error.value();
        CAPTURE(v);
        CHECK(std::abs(p.friction.value() - force_at(v)) < 4 * error);
        CHECK(std::abs(p.offset.value() - 8) < 4 * error);
        CHECK(error > 0.05); // 2 N, correlated over 20 samples, some 3 s twice: 0.08 N
        CHECK(error < 0.25);
    }
    CHECK(map.points[3].speed.value() == doctest::Approx(0.01).epsilon(1e-3).scale(0));
}
TEST_CASE("friction map: a run that jerks, rests, or has no counterpart is left out and named") {
    auto some = runs({0.001, 0.003}, 1);
    some.pop_back();            // 3: 3 mm/s, backwards
    test_run<> jerks = some[0]; // half of the time at rest, then twice as fast
    for (std::size_t i = 0; i < jerks.position.size(); ++i) {
        const double t = double(i % 500) / 500, whole = double(i / 500);
        jerks.position[i] = 2.5e-4 * (whole + std::max(0.0, 2 * t - 1)) * 1_m;
    }
    some.push_back(jerks);
    some.push_back({std::vector(9000, 0_m), std::vector(9000, 0.01_V)});
    const auto map = map_friction<>(some, T, kf);
    CHECK(map.points.size() == 1);
    REQUIRE(map.unused.size() == 3);
    CHECK(map.unused[0].run == 3);
    CHECK(map.unused[0].why.find("steady") != std::string::npos);
    CHECK(map.unused[1].why.find("move") != std::string::npos);
    CHECK(map.unused[2].run == 2);
    CHECK(map.unused[2].why.find("other way") != std::string::npos);
}
TEST_CASE("friction map: refuses what is no record") {
    auto some = runs({0.001}, 1);
    CHECK_THROWS_AS(map_friction<>(some, T, 0.0 * kf), invalid_parameter);
    CHECK_THROWS_AS(map_friction<>(some, T, kf, {.uneven = 0.9}), invalid_parameter);
    some[0].command.pop_back();
    CHECK_THROWS_AS(map_friction<>(some, T, kf), invalid_parameter);
    some[0].command.push_back(double(NAN) * 1_V);
    CHECK_THROWS_AS(map_friction<>(some, T, kf), invalid_parameter);
    CHECK_THROWS_AS(map_friction<>({{std::vector(600, 0_m), std::vector(600, 0_V)}}, T, kf), invalid_parameter);
}
TEST_CASE("fit_stribeck: gives back eq. (3.5) from exact points, also of another shape") {
    for (const double shape : {1.0, 2.0}) {
        friction_map map{{}, 15, {}};
        for (double v = 1e-4; v < 0.05; v *= 2)
            map.points.push_back({v * 1_mps, force_at(v, shape) * 1_N, 0_N, 0_N});
        const auto fit = fit_stribeck(map, shape);
        CHECK(fit.converged);
        CHECK(fit.limits.empty());
        CHECK(fit.coulomb.value.value() == doctest::Approx(122).epsilon(1e-5));
        CHECK(fit.static_level->value.value() == doctest::Approx(177).epsilon(1e-5));
        CHECK(fit.stribeck_velocity->value.value() == doctest::Approx(2.2e-3).epsilon(1e-5).scale(0));
        CHECK(fit.viscous.value.value() == doctest::Approx(1750).epsilon(1e-5));
        CHECK_NOTHROW(stribeck<>(fit.parameters(), T));
        CHECK(fit.parameters().shape == shape);
    }
}
TEST_CASE("fit_stribeck: the intervals of 95 % hold the truth in 95 of 100 maps") {
    int fc = 0, fs = 0, vs = 0, viscous = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const auto fit = fit_stribeck(map_of({1e-4, 3e-4, 6e-4, 1e-3, 2e-3, 4e-3, 1e-2, 3e-2}, 0.5, seed));
        REQUIRE(fit.static_level);
        fc += fit.coulomb.holds(truth.coulomb), fs += fit.static_level->holds(truth.static_level);
        vs += fit.stribeck_velocity->holds(truth.stribeck_velocity),
            viscous += fit.viscous.holds(truth.viscous);
    }
    for (const int held : {fc, fs, vs, viscous})
        CHECK(held >= 184); // 190 +- 3.1; widened by surprise, so rather more
}
TEST_CASE("fit_stribeck: without slow speeds Fs is not guessed, and the level and viscous part are given") {
    const auto fast = fit_stribeck(map_of({0.011, 0.015, 0.02, 0.025, 0.03, 0.05}, 0.1, 1));
    CHECK_FALSE(fast.static_level);
    CHECK_FALSE(fast.stribeck_velocity);
    CHECK(fast.limits.find("Fs is not visible") != std::string::npos);
    CHECK(fast.coulomb.value.value() == doctest::Approx(122).epsilon(0.02));
    CHECK(fast.viscous.value.value() == doctest::Approx(1750).epsilon(0.02));
    CHECK(fast.parameters().static_level == fast.parameters().coulomb);
    // One speed below Vs is no fall, however exact.
    CHECK_FALSE(fit_stribeck(map_of({2e-3, 3e-3, 5e-3, 1e-2, 2e-2, 3e-2}, 1e-3, 1)).static_level);
    CHECK(fit_stribeck(map_of({1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 3e-2}, 1e-3, 1)).static_level);
    CHECK_FALSE(fit_stribeck(map_of({1e-3, 3e-3, 1e-2, 3e-2}, 0.1, 1)).static_level); // 4 points, 4 unknowns
}
TEST_CASE("fit_stribeck: another shape than the fitted one is told by its surprise") {
    friction_map map{{}, 15, {}};
    for (double v = 1e-4; v < 0.05; v *= 2) map.points.push_back({v * 1_mps, force_at(v, 2) * 1_N, 0.1_N, 0_N});
    CHECK(fit_stribeck(map).surprise > 10);
}
TEST_CASE("fit_stribeck: refuses fewer than 4 speeds and speeds too near each other") {
    CHECK_THROWS_AS(fit_stribeck(map_of({1e-3, 3e-3, 1e-2}, 0.1, 1)), invalid_parameter);
    CHECK_THROWS_AS(fit_stribeck(map_of({1e-3, 1.2e-3, 1.5e-3, 2e-3, 2.5e-3}, 0.1, 1)), invalid_parameter);
    CHECK_THROWS_AS(fit_stribeck(map_of({1e-3, 3e-3, 1e-2, 3e-2}, 0.1, 1), 9), invalid_parameter);
}
