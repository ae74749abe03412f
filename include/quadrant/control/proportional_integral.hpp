// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"

#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// The integral alone is clamped to +-limit.
struct integral_clamp {};
/// The integral stands still while the output is beyond limit and the error drives it out.
struct conditional_integration {};
/// The integral gives way at the limit: it moves by T / tracking_time times (applied - output).
struct back_calculation {
    duration tracking_time; ///< > 0; not below the period: one period undoes the whole excess at once
};
/// How the integral of a `proportional_integral` is kept from winding up while the amplifier is at its limit.
template <class A>
concept anti_windup_rule = std::same_as<A, integral_clamp> || std::same_as<A, conditional_integration> ||
    std::same_as<A, back_calculation>;

/// Velocity loop: drives the error to zero and holds against a constant force.
///   I[k] = I[k-1] + integral_gain T e[k] (restrained by AntiWindup),   u[k] = gain e[k] + I[k]
/// Source: docs/formats.md (cascade_p_pi); anti-windup [Astrom1995] ch. 3.5; integral in output units, so that
/// a gain change does not jump (control_toolbox #294).
/// Ports: error in, output; `applied(u)` tells what the amplifier really applied, else u clipped to +-limit is
/// assumed.
/// State: the integral and the excess output - applied, both in output units; `reset` leaves zero;
/// `settle(e, u)` is
/// the bumpless start: the next step with e gives u, as far as the limit of the integral allows.
/// `retune(next, e[k-1])`: other gains from the next step on; the integral takes what the proportional part
/// loses. Then
/// |u'[k] - u[k-1]| <= gain' |e[k] - e[k-1]| + integral_gain' T |e[k]| + what the integral has beyond its new
/// limit (+ T/tracking_time' times the excess): the step that the new gains would have made anyway.
/// Range: gains not negative; integral_gain = 0 is a plain gain that keeps its integral; limit > 0, infinite =
/// none.
/// u itself is never clipped: a notch and feedforward follow, then a `limiter`. limited() = the integral was
/// restrained.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "proportional_integral.<field> = ...: must be ..." for gain, integral_gain, limit, tracking_time,
/// period.
/// Cost: 2 multiplications (3 with back calculation), 24 bytes of state; in float 3 additions more, as the
/// integral is a `fine_sum` there: what a sample adds may lie below its last digit. No integral:
/// `proportional`.
template <signal_tag In, signal_tag Out, anti_windup_rule AntiWindup = integral_clamp, class Real = double>
class proportional_integral {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>;                    ///< of parameters
    static constexpr bool fine = std::same_as<Real, float>; ///< the integral is held in two numbers

    /// Gains, the limit of the amplifier, and what the integral does at it.
    struct parameters {
        gain_of<Out, In, number> gain;               ///< >= 0
        gain_rate_of<Out, In, number> integral_gain; ///< >= 0
        quantity_of<Out, number> limit;              ///< of the amplifier, > 0; infinite = none
        AntiWindup anti_windup = {};
    };
    /// The integral, and what the amplifier cut off at the last sample; both in the unit of the output. In
    /// float `rest` is what rounding left over of the integral.
    struct state : detail::rest_of_sum<value, fine> {
        value integral{};
        value excess{}; ///< last output minus what was applied of it
    };

    proportional_integral(const parameters& p, duration period)
        : given_(p), gain_(in_real<Real>(p.gain)), limit_(in_real<Real>(p.limit)) {
        require_positive<Real>("proportional_integral.period", period);
        require_not_negative<Real>("proportional_integral.gain", p.gain);
        require_not_negative<Real>("proportional_integral.integral_gain", p.integral_gain);
        require_lanes([&](std::size_t i) { return detail::plain(lane(p.limit, i)) > 0; },
                      "proportional_integral.limit", p.limit, "must be above 0 (infinite: no limit)");
        per_sample_ =
            gain_of<Out, In, Real>::from_value(Real(p.integral_gain.value() * number(period.value())));
        if constexpr (std::same_as<AntiWindup, back_calculation>) {
            const duration tracking = p.anti_windup.tracking_time;
            require(detail::is_finite(tracking.value()) && tracking >= period,
                    "proportional_integral.tracking_time", tracking,
                    "must be finite and not below the period (" + detail::shortest(period) + ")");
            tracking_ = Real(period.value() / tracking.value());
        }
        period_ = period;
    }

