// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <complex>

namespace quadrant::inline v0 {

/// An empty box: switches an addition off at compile time (no friction feedforward, no observer).
///   y = 0
/// Ports: one scalar in, one scalar out of any signal.
/// State: none; `reset` and `settle` clear the fault.
/// NaN and infinities: gives zero, raises faulted(), as any other box.
/// Throws "absent.period = ...: must be finite and above 0".
/// Cost: none. To switch off a box in the line of the signal: `through`.
template <signal_tag In, signal_tag Out, class Real = double> class absent {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    struct parameters {};
    struct state {};

    absent(const parameters& p, duration period) : given_(p) {
        require_positive<Real>("absent.period", period);
    }

    value operator()(argument x) noexcept { return out_.keep(finite(x), value()); }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept { out_.settle(finite(x), value()); }
    void shift(argument by) noexcept { out_.raise(!finite(by)); }

    std::complex<double> response(frequency) const { return 0; }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    held_output<value> out_;
};

/// A piece of wire: switches off a box in the line of the signal at compile time (no notch).
///   y = x
/// Ports: one scalar in, one scalar out, the same signal.
/// State: none; `reset` and `settle` set the held output and clear the fault.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "through.period = ...: must be finite and above 0".
/// Cost: none. To switch off an addition: `absent`.
template <signal_tag Signal, class Real = double> class through {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    struct parameters {};
    struct state {};

    through(const parameters& p, duration period) : given_(p) {
        require_positive<Real>("through.period", period);
    }

    value operator()(value x) noexcept { return out_.keep(finite(x), x); }
    void reset() noexcept { out_.reset(); }
    void settle(value x) noexcept { out_.settle(finite(x), x); }
    void shift(value by) noexcept { out_.keep(finite(by), out_.last() + by); }

    std::complex<double> response(frequency) const { return 1; }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
