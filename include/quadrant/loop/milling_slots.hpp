// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/maps.hpp"
#include "../block/taps.hpp"
#include "cascade_slots.hpp"

#include <array>
#include <concepts>

/// What a `milling_axis` asks of each of its boxes, and the wires between them.
namespace quadrant::inline v0 {

/// A disturbance box that is fed this cycle's wish, solves the loop through its own estimate, and is told
/// afterwards what was applied.
template <class D, class Command, class Real>
concept fed_the_wish = requires(D d, quantity_of<Command, Real> u) {
    d.applied(u);
};
/// A disturbance box that is fed the command that acted since the sample before, and says so.
template <class D>
concept fed_the_last_applied = requires {
    requires D::takes_last_applied;
};
/// A disturbance box that is fed the measured acceleration and the command that acts at this sample, and says
/// so; `command()` is its estimate in units of the command. The axis is then called with the acceleration.
template <class D, class Command, class Real>
concept fed_the_acceleration = requires(D d, quantity_of<signal::acceleration, Real> a,
                                        quantity_of<Command, Real> u) {
    requires D::takes_acceleration;
    d(a, u);
    d.settle(a, u);
    { d.command() } -> std::same_as<quantity_of<Command, Real>>;
};
/// A box for the slot `disturbance`: estimate of what acts beside the command, in units of the command. Either
/// of two inputs, d(measured, u), which then states which u it is fed (`fed_the_wish`, `fed_the_last_applied`),
/// or of one, which `absent` is; or of acceleration and command (`fed_the_acceleration`).
template <class D, class Command, class Real>
concept observes_disturbance = maps<D, signal::position, Command, Real> ||
    fed_the_acceleration<D, Command, Real> ||
    ((fed_the_wish<D, Command, Real> ||
      fed_the_last_applied<D>)&&requires(D d, quantity_of<signal::position, Real> measured,
                                         quantity_of<Command, Real> u) {
        { d(measured, u) } -> std::same_as<quantity_of<Command, Real>>;
        d.reset();
    });

/// Boxes that estimate the velocities of reference and measured position in one box, `estimators`: those of an
/// axis in lanes (`velocity_pair`).
template <class B>
concept estimates_in_pair = requires(B b, quantity_of<signal::position, real_of_boxes<B>> x) {
    { b.estimators(x, x).reference } -> std::convertible_to<quantity_of<signal::velocity, real_of_boxes<B>>>;
    { b.estimators(x, x).measured } -> std::convertible_to<quantity_of<signal::velocity, real_of_boxes<B>>>;
    b.estimators.settle(x);
    b.estimators.retune(b.estimators);
    b.estimators.shift(x);
    b.estimators.reset();
};
/// Boxes that estimate each for itself.
template <class B>
concept estimates_apart = requires {
    requires maps<decltype(B::reference_velocity), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::reference_notch), signal::velocity, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::measured_velocity), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::measured_notch), signal::velocity, signal::velocity, real_of_boxes<B>>;
};

/// One box per role of a `milling_axis`. Write `static_assert(milling_boxes<my_axis>)` under your struct.
template <class B>
concept milling_boxes = requires {
    typename command_of<B>; // velocity_loop
    requires maps<decltype(B::memory), signal::position, signal::position, real_of_boxes<B>>;
    requires maps<decltype(B::position_loop), signal::position, signal::velocity, real_of_boxes<B>>;
    requires estimates_in_pair<B> || estimates_apart<B>;
    requires maps<decltype(B::velocity_loop), signal::velocity, command_of<B>>;
    requires maps<decltype(B::inertia), signal::acceleration, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::drag), signal::velocity, command_of<B>, real_of_boxes<B>>;
    requires observes_disturbance<decltype(B::disturbance), command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::travel), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::friction), signal::velocity, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::amplifier), command_of<B>, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::dac), command_of<B>, command_of<B>, real_of_boxes<B>>;
};

namespace detail {
template <class B>
concept retunable_estimators = requires {
    requires retunable<decltype(B::reference_velocity)>;
    requires retunable<decltype(B::reference_notch)>;
    requires retunable<decltype(B::measured_velocity)>;
    requires retunable<decltype(B::measured_notch)>;
};
template <class B>
concept shiftable_estimators = requires {
    requires shiftable<decltype(B::reference_velocity), signal::position, real_of_boxes<B>>;
    requires shiftable<decltype(B::measured_velocity), signal::position, real_of_boxes<B>>;
};
} // namespace detail

/// What the verb `retune` of a milling_axis asks of its slots, beside what every sample asks.
template <class B>
concept retunable_milling_boxes = milling_boxes<B> && requires {
    requires retunable<decltype(B::memory)>;
    requires retunable<decltype(B::position_loop)>;
    requires estimates_in_pair<B> || detail::retunable_estimators<B>;
    requires retunable_at<decltype(B::velocity_loop), signal::velocity, command_of<B>>;
    requires retunable<decltype(B::inertia)>;
    requires retunable<decltype(B::drag)>;
    requires retunable<decltype(B::disturbance)>;
    requires retunable<decltype(B::travel)>;
    requires retunable<decltype(B::friction)>;
    requires retunable<decltype(B::amplifier)>;
    requires retunable<decltype(B::dac)>;
};
/// What the verb `shift` of a milling_axis asks of its slots.
template <class B>
concept shiftable_milling_boxes = milling_boxes<B> && requires {
    requires estimates_in_pair<B> || detail::shiftable_estimators<B>;
    requires shiftable<decltype(B::disturbance), signal::position, real_of_boxes<B>> ||
        fed_the_acceleration<decltype(B::disturbance), command_of<B>, real_of_boxes<B>>; // knows no place
    requires shiftable<decltype(B::travel), signal::position, real_of_boxes<B>>;
};

/// Every wire of the diagram, readable after every step.
template <signal_tag Command, class Real> struct milling_wires {
    quantity_of<signal::position, Real> reference, measured, position_error, learned;
    quantity_of<signal::velocity, Real> reference_velocity, measured_velocity, demand, velocity_error, travel;
    quantity_of<Command, Real> feedback, inertia, drag, linear, disturbance, compensated, friction, wanted,
        limited, command;

    static constexpr auto taps() {
        using wires = milling_wires;
        return std::array{tap<signal::position, &wires::reference>("reference"),
                          tap<signal::position, &wires::measured>("measured"),
                          tap<signal::position, &wires::position_error>("position_error"),
                          tap<signal::position, &wires::learned>("learned"),
                          tap<signal::velocity, &wires::reference_velocity>("reference_velocity"),
                          tap<signal::velocity, &wires::measured_velocity>("measured_velocity"),
                          tap<signal::velocity, &wires::demand>("demand"),
                          tap<signal::velocity, &wires::velocity_error>("velocity_error"),
                          tap<signal::velocity, &wires::travel>("travel"),
                          tap<Command, &wires::feedback>("feedback"),
                          tap<Command, &wires::inertia>("inertia"),
                          tap<Command, &wires::drag>("drag"),
                          tap<Command, &wires::linear>("linear"),
                          tap<Command, &wires::disturbance>("disturbance"),
                          tap<Command, &wires::compensated>("compensated"),
                          tap<Command, &wires::friction>("friction"),
                          tap<Command, &wires::wanted>("wanted"),
                          tap<Command, &wires::limited>("limited"),
                          tap<Command, &wires::command>("command")};
    }
};

} // namespace quadrant::inline v0
