// SPDX-License-Identifier: BSL-1.0
// No block of the plant creates energy: from rest, the work that random forces put in is at any time at least
// the kinetic energy. A force held over a step does the work force times displacement exactly, whatever the
// step.
// Springs of a friction law are stretched by the velocity at the end of a step, the position moves by the
// mean of both: beside their energy the work is counted along the path of the springs. Tolerance: a billionth
// of the work that went in and out, which is rounding.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/backlash.hpp>
#include <quadrant/plant/ball_screw_drive.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {

constexpr double rounding = 1e-9;

/// Forces that hold for 1 to 50 steps, of all sizes from a hundredth to ten times `size`, either way.
class random_force {
public:
    explicit random_force(double size) : size_(size) {}
    double operator()() {
        if (left_-- <= 0) {
            left_ = std::uniform_int_distribution<int>(0, 49)(random_);
            const double logarithm = std::uniform_real_distribution<double>(-2, 1)(random_);
            force_ = (random_() & 1 ? 1 : -1) * size_ * std::pow(10, logarithm);
        }
        return force_;
    }

private:
    double size_, force_ = 0;
    int left_ = 0;
    std::mt19937_64 random_{7};
};

/// What was put in, and the largest excess of what is there over it, as a share of all that went in and out.
class balance {
public:
    void put_in(double work) {
        in_ += work;
        all_ += std::abs(work);
    }
    void is_there(double energy) {
        if (all_ > 0) worst_ = std::max(worst_, (energy - in_) / all_);
    }
    void restart() { in_ = all_ = 0; } ///< from rest again
    double created() const { return worst_; }

private:
    double in_ = 0, all_ = 0, worst_ = 0;
};

/// By a mass on a friction law, run from rest again and again. `stored(friction)`: in the springs of the law
/// [J].
template <class Friction, class Stored = std::nullptr_t>
double created_by(const typename Friction::parameters& friction, const Stored& stored = {}) {
    constexpr bool springs = !std::same_as<Stored, std::nullptr_t>;
    using motor = linear_motor<Friction>;
    motor m({.mass = 12_kg, .force_constant = 1_N / 1_V, .friction = friction, .substeps = 1}, 500_us);
    random_force force(40);
    balance b;
    for (int k = 0; k < 100000; ++k) {
        if (k % 97 == 0) { // short runs too: what a reversal makes is not lost beside what friction has taken
            m.reset();
            b.restart();
        }
        const double f = force(), from = m.now().x.value();
        m(0_V, f * 1_N);
        const double v = m.now().v.value();
        b.put_in(f * (springs ? v * 500e-6 : m.now().x.value() - from));
        double there = 6 * v * v;
        if constexpr (springs) there += stored(m.friction());
        b.is_there(there);
    }
    CHECK_FALSE(m.faulted());
    return b.created();
}
const stribeck<>::parameters falling{40_N, 65_N, 2_mmps, 30_N / 1_mps},
    level_alone{40_N, 40_N, 2_mmps, 0_N / 1_mps};

maxwell_slip<4>::parameters springs(const stribeck<>::parameters& curve, double attraction) {
    return {.curve = curve,
            .weights = {0.4, 0.3, 0.2, 0.1},
            .stiffness = {3e7 * 1_N / 1_m, 4e6 * 1_N / 1_m, 1e6 * 1_N / 1_m, 2e5 * 1_N / 1_m},
            .attraction = attraction * 1_N / 1_s};
}
double in_springs(const maxwell_slip<4>& f) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double force = f.now().elements[i].force.value();
        sum += force * force / (2 * f.given().stiffness[i].value());
    }
    return sum;
}

} // namespace

