// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/in_si.hpp"
#include "machine.hpp"

#include <type_traits>
#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

template <class Loop> double step_of(Loop& loop, double reference, double measured) {
    if constexpr (std::is_invocable_r_v<double, Loop&, double, double>)
        return loop(reference, measured);
    else
        return step_in_si(loop, reference, measured);
}

} // namespace detail

/// Puts a loop into the middle of a motion. One with an integral of gain 0 starts with none.
template <class Loop> void settle_at(Loop& loop, const loop_start& row) {
    if constexpr (requires {
                      typename Loop::start;
                      loop.settle(typename Loop::start{});
                  }) {
        loop.settle({.reference = in_si(row.reference),
                     .measured = in_si(row.measured),
                     .reference_velocity = in_si(row.reference_velocity),
                     .measured_velocity = in_si(row.measured_velocity),
                     .command = in_si(row.command)});
        if constexpr (requires { loop.box.velocity_loop.given().integral_gain.value(); })
            if (loop.box.velocity_loop.given().integral_gain.value() == 0) loop.box.velocity_loop.reset();
    } else if constexpr (requires { loop.settle(row); }) {
        loop.settle(row);
    } else if constexpr (requires { loop.settle(in_si(row.measured), in_si(row.command)); }) {
        loop.settle(in_si(row.measured), in_si(row.command));
    } else {
        detail::step_of(loop, row.reference, row.measured); // only the row itself can be given to it
    }
}

namespace detail {

template <class Loop> running_loop running(Loop loop) {
    return [loop = std::move(loop)](const loop_start* row, double reference, double measured) mutable {
        if (!row) return step_of(loop, reference, measured);
        settle_at(loop, *row);
        return row->command;
    };
}

} // namespace detail

/// A controller of your own in the place of the cascade: replayed on the log, run in the closed loop, judged,
/// and, with keys, corrected. `make` builds it from the values of the keys, as new, whenever one is needed:
///   machine.axes[0].controller = own_controller({{"gain_V_per_m", 9000}, {"lead_Hz", 40}}, [](std::span<const double> v) {
///       return my_lead{.gain = v[0], .lead = v[1]}; });
/// The loop is anything copyable that is called once a sample, reference and measured position in, command out:
/// with doubles (SI, command in the column's unit) or with quantities, as every loop of quadrant. Its sample
/// period is its own affair; the limit and the DAC of the machine file follow it. It begins a log by
/// settle(cascade start), settle(loop_start) or settle(position, command), whichever it has; else the first row
/// is run through it. What `make` throws for values that a search tries counts as no fit; for the given values
/// it is passed on.
template <class Make> controller_description own_controller(std::vector<own_key> keys, Make make) {
    controller_description out;
    out.own = {std::move(keys), [make = std::move(make)](std::span<const double> values) {
                   return detail::running(make(values));
               }};
    return out;
}

/// The same without keys: a mismatch is detected, but no correction is suggested.
template <class Loop> controller_description own_controller(Loop loop) {
    return own_controller({}, [loop = std::move(loop)](std::span<const double>) { return loop; });
}

} // namespace quadrant::inline v0::diagnosis
