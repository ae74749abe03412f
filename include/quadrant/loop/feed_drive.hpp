// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../block/absent.hpp"
#include "../block/taps.hpp"
#include "../control/axis_law.hpp"
#include "../control/limiter.hpp"
#include "../control/proportional.hpp"
#include "../control/quantizer.hpp"
#include "../filter/backward_difference.hpp"
#include "../plant/backlash.hpp"
#include "../plant/ball_screw_drive.hpp"
#include "../sensor/white_noise.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <tuple>

namespace quadrant::inline v0 {

/// One box per part of a `feed_drive`. Write `static_assert(drive_boxes<my_drive>)` under your struct.
template <class B>
concept drive_boxes =
    requires(B b, quantity_of<typename decltype(B::drive)::input, real_of<decltype(B::drive)>> effort,
             quantity_of<signal::force, real_of<decltype(B::drive)>> push) {
    requires maps<decltype(B::amplifier), signal::voltage, typename decltype(B::drive)::input,
                  real_of<decltype(B::drive)>>;
    requires maps<decltype(B::effort_limit), typename decltype(B::drive)::input,
                  typename decltype(B::drive)::input, real_of<decltype(B::drive)>>;
    { b.drive(effort, push) } -> std::same_as<quantity_of<signal::position, real_of<decltype(B::drive)>>>;
    { b.drive.now().v } -> std::convertible_to<quantity_of<signal::velocity, real_of<decltype(B::drive)>>>;
    requires maps<decltype(B::lead), signal::position, signal::position, real_of<decltype(B::drive)>>;
    requires maps<decltype(B::change), signal::velocity, signal::acceleration, real_of<decltype(B::drive)>>;
    requires maps<decltype(B::table), signal::acceleration, signal::force, real_of<decltype(B::drive)>>;
    requires maps<decltype(B::screw), signal::force, signal::position, real_of<decltype(B::drive)>>;
    requires maps<decltype(B::play), signal::position, signal::position, real_of<decltype(B::drive)>>;
    { b.encoder_noise() } -> std::same_as<quantity_of<signal::position, real_of<decltype(B::drive)>>>;
    requires maps<decltype(B::encoder), signal::position, signal::position, real_of<decltype(B::drive)>>;
    { b.tachometer_noise() } -> std::same_as<quantity_of<signal::velocity, real_of<decltype(B::drive)>>>;
    { b.accelerometer_noise() } -> std::same_as<quantity_of<signal::acceleration, real_of<decltype(B::drive)>>>;
    { b.scale_on_table } -> std::convertible_to<bool>;
};

/// The stock boxes. Drive: `ball_screw_drive` on any friction, or `linear_motor` (without limits, rounding and
/// encoder of its own; play, screw and lead error then stay 0). Lead: what the screw's lead is wrong by, as a
/// map of positions: `through`, `proportional` (1 + error per metre), `cyclic_error`, or a `series` of them.
template <class Drive = ball_screw_drive<>, class Lead = through<signal::position, real_of<Drive>>>
struct feed_drive_boxes {
    using real = real_of<Drive>;
    using number = parameter_real<real>; ///< of parameters
    using effort = typename Drive::input;

