// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/observer/disturbance_observer.hpp>

#include <algorithm>
#include <numbers>

namespace hal {

namespace signal = quadrant::signal;
using quadrant::duration;

/// An observer that can be off: it then gives nothing.
class switched_observer : public quadrant::disturbance_observer<signal::voltage> {
    using observer = quadrant::disturbance_observer<signal::voltage>;

public:
    struct parameters : observer::parameters {
        double on = 0; ///< 0: off. A number, so that there are no bytes between the fields (see hal_axis::same)
    };
    switched_observer(const parameters& p, duration period) : observer(p, period), given_(p) {}
    value operator()(argument measured, value wanted) noexcept {
        return given_.on != 0 ? observer::operator()(measured, wanted) : value();
    }
    void applied(value u) noexcept {
        if (given_.on != 0) observer::applied(u);
    }
    /// Moving at v with u acting against d: the steps that forget how it began.
    void settle_moving(argument x, quadrant::quantity_of<signal::velocity> v, value u, value d,
                       duration period) noexcept {
        const double forgets = 12 / (2 * std::numbers::pi * (given_.corner * period).value());
        const int steps = static_cast<int>(std::min(forgets, 2000.0)) + 1;
        settle(x - v * period * double(steps), d);
        for (int i = 1 - steps; given_.on != 0 && i <= 0; ++i) {
            observer::operator()(x + v * period * double(i), u + d);
            observer::applied(u);
        }
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
};

} // namespace hal
