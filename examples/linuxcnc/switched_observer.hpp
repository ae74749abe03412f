// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/observer/disturbance_observer.hpp>

namespace hal {

namespace signal = quadrant::signal;
using quadrant::duration;

/// An observer that can be off: it then watches and gives nothing, so that it knows the axis when it is
/// switched on.
class switched_observer : public quadrant::disturbance_observer<signal::voltage> {
    using observer = quadrant::disturbance_observer<signal::voltage>;

public:
    struct parameters : observer::parameters {
        double on = 0; ///< 0: off
    };
    switched_observer(const parameters& p, duration period) : observer(p, period), given_(p) {}
    value operator()(argument measured, value wanted) noexcept {
        return let(observer::operator()(measured, wanted));
    }
    value disturbance() const noexcept { return let(observer::disturbance()); }
    void retune(const switched_observer& next) noexcept {
        observer::retune(next);
        given_ = next.given_;
    }
    const parameters& given() const noexcept { return given_; }

private:
    value let(value d) const noexcept { return given_.on != 0 ? d : value(); }

    parameters given_;
};

} // namespace hal
