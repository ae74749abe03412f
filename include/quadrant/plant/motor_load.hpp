// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <concepts>

namespace quadrant::inline v0 {

/// Nothing: the mass feels motor and external force as they are.
struct no_load {
    struct parameters {};
    no_load(const parameters&, duration) {}
};

/// What stands between motor and mass: from where the mass is, the motor's force and the external one, the
/// force that drives the mass. Made like a block, for the length of a sub-step, and asked once in each, so it
/// may have a state.
template <class L, class Real>
concept motor_load = std::same_as<L, no_load> ||
    (requires(L l, quantity_of<signal::position, Real> x, quantity_of<signal::force, Real> motor,
              quantity_of<signal::force, Real> external) {
        typename L::parameters;
        { l(x, motor, external) } -> std::same_as<quantity_of<signal::force, Real>>;
        l.reset();
    });

} // namespace quadrant::inline v0
