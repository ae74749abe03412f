// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine.hpp"
#include "json_keys.hpp"

/// The keys of a machine file. A new one is a line here (and in docs/schema/machine.schema.json).
namespace quadrant::diagnosis::detail {

inline constexpr std::array plant_keys{
    number_key<plant_description>{"mass_kg", rule::positive, &plant_description::mass_kg, true},
    number_key<plant_description>{"viscous_N_s_per_m", rule::not_negative,
                                  &plant_description::viscous_N_s_per_m},
    number_key<plant_description>{"delay_s", rule::up_to_a_second, &plant_description::delay_s},
    number_key<plant_description>{"coulomb_N", rule::not_negative, &plant_description::coulomb_N},
    number_key<plant_description>{"static_N", rule::not_negative, &plant_description::static_N},
    number_key<plant_description>{"stribeck_velocity_m_per_s", rule::positive,
                                  &plant_description::stribeck_velocity_m_per_s},
    number_key<plant_description>{"viscous_asymmetry", rule::asymmetry, &plant_description::viscous_asymmetry},
    number_key<plant_description>{"coulomb_asymmetry", rule::asymmetry, &plant_description::coulomb_asymmetry},
    number_key<plant_description>{"constant_force_N", rule::any_number, &plant_description::constant_force_N},
    number_key<plant_description>{"cogging_period_m", rule::positive, &plant_description::cogging_period_m},
    number_key<plant_description>{"presliding_length_m", rule::positive,
                                  &plant_description::presliding_length_m},
    number_key<plant_description>{"presliding_damping_s", rule::up_to_a_second,
                                  &plant_description::presliding_damping_s},
    number_key<plant_description>{"friction_position_amplitude", rule::asymmetry,
                                  &plant_description::friction_position_amplitude},
    number_key<plant_description>{"friction_position_period_m", rule::positive,
                                  &plant_description::friction_position_period_m},
    number_key<plant_description>{"friction_position_phase_rad", rule::any_number,
                                  &plant_description::friction_position_phase_rad},
    number_key<plant_description>{"friction_drift", rule::above_minus_one, &plant_description::friction_drift},
    number_key<plant_description>{"friction_drift_time_s", rule::positive,
                                  &plant_description::friction_drift_time_s},
    number_key<plant_description>{"mode_mass_kg", rule::positive, &plant_description::mode_mass_kg},
    number_key<plant_description>{"mode_frequency_Hz", rule::positive, &plant_description::mode_frequency_Hz},
    number_key<plant_description>{"mode_damping", rule::relative, &plant_description::mode_damping},
    number_key<plant_description>{"backlash_m", rule::not_negative, &plant_description::backlash_m},
    number_key<plant_description>{"spring_N_per_m", rule::any_number, &plant_description::spring_N_per_m},
    number_key<plant_description>{"coupling", rule::asymmetry, &plant_description::coupling},
    number_key<plant_description>{"ripple", rule::asymmetry, &plant_description::ripple},
    number_key<plant_description>{"ripple_period_m", rule::positive, &plant_description::ripple_period_m},
    number_key<plant_description>{"ripple_phase_rad", rule::any_number, &plant_description::ripple_phase_rad},
};
inline constexpr std::array<std::string_view, 6> plant_other_keys{
    "force_constant_N_per_V", "force_constant_N_per_A", "cogging_N", "cogging_phase_rad", "gms_weights",
    "gms_stiffness_N_per_m"};

inline constexpr std::array actuator_keys{
    number_key<actuator_description>{"limit_V", rule::positive, &actuator_description::limit_V},
    number_key<actuator_description>{"dac_range_V", rule::positive, &actuator_description::dac_range_V},
    number_key<actuator_description>{"lag_s", rule::up_to_a_second, &actuator_description::lag_s},
    number_key<actuator_description>{"drive_limit_V", rule::positive, &actuator_description::drive_limit_V},
    number_key<actuator_description>{"dead_zone_V", rule::not_negative, &actuator_description::dead_zone_V},
    number_key<actuator_description>{"loss_probability", rule::relative,
                                     &actuator_description::loss_probability},
};
inline constexpr std::array<std::string_view, 1> actuator_other_keys{"dac_bits"};

inline constexpr std::array encoder_keys{
    number_key<encoder_description>{"resolution_m", rule::not_negative, &encoder_description::resolution_m},
    number_key<encoder_description>{"cyclic_m", rule::any_number, &encoder_description::cyclic_m},
    number_key<encoder_description>{"cyclic_period_m", rule::positive, &encoder_description::cyclic_period_m},
    number_key<encoder_description>{"cyclic_phase_rad", rule::any_number,
                                    &encoder_description::cyclic_phase_rad},
};

inline constexpr std::array process_keys{
    number_key<process_description>{"fundamental_Hz", rule::positive, &process_description::fundamental_Hz},
    number_key<process_description>{"mean_N", rule::any_number, &process_description::mean_N},
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

/// The keys of one box of an axis, by their linear names.
inline std::vector<std::string_view> keys_of_box(std::string_view box) {
    std::vector<std::string_view> out;
    const auto add = [&](const auto& names) { out.insert(out.end(), names.begin(), names.end()); };
    if (box == "plant") add(names_of(plant_keys)), add(plant_other_keys);
    if (box == "tolerance") add(names_of(tolerance_keys));
    if (box == "encoder") add(names_of(encoder_keys));
    if (box == "actuator") add(names_of(actuator_keys));
    if (box == "process") add(names_of(process_keys)), add(process_other_keys);
    return out;
}

} // namespace quadrant::diagnosis::detail
