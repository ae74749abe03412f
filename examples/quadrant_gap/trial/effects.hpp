// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"
#include "random.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

/// The effects of FORMAT.md as the trial withholds them: how one of a given amplitude gets into a machine.
namespace quadrant_gap::trial {

/// What an effect's amplitude is measured against, from a run of the machine without it.
struct surroundings {
    double period = 0.0005;     ///< of the servo [s]
    double peak_command = 1;    ///< [V]
    double peak_force = 1;      ///< [N]
    double travel = 0.1;        ///< of this motion [m]
    double peak_velocity = 0.1; ///< [m/s]
    double seconds = 10;
    double crossover = 200; ///< of the velocity loop [rad/s]
};

/// What the effect does to a machine. The dice are thrown the same way at
/// every amplitude: only the amplitude differs.
struct insertion {
    axis_truth& truth;
    const axis_truth& described;
    double amplitude;
    dice random;
    const surroundings& around;
    nlohmann::ordered_json parameters =
        nlohmann::ordered_json::object(); ///< true values under the machine keys
};

struct withheld {
    std::string_view name;
    double low, high; ///< of the amplitude
    void (*into)(insertion&);
    bool needs_coulomb = false; ///< a machine file with Coulomb friction
    bool slow_shows_it = false; ///< may be asked of one slow stroke
};

namespace detail {

/// A relative change: times or over 1 + amplitude.
inline double changed(double value, insertion& i, double upwards = 0.5) {
    return i.random.chance(upwards) ? value * (1 + i.amplitude) : value / (1 + i.amplitude);
}
/// A period that this motion passes at least twice.
inline double passed_period(insertion& i) {
    return i.random.log_uniform(std::max(2e-3, i.around.travel / 25), std::max(5e-3, i.around.travel / 2.2));
}
inline wave decaying(insertion& i, double period, int harmonics, double size) {
    wave w{period, {}, {}};
    const double decay = i.random.uniform(0.2, 0.5);
    for (int k = 0; k < harmonics; ++k, size *= decay) {
        w.size.push_back(size);
        w.phase.push_back(i.random.phase());
    }
    return w;
}
inline void controller_key(insertion& i) {
    controller_truth& c = i.truth.controller;
    struct key {
        const char* name;
        double* value;
    };
    std::vector<key> keys{{"position_gain_per_s", &c.position_gain},
                          {"velocity_gain_V_s_per_m", &c.velocity_gain},
                          {"velocity_integral_V_per_m", &c.integral}};
    if (!c.two_sample_mean) keys.push_back({"velocity_filter_Hz", &c.filter_Hz});
    if (c.acceleration_feedforward > 0)
        keys.push_back({"acceleration_feedforward_V_s2_per_m", &c.acceleration_feedforward});
    if (c.viscous_feedforward > 0) keys.push_back({"viscous_feedforward_V_s_per_m", &c.viscous_feedforward});
    if (c.velocity_feedforward > 0) keys.push_back({"velocity_feedforward", &c.velocity_feedforward});
    const key& chosen = i.random.one_of(keys);
    *chosen.value = changed(*chosen.value, i);
    i.parameters[std::string("controller.") + chosen.name] = *chosen.value;
}

} // namespace detail

inline constexpr withheld effects[] = {
    {"coulomb_friction", 0.002, 30,
     [](insertion& i) {
         auto& real = i.truth.friction;
         if (i.described.friction.coulomb == 0) { // not described at all
             real.coulomb = i.amplitude * 0.01 * i.around.peak_force;
         } else {
             const double was = real.coulomb;
             real.coulomb = detail::changed(was, i);
             if (real.level_at_rest > 0) real.level_at_rest = std::max(real.level_at_rest, real.coulomb);
         }
         i.parameters["coulomb_N"] = real.coulomb;
     },
     false, true},
    {"viscous_friction", 0.02, 20,
     [](insertion& i) {
         auto& b = i.truth.friction.viscous;
         b = detail::changed(b, i, 0.7);
         i.parameters["viscous_N_s_per_m"] = b;
     },
     false, true},
    {"stribeck_friction", 0.01, 4,
     [](insertion& i) {
         auto& f = i.truth.friction;
         f.level_at_rest = f.coulomb * (1 + i.amplitude);
         f.stribeck_velocity = i.random.log_uniform(1e-3, 1e-2);
         const double form = i.random.uniform();
         f.shape = form < 0.5    ? stribeck_shape::exponential
                   : form < 0.75 ? stribeck_shape::gaussian
                                 : stribeck_shape::lorentzian;
         if (f.shape == stribeck_shape::exponential) {
             i.parameters["static_N"] = f.level_at_rest;
             i.parameters["stribeck_velocity_m_per_s"] = f.stribeck_velocity;
         }
     },
     true, true},
    {"presliding_friction", 3e-6, 3e-4,
     [](insertion& i) {
         auto& f = i.truth.friction;
         if (f.law == contact_law::tanh_spring) f.law = contact_law::maxwell_slip; // that one barely remembers
         f.length = i.amplitude;
         i.parameters["presliding_length_m"] = i.amplitude;
     },
     true},
    {"asymmetric_friction", 0.01, 0.9,
     [](insertion& i) {
         auto& f = i.truth.friction;
         const double sign = i.random.sign();
         if (i.described.friction.coulomb == 0 || i.random.chance(0.5))
             i.parameters["viscous_asymmetry"] = f.viscous_asymmetry = sign * i.amplitude;
         if (i.described.friction.coulomb > 0)
             i.parameters["coulomb_asymmetry"] = f.coulomb_asymmetry = sign * 0.7 * i.amplitude;
     },
     false, true},
    {"position_dependent_friction", 0.01, 0.9,
     [](insertion& i) {
         auto& w = i.truth.friction.along;
         w = detail::decaying(i, detail::passed_period(i), 1, i.amplitude);
         i.parameters = {{"friction_position_amplitude", i.amplitude},
                         {"friction_position_period_m", w.period}};
     },
     true, true},
    {"friction_drift", 0.01, 2,
     [](insertion& i) {
         auto& f = i.truth.friction;
         f.drift = i.random.chance(0.7) ? -i.amplitude / (1 + i.amplitude)
                                        : i.amplitude; // warming oil: less friction
         f.drift_time = i.around.seconds * i.random.log_uniform(0.15, 1);
         i.parameters = {{"friction_drift", f.drift}, {"friction_drift_time_s", f.drift_time}};
     },
     true},
    {"mass", 0.01, 1.5,
     [](insertion& i) {
         auto& m = i.truth.mechanics.mass;
         m = detail::changed(m, i, 0.7);
         i.parameters["mass_kg"] = m;
     }},
    {"structural_resonance", 0.003, 0.45,
     [](insertion& i) {
         auto& m = i.truth.mechanics;
         m.mode_mass = i.amplitude * m.mass;
         m.mode_frequency = i.random.log_uniform(15, std::min(140.0, 0.12 / i.around.period));
         m.mode_damping = i.random.log_uniform(0.005, 0.06);
         i.parameters = {{"mode_mass_kg", m.mode_mass},
                         {"mode_frequency_Hz", m.mode_frequency},
                         {"mode_damping", m.mode_damping}};
     }},
    {"backlash", 5e-7, 5e-4,
     [](insertion& i) { i.parameters["backlash_m"] = i.truth.mechanics.backlash = i.amplitude; }},
    {"constant_force", 1e-4, 0.3,
     [](insertion& i) {
         i.parameters["constant_force_N"] = i.truth.mechanics.constant_force =
             i.random.sign() * i.amplitude * i.around.peak_force;
     },
     false, true},
    {"position_spring", 1e-4, 1,
     [](insertion& i) {
         i.parameters["spring_N_per_m"] = i.truth.mechanics.spring =
             i.amplitude * i.around.peak_force / i.around.travel;
     },
     false, true},
    {"cross_coupling", 0.001, 0.5,
     [](insertion& i) {
         i.parameters["coupling"] = i.truth.mechanics.coupling = i.random.sign() * i.amplitude;
     }},
    {"cogging", 1e-4, 0.5,
     [](insertion& i) {
         auto& w = i.truth.mechanics.cogging;
         w = detail::decaying(i, detail::passed_period(i), i.random.whole(1, 6),
                              i.amplitude * i.around.peak_force);
         i.parameters = {{"cogging_period_m", w.period}, {"cogging_N", w.size.front()}};
     },
     false, true},
    {"force_ripple", 0.002, 0.5,
     [](insertion& i) {
         auto& w = i.truth.actuator.ripple;
         w = detail::decaying(i, detail::passed_period(i), 1, i.amplitude);
         i.parameters = {{"ripple", i.amplitude}, {"ripple_period_m", w.period}};
     }},
    {"force_constant", 0.005, 1,
     [](insertion& i) {
         auto& k = i.truth.actuator.force_constant;
         k = detail::changed(k, i, 0.3);
         i.parameters["force_constant_N_per_V"] = k;
     }},
    {"time_delay", 2e-5, 0.02,
     [](insertion& i) { i.parameters["delay_s"] = i.truth.actuator.delay += i.amplitude; }},
    {"actuator_lag", 2e-5, 0.02,
     [](insertion& i) { i.parameters["actuator.lag_s"] = i.truth.actuator.lag = i.amplitude; }},
    {"actuator_saturation", 0.002, 0.7,
     [](insertion& i) {
         i.parameters["actuator.drive_limit_V"] = i.truth.actuator.drive_limit =
             i.around.peak_command * (1 - i.amplitude);
     }},
    {"actuator_dead_zone", 1e-4, 1,
     [](insertion& i) { i.parameters["actuator.dead_zone_V"] = i.truth.actuator.dead_zone = i.amplitude; }},
    {"sample_loss", 0.001, 0.2,
     [](insertion& i) { i.parameters["actuator.loss_probability"] = i.truth.actuator.loss = i.amplitude; }},
    {"encoder_quantization", 2, 400,
     [](insertion& i) {
         const double count = i.described.encoder.resolution * std::round(i.amplitude);
         i.parameters["encoder.resolution_m"] = i.truth.encoder.resolution = count;
     }},
    {"encoder_cyclic_error", 2e-8, 1e-4,
     [](insertion& i) {
         auto& w = i.truth.encoder.cyclic;
         w = detail::decaying(i, i.random.log_uniform(2e-4, std::max(1e-3, i.around.travel / 3)), 1,
                              i.amplitude);
         i.parameters = {{"encoder.cyclic_m", i.amplitude}, {"encoder.cyclic_period_m", w.period}};
     }},
    {"cutting_force", 1e-4, 0.3,
     [](insertion& i) {
         auto& p = i.truth.process;
         const int harmonics = i.random.whole(1, 4);
         p.fundamental = i.random.log_uniform(8, std::min(120.0, 0.15 / i.around.period));
         const wave w = detail::decaying(i, 1, harmonics, i.amplitude * i.around.peak_force);
         p.size = w.size, p.phase = w.phase;
         p.mean = i.random.chance(0.3) ? 0.5 * p.size.front() : 0;
         i.parameters = {{"process.fundamental_Hz", p.fundamental}, {"process.force_N", p.size.front()}};
     }},
    {"controller_mismatch", 0.005, 1, detail::controller_key},
};

inline const withheld& effect_named(std::string_view name) {
    return *std::find_if(std::begin(effects), std::end(effects),
                         [&](const withheld& e) { return e.name == name; });
}

} // namespace quadrant_gap::trial
