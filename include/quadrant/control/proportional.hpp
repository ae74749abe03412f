// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <complex>

namespace quadrant::inline v0 {

/// Multiplies a wire by a gain: position loop, velocity and acceleration feedforward.
///   u = gain x
/// Source: [Ellis2012], position-control loops (the P of a P/PI cascade).
/// Ports: one scalar in, one scalar out; the sign is that of the gain.
/// State: none; `reset` and `settle` set the held output and clear the fault.
/// `retune(next)`: another gain from the next step on, jump = |gain' - gain| |x[k]|; behind it a
/// `proportional_integral` can take it.
/// Range: any finite gain, negative and zero included; the output is not limited.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "proportional.gain = ...: must be finite", "proportional.period = ...: must be finite and above 0".
/// Cost: 1 multiplication. With an integral: `proportional_integral`; no gain at all: `through`.
template <signal_tag In, signal_tag Out, class Real = double> class proportional {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The gain, in units of the output per unit of the input.
    struct parameters {
        gain_of<Out, In, number> gain; ///< any finite value
    };
    struct state {};

    proportional(const parameters& p, duration period) : given_(p), gain_(in_real<Real>(p.gain)) {
        require_positive<Real>("proportional.period", period);
        require_finite<Real>("proportional.gain", p.gain);
    }

    value operator()(argument x) noexcept {
        const value y = gain_ * x;
        return out_.keep(finite(y), y);
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept {
        const value y = gain_ * x;
        out_.settle(finite(y), y);
    }
    void retune(const proportional& next) noexcept {
        gain_ = next.gain_;
        given_ = next.given_;
    }

    std::complex<double> response(frequency) const { return detail::plain(gain_); }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    gain_of<Out, In, Real> gain_;
    held_output<value, false> out_;
};

} // namespace quadrant::inline v0
