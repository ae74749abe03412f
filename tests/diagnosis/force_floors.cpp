// SPDX-License-Identifier: BSL-1.0
// The force that noise of the reading leaves, and what is compared with it.
#include <quadrant/diagnosis/fit/record.hpp>
#include <quadrant/diagnosis/fit/residual_force.hpp>

#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

using namespace quadrant::diagnosis;

TEST_CASE("force floors: what white noise leaves of a mass grows with the mass, and is what is measured") {
    constexpr double period = 1e-3, band = 40, sigma = 1e-6;
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, sigma);
    std::vector<double> read(60000);
    for (double& x : read) x = noise(random);
    const std::vector<double> still(read.size(), 0.0);
    const force_floors floors(period, band, {});
    for (const double mass : {2.0, 50.0}) {
        plant_model plant;
        plant.mass = mass;
        const auto left = residual_force(plant, read, still, period, band);
        CHECK(rms(left) == doctest::Approx(floors(mass, sigma)).epsilon(0.03));
    }
}
TEST_CASE("force floors: a drive's replay and the mass add as signals do, not as sizes") {
    constexpr double period = 1e-3, band = 40, mass = 3;
    std::vector<double> reaction(4001, 0.0);
    reaction[2000] = -4e6; // of a position gain
    reaction[2001] = 1e6;
    std::vector<double> both(reaction.size(), 0.0);
    both[1999] = both[2001] = mass / (period * period);
    both[2000] = -2 * both[2001];
    for (std::size_t k = 0; k < both.size(); ++k) both[k] -= reaction[k];
    const auto seen = zero_phase(both, band, period);
    double sum = 0;
    for (const double x : seen) sum += x * x;
    CHECK(force_floors(period, band, reaction)(mass, 1) == doctest::Approx(std::sqrt(sum)).epsilon(1e-9));
}
TEST_CASE("rows that are left out make no force smaller") {
    axis_record r;
    std::vector<double> residual(100, 2.0);
    CHECK(rms_judged(r, residual) == doctest::Approx(2));
    r.left_out.assign(100, 0);
    for (std::size_t k = 20; k < 70; ++k) {
        r.left_out[k] = 1;
        residual[k] = 0; // as residual_force() leaves them
    }
    CHECK(rms_judged(r, residual) == doctest::Approx(2));
    r.left_out.assign(100, 1);
    CHECK(rms_judged(r, residual) == 0);
}
