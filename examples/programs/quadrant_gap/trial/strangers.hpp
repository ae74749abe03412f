// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effects.hpp"

/// What the trial puts into machines that no list has a name for.
namespace quadrant_gap::trial {

/// Forces and gains that no list knows. Amplitude relative to the largest force of the motion.
inline void put_stranger(insertion& i) {
    using enum stranger::kind;
    const double force = i.amplitude * i.around.peak_force;
    auto& u = i.truth.unknown;
    u.seed = static_cast<std::uint64_t>(i.random.uniform() * 1e15);
    // The last two are amplifiers of a command in volts of force.
    const int which = i.random.whole(0, i.truth.drive.closes() ? 5 : 7);
    const char* name = "";
    switch (which) {
    case 0:
        u = {ramp, force * i.random.sign(), i.around.seconds, 0, u.seed}, name = "force_ramp";
        break;
    case 1:
        u = {bump, force, i.around.travel * i.random.uniform(0.03, 0.1),
             i.around.travel * i.random.uniform(0, 0.3), u.seed},
        name = "detent";
        break;
    case 2:
        u = {quadratic_spring, force * i.random.sign(), i.around.travel, 0, u.seed}, name = "quadratic_spring";
        break;
    case 3:
        u = {step, force * i.random.sign(), 1, i.around.seconds * i.random.uniform(0.3, 0.7), u.seed},
        name = "force_step";
        break;
    case 4:
        u = {bursts, force, 1, 0, u.seed}, name = "force_bursts";
        break;
    case 5:
        u = {wander, force, 1, 0, u.seed}, name = "wandering_force";
        break;
    case 6:
        i.truth.actuator.slew = i.around.peak_command * i.around.crossover * 0.2 / i.amplitude;
        name = "amplifier_slew_rate";
        break;
    default:
        i.truth.actuator.soft_limit = i.around.peak_command / std::sqrt(i.amplitude);
        name = "soft_saturation";
    }
    i.parameters["unknown"] = name;
}

} // namespace quadrant_gap::trial
