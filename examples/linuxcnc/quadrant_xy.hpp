// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_parameters.hpp"

#include <quadrant/loop/xy_loop.hpp>

#include <stdexcept>
#include <string>
#include <utility>

/// The whole loop of an xy-table for HAL: `xy_loop` with the boxes of `axis_parameters.hpp` on both axes, and
/// the machine behind the pins as its table.
namespace hal {

/// The table of an `xy_loop` that is a machine: its readings come in before the call, the commands are fetched
/// after it.
class machine_table {
public:
    struct parameters {};
    using commands = quadrant::xy<quadrant::quantity_of<signal::voltage>>;
    using forces = quadrant::xy<quadrant::quantity_of<signal::force>>;
    using positions = quadrant::xy<length>;

    machine_table(const parameters&, duration) {}

    void read(const positions& now) noexcept { at_ = now; }
    const commands& asked() const noexcept { return asked_; }

    positions operator()(const commands& u, const forces&) noexcept {
        asked_ = u;
        return at_;
    }
    positions reading() const noexcept { return at_; }
    bool faulted() const noexcept { return false; }
    void settle(const positions& at) noexcept {
        at_ = at;
        asked_ = {};
    }
    void reset() noexcept { settle({}); }

private:
    positions at_{};
    commands asked_{};
};

/// The parameters of both axes.
struct xy_parameters {
    axis_parameters x, y;
};
using xy_machine_loop = quadrant::xy_loop<axis_boxes, axis_boxes, machine_table>;
using xy_machine_control = xy_machine_loop::control_type;
using xy_machine_axis = quadrant::milling_axis<axis_boxes>;

namespace detail {
/// A name with its axis in front.
struct axis_name {
    std::array<char, HAL_NAME_LEN + 1> text{};
    constexpr axis_name(char axis, const char* name) {
        text[0] = axis;
        text[1] = '.';
        for (std::size_t i = 2; *name != 0; ++i, ++name) text[i] = *name;
    }
};
/// Parameter and wire number I of an axis, as one of both.
template <char Axis, std::size_t I> struct field_of {
    static constexpr auto one = axis_parameters::list()[I];
    static constexpr axis_name name{Axis, one.name};
    static void set(xy_parameters& p, double value) { one.set(Axis == 'x' ? p.x : p.y, value); }
    static constexpr parameter<xy_parameters> field{name.text.data(), one.standard, &set};
};
template <char Axis, std::size_t I> struct wire_of {
    static constexpr auto one = xy_machine_axis::taps()[I];
    static constexpr axis_name name{Axis, one.name};
    static double read(const xy_machine_control& c) noexcept {
        return one.read(Axis == 'x' ? c.x().wire : c.y().wire);
    }
    static constexpr quadrant::tap_of<xy_machine_control, double> tap{name.text.data(), one.unit, &read,
                                                                      nullptr, one.bytes};
};
} // namespace detail

class hal_xy {
    using loop = xy_machine_loop;
    using control = xy_machine_control;
    using axis = xy_machine_axis;

public:
    static constexpr const char *component = "quadrant_xy", *prefix = "quadrant-xy";
    using wires = control;

    using parameters = xy_parameters;
    /// x.position-gain, ..., y.position-gain, ...
    static constexpr auto list() {
        return []<std::size_t... I>(std::index_sequence<I...>) {
            return std::array{detail::field_of<'x', I>::field..., detail::field_of<'y', I>::field...};
        }
        (std::make_index_sequence<axis_parameters::list().size()>());
    }
    /// wire.x.reference, ..., wire.y.reference, ...
    static constexpr auto taps() {
        return []<std::size_t... I>(std::index_sequence<I...>) {
            return std::array{detail::wire_of<'x', I>::tap..., detail::wire_of<'y', I>::tap...};
        }
        (std::make_index_sequence<axis::taps().size()>());
    }
    struct pins {
        axis_pins x, y;
        explicit pins(pin_maker& maker) : x(maker, "x."), y(maker, "y.") {}
    };

    hal_xy(const parameters& p, duration period)
        : given_{completed("x: ", p.x, period), completed("y: ", p.y, period)},
          loop_({.control = {given_.x.box, given_.y.box}, .table = {}}, period), asked_x_(period),
          asked_y_(period) {}

    const wires& wire() const noexcept { return loop_.control(); }

    /// The table is on when both axes are: one that has lost an encoder stops as a whole. Off: the loop goes
    /// along and takes 0 for its last outputs, so that it begins without a bump, also on the move.
    bool step(const pins& p) noexcept {
        const bool on = p.x.enable.get() && p.y.enable.get();
        fault_ = fault_ && on;
        if (!on) p.x.off(), p.y.off();
        const length to_x = given_.x.metres(p.x.command.get()), to_y = given_.y.metres(p.y.command.get()),
                     at_x = given_.x.metres(p.x.feedback.get()), at_y = given_.y.metres(p.y.feedback.get());
        if (!given_.x.inside(to_x) || !given_.x.inside(at_x) || !given_.y.inside(to_y) ||
            !given_.y.inside(at_y)) {
            missed_ = true;
            known_ = known_ && on;
            fault_ = on;
            return !on;
        }
        const machine_table::positions at{.x = quadrant::on_x(at_x), .y = quadrant::on_y(at_y)};
        if (!known_) { // at rest here, from now on
            loop_.settle(at);
            asked_x_.settle(to_x), asked_y_.settle(to_y);
        } else if (missed_)
            asked_x_.resume(to_x), asked_y_.resume(to_y);
        missed_ = false;
        const control::motions asked{asked_x_(to_x), asked_y_(to_y)};
        if (on) {
            loop_.table().read(at);
            loop_(asked);
            p.x.output.set(loop_.table().asked().x.plain().value());
            p.y.output.set(loop_.table().asked().y.plain().value());
            p.x.saturated.set(loop_.control().limited_x());
            p.y.saturated.set(loop_.control().limited_y());
            fault_ = fault_ || loop_.faulted();
        } else
            loop_.control().track(asked, asked, at, {});
        known_ = on || !loop_.faulted();
        return !fault_;
    }

    /// As `hal_axis`, both axes at once.
    bool adopt(const hal_xy& next) noexcept {
        known_ = known_ && given_.x.scale == next.given_.x.scale && given_.y.scale == next.given_.y.scale;
        const bool switched_x = (given_.x.weight == 0) != (next.given_.x.weight == 0),
                   switched_y = (given_.y.weight == 0) != (next.given_.y.weight == 0);
        axis &x = loop_.control().x(), &y = loop_.control().y();
        if (switched_x) x.wire.learned = {};
        if (switched_y) y.wire.learned = {};
        given_ = next.given_;
        loop_.retune(next.loop_, {asked_x_.now(), asked_y_.now()});
        if (switched_x) x.box.memory.settle({}, {});
        if (switched_y) y.box.memory.settle({}, {});
        return true;
    }

private:
    /// What is refused says of which axis.
    static axis_parameters completed(const char* axis, const axis_parameters& p, duration period) try {
        const axis_parameters whole = hal::completed(p, period);
        axis_boxes(whole.box, period);
        return whole;
    } catch (const quadrant::invalid_parameter& refused) {
        throw std::invalid_argument(axis + std::string(refused.what()));
    }

    parameters given_;
    loop loop_;
    asked_motion asked_x_, asked_y_;
    bool known_ = false, missed_ = false, fault_ = false; ///< known: the loop has seen where the table is
};

} // namespace hal
