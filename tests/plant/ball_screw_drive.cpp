// SPDX-License-Identifier: BSL-1.0
// Long: one machine: the drive, its friction, its play.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/backlash.hpp>
#include <quadrant/plant/ball_screw_drive.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using drive = ball_screw_drive<>;
const duration Ts = 1_ms;
/// The x axis of [Yeung2006].
constexpr double J = 0.0077736, B = 0.019811, Kt = 0.4769, rg = 0.01 / (2 * std::numbers::pi);
constexpr double static_forward = 2.6256, static_backward = 1.8672;

asymmetric_stribeck<>::parameters printed_friction() {
    return {{static_forward * 1_Nm, 2.1529_Nm, 3.88_radps, 4.20_radps},
            {static_backward * 1_Nm, 1.4730_Nm, 3.51_radps, 3.52_radps},
            {}};
}
asymmetric_stribeck<>::parameters level(double torque) { // the same at every speed
    const asymmetric_stribeck<>::side s{torque * 1_Nm, torque * 1_Nm, 1_radps, 1_radps};
    return {s, s, {}};
}
drive::parameters with(const asymmetric_stribeck<>::parameters& friction, std::size_t substeps = 4,
                       double viscous = B) {
    return {.inertia = J * 1_kgm2,
            .viscous = viscous * 1_Nm / 1_radps,
            .torque_constant = Kt * 1_Nm / 1_A,
            .pitch = 10_mm,
            .friction = friction,
            .substeps = substeps};
}
auto amperes(double i) { return quantity<si::current>::from_value(i); }
auto newtons(double f) { return quantity<si::force>::from_value(f); }
/// w of the drive.
double speed(const drive& d) { return d.now().v.value() / rg; }
bool near(double a, double b, double share) { return std::abs(a - b) <= share * std::abs(b); }
} // namespace

