// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_parameters.hpp"

/// The controller of an axis for HAL: `milling_axis` with Stribeck friction, disturbance observer and
/// repetitive memory (`axis_parameters.hpp`). Pins for the wires come with the loop. For both axes of a table:
/// `quadrant_xy.hpp`.
namespace hal {

class hal_axis {
    using loop = quadrant::milling_axis<axis_boxes>;

public:
    static constexpr const char *component = "quadrant_axis", *prefix = "quadrant-axis";
    using wires = loop::wires;
    using parameters = axis_parameters;
    static constexpr auto list() { return parameters::list(); }

    using pins = axis_pins;

    hal_axis(const parameters& p, duration period)
        : given_(completed(p, period)), loop_{.box = {given_.box, period}}, asked_(period) {}

    static constexpr auto taps() { return loop::taps(); }
    const wires& wire() const noexcept { return loop_.wire; }

    /// Off: the loop goes along and takes 0 for its last output, so that it begins without a bump, also on the
    /// move.
    bool step(const pins& p) noexcept {
        const bool on = p.enable.get();
        fault_ = fault_ && on;
        if (!on) p.off();
        const length command = given_.metres(p.command.get()), feedback = given_.metres(p.feedback.get());
        if (!given_.inside(command) || !given_.inside(feedback)) {
            missed_ = true;
            known_ = known_ && on;
            fault_ = on;
            return !on;
        }
        if (!known_) { // at rest here, from now on
            loop_.settle(feedback);
            asked_.settle(command);
        } else if (missed_)
            asked_.resume(command);
        missed_ = false;
        const axis_motion& asked = asked_(command);
        if (on) {
            p.output.set(loop_(asked, feedback).value());
            p.saturated.set(loop_.limited());
            fault_ = fault_ || loop_.faulted();
        } else
            loop_.track(asked, feedback, {});
        known_ = on || !loop_.faulted();
        return !fault_;
    }

    /// Other parameters, also in motion: the first output after the change is off by no more than
    /// docs/integrator.md says. A memory that is switched on or off begins with nothing learnt.
    bool adopt(const hal_axis& next) noexcept {
        known_ = known_ && given_.scale == next.given_.scale; // other units: begins anew
        const bool switched = (given_.weight == 0) != (next.given_.weight == 0);
        if (switched) loop_.wire.learned = {};
        given_ = next.given_;
        loop_.retune(next.loop_.box, asked_.now());
        if (switched) loop_.box.memory.settle({}, {});
        return true;
    }

private:
    parameters given_;
    loop loop_;
    asked_motion asked_;
    bool known_ = false, missed_ = false, fault_ = false; ///< known: the loop has seen where the axis is
};

} // namespace hal
