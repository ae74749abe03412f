// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../block/along.hpp"
#include "table_axis.hpp"

namespace quadrant::inline v0 {

/// An xy-table: two axes of named boxes, each excited by the acceleration of the other.
///   a_x = (forces of x)/M_x + into_x a_y,   a_y = (forces of y)/M_y + into_y a_x
/// Source: docs/formats.md (effect cross_coupling); [Jamaludin2008] chapter 2 for the table.
/// Ports: a pair of commands [V] and a pair of external forces [N] in, the pair of readings [m] of the next
/// sample out. A
/// pair is made by name: table({.x = on_x(ux), .y = on_y(uy)}, {.x = on_x(fx), .y = on_y(fy)}); what belongs to
/// x does not compile as y. Its members are read as plain quantities.
/// State: that of the boxes. `reset`, `settle(pair)`: both axes at rest.
/// Range: |into_x into_y| < 1. The acceleration is the mean of the last period, so the coupling is one period
/// late.
/// NaN and infinities in either axis: returns the last readings, neither axis moves, raises faulted() until
/// reset or settle. Throws "xy_table.coupling.<field> = ...: must ..."; the boxes throw in their own names.
/// Cost: that of the boxes. A single axis: `table_axis`.
template <table_boxes X, table_boxes Y>
requires std::same_as<real_of<decltype(X::motor)>, real_of<decltype(Y::motor)>>
class xy_table {
public:
    using real = real_of<decltype(X::motor)>;
    using number = parameter_real<real>; ///< of parameters
    using commands = xy<quantity_of<signal::voltage, real>>;
    using forces = xy<quantity_of<signal::force, real>>;
    using positions = xy<quantity_of<signal::position, real>>;

    /// How much of the acceleration of one axis the other one gets, without a unit.
    struct cross_coupling {
        number into_x{}; ///< a_x gains into_x a_y; |into_x| < 1
        number into_y{}; ///< a_y gains into_y a_x
    };
    /// Both axes, and how they shake each other.
    struct parameters {
        typename X::parameters x;
        typename Y::parameters y;
        cross_coupling coupling{};
    };

    xy_table(const parameters& p, duration period)
        : x_{.box = {p.x, period}}, y_{.box = {p.y, period}}, given_(p), into_x_(real(p.coupling.into_x)),
          into_y_(real(p.coupling.into_y)), mass_x_(in_real<real>(x_.box.motor.given().mass)),
          mass_y_(in_real<real>(y_.box.motor.given().mass)) {
        require_share("xy_table.coupling.into_x", p.coupling.into_x);
        require_share("xy_table.coupling.into_y", p.coupling.into_y);
        reset();
    }

    positions operator()(const commands& u, const forces& external = {}) noexcept {
        if (!finite(u.x.plain(), u.y.plain(), external.x.plain(), external.y.plain())) {
            x_.fault = y_.fault = true;
            return reading();
        }
        const auto onto_x = into_x_ * (mass_x_ * y_.wire.acceleration); // z^-1: of the last period
        const auto onto_y = into_y_ * (mass_y_ * x_.wire.acceleration); // z^-1
        x_(u.x, external.x, onto_x);
        y_(u.y, external.y, onto_y);
        return reading();
    }
    void settle(const positions& at) noexcept {
        if (!finite(at.x.plain(), at.y.plain())) {
            x_.fault = y_.fault = true;
            return;
        }
        x_.settle(at.x);
        y_.settle(at.y);
    }
    void reset() noexcept { settle({}); }

    positions reading() const noexcept { return {.x = on_x(x_.wire.reading), .y = on_y(y_.wire.reading)}; }
    bool faulted() const noexcept { return x_.faulted() || y_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const table_axis<X>& x() const noexcept { return x_; } ///< its wires: x().wire, x().taps()
    const table_axis<Y>& y() const noexcept { return y_; }

private:
    static void require_share(const char* field, const number& share) {
        require(std::abs(detail::plain(share)) < 1, field, share, "must lie between -1 and 1");
    }

    table_axis<X> x_;
    table_axis<Y> y_;
    parameters given_;
    real into_x_, into_y_;
    quantity<si::mass, real> mass_x_, mass_y_;
};

} // namespace quadrant::inline v0
