// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hal_pins.hpp"
#include "switched_observer.hpp"

#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>

/// What the controllers of one axis and of a whole table have in common in HAL: the boxes of an axis, its
/// parameters, and the motion that a position command asks for. Another friction law is another type below, and
/// its fields in `list()`.
namespace hal {

using axis_friction = quadrant::stribeck<signal::velocity, signal::voltage>;
using axis_memory = quadrant::repetitive<signal::position, 8192>;
using axis_boxes = quadrant::milling_axis_boxes<axis_friction, switched_observer, axis_memory>;
using axis_motion = quadrant::axis_motion<double>;
using length = quantity<quadrant::si::length>;

/// Parameters of an axis, each of them a pin.
struct axis_parameters {
    axis_boxes::parameters box;
    duration delay{};             ///< of the axis: what the memory's filter is designed for
    quadrant::frequency corner{}; ///< of the memory's smoothing
    double weight = 0;            ///< of the memory, 0 ... 1; 0: off
    double scale = 1000;          ///< machine units per metre
    length range{};               ///< a position beyond it is a fault

    static constexpr auto list() {
        using p = axis_parameters;
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

    /// From machine units.
    length metres(double x) const noexcept { return length::from_value(x / scale); }
    bool inside(length x) const noexcept { return x >= -range && x <= range; } // NaN is not
};

/// The observer compares with the plant that is fed forward; the memory's filters are made for loop and period.
inline axis_parameters completed(axis_parameters p, duration period) {
    constexpr std::size_t ahead = 30; // samples that the memory's filter looks ahead
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
                          quadrant::detail::shortest(least) + " ... " + quadrant::detail::shortest(most) + ")");
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
    box.memory = analysis::repetitive_parameters<axis_memory>(
        closed, std::array{p.weight}, learning, smooth, box.memory.cycle, analysis::up_to_nyquist(period));
    box.memory.fade = fade;
    return p;
}

/// The signals of an axis. `axis` stands in front of their names: "x." where a component has two.
struct axis_pins {
    real_pin command, feedback, output;
    bit_pin enable, saturated;
    explicit axis_pins(pin_maker& maker, const std::string& axis = "") {
        maker.make(command, HAL_IN, axis + "command");
        maker.make(feedback, HAL_IN, axis + "feedback");
        maker.make(output, HAL_OUT, axis + "output");
        maker.make(enable, HAL_IN, axis + "enable");
        maker.make(saturated, HAL_OUT, axis + "saturated");
    }
    void off() const noexcept {
        output.set(0);
        saturated.set(false);
    }
};

/// What the planner asks of an axis at one moment: its position command, and the differences of it.
class asked_motion {
public:
    explicit asked_motion(duration period)
        : period_(period), velocity_({}, period), acceleration_({}, period) {}

    void settle(length command) noexcept { // at rest
        velocity_.settle(command);
        acceleration_.settle({});
    }
    /// Samples are missing before the coming command: it is reached at the velocity of the last one.
    void resume(length command) noexcept {
        velocity_.settle(command - asked_.velocity * period_, asked_.velocity);
    }
    const axis_motion& operator()(length command) noexcept {
        const auto speed = velocity_(command);
        return asked_ = {command, speed, acceleration_(speed)};
    }
    const axis_motion& now() const noexcept { return asked_; }

private:
    duration period_;
    quadrant::backward_difference<signal::position, signal::velocity> velocity_;
    quadrant::backward_difference<signal::velocity, signal::acceleration> acceleration_;
    axis_motion asked_{};
};

} // namespace hal
