// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/select.hpp"
#include "../friction/already_checked.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// The current loop of an amplifier as one lag: what the motor gets of a command that is held for a step, on
/// average over it.
///   di/dt = (u - i)/lag,   out = mean of i over the step h, exact
/// Ports: command u in, mean current out, both in the command's unit.
/// State: the current at the end of the step; given and returned by the caller, as of `slip_contact`.
/// Range: lag >= 0; 0: out = u. Runs in lanes.
/// Throws "amplifier_lag.lag = ...: must be finite and not below 0".
/// Cost: 2 multiplications. A lag on a sampled wire: `lowpass`.
template <class Real = double> class amplifier_lag {
public:
    using number = parameter_real<Real>; ///< of parameters

    /// Time constant of the current loop.
    struct parameters {
        quantity<si::time, number> lag{}; ///< >= 0
    };

    amplifier_lag(const parameters& p, Real h) : amplifier_lag(checked(p), h, already_checked()) {}
    amplifier_lag(const parameters& p, Real h, already_checked) {
        using std::exp;
        const Real lag = in_real<Real>(p.lag).value();
        const auto lags = greater(lag, Real(0));
        const Real steps = select(lags, h / select(lags, lag, Real(1)), Real(1));
        const Real left = exp(-steps);
        left_ = select(lags, left, Real(0));
        mean_ = select(lags, (Real(1) - left) / steps, Real(0));
        present_ = any(lags);
    }
    /// False when no lane has a lag.
    bool present() const noexcept { return present_; }
    Real operator()(Real& current, Real command) const noexcept {
        const Real from = current - command;
        current = command + from * left_;
        return command + from * mean_;
    }

private:
    static const parameters& checked(const parameters& p) {
        require_not_negative<Real>("amplifier_lag.lag", p.lag);
        return p;
    }

    Real left_{0}, mean_{0};
    bool present_ = false;
};

} // namespace quadrant::inline v0
