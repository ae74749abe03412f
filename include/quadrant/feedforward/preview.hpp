// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/axis_motion.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// Makes a trajectory look ahead: the axis is asked Capacity periods later, so that what comes is known, and a
/// feedforward can act as much earlier as the drive is late. The path is the same; the whole of it is executed
/// Capacity periods later.
///   reference[k] = r[k - Capacity],   ahead[k] = r(t - Capacity T + lead)
/// Between samples: position by the cubic through position and velocity at either end, velocity and
/// acceleration by the cubic through velocity and acceleration at either end (Hermite). Exact at samples, and
/// between them for a position of third order in time (constant jerk); for a sine of angular frequency w the
/// position to (w T)^4 / 384 of it.
/// Source: [Jamaludin2008], feedforward advanced by the delay Td of the plant; the polynomials are textbook.
/// Ports: motion (position, velocity, acceleration) in; two motions out. `at(d)` reads any other lead, without
/// a step: friction may need another one than mass.
/// State: the last Capacity + 1 motions. `reset`: stands at zero, lead of the parameters; `settle(m)`: as if m
/// had been applied for ever ({.position = x} for rest). Settle at the first position before the first step, or
/// it reads as a jump. `lead(d)` and `retune(next)` change the lead between two steps; the reference does not
/// move by it, the other motion by what lies between both times.
/// Range: 0 <= lead <= Capacity periods; lead(d) and at(d) outside saturate, limited() reports it for lead(d).
/// Axes that follow one path need the same Capacity, not the same lead. Where the acceleration jumps within a
/// period, its value there is off by up to 1/3 of the jump.
/// NaN and infinities: holds both motions, takes nothing in, raises faulted().
/// Throws "preview.lead = ...: must lie between 0 and ... (capacity)".
/// Cost: about 16 multiplications for a lead between samples, 24 (Capacity + 3) bytes of state. Late instead of
/// early: `delay_line`.
template <std::size_t Capacity, motion_sample Motion = axis_motion<>>
requires(Capacity > 0) class preview {
public:
    using Real = typename decltype(Motion::position)::value_type;
    using number = parameter_real<Real>; ///< of parameters
    using time = quantity<si::time, number>;

    /// How much earlier than the reference the other motion is.
    struct parameters {
        time lead{}; ///< of `ahead` before `reference`; 0 ... Capacity periods
    };
    /// The motions that have come in and are not executed yet.
    struct state {
        std::array<Motion, Capacity + 1> r{}; ///< a ring
        std::size_t next = 0;                 ///< where the coming motion goes
    };
    /// What is due now, and what will be due `lead` later.
    struct outcome {
        Motion reference{}, ahead{};
    };

    preview(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive("preview.period", period);
        lead(p.lead);
        require(!limited_ && !out_.faulted(), "preview.lead", p.lead,
                "must lie between 0 and " + detail::shortest(double(Capacity) * period) + " (capacity)");
    }

    outcome operator()(const Motion& r) noexcept {
        if (!finite(r.position) || !finite(r.velocity) || !finite(r.acceleration)) return out_.hold();
        state_.r[state_.next] = r; // the oldest, read no more; the next step takes the same place after a fault
        const std::size_t oldest = after(state_.next, 1);
        const outcome y{state_.r[oldest], read(oldest, lead_)};
        if (!finite(y.ahead.position) || !finite(y.ahead.velocity) || !finite(y.ahead.acceleration))
            return out_.hold();
        state_.next = oldest;
        return out_.keep(y);
    }
    void reset() noexcept {
        lead(given_.lead);
        settle(Motion());
    }
    void settle(const Motion& m) noexcept {
        if (!finite(m.position) || !finite(m.velocity) || !finite(m.acceleration)) return out_.raise();
        state_.r.fill(m);
        state_.next = 0;
        out_.reset({m, read(0, lead_)});
    }

    void lead(time d) noexcept {
        if (!finite(d)) return out_.raise();
        const place wanted = placed(d);
        lead_ = wanted;
        limited_ = wanted.limited;
    }
    void retune(const preview& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        given_ = next.given_;
        lead_ = next.lead_;
        limited_ = next.limited_;
    }
    /// The motion d before the reference that the last step gave.
    Motion at(time d) const noexcept { return read(state_.next, placed(d)); }

    bool limited() const noexcept { return limited_; } ///< the last lead(d) was out of range
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    struct place {
        std::size_t whole = 0; ///< periods
        Real part{};           ///< of the next one; 0 ... 1
        bool limited = false;
    };
    place placed(time d) const noexcept {
        const number periods = d.value() / number(period_.value());
        if (!(periods >= number(0))) return {0, Real(0), true};
        // Capacity * period is no more than that, however its quotient rounds.
        if (periods >= number(double(Capacity)))
            return {Capacity, Real(0), d.value() > number(double(Capacity) * period_.value())};
        const double whole = std::floor(detail::plain(periods));
        return {std::size_t(whole), Real(periods - number(whole)), false};
    }
    static std::size_t after(std::size_t i, std::size_t steps) noexcept {
        return i + steps > Capacity ? i + steps - (Capacity + 1) : i + steps;
    }
    Motion read(std::size_t oldest, const place& p) const noexcept {
        const Motion& a = state_.r[after(oldest, p.whole)];
        if (p.whole == Capacity) return a; // the newest: no sample behind it
        const Motion& b = state_.r[after(oldest, p.whole + 1)];
        const Real h = Real(period_.value()), u = p.part;
        const Real da = a.acceleration.value() * h, db = b.acceleration.value() * h,
                   v = b.velocity.value() - a.velocity.value(), va = a.velocity.value() * h,
                   vb = b.velocity.value() * h, x = b.position.value() - a.position.value();
        Motion y;
        y.position = a.position + decltype(y.position)::from_value(hermite(x, va, vb, u));
        y.velocity = a.velocity + decltype(y.velocity)::from_value(hermite(v, da, db, u));
        y.acceleration = decltype(y.acceleration)::from_value(slope(v, da, db, u) / h);
        return y;
    }
    /// The cubic from 0 (slope p) to `rise` (slope q) at u in 0 ... 1, and its slope.
    static Real hermite(Real rise, Real p, Real q, Real u) noexcept {
        const Real c = p - rise, d = rise - q;
        return u * (rise + (Real(1) - u) * (c + u * (d - c)));
    }
    static Real slope(Real rise, Real p, Real q, Real u) noexcept {
        const Real c = p - rise, d = rise - q;
        return rise + (Real(1) - Real(2) * u) * (c + u * (d - c)) + u * (Real(1) - u) * (d - c);
    }

    parameters given_;
    duration period_;
    place lead_;
    bool limited_ = false;
    state state_;
    held_output<outcome> out_;
};

} // namespace quadrant::inline v0
