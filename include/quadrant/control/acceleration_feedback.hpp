// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../filter/lowpass.hpp"
#include "axis_law.hpp"

#include <complex>

namespace quadrant::inline v0 {

namespace detail {
/// A law whose reference is that of now: its acceleration can be compared with the measured one.
template <class L>
concept law_without_lead = axis_law<L> && !requires {
    L::most_lead;
};
} // namespace detail

/// A control law with an accelerometer in its feedback: what the axis accelerates less than it is asked to is
/// added to the command, so that disturbances meet a heavier axis and the reference the same one.
///   u = law(reference, x, v) + gain H (a_ref - a),   H = `lowpass` of the corner
/// A disturbance moves the axis as if it had (1 + gain B) times its inertia, up to the corner; B = acceleration
/// of the plant per unit of command.
/// Source: [Yeung2006] eq. (19), the acceleration in the feedback; [Schmidt1992] acceleration feedback as an
/// electronic inertia.
/// Ports: those of a control law; the fourth argument is the measured acceleration. `feed_control` hands it
/// over; asked with three arguments, the law takes the axis to accelerate as it is asked to.
/// State: that of the law and of the filter. `reset`: both as new; `settle(x, u)`: at rest at x, held by u.
/// `retune(next, reference, x, v, u)`: as `retunable_law` says, where the law does; the law takes what the
/// new gain changes. |u'[k] - u| is at most what the law says of its own, and gain' times the step of the
/// filter's output.
/// Range: gain >= 0. The measured acceleration is the mean of the last period, half a period late: with the
/// filter's lag it bounds the gain. Without any lag of the filter the inner loop needs gain B < 1.
/// NaN and infinities in any input: holds the last command, keeps the state, raises faulted().
/// Throws "acceleration_feedback.<field> = ...: must ..." for gain and period, and what the law and `lowpass`
/// throw. Cost: that of the law, 2 multiplications, 24 bytes. Without an accelerometer: `disturbance_observer`.
template <detail::law_without_lead Law> class acceleration_feedback {
public:
    using output = typename Law::output;
    using real = real_of<Law>;
    using number = parameter_real<real>; ///< of parameters
    using value = quantity_of<output, real>;
    using position = quantity_of<signal::position, real>;
    using velocity = quantity_of<signal::velocity, real>;
    using acceleration = quantity_of<signal::acceleration, real>;
    using filter = lowpass<signal::acceleration, real>;

    /// The law, how strongly a missing acceleration is answered, and how fast.
    struct parameters {
        typename Law::parameters law;
        gain_of<output, signal::acceleration, number> gain{}; ///< >= 0; 0: the law alone
        quantity<hertz_unit, number> corner;                  ///< of the filter
    };

    acceleration_feedback(const parameters& p, duration period)
        : given_(p), period_(period), law_(p.law, period), filter_({p.corner}, period),
          gain_(in_real<real>(p.gain)) {
        require_not_negative<real>("acceleration_feedback.gain", p.gain);
    }

    value operator()(const axis_motion<real>& reference, position x, velocity v, acceleration a) noexcept {
        if (!finite(reference.position, reference.velocity, reference.acceleration, x, v, a))
            return out_.hold();
        filtered_ = filter_(reference.acceleration - a);
        added_ = gain_ * filtered_;
        of_law_ = law_(reference, x, v);
        const value u = of_law_ + added_;
        return finite(u) ? out_.keep(u) : out_.hold();
    }
    value operator()(const axis_motion<real>& reference, position x, velocity v) noexcept {
        return (*this)(reference, x, v, reference.acceleration);
    }
    /// What was left of the last command; the cut is charged to the law.
    void applied(value u) noexcept {
        // Not u - added: its rounding would be taken for a cut.
        if constexpr (requires { law_.applied(u); }) law_.applied(of_law_ + (u - out_.last()));
    }
    void reset() noexcept {
        law_.reset();
        filter_.reset();
        filtered_ = {};
        added_ = of_law_ = {};
        out_.reset();
    }
    void settle(position x, value hold = value()) noexcept {
        if (!finite(x, hold)) return out_.raise();
        law_.settle(x, hold);
        filter_.settle({});
        filtered_ = {};
        added_ = {};
        of_law_ = hold;
        out_.reset(hold);
    }
    void retune(const acceleration_feedback& next, const axis_motion<real>& reference, position x, velocity v,
                value u) noexcept requires retunable_law<Law> {
        if (next.period_ != period_) return out_.raise();
        added_ = next.gain_ * filtered_;
        law_.retune(next.law_, reference, x, v, u - added_);
        filter_.retune(next.filter_);
        gain_ = next.gain_;
        given_ = next.given_;
    }

    /// Eq. (19), where the law has it.
    law_response response(frequency f) const requires requires(const Law& law) { law.response(f); }
    {
        law_response r = law_.response(f);
        const std::complex<double> h = detail::plain(gain_.value()) * filter_.response(f);
        r.to_acceleration += h;
        r.from_acceleration += h;
        return r;
    }
    value added() const noexcept { return added_; } ///< for the accelerometer's last sample, by the gain in use
    bool faulted() const noexcept {
        return out_.faulted() || detail::is_faulted(law_) || detail::is_faulted(filter_);
    }
    const parameters& given() const noexcept { return given_; }
    const Law& law() const noexcept { return law_; }

private:
    parameters given_;
    duration period_;
    Law law_;
    filter filter_;
    gain_of<output, signal::acceleration, real> gain_;
    acceleration filtered_{};
    value added_{}, of_law_{}; ///< the parts of the last command
    held_output<value> out_;
};

} // namespace quadrant::inline v0
