// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

namespace quadrant::inline v0 {

/// Two motors at the ends of one beam, seen as what they do together: moving it and turning it. Each gets a
/// loop of its own, and the loops do not disturb each other.
///   mean = c y1 + (1-c) y2,   skew = y1 - y2 - offset;   u1 = c u + w,   u2 = (1-c) u - w
/// u moves the centre of gravity and w turns the beam about it, when c is the share of the mass at end 1 (1/2:
/// in the middle).
///   const auto [mean, skew] = beam(y1, y2);
///   const auto drive = beam.split(mean_loop(r, mean), skew_loop(0_m, skew));   // each as for one axis
/// Source: rigid body; [Koren1980] couples two axes across each other for the same reason.
/// Ports: both readings in, mean and skew out; both loops' commands in, those of the motors out, with what
/// became of u and w.
/// At the limit of a motor w comes first: a beam that lags is late, a beam that racks breaks.
/// Homing: when both ends have found their index, `offset(d)` takes the skew of a square beam; the skew loop's
/// `shift(-change)` in the same sample keeps its command, and its reference then goes slowly to 0.
/// State: last outputs; `reset` leaves zeros; `settle(y1, y2)` clears the fault.
/// Range: 0 < share < 1; limit > 0, may be infinite. Both ends in the same frame and direction.
/// NaN and infinities: holds the last outputs, raises faulted().
/// Throws "gantry_pair.<field> = ...: must ..." for period, share, limit, offset.
/// Cost: 8 multiplications. Without a beam between them: two axes.
template <signal_tag Command = signal::force, class Real = double> class gantry_pair {
public:
    using position = quantity_of<signal::position, Real>;
    using value = quantity_of<Command, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Where the beam's mass lies, what its motors can give, how it stands when it is square.
    struct parameters {
        number share = number(1) / number(2);           ///< of the mass at end 1, 0 ... 1
        quantity_of<Command, number> limit;             ///< of each motor, > 0; infinite = none
        quantity_of<signal::position, number> offset{}; ///< y1 - y2 of a square beam
    };
    /// Position and racking of the beam [m].
    struct modes {
        position mean{}, skew{};
    };
    /// What both motors get, and what became of the commands of both loops.
    struct commands {
        value first{}, second{}; ///< of the motors
        value mean{}, skew{};    ///< what was left of u and w
    };
    /// The last outputs, for a sample that is not finite.
    struct state {
        modes seen{};
        commands given{};
    };

    gantry_pair(const parameters& p, duration period)
        : given_(p), first_(Real(p.share)), second_(Real(number(1) - p.share)), limit_(in_real<Real>(p.limit)),
          offset_(in_real<Real>(p.offset)) {
        require_positive<Real>("gantry_pair.period", period);
        require(detail::plain(p.share) > 0 && detail::plain(p.share) < 1, "gantry_pair.share", p.share,
                "must lie between 0 and 1");
        require(detail::plain(p.limit) > 0, "gantry_pair.limit", p.limit,
                "must be above 0 (infinite: no limit)");
        require_finite<Real>("gantry_pair.offset", p.offset);
    }

    modes operator()(position first, position second) noexcept {
        const modes y{first_ * first + second_ * second, first - second - offset_};
        if (finite(y.mean, y.skew))
            state_.seen = y;
        else
            fault_ = true;
        return state_.seen;
    }
    commands split(value u, value w) noexcept {
        if (!finite(u, w)) {
            fault_ = true;
            return state_.given;
        }
        w = within(w, -limit_, limit_);
        // -limit <= c u + w <= limit and -limit <= (1-c) u - w <= limit; each holds u = 0 in between.
        u = within(u, (-limit_ - w) / first_, (limit_ - w) / first_);
        u = within(u, (w - limit_) / second_, (limit_ + w) / second_);
        return state_.given = {first_ * u + w, second_ * u - w, u, w};
    }
    void reset() noexcept {
        state_ = {};
        offset_ = in_real<Real>(given_.offset);
        fault_ = false;
    }
    void settle(position first, position second) noexcept {
        const bool good = finite(first, second);
        if (good) (*this)(first, second);
        fault_ = !good;
    }

    void offset(position d) noexcept {
        finite(d) ? void(offset_ = d) : void(fault_ = true);
    } ///< from the next sample on
    position offset() const noexcept { return offset_; }
    bool limited() const noexcept { ///< at least one motor is at its limit
        const auto at = [&](value u) { return u >= limit_ || -u >= limit_; };
        return at(state_.given.first) || at(state_.given.second);
    }
    bool faulted() const noexcept { return fault_; }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static value within(value x, value low, value high) noexcept { return x > high ? high : x < low ? low : x; }

    parameters given_;
    Real first_, second_;
    value limit_;
    position offset_;
    state state_;
    bool fault_ = false;
};

} // namespace quadrant::inline v0
