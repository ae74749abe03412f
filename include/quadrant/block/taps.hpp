// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/signal.hpp"

#include <array>
#include <cstddef>

/// Named wires to record: a list of taps beside a struct of wires, so that a log has names and units without a
/// macro.
///   static constexpr auto taps() { return std::array{tap<signal::position, &wires::error>("error"), ...}; }
namespace quadrant::inline v0 {

/// One wire of `Wires`: its name, the text of its unit, and how to read it in SI.
template <class Wires, class Real> struct tap_of {
    const char* name;
    const char* unit;
    Real (*read)(const Wires&) noexcept;
    void (*write)(Wires&, Real) noexcept;
    std::size_t bytes; ///< that the wire takes of the struct
};

namespace detail {
template <class Member> struct wire_type;
template <class Unit, class Number, class Struct>
struct wire_type<boost::units::quantity<Unit, Number> Struct::*> {
    using unit = Unit;
    using real = Number;
    using wires = Struct;
};
} // namespace detail

/// One entry of a list; does not compile when the wire is not of this signal's unit.
template <signal_tag Signal, auto Member, class Wire = detail::wire_type<decltype(Member)>>
requires std::same_as<typename Signal::unit, typename Wire::unit>
constexpr tap_of<typename Wire::wires, typename Wire::real> tap(const char* name) {
    using wires = typename Wire::wires;
    using real = typename Wire::real;
    return {name, Signal::text, [](const wires& w) noexcept { return (w.*Member).value(); },
            [](wires& w, real x) noexcept { w.*Member = quantity_of<Signal, real>::from_value(x); },
            sizeof(quantity_of<Signal, real>)};
}

/// Calls f(name, unit text, value in SI) for every tap, in the order of the list: write a header with it, then
/// rows.
template <class Wires, class Real, std::size_t N, class F>
constexpr void for_each_tap(const Wires& wires, const std::array<tap_of<Wires, Real>, N>& taps, F&& f) {
    for (const auto& each : taps) f(each.name, each.unit, each.read(wires));
}

/// True when every wire has exactly one tap: their sizes fill the struct and no two read the same place. Under
/// a struct of
/// wires: `static_assert(every_wire_has_a_tap(wires::taps()))`; a wire added without a tap then does not
/// compile.
template <class Wires, class Real, std::size_t N>
constexpr bool every_wire_has_a_tap(const std::array<tap_of<Wires, Real>, N>& taps) {
    std::size_t bytes = 0;
    Wires marked{};
    for (std::size_t i = 0; i < N; ++i) {
        bytes += taps[i].bytes;
        if (taps[i].read(marked) != Real(0)) return false; // an earlier tap has written there
        taps[i].write(marked, Real(1));
    }
    return bytes == sizeof(Wires);
}

} // namespace quadrant::inline v0
