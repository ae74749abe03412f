// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/along.hpp"
#include "milling_axis.hpp"

#include <cstdint>

namespace quadrant::inline v0 {

namespace detail {
/// Beyond this an input is no place, speed or acceleration of a machine (SI), and behind it products may
/// overflow.
inline constexpr double sensible_input = 0x1p199; // 8e59
/// Is a sum of magnitudes below that? By its bits: a NaN is not.
constexpr bool is_sensible(double sum_of_magnitudes) noexcept {
    return bits_as<std::uint64_t>(sum_of_magnitudes) < bits_as<std::uint64_t>(sensible_input);
}
constexpr double magnitude(double x) noexcept {
    return bits_as<double>(bits_as<std::uint64_t>(x) & 0x7fff'ffff'ffff'ffff);
}
template <class Unit> constexpr double magnitude(const quantity<Unit>& x) noexcept {
    return magnitude(x.value());
}
template <class Motion> constexpr double magnitude_of(const Motion& m) noexcept {
    return magnitude(m.position) + (magnitude(m.velocity) + magnitude(m.acceleration));
}
} // namespace detail

/// What goes into an `xy_control` and what comes out. A pair of quantities is made by name: {.x = on_x(a), .y =
/// on_y(b)}.
template <signal_tag Command> struct xy_signals {
    using motion = axis_motion<double>;
    using position = quantity_of<signal::position>;
    using command = quantity_of<Command>;
    using positions = xy<position>;
    using commands = xy<command>;
    /// What the trajectory asks of both axes at one moment.
    struct motions {
        motion x, y;
    };

    static bool sensible(const motions& r, const positions& y) noexcept {
        return detail::is_sensible((detail::magnitude_of(r.x) + detail::magnitude_of(r.y)) +
                                   (detail::magnitude(y.x.plain()) + detail::magnitude(y.y.plain())));
    }
    static bool sensible(const commands& u) noexcept { return sensible_pair(u); }
    template <class Quantity> static bool sensible_pair(const xy<Quantity>& q) noexcept {
        return detail::is_sensible(detail::magnitude(q.x.plain()) + detail::magnitude(q.y.plain()));
    }
};

/// The controllers of both axes of a table as one block: one `milling_axis` each, everything that its boxes
/// name in it.
///   (u_x, u_y) = (milling_axis<X>(r_x, y_x), milling_axis<Y>(r_y, y_y))
/// Two forms with the same calls: `xy_control<X, Y>` holds two axes of boxes of their own;
/// `xy_control<in_lanes<X>>` (`xy_control_lanes.hpp`) holds both axes, of the same kind and with parameters of
/// their own, in the lanes of one register, in under half the instructions. They differ by rounding (other
/// order of the memory's sums, the exponential of the lanes).
/// Source: [Jamaludin2008] chapters 2 to 5; `milling_axis` says which equations.
/// Ports: motions of both axes and measured positions in, commands out, to act from this sample on; `ahead` as
/// `milling_axis` has it. With a `ferraris_force_estimator` in an axis the measured accelerations as well.
/// State: that of both axes. `reset`, `settle(at, hold)`, `track`, `retune(next, ahead)`, `shift`: as
/// `milling_axis`, both at once. `retune` takes a loop that was built beside, out of the servo thread, with the
/// parameters that are to come. NaN, infinities, and magnitudes whose sum is above 8e59 (SI) in any input:
/// returns the last commands, neither axis moves, raises faulted(): a table that has lost one of its encoders
/// has to stop as a whole. In lanes no box looks at its numbers: should one overflow inside, the command shows
/// it, and the loop holds the last one until reset or settle. Throws what the boxes throw, in their names; in
/// lanes "in_lanes.<field> = ...: must be the same on both axes" (ahead, fade, shape).
/// Cost: that of both axes. With the table behind it: `xy_loop`.
template <class X, class Y = X> class xy_control : public xy_signals<command_of<X>> {
    using signals = xy_signals<command_of<X>>;

public:
    using signals::sensible;
    using typename signals::command, typename signals::commands, typename signals::motion,
        typename signals::motions, typename signals::position, typename signals::positions;
    static_assert(milling_boxes<X> && milling_boxes<Y>);
    /// True where an axis wants the measured acceleration: every call then has to give both.
    static constexpr bool takes_acceleration =
        milling_axis<X>::takes_acceleration || milling_axis<Y>::takes_acceleration;
    using accelerations =
        xy<quantity_of<signal::acceleration>>; ///< measured; that of an axis that wants none is not read

    /// Those of both axes.
    struct parameters {
        typename X::parameters x;
        typename Y::parameters y;
    };
    xy_control(const parameters& p, duration period) : x_{.box = {p.x, period}}, y_{.box = {p.y, period}} {}

    [[gnu::always_inline]] commands operator()(const motions& r, const positions& measured) noexcept
        requires(!takes_acceleration) {
        return (*this)(r, r, measured);
    }
    [[gnu::always_inline]] commands operator()(const motions& r, const motions& ahead,
                                               const positions& measured) noexcept
        requires(!takes_acceleration) {
        if (!good(r, ahead, measured)) return command_now();
        const command ux = x_(r.x, ahead.x, measured.x), uy = y_(r.y, ahead.y, measured.y);
        return {.x = on_x(ux), .y = on_y(uy)};
    }
    commands operator()(const motions& r, const motions& ahead, const positions& measured,
                        const accelerations& accelerated) noexcept requires takes_acceleration {
        if (!good(r, ahead, measured) || !signals::sensible_pair(accelerated)) {
            fault_ = true;
            return command_now();
        }
        const command ux = given_acceleration(x_, r.x, ahead.x, measured.x, accelerated.x),
                      uy = given_acceleration(y_, r.y, ahead.y, measured.y, accelerated.y);
        return {.x = on_x(ux), .y = on_y(uy)};
    }
    void settle(const positions& at, const commands& hold = {}) noexcept {
        if (!sensible({}, at) || !sensible(hold)) return void(fault_ = true);
        x_.settle(at.x, hold.x);
        y_.settle(at.y, hold.y);
        fault_ = false;
    }
    void track(const motions& r, const motions& ahead, const positions& measured, const commands& applied,
               const accelerations& accelerated) noexcept requires takes_acceleration {
        if (!good(r, ahead, measured) || !sensible(applied) || !signals::sensible_pair(accelerated))
            return void(fault_ = true);
        x_.track(r.x, ahead.x, measured.x, applied.x, accelerated.x);
        y_.track(r.y, ahead.y, measured.y, applied.y, accelerated.y);
    }
    void track(const motions& r, const motions& ahead, const positions& measured,
               const commands& applied) noexcept requires(!takes_acceleration) {
        if (!good(r, ahead, measured) || !sensible(applied)) return void(fault_ = true);
        x_.track(r.x, ahead.x, measured.x, applied.x);
        y_.track(r.y, ahead.y, measured.y, applied.y);
    }
    void retune(const xy_control& next, const motions& ahead) noexcept {
        x_.retune(next.x_.box, ahead.x);
        y_.retune(next.y_.box, ahead.y);
    }
    void shift(const positions& by) noexcept {
        if (!sensible({}, by)) return void(fault_ = true);
        x_.shift(by.x);
        y_.shift(by.y);
    }
    void reset() noexcept {
        x_.reset();
        y_.reset();
        fault_ = false;
    }

    commands command_now() const noexcept { return {.x = on_x(x_.wire.command), .y = on_y(y_.wire.command)}; }
    bool limited_x() const noexcept { return x_.limited(); }
    bool limited_y() const noexcept { return y_.limited(); }
    bool limited() const noexcept { return limited_x() || limited_y(); }
    bool faulted() const noexcept { return fault_ || x_.faulted() || y_.faulted(); }

    /// Every wire of the diagram by axis: f(axis 'x' or 'y', name, unit, value in SI).
    template <class F> void each_wire(F&& f) const {
        for_each_tap(x_.wire, x_.taps(), [&](auto... tap) { f('x', tap...); });
        for_each_tap(y_.wire, y_.taps(), [&](auto... tap) { f('y', tap...); });
    }
    const milling_axis<X>& x() const noexcept { return x_; }
    const milling_axis<Y>& y() const noexcept { return y_; }
    milling_axis<X>& x() noexcept { return x_; } ///< for a box that follows the machine: the cycle of a memory
    milling_axis<Y>& y() noexcept { return y_; }

private:
    template <class Axis>
    static command given_acceleration(Axis& axis, const motion& r, const motion& ahead,
                                      const position& measured,
                                      const quantity_of<signal::acceleration>& accelerated) noexcept {
        if constexpr (Axis::takes_acceleration)
            return axis(r, ahead, measured, accelerated);
        else
            return axis(r, ahead, measured);
    }
    bool good(const motions& r, const motions& ahead, const positions& measured) noexcept {
        const bool all = sensible(r, measured) && (&r == &ahead || sensible(ahead, {}));
        fault_ = fault_ || !all;
        return all;
    }

    milling_axis<X> x_;
    milling_axis<Y> y_;
    bool fault_ = false;
};

} // namespace quadrant::inline v0
