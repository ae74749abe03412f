// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::diagnosis {

namespace detail {

/// Keys in the order of writing; what is not described gets none.
class machine_box {
public:
    machine_box& put(const char* key, double value) {
        json_[key] = value;
        return *this;
    }
    machine_box& put(const char* key, const std::optional<double>& value) {
        if (value) json_[key] = *value;
        return *this;
    }
    machine_box& put(const char* key, const std::vector<double>& values) {
        if (!values.empty()) json_[key] = values;
        return *this;
    }
    machine_box& put_unless_zero(const char* key, double value) {
        if (value != 0) json_[key] = value;
        return *this;
    }
    machine_box& put(const char* key, nlohmann::ordered_json value) {
        json_[key] = std::move(value);
        return *this;
    }
    nlohmann::ordered_json take() { return std::move(json_); }

private:
    nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

inline nlohmann::ordered_json plant_json(const axis_description& a) {
    const plant_description& p = a.plant;
    machine_box box;
    box.put("mass_kg", p.mass_kg);
    if (a.command_unit != "N")
        box.put(("force_constant_N_per_" + a.command_unit).c_str(), p.force_constant_N_per_V);
    return box.put("viscous_N_s_per_m", p.viscous_N_s_per_m)
        .put("delay_s", p.delay_s)
        .put("coulomb_N", p.coulomb_N)
        .put("static_N", p.static_N)
        .put("stribeck_velocity_m_per_s", p.stribeck_velocity_m_per_s)
        .put("viscous_asymmetry", p.viscous_asymmetry)
        .put("coulomb_asymmetry", p.coulomb_asymmetry)
        .put("constant_force_N", p.constant_force_N)
        .put("cogging_period_m", p.cogging_period_m)
        .put("cogging_N", p.cogging_N)
        .put("cogging_phase_rad", p.cogging_phase_rad)
        .put("presliding_length_m", p.presliding_length_m)
        .put("presliding_damping_s", p.presliding_damping_s)
        .put("gms_weights", p.gms_weights)
        .put("gms_stiffness_N_per_m", p.gms_stiffness_N_per_m)
        .put("friction_position_amplitude", p.friction_position_amplitude)
        .put("friction_position_period_m", p.friction_position_period_m)
        .put("friction_position_phase_rad", p.friction_position_phase_rad)
        .put("friction_drift", p.friction_drift)
        .put("friction_drift_time_s", p.friction_drift_time_s)
        .put("mode_mass_kg", p.mode_mass_kg)
        .put("mode_frequency_Hz", p.mode_frequency_Hz)
        .put("mode_damping", p.mode_damping)
        .put("backlash_m", p.backlash_m)
        .put("spring_N_per_m", p.spring_N_per_m)
        .put("coupling", p.coupling)
        .put("ripple", p.ripple)
        .put("ripple_period_m", p.ripple_period_m)
        .put("ripple_phase_rad", p.ripple_phase_rad)
        .take();
}

inline nlohmann::ordered_json encoder_json(const encoder_description& e) {
    return machine_box()
        .put_unless_zero("resolution_m", e.resolution_m)
        .put("cyclic_m", e.cyclic_m)
        .put("cyclic_period_m", e.cyclic_period_m)
        .put("cyclic_phase_rad", e.cyclic_phase_rad)
        .take();
}

inline nlohmann::ordered_json actuator_json(const actuator_description& a) {
    machine_box box;
    box.put("limit_V", a.limit_V);
    if (a.dac_bits) box.put("dac_bits", nlohmann::ordered_json(*a.dac_bits));
    return box.put("dac_range_V", a.dac_range_V)
        .put("lag_s", a.lag_s)
        .put("drive_limit_V", a.drive_limit_V)
        .put("dead_zone_V", a.dead_zone_V)
        .put("loss_probability", a.loss_probability)
        .take();
}

inline nlohmann::ordered_json process_json(const process_description& p) {
    return machine_box()
        .put("fundamental_Hz", p.fundamental_Hz)
        .put("force_N", p.force_N)
        .put("phase_rad", p.phase_rad)
        .put("mean_N", p.mean_N)
        .take();
}

inline nlohmann::ordered_json controller_json(const controller_description& c) {
    const bool mean = c.velocity_estimator == controller_description::estimator::two_sample_mean;
    machine_box box;
    box.put("kind", nlohmann::ordered_json("cascade_p_pi"))
        .put("position_gain_per_s", c.position_gain_per_s)
        .put("velocity_gain_V_s_per_m", c.velocity_gain_V_s_per_m)
        .put("velocity_integral_V_per_m", c.velocity_integral_V_per_m);
    if (mean) box.put("velocity_estimator", nlohmann::ordered_json("two_sample_mean"));
    box.put_unless_zero("velocity_filter_Hz", c.velocity_filter_Hz)
        .put("velocity_feedforward", c.velocity_feedforward)
        .put("acceleration_feedforward_V_s2_per_m", c.acceleration_feedforward_V_s2_per_m)
        .put("viscous_feedforward_V_s_per_m", c.viscous_feedforward_V_s_per_m)
        .put("coulomb_feedforward_V", c.coulomb_feedforward_V);
    if (c.notch)
        box.put(
            "notch",
            machine_box().put("frequency_Hz", c.notch->frequency_Hz).put("damping", c.notch->damping).take());
    return box.take();
}

inline nlohmann::ordered_json axis_json(const axis_description& a) {
    nlohmann::ordered_json tolerance = nlohmann::ordered_json::object(), out = {{"plant", plant_json(a)}};
    for (const auto& [key, value] : a.tolerance.given)
        if (key != "force_constant" || a.command_unit != "N") tolerance[key] = value; // there 0 by definition
    const auto box = [&](const char* name, nlohmann::ordered_json content) {
        if (!content.empty()) out[name] = std::move(content);
    };
    box("tolerance", std::move(tolerance));
    box("encoder", encoder_json(a.encoder));
    box("actuator", actuator_json(a.actuator));
    box("process", process_json(a.process));
    if (a.controller) out["controller"] = controller_json(*a.controller);
    return out;
}

} // namespace detail

/// The machine file (FORMAT.md) of a description: read_machine() of it gives the description back, but for a controller
/// of unknown kind, of which a description holds nothing.
inline nlohmann::ordered_json to_json(const machine_description& m) {
    nlohmann::ordered_json out = {{"schema", "quadrant.machine/1"}, {"sample_period_s", m.sample_period_s}};
    if (!m.excluded_effects.empty()) out["excluded_effects"] = m.excluded_effects;
    auto& axes = out["axes"] = nlohmann::ordered_json::object();
    for (const axis_description& a : m.axes) axes[a.name] = detail::axis_json(a);
    return out;
}

} // namespace quadrant::diagnosis
