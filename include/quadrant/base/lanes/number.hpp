// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../select.hpp"
#include "mask.hpp"
#include "registers.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace quadrant::inline v0 {

/// A number that holds W independent instances: run W loops side by side, one in each lane, with the registers
/// of the processor. Every operation works lane by lane; + - * / and sqrt give in each lane what a double
/// gives, bit for bit (exp, log, sin and the like: docs/lanes.md). Fits into a quantity.
/// Comparisons are functions that return a mask: less(a, b), select(mask, a, b), any(mask) (select.hpp). There
/// is no operator<, because one bool cannot answer for W lanes.
/// With xsimd (Debian: libxsimd-dev) W numbers fill registers: 2 with SSE2, 4 with AVX, 8 with AVX-512; without
/// it, or when W is odd, the lanes are W doubles. `Isa` is the instruction set, by default that of the
/// translation unit.
template <std::size_t W, class Isa = isa::here> class lanes {
    using registers = detail::lane_registers<W, Isa>;
    static constexpr std::size_t pieces = W / registers::width;

public:
    using piece = typename registers::number; ///< what one register holds
    static_assert(W > 0, "at least one lane");
    using mask = lane_mask<W, Isa>;
    static constexpr std::size_t size = W;
    using single = lanes<1, Isa>; ///< one instance in the same instruction set

    lanes() noexcept : lanes(0.0) {}
    /// The same number in every lane.
    template <class Number>
    requires std::is_arithmetic_v<Number> lanes(Number all)
    noexcept { piece_.fill(piece(static_cast<double>(all))); }
    /// One number for each lane.
    explicit lanes(const std::array<double, W>& each) noexcept {
        for (std::size_t i = 0; i < pieces; ++i) detail::get(piece_[i], each.data() + i * registers::width);
    }

    /// All lanes, as numbers.
    std::array<double, W> each() const noexcept {
        std::array<double, W> out;
        for (std::size_t i = 0; i < pieces; ++i) detail::put(piece_[i], out.data() + i * registers::width);
        return out;
    }
    /// The number in lane i < W.
    double operator[](std::size_t i) const noexcept {
        std::array<double, registers::width> out;
        detail::put(piece_[i / registers::width], out.data());
        return out[i % registers::width];
    }
    /// Another number in lane i < W.
    void set(std::size_t i, double value) noexcept {
        std::array<double, registers::width> out;
        detail::put(piece_[i / registers::width], out.data());
        out[i % registers::width] = value;
        detail::get(piece_[i / registers::width], out.data());
    }

    lanes& operator+=(const lanes& o) noexcept { return *this = *this + o; }
    lanes& operator-=(const lanes& o) noexcept { return *this = *this - o; }
    lanes& operator*=(const lanes& o) noexcept { return *this = *this * o; }
    lanes& operator/=(const lanes& o) noexcept { return *this = *this / o; }
    friend lanes operator+(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return x + y; }, a, b);
    }
    friend lanes operator-(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return x - y; }, a, b);
    }
    friend lanes operator*(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return x * y; }, a, b);
    }
    friend lanes operator/(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return x / y; }, a, b);
    }
    friend lanes operator-(const lanes& a) noexcept {
        return map([](const piece& x) { return -x; }, a);
    }
    friend lanes operator+(const lanes& a) noexcept { return a; }

    /// Deleted: one bool cannot answer for W lanes. Use less, equal and so on.
    friend bool operator<(const lanes&, const lanes&) = delete;
    friend bool operator>(const lanes&, const lanes&) = delete;
    friend bool operator<=(const lanes&, const lanes&) = delete;
    friend bool operator>=(const lanes&, const lanes&) = delete;
    friend bool operator==(const lanes&, const lanes&) = delete;
    friend bool operator!=(const lanes&, const lanes&) = delete;

    friend mask less(const lanes& a, const lanes& b) noexcept {
        return test([](const piece& x, const piece& y) { return x < y; }, a, b);
    }
    friend mask less_equal(const lanes& a, const lanes& b) noexcept {
        return test([](const piece& x, const piece& y) { return x <= y; }, a, b);
    }
    friend mask greater(const lanes& a, const lanes& b) noexcept { return less(b, a); }
    friend mask greater_equal(const lanes& a, const lanes& b) noexcept { return less_equal(b, a); }
    friend mask equal(const lanes& a, const lanes& b) noexcept {
        return test([](const piece& x, const piece& y) { return x == y; }, a, b);
    }
    friend mask differs(const lanes& a, const lanes& b) noexcept {
        return test([](const piece& x, const piece& y) { return x != y; }, a, b);
    }
    friend auto finite_lanes(const lanes& a) noexcept {
        if constexpr (isa::is_in_step<Isa>)
            return in_every_lane<true>();
        else
            return a.finite_mask();
    }
    friend mask within_turns(const lanes& a) noexcept {
        return test([](const piece& x) { return detail::within_turns(x); }, a);
    }
    /// a, negated where b has a minus sign (also that of a zero).
    friend lanes turned_as(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return detail::turned_as(x, y); }, a, b);
    }
    /// The bits of both: below a power of two where both are.
    friend lanes bits_joined(const lanes& a, const lanes& b) noexcept {
        return map([](const piece& x, const piece& y) { return detail::bits_joined(x, y); }, a, b);
    }
    /// p 2^k, where k are the lowest bits of `shifted`.
    friend lanes scaled_by_bits(const lanes& p, const lanes& shifted) noexcept {
        return map([](const piece& x, const piece& k) { return detail::scaled_by_bits(x, k); }, p, shifted);
    }
    /// high above high, low below low, else x, a NaN too.
    friend lanes clipped_lanes(const lanes& x, const lanes& low, const lanes& high) noexcept {
        const lanes under =
            map([](const piece& h, const piece& v) { return detail::not_above(h, v); }, high, x);
        return map([](const piece& l, const piece& v) { return detail::not_below(l, v); }, low, under);
    }
    /// most above most, else x, a NaN too.
    friend lanes clipped_above(const lanes& x, const lanes& most) noexcept {
        return map([](const piece& m, const piece& v) { return detail::not_above(m, v); }, most, x);
    }
    friend lanes select(const mask& choice, const lanes& one, const lanes& other) noexcept {
        return chosen(choice, one, other);
    }

    /// Which lanes are finite; asked also of lanes in step, at the border of their loop.
    mask finite_mask() const noexcept {
        return test([](const piece& x) { return detail::is_finite(x); }, *this);
    }
    /// W numbers that lie one behind the other.
    static lanes read(const double* from) noexcept {
        lanes out;
        for (std::size_t i = 0; i < pieces; ++i) detail::get(out.piece_[i], from + i * registers::width);
        return out;
    }
    /// Writes them one behind the other.
    void write(double* to) const noexcept {
        for (std::size_t i = 0; i < pieces; ++i) detail::put(piece_[i], to + i * registers::width);
    }
    /// How many lanes a register holds, and the i-th register.
    static constexpr std::size_t register_width = registers::width;
    const piece& in_register(std::size_t i) const noexcept { return piece_[i]; }
    /// From one register after the other: make(i) gives the i-th.
    template <class Make> static lanes from_registers(Make&& make) noexcept {
        lanes out;
        for (std::size_t i = 0; i < pieces; ++i) out.piece_[i] = make(i);
        return out;
    }
    /// N times as many lanes, and N lanes, of the same instruction set.
    template <std::size_t N> using times = lanes<N * W, Isa>;
    template <std::size_t N> using of_width = lanes<N, Isa>;

    /// Applies `f` to the registers of the arguments: for functions that xsimd and std have under one name.
    template <class F, class... More> static lanes map(F f, const lanes& a, const More&... more) noexcept {
        return each_piece<lanes>(f, std::make_index_sequence<pieces>(), a, more...);
    }
    /// Applies `f`, a function of doubles, lane by lane.
    template <class F, class... More>
    static lanes one_by_one(F f, const lanes& a, const More&... more) noexcept {
        std::array<double, W> out;
        for (std::size_t i = 0; i < W; ++i) out[i] = f(a[i], more[i]...);
        return lanes(out);
    }