    /// Amplifier, drive, errors of screw and play, and what encoder and tachometer make of the motion.
    struct parameters {
        gain_of<effort, signal::voltage, number> amplifier; ///< Ka; finite
        quantity_of<effort, number> effort_limit = quantity_of<effort, number>::from_value(
            number(std::numeric_limits<double>::infinity())); ///< both ways, of motor or amplifier; >= 0
        typename Drive::parameters drive;
        typename Lead::parameters lead{};
        quantity<si::mass, number> table_mass{}; ///< that bends the screw; 0: does not bend it
        gain_of<signal::position, signal::force, number> compliance{};   ///< of screw and nut; 0: rigid
        quantity_of<signal::position, number> backlash{};                ///< from flank to flank; >= 0
        quantity_of<signal::position, number> encoder_step{};            ///< 0: none
        quantity_of<signal::position, number> encoder_noise{};           ///< standard deviation; 0: none
        quantity_of<signal::velocity, number> tachometer_noise{};        ///< standard deviation; 0: none
        quantity_of<signal::acceleration, number> accelerometer_noise{}; ///< standard deviation; 0: none
        std::uint64_t seed = 1; ///< of the noise; another for every axis
        bool scale_on_table =
            true; ///< else the encoder sits on the motor and does not see lead error, screw and play
    };
    feed_drive_boxes(const parameters& p, duration period)
        : amplifier({p.amplifier}, period), effort_limit({-p.effort_limit, p.effort_limit}, period),
          drive(p.drive, period), lead(p.lead, period), change({}, period),
          table({gain_of<signal::force, signal::acceleration, number>(p.table_mass)}, period),
          screw({p.compliance}, period), play({p.backlash}, period),
          encoder_noise({p.encoder_noise, 2 * p.seed}, period), encoder({p.encoder_step}, period),
          tachometer_noise({p.tachometer_noise, 2 * p.seed + 1}, period),
          accelerometer_noise({p.accelerometer_noise, ~p.seed}, period), scale_on_table(p.scale_on_table) {}

