// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../controller/cascade_p_pi.hpp"
#include "../controller/generalized_predictive.hpp"
#include "../controller/kinds.hpp"
#include "../controller/lead_lag.hpp"
#include "../controller/linuxcnc_pid.hpp"
#include "../controller/milling_axis.hpp"
#include "../controller/p_pi.hpp"
#include "../controller/p_velocity.hpp"
#include "../controller/pid.hpp"
#include "../controller/pole_placement.hpp"
#include "../controller/predictive.hpp"
#include "../controller/sliding_mode.hpp"
#include "../controller/state_feedback.hpp"

namespace quadrant::diagnosis {

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

} // namespace quadrant::diagnosis