private:
    static lanes chosen(const mask& choice, const lanes& one, const lanes& other) noexcept {
        lanes out;
        for (std::size_t i = 0; i < pieces; ++i)
            out.piece_[i] = detail::choose(choice.piece_[i], one.piece_[i], other.piece_[i]);
        return out;
    }
    template <class F, class... More> static mask test(F f, const lanes& a, const More&... more) noexcept {
        return each_piece<mask>(f, std::make_index_sequence<pieces>(), a, more...);
    }
    template <class Out, class F, std::size_t... I>
    static Out each_piece(F f, std::index_sequence<I...>, const lanes& a) noexcept {
        return Out(std::array{f(a.piece_[I])...}, nullptr);
    }
    template <class Out, class F, std::size_t... I>
    static Out each_piece(F f, std::index_sequence<I...>, const lanes& a, const lanes& b) noexcept {
        return Out(std::array{f(a.piece_[I], b.piece_[I])...}, nullptr);
    }
    lanes(const std::array<piece, pieces>& from, std::nullptr_t) noexcept : piece_(from) {}

    std::array<piece, pieces> piece_;
};

/// Lanes that take a sample all together or not at all, such as the axes of one table: `finite` is true of them
/// without a look, so no block inside holds, and the loop around the blocks checks its inputs once, at its
/// border (`xy_control`). A block of its own should have `lanes`, which hold each for itself.
template <std::size_t W, class Isa = isa::here> using lanes_in_step = lanes<W, isa::in_step<Isa>>;

/// W.
template <std::size_t W, class Isa> inline constexpr std::size_t lane_count<lanes<W, Isa>> = W;
/// W.
template <std::size_t W, class Isa> inline constexpr std::size_t lane_count<lane_mask<W, Isa>> = W;
/// The number in lane i.
template <std::size_t W, class Isa> double lane(const lanes<W, Isa>& x, std::size_t i) noexcept { return x[i]; }
template <std::size_t W, class Isa> bool lane(const lane_mask<W, Isa>& x, std::size_t i) noexcept {
    return x[i];
}
/// Replaces the number in lane i.
template <std::size_t W, class Isa> void set_lane(lanes<W, Isa>& x, std::size_t i, double value) noexcept {
    x.set(i, value);
}

/// A quantity of lanes times a plain number: Boost.Units scales by the quantity's own number type only.
template <class Unit, std::size_t W, class Isa, class Number>
requires std::is_arithmetic_v<Number> quantity<Unit, lanes<W, Isa>>
operator*(const quantity<Unit, lanes<W, Isa>>& q, Number n) noexcept {
    return quantity<Unit, lanes<W, Isa>>::from_value(q.value() * n);
}
template <class Unit, std::size_t W, class Isa, class Number>
requires std::is_arithmetic_v<Number> quantity<Unit, lanes<W, Isa>>
operator*(Number n, const quantity<Unit, lanes<W, Isa>>& q) noexcept {
    return quantity<Unit, lanes<W, Isa>>::from_value(n * q.value());
}
template <class Unit, std::size_t W, class Isa, class Number>
requires std::is_arithmetic_v<Number> quantity<Unit, lanes<W, Isa>>
operator/(const quantity<Unit, lanes<W, Isa>>& q, Number n) noexcept {
    return quantity<Unit, lanes<W, Isa>>::from_value(q.value() / n);
}

} // namespace quadrant::inline v0
