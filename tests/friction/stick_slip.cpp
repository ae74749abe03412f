// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
// One implicit step of a mass on friction, over random axes: from 0.1 to 1000 kg, sub-steps from 1 us to 1 ms.
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/asymmetric_stribeck.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/stick_slip.hpp>
#include <quadrant/friction/stribeck.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using velocity = quantity_of<signal::velocity>;
using force = quantity_of<signal::force>;
const auto Ts = 500_us;

/// A law whose level drops at once when the axis moves: the extreme of what the concept allows.
struct dropping {
    double held, sliding, slope;
    force breakaway() const { return force::from_value(held); }
    force slip(velocity) const { return force::from_value(sliding); }
    gain_of<signal::force, signal::velocity> viscous() const {
        return gain_of<signal::force, signal::velocity>::from_value(slope);
    }
};
static_assert(friction_law<dropping, double>);
struct no_law {
    force breakaway() const { return {}; }
};
static_assert(!friction_law<no_law, double>);
static_assert(!friction_law<coulomb_viscous<signal::velocity, signal::voltage>, double>); // volts hold no axis

class dice {
public:
    double operator()(double low, double high) { return low + (high - low) * next(); }
    double decades(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
    bool often() { return next() < 0.7; }

private:
    double next() {
        x_ = x_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(x_ >> 11) * 0x1p-53;
    }
    std::uint64_t x_ = 20080615;
};

struct situation {
    double mass, v, drive, h;
    template <class Law> double step(const Law& law) const {
        return stick_slip<double>(law, quantity<si::mass>::from_value(mass), velocity::from_value(v),
                                  force::from_value(drive), duration::from_value(h))
            .value();
    }
};
template <class Law> double hold(const Law& law) { return law.breakaway().value(); }
template <class Law> double slip(const Law& law, double v) { return law.slip(velocity::from_value(v)).value(); }
template <class Law> double slope(const Law& law, const situation& s) {
    return s.mass / s.h + law.viscous().value();
}
double push(const situation& s) { return s.mass * s.v / s.h + s.drive; }
/// Rounding of the forces that meet in a step.
template <class Law> double rounding(const Law& law, const situation& s) {
    return 1e-13 * (std::abs(s.mass * s.v / s.h) + std::abs(s.drive) + hold(law));
}

/// Calls f(law, situation) for 20000 axes of each kind; drives and momenta lie around what friction can hold.
template <class F> void random_axes(F&& f) {
    dice roll;
    for (int n = 0; n < 20000; ++n) {
        const double mass = roll.decades(0.1, 1000), h = roll.decades(1e-6, 1e-3), level = roll.decades(1, 300);
        const double more = level * roll(0, 2), viscous = roll.often() ? roll.decades(1, 2000) : 0;
        situation s{mass, 0, 0, h};
        if (roll.often()) s.v = roll(-3, 3) * (roll.often() ? level * h / mass : 1e-2);
        if (roll.often()) s.drive = roll(-2, 2) * (level + more);
        const auto level_q = force::from_value(level), held_q = force::from_value(level + more);
        const auto viscous_q = gain_of<signal::force, signal::velocity>::from_value(viscous);
        f(coulomb_viscous<>{{level_q, viscous_q}, Ts}, s);
        f(dropping{level + more, level, viscous}, s);
        const auto vs = velocity::from_value(roll.decades(1e-4, 1e-2));
        f(stribeck<>{{level_q, held_q, vs, viscous_q, 1}, Ts}, s);
        f(stribeck<>{{level_q, held_q, vs, viscous_q, roll(0.25, 4)}, Ts}, s);
    }
}
} // namespace

