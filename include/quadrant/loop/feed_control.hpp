// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../block/absent.hpp"
#include "../block/taps.hpp"
#include "../control/axis_law.hpp"
#include "../control/limiter.hpp"
#include "../control/pid.hpp"
#include "../control/quantizer.hpp"
#include "../feedforward/preview.hpp"

#include <array>
#include <tuple>

namespace quadrant::inline v0 {

/// In the place of a `preview`, for a law that needs none.
template <motion_sample Motion> struct no_preview {
    struct parameters {};
    /// The motion of this sample, twice.
    struct outcome {
        Motion reference, ahead;
    };
    no_preview(const parameters&, duration) {}
    outcome operator()(const Motion& m) noexcept { return {m, m}; }
    void reset() noexcept {}
    void settle(const Motion&) noexcept {}
};

/// One box per role of a `feed_control`. Write `static_assert(control_boxes<my_control>)` under your struct.
template <class B>
concept control_boxes = requires(B b, const axis_motion<real_of<decltype(B::law)>>& motion) {
    requires axis_law<decltype(B::law)>;
    { b.preview(motion).reference } -> std::convertible_to<axis_motion<real_of<decltype(B::law)>>>;
    { b.preview(motion).ahead } -> std::convertible_to<axis_motion<real_of<decltype(B::law)>>>;
    requires maps<decltype(B::friction), signal::velocity, typename decltype(B::law)::output,
                  real_of<decltype(B::law)>>;
    requires maps<decltype(B::limit), typename decltype(B::law)::output, typename decltype(B::law)::output,
                  real_of<decltype(B::law)>>;
    requires maps<decltype(B::dac), typename decltype(B::law)::output, typename decltype(B::law)::output,
                  real_of<decltype(B::law)>>;
};

/// What the verb `retune` of a feed_control asks of its slots, beside what every sample asks.
template <class B>
concept retunable_control_boxes = control_boxes<B> && requires {
    requires retunable_law<decltype(B::law)>;
    requires retunable<decltype(B::friction)>;
    requires retunable<decltype(B::limit)>;
    requires retunable<decltype(B::dac)>;
};

namespace detail {
template <class Law> struct preview_of { using type = no_preview<axis_motion<real_of<Law>>>; };
template <class Law>
requires requires { Law::most_lead; }
struct preview_of<Law> {
    using type = preview<Law::most_lead, axis_motion<real_of<Law>>>;
};
} // namespace detail

/// The stock boxes around any control law. Friction: `friction_feedforward` on any static law, or `absent`.
template <axis_law Law = pid<>, class Friction = absent<signal::velocity, typename Law::output, real_of<Law>>>
struct feed_control_boxes {
    using command = typename Law::output;
    using real = real_of<Law>;
    using number = parameter_real<real>; ///< of parameters
    using preview_box = typename detail::preview_of<Law>::type;

    /// The law, what friction is fed forward, and what amplifier and converter can give.
    struct parameters {
        typename Law::parameters law;
        typename Friction::parameters friction{};
        quantity_of<command, number> limit;      ///< of the command, both ways, > 0; may be infinite
        quantity_of<command, number> dac_step{}; ///< 0: none
    };
    feed_control_boxes(const parameters& p, duration period)
        : law(p.law, period), preview(lead(law, period), period), friction(p.friction, period),
          limit({-p.limit, p.limit}, period), dac({p.dac_step}, period) {}

