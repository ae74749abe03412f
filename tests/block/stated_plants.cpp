// SPDX-License-Identifier: BSL-1.0
// As stated.cpp: friction solved with the mass that it brakes, drives, and the pieces of a path.
#include "dice.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/friction/asymmetric_stribeck.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/presliding.hpp>
#include <quadrant/friction/stick_slip.hpp>
#include <quadrant/path/spline.hpp>
#include <quadrant/plant/ball_screw_drive.hpp>
#include <quadrant/plant/three_phase_drive.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using path::point;
using stated::dice, stated::trials;
auto force_of(double f) { return quantity_of<signal::force>::from_value(f); }
auto velocity_of(double v) { return quantity_of<signal::velocity>::from_value(v); }
auto torque_of(double t) { return quantity_of<signal::torque>::from_value(t); }
auto speed_of(double w) { return quantity_of<signal::angular_velocity>::from_value(w); }
auto amps_of(double i) { return quantity_of<signal::current>::from_value(i); }
auto stiffness_of(double k) { return gain_rate_of<signal::force, signal::velocity>::from_value(k); }

/// By how much M (v' - v)/h + force(v') = drive is missed, as a share of what stands in it; 0 where the law jumps
/// across it at v'.
template <class Law> double missed(const Law& law, dice& roll, double level) {
    const double mass = roll.decades(0.1, 1000), h = roll.decades(1e-6, 1e-3), v = roll(-1, 1) * 1e-2,
                 drive = roll(-3, 3) * level, inertia = mass / h;
    const double next = presliding<double>(law, quantity<si::mass>::from_value(mass), velocity_of(v),
                                           force_of(drive), duration::from_value(h))
                            .v.value();
    const auto excess = [&](double x) {
        return inertia * (x - v) + law.after(velocity_of(x), duration::from_value(h)).force.value() - drive;
    };
    const double near = 1e-13 * (std::abs(v) + std::abs(next));
    if (excess(next - near) < 0 && excess(next + near) > 0) return 0;
    return std::abs(excess(next)) / (inertia * (std::abs(v) + std::abs(next)) + std::abs(drive) + level);
}
} // namespace