    proportional<signal::voltage, effort, real> amplifier;
    limiter<effort, real> effort_limit;
    Drive drive;
    Lead lead;
    backward_difference<signal::velocity, signal::acceleration, real> change;
    proportional<signal::acceleration, signal::force, real> table;
    proportional<signal::force, signal::position, real> screw;
    backlash<signal::position, real> play;
    white_noise<signal::position, real> encoder_noise;
    quantizer<signal::position, real> encoder;
    white_noise<signal::velocity, real> tachometer_noise;
    white_noise<signal::acceleration, real> accelerometer_noise;
    bool scale_on_table;
};
static_assert(drive_boxes<feed_drive_boxes<>>);

/// Every wire of the diagram, readable after every step.
template <signal_tag Effort, class Real> struct feed_drive_wires {
    quantity_of<signal::voltage, Real> command;
    quantity_of<Effort, Real> amplified, effort; ///< of the motor: current, or voltage of a `linear_motor`
    quantity_of<signal::force, Real> external;
    quantity_of<signal::position, Real> turned; ///< what the motor has turned, times the nominal lead
    quantity_of<signal::velocity, Real> velocity;
    quantity_of<signal::acceleration, Real> acceleration; ///< mean of the last period
    quantity_of<signal::force, Real> transmitted;         ///< through the screw
    quantity_of<signal::position, Real> led, deflection, nut, place, reading;
    quantity_of<signal::velocity, Real> tachometer;
    quantity_of<signal::acceleration, Real> accelerometer;

    static constexpr auto taps() {
        using wires = feed_drive_wires;
        return std::array{tap<signal::voltage, &wires::command>("command"),
                          tap<Effort, &wires::amplified>("amplified"),
                          tap<Effort, &wires::effort>("effort"),
                          tap<signal::force, &wires::external>("external"),
                          tap<signal::position, &wires::turned>("turned"),
                          tap<signal::velocity, &wires::velocity>("velocity"),
                          tap<signal::acceleration, &wires::acceleration>("acceleration"),
                          tap<signal::force, &wires::transmitted>("transmitted"),
                          tap<signal::position, &wires::led>("led"),
                          tap<signal::position, &wires::deflection>("deflection"),
                          tap<signal::position, &wires::nut>("nut"),
                          tap<signal::position, &wires::place>("place"),
                          tap<signal::position, &wires::reading>("reading"),
                          tap<signal::velocity, &wires::tachometer>("tachometer"),
                          tap<signal::acceleration, &wires::accelerometer>("accelerometer")};
    }
};

/// The machine's side of one feed axis as named boxes: current amplifier with its limit, motor and screw on
/// friction, lead error, screw that yields, play, encoder, tachometer, accelerometer. The controller's side is
/// `feed_control`.
///   effort = limit(Ka u),  turned = drive(effort, external),  nut = lead(turned) - compliance (table_mass a - external)
///   place = play(nut),  reading = encoder(place or turned + noise),  tachometer = v + noise
///   accelerometer = mean acceleration of the last period + noise
/// Source: [Yeung2006] eqs. (1-18); lead error and compliance are textbook.
/// Ports: command u[k] [V] and the external force [N] on the table, held from sample k on, in; measurement of
/// sample k+1 out. Where the table is: wire.place.
/// State: that of the boxes. `reset`: at rest at zero; `settle(x)`: motor at rest at x, in the middle of the
/// play; noise as new.
/// Range: the screw yields quasi-statically: good well below the resonance of table on screw. Its deflection
/// does not act back on the motor.
/// NaN and infinities: returns the last measurement, no box moves, raises faulted() until reset or settle.
/// Cost: that of the boxes. Linear motors with structure: `table_axis`.
template <drive_boxes Boxes> struct feed_drive {
    using real = real_of<decltype(Boxes::drive)>;
    using voltage = quantity_of<signal::voltage, real>;
    using force = quantity_of<signal::force, real>;
    using position = quantity_of<signal::position, real>;
    using wires = feed_drive_wires<typename decltype(Boxes::drive)::input, real>;
    static_assert(every_wire_has_a_tap(wires::taps()));

    Boxes box;
    wires wire{};
    bool fault = false; ///< a sample was not finite; cleared by reset and settle

    axis_measurement<real> operator()(voltage command, force external = force()) noexcept {
        if (!finite(command, external)) {
            fault = true;
            return measured();
        }
        wire.command = command;
        wire.external = external;
        wire.amplified = box.amplifier(command);
        wire.effort = box.effort_limit(wire.amplified);
        wire.turned = box.drive(wire.effort, external);
        wire.velocity = box.drive.now().v;
        wire.acceleration = box.change(wire.velocity);
        wire.led = box.lead(wire.turned);
        wire.transmitted = box.table(wire.acceleration) - external;
        wire.deflection = box.screw(wire.transmitted);
        wire.nut = wire.led - wire.deflection;
        wire.place = box.play(wire.nut);
        wire.reading = box.encoder((box.scale_on_table ? wire.place : wire.turned) + box.encoder_noise());
        wire.tachometer = wire.velocity + box.tachometer_noise();
        wire.accelerometer = wire.acceleration + box.accelerometer_noise();
        return measured();
    }
    void settle(position x) noexcept {
        if (!finite(x)) {
            fault = true;
            return;
        }
        reset();
        box.drive.settle(x);
        wire.turned = x;
        wire.nut = wire.place = wire.led = detail::settled(box.lead, x);
        box.play.settle(wire.nut);
        wire.reading = detail::settled(box.encoder, box.scale_on_table ? wire.place : x);
    }
    void reset() noexcept {
        std::apply([](auto&... each) { (each.reset(), ...); }, boxes(box));
        wire = {};
        fault = false;
    }

    axis_measurement<real> measured() const noexcept {
        return {wire.reading, wire.tachometer, wire.accelerometer};
    }
    bool limited() const noexcept { return wire.effort != wire.amplified; } ///< amplifier or motor
    bool faulted() const noexcept {
        return fault ||
               std::apply([](const auto&... each) { return (detail::is_faulted(each) || ...); }, boxes(box));
    }

    static constexpr auto taps() { return wires::taps(); }

private:
    static constexpr auto boxes(auto& b) noexcept {
        return std::tie(b.amplifier, b.effort_limit, b.drive, b.lead, b.change, b.table, b.screw, b.play,
                        b.encoder_noise, b.encoder, b.tachometer_noise, b.accelerometer_noise);
    }
};

/// From command to position without friction and limits: what a control law is designed from.
template <class Boxes>
requires requires(const Boxes& b) {
    b.drive.model();
    b.amplifier.given().gain;
}
auto model_of(const Boxes& b) {
    const auto drive = b.drive.model();
    return axis_model<signal::voltage, typename decltype(drive.gain)::value_type>{
        drive.gain * b.amplifier.given().gain, drive.viscous_rate};
}

} // namespace quadrant::inline v0
