// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "in_lanes.hpp"
#include "xy_control.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// Both axes in lanes.
template <class Boxes>
class xy_control<in_lanes<Boxes>, in_lanes<Boxes>> : public xy_signals<command_of<Boxes>> {
    using signals = xy_signals<command_of<Boxes>>;
    using axis = milling_axis<typename in_lanes<Boxes>::together>;

public:
    using signals::sensible;
    using typename signals::command, typename signals::commands, typename signals::motion,
        typename signals::motions, typename signals::position, typename signals::positions;

    /// Those of both axes.
    struct parameters {
        typename Boxes::parameters x, y;
    };
    xy_control(const parameters& p, duration period) : both_{.box = in_lanes<Boxes>::of(p.x, p.y, period)} {}

    [[gnu::always_inline]] commands operator()(const motions& r, const positions& measured) noexcept {
        const auto now = packed(r);
        const auto seen = packed(measured);
        return step(now, now, seen, magnitude_of(now) + abs(seen.value()));
    }
    [[gnu::always_inline]] commands operator()(const motions& r, const motions& ahead,
                                               const positions& measured) noexcept {
        const auto now = packed(r), then = packed(ahead);
        const auto seen = packed(measured);
        return step(now, then, seen, (magnitude_of(now) + magnitude_of(then)) + abs(seen.value()));
    }
    void settle(const positions& at, const commands& hold = {}) noexcept {
        if (!sensible({}, at) || !sensible(hold)) return void(fault_ = true);
        both_.settle(packed(at), packed(hold));
        last_ = command_of_lanes();
        fault_ = broken_ = false;
    }
    void track(const motions& r, const motions& ahead, const positions& measured,
               const commands& applied) noexcept {
        if (!good(r, ahead, measured) || !sensible(applied)) return void(fault_ = true);
        both_.track(packed(r), packed(ahead), packed(measured), packed(applied));
        last_ = command_of_lanes();
    }
    void retune(const xy_control& next, const motions& ahead) noexcept {
        both_.retune(next.both_.box, packed(ahead));
    }
    void shift(const positions& by) noexcept {
        if (!sensible({}, by)) return void(fault_ = true);
        both_.shift(packed(by));
    }
    void reset() noexcept {
        both_.reset();
        last_ = {};
        fault_ = broken_ = false;
    }

    commands command_now() const noexcept { return last_; }
    bool limited_x() const noexcept { return !equal(both_.wire.limited, both_.wire.wanted)[0]; }
    bool limited_y() const noexcept { return !equal(both_.wire.limited, both_.wire.wanted)[1]; }
    bool limited() const noexcept { return both_.limited(); }
    bool faulted() const noexcept { return fault_ || both_.faulted(); }

    /// Every wire of the diagram by axis: f(axis 'x' or 'y', name, unit, value in SI).
    template <class F> void each_wire(F&& f) const {
        for (std::size_t lane = 0; lane < 2; ++lane)
            for (const auto& tap : axis::taps()) f("xy"[lane], tap.name, tap.unit, tap.read(both_.wire)[lane]);
    }

private:
    [[gnu::always_inline]] commands step(const typename axis::motion& now, const typename axis::motion& then,
                                         const typename axis::position& seen, const xy_number& sizes) noexcept {
        if (broken_ || !detail::is_sensible(sizes[0] + sizes[1])) [[unlikely]] {
            fault_ = true;
            return last_;
        }
        const xy_number u = both_(now, then, seen).value(), size = abs(u);
        if (!detail::is_sensible(size[0] + size[1])) [[unlikely]] {
            broken_ = fault_ = true;
            return last_;
        }
        return last_ = {.x = on_x(command::from_value(u[0])), .y = on_y(command::from_value(u[1]))};
    }
    static xy_number magnitude_of(const typename axis::motion& m) noexcept {
        return abs(m.position.value()) + (abs(m.velocity.value()) + abs(m.acceleration.value()));
    }
    static auto packed(const motions& r) noexcept {
        return typename axis::motion{detail::both(r.x.position, r.y.position),
                                     detail::both(r.x.velocity, r.y.velocity),
                                     detail::both(r.x.acceleration, r.y.acceleration)};
    }
    template <class Quantity> static auto packed(const xy<Quantity>& q) noexcept {
        return detail::both(q.x.plain(), q.y.plain());
    }
    commands command_of_lanes() const noexcept {
        const auto u = both_.wire.command.value();
        return {.x = on_x(command::from_value(u[0])), .y = on_y(command::from_value(u[1]))};
    }
    bool good(const motions& r, const motions& ahead, const positions& measured) noexcept {
        const bool all = sensible(r, measured) && (&r == &ahead || sensible(ahead, {})) && !broken_;
        fault_ = fault_ || !all;
        return all;
    }

    axis both_;
    commands last_{};
    bool fault_ = false, broken_ = false;
};

} // namespace quadrant::inline v0