TEST_CASE("ball_screw_drive: 1 A on the x axis of [Yeung2006], frictionless: 48.78 nm after 1 ms") {
    drive d{with(level(0)), Ts};
    CHECK(std::abs(d(1_A).value() - 48.78e-9) < 0.01e-9); // rg Kt t^2 / 2 J = 48.82 nm, less 0.1 % by B
}
TEST_CASE("ball_screw_drive: without dry friction every sample is the exponential, whatever the substeps") {
    for (const double viscous : {B, 5.0, 0.0}) // 5: the motor's time constant is one and a half periods
        for (const std::size_t substeps : {1u, 3u, 10u}) {
            drive d{with(level(0), substeps, viscous), Ts};
            for (int k = 1; k <= 300; ++k) {
                const double x = d(2_A).value(), t = 1e-3 * k, torque = 2 * Kt;
                if (viscous == 0) {
                    CHECK(near(speed(d), torque * t / J, 1e-12));
                    CHECK(near(x, rg * torque * t * t / (2 * J), 1e-12));
                } else {
                    const double rise = -std::expm1(-viscous * t / J);
                    CHECK(near(speed(d), torque / viscous * rise, 1e-12));
                    CHECK(near(x, rg * torque / viscous * (t - J / viscous * rise),
                               1e-9)); // the formula loses digits
                }
            }
        }
}
TEST_CASE("ball_screw_drive: its model is what it does at low speed of change: gain and damping") {
    drive d{with(level(0)), Ts};
    const auto m = d.model();
    for (int k = 0; k < 5000; ++k) d(1_A); // 13 time constants
    CHECK(near(d.now().v.value(), m.gain.value() / m.viscous_rate.value(), 1e-5));
    CHECK(near(m.viscous_rate.value(), 2.5485, 1e-4)); // B/J
}
TEST_CASE("ball_screw_drive: sticks by one level forward and another backward, and a push on the table counts "
          "by its lever") {
    for (const double share : {0.999, 1.001}) {
        const bool goes = share > 1;
        drive d{with(printed_friction()), Ts};
        d(amperes(share * static_forward / Kt));
        CHECK((d.now().v > 0_mps) == goes);
        CHECK((d.now().x != 0_m) == goes);
        d.reset();
        d(amperes(-share * static_backward / Kt));
        CHECK((d.now().v < 0_mps) == goes);
        CHECK((d.now().x != 0_m) == goes);
        d.reset();
        d(0_A, newtons(-share * static_backward / rg)); // 1173 N hold the table
        CHECK((d.now().v < 0_mps) == goes);
    }
}
TEST_CASE("ball_screw_drive: coasts to rest when and where the closed form says, and stays") {
    // J w' = -B w - Tc: rests after (J/B) ln(1 + B w0/Tc), having turned (J/B)(w0 - (Tc/B) ln(1 + B w0/Tc))
    const double Tc = 2.0;
    drive d{with(level(Tc)), Ts};
    for (int k = 0; k < 200; ++k) d(10_A);
    const double w0 = speed(d), x0 = d.now().x.value(), log = std::log1p(B * w0 / Tc);
    REQUIRE(w0 > 50);
    int samples = 0;
    for (; d.now().v > 0_mps; ++samples) d(0_A);
    CHECK(std::abs(samples * 1e-3 - J / B * log) <= 1e-3);
    CHECK(std::abs(d.now().x.value() - x0 - rg * J / B * (w0 - Tc / B * log)) < 1e-9);
    const auto rests = d.now().x;
    for (int k = 0; k < 100; ++k) d(amperes(0.999 * Tc / Kt * (k % 2 == 0 ? 1 : -1)));
    CHECK(d.now().x == rests);
    CHECK(d.now().v == 0_mps);
}
TEST_CASE("ball_screw_drive: through a reversal it stops once, then leaves to the other side") {
    drive d{with(printed_friction(), 10), Ts};
    for (int k = 0; k < 50; ++k) d(8_A);
    REQUIRE(d.now().v > 0_mps);
    int changes = 0;
    double before = speed(d);
    for (int k = 0; k < 200; ++k) {
        d(amperes(-8));
        changes += (before > 0) != (speed(d) > 0);
        CHECK(speed(d) < before); // brakes all the way
        before = speed(d);
    }
    CHECK(changes == 1);
    CHECK(d.now().v < 0_mps);
}
TEST_CASE(
    "ball_screw_drive: ten reversals in a second and 4 mm of travel, no loop closed: right to 1.2 um with 4 "
    "sub-steps, 0.15 um with 40") {
    // Reference: classical Runge-Kutta at 1 us between stops, its own law, the stop found by halving the last
    // step.
    const auto torque = [](double t) {
        return 4.5 * std::sin(2 * std::numbers::pi * 5 * std::floor(t / 1e-3 + 1e-6) * 1e-3);
    };
    const auto slip = [](double w) {
        return w > 0 ? static_forward * std::exp(-w / 3.88) + 2.1529 * (1 - std::exp(-w / 4.20))
                     : -(static_backward * std::exp(w / 3.51) + 1.4730 * (1 - std::exp(w / 3.52)));
    };
    double angle = 0, w = 0;
    const double h = 2e-6;
    const int steps_of_sample = 500;
    drive coarse{with(printed_friction(), 4), Ts}, fine{with(printed_friction(), 40), Ts};
    double off_coarse = 0, off_fine = 0, most = 0;
    for (int k = 0; k < 1000; ++k) {
        const double T = torque(1e-3 * k);
        for (int n = 0; n < steps_of_sample; ++n) {
            if (w == 0) {
                if (T <= static_forward && T >= -static_backward) continue;
                w = 1e-12 * (T > 0 ? 1 : -1); // leaves to that side
            }
            const double side = w > 0 ? 1 : -1;
            const auto rate = [&](double v) {
                return (T - B * v - (side * v >= 0 ? slip(v == 0 ? side * 1e-300 : v) : slip(side * 1e-300))) /
                       J;
            };
            const double k1 = rate(w), k2 = rate(w + h / 2 * k1), k3 = rate(w + h / 2 * k2),
                         k4 = rate(w + h * k3);
            const double next = w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
            if (next * side <= 0) {
                angle += w * h / 2 * (w / (w - next));
                w = 0;
            } else {
                angle += h / 2 * (w + next);
                w = next;
            }
        }
        coarse(amperes(T / Kt)), fine(amperes(T / Kt));
        off_coarse = std::max(off_coarse, std::abs(coarse.now().x.value() - rg * angle));
        off_fine = std::max(off_fine, std::abs(fine.now().x.value() - rg * angle));
        most = std::max(most, std::abs(rg * angle));
    }
    CHECK(most > 4e-3);
    CHECK(off_coarse < 1.2e-6);
    CHECK(off_fine < 0.15e-6);
}
TEST_CASE("ball_screw_drive: on a stribeck as on the asymmetric law of the same levels") {
    using symmetrical = ball_screw_drive<stribeck<signal::angular_velocity, signal::torque>>;
    const asymmetric_stribeck<>::side s{2.6_Nm, 2.1_Nm, 4_radps, 4_radps};
    drive a{with({s, s, {}}), Ts};
    symmetrical b{{.inertia = J * 1_kgm2,
                   .viscous = B * 1_Nm / 1_radps,
                   .torque_constant = Kt * 1_Nm / 1_A,
                   .pitch = 10_mm,
                   .friction = {2.1_Nm, 2.6_Nm, 4_radps}},
                  Ts};
    for (int k = 0; k < 500; ++k) {
        const double i = 7 * std::sin(0.03 * k);
        a(amperes(i)), b(amperes(i));
        CHECK(std::abs((a.now().x - b.now().x).value()) < 1e-15);
    }
    CHECK(std::abs(a.now().x.value()) > 1e-4);
}
TEST_CASE("ball_screw_drive: refuses what no drive has, by name") {
    const auto says = [](const drive::parameters& p, const char* words) {
        try {
            drive{p, Ts};
        } catch (const invalid_parameter& e) {
            return std::string(e.what()).find(words) == 0;
        }
        return false;
    };
    auto p = with(printed_friction());
    p.inertia = 0_kgm2;
    CHECK(says(p, "ball_screw_drive.inertia = 0 kg m^2: must be finite and above 0"));
    p = with(printed_friction());
    p.substeps = 0;
    CHECK(says(p, "ball_screw_drive.substeps = 0: must lie between 1 and 1000"));
    p = with(printed_friction());
    p.friction.backward.rise = 0_radps;
    CHECK(says(p, "asymmetric_stribeck.backward.rise = 0 rad/s: must be finite and above 0"));
    p = with(printed_friction());
    p.pitch = -10_mm;
    CHECK(says(p, "ball_screw_drive.pitch = -0.01 m: must be finite and above 0"));
}

