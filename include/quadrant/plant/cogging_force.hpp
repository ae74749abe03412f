// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "periodic.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// The pull of the magnets on the iron: a force that depends on the position alone, command or not.
///   F = sum_{i=1..Harmonics} size_i sin(2 pi i x / period + phase_i)
/// Source: docs/formats.md (effect cogging: cogging_period_m, cogging_N, cogging_phase_rad), the same signs.
/// Ports: position [m] in, force on the axis [N] out; positive pushes forward.
/// State: none; `reset` and `settle` set the held output and clear the fault. With phases, F(0) is not zero.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "cogging_force.<field> = ...: must ..." for period, size, phase and "cogging_force.sample_period".
/// Cost: one sine, one cosine, 6 multiplications per harmonic. In a plant: as `cogging` of `axis_load`, in
/// every sub-step. A
/// force that grows with the command: `force_ripple`.
template <std::size_t Harmonics = 1, class Real = double> class cogging_force {
public:
    using input = signal::position;
    using output = signal::force;
    using argument = quantity_of<signal::position, Real>;
    using value = quantity_of<signal::force, Real>;
    using number = parameter_real<Real>; ///< of parameters

    using parameters = periodic<signal::force, Harmonics, number>;
    struct state {};

    cogging_force(const parameters& p, duration sample_period) : given_(p), sum_("cogging_force", p) {
        require_positive<Real>("cogging_force.sample_period", sample_period);
    }

    value operator()(argument x) noexcept {
        const value y = sum_(x);
        return finite(x, y) ? out_.keep(y) : out_.hold();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept {
        const value y = sum_(x);
        finite(x, y) ? out_.reset(y) : out_.raise();
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    detail::periodic_sum<signal::force, Harmonics, Real> sum_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
