// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// Watches how far the axis is from where it shall be, and trips when that is too far for too long.
///   y = |e| / (window + per_speed |v|);   y > warning: warns;   y > 1 for longer than patience: trips
/// Source: LinuxCNC MIN_FERROR and FERROR: window = MIN_FERROR, per_speed = (FERROR - MIN_FERROR) / maximum
/// speed, nearly.
/// Ports: position error and the speed of the reference in, share of the window out: 1 is the limit.
/// State: since when, and the latch; `reset` and `settle(e, v)` clear it. tripped() stays until then, warns()
/// follows.
/// Range: window > 0, per_speed >= 0, 0 < warning <= 1, patience >= 0 (0: the first sample beyond trips). Reset
/// it while the
/// axis is off: an axis without power may be anywhere.
/// NaN and infinities: holds the last output, raises faulted() and so tripped(): an axis that cannot be seen
/// has to stop. Throws "following_error.<field> = ...: must ..." for period, window, per_speed, warning,
/// patience.
/// Cost: 1 multiplication, 1 division. To stop the axis: `axis_enable`.
template <class Real = double> class following_error {
public:
    using input = signal::position;
    using output = signal::number;
    using argument = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using value = quantity_of<signal::number, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The window at rest and with speed, and how long the axis may be beyond it.
    struct parameters {
        quantity<si::length, number> window;  ///< at rest, > 0
        quantity<si::time, number> per_speed; ///< how much wider it gets with speed, >= 0
        double warning = 0.5;                 ///< share of the window, 0 ... 1
        duration patience{};                  ///< >= 0
    };
    /// For how long the axis has been beyond the window, and what that has led to.
    struct state {
        std::size_t beyond = 0; ///< samples on end
        bool tripped = false, warns = false;
    };

    following_error(const parameters& p, duration period)
        : given_(p), window_(in_real<Real>(p.window)), per_speed_(in_real<Real>(p.per_speed)) {
        require_positive<Real>("following_error.period", period);
        require_positive<Real>("following_error.window", p.window);
        require_not_negative<Real>("following_error.per_speed", p.per_speed);
        require(p.warning > 0 && p.warning <= 1, "following_error.warning", p.warning,
                "must lie above 0 and not above 1");
        require_not_negative<Real>("following_error.patience", p.patience);
        patience_ = std::size_t(std::ceil(p.patience.value() / period.value() * (1 - 1e-12)));
    }

    value operator()(argument error, velocity speed) noexcept {
        const argument limit = window_ + per_speed_ * (speed < velocity() ? -speed : speed);
        const value share = (error < argument() ? -error : error) / limit;
        if (!finite(limit, share)) return out_.hold();
        state_.warns = detail::plain(share) > given_.warning;
        state_.beyond = detail::plain(share) > 1 ? state_.beyond + 1 : 0;
        state_.tripped = state_.tripped || state_.beyond > patience_;
        return out_.keep(share);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(argument error, velocity speed) noexcept {
        auto fresh = *this;
        fresh.reset();
        const value share = fresh(error, speed);
        if (fresh.faulted()) return out_.raise();
        state_ = {};
        out_.reset(share);
    }

    bool tripped() const noexcept { return state_.tripped || out_.faulted(); }
    bool warns() const noexcept { return state_.warns; }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    parameters given_;
    argument window_;
    quantity<si::time, Real> per_speed_;
    std::size_t patience_ = 0;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
