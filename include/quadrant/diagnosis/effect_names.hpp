// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <string_view>

namespace quadrant::diagnosis {

/// An effect as files call it, and the box of the loop that it lives in.
struct effect_name {
    std::string_view name, box;
};

/// Every effect that a file may speak of, whether or not this version can simulate it. The list is FORMAT.md's.
inline constexpr std::array effect_names{
    effect_name{"coulomb_friction", "mechanics"},
    effect_name{"viscous_friction", "mechanics"},
    effect_name{"stribeck_friction", "mechanics"},
    effect_name{"presliding_friction", "mechanics"},
    effect_name{"asymmetric_friction", "mechanics"},
    effect_name{"position_dependent_friction", "mechanics"},
    effect_name{"friction_drift", "mechanics"},
    effect_name{"mass", "mechanics"},
    effect_name{"structural_resonance", "mechanics"},
    effect_name{"backlash", "mechanics"},
    effect_name{"constant_force", "mechanics"},
    effect_name{"position_spring", "mechanics"},
    effect_name{"cross_coupling", "mechanics"},
    effect_name{"cogging", "mechanics"},
    effect_name{"force_ripple", "actuator"},
    effect_name{"force_constant", "actuator"},
    effect_name{"time_delay", "actuator"},
    effect_name{"actuator_lag", "actuator"},
    effect_name{"actuator_saturation", "actuator"},
    effect_name{"actuator_dead_zone", "actuator"},
    effect_name{"sample_loss", "actuator"},
    effect_name{"encoder_quantization", "sensor"},
    effect_name{"encoder_cyclic_error", "sensor"},
    effect_name{"cutting_force", "process"},
    effect_name{"controller_mismatch", "controller"},
};

} // namespace quadrant::diagnosis