TEST_CASE("energy: a mass on friction without memory never has more than the work that went in") {
    CHECK(created_by<coulomb_viscous<>>({40_N, 30_N / 1_mps}) <= rounding);
    CHECK(created_by<coulomb_viscous<>>({0_N, 30_N / 1_mps}) <= rounding);
    CHECK(created_by<stribeck<>>(falling) <= rounding);
}
TEST_CASE("energy: a mass on springs that slip at a constant level, their energy included") {
    for (const double attraction : {1e2, 1e4, 1e12}) {
        CAPTURE(attraction);
        CHECK(created_by<maxwell_slip<4>>(springs(level_alone, attraction), in_springs) <= rounding);
    }
    dahl<>::parameters d{.coulomb = 40_N, .stiffness = 4e6 * 1_N / 1_m, .viscous = 30_N / 1_mps};
    CHECK(created_by<dahl<>>(d, [](const dahl<>& f) {
              return f.now().force.value() * f.now().force.value() / (2 * f.given().stiffness.value());
          }) <= rounding);
}
TEST_CASE("energy: a mass on friction that falls with the speed never has more kinetic energy than the work "
          "that went in") {
    for (const double attraction : {1e2, 1e4, 1e12}) {
        CAPTURE(attraction);
        CHECK(created_by<maxwell_slip<4>>(springs(falling, attraction)) <= rounding);
    }
    lugre<>::parameters l{.curve = falling, .stiffness = 4e6 * 1_N / 1_m};
    CHECK(created_by<lugre<>>(l) <= rounding);
}
TEST_CASE("energy: a screw drive never has more than the work of motor and table force") {
    using side = asymmetric_stribeck<>::side;
    ball_screw_drive<> drive(
        {.inertia = 0.0078 * 1_kgm2,
         .viscous = 0.02 * 1_Nm / 1_radps,
         .torque_constant = 0.48_Nm / 1_A,
         .pitch = 10_mm,
         .friction = {side{2.6_Nm, 2.1_Nm, 3.9_radps, 4.2_radps}, side{1.9_Nm, 1.5_Nm, 3.5_radps, 3.5_radps}},
         .substeps = 1},
        1_ms);
    const double way = 0.01 / (2 * std::numbers::pi); // m/rad
    random_force current(5), push(1000);
    balance b;
    for (int k = 0; k < 40000; ++k) {
        const double i = current(), f = push(), from = drive.now().x.value();
        drive(i * 1_A, f * 1_N);
        b.put_in((0.48 * i / way + f) * (drive.now().x.value() - from));
        const double w = drive.now().v.value() / way;
        b.is_there(0.5 * 0.0078 * w * w);
    }
    CHECK_FALSE(drive.faulted());
    CHECK(b.created() <= rounding);
}
TEST_CASE("energy: modes shaken at the motor never have more than the work of its force") {
    constexpr double mass = 20;
    flexible_modes<2> modes({.mass = mass * 1_kg, .modes = {{{30_Hz, 0.0, 0.5}, {180_Hz, 0.02, 0.1}}}}, 500_us);
    random_force force(100);
    balance b;
    double y = 0;
    for (int k = 0; k < 40000; ++k) {
        const double f = force(), next = modes(f * 1_N).value();
        b.put_in(f * (next - y));
        y = next;
        double there = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const auto& m = modes.given().modes[i];
            const double w = 2 * std::numbers::pi * m.centre.value(), q = modes.now().deflection[i].value(),
                         speed = modes.now().speed[i].value();
            there += mass / (2 * m.share) * (speed * speed + w * w * q * q); // modal mass: mass/share
        }
        b.is_there(there);
    }
    CHECK(b.created() <= rounding);
}
TEST_CASE("energy: what is behind a play never moves further than its drive, nor against it") {
    backlash<> play({.width = 20_um}, 500_us);
    random_force way(10e-6);
    double x = 0, y = 0;
    bool passive = true;
    for (int k = 0; k < 40000; ++k) {
        const double step = way(), next = play((x += step) * 1_m).value(), moved = next - y;
        passive = passive && moved * step >= 0 && std::abs(moved) <= std::abs(step) * (1 + rounding);
        y = next;
    }
    CHECK(passive);
}