    Law law;
    preview_box preview;
    Friction friction;
    limiter<command, real> limit;
    quantizer<command, real> dac;

private:
    static typename preview_box::parameters lead([[maybe_unused]] const Law& law,
                                                 [[maybe_unused]] duration period) {
        if constexpr (requires { Law::most_lead; })
            return {number(static_cast<double>(law.lead())) * period};
        else
            return {};
    }
};
static_assert(control_boxes<feed_control_boxes<>>);

/// Every wire of the diagram, readable after every step.
template <signal_tag Command, class Real> struct feed_control_wires {
    quantity_of<signal::position, Real> reference, measured, position_error;
    quantity_of<signal::velocity, Real> reference_velocity, measured_velocity;
    quantity_of<signal::acceleration, Real> reference_acceleration, measured_acceleration;
    quantity_of<Command, Real> feedback, friction, wanted, limited, command;

    static constexpr auto taps() {
        using wires = feed_control_wires;
        return std::array{tap<signal::position, &wires::reference>("reference"),
                          tap<signal::position, &wires::measured>("measured"),
                          tap<signal::position, &wires::position_error>("position_error"),
                          tap<signal::velocity, &wires::reference_velocity>("reference_velocity"),
                          tap<signal::velocity, &wires::measured_velocity>("measured_velocity"),
                          tap<signal::acceleration, &wires::reference_acceleration>("reference_acceleration"),
                          tap<signal::acceleration, &wires::measured_acceleration>("measured_acceleration"),
                          tap<Command, &wires::feedback>("feedback"),
                          tap<Command, &wires::friction>("friction"),
                          tap<Command, &wires::wanted>("wanted"),
                          tap<Command, &wires::limited>("limited"),
                          tap<Command, &wires::command>("command")};
    }
};

/// The controller's side of one feed axis: any control law, friction of the reference fed forward, limit, D/A
/// converter. The machine's side is `feed_drive`; together they are an axis of a virtual CNC:
///   measured = drive(control(reference, measured));
///   u = round(limit(law(reference, x, v) + friction(v_ref)))
/// Source: [Yeung2006] Fig. 1, eq. (19).
/// Ports: motion of the trajectory and measurement of sample k in, command to act from sample k on out.
/// A law with a lead is asked so much later: wire.reference, which is what is due now, is what came in
/// most_lead samples ago.
/// State: that of the boxes. `reset`: at rest at zero; `settle(x, u)`: at rest at x, held by u.
/// `retune(next)`: other parameters from the next step on, each box as its own retune says. What friction and
/// gains change goes into what holds the axis in the law: the last step, done once more, would give the same
/// command.
/// NaN and infinities: returns the last command, no box moves, raises faulted() until reset or settle.
/// Cost: that of the boxes. limited() reports that the command was clipped; the law learns it.
template <control_boxes Boxes> struct feed_control {
    using command_signal = typename decltype(Boxes::law)::output;
    using real = real_of<decltype(Boxes::law)>;
    using position = quantity_of<signal::position, real>;
    using velocity = quantity_of<signal::velocity, real>;
    using command = quantity_of<command_signal, real>;
    using wires = feed_control_wires<command_signal, real>;
    static_assert(every_wire_has_a_tap(wires::taps()));

    Boxes box;
    wires wire{};
    bool fault = false; ///< a sample was not finite; cleared by reset and settle

    command operator()(const axis_motion<real>& reference, const axis_measurement<real>& measured) noexcept {
        if (!finite(reference.position, reference.velocity, reference.acceleration, measured.position,
                    measured.velocity, measured.acceleration)) {
            fault = true;
            return wire.command;
        }
        const auto known = box.preview(reference);
        wire.reference = known.reference.position;
        wire.reference_velocity = known.reference.velocity;
        wire.reference_acceleration = known.reference.acceleration;
        wire.measured = measured.position;
        wire.measured_velocity = measured.velocity;
        wire.position_error = wire.reference - wire.measured;
        wire.measured_acceleration = measured.acceleration;
        if constexpr (requires {
                          box.law(known.ahead, measured.position, measured.velocity, measured.acceleration);
                      })
            wire.feedback = box.law(known.ahead, measured.position, measured.velocity, measured.acceleration);
        else
            wire.feedback = box.law(known.ahead, measured.position, measured.velocity);
        wire.friction = box.friction(wire.reference_velocity);
        wire.wanted = wire.feedback + wire.friction;
        wire.limited = box.limit(wire.wanted);
        wire.command = box.dac(wire.limited);
        // What was cut off is charged to the law, whoever asked for too much.
        if constexpr (requires { box.law.applied(wire.feedback); })
            box.law.applied(wire.feedback + (wire.limited - wire.wanted));
        return wire.command;
    }
    void settle(position x, command hold = command()) noexcept {
        if (!finite(x, hold)) {
            fault = true;
            return;
        }
        wire = {};
        wire.reference = wire.measured = x;
        box.preview.settle({x, {}, {}});
        wire.friction = detail::settled(box.friction, velocity());
        wire.feedback = hold - wire.friction;
        box.law.settle(x, wire.feedback);
        wire.wanted = hold;
        wire.limited = detail::settled(box.limit, hold);
        wire.command = detail::settled(box.dac, wire.limited);
        fault = false;
    }
    void retune(const Boxes& next) noexcept requires retunable_control_boxes<Boxes> {
        detail::retune(box.friction, next.friction);
        detail::retune(box.limit, next.limit);
        detail::retune(box.dac, next.dac);
        wire.friction = detail::foreseen(box.friction, wire.reference_velocity);
        wire.feedback = wire.wanted - wire.friction;
        box.law.retune(next.law, {wire.reference, wire.reference_velocity, wire.reference_acceleration},
                       wire.measured, wire.measured_velocity, wire.feedback);
    }
    void reset() noexcept {
        std::apply([](auto&... each) { (each.reset(), ...); }, boxes(box));
        wire = {};
        fault = false;
    }

    bool limited() const noexcept { return wire.limited != wire.wanted; }
    bool faulted() const noexcept {
        return fault ||
               std::apply([](const auto&... each) { return (detail::is_faulted(each) || ...); }, boxes(box));
    }

    static constexpr auto taps() { return wires::taps(); }

private:
    static constexpr auto boxes(auto& b) noexcept {
        return std::tie(b.preview, b.law, b.friction, b.limit, b.dac);
    }
};

} // namespace quadrant::inline v0
