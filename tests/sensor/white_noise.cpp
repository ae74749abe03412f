// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/sensor/white_noise.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using noise = white_noise<signal::velocity>;
std::vector<double> drawn(std::uint64_t seed, int samples) {
    noise n{{2_mmps, seed}, 1_ms};
    std::vector<double> y;
    for (int k = 0; k < samples; ++k) y.push_back(n().value() / 2e-3);
    return y;
}
double mean_product(const std::vector<double>& a, const std::vector<double>& b, std::size_t late = 0) {
    double sum = 0;
    for (std::size_t k = late; k < a.size(); ++k) sum += a[k] * b[k - late];
    return sum / double(a.size() - late);
}
} // namespace

TEST_CASE("white_noise: 100 000 samples are normal: mean, variance, fourth moment, shares within 1 and 2 "
          "deviations") {
    const int n = 100'000;
    const double sigma = 1 / std::sqrt(double(n)); // of a mean of n; all bounds are four of theirs
    const auto y = drawn(1, n);
    double mean = 0, square = 0, fourth = 0, in_1 = 0, in_2 = 0;
    for (const double each : y) {
        mean += each / n, square += each * each / n, fourth += each * each * each * each / n;
        in_1 += (std::abs(each) < 1) / double(n), in_2 += (std::abs(each) < 2) / double(n);
    }
    CHECK(std::abs(mean) < 4 * sigma);
    CHECK(std::abs(square - 1) < 4 * std::sqrt(2.0) * sigma);
    CHECK(std::abs(fourth - 3) < 4 * std::sqrt(96.0) * sigma);
    CHECK(std::abs(in_1 - 0.6826895) < 4 * std::sqrt(0.68 * 0.32) * sigma);
    CHECK(std::abs(in_2 - 0.9544997) < 4 * std::sqrt(0.9545 * 0.0455) * sigma);
}
TEST_CASE("white_noise: no sample knows the ones before it, nor those of another seed") {
    const int n = 100'000;
    const auto a = drawn(1, n), b = drawn(2, n);
    for (const std::size_t late : {1u, 2u, 3u, 1000u})
        CHECK(std::abs(mean_product(a, a, late)) < 4 / std::sqrt(double(n - int(late))));
    for (const std::size_t late : {0u, 1u, 2u})
        CHECK(std::abs(mean_product(a, b, late)) < 4 / std::sqrt(double(n - int(late))));
}
TEST_CASE("white_noise: seed 1 begins as splitmix64 by hand says, so a run is the same on every machine") {
    const auto next = [](std::uint64_t state) {
        state += 0x9e3779b97f4a7c15u;
        state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
        state = (state ^ (state >> 27)) * 0x94d049bb133111ebu;
        return state ^ (state >> 31);
    };
    REQUIRE(next(0) == 0xe220a8397b1dcdafu); // what the reference implementation prints
    const std::uint64_t golden = 0x9e3779b97f4a7c15u, first = next(golden);
    const auto uniform = [&](std::uint64_t n) {
        return double((next(n * golden) >> 11) + 1) * std::pow(2.0, -53);
    };
    constexpr std::size_t samples = 1'000'000;
    const auto y = drawn(1, samples);
    double most = 0;
    for (std::uint64_t k = 0; k < samples; ++k) { // two numbers for each sample
        const double u = uniform(first + 2 * k), v = uniform(first + 2 * k + 1);
        most = std::max(most, std::abs(y[k] - std::sqrt(-2 * std::log(u)) * std::cos(8 * std::atan(1.0) * v)));
    }
    CHECK(most < 8.6 * 1e-15); // the cosine's angle alone is rounded by 4e-16
}
TEST_CASE("white_noise: without a deviation it is silent; a negative one is refused") {
    noise n{{}, 1_ms};
    for (int k = 0; k < 10; ++k) CHECK(n() == 0_mps);
    try {
        noise bad{{-1_mps}, 1_ms};
        FAIL("taken");
    } catch (const invalid_parameter& e) {
        CHECK(std::string(e.what()) == "white_noise.deviation = -1 m/s: must be finite and not below 0");
    }
}
