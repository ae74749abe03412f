// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
namespace s = quadrant::signal;
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
using estimator = ferraris_force_estimator<s::voltage>;
const estimator::parameters y{.mass = 170_kg, .force_constant = 1470_N / 1_V, .corner = 90_Hz};

/// The mass with viscous friction, exact for a held command and force; its acceleration as the next sample
/// finds it.
struct plant {
    double x = 0, v = 0, a = 0;
    void step(double u, double push) {
        const double m = 170, c = 3400, e = std::exp(-c / m * T.value()), to = (1470 * u + push) / c;
        x += to * T.value() + (v - to) * (1 - e) * m / c;
        v = to + (v - to) * e;
        a = (1470 * u + push - c * v) / m;
    }
};
} // namespace

TEST_CASE("ferraris_force_estimator: the force is Q times the force, whatever is commanded") {
    for (const double f : {5.0, 40.0, 90.0}) {
        estimator box{y, T};
        plant p;
        std::complex<double> sum = 0;
        double u = 0;
        for (int k = 0; k < 2400; ++k) {
            const double angle = 2 * pi * f * k * T.value();
            const auto d = box(p.a * 1_mps2, u * 1_V, 3400 * p.v * 1_N); // z^-1: u of the last cycle
            if (k >= 2000) sum += d.value() * std::polar(2.0 / 400, -angle);
            u = 0.5 * std::sin(0.07 * k);
            p.step(u, 100 * std::cos(angle));
        }
        // The push of cycle k is seen at sample k + 1; without a rest, as nothing is differentiated.
        const auto expected = 100.0 * box.response(f * 1_Hz) / 170.0 * std::polar(1.0, -2 * pi * f * T.value());
        CHECK(std::abs(sum - expected) < 1e-8);
    }
}
TEST_CASE("ferraris_force_estimator: fed back it leaves 1 - Q z^-1 of a force in the motion") {
    estimator box{y, T};
    plant with, without;
    double u = 0, most = 0, most_without = 0;
    for (int k = 0; k < 8000; ++k) {
        const double angle = 2 * pi * 5 * k * T.value();
        box(with.a * 1_mps2, u * 1_V, 3400 * with.v * 1_N);
        u = -box.command().value();
        with.step(u, 100 * std::cos(angle));
        without.step(0, 100 * std::cos(angle));
        if (k < 6000) continue;
        most = std::max(most, std::abs(with.a));
        most_without = std::max(most_without, std::abs(without.a));
    }
    const double share = std::abs(1.0 - box.response(5_Hz) / 170.0 * std::polar(1.0, -2 * pi * 5 * T.value()));
    CHECK(share == Approx(0.127).epsilon(0.01).scale(0)); // 2 w / wc + w T
    CHECK(most / most_without == Approx(share).epsilon(1e-3).scale(0));
}
TEST_CASE("ferraris_force_estimator: friction that is given is not taken for a disturbance") {
    estimator box{y, T};
    for (int k = 0; k < 400; ++k) box(0_mps2, 0.1_V, 147_N); // stands still, held by friction
    CHECK(std::abs(box.command().value()) < 1e-12);
    for (int k = 0; k < 400; ++k) box(0_mps2, 0.1_V);
    CHECK(box.command().value() == Approx(-0.1).epsilon(1e-9));
}
TEST_CASE("ferraris_force_estimator: an offset of the sensor of 8580 um/s^2 is a force of 1.46 N on 170 kg") {
    estimator box{y, T};
    box.settle(0.00858_mps2);
    CHECK(box.command().value() == Approx(1.4586 / 1470).epsilon(1e-9)); // before any step too
    CHECK(box(0.00858_mps2).value() == Approx(1.4586).epsilon(1e-9));
}
TEST_CASE("ferraris_force_estimator: a bad argument of the three holds the force") {
    estimator box{y, T};
    box(1_mps2), box(2_mps2);
    const auto last = box(3_mps2);
    const auto command = box.command();
    CHECK(box(std::nan("") * 1_mps2) == last);
    CHECK(box(1_mps2, std::nan("") * 1_V) == last);
    CHECK(box(1_mps2, 0_V, std::nan("") * 1_N) == last);
    CHECK(box.command() == command);
    CHECK(box.faulted());
}
TEST_CASE("ferraris_force_estimator: refuses a mass and a motor that are none, and a corner above half the "
          "sampling rate") {
    const auto with = [](auto change) {
        auto p = y;
        change(p);
        return estimator(p, T);
    };
    CHECK_THROWS_WITH_AS(with([](auto& p) { p.mass = 0_kg; }),
                         "ferraris_force_estimator.mass = 0 kg: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.force_constant = 0_N / 1_V; }), invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.corner = 1000_Hz; }), invalid_parameter);
    CHECK_THROWS_AS(estimator(y, 0_s), invalid_parameter);
}
