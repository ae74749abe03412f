// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "xy_control.hpp"
#include "xy_table.hpp"

#include <concepts>
#include <type_traits>

namespace quadrant::inline v0 {

/// No tool in the cut: a process of an `xy_loop` that pushes nothing.
struct no_process {
    struct parameters {};
    no_process(const parameters&, duration) {}
    quantity_of<signal::force> operator()() noexcept { return {}; }
    void reset() noexcept {}
};

/// What an `xy_loop` asks of its table: pairs of commands and forces in, the readings of the next sample out.
template <class T>
concept moves_two_axes = requires(T& t, const T& seen, const typename T::commands& u,
                                  const typename T::forces& f, const typename T::positions& at) {
    { t(u, f) } -> std::same_as<typename T::positions>;
    { seen.reading() } -> std::same_as<typename T::positions>;
    { seen.faulted() } -> std::same_as<bool>;
    t.settle(at);
    t.reset();
};

/// What it asks of a process: a force at each call.
template <class P>
concept pushes = requires(P& p) {
    { p() } -> std::same_as<quantity_of<signal::force>>;
    p.reset();
};

/// The whole loop of a milling table as one type: the controllers of both axes with all that they compensate
/// (cascade, notch, inverse of the axis, friction, disturbance observer, memory), the table behind them, and
/// the process that pushes it.
///   u[k] = control(r[k], y[k]),   y[k+1] = table(u[k], process[k])
/// Source: [Jamaludin2008], the whole of it.
/// Ports: motions of both axes in, readings of the next sample out. X, Y: boxes of a `milling_axis`, or
/// `in_lanes` of them; Table: an `xy_table`, or what has its calls; Process: `cutting_force`, `milling_force`,
/// `no_process`.
/// State: that of the parts. `reset`: as new; `settle(at)`: at rest there, nothing learnt, the process as it
/// is.
/// NaN and infinities in the motions: neither controller moves, the last commands go on acting on the table,
/// faulted() until reset or settle.
/// Throws what the parts throw, in their names.
/// Cost: that of the parts; the controllers alone: `xy_control`, which is what goes onto the machine.
template <class X, class Y, moves_two_axes Table, pushes Process = no_process> class xy_loop {
public:
    using control_type = xy_control<X, Y>;
    using motion = typename control_type::motion;
    using motions = typename control_type::motions;
    using positions = typename control_type::positions;
    using commands = typename control_type::commands;
    static_assert(
        !requires { requires control_type::takes_acceleration; },
        "no acceleration is read from this table: close the loop around an xy_control by hand");
    static_assert(std::same_as<commands, typename Table::commands>,
                  "the table takes what the controllers give");

    /// Those of the parts.
    struct parameters {
        typename control_type::parameters control;
        typename Table::parameters table;
        typename Process::parameters process_x{}, process_y{};
    };
    xy_loop(const parameters& p, duration period)
        : control_(p.control, period), table_(p.table, period), process_x_(p.process_x, period),
          process_y_(p.process_y, period) {}

    positions operator()(const motions& r) noexcept { return (*this)(r, r); }
    positions operator()(const motions& r, const motions& ahead) noexcept {
        const positions measured = table_.reading(); // z^-1
        const commands u = control_(r, ahead, measured);
        return table_(u, {.x = on_x(process_x_()), .y = on_y(process_y_())});
    }
    void settle(const positions& at) noexcept {
        control_.settle(at);
        table_.settle(at);
    }
    void reset() noexcept {
        control_.reset();
        table_.reset();
        process_x_.reset();
        process_y_.reset();
    }
    /// As that of the controllers: `next` is a loop that was built beside.
    void retune(const xy_loop& next, const motions& ahead) noexcept { control_.retune(next.control_, ahead); }

    bool limited() const noexcept { return control_.limited(); }
    bool faulted() const noexcept { return control_.faulted() || table_.faulted(); }
    const control_type& control() const noexcept { return control_; }
    control_type& control() noexcept { return control_; }
    const Table& table() const noexcept { return table_; }
    Table& table() noexcept { return table_; } ///< for a machine as the table: what its encoders read
    Process& process_x() noexcept { return process_x_; } ///< to let the tool leave the cut
    Process& process_y() noexcept { return process_y_; }

    /// Every wire of the diagram by axis: f(axis 'x' or 'y', name, unit, value in SI); of an `xy_table` its
    /// wires too.
    template <class F> void each_wire(F&& f) const {
        control_.each_wire(f);
        if constexpr (requires { table_.x().wire; }) {
            for_each_tap(table_.x().wire, table_.x().taps(), [&](auto... tap) { f('x', tap...); });
            for_each_tap(table_.y().wire, table_.y().taps(), [&](auto... tap) { f('y', tap...); });
        }
    }

private:
    control_type control_;
    Table table_;
    Process process_x_, process_y_;
};

} // namespace quadrant::inline v0