TEST_CASE("presliding: on dahl, lugre, maxwell_slip the velocity is exact to rounding") {
    dice roll;
    double of_dahl = 0, of_lugre = 0, of_springs = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double level = roll.decades(1, 300), k = level / roll.decades(1e-6, 1e-4);
        const auto shake = [&](auto& law) {
            law.become(
                law.after(velocity_of(roll(-1, 1) * 1e-3), duration::from_value(roll.decades(1e-4, 1e-1)))
                    .next);
        };
        dahl<> one({.coulomb = force_of(level), .stiffness = stiffness_of(k)}, 1_ms);
        shake(one);
        of_dahl = std::max(of_dahl, missed(one, roll, level));
        const stribeck<>::parameters curve{force_of(level), force_of(level * roll(1, 2)),
                                           velocity_of(roll.decades(1e-3, 1e-1))};
        lugre<> bristles({.curve = curve, .stiffness = stiffness_of(k)}, 1_ms);
        shake(bristles);
        of_lugre = std::max(of_lugre, missed(bristles, roll, level));
        maxwell_slip<2>::parameters p{
            .curve = curve, .weights = {0.6, 0.4}, .forces = {}, .stiffness = {}, .attraction = {}};
        p.stiffness = {stiffness_of(k), stiffness_of(0.2 * k)};
        p.attraction = decltype(p.attraction)::from_value(roll.decades(1, 1000));
        maxwell_slip<2> springs(p, 1_ms);
        shake(springs);
        of_springs = std::max(of_springs, missed(springs, roll, level));
    }
    CHECK(tried >= trials);
    CHECK(of_dahl < 1e-12);
    CHECK(of_lugre < 1e-12);
    CHECK(of_springs < 1e-12);
}
TEST_CASE("stick_slip: on a law by direction the last pass is exact: the velocity solves its equation") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        const double level = roll.decades(1, 300), mass = roll.decades(0.1, 1000), h = roll.decades(1e-6, 1e-3);
        using law_type = asymmetric_stribeck<signal::velocity, signal::force>;
        const auto side = [&] {
            return law_type::side{force_of(level * roll(1, 2)), force_of(level * roll(0.2, 1.5)),
                                  velocity_of(roll.decades(1e-4, 1e-1)), velocity_of(roll.decades(1e-4, 1e-1))};
        };
        const double viscous = roll(0, 100);
        const law_type law({side(), side(), gain_of<signal::force, signal::velocity>::from_value(viscous)},
                           1_ms);
        for (int k = 0; k < 10; ++k) {
            const double v = roll.often() ? roll(-1, 1) * roll.decades(1e-4, 1) : 0,
                         drive = roll(-4, 4) * level;
            const auto next = stick_slip<double>(law, quantity<si::mass>::from_value(mass), velocity_of(v),
                                                 force_of(drive), duration::from_value(h));
            const double moving = next.value(), push = mass / h * v + drive;
            if (moving == 0) continue; // held
            const double size = (mass / h + viscous) * std::abs(moving) + law.slip(next).value();
            off = std::max(off, std::abs(size - std::copysign(push, push * moving)) / size);
            ++tried;
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-12);
}
TEST_CASE("ball_screw_drive: each sub-step is the exact solution for the torque at its beginning") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        const double T = roll.decades(1e-4, 1e-2), J = roll.decades(1e-4, 1e-1),
                     B = roll.decades(0.01, 5) * J / T, slope = roll(0, 1) * B, pitch = roll(5e-3, 40e-3),
                     torque = roll(0.1, 5), per_angle = pitch / (2 * std::numbers::pi), A = (B + slope) / J;
        ball_screw_drive<>::parameters p;
        p.inertia = decltype(p.inertia)::from_value(J);
        p.viscous = decltype(p.viscous)::from_value(B);
        p.torque_constant = decltype(p.torque_constant)::from_value(torque);
        p.pitch = quantity_of<signal::position>::from_value(pitch);
        p.friction.forward = {torque_of(0.2), torque_of(0.1), speed_of(1), speed_of(3)};
        p.friction.backward = {torque_of(0.3), torque_of(0.2), speed_of(0.5), speed_of(2)};
        p.friction.viscous = decltype(p.friction.viscous)::from_value(slope);
        p.substeps = 1;
        ball_screw_drive<> drive(p, duration::from_value(T));
        for (int k = 0; k < 100; ++k) {
            const auto was = drive.now();
            const double amps = roll(-1, 1) * 10, w = was.v.value() / per_angle;
            drive(quantity_of<signal::current>::from_value(amps));
            if (w == 0) continue;
            const double slip = drive.friction().slip(speed_of(w)).value(),
                         t = (torque * amps - std::copysign(slip, w)) / J;
            const double gone = -std::expm1(-A * T), slid = gone / A, next = w * (1 - gone) + slid * t,
                         turned = w * slid + (T - slid) / A * t;
            if (next * w <= 0) continue; // stops on its way: another rule
            const double size = std::abs(w) + std::abs(t) * T;
            off = std::max({off, std::abs(drive.now().v.value() / per_angle - next) / size,
                            std::abs((drive.now().x - was.x).value() / per_angle - turned) /
                                (size * T + std::abs(was.x.value()) / per_angle)});
            ++tried;
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE("three_phase_drive: its currents are exact for voltages and motion that stand over the step") {
    dice roll;
    double off = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double T = roll.decades(2e-5, 1e-3), R = roll.decades(0.1, 10), lag = roll.decades(1e-4, 1e-1),
                     kf = roll.decades(5, 200), pole = roll(0.01, 0.06), bandwidth = roll(0.01, 0.08) / T;
        three_phase_drive<>::parameters p{};
        p.force_constant = decltype(p.force_constant)::from_value(kf);
        p.resistance = decltype(p.resistance)::from_value(R);
        p.time_constant = duration::from_value(lag);
        p.pole_pair = quantity_of<signal::position>::from_value(pole);
        p.bus = decltype(p.bus)::from_value(1e9);
        p.current_limit = amps_of(100);
        p.bandwidth = frequency::from_value(bandwidth);
        p.steps = 1;
        three_phase_drive<> drive(p, duration::from_value(T));
        const double before = roll(-10, 10), demand = roll(-10, 10), x = roll(-1, 1), v = roll(-2, 2),
                     wave = 2 * std::numbers::pi / pole;
        drive.settle(amps_of(before), quantity_of<signal::position>::from_value(x));
        drive(amps_of(demand), quantity_of<signal::position>::from_value(x), velocity_of(v));
        // Along q, at the angle of the start: R i that holds the current, and w L for what is asked beside it.
        const std::complex<double> q = std::polar(1.0, wave * x) * std::complex<double>(0, 1),
                                   held = R * before +
                                          2 * std::numbers::pi * bandwidth * R * lag * (demand - before),
                                   back = std::polar(kf / 1.5 * v, wave * (x + v * T / 2)) *
                                          std::complex<double>(0, 1);
        const double gone = -std::expm1(-T / lag);
        const auto i = q * before * (1 - gone) + (q * held - back) / R * gone;
        const auto is = drive.now();
        off = std::max(off, std::abs(std::complex<double>(is.alpha, is.beta) - i) / (20 + std::abs(back) / R));
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE(
    "spline: its feed correction has the exact value, slope and second derivative at both ends; tangent and "
    "curvature are exact for the place") {
    dice roll;
    constexpr std::array<double, 7> first{-49.0 / 20, 6, -15.0 / 2, 20.0 / 3, -15.0 / 4, 6.0 / 5, -1.0 / 6},
        second{203.0 / 45, -87.0 / 5, 117.0 / 4, -254.0 / 9, 33.0 / 2, -27.0 / 5, 137.0 / 180};
    double off_first = 0, off_second = 0, off_tangent = 0, off_curvature = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        std::array<point, 6> c{point{roll(-1, 1), roll(-1, 1), roll(-1, 1)}, point{roll(0.1, 0.2), 0, 0}};
        for (std::size_t k = 1; k < 6; ++k) c[k].y = 0.01 * roll(-1, 1), c[k].z = 0.01 * roll(-1, 1);
        const path::spline curve(c);
        const auto at = [&](double u) { // slope and bend of the polynomial there
            std::array<point, 2> out{};
            for (std::size_t k = 5; k > 0; --k) {
                out[0] = u * out[0] + double(k) * c[k];
                if (k > 1) out[1] = u * out[1] + double(k * (k - 1)) * c[k];
            }
            return out;
        };
        const auto bent = [](const std::array<point, 2>& d) {
            const double v2 = dot(d[0], d[0]);
            return (d[1] - (dot(d[0], d[1]) / v2) * d[0]) / v2;
        };
        const double L = curve.length(), h = 2e-3 * L;
        for (const double from : {0.0, L}) {
            point slope{}, bend{};
            for (std::size_t k = 0; k < first.size(); ++k) {
                const point r = curve.position(from + (from > 0 ? -h : h) * double(k)) - curve.position(from);
                slope += ((from > 0 ? -1 : 1) * first[k] / h) * r, bend += (second[k] / (h * h)) * r;
            }
            const auto end = at(from > 0 ? 1 : 0);
            off_first = std::max(off_first, distance(slope, end[0] / magnitude(end[0])));
            off_second = std::max(off_second, distance(bend, bent(end)) * L);
        }
        const double s = roll(0, L), u = (curve.position(s).x - c[0].x) / c[1].x; // x runs evenly
        const auto there = at(u);
        off_tangent = std::max(off_tangent, distance(curve.tangent(s), there[0] / magnitude(there[0])));
        off_curvature = std::max(off_curvature, distance(curve.curvature(s), bent(there)) * L);
    }
    CHECK(tried >= trials);
    CHECK(off_first < 1e-8);
    CHECK(off_second < 1e-5);
    CHECK(off_tangent < 1e-12);
    CHECK(off_curvature < 1e-12);
}
