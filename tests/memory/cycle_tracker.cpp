// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/memory/cycle_tracker.hpp>
#include <quadrant/memory/repetitive.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using tracker = cycle_tracker<signal::force, 100>;
constexpr double true_cycle = 85.859; ///< periods of a spindle of 23.294 Hz at 2 kHz

/// A spindle whose speed may change: its angle goes on, its force has three harmonics.
struct spindle {
    double angle = 0;
    double operator()(double cycle) {
        angle += 2 * std::numbers::pi / cycle;
        return 80 * std::cos(angle) + 60 * std::sin(2 * angle) + 70 * std::cos(3 * angle + 1);
    }
};
const tracker::parameters given{.cycle = 83.0 * 500_us, .range = 0.08, .settles_in = 200_ms};
} // namespace

TEST_CASE("cycle_tracker: finds a cycle between samples from 3 % beside it, and follows a change of speed") {
    tracker block(given, 500_us);
    spindle turns;
    const auto found = [&] { return block.cycle().value() / 500e-6; };
    for (int k = 0; k < 4000; ++k) block(turns(true_cycle) * 1_N);
    CHECK(std::abs(found() - true_cycle) < 0.002);
    for (int k = 0; k < 4000; ++k) block(turns(1.02 * true_cycle) * 1_N);
    CHECK(std::abs(found() - 1.02 * true_cycle) < 0.01);
    CHECK_FALSE(block.limited());
}

TEST_CASE("cycle_tracker: approaches with its time constant once it has seen a whole cycle") {
    // Two trackers of the same wire: the error of the slower one falls by e in twice the time.
    spindle turns;
    auto slower = given;
    slower.settles_in = 400_ms;
    tracker fast(given, 500_us), slow(slower, 500_us);
    for (int k = 0; k < 4000; ++k) {
        const auto x = turns(true_cycle) * 1_N;
        fast(x), slow(x);
    }
    const auto error = [](const tracker& t) {
        return std::abs(t.cycle().value() / 500e-6 - 1.01 * true_cycle);
    };
    for (int k = 0; k < 200; ++k) { // until the old speed has left the ring
        const auto x = turns(1.01 * true_cycle) * 1_N;
        fast(x), slow(x);
    }
    const double fast_from = error(fast), slow_from = error(slow);
    for (int k = 0; k < 400; ++k) {
        const auto x = turns(1.01 * true_cycle) * 1_N;
        fast(x), slow(x);
    }
    CHECK(std::log(fast_from / error(fast)) == doctest::Approx(1).epsilon(0.1)); // 400 samples are 200 ms
    CHECK(std::log(slow_from / error(slow)) == doctest::Approx(0.5).epsilon(0.1));
}

TEST_CASE("cycle_tracker: noise on the wire scatters the cycle and does not bias it") {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, 20);
    auto p = given;
    p.settles_in = 500_ms;
    tracker block(p, 500_us);
    spindle turns;
    double sum = 0, squares = 0;
    int count = 0;
    for (int k = 0; k < 200000; ++k) {
        block((turns(true_cycle) + noise(random)) * 1_N);
        if (k < 10000 || k % 2000 != 0) continue; // two time constants apart: as good as independent
        const double off = block.cycle().value() / 500e-6 - true_cycle;
        sum += off, squares += off * off, ++count;
    }
    const double mean = sum / count, deviation = std::sqrt(squares / count);
    CHECK(deviation < 0.1);
    CHECK(std::abs(mean) < 4 * deviation / std::sqrt(double(count)));
}

TEST_CASE("cycle_tracker: gives what does not repeat") {
    auto p = given;
    p.cycle = 80.0 * 500_us;
    tracker block(p, 500_us);
    for (int k = 0; k < 400; ++k) {
        const double comes_again = std::sin(2 * std::numbers::pi * k / 80), once = k == 300 ? 5 : 0;
        const double y = block((comes_again + once) * 1_N).value();
        if (k > 100) CHECK(y == doctest::Approx(k == 300 ? 5 : k == 380 ? y : 0).epsilon(1e-6).scale(1));
    }
}

TEST_CASE("cycle_tracker: stays where nothing shows a cycle, and within its range") {
    auto p = given;
    p.least = 1_N;
    tracker block(p, 500_us);
    std::mt19937_64 random(6);
    std::normal_distribution<double> noise(0, 0.5);
    for (int k = 0; k < 5000; ++k) block(noise(random) * 1_N);
    CHECK(block.cycle().value() == doctest::Approx(83 * 500e-6).epsilon(1e-12));
    spindle turns;
    for (int k = 0; k < 5000; ++k) block(turns(92) * 1_N); // beyond 83 * 1.08
    CHECK(block.limited());
    CHECK(block.cycle().value() == doctest::Approx(1.08 * 83 * 500e-6).epsilon(1e-12));
    block.reset();
    CHECK(block.cycle().value() == doctest::Approx(83 * 500e-6).epsilon(1e-12));
    CHECK_FALSE(block.limited());
}

TEST_CASE("cycle_tracker: a memory that follows it cancels a force whose cycle has changed") {
    // What is left of a force after what a first-order memory of one cycle has learnt of it.
    using memory = repetitive<signal::force, 100>;
    const auto left_of_it = [](bool follows) {
        tracker watch(given, 500_us);
        memory learns({.cycle = 85.859 * 500_us}, 500_us);
        spindle turns;
        double squares = 0;
        for (int k = 0; k < 12000; ++k) {
            const double force = turns(k < 4000 ? true_cycle : 1.02 * true_cycle);
            watch(force * 1_N);
            if (follows) learns.cycle(watch.cycle());
            static double learned;
            if (k == 0) learned = 0;
            const double error = force - learned;
            learned = learns(error * 1_N).value(); // acts in the next period
            if (k >= 10000) squares += error * error / 2000;
        }
        return std::sqrt(squares);
    };
    const double held = left_of_it(false), followed = left_of_it(true);
    CHECK(followed < 0.25 * held);
}

TEST_CASE("cycle_tracker: refuses what it cannot hold, and takes no NaN in") {
    const auto message = [](tracker::parameters p, duration period = 500_us) -> std::string {
        try {
            tracker(p, period);
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return {};
    };
    auto p = given;
    p.cycle = 95.0 * 500_us; // with 8 % beyond 100 periods
    CHECK(message(p).find(
              "cycle_tracker.cycle = 0.0475 s: must lie, with its range, between 0.0015 s and 0.05 s") == 0);
    p = given, p.range = 0.5;
    CHECK(message(p).find("cycle_tracker.range = 0.5") == 0);
    p = given, p.settles_in = 10_ms;
    CHECK(message(p).find("cycle_tracker.settles_in = 0.01 s: must be at least one cycle") == 0);
    p = given, p.least = -1_N;
    CHECK(message(p).find("cycle_tracker.least = -1") == 0);
    tracker block(given, 500_us), twin = block;
    spindle a, b;
    for (int k = 0; k < 500; ++k) {
        if (k == 250) {
            block(std::nan("") * 1_N);
            CHECK(block.faulted());
        }
        block(a(true_cycle) * 1_N), twin(b(true_cycle) * 1_N);
    }
    CHECK(block.cycle().value() == twin.cycle().value());
}
