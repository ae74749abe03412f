// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "periodic.hpp"

#include <complex>
#include <cstddef>

namespace quadrant::inline v0 {

/// A force constant that varies with the magnets: what the motor gives of what is asked, along the travel.
///   y = u (1 + sum_{i=1..Harmonics} size_i sin(2 pi i x / period + phase_i))
/// Source: docs/formats.md (effect force_ripple: ripple, ripple_period_m, ripple_phase_rad), the same signs.
/// Ports: ripple(u, x), command or force in and out, the same signal, and the position [m]; ripple(u) stays
/// where it was.
/// State: the position; `reset`: zero; `settle(u)` where it is.
/// Range: the sizes, a share of the force, sum up to less than one.
/// NaN and infinities in u or x: holds the last output, keeps the position, raises faulted().
/// Throws "force_ripple.<field> = ...: must ..." for period, size, phase and "force_ripple.sample_period".
/// Cost: one sine, one cosine, 6 multiplications per harmonic. In a plant: as `ripple` of `axis_load`, in every
/// sub-step. A
/// force without command: `cogging_force`.
template <signal_tag Signal = signal::force, std::size_t Harmonics = 1, class Real = double>
class force_ripple {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using position = quantity_of<signal::position, Real>;
    using number = parameter_real<Real>; ///< of parameters

    using parameters = periodic<signal::number, Harmonics, number>;
    /// Where the axis was when it was last told; a call with a command alone takes this place.
    struct state {
        quantity_of<signal::position, Real> position{};
    };

    force_ripple(const parameters& p, duration sample_period) : given_(p), sum_("force_ripple", p) {
        require_positive<Real>("force_ripple.sample_period", sample_period);
        double most = 0;
        for (const auto& each : p.size) most += std::abs(detail::plain(each));
        require(most < 1, "force_ripple.size", most, "must sum up to less than 1");
    }

    value operator()(value u) noexcept { return (*this)(u, state_.position); }
    value operator()(value u, position x) noexcept {
        const value y = u * gain(x);
        if (!finite(u, x, y)) return out_.hold();
        state_.position = x;
        return out_.keep(y);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(value u) noexcept {
        const value y = u * gain(state_.position);
        finite(u, y) ? out_.reset(y) : out_.raise();
    }

    /// As long as the axis stays where it is.
    std::complex<double> response(frequency) const { return detail::plain(gain(state_.position)); }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    Real gain(position x) const noexcept { return Real(1) + Real(sum_(x).value()); }

    parameters given_;
    detail::periodic_sum<signal::number, Harmonics, Real> sum_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
