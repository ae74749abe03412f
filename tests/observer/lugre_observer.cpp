// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/observer/lugre_observer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const lugre<>::parameters friction{
    {8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1.5e6 * 1_N / 1_m, 400_N / 1_mps, 10_mmps};

/// The textbook equation in small steps of Runge and Kutta, velocity and error held.
struct fine_steps {
    double z = 0, correction;
    double slope(double v, double e, double at) const {
        const double g = 8 + 4 * std::exp(-(v / 5e-3) * (v / 5e-3));
        return v + correction * e - 1.5e6 * std::abs(v) * at / g;
    }
    void run(double v, double e, double time) {
        const int n = 400;
        const double h = time / n;
        for (int i = 0; i < n; ++i) {
            const double a = slope(v, e, z), b = slope(v, e, z + h / 2 * a), c = slope(v, e, z + h / 2 * b),
                         d = slope(v, e, z + h * c);
            z += h / 6 * (a + 2 * b + 2 * c + d);
        }
    }
};
} // namespace

TEST_CASE("lugre_observer: bends as its differential equation in small steps, with speed and error changing") {
    lugre_observer<> block({friction, 20.0 / 1_s}, 1_ms);
    fine_steps fine{.correction = 20};
    for (int k = 0; k < 300; ++k) {
        const double v = (6e-3 + 2e-3 * std::sin(0.05 * k)) * (k % 100 < 50 ? 1 : -1),
                     e = 5e-6 * std::cos(0.11 * k), before = fine.z;
        const double force = block(v * 1_mps, e * 1_m).value();
        fine.run(v, e, 1e-3);
        const double s1 = 400 * std::exp(-(v / 10e-3) * (v / 10e-3));
        REQUIRE(std::abs(1.5e6 * fine.z) < 12); // nothing is held back here
        CHECK(std::abs(block.now().force.value() - 1.5e6 * fine.z) < 1e-6);
        CHECK(std::abs(force - (1.5e6 * fine.z + s1 * (fine.z - before) / 1e-3 + 15 * v)) < 1e-6);
    }
}
TEST_CASE("lugre_observer: at rest the force grows by stiffness, correction, error and time, up to breakaway") {
    lugre_observer<> block({friction, 20.0 / 1_s}, 1_ms);
    for (int k = 0; k < 10; ++k) block(0_mps, 10_um);
    CHECK(block.now().force.value() == doctest::Approx(3).epsilon(1e-12)); // 1.5e6 20 10e-6 0.01
    for (int k = 0; k < 1000; ++k) block(0_mps, 10_um);
    CHECK(block(0_mps, 10_um).value() == doctest::Approx(12).epsilon(1e-12));
    for (int k = 0; k < 1000; ++k) block(0_mps, -10_um);
    CHECK(block(0_mps, -10_um).value() == doctest::Approx(-12).epsilon(1e-12));
}
TEST_CASE("lugre_observer: without error it is the lugre friction of the same speed") {
    lugre_observer<> block({friction, 20.0 / 1_s}, 1_ms);
    lugre<> model(friction, 1_ms);
    for (int k = 0; k < 500; ++k) {
        const auto v = 8_mmps * std::sin(0.03 * k);
        CHECK(block(v).value() == doctest::Approx(model(v).value()).epsilon(1e-9));
    }
}
TEST_CASE("lugre_observer: refuses a correction below 0, and what lugre refuses") {
    const auto message = [](const lugre_observer<>::parameters& p) -> std::string {
        try {
            lugre_observer<>{p, 1_ms};
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return {};
    };
    CHECK(message({friction, -1.0 / 1_s}) ==
          "lugre_observer.correction = -1 per s: must be finite and not below 0");
    auto bare = friction;
    bare.stiffness = {};
    CHECK(message({bare, 1.0 / 1_s}) == "lugre.stiffness = 0 N/m: must be finite and above 0");
}
