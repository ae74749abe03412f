// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/trajectory/profile.hpp>
#include <quadrant/trajectory/stream_limiter.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration Ts = 1_ms;
using limiter_400 = trajectory::stream_limiter<400>;
constexpr double no_bound = trajectory::unlimited;
limiter_400::parameters limits(double v, double a, double j) {
    const trajectory::motion_limits all{v * 1_mps, a * 1_mps2, trajectory::jerk::from_value(j)};
    return {all.velocity, all.acceleration, all.jerk};
}
std::vector<double> through(limiter_400& limit, const std::vector<double>& x) {
    std::vector<double> y;
    for (const double each : x) y.push_back(limit(each * 1_m).value());
    return y;
}
/// Largest n-th difference per T^n.
double most(std::vector<double> y, int n) {
    double all = 0;
    for (int i = 0; i < n; ++i)
        for (std::size_t k = y.size() - 1; k > std::size_t(i); --k) y[k] = (y[k] - y[k - 1]) / 1e-3;
    for (std::size_t k = std::size_t(n); k < y.size(); ++k) all = std::max(all, std::abs(y[k]));
    return all;
}
} // namespace

TEST_CASE("stream_limiter: whatever comes in, the differences of what goes out keep all three limits") {
    std::mt19937 random(3);
    const auto between = [&](double low, double high) {
        return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
    };
    double tightest[3] = {};
    for (int trial = 0; trial < 60; ++trial) {
        const double v = between(0.01, 2), a = between(0.1, 20), j = std::max(between(2, 1000), 5.1 * a);
        limiter_400 limit{limits(v, a, j), Ts};
        std::vector<double> x(1500);
        const double size = between(1e-4, 1), pace = between(0.001, 0.3);
        double at = 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            if (random() % 200 == 0) at = size * std::uniform_real_distribution(-1.0, 1.0)(random); // jumps
            x[k] = at + (trial % 3 == 0   ? size * std::sin(pace * double(k))
                         : trial % 3 == 1 ? size * 1e-3 * double(random() % 1000)
                                          : 0);
        }
        const auto y = through(limit, x);
        const double allowed[] = {v, a, j};
        for (int n = 0; n < 3; ++n) {
            const double share = most(y, n + 1) / allowed[n];
            CAPTURE(n);
            CHECK(share <= 1 + 1e-5); // third differences of 1 m in double: 1e-16 m / (1 ms)^3
            tightest[n] = std::max(tightest[n], share);
        }
    }
    for (const double share : tightest) CHECK(share > 0.99); // and each limit was reached
}

TEST_CASE_TEMPLATE(
    "stream_limiter: in a million random samples the limits always hold within range(), in float to 4 %", Real,
    double, float) {
    using block = trajectory::stream_limiter<64, Real>;
    using at = typename block::value;
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(-1, 1);
    double fastest = 0, hardest = 0;
    int held = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const double T = trial % 2 == 0 ? 1e-3 : 5e-5, v = std::pow(10, unit(random)),
                     a = 10 * std::pow(10, unit(random));
        block limit({v * 1_mps, a * 1_mps2, trajectory::jerk::from_value(a / T / 10)}, T * 1_s);
        const double range = limit.range().value(), size = std::min(1.0, range) * (trial % 3 == 0 ? 1 : 0.1);
        limit.settle(at::from_value(Real(0.9 * size)));
        double now = 0.9 * size, y1 = double(limit(at::from_value(Real(now))).value()), y2 = y1;
        for (int k = 0; k < 2000; ++k) {
            if (random() % 100 == 0) now = 0.9 * size * unit(random);
            now += 1e-3 * v * T * unit(random);
            const double y = double(limit(at::from_value(Real(now))).value());
            fastest = std::max(fastest, std::abs(y - y1) / (v * T));
            hardest = std::max(hardest, std::abs(y - 2 * y1 + y2) / (a * T * T));
            y2 = y1, y1 = y;
        }
        CHECK_FALSE(limit.faulted());
        if (range > 1e30) continue;
        const auto last = limit(at::from_value(Real(now)));
        held += limit(at::from_value(Real(1.5 * range))) == last && limit.faulted();
    }
    // A position and its mean are rounded; in double nothing to speak of at 1 m.
    CHECK(fastest <= 1 + (std::same_as<Real, float> ? 0.04 : 1e-4));
    CHECK(hardest <= 1 + (std::same_as<Real, float> ? 0.04 : 1e-4));
    CHECK(hardest > 0.9);
    CHECK(held == 500); // a position beyond range() is a bad sample
}
TEST_CASE("stream_limiter: a stream within velocity and acceleration passes bit for bit, late by delay() with "
          "a jerk limit") {
    std::vector<double> x(2000);
    for (std::size_t k = 0; k < x.size(); ++k) // 0.094 m/s, 0.30 m/s^2
        x[k] = 0.03 * (1 - std::cos(3.14 * 1e-3 * double(k)));
    limiter_400 free{limits(0.2, 1, no_bound), Ts};
    CHECK(through(free, x) == x);
    CHECK_FALSE(free.limited());
    limiter_400 smooth{limits(0.2, 1, 40.0), Ts}; // a mean of 50
    CHECK(smooth.delay().value() == doctest::Approx(24.5e-3));
    const auto y = through(smooth, x);
    double off = 0; // a mean of a parabola is a N^2 T^2/24 away from its middle
    for (std::size_t k = 600; k < x.size(); ++k)
        off = std::max(off, std::abs(y[k] - 0.5 * (x[k - 24] + x[k - 25])));
    CHECK(off <= 0.30 * 2.5e-3 / 24);
}

