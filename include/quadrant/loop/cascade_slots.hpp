// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/maps.hpp"
#include "../block/taps.hpp"

#include <array>

/// What a `cascade` asks of each of its boxes, and the wires between them.
namespace quadrant::inline v0 {

/// The signal that the velocity loop of a set of boxes puts out; every box behind it has to carry the same.
template <class Boxes> using command_of = typename decltype(Boxes::velocity_loop)::output;
/// The number type in which a set of boxes calculates.
template <class Boxes> using real_of_boxes = real_of<decltype(Boxes::velocity_loop)>;

/// One box per role, each mapping what its place in the diagram maps. Write
/// `static_assert(axis_boxes<my_axis>)` under your struct: the compiler then names the member that is missing
/// or maps something else.
template <class B>
concept axis_boxes = requires {
    typename command_of<B>; // velocity_loop
    requires maps<decltype(B::reference_velocity), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::reference_acceleration), signal::velocity, signal::acceleration,
                  real_of_boxes<B>>;
    requires maps<decltype(B::measured_velocity), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::position_loop), signal::position, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::velocity_feedforward), signal::velocity, signal::velocity, real_of_boxes<B>>;
    requires maps<decltype(B::velocity_loop), signal::velocity, command_of<B>>;
    requires maps<decltype(B::resonance), command_of<B>, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::acceleration_feedforward), signal::acceleration, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::friction), signal::velocity, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::amplifier), command_of<B>, command_of<B>, real_of_boxes<B>>;
    requires maps<decltype(B::dac), command_of<B>, command_of<B>, real_of_boxes<B>>;
};

/// What the verb `retune` of a cascade asks of its slots, beside what every sample asks. A loop of boxes that
/// cannot do it runs, and its `retune` is refused with the slot and the missing verb.
template <class B>
concept retunable_axis_boxes = axis_boxes<B> && requires {
    requires retunable<decltype(B::reference_velocity)>;
    requires retunable<decltype(B::reference_acceleration)>;
    requires retunable<decltype(B::measured_velocity)>;
    requires retunable<decltype(B::position_loop)>;
    requires retunable<decltype(B::velocity_feedforward)>;
    requires retunable_at<decltype(B::velocity_loop), signal::velocity, command_of<B>>;
    requires retunable<decltype(B::resonance)>;
    requires shiftable<decltype(B::resonance), command_of<B>, real_of_boxes<B>>;
    requires retunable<decltype(B::acceleration_feedforward)>;
    requires retunable<decltype(B::friction)>;
    requires retunable<decltype(B::amplifier)>;
    requires retunable<decltype(B::dac)>;
};
/// What the verb `shift` of a cascade asks of its slots.
template <class B>
concept shiftable_axis_boxes = axis_boxes<B> && requires {
    requires shiftable<decltype(B::reference_velocity), signal::position, real_of_boxes<B>>;
    requires shiftable<decltype(B::measured_velocity), signal::position, real_of_boxes<B>>;
};

/// Every wire of the diagram, readable after every step.
template <signal_tag Command, class Real> struct cascade_wires {
    quantity_of<signal::position, Real> reference, measured, position_error;
    quantity_of<signal::velocity, Real> reference_velocity, measured_velocity, demand, velocity_error;
    quantity_of<signal::acceleration, Real> reference_acceleration;
    quantity_of<Command, Real> feedback, damped, inertia, friction, wanted, limited, command;

    static constexpr auto taps() {
        using wires = cascade_wires;
        return std::array{tap<signal::position, &wires::reference>("reference"),
                          tap<signal::position, &wires::measured>("measured"),
                          tap<signal::position, &wires::position_error>("position_error"),
                          tap<signal::velocity, &wires::reference_velocity>("reference_velocity"),
                          tap<signal::velocity, &wires::measured_velocity>("measured_velocity"),
                          tap<signal::velocity, &wires::demand>("demand"),
                          tap<signal::velocity, &wires::velocity_error>("velocity_error"),
                          tap<signal::acceleration, &wires::reference_acceleration>("reference_acceleration"),
                          tap<Command, &wires::feedback>("feedback"),
                          tap<Command, &wires::damped>("damped"),
                          tap<Command, &wires::inertia>("inertia"),
                          tap<Command, &wires::friction>("friction"),
                          tap<Command, &wires::wanted>("wanted"),
                          tap<Command, &wires::limited>("limited"),
                          tap<Command, &wires::command>("command")};
    }
};

} // namespace quadrant::inline v0