    value operator()(argument e) noexcept {
        const value proportion = gain_ * e, more = per_sample_ * e;
        const auto sum = summed(more);
        const value free = sum.high, integral = restrained(free, more, proportion), u = proportion + integral;
        const auto good = finite(u, integral);
        if (none(good)) return out_.hold();
        set_where(good, limited_, restrains(integral, free));
        if constexpr (fine)
            state_.rest = integral == free ? sum.low : integral == state_.integral ? state_.rest : value();
        set_where(good, state_.integral, integral);
        if constexpr (std::same_as<AntiWindup, back_calculation>)
            set_where(good, state_.excess, u - bounded(u));
        else if constexpr (std::same_as<AntiWindup, conditional_integration>)
            set_where(good, state_.excess, value());
        return out_.keep(good, u);
    }
    /// What the amplifier applied of the last output, in its unit and before anything that was added to it.
    void applied(value u) noexcept {
        if constexpr (!std::same_as<AntiWindup, integral_clamp>) {
            const value excess = out_.last() - u;
            const auto good = finite(excess);
            set_where(good, state_.excess, excess);
            out_.raise(!good);
        }
    }
    void reset() noexcept {
        state_ = {};
        limited_ = mask_of<Real>();
        out_.reset();
    }
    void settle(argument e, value u) noexcept {
        const value proportion = gain_ * e, more = per_sample_ * e;
        value integral = u - proportion; // after the coming step
        const auto good = finite(u, integral, more);
        if constexpr (std::same_as<AntiWindup, integral_clamp>)
            integral = bounded(bounded(integral) - more);
        else if constexpr (std::same_as<AntiWindup, conditional_integration>)
            integral = select(drives_out(u, more), integral, integral - more);
        else
            integral -= more;
        set_where(good, state_.integral, integral);
        set_where(good, state_.excess, value());
        set_where(good, limited_, mask_of<Real>());
        if constexpr (fine)
            if (good) state_.rest = value();
        out_.settle(good, u);
    }
    /// The last step once more, with the new gains: as if it had been given e and had put out u (of one
    /// argument: u).
    void retune(const proportional_integral& next, argument e) noexcept { retune(next, e, out_.last()); }
    void retune(const proportional_integral& next, argument e, value u) noexcept {
        const value integral = u - next.gain_ * e;
        const auto good = finite(integral);
        if (next.period_ != period_ || none(good)) return out_.raise();
        given_ = next.given_;
        set_where(good, gain_, next.gain_);
        set_where(good, per_sample_, next.per_sample_);
        set_where(good, limit_, next.limit_);
        set_where(good, tracking_, next.tracking_);
        set_where(good, limited_, next.limited_);
        if constexpr (std::same_as<AntiWindup, integral_clamp>)
            set_where(good, state_.integral, bounded(integral));
        else
            set_where(good, state_.integral, integral);
        if constexpr (fine) state_.rest = value();
        out_.raise(!good);
    }

    /// Of the unrestrained loop.
    std::complex<double> response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value());
        return detail::plain(gain_) + detail::plain(per_sample_) / (1.0 - back);
    }
    bool limited() const noexcept { return any(limited_); } ///< some lane was
    mask_of<Real> limited_lanes() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    value bounded(value u) const noexcept { return limited_to(u, limit_); }
    mask_of<Real> drives_out(value u, value more) const noexcept {
        return either(both(greater(more, value()), greater(u, limit_)),
                      both(less(more, value()), less(u, -limit_)));
    }
    value restrained(value free, value more, value proportion) const noexcept {
        if constexpr (std::same_as<AntiWindup, integral_clamp>) {
            return bounded(free);
        } else if constexpr (std::same_as<AntiWindup, conditional_integration>) {
            const auto short_of_it = either(both(greater(more, value()), greater(state_.excess, value())),
                                            both(less(more, value()), less(state_.excess, value())));
            return select(either(short_of_it, drives_out(proportion + free, more)), state_.integral, free);
        } else {
            return fine ? free : value(free - tracking_ * state_.excess);
        }
    }
    /// The integral and what comes to it; in float with what flows off at the limit, which may be as small.
    fine_sum<value, fine> summed(value more) const noexcept {
        if constexpr (!fine)
            return fine_sum<value, false>{state_.integral}.plus(more);
        else if constexpr (std::same_as<AntiWindup, back_calculation>)
            return fine_sum<value>{state_.integral, state_.rest}.plus(more - tracking_ * state_.excess);
        else
            return fine_sum<value>{state_.integral, state_.rest}.plus(more);
    }
    mask_of<Real> restrains(value integral, value free) const noexcept {
        if constexpr (fine && std::same_as<AntiWindup, back_calculation>)
            return state_.excess != value();
        else
            return differs(integral, free);
    }

    parameters given_;
    duration period_;
    gain_of<Out, In, Real> gain_, per_sample_;
    value limit_;
    Real tracking_{0};
    state state_;
    mask_of<Real> limited_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
