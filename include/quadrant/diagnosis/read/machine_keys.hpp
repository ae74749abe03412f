// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine.hpp"
#include "json_node.hpp"

#include <array>

/// The keys of a machine file. A new one is a line here (and in docs/schema/machine.schema.json).
namespace quadrant::diagnosis::detail {

namespace rule {
inline constexpr number_rule positive{"must be a number > 0", [](double x) { return x > 0; }};
inline constexpr number_rule not_negative{"must be a number >= 0", [](double x) { return x >= 0; }};
inline constexpr number_rule any_number{"must be a number", [](double) { return true; }};
inline constexpr number_rule up_to_a_second{"must be a number from 0 to 1 (seconds)",
                                            [](double x) { return x >= 0 && x <= 1; }};
inline constexpr number_rule asymmetry{"must be a number between -1 and 1 (relative)",
                                       [](double x) { return x > -1 && x < 1; }};
inline constexpr number_rule above_minus_one{"must be a number above -1 (relative)",
                                             [](double x) { return x > -1; }};
inline constexpr number_rule relative{"must be a number from 0 to below 1 (relative: 0.05 is 5 %)",
                                      [](double x) { return x >= 0 && x < 1; }};
inline constexpr number_rule bits{"must be a whole number from 1 to 32",
                                  [](double x) { return x >= 1 && x <= 32 && x == std::floor(x); }};
} // namespace rule

template <class Target> struct number_key {
    const char* name;
    number_rule rule;
    double& (*of)(Target&);
    bool needed = false;
};

inline constexpr std::array plant_keys{
    number_key<plant_description>{"mass_kg", rule::positive, [](auto& p) -> double& { return p.mass_kg; },
                                  true},
    number_key<plant_description>{"viscous_N_s_per_m", rule::not_negative,
                                  [](auto& p) -> double& { return p.viscous_N_s_per_m; }},
    number_key<plant_description>{"delay_s", rule::up_to_a_second,
                                  [](auto& p) -> double& { return p.delay_s; }},
    number_key<plant_description>{"coulomb_N", rule::not_negative,
                                  [](auto& p) -> double& { return p.coulomb_N.emplace(); }},
    number_key<plant_description>{"static_N", rule::not_negative,
                                  [](auto& p) -> double& { return p.static_N.emplace(); }},
    number_key<plant_description>{"stribeck_velocity_m_per_s", rule::positive,
                                  [](auto& p) -> double& { return p.stribeck_velocity_m_per_s.emplace(); }},
    number_key<plant_description>{"viscous_asymmetry", rule::asymmetry,
                                  [](auto& p) -> double& { return p.viscous_asymmetry.emplace(); }},
    number_key<plant_description>{"coulomb_asymmetry", rule::asymmetry,
                                  [](auto& p) -> double& { return p.coulomb_asymmetry.emplace(); }},
    number_key<plant_description>{"constant_force_N", rule::any_number,
                                  [](auto& p) -> double& { return p.constant_force_N.emplace(); }},
    number_key<plant_description>{"cogging_period_m", rule::positive,
                                  [](auto& p) -> double& { return p.cogging_period_m.emplace(); }},
    number_key<plant_description>{"presliding_length_m", rule::positive,
                                  [](auto& p) -> double& { return p.presliding_length_m.emplace(); }},
    number_key<plant_description>{"presliding_damping_s", rule::up_to_a_second,
                                  [](auto& p) -> double& { return p.presliding_damping_s.emplace(); }},
    number_key<plant_description>{"friction_position_amplitude", rule::asymmetry,
                                  [](auto& p) -> double& { return p.friction_position_amplitude.emplace(); }},
    number_key<plant_description>{"friction_position_period_m", rule::positive,
                                  [](auto& p) -> double& { return p.friction_position_period_m.emplace(); }},
    number_key<plant_description>{"friction_position_phase_rad", rule::any_number,
                                  [](auto& p) -> double& { return p.friction_position_phase_rad.emplace(); }},
    number_key<plant_description>{"friction_drift", rule::above_minus_one,
                                  [](auto& p) -> double& { return p.friction_drift.emplace(); }},
    number_key<plant_description>{"friction_drift_time_s", rule::positive,
                                  [](auto& p) -> double& { return p.friction_drift_time_s.emplace(); }},
    number_key<plant_description>{"mode_mass_kg", rule::positive,
                                  [](auto& p) -> double& { return p.mode_mass_kg.emplace(); }},
    number_key<plant_description>{"mode_frequency_Hz", rule::positive,
                                  [](auto& p) -> double& { return p.mode_frequency_Hz.emplace(); }},
    number_key<plant_description>{"mode_damping", rule::relative,
                                  [](auto& p) -> double& { return p.mode_damping.emplace(); }},
    number_key<plant_description>{"backlash_m", rule::not_negative,
                                  [](auto& p) -> double& { return p.backlash_m.emplace(); }},
    number_key<plant_description>{"spring_N_per_m", rule::any_number,
                                  [](auto& p) -> double& { return p.spring_N_per_m.emplace(); }},
    number_key<plant_description>{"coupling", rule::asymmetry,
                                  [](auto& p) -> double& { return p.coupling.emplace(); }},
    number_key<plant_description>{"ripple", rule::asymmetry,
                                  [](auto& p) -> double& { return p.ripple.emplace(); }},
    number_key<plant_description>{"ripple_period_m", rule::positive,
                                  [](auto& p) -> double& { return p.ripple_period_m.emplace(); }},
    number_key<plant_description>{"ripple_phase_rad", rule::any_number,
                                  [](auto& p) -> double& { return p.ripple_phase_rad.emplace(); }},
};
inline constexpr std::array<std::string_view, 6> plant_other_keys{
    "force_constant_N_per_V", "force_constant_N_per_A", "cogging_N", "cogging_phase_rad", "gms_weights",
    "gms_stiffness_N_per_m"};

inline constexpr std::array controller_keys_of_file{
    number_key<controller_description>{"position_gain_per_s", rule::not_negative,
                                       [](auto& c) -> double& { return c.position_gain_per_s; }, true},
    number_key<controller_description>{"velocity_gain_V_s_per_m", rule::not_negative,
                                       [](auto& c) -> double& { return c.velocity_gain_V_s_per_m; }, true},
    number_key<controller_description>{"velocity_integral_V_per_m", rule::not_negative,
                                       [](auto& c) -> double& { return c.velocity_integral_V_per_m; }},
    number_key<controller_description>{"velocity_filter_Hz", rule::positive,
                                       [](auto& c) -> double& { return c.velocity_filter_Hz; }},
    number_key<controller_description>{"velocity_feedforward", rule::any_number,
                                       [](auto& c) -> double& { return c.velocity_feedforward; }},
    number_key<controller_description>{
        "acceleration_feedforward_V_s2_per_m", rule::any_number,
        [](auto& c) -> double& { return c.acceleration_feedforward_V_s2_per_m; }},
    number_key<controller_description>{"viscous_feedforward_V_s_per_m", rule::any_number,
                                       [](auto& c) -> double& { return c.viscous_feedforward_V_s_per_m; }},
    number_key<controller_description>{"coulomb_feedforward_V", rule::any_number,
                                       [](auto& c) -> double& { return c.coulomb_feedforward_V; }},
};
inline constexpr std::array<std::string_view, 3> controller_other_keys{"kind", "velocity_estimator", "notch"};

inline constexpr std::array notch_keys{
    number_key<notch_description>{"frequency_Hz", rule::positive,
                                  [](auto& n) -> double& { return n.frequency_Hz; }, true},
    number_key<notch_description>{"damping", rule::positive, [](auto& n) -> double& { return n.damping; },
                                  true},
};

inline constexpr std::array actuator_keys{
    number_key<actuator_description>{"limit_V", rule::positive,
                                     [](auto& a) -> double& { return a.limit_V.emplace(); }},
    number_key<actuator_description>{"dac_range_V", rule::positive,
                                     [](auto& a) -> double& { return a.dac_range_V.emplace(); }},
    number_key<actuator_description>{"lag_s", rule::up_to_a_second,
                                     [](auto& a) -> double& { return a.lag_s.emplace(); }},
    number_key<actuator_description>{"drive_limit_V", rule::positive,
                                     [](auto& a) -> double& { return a.drive_limit_V.emplace(); }},
    number_key<actuator_description>{"dead_zone_V", rule::not_negative,
                                     [](auto& a) -> double& { return a.dead_zone_V.emplace(); }},
    number_key<actuator_description>{"loss_probability", rule::relative,
                                     [](auto& a) -> double& { return a.loss_probability.emplace(); }},
};
inline constexpr std::array<std::string_view, 1> actuator_other_keys{"dac_bits"};

inline constexpr std::array encoder_keys{
    number_key<encoder_description>{"resolution_m", rule::not_negative,
                                    [](auto& e) -> double& { return e.resolution_m; }},
    number_key<encoder_description>{"cyclic_m", rule::any_number,
                                    [](auto& e) -> double& { return e.cyclic_m.emplace(); }},
    number_key<encoder_description>{"cyclic_period_m", rule::positive,
                                    [](auto& e) -> double& { return e.cyclic_period_m.emplace(); }},
    number_key<encoder_description>{"cyclic_phase_rad", rule::any_number,
                                    [](auto& e) -> double& { return e.cyclic_phase_rad.emplace(); }},
};

inline constexpr std::array process_keys{
    number_key<process_description>{"fundamental_Hz", rule::positive,
                                    [](auto& p) -> double& { return p.fundamental_Hz.emplace(); }},
    number_key<process_description>{"mean_N", rule::any_number,
                                    [](auto& p) -> double& { return p.mean_N.emplace(); }},
};
inline constexpr std::array<std::string_view, 2> process_other_keys{"force_N", "phase_rad"};

inline constexpr std::array<std::string_view, 6> axis_keys{"plant",    "tolerance",  "encoder",
                                                           "actuator", "controller", "process"};
inline constexpr std::array<std::string_view, 4> machine_file_keys{"schema", "sample_period_s",
                                                                   "excluded_effects", "axes"};

/// Names under `tolerance`, each with the value that it is the tolerance of; null where no value is described.
struct tolerance_key {
    std::string_view name;
    double (*of)(const plant_description&);
};
inline constexpr std::array tolerance_keys{
    tolerance_key{"mass", [](auto& p) { return p.mass_kg; }},
    tolerance_key{"force_constant", [](auto& p) { return p.force_constant_N_per_V; }},
    tolerance_key{"viscous", [](auto& p) { return p.viscous_N_s_per_m; }},
    tolerance_key{"delay", [](auto& p) { return p.delay_s; }},
    tolerance_key{"coulomb", [](auto& p) { return p.coulomb_N.value_or(0); }},
    tolerance_key{"static", [](auto& p) { return p.static_N.value_or(0); }},
    tolerance_key{"stribeck_velocity", [](auto& p) { return p.stribeck_velocity_m_per_s.value_or(0); }},
    tolerance_key{"viscous_asymmetry", [](auto& p) { return p.viscous_asymmetry.value_or(0); }},
    tolerance_key{"coulomb_asymmetry", [](auto& p) { return p.coulomb_asymmetry.value_or(0); }},
    tolerance_key{"constant_force", [](auto& p) { return p.constant_force_N.value_or(0); }},
    tolerance_key{"cogging_period", [](auto& p) { return p.cogging_period_m.value_or(0); }},
    tolerance_key{"cogging", [](auto& p) { return p.cogging_N.empty() ? 0.0 : p.cogging_N.front(); }},
};

} // namespace quadrant::diagnosis::detail