TEST_CASE("viscous_step: is the closed form, to 1e-14 on either side of where its series ends, and a parabola "
          "without damping") {
    for (const double A : {1e-9, 1e-3, 1.0, 400.0, 499.9, 500.1, 3000.0}) {
        const double h = 1e-3;
        const viscous_step<> s(A, h);
        // Two halves make a whole: v and x after h/2 twice, by the same rule at half the argument.
        const viscous_step<> half(A, h / 2);
        CHECK(near(half.kept * half.kept, s.kept, 1e-14));
        CHECK(near(half.gained + half.kept * half.gained, s.gained, 1e-14));
        CHECK(near(2 * half.way + half.gained * half.gained, s.way, 1e-14));
        CHECK(near(std::exp(-A * h), s.kept, 1e-14));
        CHECK(near(-std::expm1(-A * h) / A, s.gained, 1e-14));
    }
    CHECK(viscous_step<>(0, 2).way == 2);
    CHECK(viscous_step<>(0, 2).gained == 2);
    CHECK(viscous_step<>(0, 2).kept == 1);
}

TEST_CASE("asymmetric_stribeck: the x axis forward: 2.6256 N m at rest, 2.311 at 3 rad/s, Coulomb at 100; "
          "backward by its own levels") {
    asymmetric_stribeck<> f{printed_friction(), Ts};
    CHECK(f.breakaway(true) == static_forward * 1_Nm);
    CHECK(f.breakaway(false) == static_backward * 1_Nm);
    // 2.6256 e^(-3/3.88) + 2.1529 (1 - e^(-3/4.2)) = 1.2117 + 1.0990 by hand
    CHECK(std::abs(f(3_radps).value() - 2.3107) < 2e-4);
    CHECK(near(f(100_radps).value(), 2.1529, 1e-9));
    CHECK(near(f(quantity<si::angular_velocity>::from_value(-100)).value(), -1.4730, 1e-9));
    CHECK(f(0_radps) == 0_Nm);
}

