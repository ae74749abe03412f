// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../measured_axis.hpp"

#include <quadrant/analysis/fit_gms.hpp>
#include <quadrant/analysis/fit_stribeck.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

/// The identification of [Jamaludin2008] eqs. (3.5), (3.9) on a simulated axis: runs at constant speeds, two
/// slow sinusoids, and what the procedures of `quadrant::analysis` make of the logs, beside what was simulated.
namespace thesis::identification {

/// An encoder that counts and jitters, and a noisy amplifier.
class noisy_instruments {
public:
    static constexpr double encoder = 0.25e-6;

    explicit noisy_instruments(unsigned seed) : random_(seed) {}
    quantity<si::length> reading(quantity<si::length> place, quantity<si::velocity>) {
        const double exact = place.value() + 20e-9 * gauss_(random_);
        return quantity<si::length>::from_value(encoder * std::round(exact / encoder));
    }
    quantity_of<signal::voltage> command(quantity_of<signal::voltage> u) {
        return u + 1e-3 * gauss_(random_) * 1_V;
    }

private:
    std::mt19937 random_;
    std::normal_distribution<double> gauss_;
};

/// A simulated axis on Generalized Maxwell-slip friction in the thesis' cascade, without friction feedforward.
/// Its instruments are noisy, it has a DAC, and the controller's plant is 2 % off.
template <template <class, class, class> class Axis = measured_axis> class rig_of {
public:
    using motor = linear_motor<maxwell_slip<4>>;
    using log = analysis::test_run<>;

    rig_of(const axis& a, unsigned seed) : axis_(controller(a), machine(a), noisy_instruments(seed)) {}

    /// Follows x(t), v(t), a(t) for `length` seconds from rest at x(0) = 0.
    template <class Motion> log follow(const Motion& motion, double length) {
        log out;
        const auto samples = std::size_t(length / period.value());
        for (std::size_t i = 0; i < samples; ++i) {
            const auto [x, v, a] = motion(double(i) * period.value());
            axis_.step({x * 1_m, v * 1_mps, a * 1_mps2});
            out.position.push_back(axis_.reading()), out.command.push_back(axis_.command());
        }
        return out;
    }

private:
    static milling_axis_boxes<>::parameters controller(const axis& a) {
        auto p = controller_of<milling_axis_boxes<>>(a);
        p.plant_gain *= 1.02;
        p.plant_pole *= 0.98;
        p.dac_step = 20_V / 65536.0;
        return p;
    }
    static typename motor::parameters machine(const axis& a) {
        typename motor::parameters p{.mass = a.kf / a.B,
                                     .force_constant = a.kf,
                                     .friction =
                                         gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0)),
                                     .delay = 0.4_ms,
                                     .substeps = 5};
        p.friction.curve.viscous += a.A_gms * p.mass; // A' beside sigma
        return p;
    }

    Axis<milling_axis_boxes<>, motor, noisy_instruments> axis_;
};
using rig = rig_of<>;

/// The speeds of [Jamaludin2008] section 3.3.2 [m/s].
inline constexpr std::array map_speeds{1e-5, 4e-5, 8e-5, 2e-4,   4e-4,   5e-4, 1e-3,   2e-3, 4e-3,
                                       5e-3, 8e-3, 1e-2, 1.4e-2, 1.6e-2, 2e-2, 2.5e-2, 3e-2};

/// Runs at constant speeds, both ways: first fast enough for the springs to be bent, then at the speed.
inline std::vector<rig::log> constant_speeds(const axis& a, unsigned seed) {
    std::vector<rig::log> out;
    for (const double speed : map_speeds)
        for (const double way : {1.0, -1.0}) {
            constexpr double start = 0.1, run_in = 1.5; // s
            const double first = std::max(speed, 1.5e-4), length = run_in + std::max(4.0, 5e-5 / speed);
            const auto motion = [&](double t) -> std::array<double, 3> {
                if (t < start)
                    return {way * 0.5 * first / start * t * t, way * first / start * t, way * first / start};
                if (t < run_in) return {way * first * (t - 0.5 * start), way * first, 0};
                return {way * (first * (run_in - 0.5 * start) + speed * (t - run_in)), way * speed, 0};
            };
            out.push_back(rig(a, seed++).follow(motion, length));
        }
    return out;
}

/// The slow sinusoid, from rest: 0.1 Hz and so many micrometres.
inline rig::log slow_sinusoid(const axis& a, double amplitude, double cycles, unsigned seed) {
    const double w = 2 * pi_ * 0.1;
    return rig(a, seed).follow(
        [=](double t) -> std::array<double, 3> {
            return {amplitude * (1 - std::cos(w * t)), amplitude * w * std::sin(w * t),
                    amplitude * w * w * std::cos(w * t)};
        },
        cycles * 10);
}

/// What the axis was simulated with: its elements at the level Fs.
inline double virgin_force(const axis& a, double way) {
    double alpha = 0, force = 0;
    for (const auto& each : a.alpha) alpha += each.value();
    for (std::size_t i = 0; i < a.alpha.size(); ++i)
        force += std::min(a.k[i].value() * way, a.alpha[i].value() / alpha * a.curve.static_level.value());
    return force;
}

/// One figure of `thesis.identify.<axis>`: found, with its interval of 95 %, beside what was simulated.
struct identified {
    std::string id, quantity, unit;
    double simulated; ///< identified from the runs
    double low, high; ///< of that
    double reference; ///< what the runs were simulated with
    bool held() const { return low <= reference && reference <= high; }
};

/// What the procedures found, and the map that the first of them gave.
struct findings {
    std::vector<identified> rows;
    analysis::friction_map map;
};

/// The whole of it: friction map at the thesis' 17 speeds, then the virgin curve with the level that the map
/// gave, then the elements.
inline findings identify(const axis& a, unsigned seed = 1) {
    findings out{{}, analysis::map_friction<>(constant_speeds(a, seed), period, a.kf)};
    const auto level = analysis::fit_stribeck(out.map);
    const quantity<si::mass> mass = a.kf / a.B;
    const auto viscous = a.curve.viscous + a.A_gms * mass;
    const auto curve = analysis::find_virgin_curve<>(
        {slow_sinusoid(a, 15e-6, 4, seed + 100), slow_sinusoid(a, 450e-6, 4, seed + 101)}, period, a.kf,
        {.mass = 1.02 * mass, .viscous = 0.98 * viscous, .level = level.parameters()});
    const auto springs = analysis::fit_gms<4>(curve);

    const std::string id = std::string("thesis.identify.") + a.name;
    const auto add = [&](const std::string& name, const std::string& unit, const auto& found, double truth) {
        out.rows.push_back({id, name, unit, found.value.value(), found.low.value(), found.high.value(), truth});
    };
    add("Fc", "N", level.coulomb, a.curve.coulomb.value());
    if (level.static_level) add("Fs", "N", *level.static_level, a.curve.static_level.value());
    if (level.stribeck_velocity) add("Vs", "m/s", *level.stribeck_velocity, a.curve.stribeck_velocity.value());
    add("viscous", "N s/m", level.viscous, viscous.value());
    for (const int um : {1, 5, 15, 30})
        add("virgin_" + std::to_string(um) + "um", "N", springs.at(um * 1e-6 * 1_m),
            virgin_force(a, um * 1e-6));
    return out;
}

} // namespace thesis::identification
