// SPDX-License-Identifier: BSL-1.0
// Long: one overload for each comparison and each kind of number.
#pragma once
#include "units.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

/// Comparison and choice for every number type. `a < b` has one answer; a number of lanes (lanes.hpp) has one
/// answer per lane, a mask. A block that is to run in lanes writes `select(less(x, low), low, x)` where a block
/// in double may write `x < low ? low : x`. For double, float and dual both compile to the same code.
namespace quadrant::inline v0 {

/// How many instances a number holds: 1, or W for lanes<W>.
template <class Number> inline constexpr std::size_t lane_count = 1;
/// That of its number.
template <class Unit, class Real>
inline constexpr std::size_t lane_count<quantity<Unit, Real>> = lane_count<Real>;
/// That of its elements.
template <class Number, std::size_t N>
inline constexpr std::size_t lane_count<std::array<Number, N>> = lane_count<Number>;

/// A number with more than one instance in it.
template <class Number>
concept multi_lane = requires {
    typename Number::mask;
};

/// The same for a class that keeps its lanes apart: lanes<1> is one instance.
template <class Number>
concept several_lanes = multi_lane<Number> && lane_count<Number> >
1;

/// Lanes that take a sample all together or not at all (`lanes_in_step`).
template <class Number>
concept steps_together = multi_lane<Number> &&
    !std::is_same_v<decltype(finite_lanes(std::declval<Number>())), typename Number::mask>;

/// An answer that is the same in every lane and known to the compiler: nothing is computed for it and nothing
/// chosen by it.
template <bool Answer> struct in_every_lane {
    /// As a mask.
    template <class Mask>
    requires(!std::is_arithmetic_v<Mask> && requires { Mask(true)[0]; }) operator Mask() const noexcept {
        return Mask(Answer);
    }
    friend constexpr in_every_lane<!Answer> operator!(in_every_lane) noexcept { return {}; }
    friend constexpr bool any(in_every_lane) noexcept { return Answer; }
    friend constexpr bool all(in_every_lane) noexcept { return Answer; }
    friend constexpr bool none(in_every_lane) noexcept { return !Answer; }
    template <class Mask> friend constexpr Mask both(in_every_lane, const Mask& m) noexcept {
        if constexpr (Answer)
            return m;
        else
            return Mask();
    }
    template <class Mask> friend constexpr Mask either(const Mask& m, in_every_lane) noexcept {
        if constexpr (Answer)
            return Mask(true);
        else
            return m;
    }
    template <class Value>
    friend constexpr Value select(in_every_lane, const Value& one,
                                  const std::type_identity_t<Value>& other) noexcept {
        return Answer ? one : other;
    }
};

namespace detail {
template <class Number> struct mask_of { using type = bool; };
template <multi_lane Number> struct mask_of<Number> { using type = typename Number::mask; };
template <class Unit, class Real> struct mask_of<quantity<Unit, Real>> : mask_of<Real> {};
template <class A, class B>
concept single = std::is_same_v < typename mask_of<A>::type,
bool > &&std::is_same_v<typename mask_of<B>::type, bool>;
} // namespace detail

/// What a comparison of two such numbers returns: bool, or lane_mask for lanes.
template <class Number> using mask_of = typename detail::mask_of<Number>::type;

/// a < b, lane by lane. A NaN is not less than anything; the same holds for the other comparisons.
template <class A, class B>
requires detail::single<A, B>
constexpr bool less(const A& a, const B& b) noexcept { return a < b; }
/// The same for quantities of one unit.
template <class Unit, class A, class B>
requires(!detail::single<A, B>) constexpr auto less(const quantity<Unit, A>& a,
                                                    const quantity<Unit, B>& b) noexcept {
    return less(a.value(), b.value());
}
/// a <= b, lane by lane.
template <class A, class B>
requires detail::single<A, B>
constexpr bool less_equal(const A& a, const B& b) noexcept { return a <= b; }
/// The same for quantities of one unit.
template <class Unit, class A, class B>
requires(!detail::single<A, B>) constexpr auto less_equal(const quantity<Unit, A>& a,
                                                          const quantity<Unit, B>& b) noexcept {
    return less_equal(a.value(), b.value());
}
/// a == b, lane by lane.
template <class A, class B>
requires detail::single<A, B>
constexpr bool equal(const A& a, const B& b) noexcept { return a == b; }
/// The same for quantities of one unit.
template <class Unit, class A, class B>
requires(!detail::single<A, B>) constexpr auto equal(const quantity<Unit, A>& a,
                                                     const quantity<Unit, B>& b) noexcept {
    return equal(a.value(), b.value());
}
/// a != b, lane by lane.
template <class A, class B>
requires detail::single<A, B>
constexpr bool differs(const A& a, const B& b) noexcept { return a != b; }
/// The same for quantities of one unit.
template <class Unit, class A, class B>
requires(!detail::single<A, B>) constexpr auto differs(const quantity<Unit, A>& a,
                                                       const quantity<Unit, B>& b) noexcept {
    return differs(a.value(), b.value());
}
/// a > b, lane by lane.
template <class A, class B> constexpr auto greater(const A& a, const B& b) noexcept { return less(b, a); }
/// a >= b, lane by lane.
template <class A, class B> constexpr auto greater_equal(const A& a, const B& b) noexcept {
    return less_equal(b, a);
}

/// True when some lane is; for a bool: itself. A mask has the same three functions.
constexpr bool any(bool one) noexcept { return one; }
/// True when every lane is.
constexpr bool all(bool one) noexcept { return one; }
/// True when no lane is.
constexpr bool none(bool one) noexcept { return !one; }
/// Both hold, lane by lane. (A bool has && for that, a mask has &.)
constexpr bool both(bool a, bool b) noexcept { return a && b; }
/// One of them holds, lane by lane.
constexpr bool either(bool a, bool b) noexcept { return a || b; }

/// The one where `choice` is true, the other elsewhere. Both are computed.
template <class Value>
constexpr Value select(bool choice, const Value& one, const std::type_identity_t<Value>& other) noexcept {
    return choice ? one : other;
}
/// The same for quantities of lanes.
template <class Unit, multi_lane Real>
constexpr quantity<Unit, Real> select(const typename Real::mask& choice, const quantity<Unit, Real>& one,
                                      const std::type_identity_t<quantity<Unit, Real>>& other) noexcept {
    return quantity<Unit, Real>::from_value(select(choice, one.value(), other.value()));
}

/// Stores `from` in the lanes where `where` is true and leaves the others as they are.
template <class Value>
constexpr void set_where(bool where, Value& to, const std::type_identity_t<Value>& from) noexcept {
    if (where) to = from;
}
/// The same, lane by lane.
template <class Mask, class Value>
requires(!std::is_same_v<Mask, bool>) constexpr void set_where(
    const Mask& where, Value& to, const std::type_identity_t<Value>& from) noexcept {
    if (all(where)) // nearly always, and a branch costs less than W selections
        to = from;
    else
        to = select(where, from, to);
}
/// The same for each entry of an array.
template <class Mask, class Value, std::size_t N>
requires(!std::is_same_v<Mask, bool>) constexpr void set_where(
    const Mask& where, std::array<Value, N>& to,
    const std::type_identity_t<std::array<Value, N>>& from) noexcept {
    for (std::size_t i = 0; i < N; ++i) set_where(where, to[i], from[i]);
}

/// The smaller of two, with std::min's answer for NaN: `a`.
template <class Value> constexpr Value smaller(const Value& a, const std::type_identity_t<Value>& b) noexcept {
    return select(less(b, a), b, a);
}
/// The larger of two, with std::max's answer for NaN: `a`.
template <class Value> constexpr Value larger(const Value& a, const std::type_identity_t<Value>& b) noexcept {
    return select(less(a, b), b, a);
}
namespace detail {
template <class Real> constexpr const Real& number_in(const Real& x) noexcept { return x; }
template <class Unit, class Real> constexpr const Real& number_in(const quantity<Unit, Real>& x) noexcept {
    return x.value();
}
template <class Value, class Real> constexpr Value with_number(const Real& x) noexcept {
    if constexpr (std::is_same_v<Value, Real>)
        return x;
    else
        return Value::from_value(x);
}
} // namespace detail
/// x within its bounds: high above high, low below low, else x, a NaN too.
template <class Value>
constexpr Value limited_to(const Value& x, const std::type_identity_t<Value>& low,
                           const std::type_identity_t<Value>& high) noexcept {
    if constexpr (detail::single<Value, Value>)
        return x > high ? high : x < low ? low : x; // no bound is read that is not needed
    else if constexpr (requires {
                           clipped_lanes(detail::number_in(x), detail::number_in(low), detail::number_in(high));
                       })
        return detail::with_number<Value>(
            clipped_lanes(detail::number_in(x), detail::number_in(low), detail::number_in(high)));
    else
        return select(greater(x, high), high, select(less(x, low), low, x));
}
/// x within -most ... most.
template <class Value>
constexpr Value limited_to(const Value& x, const std::type_identity_t<Value>& most) noexcept {
    if constexpr (detail::single<Value, Value>)
        return x > most ? most : x < -most ? -most : x;
    else
        return limited_to(x, -most, most);
}
/// True where x lies above high or below low.
template <class Value>
constexpr mask_of<Value> outside(const Value& x, const std::type_identity_t<Value>& low,
                                 const std::type_identity_t<Value>& high) noexcept {
    if constexpr (detail::single<Value, Value>)
        return x > high || x < low;
    else
        return greater(x, high) | less(x, low);
}
/// The value without its sign.
template <class Value> constexpr Value absolute(const Value& x) noexcept {
    return select(less(x, Value()), -x, x);
}
/// The same in lanes.
template <multi_lane Real> Real absolute(const Real& x) noexcept { return abs(x); }
/// The same for a quantity of lanes.
template <class Unit, multi_lane Real> quantity<Unit, Real> absolute(const quantity<Unit, Real>& x) noexcept {
    return quantity<Unit, Real>::from_value(abs(x.value()));
}
/// exp(-x) of a number that is not below zero: what is left of a decay.
template <class Real>
requires(!multi_lane<Real>) Real decayed(const Real& x)
noexcept {
    using std::exp;
    return exp(-x);
}

/// One instance: the number itself, or one lane of it.
template <class Number>
requires(lane_count<Number> == 1) constexpr const Number& lane(const Number& x, std::size_t) noexcept {
    return x;
}
/// One lane, with its unit.
template <class Unit, multi_lane Real>
constexpr auto lane(const quantity<Unit, Real>& x, std::size_t i) noexcept {
    return quantity<Unit, double>::from_value(x.value()[i]);
}
/// One lane of every element.
template <class Number, std::size_t N>
requires(lane_count<Number> > 1) constexpr auto lane(const std::array<Number, N>& x, std::size_t i) noexcept {
    std::array<std::remove_cvref_t<decltype(lane(x[0], i))>, N> out;
    for (std::size_t k = 0; k < N; ++k) out[k] = lane(x[k], i);
    return out;
}
/// Replaces one instance: the number itself, or one lane of it.
template <class Number>
requires(lane_count<Number> == 1) constexpr void set_lane(Number& x, std::size_t,
                                                          const std::type_identity_t<Number>& value) noexcept {
    x = value;
}
/// Replaces one lane, unit checked.
template <class Unit, multi_lane Real>
constexpr void set_lane(quantity<Unit, Real>& x, std::size_t i, const quantity<Unit>& value) noexcept {
    Real lanes = x.value();
    lanes.set(i, value.value());
    x = quantity<Unit, Real>::from_value(lanes);
}

} // namespace quadrant::inline v0
