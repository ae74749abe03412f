// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "digits.hpp"
#include "select.hpp"
#include "signal.hpp"
#include "unit_text.hpp"

#include <array>
#include <cstddef>
#ifdef __cpp_exceptions
#    include <string>
#endif

/// What a refused parameter is told with: words, numbers and the letters of units, without the heap where there
/// are no exceptions.
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
    template <class Isa = isa::here> constexpr friend rule operator+(rule left, const rule& right) {
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

} // namespace quadrant::inline v0
