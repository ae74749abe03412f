// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../block/absent.hpp"
#include "../block/maps.hpp"
#include "../block/taps.hpp"
#include "../control/quantizer.hpp"
#include "../filter/backward_difference.hpp"
#include "../plant/axis_load.hpp"
#include "../plant/linear_motor.hpp"

#include <array>
#include <tuple>

namespace quadrant::inline v0 {

/// One box per part of a `table_axis`. Write `static_assert(table_boxes<my_axis>)` under your struct.
template <class B>
concept table_boxes = requires(B b, quantity_of<signal::voltage, real_of<decltype(B::motor)>> command,
                               quantity_of<signal::force, real_of<decltype(B::motor)>> push) {
    { b.motor(command, push) } -> std::same_as<quantity_of<signal::position, real_of<decltype(B::motor)>>>;
    { b.motor.now().x } -> std::convertible_to<quantity_of<signal::position, real_of<decltype(B::motor)>>>;
    { b.motor.now().v } -> std::convertible_to<quantity_of<signal::velocity, real_of<decltype(B::motor)>>>;
    b.motor.given().mass;
    requires maps<decltype(B::change), signal::velocity, signal::acceleration, real_of<decltype(B::motor)>>;
    requires maps<decltype(B::scale), signal::position, signal::position, real_of<decltype(B::motor)>>;
    requires maps<decltype(B::encoder), signal::position, signal::position, real_of<decltype(B::motor)>>;
};

/// The stock boxes. Motor: `linear_motor` on any friction, with cogging, ripple and modes in its `axis_load`;
/// Scale: `cyclic_error`, or `through`.
template <class Motor = linear_motor<>, class Scale = through<signal::position, real_of<Motor>>>
struct table_axis_boxes {
    using real = real_of<Motor>;
    using number = parameter_real<real>; ///< of parameters

    /// The motor, the error of its scale, and the count of its encoder.
    struct parameters {
        typename Motor::parameters motor; ///< its encoder_step 0: the encoder has its own box
        typename Scale::parameters scale{};
        quantity_of<signal::position, number> encoder_step{}; ///< 0: none
    };
    table_axis_boxes(const parameters& p, duration period)
        : motor(checked(p), period), change({}, period), scale(p.scale, period),
          encoder({p.encoder_step}, period) {}

    Motor motor;
    backward_difference<signal::velocity, signal::acceleration, real> change; ///< of the rigid axis' velocity
    Scale scale;
    quantizer<signal::position, real> encoder;

private:
    static const typename Motor::parameters& checked(const parameters& p) {
        if constexpr (requires { p.motor.encoder_step; })
            require(p.motor.encoder_step == decltype(p.motor.encoder_step)(), "table_axis.motor.encoder_step",
                    p.motor.encoder_step, "must be 0 (the encoder is a box of its own)");
        if constexpr (requires { p.motor.load.modes.mass; })
            require(p.motor.load.modes.mass == p.motor.mass, "table_axis.motor.load.modes.mass",
                    p.motor.load.modes.mass,
                    "must be that of the motor (" + detail::shortest(p.motor.mass) + ")");
        return p.motor;
    }
};
static_assert(table_boxes<table_axis_boxes<>>);

/// Every wire of the diagram, readable after every step.
template <class Real> struct table_wires {
    quantity_of<signal::voltage, Real> command;
    quantity_of<signal::force, Real> external, coupling;
    quantity_of<signal::position, Real> rigid;
    quantity_of<signal::velocity, Real> velocity;
    quantity_of<signal::acceleration, Real> acceleration; ///< mean of the last period
    quantity_of<signal::position, Real> deflection, place, scale, reading;

    static constexpr auto taps() {
        using wires = table_wires;
        return std::array{tap<signal::voltage, &wires::command>("command"),
                          tap<signal::force, &wires::external>("external"),
                          tap<signal::force, &wires::coupling>("coupling"),
                          tap<signal::position, &wires::rigid>("rigid"),
                          tap<signal::velocity, &wires::velocity>("velocity"),
                          tap<signal::acceleration, &wires::acceleration>("acceleration"),
                          tap<signal::position, &wires::deflection>("deflection"),
                          tap<signal::position, &wires::place>("place"),
                          tap<signal::position, &wires::scale>("scale"),
                          tap<signal::position, &wires::reading>("reading")};
    }
};

/// One axis of a machine, as named boxes: motor on friction with its load (cogging, ripple, modes), scale,
/// encoder.
///   place = rigid + deflection of the modes,  reading = encoder(scale(place))
/// Source: docs/formats.md, whose effects the boxes are; [Jamaludin2008] chapter 2.
/// Ports: command u[k] [V] and the external force [N] held from sample k on in, reading [m] of sample k+1 out.
/// State: that of the boxes. `reset`: at rest at zero; `settle(x)`: at rest with the rigid axis at x, no
/// command pending.
/// NaN and infinities: returns the last reading, no box moves, raises faulted() until reset or settle.
/// Cost: that of the boxes. Two of them, coupled: `xy_table`. Without scale and modes: `linear_motor`.
template <table_boxes Boxes> struct table_axis {
    using input = signal::voltage;
    using output = signal::position;
    using real = real_of<decltype(Boxes::motor)>;
    using voltage = quantity_of<signal::voltage, real>;
    using force = quantity_of<signal::force, real>;
    using position = quantity_of<signal::position, real>;
    using wires = table_wires<real>;
    static_assert(every_wire_has_a_tap(wires::taps()));

    Boxes box;
    wires wire{};
    bool fault = false; ///< a sample was not finite; cleared by reset and settle

    position operator()(voltage command, force external = force(), force coupling = force()) noexcept {
        if (!finite(command, external, coupling)) {
            fault = true;
            return wire.reading;
        }
        wire.command = command;
        wire.external = external;
        wire.coupling = coupling;
        box.motor(command, external + coupling);
        wire.rigid = box.motor.now().x;
        wire.velocity = box.motor.now().v;
        wire.acceleration = box.change(wire.velocity);
        wire.deflection = deflection();
        wire.place = wire.rigid + wire.deflection;
        wire.scale = box.scale(wire.place);
        return wire.reading = box.encoder(wire.scale);
    }
    void settle(position x) noexcept {
        if (!finite(x)) {
            fault = true;
            return;
        }
        wire = {};
        box.motor.settle(x);
        wire.rigid = wire.place = x;
        wire.acceleration = detail::settled(box.change, wire.velocity);
        wire.scale = detail::settled(box.scale, x);
        wire.reading = detail::settled(box.encoder, wire.scale);
        fault = false;
    }
    void reset() noexcept { settle(position()); }
    bool faulted() const noexcept {
        return fault || detail::is_faulted(box.motor) || detail::is_faulted(box.change) ||
               detail::is_faulted(box.scale) || detail::is_faulted(box.encoder);
    }

    static constexpr auto taps() { return wires::taps(); }

private:
    position deflection() const noexcept {
        if constexpr (requires { box.motor.load().deflection(); })
            return box.motor.load().deflection();
        else
            return position();
    }
};

} // namespace quadrant::inline v0