TEST_CASE("backlash: is the dead zone [d-, d+] of eq. (17), which the drive drags") {
    backlash<> b{{3_um}, Ts};
    double low = -1.5e-6, high = 1.5e-6, y = 0;
    unsigned n = 1;
    for (int k = 0; k < 2000; ++k) {
        n = n * 1664525u + 1013904223u;
        const double x = 1e-5 * (n >> 16) / 65536.0 - 5e-6;
        if (x > high) high = x, low = x - 3e-6, y = x - 1.5e-6; // the front flank drags
        if (x < low) low = x, high = x + 3e-6, y = x + 1.5e-6;
        CHECK(std::abs(b(x * 1_m).value() - y) < 1e-18);
    }
}
TEST_CASE(
    "backlash: 3 um: after a reversal the table waits for 3 um of the drive; without width it never waits") {
    backlash<> b{{3_um}, Ts}, none{{}, Ts};
    CHECK(std::abs((b(10_um) - 8.5_um).value()) < 1e-18);
    const auto before = b(10_um);
    CHECK(b(7.01_um) == before);
    CHECK(std::abs((b(6_um) - 7.5_um).value()) < 1e-18);
    for (const auto& x : {10_um, 7.01_um, 6_um}) CHECK(none(x) == x);
}

namespace {
// Each law with a memory on the screw, and the same in newtons and metres on a table without a screw.
using rotary = signal::angular_velocity;
auto nm(double t) { return quantity_of<signal::torque>::from_value(t); }
auto radps(double w) { return quantity_of<rotary>::from_value(w); }
auto nm_per_rad(double k) { return gain_rate_of<signal::torque, rotary>::from_value(k); }
auto n_per_m(double k) { return gain_rate_of<signal::force, signal::velocity>::from_value(k); }
auto mps(double v) { return quantity<si::velocity>::from_value(v); }

struct with_dahl {
    using screw = dahl<rotary, signal::torque>;
    using table = dahl<>;
    static screw::parameters on_screw() { return {.coulomb = nm(2.1), .stiffness = nm_per_rad(900)}; }
    static table::parameters on_table() {
        return {.coulomb = newtons(2.1 / rg), .stiffness = n_per_m(900 / rg / rg)};
    }
};
struct with_lugre {
    using screw = lugre<rotary, signal::torque>;
    using table = lugre<>;
    static screw::parameters on_screw() {
        return {.curve = {.coulomb = nm(1.5),
                          .static_level = nm(2.4),
                          .stribeck_velocity = radps(3.5),
                          .viscous = {}},
                .stiffness = nm_per_rad(600)};
    }
    static table::parameters on_table() {
        return {.curve = {.coulomb = newtons(1.5 / rg),
                          .static_level = newtons(2.4 / rg),
                          .stribeck_velocity = mps(3.5 * rg),
                          .viscous = {}},
                .stiffness = n_per_m(600 / rg / rg)};
    }
};
struct with_springs {
    using screw = maxwell_slip<3, rotary, signal::torque>;
    using table = maxwell_slip<3>;
    static screw::parameters on_screw() {
        screw::parameters p;
        p.curve = {.coulomb = nm(1.5), .static_level = nm(2.4), .stribeck_velocity = radps(3.5), .viscous = {}};
        p.weights = {0.5, 0.3, 0.2};
        p.stiffness = {nm_per_rad(900), nm_per_rad(300), nm_per_rad(50)};
        p.attraction = decltype(p.attraction)::from_value(20);
        return p;
    }
    static table::parameters on_table() {
        table::parameters p;
        p.curve = {.coulomb = newtons(1.5 / rg),
                   .static_level = newtons(2.4 / rg),
                   .stribeck_velocity = mps(3.5 * rg),
                   .viscous = {}};
        p.weights = {0.5, 0.3, 0.2};
        p.stiffness = {n_per_m(900 / rg / rg), n_per_m(300 / rg / rg), n_per_m(50 / rg / rg)};
        p.attraction = decltype(p.attraction)::from_value(20 / rg);
        return p;
    }
};
} // namespace

