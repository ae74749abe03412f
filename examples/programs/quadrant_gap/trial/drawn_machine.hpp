// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop.hpp"
#include "motion.hpp"
#include "plan.hpp"
#include "tolerances.hpp"

/// A machine of the trial without its effects: values as machine tools have them, a controller tuned to them.
namespace quadrant_gap::trial {

/// White noise of what is measured behind an amplifier or a drive's loops, of the peak; last digit of a duty.
inline constexpr double noise_of_measured = 0.002, rounding_of_duty = 1e-5;

struct drawn_effect {
    std::string name;
    double size = 0; ///< command gap that it alone makes [in the 95th percentile of the tolerance cloud]
    nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
};

struct drawn_machine {
    std::size_t index = 0;
    kind what = kind::none;
    logs how = logs::plain;
    double period = 0.0005;
    std::vector<axis_truth> truth, described; ///< axis by axis; effects are on the first
    tolerances tolerance;
    std::vector<drawn_effect> effects{};
    std::vector<std::string> excluded{};
    std::vector<std::vector<double>> log_reference, holdout_reference;
    std::uint64_t noise_seed = 0;
    double cloud = 0; ///< 95th percentile of the command gap by tolerances, noise and rounding alone [N]
};

namespace detail {

/// Six digits, as files carry them: what is described is what is written.
inline double written(double v) {
    if (v == 0) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(v))) - 5);
    return unit < 1 ? std::round(v / unit) / std::round(1 / unit) : std::round(v / unit) * unit;
}

inline axis_truth drawn_axis(double period, const std::string& name, dice& random) {
    axis_truth a;
    a.name = name;
    auto& c = a.controller;
    c.limit = random.one_of(std::vector<double>{10, 10, 10, 8, 5});
    c.dac_bits = random.one_of(std::vector<int>{16, 16, 16, 14, 12, 0});
    a.mechanics.mass = written(random.log_uniform(15, 600));
    const double peak = random.log_uniform(8, 60); // acceleration at the limit [m/s^2]
    const double kf = a.actuator.force_constant = written(a.mechanics.mass * peak / c.limit);
    a.friction.viscous = written(a.mechanics.mass * random.log_uniform(0.3, 4));
    a.actuator.delay = written(std::round(random.log_uniform(1e-4, 1.2e-3) * 2e4) / 2e4);
    if (random.chance(0.65)) {
        a.friction.coulomb = written(a.mechanics.mass * peak * random.log_uniform(0.004, 0.03));
        if (random.chance(0.4)) {
            a.friction.level_at_rest = written(a.friction.coulomb * random.uniform(1.15, 1.9));
            a.friction.stribeck_velocity = written(random.log_uniform(1.5e-3, 1e-2));
        }
    }
    auto& f = a.friction;
    f.law = static_cast<contact_law>(random.whole(0, 3));
    f.length = random.log_uniform(5e-8, 4e-7);
    f.exponent = random.uniform(0.5, 1.6);
    f.damping = random.uniform(0.1, 0.4);
    double sum = 0;
    for (int k = random.whole(6, 10); k > 0; --k) {
        f.weights.push_back(random.uniform(0.4, 1));
        f.ways.push_back(random.log_uniform(0.3, 2.5));
        sum += f.weights.back();
    }
    for (double& w : f.weights) w /= sum;

    c.two_sample_mean = random.chance(0.25);
    c.filter_Hz = written(random.uniform(90, std::min(300.0, 0.16 / period)));
    const double estimator = c.two_sample_mean ? period : 1 / (2 * std::numbers::pi * c.filter_Hz);
    const double crossover =
        std::clamp(random.uniform(0.25, 0.45) / (a.actuator.delay + period / 2 + estimator), 40.0, 450.0);
    c.velocity_gain = written(crossover * a.mechanics.mass / kf);
    c.position_gain = written(crossover * random.uniform(0.25, 0.42));
    c.integral = written(c.velocity_gain * random.log_uniform(3, 15));
    c.velocity_feedforward = random.chance(0.85) ? 1 : 0;
    if (random.chance(0.8))
        c.acceleration_feedforward = written(a.mechanics.mass / kf * random.uniform(0.85, 1.02));
    if (random.chance(0.7)) c.viscous_feedforward = written(f.viscous / kf * random.uniform(0.8, 1.1));
    if (f.coulomb > 0 && random.chance(0.35))
        c.coulomb_feedforward = written(f.coulomb / kf * random.uniform(0.5, 1));
    if (random.chance(0.3)) {
        c.notch_Hz = written(random.uniform(150, std::min(400.0, 0.3 / period)));
        c.notch_damping = written(random.uniform(0.04, 0.25));
    }
    std::vector<double> counts;
    for (const double q : {1e-8, 5e-8, 1e-7, 2.5e-7, 2.5e-7, 5e-7, 1e-6})
        if (q / period * c.velocity_gain * std::min(1.0, 2 * c.filter_Hz * period) < 0.15) counts.push_back(q);
    a.encoder.resolution = counts.empty() ? 1e-8 : random.one_of(counts);
    a.encoder.noise = a.encoder.resolution * random.log_uniform(0.05, 1);
    a.encoder.noise_colour = random.uniform(0, 0.95);
    return a;
}

