// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../error.hpp"
#include "../finite.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

namespace quadrant {

/// Coefficients of a sampled filter as bare numbers in SI, by rising power of z^-1; what `discretize.hpp` gives.
template <std::size_t Order, class Number = double> struct discrete {
    std::array<Number, Order + 1> numerator{}, denominator{};
};

/// Any linear filter of fixed order, for what has no block of its own.
///   y = (b[0] + b[1] z^-1 + ... + b[n] z^-n) / (a[0] + a[1] z^-1 + ... + a[n] z^-n) x
/// Source: [Oppenheim2010] ch. 6, transposed direct form II: the states are in the unit of the output.
/// Ports: one scalar in, one scalar out of any signal; the numerator carries the unit Out/In.
/// State: n numbers in the unit of the output; `reset` leaves zero; `settle(x)` the state of a constant x. With a pole at
/// z = 1 (integrates()) no such state exists: `settle(x, y)`, where the next step with x gives y; settle(x) then takes
/// the last output for y.
/// Range: a[0] not zero. Poles outside the unit circle are allowed (a plant may have them); the output then grows until
/// it is no longer finite, and holds. From order 4 on with poles near z = 1 prefer a `series` of low orders.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "transfer_function.denominator[0] = 0: must not be zero", "transfer_function.numerator = ...: must be finite".
/// Cost: 2 n + 1 multiplications, 8 n bytes of state. Of order one or two: `lowpass`, `butterworth`, `notch`.
template <signal_tag In, signal_tag Out, std::size_t Order, class Real = double> class transfer_function {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using gain = gain_of<Out, In, Real>;

    /// Coefficients of both polynomials, the numerator's with their unit.
    struct parameters {
        std::array<gain_of<Out, In, number>, Order + 1> numerator{}; ///< by rising power of z^-1
        std::array<number, Order + 1> denominator{};                 ///< the same; denominator[0] not zero

        static parameters in_si(const discrete<Order, number>& d) {
            parameters p;
            for (std::size_t i = 0; i <= Order; ++i) {
                p.numerator[i] = gain_of<Out, In, number>::from_value(d.numerator[i]);
                p.denominator[i] = d.denominator[i];
            }
            return p;
        }
    };
    /// The delays of transposed direct form II, in the unit of the output.
    struct state {
        std::array<value, Order> s{};
    };

    transfer_function(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive("transfer_function.period", period);
        for (std::size_t i = 0; i <= Order; ++i) {
            require_finite("transfer_function.numerator", p.numerator[i]);
            require_finite("transfer_function.denominator", p.denominator[i]);
        }
        const number a0 = p.denominator[0];
        require_lanes([&](std::size_t i) { return detail::plain(lane(a0, i)) != 0; },
                      "transfer_function.denominator[0]", a0, "must not be zero");
        Real sum_of_a(1), size_of_a(1);
        gain sum_of_b{};
        for (std::size_t i = 0; i <= Order; ++i) {
            b_[i] = gain::from_value(Real(p.numerator[i].value() / a0));
            sum_of_b += b_[i];
            require_finite("transfer_function.numerator / denominator[0]", b_[i]);
            if (i == 0) continue;
            a_[i - 1] = Real(p.denominator[i] / a0);
            require_finite("transfer_function.denominator / denominator[0]", a_[i - 1]);
            sum_of_a += a_[i - 1];
            size_of_a += absolute(a_[i - 1]);
        }
        // Closer to z = 1 than the coefficients can tell: the sum is nothing but their rounding.
        const double rounding = 4 * double(std::numeric_limits<plain_real>::epsilon());
        integrates_ = less_equal(absolute(sum_of_a), Real(plain_real(rounding)) * size_of_a);
        if (!all(integrates_)) set_where(!integrates_, standstill_, sum_of_b / sum_of_a);
    }

    value operator()(argument x) noexcept {
        std::array<value, Order> next;
        const value y = Order == 0 ? value(b_[0] * x) : value(b_[0] * x + first());
        Real sum = y.value();
        for (std::size_t i = 0; i < Order; ++i) {
            next[i] = b_[i + 1] * x - a_[i] * y;
            if (i + 1 < Order) next[i] += state_.s[i + 1];
            sum += next[i].value();
        }
        const auto good = finite(sum);
        if (none(good)) return out_.hold();
        set_where(good, state_.s, next);
        return out_.keep(good, y);
    }
    void reset() noexcept { settle(argument(), value()); }
    void settle(argument x) noexcept { settle(x, select(integrates_, out_.last(), value(standstill_ * x))); }
    void settle(argument x, value y) noexcept {
        std::array<value, Order> s;
        Real sum = x.value() + y.value();
        for (std::size_t i = Order; i-- > 0;) {
            s[i] = b_[i + 1] * x - a_[i] * y; // as if x and y had stood for ever
            if (i + 1 < Order) s[i] += s[i + 1];
            if (i == 0) s[i] = y - b_[0] * x; // the same, but for a pole at z = 1
            sum += s[i].value();
        }
        const auto good = finite(sum);
        set_where(good, state_.s, s);
        out_.settle(good, y);
    }

    std::complex<double> response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        std::complex<double> over = 0, under = 0;
        for (std::size_t i = Order + 1; i-- > 0;) {
            over = over * back + detail::plain(b_[i]);
            under = under * back + (i == 0 ? 1.0 : detail::plain(a_[i - 1]));
        }
        return over / under;
    }
    mask_of<Real> integrates() const noexcept { return integrates_; } ///< has a pole at z = 1
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    using plain_real = std::conditional_t<std::same_as<Real, float>, float, double>;
    value first() const noexcept {
        if constexpr (Order > 0) return state_.s[0];
        return value();
    }

    parameters given_;
    duration period_;
    std::array<gain, Order + 1> b_{};
    std::array<Real, Order> a_{}; ///< from z^-1 on
    mask_of<Real> integrates_{};
    gain standstill_{};
    state state_;
    held_output<value> out_;
};

} // namespace quadrant
