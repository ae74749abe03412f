// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "finite_bits.hpp"
#include "rule.hpp"
#include "select.hpp"
#include "signal.hpp"

#include <cstddef>
#include <limits>
#include <type_traits>
#ifdef __cpp_exceptions
#    include <optional>
#    include <stdexcept>
#    include <string>
#else
#    include <csetjmp>
#endif

/// Parameters that no machine could have. With exceptions a constructor throws invalid_parameter. Without them
/// (-fno-exceptions) make.hpp says why, and a constructor called directly ends in on_refusal. A step does
/// neither. What is no template by itself carries the instruction set, see lanes/instruction_set.hpp.
namespace quadrant::inline v0 {

/// Why a block was not made: literals and numbers, free to copy.
struct refused_parameter {
    detail::field_name field{};
    double value = 0;
    detail::rule must{};
    const char* unit = nullptr; ///< letters of the unit of `value`, with a space before them; null: none

    /// Writes "notch.centre = 1200 Hz: must lie between 0 and half the sampling rate (1000 Hz)", values in SI,
    /// cut off to fit `size` with its final zero. Returns the length of the whole.
    std::size_t write(char* out, std::size_t size) const {
        detail::text_buffer text{out, size > 0 ? size - 1 : 0};
        write(text);
        if (size > 0) out[text.used < size ? text.used : size - 1] = '\0';
        return text.used;
    }
    template <class Isa = isa::here> void write(detail::text_buffer& text) const {
        if (field.block == nullptr) return text.add("nothing was made yet");
        for (const char* words : {field.block, field.field, " = "}) text.add(words);
        text.add(value);
        if (unit != nullptr) text.add(unit);
        text.add(": ");
        must.write(text);
    }
};

#ifdef __cpp_exceptions
/// what() reads as refused_parameter::write. Thrown by constructors only, never by a step.
struct invalid_parameter : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
    [[gnu::always_inline]] explicit invalid_parameter(const refused_parameter& r)
        : std::invalid_argument(detail::written(r)), why(r) {}
    std::optional<refused_parameter> why; ///< none when thrown as text, which no block does
};
#else
/// Called with what a constructor refused outside of make(); then, or without one, the program traps. Set it
/// once at the start; it may reset the processor, or never return.
inline void (*on_refusal)(const refused_parameter&) = nullptr;

namespace detail {
/// Where a constructor that refuses goes back to while make() runs. One thread at a time makes blocks.
struct attempt {
    std::jmp_buf back;
    refused_parameter why;
    static inline attempt* running = nullptr;
};
} // namespace detail
#endif

namespace detail {
template <class Isa = isa::here> [[noreturn]] void refuse(const refused_parameter& why) {
#ifdef __cpp_exceptions
    throw invalid_parameter(why);
#else
    if (attempt* const a = attempt::running) {
        a->why = why;
        std::longjmp(a->back, 1); // as a throw would: nothing that a block holds has a destructor
    }
    if (on_refusal != nullptr) on_refusal(why);
    __builtin_trap();
#endif
}
} // namespace detail

namespace detail {
/// One function for values of all units: on a microcontroller each would be a copy.
template <class Isa = isa::here>
void require_number(bool holds, const field_name& field, double x, const char* unit, const rule& must) {
    if (!holds || is_nan(x)) refuse({field, x, must, unit});
}
/// The numbers that a type holds with all their digits, zero left out: without those that it rounds to zero, to
/// few digits or to infinity.
struct number_range {
    double least, most;
};
template <class Real> constexpr number_range range_of() noexcept {
    using limits = std::numeric_limits<std::conditional_t<std::is_same_v<Real, float>, float, double>>;
    return {double(limits::min()), double(limits::max())};
}
template <class Isa = isa::here>
void require_in_range(const field_name& field, double x, const char* unit, const number_range& range) {
    const double size = x < 0 ? -x : x;
    if (size != 0 && !(size >= range.least && size <= range.most))
        refuse({field, x,
                "must lie between " + rule(range.least) + " and " + rule(range.most) +
                    " in size in this number type",
                unit});
}
} // namespace detail

/// Refuses `value` unless `holds`, naming block, field, value and rule. A NaN keeps no rule, whatever a
/// compiler makes of its comparison.
template <class Value, class Isa = isa::here>
void require(bool holds, const detail::field_name& field, const Value& value, const detail::rule& must) {
    detail::require_number<Isa>(holds, field, detail::plain(value), detail::unit_of(value), must);
}
/// The same for every lane: `holds(i)` is the rule of lane i, and the message names the first value that breaks
/// it.
template <class Value, class Rule, class Isa = isa::here>
requires std::is_invocable_r_v<bool, Rule, std::size_t>
void require_lanes(Rule holds, const detail::field_name& field, const Value& value, const detail::rule& must) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) require(holds(i), field, lane(value, i), must);
}

/// The rules that come up everywhere. Of a number of lanes each has to keep them. `Real`: the number type that
/// the block computes in; a value that it cannot hold (1e-42 or 1e40 in float, 1e-320 in double) is refused,
/// too.
template <class Real = double, class Value, class Isa = isa::here>
void require_finite(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double x = detail::plain(lane(value, i));
        detail::require_number<Isa>(detail::is_finite(x), field, x, detail::unit_of(value), "must be finite");
        detail::require_in_range<Isa>(field, x, detail::unit_of(value), detail::range_of<Real>());
    }
}
/// Finite and above 0.
template <class Real = double, class Value, class Isa = isa::here>
void require_positive(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double x = detail::plain(lane(value, i));
        detail::require_number<Isa>(detail::is_finite(x) && x > 0, field, x, detail::unit_of(value),
                                    "must be finite and above 0");
        detail::require_in_range<Isa>(field, x, detail::unit_of(value), detail::range_of<Real>());
    }
}
/// Finite and not below 0.
template <class Real = double, class Value, class Isa = isa::here>
void require_not_negative(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double x = detail::plain(lane(value, i));
        detail::require_number<Isa>(detail::is_finite(x) && x >= 0, field, x, detail::unit_of(value),
                                    "must be finite and not below 0");
        detail::require_in_range<Isa>(field, x, detail::unit_of(value), detail::range_of<Real>());
    }
}
/// Coefficients that a block makes of a parameter: their product with an ordinary signal has to be a number, so
/// none may exceed the root of the largest one.
template <class Real, class Value, class... Coefficients>
void require_coefficients(const detail::field_name& field, const Value& of, const Coefficients&... each) {
    // No product or quotient: under -ffast-math that is one with 1 / largest, which is subnormal.
    constexpr double root = detail::range_of<Real>().most < 1e300 ? 0x1p64 : 0x1p512;
    const auto held = [](double c) { return detail::is_finite(c) && c < root && c > -root; };
    for (std::size_t i = 0; i < lane_count<Real>; ++i)
        require((held(detail::plain(lane(each, i))) && ...), field, lane(of, i),
                "must leave coefficients that this number type can hold");
}
/// A corner or centre frequency of a block that runs every `period`.
template <class Value, class Isa = isa::here>
void require_below_nyquist(const detail::field_name& field, const Value& value, duration period) {
    const double nyquist = 0.5 / period.value();
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double f = detail::plain(lane(value, i));
        if (!(detail::is_finite(f) && f > 0 && f < nyquist))
            detail::require_number<Isa>(false, field, f, detail::unit_of(value),
                                        "must lie between 0 and half the sampling rate (" +
                                            detail::shortest(detail::in_unit(nyquist, " Hz")) + ")");
    }
}

} // namespace quadrant::inline v0