TEST_CASE_TEMPLATE(
    "ball_screw_drive: on a friction with memory it goes where a linear_motor of the same mass and law goes, "
    "to 1e-9 of the way",
    Law, with_dahl, with_lugre, with_springs) {
    using on_screw = ball_screw_drive<typename Law::screw>;
    using on_table = linear_motor<typename Law::table>;
    on_screw screw{{.inertia = J * 1_kgm2,
                    .torque_constant = Kt * 1_Nm / 1_A,
                    .pitch = 10_mm,
                    .friction = Law::on_screw(),
                    .substeps = 5},
                   Ts};
    on_table table{{.mass = quantity<si::mass>::from_value(J / rg / rg),
                    .force_constant = gain_of<signal::force, signal::voltage>::from_value(Kt / rg),
                    .friction = Law::on_table(),
                    .substeps = 5},
                   Ts};
    double furthest = 0, apart = 0;
    for (int k = 0; k < 4000; ++k) { // break-away, reversals, and a rest on bent springs
        const double i = k < 3000 ? 9 * std::sin(0.01 * k) * std::sin(0.0021 * k) : 2.0;
        const double push = 40 * std::sin(0.003 * k);
        const double a = screw(amperes(i), newtons(push)).value();
        const double b = table(quantity<si::electric_potential>::from_value(i), newtons(push)).value();
        furthest = std::max(furthest, std::abs(b));
        apart = std::max(apart, std::abs(a - b));
    }
    CHECK(furthest > 1e-3);
    CHECK(apart <= 1e-9 * furthest);
    CHECK(!screw.faulted());
}
TEST_CASE("ball_screw_drive: on springs its viscous friction brakes as that of the law does, and a lost number "
          "moves neither table nor springs") {
    using law = with_springs::screw;
    using on_springs = ball_screw_drive<law>;
    const auto with_viscous = [](double in_drive, double in_law) {
        auto friction = with_springs::on_screw();
        friction.curve.viscous = decltype(friction.curve.viscous)::from_value(in_law);
        return on_springs({.inertia = J * 1_kgm2,
                           .viscous = in_drive * 1_Nm / 1_radps,
                           .torque_constant = Kt * 1_Nm / 1_A,
                           .pitch = 10_mm,
                           .friction = friction},
                          Ts);
    };
    on_springs a = with_viscous(B, 0), b = with_viscous(0, B);
    for (int k = 0; k < 2000; ++k) {
        const auto i = amperes(10 * std::sin(0.01 * k));
        REQUIRE(near(a(i).value(), b(i).value(), 1e-9));
    }
    const auto x = a.now().x;
    const auto spring = a.friction().now().elements[0].force;
    const auto before = a(amperes(std::nan("")));
    CHECK(a.faulted());
    CHECK(before.value() == x.value());
    CHECK(a.friction().now().elements[0].force.value() == spring.value());
    CHECK(a(amperes(1e300 * 1e10)).value() == x.value());
    a.settle(1_mm);
    CHECK(!a.faulted());
    CHECK(a.friction().now().elements[0].force.value() == 0);
    // Held below breakaway by springs: it yields, stands, and comes back when it is let go.
    double there = 0;
    for (int k = 0; k < 4000; ++k) there = a(1_A).value();
    CHECK(there > 1.0001e-3);
    CHECK(std::abs(a.now().v.value()) < 1e-15); // the springs have rung down
    double back = 0;
    for (int k = 0; k < 4000; ++k) back = a(0_A).value();
    CHECK(back < there);
}