/// Makes the drive of this axis one with loops of its own, with a bandwidth and delays as such drives have.
inline void give_loops(axis_truth& a, population of, double period, logs how, dice& random) {
    drive_truth& d = a.drive;
    d.kind = drive_of(of);
    a.actuator.delay = 0;
    a.encoder.resolution = random.one_of(std::vector<double>{5e-8, 1e-7, 2.5e-7, 5e-7, 1e-6});
    a.encoder.noise = a.encoder.resolution * random.log_uniform(0.05, 1);
    const double peak = a.actuator.force_constant * a.controller.limit / a.mechanics.mass;
    d.delay = written(period * random.uniform(0.3, 2));
    if (of == population::position_servo) {
        const double inertia = a.mechanics.mass = written(random.log_uniform(2e-3, 2e-2));
        a.controller.limit = d.supply = random.one_of(std::vector<double>{6, 7.4, 12, 24});
        a.actuator.force_constant = written(inertia * peak / d.supply);
        const double corner = random.uniform(15, 40), share = inertia * peak;
        d.duty_gain = written(inertia * corner * corner / share);
        a.friction.viscous = written(inertia * corner * random.uniform(0.8, 1.6));
        if (a.friction.coulomb > 0) a.friction.coulomb = written(share * random.log_uniform(0.01, 0.06));
        if (a.friction.level_at_rest > 0)
            a.friction.level_at_rest = written(a.friction.coulomb * random.uniform(1.15, 1.9));
        a.encoder.resolution = random.one_of(std::vector<double>{2e-5, 1e-4, 3e-4});
        a.encoder.noise = a.encoder.resolution * random.log_uniform(0.05, 0.5);
        d.tapped = random.chance(0.5) || how == logs::measured;
        return;
    }
    const double bandwidth = 2 * std::numbers::pi * random.uniform(20, std::min(60.0, 0.06 / period));
    d.velocity_gain = written(a.mechanics.mass * bandwidth);
    if (of == population::velocity_pi || (of == population::position && random.chance(0.7)))
        d.velocity_integral = written(d.velocity_gain * bandwidth * random.uniform(0.1, 0.3));
    if (of == population::position) {
        d.position_gain = written(bandwidth * random.uniform(0.12, 0.3));
        d.linear = random.chance(0.5);
    } else {
        d.velocity_per_V = written(random.uniform(0.05, 0.12));
        a.controller.position_gain = written(bandwidth * random.uniform(0.08, 0.2));
    }
    a.controller.limit = written(a.mechanics.mass * peak);
    a.actuator.force_constant = 1;
    if (random.chance(0.5)) d.force_limit = a.controller.limit;
    if (how != logs::measured) return;
    d.tapped = true;
    d.tap_is_mean = random.chance(0.5);
    a.actuator.force_constant = written(a.controller.limit / random.log_uniform(3, 30)); // [N/A]
}

