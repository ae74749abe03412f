// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "logs.hpp"
#include "quadrant/diagnosis/effect/effect_list.hpp"
#include "random.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

/// How the effects of the list get into the trial's machines. Each record says what an amplitude does to the
/// numbers under the machine file's keys; where these numbers are in this simulator stands here.
namespace quadrant_gap::trial {

using quadrant::diagnosis::effect_named;
using surroundings = quadrant::diagnosis::trial_scale;

namespace detail {

/// The number of a machine behind a key; null: this simulator has none.
inline double* number_in(axis_truth& a, std::string_view key) {
    const std::pair<std::string_view, double*> all[] = {
        {"mass_kg", &a.mechanics.mass},
        {"force_constant_N_per_V", &a.actuator.force_constant},
        {"delay_s", &a.actuator.delay},
        {"viscous_N_s_per_m", &a.friction.viscous},
        {"coulomb_N", &a.friction.coulomb},
        {"static_N", &a.friction.level_at_rest},
        {"stribeck_velocity_m_per_s", &a.friction.stribeck_velocity},
        {"presliding_length_m", &a.friction.length},
        {"viscous_asymmetry", &a.friction.viscous_asymmetry},
        {"coulomb_asymmetry", &a.friction.coulomb_asymmetry},
        {"friction_position_period_m", &a.friction.along.period},
        {"friction_drift", &a.friction.drift},
        {"friction_drift_time_s", &a.friction.drift_time},
        {"load_friction", &a.friction.load},
        {"mode_mass_kg", &a.mechanics.mode_mass},
        {"mode_frequency_Hz", &a.mechanics.mode_frequency},
        {"mode_damping", &a.mechanics.mode_damping},
        {"backlash_m", &a.mechanics.backlash},
        {"constant_force_N", &a.mechanics.constant_force},
        {"spring_N_per_m", &a.mechanics.spring},
        {"coupling", &a.mechanics.coupling},
        {"gravity_torque_Nm", &a.mechanics.gravity},
        {"gravity_phase_rad", &a.mechanics.gravity_phase},
        {"payload.mass_kg", &a.mechanics.payload.mass},
        {"payload.arm_m", &a.mechanics.payload.arm},
        {"cogging_period_m", &a.mechanics.cogging.period},
        {"ripple_period_m", &a.actuator.ripple.period},
        {"actuator.lag_s", &a.actuator.lag},
        {"actuator.drive_limit_V", &a.actuator.drive_limit},
        {"actuator.dead_zone_V", &a.actuator.dead_zone},
        {"actuator.loss_probability", &a.actuator.loss},
        {"encoder.resolution_m", &a.encoder.resolution},
        {"encoder.cyclic_period_m", &a.encoder.cyclic.period},
        {"process.fundamental_Hz", &a.process.fundamental},
        {"process.mean_N", &a.process.mean},
        {"drive.velocity_per_V", &a.drive.velocity_per_V},
        {"drive.velocity_gain_N_s_per_m", &a.drive.velocity_gain},
        {"drive.velocity_integral_N_per_m", &a.drive.velocity_integral},
        {"drive.position_gain_per_s", &a.drive.position_gain},
        {"drive.position_gain_per_m", &a.drive.duty_gain},
        {"drive.force_limit_N", &a.drive.force_limit},
        {"drive.maximum_duty", &a.drive.maximum_duty},
        {"drive.minimum_duty", &a.drive.minimum_duty},
        {"drive.supply_V", &a.drive.supply},
        {"drive.setpoint_rate_limit_m_per_s", &a.drive.rate_limit},
        {"drive.command_delay_s", &a.drive.delay},
        {"drive.set_point_loss", &a.drive.loss},
        {"drive.clock_slip", &a.drive.clock_slip},
    };
    for (const auto& [name, place] : all)
        if (name == key) return place;
    return nullptr;
}
/// The harmonics behind a key; null: there are none.
inline std::vector<double>* harmonics_in(axis_truth& a, std::string_view key) {
    const std::pair<std::string_view, std::vector<double>*> all[] = {
        {"friction_position_amplitude", &a.friction.along.size},
        {"friction_position_phase_rad", &a.friction.along.phase},
        {"cogging_N", &a.mechanics.cogging.size},
        {"cogging_phase_rad", &a.mechanics.cogging.phase},
        {"ripple", &a.actuator.ripple.size},
        {"ripple_phase_rad", &a.actuator.ripple.phase},
        {"encoder.cyclic_m", &a.encoder.cyclic.size},
        {"encoder.cyclic_phase_rad", &a.encoder.cyclic.phase},
        {"process.force_N", &a.process.size},
        {"process.phase_rad", &a.process.phase},
    };
    for (const auto& [name, place] : all)
        if (name == key) return place;
    return nullptr;
}
/// The number of an effect's law, which joins the machine; null: no law of the list has this key.
inline double* law_number_in(axis_truth& a, std::string_view key) {
    for (const auto* e : quadrant::diagnosis::every_effect()) {
        if (!e->law || e->law->index_of(key) == e->law->count()) continue;
        const auto is = [&](const law_truth& l) { return l.law == e->law; };
        auto found = std::find_if(a.laws.begin(), a.laws.end(), is);
        if (found == a.laws.end()) found = a.laws.insert(found, {e->law, {}});
        return &found->values[e->law->index_of(key)];
    }
    return nullptr;
}

} // namespace detail

/// What an effect does to a machine. The dice are thrown the same way at every amplitude: only the amplitude
/// differs.
class insertion final : public quadrant::diagnosis::trial_machine {
public:
    insertion(axis_truth& real, const axis_truth& as_described, double size, dice throws,
              const surroundings& scale)
        : trial_machine(size, scale), truth(real), random(throws), described_(as_described) {}

