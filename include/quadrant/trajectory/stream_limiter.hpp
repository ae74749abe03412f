// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"
#include "limits.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace quadrant::inline v0::trajectory {

/// Keeps a stream of positions within limits of velocity, acceleration and jerk, sample by sample, whatever
/// comes in: a hand wheel, a joint of a robot, an external planner that jumps.
///   1. E = x[k] - p[k-1] - s,  s = x[k] - x[k-1]:   step p by s + sign(E) c w,  c = acceleration T^2,
///      (n+1) w - n (n+1)/2 = |E|/c,  n = largest whole number with n (n+1)/2 <= |E|/c:   the greatest speed relative to the
///      stream from which it still stops at the stream, slowing down by c a sample; held to velocity and acceleration
///   2. y = mean of the last N of p,   N = ceil(2 acceleration / (jerk T))
/// Then |y'| <= velocity, |y''| <= acceleration, |y'''| <= jerk for the differences of y, always: a mean
/// exceeds nothing, and the acceleration changes by (a[k] - a[k-N])/(N T) at most. Without a jerk limit
/// (infinite) N = 1.
/// Source: step 1 is a discrete form of what LinuxCNC's limit3 does; step 2 is the moving average behind a
/// CNC's interpolator.
/// Ports: position in, position out. A stream within the limits passes unchanged but late by delay() = (N-1)
/// T/2.
/// Overshoot: none towards a stream that stands or moves evenly, unless it turned away harder than the limits
/// allow.
/// Time: a move from rest takes that of the best acceleration-limited one plus N T, where the best jerk-limited
/// takes acceleration/jerk = N T/2 more.
/// State: p, its last step, the last input, N values of p; `reset` at rest at zero, `settle(x)` at rest at x.
/// `shift(by)`: the frame of positions moves. limited() = the last sample could not follow.
/// Range: velocity > 0, may be infinite; acceleration finite, > 0; jerk > 0, may be infinite; N <= Capacity.
/// |x| <= range() = acceleration T^2/(100 eps): there the roundings of three positions are up to 4 % of the
/// acceleration limit, and those of four up to 8 % of acceleration/T beside the jerk limit. In
/// double at 1 kHz and 1 m/s^2 that is 45 km, in float 84 mm: count positions from where the axis is (`shift`),
/// or take double. NaN, infinities, positions beyond range(): holds the last output, keeps the state, raises
/// faulted(). Throws "stream_limiter.<field> = ...: must ..." for period, velocity,
/// acceleration, jerk.
/// Cost: 1 square root, 2 divisions, 8 (Capacity + 6) bytes. Whole moves that are known: `interpolator`; no
/// acceleration limit: `rate_limiter`.
template <std::size_t Capacity, class Real = double>
requires(Capacity >= 1) class stream_limiter {
public:
    using input = signal::position;
    using output = signal::position;
    using argument = quantity_of<signal::position, Real>;
    using value = argument;
    using number = parameter_real<Real>; ///< of parameters

    /// How fast, hard and suddenly the output may move.
    struct parameters {
        quantity<si::velocity, number> velocity;         ///< > 0, may be infinite
        quantity<si::acceleration, number> acceleration; ///< > 0
        quantity<jerk_unit, number> jerk = quantity<jerk_unit, number>::from_value(number(unlimited)); ///< > 0
    };
    /// The stream, the path that follows it, and the samples that the mean is taken over.
    struct state {
        value x{}, p{}, step{};           ///< last input, last p, p minus the one before
        std::array<value, Capacity> of{}; ///< a ring of p
        std::size_t next = 0;
        fine_sum<value, std::same_as<Real, float>> sum{},
            fresh{}; ///< of the ring; of what was written since it began anew
    };

    stream_limiter(const parameters& p, duration period) : given_(p) {
        require_positive<Real>("stream_limiter.period", period);
        const char* const rule = "must be above 0 (infinite: no bound)";
        require(quadrant::detail::plain(p.velocity) > 0, "stream_limiter.velocity", p.velocity, rule);
        require_positive<Real>("stream_limiter.acceleration", p.acceleration);
        require(quadrant::detail::plain(p.jerk) > 0, "stream_limiter.jerk", p.jerk, rule);
        const double T = period.value(), a = quadrant::detail::plain(p.acceleration),
                     j = quadrant::detail::plain(p.jerk);
        const double length = std::fmax(1, std::ceil(2 * a / (j * T) * (1 - 1e-12)));
        require(length <= double(Capacity), "stream_limiter.jerk", p.jerk,
                "needs a mean of " + quadrant::detail::shortest(length) + " samples, and the capacity is " +
                    quadrant::detail::shortest(double(Capacity)));
        length_ = std::size_t(length);
        delay_ = 0.5 * (length - 1) * period;
        fastest_ = value::from_value(Real(p.velocity.value() * number(T)));
        change_ = value::from_value(Real(p.acceleration.value() * number(T * T)));
        using plain_real = std::conditional_t<std::same_as<Real, float>, float, double>;
        range_ = quadrant::detail::plain(change_) / (100 * double(std::numeric_limits<plain_real>::epsilon()));
        require(range_ > 0, "stream_limiter.acceleration", p.acceleration,
                "must be a change of position in this period and number type");
    }

    value operator()(argument x) noexcept {
        const value s = within(x - state_.x, fastest_), E = (x - state_.p) - s;
        const bool back = E < value();
        const Real share = (back ? -E : E) / change_;
        const double n = std::floor(0.5 * (std::sqrt(1 + 8 * quadrant::detail::plain(share)) - 1));
        const value w = Real((share + Real(0.5 * n * (n + 1))) / Real(n + 1)) * change_;
        const value wanted = back ? s - w : s + w;
        const value step = state_.step + within(within(wanted, fastest_) - state_.step, change_);
        const bool lands = n == 0 && step == wanted;
        const value p = lands ? x : value(state_.p + step), gone = state_.of[state_.next];
        const auto sum = state_.sum.plus(p - gone), fresh = state_.fresh.plus(p);
        if (!finite(share, p, sum.high, fresh.high) || beyond(x)) return out_.hold();
        limited_ = !lands;
        state_.x = x;
        state_.step = lands ? within(p - state_.p, fastest_) : step;
        state_.p = p;
        state_.of[state_.next] = p;
        const bool around = ++state_.next == length_; // the sum is made anew: no rounding piles up
        if (around) state_.next = 0;
        state_.sum = around ? fresh : sum;
        state_.fresh = around ? decltype(fresh){} : fresh;
        return out_.keep(length_ == 1 ? p : value(state_.sum.high / Real(double(length_))));
    }
    void reset() noexcept { settle(value()); }
    void settle(value x) noexcept {
        const value sum = Real(double(length_)) * x;
        if (!finite(x, sum) || beyond(x)) return out_.raise();
        state_ = {};
        state_.x = state_.p = x;
        state_.of.fill(x);
        state_.sum = {sum};
        limited_ = false;
        out_.reset(x);
    }
    void shift(value by) noexcept {
        if (!finite(by) || beyond(state_.x + by)) return out_.raise();
        state_.x += by, state_.p += by;
        for (value& each : state_.of) each += by;
        state_.sum.high += Real(double(length_)) * by;
        state_.fresh.high += Real(double(state_.next)) * by;
        out_.keep(out_.last() + by);
    }

    duration delay() const noexcept { return delay_; }
    /// How far from zero the limits hold: a position beyond it is a bad sample.
    quantity_of<signal::position> range() const noexcept {
        return quantity_of<signal::position>::from_value(range_);
    }
    bool limited() const noexcept { return limited_; }
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    bool beyond(value x) const noexcept {
        const double at = quadrant::detail::plain(x);
        return at > range_ || at < -range_;
    }
    static value within(value x, value most) noexcept { return x > most ? most : x < -most ? -most : x; }

    parameters given_;
    std::size_t length_ = 1;
    duration delay_{};
    double range_ = 0;       ///< [m]
    value fastest_, change_; ///< of p, in one sample
    state state_;
    bool limited_ = false;
    held_output<value> out_;
};

} // namespace quadrant::inline v0::trajectory