TEST_CASE(
    "stream_limiter: a jump is reached without overshoot, exactly, and hardly later than by the best profile") {
    std::mt19937 random(5);
    double slowest = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const double v = 0.05 + 0.001 * double(random() % 500), a = 1 + 0.01 * double(random() % 900),
                     j = 6 * a + double(random() % 100), way = 1e-3 * double(1 + random() % 400);
        limiter_400 limit{limits(v, a, j), Ts};
        const auto best =
            trajectory::profile(
                {.length = way * 1_m, .limits = {v * 1_mps, a * 1_mps2, trajectory::jerk::from_value(1e9)}})
                .lasts();
        int k = 0;
        double y = 0, furthest = 0;
        for (; k < 20000 && std::abs(y - way) > 1e-14; ++k)
            furthest = std::max(furthest, y = limit(way * 1_m).value());
        const double mean = 2 * limit.delay().value() + 1e-3;
        CHECK(furthest <= way * (1 + 1e-14));
        CHECK(k * 1e-3 <= best.value() + mean + 3e-3); // whole samples: one a phase
        slowest = std::max(slowest, k * 1e-3 - best.value() - mean);
    }
    MESSAGE("latest: ", 1e3 * slowest, " ms");
}

TEST_CASE("stream_limiter: catches up with a moving stream without overshoot; one that stops dead is passed by "
          "v^2/(2 a)") {
    std::mt19937 random(9);
    for (int trial = 0; trial < 100; ++trial) {
        const double a = 1 + 0.01 * double(random() % 900), v = 0.1, speed = 1e-4 * double(random() % 900);
        limiter_400 limit{limits(v, a, no_bound), Ts};
        const double ahead = 1e-4 * double(random() % 500);
        double beyond = 0, x = ahead, y = 0;
        for (int k = 0; k < 12000; ++k, x += speed * 1e-3)
            y = limit(x * 1_m).value(), beyond = std::max(beyond, y - x);
        CHECK(beyond <= 1e-15);
        x -= speed * 1e-3;
        CHECK(std::abs(y - x) <= 1e-15); // has caught up
        for (int k = 0; k < 4000; ++k) y = limit(x * 1_m).value(), beyond = std::max(beyond, y - x);
        CHECK(beyond <= speed * speed / (2 * a) + 1e-12);
        CHECK(beyond >= speed * speed / (2 * a) - 1e-3 * speed); // and not less: it cannot be
        CHECK(std::abs(y - x) <= 1e-15);
    }
}

TEST_CASE("stream_limiter: shift moves the frame and nothing else") {
    limiter_400 one{limits(0.1, 2, 30), Ts}, other = one;
    double off = 0;
    for (int k = 0; k < 700; ++k) {
        const auto x = 20_mm * std::sin(0.01 * k);
        if (k == 333) other.shift(150_mm);
        const auto by = k < 333 ? 0_m : 150_mm;
        off = std::max(off, std::abs((other(x + by) - one(x) - by).value()));
    }
    CHECK(off <= 1e-14); // rounding of sums of 133
}

TEST_CASE("stream_limiter: refuses a jerk that needs a longer mean than it has") {
    CHECK_THROWS_WITH_AS(
        (limiter_400{limits(1, 10, 10), Ts}),
        "stream_limiter.jerk = 10 m/s^3: needs a mean of 2000 samples, and the capacity is 400",
        invalid_parameter);
    CHECK_THROWS_AS((limiter_400{limits(0, 1, 100), Ts}), invalid_parameter);
    CHECK_THROWS_AS((limiter_400{limits(1, no_bound, 100), Ts}), invalid_parameter);
}
