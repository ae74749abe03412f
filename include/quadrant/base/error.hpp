// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "digits.hpp"
#include "finite_bits.hpp"
#include "select.hpp"
#include "signal.hpp"
#include "unit_text.hpp"

#include <array>
#include <cmath>
#include <cstddef>
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

namespace detail {
/// Words and numbers into a buffer that is never overrun; `used` counts what there was to write.
struct text_buffer {
    char* out;
    std::size_t size, used = 0;
    [[gnu::always_inline]] void add(const char* words) {
        for (; *words != '\0'; ++words, ++used)
            if (used < size) out[used] = *words;
    }
    [[gnu::always_inline]] void add(double number) { add(digits(number).text.data()); }
};

#ifdef __cpp_exceptions
template <class Isa = isa::here, class Written> std::string written(const Written& what) {
    text_buffer counted{nullptr, 0};
    what.write(counted);
    std::string out(counted.used, ' ');
    text_buffer text{out.data(), out.size()};
    what.write(text);
    return out;
}
#endif

/// What must hold, words with numbers between them: "must not exceed the capacity (" + shortest(8) + ")".
/// Nothing is written, copied or allocated before the rule is broken; the words are literals. Nine pieces at
/// most.
class rule {
public:
    constexpr rule() = default;
    constexpr rule(const char* words) : pieces_{{{words, 0, false}}}, count_(1) {}
    constexpr explicit rule(double number, const char* unit = nullptr)
        : pieces_{{{unit, number, true}}}, count_(1) {}
    constexpr friend rule operator+(rule left, const rule& right) {
        for (std::size_t i = 0; i < right.count_ && left.count_ < left.pieces_.size(); ++i)
            left.pieces_[left.count_++] = right.pieces_[i];
        return left;
    }
    template <class Isa = isa::here> void write(text_buffer& text) const {
        for (std::size_t i = 0; i < count_; ++i) {
            if (pieces_[i].counts) text.add(pieces_[i].number);
            if (pieces_[i].words != nullptr) text.add(pieces_[i].words);
        }
    }
#ifdef __cpp_exceptions
    operator std::string() const { return written(*this); }
#endif

private:
    struct piece {
        const char* words; // null: none; behind a number its unit
        double number;
        bool counts; // whether there is a number
    };
    std::array<piece, 9> pieces_{};
    std::size_t count_ = 0;
};
constexpr rule shortest(double value) { return rule(value); }
/// "notch.centre", or a block's name and ".period" where several blocks share the check.
struct field_name {
    constexpr field_name() = default;
    constexpr field_name(const char* name, const char* rest = "") : block(name), field(rest) {}
    const char *block = nullptr, *field = nullptr;
};

template <multi_lane Lanes>
requires(lane_count<Lanes> == 1) constexpr double plain(const Lanes& x) noexcept { return x[0]; }
constexpr double plain(double x) noexcept { return x; }
template <carries_partials Dual> constexpr double plain(const Dual& x) noexcept {
    return static_cast<double>(x.value);
}
template <class Unit, class Real> constexpr double plain(const boost::units::quantity<Unit, Real>& x) noexcept {
    return plain(x.value());
}

/// A number and the letters of its unit, with a space before them, where the type does not say it:
/// in_unit(60, " degrees").
struct in_unit {
    double value;
    const char* unit;
    template <class Number>
    constexpr in_unit(const Number& number, const char* letters)
        : value(detail::plain(number)), unit(letters) {}
};
constexpr double plain(const in_unit& x) noexcept { return x.value; }

/// The letters of the unit of a value; none for a bare number.
template <class Value> constexpr const char* unit_of(const Value&) noexcept { return nullptr; }
template <class Unit, class Real> constexpr const char* unit_of(const quantity<Unit, Real>&) noexcept {
    return unit_text<quantity<Unit, double>>.text.data();
}
constexpr const char* unit_of(const in_unit& x) noexcept { return x.unit; }

/// A number in a rule, with its unit.
constexpr rule shortest(const in_unit& value) { return rule(value.value, value.unit); }
template <class Unit, class Real> constexpr rule shortest(const quantity<Unit, Real>& value) {
    return shortest(in_unit(value, unit_of(value)));
}
} // namespace detail

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

/// The rules that come up everywhere. Of a number of lanes each has to keep them.
template <class Value, class Isa = isa::here>
void require_finite(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i)
        if (const double x = detail::plain(lane(value, i)); !detail::is_finite(x))
            detail::require_number<Isa>(false, field, x, detail::unit_of(value), "must be finite");
}
/// Finite and above 0.
template <class Value, class Isa = isa::here>
void require_positive(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double x = detail::plain(lane(value, i));
        detail::require_number<Isa>(detail::is_finite(x) && x > 0, field, x, detail::unit_of(value),
                                    "must be finite and above 0");
    }
}
/// Finite and not below 0.
template <class Value, class Isa = isa::here>
void require_not_negative(const detail::field_name& field, const Value& value) {
    for (std::size_t i = 0; i < lane_count<Value>; ++i) {
        const double x = detail::plain(lane(value, i));
        detail::require_number<Isa>(detail::is_finite(x) && x >= 0, field, x, detail::unit_of(value),
                                    "must be finite and not below 0");
    }
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
