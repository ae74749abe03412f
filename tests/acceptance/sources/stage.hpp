// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "case.hpp"

#include "quadrant_reproduce/stage.hpp"

#include <quadrant/plant/three_phase_drive.hpp>

/// The precision stage of [LowKeck2003]: predictive law, Kalman filter, LuGre friction, current loop of three
/// phases.
namespace sources::precision_stage {

using namespace quadrant;
using namespace quadrant::literals;

/// The drive of docs/blocks/three_phase_drive.md; its back electromotive force does not reach the bus.
inline three_phase_drive<>::parameters drive() {
    return {.force_constant = in_si(stage::real.force_constant),
            .resistance = 2_V / 1_A,
            .time_constant = 4_ms,
            .pole_pair = 30_mm,
            .bus = 150_V,
            .current_limit = 8_A,
            .bandwidth = 300_Hz,
            .steps = 20};
}

inline diagnosis::axis_description described(bool three_phases) {
    const stage::machine& m = stage::real;
    diagnosis::axis_description d;
    d.name = "x";
    d.command_unit = "A";
    d.plant.mass_kg = m.mass;
    d.plant.force_constant_N_per_V = m.force_constant;
    d.plant.viscous_N_s_per_m = m.viscous;
    d.plant.coulomb_N = m.coulomb;
    d.plant.static_N = m.static_level;
    d.plant.stribeck_velocity_m_per_s = m.stribeck;
    d.plant.stribeck_exponent = 2;
    d.plant.presliding_length_m = m.static_level / m.stiffness; // at rest a bristle approaches Fs exponentially
    d.plant.presliding_damping_s = m.damping / m.stiffness;
    d.encoder.resolution_m = 1e-6;
    d.actuator.limit_V = 8;
    if (three_phases) {
        const auto c = drive();
        const double w = 2 * std::numbers::pi * c.bandwidth.value();
        d.actuator.lag_s = 1 / w;
        // Under an acceleration a the back electromotive force rises by a kf/1.5 a second. The integral of the
        // current's controller follows such a ramp with the error i = a kf / (1.5 w R), whose force kf i the
        // command sees as more mass.
        d.plant.mass_kg +=
            c.force_constant.value() * c.force_constant.value() / (1.5 * w * c.resistance.value());
    }
    d.tolerance.given = {{"mass", 0.05},    {"force_constant", 0.05}, {"viscous", 0.05},
                         {"coulomb", 0.05}, {"static", 0.05},         {"stribeck_velocity", 0.05}};
    return d;
}

/// The loop of stage::axis with the current loop between command and motor, or without it.
inline written_case make(const std::function<axis_motion<>(double)>& reference, double lasts,
                         const stage::tuning& tuned, bool three_phases) {
    const auto believed = stage::believed;
    using friction = lugre<signal::velocity, signal::voltage>;
    feed_control<feed_control_boxes<stage::law, friction>> control{
        .box = {{.law = stage::law_of(believed, tuned),
                 .friction = stage::friction_of<signal::voltage>(believed, believed.force_constant),
                 .limit = 8_V},
                stage::period}};
    kalman<signal::voltage> filter(stage::filter_of(believed, tuned), stage::period);
    stage::motor motor(stage::motor_of(stage::real), stage::period);
    three_phase_drive<> current(drive(), stage::period);
    quantity<si::length> reading{};
    quantity<si::electric_potential> command{};
    recording::axis logged{"x", "A", {}};
    const double T = stage::period.value();
    const auto ahead = static_cast<long>(stage::horizon);
    for (long k = -ahead; static_cast<double>(k) * T <= lasts; ++k) {
        const auto speed = filter(reading, command);
        command = control(reference(static_cast<double>(k + ahead) * T), {filter.position(), speed});
        if (k >= 0) logged.rows.push_back({control.wire.reference.value(), reading.value(), command.value()});
        reading = three_phases ? motor(0_V, current(command / 1_V * 1_A, motor.now().x, motor.now().v))
                               : motor(command);
    }
    written_case out{{T, {std::move(logged)}}, {}};
    diagnosis::machine_description file;
    file.sample_period_s = T;
    file.excluded_effects = {"backlash"}; // a direct drive
    file.axes.push_back(described(three_phases));
    out.machine = to_json(file);
    return out;
}

inline void add(std::vector<log_case>& to) {
    const auto curve = [](double length, double time) {
        return [s = trajectory::s_curve({length * 1_m, time * 1_s})](double t) {
            const auto m = s(t * 1_s);
            return axis_motion<>{m.position, m.velocity, m.acceleration};
        };
    };
    for (const bool three_phases : {true, false}) {
        const std::string name = three_phases ? "stage.three_phases." : "stage.direct.";
        const auto put = [&](const char* motion, auto reference, double lasts, const stage::tuning& t) {
            to.push_back({name + motion, [=] { return make(reference, lasts, t, three_phases); }});
        };
        put("move_300mm", curve(0.3, 1), 1.2, stage::tight);
        put("move_20mm", curve(0.02, 0.5), 0.7, stage::tight);
        put("move_500um", curve(500e-6, 0.2), 2.2, stage::moderate);
        put("bs3800", stage::linear_cycle(), stage::linear_cycle::end(), stage::tight);
    }
}

} // namespace sources::precision_stage