/// Makes this axis a joint of an arm: geared, with a load at its end, its weight and friction that grows with
/// what the gears carry. Its cascade is scaled with it.
inline void give_joint(axis_truth& a, double period, dice& random) {
    a.turns = true;
    auto& m = a.mechanics;
    auto& c = a.controller;
    const double before = m.mass / a.actuator.force_constant;
    const double inertia = m.mass = written(random.log_uniform(0.03, 3));
    const double arm = written(random.uniform(0.15, 0.6)), part = random.uniform(0.3, 0.8);
    m.payload = m.payload_as_described = {written(part * inertia / (arm * arm)), arm};
    m.gravity = written(m.payload.weight() * random.uniform(1.05, 1.5));
    m.gravity_phase = written(random.uniform(-1.2, 1.2));
    const double peak = m.gravity / inertia * random.uniform(2.5, 6); // torque at the limit over the inertia
    a.actuator.force_constant = written(inertia * peak / c.limit);
    const double scale = inertia / a.actuator.force_constant / before;
    for (double* gain : {&c.velocity_gain, &c.integral, &c.acceleration_feedforward})
        *gain = written(*gain * scale);
    const auto of_torque = [&](double low, double high) {
        return written(inertia * peak * random.log_uniform(low, high));
    };
    a.friction.viscous = written(inertia * random.log_uniform(0.5, 6));
    if (c.viscous_feedforward > 0)
        c.viscous_feedforward =
            written(a.friction.viscous / a.actuator.force_constant * random.uniform(0.8, 1.1));
    c.coulomb_feedforward = 0;
    const double excess = a.friction.level_at_rest > 0 ? a.friction.level_at_rest / a.friction.coulomb : 0;
    if (a.friction.coulomb > 0) a.friction.coulomb = of_torque(0.005, 0.05);
    a.friction.level_at_rest = excess > 0 ? written(excess * a.friction.coulomb) : 0;
    a.friction.stribeck_velocity = written(random.log_uniform(0.01, 0.1));
    if (a.friction.coulomb > 0 && random.chance(0.6)) a.friction.load = written(random.log_uniform(0.02, 0.2));
    // Against counts and travel as short as on linear axes: the file says nothing of it, so a record may show
    // nothing of it.
    a.friction.length = radians_for_a_metre * random.log_uniform(5e-8, 4e-7);
    std::vector<double> counts;
    for (const double q : {2e-7, 1e-6, 2e-6, 5e-6, 1e-5, 2e-5})
        if (q / period * c.velocity_gain * std::min(1.0, 2 * c.filter_Hz * period) < 0.15) counts.push_back(q);
    a.encoder.resolution = counts.empty() ? 2e-7 : random.one_of(counts);
    a.encoder.noise = a.encoder.resolution * random.log_uniform(0.05, 1);
}

/// The true values of an effect, after calibration has moved them too.
inline void read_again(nlohmann::ordered_json& parameters, axis_truth a) {
    for (auto& [key, value] : parameters.items())
        if (const double* place = number_in(a, key)) value = *place;
}

inline motion_limits limits(const axis_truth& a, double seconds, double period, dice& random) {
    motion_limits l;
    l.seconds = seconds;
    const double peak = a.actuator.force_constant * a.controller.limit / a.mechanics.mass;
    l.acceleration = std::min(8.0, peak * random.uniform(0.2, 0.45));
    l.velocity = random.log_uniform(0.08, 0.6);
    l.half_travel = random.log_uniform(0.04, 0.3);
    l.top_Hz = std::min(180.0, 0.15 / period);
    if (a.turns) {
        l.acceleration = peak * random.uniform(0.15, 0.35);
        l.velocity = random.log_uniform(0.5, 3);
        l.half_travel = random.log_uniform(0.4, 1.6);
        l.top_Hz = std::min(60.0, l.top_Hz);
        l.unit = radians_for_a_metre;
    }
    return l;
}

} // namespace detail

} // namespace quadrant_gap::trial