TEST_CASE("stick_slip: friction on a moving axis is the slip force of its new velocity, against the motion") {
    // To 1e-6 of the level where the law falls less than half as fast as inertia resists, on the way and at its
    // end.
    int moving = 0, steep = 0;
    random_axes([&](const auto& law, const situation& s) {
        const double v = std::abs(s.step(law));
        if (v == 0) return;
        const double free = std::abs(push(s)) / slope(law, s), friction = (free - v) * slope(law, s);
        CHECK(s.step(law) * push(s) > 0);
        CHECK(friction >= slip(law, free) - rounding(law, s));
        CHECK(friction <= slip(law, v) + rounding(law, s)); // never more than the law
        double fall = 0;
        for (int i = 0; i < 50; ++i) {
            const double at = v * std::pow(free / v, i / 50.0), next = v * std::pow(free / v, (i + 1) / 50.0);
            if (next > at) fall = std::max(fall, (slip(law, at) - slip(law, next)) / (next - at));
        }
        if (fall < 0.5 * slope(law, s)) {
            ++moving;
            CHECK(slip(law, v) - friction <= 1e-6 * hold(law) + rounding(law, s));
        } else
            ++steep;
    });
    CHECK(moving > 20000);
    CHECK(steep > 100); // the others may stop short where two solutions meet
}
TEST_CASE("stick_slip: an axis that stands after the step could be held by the breakaway force") {
    int stood = 0;
    random_axes([&](const auto& law, const situation& s) {
        if (s.step(law) != 0) return;
        ++stood;
        CHECK(std::abs(push(s)) <= hold(law) + rounding(law, s));
    });
    CHECK(stood > 10000);
}
TEST_CASE(
    "stick_slip: a resting axis moves if and only if the drive exceeds breakaway, and then with the drive") {
    random_axes([](const auto& law, situation s) {
        s.v = 0;
        const double v = s.step(law);
        CHECK((v != 0) == (std::abs(s.drive) > hold(law)));
        CHECK(v * s.drive >= 0);
        s.drive = hold(law);
        CHECK(s.step(law) == 0);
        s.drive = -hold(law);
        CHECK(s.step(law) == 0);
        s.drive = 1.0001 * hold(law);
        CHECK(s.step(law) > 0);
    });
}
TEST_CASE("stick_slip: friction alone never reverses and never speeds up an axis") {
    random_axes([](const auto& law, situation s) {
        s.drive = 0;
        const double v = s.step(law);
        CHECK(v * s.v >= 0);
        CHECK((s.v == 0 ? v == 0 : std::abs(v) < std::abs(s.v)));
    });
}
TEST_CASE("stick_slip: the axis never gains more energy than the drive gives") {
    // M/2 (v'^2 - v^2) <= drive v' h: the implicit step dissipates M/2 (v' - v)^2 on top of what friction does.
    random_axes([](const auto& law, const situation& s) {
        const double v = s.step(law), gained = 0.5 * s.mass * (v - s.v) * (v + s.v);
        CHECK(gained <= s.drive * v * s.h + 1e-12 * s.mass * (v * v + s.v * s.v));
    });
}
TEST_CASE("stick_slip: an axis is driven through rest only by more than its momentum and breakaway together") {
    int reversed = 0, stopped = 0;
    random_axes([&](const auto& law, const situation& s) {
        if (s.v * s.drive >= 0) return;
        const double v = s.step(law);
        const double left =
            std::abs(s.drive) - s.mass * std::abs(s.v) / s.h; // of the drive, after stopping the mass
        if (v * s.v < 0) {
            ++reversed;
            CHECK(left >= hold(law) - rounding(law, s));
        } else if (v == 0)
            ++stopped;
    });
    CHECK(reversed > 1000);
    CHECK(stopped > 1000);
}
TEST_CASE("stick_slip: driven between slip and breakaway, an axis that comes to rest stays there") {
    const dropping law{177, 122, 0};
    // 150 N forwards, coming backwards at 1 um/s: 6.8 N s/h of momentum at 50 us. Alone, 150 N could not start
    // it.
    CHECK(situation{340, -1e-6, 150, 50e-6}.step(law) == 0);
    CHECK(situation{340, 0, 150, 50e-6}.step(law) == 0);
    CHECK(situation{340, 1e-6, 150, 50e-6}.step(law) > 1e-6); // an axis that slides is not held
    CHECK(situation{340, 1e-6, -150, 50e-6}.step(law) == 0);
    CHECK(situation{340, -1e-6, 185, 50e-6}.step(law) > 0); // 185 - 6.8 > 177
}
TEST_CASE("stick_slip: stops an axis within the step if slip can, at most a step early or late") {
    const dropping law{177, 122, 0};
    const double most = 122 * 50e-6 / 340; // what slip takes off in a step: 17.9 um/s
    CHECK(situation{340, 0.999 * most, 0, 50e-6}.step(law) == 0);
    CHECK(situation{340, 1.001 * most, 0, 50e-6}.step(law) ==
          doctest::Approx(0.001 * most).epsilon(1e-6).scale(0));
}
TEST_CASE("stick_slip: the new velocity never falls when the axis is faster or pushed harder") {
    random_axes([](const auto& law, const situation& s) {
        const double v = s.step(law),
                     little = 1e-9 * (std::abs(v) + std::abs(s.v)); // where the passes stop short
        situation pushed = s;
        pushed.drive += 0.01 * hold(law);
        CHECK(pushed.step(law) >= v - little);
        if (s.v == 0) return; // from rest to moving the level may drop, but never rise
        situation faster = s;
        faster.v += 0.01 * std::abs(s.v);
        CHECK(faster.step(law) >= v - little);
    });
}
TEST_CASE("stick_slip: odd in velocity and drive, bit for bit") {
    random_axes([](const auto& law, const situation& s) {
        const situation mirrored{s.mass, -s.v, -s.drive, s.h};
        CHECK(mirrored.step(law) == -s.step(law));
    });
}
TEST_CASE("stick_slip: the new velocity is the fastest solution of the implicit equation, found by bisection") {
    // slope v' + slip(v') - |push|: from the frictionless velocity down, in steps of 1/2000, then bisected.
    // 1e-6 of it.
    int found = 0;
    random_axes([&](const auto& law, const situation& s) {
        const double p = push(s), k = slope(law, s), size = std::abs(p);
        if (s.v * p <= 0 || ++found % 40 != 0) return;
        const auto excess = [&](double v) { return k * v + slip(law, v) - size; };
        double high = size / k, low = high;
        while (low > 0 && excess(low) >= 0) {
            high = low;
            low -= size / k / 2000;
        }
        if (low <= 0 && excess(0) >= 0) {
            // No solution on the way: stands, but for a touch that the grid missed.
            const double v = std::abs(s.step(law));
            CHECK((v == 0 || excess(v) < 1e-3 * hold(law)));
            return;
        }
        low = std::max(low, 0.0);
        for (int i = 0; i < 100; ++i) (excess((low + high) / 2) >= 0 ? high : low) = (low + high) / 2;
        const double fall = (slip(law, 0.999 * low) - slip(law, 1.001 * low)) / (0.002 * low);
        if (fall < 0.5 * k) CHECK(std::abs(s.step(law)) == doctest::Approx(low).epsilon(1e-6).scale(0));
    });
    CHECK(found > 20000);
}
TEST_CASE(
    "stick_slip: a light axis that slides on a steeply falling law goes on, though breakaway would hold it") {
    // 50 g at 10 mm/s, 1 ms: momentum 0.5 N, drive 6 N, friction 10 N at rest and 5 N beyond 1 mm/s.
    const stribeck<> law{{5_N, 10_N, 1_mmps, {}}, Ts};
    CHECK(situation{0.05, 10e-3, 6, 1e-3}.step(law) ==
          doctest::Approx(30e-3).epsilon(1e-3).scale(0)); // (0.5 + 6 - 5) h / M
    CHECK(situation{0.05, 0, 6, 1e-3}.step(law) == 0);
    CHECK(situation{0.05, 10e-3, 4, 1e-3}.step(law) == 0); // below the lowest friction
}
TEST_CASE("stick_slip: coasting on stribeck friction follows a fine Runge-Kutta solution, with the error "
          "halving with h") {
    const stribeck<> law{{122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps}, Ts};
    const double mass = 340, v0 = 20e-3, t = 0.04; // stops after 0.05 s
    const auto acceleration = [&](double v) { return -(slip(law, v) + 950 * v) / mass; };
    double exact = v0;
    const int fine = 4000;
    for (int k = 0; k < fine; ++k) {
        const double h = t / fine, a = acceleration(exact), b = acceleration(exact + h / 2 * a),
                     c = acceleration(exact + h / 2 * b), d = acceleration(exact + h * c);
        exact += h / 6 * (a + 2 * b + 2 * c + d);
    }
    REQUIRE(exact > 2e-3);
    const auto error = [&](int steps) {
        double v = v0;
        for (int k = 0; k < steps; ++k) v = situation{mass, v, 0, t / steps}.step(law);
        return std::abs(v - exact);
    };
    CHECK(error(80) < 5e-6); // 5 um/s at a servo period of 500 us
    CHECK(error(80) / error(160) == doctest::Approx(2).epsilon(0.05));
    CHECK(error(160) / error(320) == doctest::Approx(2).epsilon(0.05));
}
TEST_CASE("stick_slip: in float as in double, to a part in 1e5 of the velocities") {
    const stribeck<signal::velocity, signal::force, float> rough{{122_N, 177_N, 2.2_mmps, 950_N / 1_mps}, Ts};
    const stribeck<> exact{{122_N, 177_N, 2.2_mmps, 950_N / 1_mps}, Ts};
    dice roll;
    for (int n = 0; n < 1000; ++n) {
        const float v = static_cast<float>(roll(-5e-3, 5e-3)), drive = static_cast<float>(roll(-400, 400));
        const situation s{340, static_cast<double>(v), static_cast<double>(drive), 50e-6};
        const float rounded = stick_slip<float>(rough, quantity<si::mass, float>::from_value(340),
                                                quantity_of<signal::velocity, float>::from_value(v),
                                                quantity_of<signal::force, float>::from_value(drive),
                                                quantity<si::time, float>::from_value(50e-6f))
                                  .value();
        CHECK(std::abs(static_cast<double>(rounded) - s.step(exact)) <= 1e-5 * 5e-3);
    }
}
TEST_CASE(
    "stick_slip: with duals the derivatives of a step are those of difference quotients, zero when it stands") {
    using D = dual<4>; // by mass, velocity, drive, static level
    const auto step = [](auto mass, auto v, auto drive, auto level) {
        using Real = decltype(mass);
        using law = stribeck<signal::velocity, signal::force, Real>;
        typename law::parameters p;
        p.coulomb = decltype(p.coulomb)::from_value(Real(122));
        p.static_level = decltype(p.static_level)::from_value(level);
        p.stribeck_velocity = decltype(p.stribeck_velocity)::from_value(Real(2.2e-3));
        p.viscous = decltype(p.viscous)::from_value(Real(950));
        return stick_slip<Real>(law{p, Ts}, quantity<si::mass, Real>::from_value(mass),
                                quantity_of<signal::velocity, Real>::from_value(v),
                                quantity_of<signal::force, Real>::from_value(drive),
                                quantity<si::time, Real>::from_value(Real(500e-6)))
            .value();
    };
    for (const double v : {-3e-3, 1e-3, 4e-3}) {
        const D y = step(D::variable(340, 0), D::variable(v, 1), D::variable(50, 2), D::variable(177, 3));
        REQUIRE(y.value != 0);
        const double e = 1e-6;
        const auto quotient = [](double up, double down, double width) { return (up - down) / width; };
        CHECK(y.partial[0] == doctest::Approx(quotient(step(340 + 340 * e, v, 50.0, 177.0),
                                                       step(340 - 340 * e, v, 50.0, 177.0), 680 * e))
                                  .epsilon(1e-6)
                                  .scale(0));
        CHECK(y.partial[1] == doctest::Approx(quotient(step(340.0, v + v * e, 50.0, 177.0),
                                                       step(340.0, v - v * e, 50.0, 177.0), 2 * v * e))
                                  .epsilon(1e-6)
                                  .scale(0));
        CHECK(y.partial[2] == doctest::Approx(quotient(step(340.0, v, 50 + 50 * e, 177.0),
                                                       step(340.0, v, 50 - 50 * e, 177.0), 100 * e))
                                  .epsilon(1e-6)
                                  .scale(0));
        CHECK(y.partial[3] == doctest::Approx(quotient(step(340.0, v, 50.0, 177 + 177 * e),
                                                       step(340.0, v, 50.0, 177 - 177 * e), 354 * e))
                                  .epsilon(1e-6)
                                  .scale(0));
    }
    const D stands = step(D::variable(340, 0), D::variable(0, 1), D::variable(50, 2), D::variable(177, 3));
    CHECK(stands.value == 0);
    CHECK(stands.partial == std::array{0.0, 0.0, 0.0, 0.0});
}

