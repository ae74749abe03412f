// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>

namespace quadrant::inline v0 {

/// Where something may join an axis, in the order in which a command passes. What a law returns there:
///   command       added to the command [its unit]
///   motor_gain    relative change of the force constant
///   force         added force [N]
///   friction      relative change of the friction's level
///   transmission  displacement of the load against the motor [m]
///   reading       added to the encoder's reading [m]
enum class joint { command, motor_gain, force, friction, transmission, reading };
/// How many there are.
inline constexpr std::size_t joint_count = 6;

/// Where the axis is when a law at a joint is asked.
template <class Real = double> struct joint_point {
    Real position{0}, velocity{0}; ///< of the motor, in the middle of the step and before it [m], [m/s]
    Real command{0};               ///< that acts now, in its own unit
    Real time{0};                  ///< of the middle of the step [s]
    Real step{0};                  ///< length of the step [s], for a memory that integrates
};

/// Nothing at any joint: an axis of the listed laws alone.
struct no_joint_laws {
    struct state {};
    static constexpr bool at(joint) noexcept { return false; }
    template <class Real>
    constexpr Real operator()(joint, const joint_point<Real>&, const state&) const noexcept {
        return Real(0);
    }
};

} // namespace quadrant::inline v0
