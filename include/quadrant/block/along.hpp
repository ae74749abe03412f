// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/units.hpp"

#include <concepts>

namespace quadrant::inline v0 {

/// Names of the axes, for the compiler.
struct x_direction {};
struct y_direction {};

/// A quantity that belongs to one axis. It is read as a plain one; a plain one becomes it only by name,
/// `on_x(u)`, and one
/// of the other axis never: two axes cannot change places unseen.
template <class Axis, class Quantity> class along {
public:
    constexpr along() = default;
    constexpr explicit along(const Quantity& q) : q_(q) {}
    template <class Other, class Q>
    requires(!std::same_as<Other, Axis>) along(const along<Other, Q>&)
    = delete; // of the other axis

    constexpr operator Quantity() const { return q_; }
    constexpr const Quantity& plain() const noexcept { return q_; }

private:
    Quantity q_{};
};
template <class Unit, class Real> constexpr auto on_x(const quantity<Unit, Real>& q) {
    return along<x_direction, quantity<Unit, Real>>(q);
}
template <class Unit, class Real> constexpr auto on_y(const quantity<Unit, Real>& q) {
    return along<y_direction, quantity<Unit, Real>>(q);
}
template <class Unit, class Real> void on_x(const along<y_direction, quantity<Unit, Real>>&) = delete;
template <class Unit, class Real> void on_y(const along<x_direction, quantity<Unit, Real>>&) = delete;

/// One quantity of each axis.
template <class Quantity> struct xy {
    along<x_direction, Quantity> x;
    along<y_direction, Quantity> y;
};

} // namespace quadrant::inline v0
