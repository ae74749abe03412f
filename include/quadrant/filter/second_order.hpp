// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../error.hpp"
#include "../finite.hpp"

#include <array>
#include <complex>
#include <numbers>

/// The arithmetic that notch and Butterworth low-pass share: one second-order section in transposed direct form II,
/// chosen because its states are in the unit of the output and small next to it.
namespace quadrant {

/// For hertz into rad/s: w = 2 pi f.
inline constexpr double pi = std::numbers::pi;

/// Coefficients of one second-order section; as they stand: a piece of wire.
template <class Real> struct second_order_coefficients {
    Real b0{1}, b1{0}, b2{0}, a1{0}, a2{0}; ///< (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2)
};

/// Both delays of the section, in the unit of its output.
template <signal_tag Signal, class Real> struct second_order_state {
    std::array<quantity_of<Signal, Real>, 2> s{};
};

/// One sample through the section; what is not finite leaves the state as it is and holds the last output.
template <signal_tag Signal, class Real>
quantity_of<Signal, Real>
step(const second_order_coefficients<Real>& c, second_order_state<Signal, Real>& state,
     held_output<quantity_of<Signal, Real>>& out, quantity_of<Signal, Real> x) noexcept {
    const quantity_of<Signal, Real> y = c.b0 * x + state.s[0];
    const quantity_of<Signal, Real> s0 = c.b1 * x - c.a1 * y + state.s[1];
    const quantity_of<Signal, Real> s1 = c.b2 * x - c.a2 * y;
    const auto good = finite(y, s0, s1);
    if (none(good)) return out.hold();
    set_where(good, state.s, {s0, s1});
    return out.keep(good, y);
}

/// As if x had been applied for ever; an x that is not finite only raises the fault flag.
template <signal_tag Signal, class Real>
void settle(const second_order_coefficients<Real>& c, second_order_state<Signal, Real>& state,
            held_output<quantity_of<Signal, Real>>& out, quantity_of<Signal, Real> x) noexcept {
    const Real gain = (c.b0 + c.b1 + c.b2) / (1 + c.a1 + c.a2);
    const quantity_of<Signal, Real> y = gain * x;
    const quantity_of<Signal, Real> s0 = y - c.b0 * x, s1 = c.b2 * x - c.a2 * y;
    const auto good = finite(y, s0, s1);
    set_where(good, state.s, {s0, s1});
    out.settle(good, y);
}

/// Other coefficients in the next step, for a filter whose gain at standstill is one: the state goes on as if the last input
/// had stood for ever under either. Nothing changes for a constant input; else the next output is off by (b0' - b0)(x[k] - x[k-1])
/// from what it would have been.
template <signal_tag Signal, class Real>
void retune(second_order_coefficients<Real>& c, const second_order_coefficients<Real>& next,
            second_order_state<Signal, Real>& state, const quantity_of<Signal, Real>& last) noexcept {
    const quantity_of<Signal, Real> x = (state.s[1] + c.a2 * last) / c.b2; // the last input
    const quantity_of<Signal, Real> s0 = state.s[0] + (c.b0 - next.b0) * x,
                                    s1 = state.s[1] + ((next.b2 - c.b2) + (c.a2 - next.a2)) * x;
    c = next;
    set_where(finite(s0, s1), state.s, {s0, s1});
}

/// As if all inputs so far had been higher by so much, for the same filters.
template <signal_tag Signal, class Real>
void shift(const second_order_coefficients<Real>& c, second_order_state<Signal, Real>& state,
           held_output<quantity_of<Signal, Real>>& out, quantity_of<Signal, Real> by) noexcept {
    const auto good = finite(by);
    set_where(good, state.s, {state.s[0] + (by - c.b0 * by), state.s[1] + (c.b2 - c.a2) * by});
    out.keep(good, out.last() + by);
}

/// Response of the section at f, as it runs with this period.
template <class Real>
std::complex<double> response(const second_order_coefficients<Real>& c, frequency f, duration period) {
    const auto number = [](const Real& x) { return detail::plain(x); };
    const std::complex<double> back = std::polar(1.0, -2 * pi * f.value() * period.value()); // z^-1
    return (number(c.b0) + back * (number(c.b1) + back * number(c.b2))) /
           (1.0 + back * (number(c.a1) + back * number(c.a2)));
}

} // namespace quadrant
