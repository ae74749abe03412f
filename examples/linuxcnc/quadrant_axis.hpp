// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hal_pins.hpp"
#include "switched_observer.hpp"

#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>

/// The controller of an axis for HAL: `milling_axis` with Stribeck friction, disturbance observer and
/// repetitive memory. Another friction law is another type below and its fields in `list()`; pins for the wires
/// come with the loop.
namespace hal {

class hal_axis {
    using friction = quadrant::stribeck<signal::velocity, signal::voltage>;
    using memory = quadrant::repetitive<signal::position, 8192>;
    using boxes = quadrant::milling_axis_boxes<friction, switched_observer, memory>;
    using loop = quadrant::milling_axis<boxes>;
    using length = loop::position;

public:
    static constexpr const char *component = "quadrant_axis", *prefix = "quadrant-axis";
    using wires = loop::wires;

    struct parameters {
        boxes::parameters box;
        duration delay{};             ///< of the axis: what the memory's filter is designed for
        quadrant::frequency corner{}; ///< of the memory's smoothing
        double weight = 0;            ///< of the memory, 0 ... 1; 0: off
        double scale = 1000;          ///< machine units per metre
        length range{};               ///< a position beyond it is a fault
    };
    static constexpr auto list() {
        using p = parameters;
        return std::array{
            field<p>("position-gain", 100, [](p& s) { return &s.box.position_gain; }),
            field<p>("velocity-gain", 0, [](p& s) { return &s.box.velocity_gain; }),
            field<p>("velocity-integral", 0, [](p& s) { return &s.box.velocity_integral; }),
            field<p>("estimator-corner", 150, [](p& s) { return &s.box.estimator_corner; }),
            field<p>("notch-centre", 330, [](p& s) { return &s.box.notch.centre; }),
            field<p>("notch-width", 0.06, [](p& s) { return &s.box.notch.width; }),
            field<p>("plant-gain", 1, [](p& s) { return &s.box.plant_gain; }),
            field<p>("plant-pole", 0, [](p& s) { return &s.box.plant_pole; }),
            field<p>("friction-coulomb", 0, [](p& s) { return &s.box.friction.coulomb; }),
            field<p>("friction-static", 0, [](p& s) { return &s.box.friction.static_level; }),
            field<p>("friction-velocity", 0.002, [](p& s) { return &s.box.friction.stribeck_velocity; }),
            field<p>("friction-viscous", 0, [](p& s) { return &s.box.friction.viscous; }),
            field<p>("friction-shape", 1, [](p& s) { return &s.box.friction.shape; }),
            field<p>("observer-on", 0, [](p& s) { return &s.box.disturbance.on; }),
            field<p>("observer-corner", 20, [](p& s) { return &s.box.disturbance.corner; }),
            field<p>("memory-weight", 0, [](p& s) { return &s.weight; }),
            field<p>("memory-cycle", 1, [](p& s) { return &s.box.memory.cycle; }),
            field<p>("memory-fade", 0, [](p& s) { return &s.box.memory.fade; }),
            field<p>("memory-corner", 50, [](p& s) { return &s.corner; }),
            field<p>("delay", 0, [](p& s) { return &s.delay; }),
            field<p>("limit", 10, [](p& s) { return &s.box.limit; }),
            field<p>("dac-step", 0, [](p& s) { return &s.box.dac_step; }),
            field<p>("scale", 1000, [](p& s) { return &s.scale; }),
            field<p>("range", 100, [](p& s) { return &s.range; })};
    }

    struct pins {
        real_pin command, feedback, output;
        bit_pin enable, saturated;
        explicit pins(pin_maker& maker) {
            maker.make(command, HAL_IN, "command");
            maker.make(feedback, HAL_IN, "feedback");
            maker.make(output, HAL_OUT, "output");
            maker.make(enable, HAL_IN, "enable");
            maker.make(saturated, HAL_OUT, "saturated");
        }
    };

    hal_axis(const parameters& p, duration period)
        : given_(completed(p, period)), period_(period), loop_{.box = {given_.box, period}},
          velocity_({}, period), acceleration_({}, period) {}

    static constexpr auto taps() { return loop::taps(); }
    const wires& wire() const noexcept { return loop_.wire; }

