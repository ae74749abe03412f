// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cascade_p_pi.hpp"
#include "generalized_predictive.hpp"
#include "lead_lag.hpp"
#include "linuxcnc_pid.hpp"
#include "milling_axis.hpp"
#include "p_pi.hpp"
#include "p_velocity.hpp"
#include "pid.hpp"
#include "pole_placement.hpp"
#include "predictive.hpp"
#include "sliding_mode.hpp"
#include "state_feedback.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::span<const controller_kind* const> controller_kinds() {
    static constexpr const controller_kind* all[] = {
        &controllers::cascade_p_pi,
        &controllers::p_velocity,
        &controllers::milling_axis,
        &controllers::linuxcnc_pid,
        &controllers::pid,
        &controllers::p_pi,
        &controllers::sliding_mode,
        &controllers::lead_lag,
        &controllers::pole_placement,
        &controllers::zero_phase,
        &controllers::generalized_predictive,
        &controllers::state_feedback,
        &controllers::predictive,
    };
    return all;
}

} // namespace quadrant::inline v0::diagnosis
