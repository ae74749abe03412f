// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "thesis.hpp"

#include <quadrant/loop/milling_axis.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_control.hpp>
#include <quadrant/plant/linear_motor.hpp>

namespace thesis {

/// One axis whose instruments are not ideal: a `milling_axis`, a motor, and between them
///   reading(place, velocity): what the encoder makes of it,
///   command(u): what the amplifier makes of it.
/// Tests put an axis of an `xy_loop` in its place, whose table is a `measured_table`.
template <class Boxes, class Motor, class Instruments> class measured_axis {
public:
    using loop = milling_axis<Boxes>;
    using motion = typename loop::motion;

    measured_axis(const typename Boxes::parameters& controller, const typename Motor::parameters& motor,
                  const Instruments& instruments)
        : loop_{.box = {controller, period}}, motor_(motor, period), instruments_(instruments) {}

    void settle(quantity<si::length> at) {
        motor_.settle(at);
        loop_.settle(at);
    }
    void step(const motion& now) {
        reading_ = instruments_.reading(motor_.now().x, motor_.now().v);
        command_ = loop_(now, reading_);
        motor_(instruments_.command(command_));
    }
    Boxes& boxes() { return loop_.box; }
    auto now() const { return motor_.now(); } ///< of the axis, not of its encoder
    auto reading() const { return reading_; } ///< of the last step, before the motor moved
    auto command() const { return command_; } ///< of the controller, before the amplifier
    bool stopped() const { return motor_.faulted() || loop_.faulted() || loop_.limited(); }

private:
    loop loop_;
    Motor motor_;
    Instruments instruments_;
    quantity<si::length> reading_{};
    quantity_of<signal::voltage> command_{};
};

/// A table for an `xy_loop` that is read and commanded through such instruments: the place for noise of
/// measurement and for noise of excitation in the whole loop. Each axis has its own.
template <class Table, class Instruments> class measured_table {
public:
    using commands = typename Table::commands;
    using forces = typename Table::forces;
    using positions = typename Table::positions;
    struct parameters {
        typename Table::parameters table; ///< without encoders: they are instruments
        Instruments x, y;
    };

    measured_table(const parameters& p, duration T) : given_(p), table_(p.table, T), x_(p.x), y_(p.y) {
        read();
    }
    positions operator()(const commands& u, const forces& external = {}) noexcept {
        table_({.x = on_x(x_.command(u.x.plain())), .y = on_y(y_.command(u.y.plain()))}, external);
        read();
        return reading_;
    }
    void settle(const positions& at) noexcept {
        table_.settle(at);
        x_ = given_.x;
        y_ = given_.y;
        read();
    }
    void reset() noexcept { settle({}); }
    positions reading() const noexcept { return reading_; }
    bool faulted() const noexcept { return table_.faulted(); }
    const auto& x() const noexcept { return table_.x(); }
    const auto& y() const noexcept { return table_.y(); }

private:
    void read() noexcept {
        const auto &at_x = table_.x().wire, &at_y = table_.y().wire;
        reading_ = {.x = on_x(x_.reading(at_x.place, at_x.velocity)),
                    .y = on_y(y_.reading(at_y.place, at_y.velocity))};
    }
    parameters given_;
    Table table_;
    Instruments x_, y_;
    positions reading_{};
};

} // namespace thesis