    /// Off: the loop goes along and takes 0 for its last output, so that it begins without a bump, also on the
    /// move.
    bool step(const pins& p) noexcept {
        const bool on = p.enable.get();
        fault_ = fault_ && on;
        if (!on) {
            p.output.set(0);
            p.saturated.set(false);
        }
        const length command = length::from_value(p.command.get() / given_.scale),
                     feedback = length::from_value(p.feedback.get() / given_.scale);
        if (!inside(command) || !inside(feedback)) {
            missed_ = true;
            known_ = known_ && on;
            fault_ = on;
            return !on;
        }
        if (!known_) { // at rest here, from now on
            loop_.settle(feedback);
            velocity_.settle(command);
            acceleration_.settle({});
        } else if (missed_)
            velocity_.settle(command - asked_.velocity * period_, asked_.velocity);
        missed_ = false;
        const auto speed = velocity_(command);
        asked_ = {command, speed, acceleration_(speed)};
        if (on) {
            p.output.set(loop_(asked_, feedback).value());
            p.saturated.set(loop_.limited());
            fault_ = fault_ || loop_.faulted();
        } else
            loop_.track(asked_, feedback, {});
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
        loop_.retune(next.loop_.box, asked_);
        if (switched) loop_.box.memory.settle({}, {});
        return true;
    }

private:
    bool inside(length x) const noexcept { return x >= -given_.range && x <= given_.range; } // NaN is not

    /// The observer compares with the plant that is fed forward; the memory's filters are made for loop and
    /// period.
    static parameters completed(parameters p, duration period) {
        namespace analysis = quadrant::analysis;
        quadrant::require_positive("quadrant_axis.scale", p.scale);
        quadrant::require_positive("quadrant_axis.range", p.range);
        quadrant::require_not_negative("quadrant_axis.delay", p.delay);
        quadrant::require(p.weight >= 0 && p.weight <= 1, "quadrant_axis.memory_weight", p.weight,
                          "must lie between 0 and 1");
        auto& box = p.box;
        quadrant::require(box.dac_step <= box.limit, "quadrant_axis.dac_step", box.dac_step,
                          "must not be above limit (" + quadrant::detail::shortest(box.limit) + ")");
        // How far the limit moves the axis in a period, beside the range: below a rounding of it the axis is no
        // axis.
        const double range = p.range.value(), push = box.limit.value() * period.value() * period.value(),
                     least = std::numeric_limits<double>::epsilon() * range / push, most = range / push;
        quadrant::require(box.plant_gain.value() >= least && box.plant_gain.value() <= most,
                          "quadrant_axis.plant_gain", box.plant_gain,
                          "must with limit move the axis by more than a rounding of range in a period, and by "
                          "less than range (" +
                              quadrant::detail::shortest(least) + " ... " + quadrant::detail::shortest(most) +
                              ")");
        static_cast<quadrant::disturbance_observer<signal::voltage>::parameters&>(box.disturbance).plant =
            quadrant::axis_model<signal::voltage>{box.plant_gain, box.plant_pole};
        if (p.weight == 0) {
            box.memory.weights = {0};
            box.memory.cycle = 1000.0 * period;
            box.memory.ahead = ahead;
            return p;
        }
        const analysis::rigid_axis_model<> axis{box.plant_pole, box.plant_gain, p.delay + 0.5 * period},
            nominal{box.plant_pole, box.plant_gain, duration()};
        const analysis::p_pi_loop inner{
            axis, analysis::pi_model<>{box.velocity_gain, box.velocity_integral},
            analysis::in_series{analysis::derivative_model{box.estimator_corner},
                                analysis::notch_model{box.notch.centre, box.notch.width}},
            box.position_gain};
        const analysis::q_model<> q{box.disturbance.corner};
        const analysis::p_pi_dob_loop observed{inner, q, analysis::q_inverse_model{q, nominal}};
        const auto closed = [&](quadrant::frequency f) {
            return box.disturbance.on != 0 ? observed.tracking(f) : inner.tracking(f);
        };
        const auto fade = box.memory.fade;
        const auto smooth = analysis::smoothing_filter<61>(p.corner, period);
        const auto learning = analysis::learning_filter<90>(closed, smooth, ahead, period);
        box.memory = analysis::repetitive_parameters<memory>(closed, std::array{p.weight}, learning, smooth,
                                                             box.memory.cycle, analysis::up_to_nyquist(period));
        box.memory.fade = fade;
        return p;
    }

    static constexpr std::size_t ahead = 30; ///< samples that the memory's filter looks ahead

    parameters given_;
    duration period_;
    loop loop_;
    quadrant::backward_difference<signal::position, signal::velocity> velocity_; ///< of the command
    quadrant::backward_difference<signal::velocity, signal::acceleration> acceleration_;
    loop::motion asked_{};
    bool known_ = false, missed_ = false, fault_ = false; ///< known: the loop has seen where the axis is
};

} // namespace hal