namespace {
using two_sided = asymmetric_stribeck<signal::velocity, signal::force>;
static_assert(friction_law_by_direction<two_sided, double>);
static_assert(!friction_law<two_sided, double> && !friction_law_by_direction<stribeck<>, double>);

two_sided::side side(double held, double level, double fall, double rise) {
    return {force::from_value(held), force::from_value(level), velocity::from_value(fall),
            velocity::from_value(rise)};
}
two_sided::side any_side(dice& roll) {
    return side(roll.decades(1, 300), roll.decades(1, 300), roll.decades(1e-4, 1e-2), roll.decades(1e-4, 1e-2));
}
const two_sided::side& toward(const two_sided& law, double direction) {
    return direction < 0 ? law.given().backward : law.given().forward;
}
} // namespace

TEST_CASE(
    "stick_slip by direction: stands if and only if breakaway of that side or no speed can carry the push, "
    "else takes the fastest speed that solves the step") {
    dice roll;
    int moving = 0, steep = 0, stood = 0;
    for (int n = 0; n < 100'000; ++n) {
        const auto viscous = gain_of<signal::force, signal::velocity>::from_value(roll.often() ? 850 : 0);
        const two_sided law({any_side(roll), any_side(roll), viscous}, Ts);
        situation s{roll.decades(0.1, 1000), 0, 0, roll.decades(1e-6, 1e-3)};
        if (roll.often()) s.v = roll(-3, 3) * (roll.often() ? 100 * s.h / s.mass : 1e-2);
        if (roll.often()) s.drive = roll(-600, 600);
        const double p = push(s), k = slope(law, s), v = s.step(law), v_along = p < 0 ? -v : v;
        const double held = toward(law, p).static_level.value();
        const double small = 1e-11 * (std::abs(p) + held + toward(law, p).coulomb.value());
        const auto excess = [&](double speed) { // of what speed needs over the push
            return k * speed + slip(law, p < 0 ? -speed : speed) - std::abs(p);
        };
        REQUIRE(v_along >= 0);
        if (v != 0) {
            ++moving;
            REQUIRE(excess(v_along) >= -small); // friction is never more than the law
            const auto at = law.parts(p > 0, velocity::from_value(v_along));
            if (-at.falling_slope.value() < 0.5 * k)
                REQUIRE(excess(v_along) <= small);
            else
                ++steep; // where two solutions are about to meet the step may stop short of them
        } else if (s.v * p > 0 || std::abs(p) > held)
            ++stood;
        else
            continue;                   // held by breakaway
        for (int i = 1; i <= 30; ++i) { // none is faster
            const double faster = v_along + (std::abs(p) / k - v_along) * i / 30;
            if (faster > v_along) REQUIRE(excess(faster) >= -small);
        }
    }
    CHECK(moving > 30'000);
    CHECK(steep < moving / 2);
    CHECK(stood > 1000);
}
TEST_CASE(
    "stick_slip by direction: with both sides alike and as wide a rise as fall it is the step on stribeck") {
    dice roll;
    for (int n = 0; n < 50'000; ++n) {
        const double level = roll.decades(1, 300), held = level * roll(1, 3), scale = roll.decades(1e-3, 1e-2);
        const auto both = side(held, level, scale, scale);
        const two_sided law({both, both, {}}, Ts);
        const stribeck<> even{{force::from_value(level), force::from_value(held), velocity::from_value(scale)},
                              Ts};
        situation s{roll.decades(100, 1000), roll(-1e-2, 1e-2), roll(-2, 2) * held, roll.decades(1e-6, 1e-4)};
        if (roll.often()) s.v = 0;
        REQUIRE(std::abs(s.step(law) - s.step(even)) <=
                1e-10 * (std::abs(s.v) + std::abs(push(s)) / slope(law, s)));
    }
}
TEST_CASE("stick_slip by direction: a dual carries the derivative by mass and by either level") {
    const auto step = [](auto mass, auto held, auto level) {
        using Real = decltype(mass);
        using law = asymmetric_stribeck<signal::velocity, signal::force, Real>;
        typename law::side one{quantity_of<signal::force, Real>::from_value(held),
                               quantity_of<signal::force, Real>::from_value(level),
                               quantity_of<signal::velocity, Real>::from_value(Real(2e-3)),
                               quantity_of<signal::velocity, Real>::from_value(Real(5e-3))};
        return stick_slip<Real>(law({one, one, {}}, Ts), quantity<si::mass, Real>::from_value(mass),
                                quantity_of<signal::velocity, Real>::from_value(Real(4e-3)),
                                quantity_of<signal::force, Real>::from_value(Real(200)),
                                quantity<si::time, Real>::from_value(Real(1e-4)))
            .value();
    };
    using d = dual<3>;
    const d v = step(d::variable(20, 0), d::variable(150, 1), d::variable(110, 2));
    const auto by = [&](double m, double held, double level) {
        return (step(20 + m, 150 + held, 110 + level) - step(20 - m, 150 - held, 110 - level));
    };
    CHECK(v.partial[0] == doctest::Approx(by(1e-3, 0, 0) / 2e-3).epsilon(1e-6));
    CHECK(v.partial[1] == doctest::Approx(by(0, 1e-2, 0) / 2e-2).epsilon(1e-6));
    CHECK(v.partial[2] == doctest::Approx(by(0, 0, 1e-2) / 2e-2).epsilon(1e-6));
}