    axis_truth& truth;
    dice random;
    nlohmann::ordered_json parameters =
        nlohmann::ordered_json::object(); ///< true values under the machine keys

    double described(std::string_view key) const override {
        axis_truth a = described_;
        const double* place = detail::number_in(a, key);
        return place ? *place : 0;
    }
    double now(std::string_view key) const override {
        const double* place = detail::number_in(truth, key);
        return place ? *place : 0;
    }
    void set(std::string_view key, double value) override {
        put(key, {value});
        parameters[std::string(key)] = value;
    }
    void set(std::string_view key, const std::vector<double>& values) override {
        put(key, values);
        parameters[std::string(key)] = values.front();
    }
    void set_untold(std::string_view key, const std::vector<double>& values) override { put(key, values); }
    void change_controller() override;
    using trial_machine::uniform;
    double uniform() override { return random.uniform(); }

    /// What this simulator does otherwise than the law of the candidates, once the effect is in.
    void vary(std::string_view effect) {
        auto& f = truth.friction;
        if (effect == "presliding_friction" && f.law == contact_law::tanh_spring)
            f.law = contact_law::maxwell_slip; // that one barely remembers
        if (effect != "stribeck_friction") return;
        if (truth.turns) f.stribeck_velocity *= radians_for_a_metre;
        const double form = random.uniform();
        f.shape = form < 0.5    ? stribeck_shape::exponential
                  : form < 0.75 ? stribeck_shape::gaussian
                                : stribeck_shape::lorentzian;
        if (f.shape != stribeck_shape::exponential) parameters.clear(); // its numbers mean something else
    }

private:
    void put(std::string_view key, const std::vector<double>& values) {
        if (auto* harmonics = detail::harmonics_in(truth, key)) {
            *harmonics = values;
        } else {
            double* number = detail::number_in(truth, key);
            if (!number) number = detail::law_number_in(truth, key);
            if (!number) throw std::logic_error("the trial's machines have no " + std::string(key));
            *number = values.front();
        }
        keep_level_at_rest(truth.friction);
    }
    const axis_truth& described_;
};

inline void insertion::change_controller() {
    controller_truth& c = truth.controller;
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
    const key& chosen = random.one_of(keys);
    *chosen.value = changed(*chosen.value);
    parameters[std::string("controller.") + chosen.name] = *chosen.value;
}

/// Whether a machine with this kind of drive can have the effect, and a log of this kind shows it. Behind a
/// drive that closes loops of its own there is one axis, and its encoder is the motor's: no play, no error of a
/// scale, no neighbour, and the limits and delays are the drive's. Its force constant shows where its current
/// is measured.
inline bool fits(const quadrant::diagnosis::effect& e, quadrant::diagnosis::drive_kind kind,
                 logs how = logs::plain) {
    using enum quadrant::diagnosis::drive_kind;
    if (e.rotary_only) return false; // of a joint alone
    if (kind == current) return e.box != "drive" && shows(how, e);
    if (e.name == "force_constant") return kind == position_servo || how == logs::measured;
    if (e.box == "process") return true;
    if (e.box == "mechanics") return e.name != "backlash" && e.name != "cross_coupling";
    if (e.box != "drive") return false;
    if (e.name == "drive_gain" || e.name == "drive_limit" || e.name == "command_delay") return true;
    if (e.name == "set_point_loss" || e.name == "clock_slip") return kind != velocity;
    return kind == position_servo;
}

/// The effects that a trial withholds from machines with such drives, in the order of the list.
inline std::vector<const quadrant::diagnosis::effect*>
withheld_effects(quadrant::diagnosis::drive_kind kind = quadrant::diagnosis::drive_kind::current,
                 logs how = logs::plain) {
    std::vector<const quadrant::diagnosis::effect*> out;
    for (const auto* e : quadrant::diagnosis::every_effect())
        if (e->trial.into && fits(*e, kind, how)) out.push_back(e);
    return out;
}

/// The effects of a joint of an arm with gears, in the order of the list.
inline std::vector<const quadrant::diagnosis::effect*> effects_of_a_joint() {
    constexpr std::array<std::string_view, 12> of_joints{
        "coulomb_friction", "viscous_friction", "stribeck_friction", "load_friction",  "mass",
        "gravity",          "payload_mass",     "arm_length",        "constant_force", "cogging",
        "force_constant",   "time_delay"};
    std::vector<const quadrant::diagnosis::effect*> out;
    for (const auto* e : quadrant::diagnosis::every_effect())
        if (e->trial.into && std::find(of_joints.begin(), of_joints.end(), e->name) != of_joints.end())
            out.push_back(e);
    return out;
}

} // namespace quadrant_gap::trial
