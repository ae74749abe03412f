// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <concepts>

namespace quadrant::inline v0 {

/// What a trajectory asks of one axis at one moment.
template <class Real = double> struct axis_motion {
    quantity_of<signal::position, Real> position{};
    quantity_of<signal::velocity, Real> velocity{};
    quantity_of<signal::acceleration, Real> acceleration{};
};

/// Any struct of these three, such as `milling_axis<...>::motion`.
template <class M>
concept motion_sample = std::default_initializable<M> && requires(const M& m) {
    typename decltype(M::position)::value_type;
    requires std::same_as<decltype(M::position),
                          quantity_of<signal::position, typename decltype(M::position)::value_type>>;
    requires std::same_as<decltype(M::velocity),
                          quantity_of<signal::velocity, typename decltype(M::position)::value_type>>;
    requires std::same_as<decltype(M::acceleration),
                          quantity_of<signal::acceleration, typename decltype(M::position)::value_type>>;
};

} // namespace quadrant::inline v0
