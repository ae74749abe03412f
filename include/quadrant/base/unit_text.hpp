// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "units.hpp"

#include <array>
#include <cstddef>

/// The unit of a quantity as text, for messages: " Hz", " N/V", " V s/m". Found from the type when a program is
/// compiled, so that a message costs no more than the letters. A unit that is a product of others has several
/// names; the text takes the shortest, with volts before newtons, since gains of a servo loop carry volts.
namespace quadrant::inline v0::detail {

/// Powers of the SI's base units, of the radian and of the hertz.
struct unit_powers {
    int m = 0, kg = 0, s = 0, A = 0, rad = 0, Hz = 0;
    bool known = true; ///< false: of another dimension as well, or a broken power
};

template <class Tag> inline constexpr int unit_powers::*power_of_dimension = nullptr;
template <>
inline constexpr int unit_powers::*power_of_dimension<boost::units::length_base_dimension> = &unit_powers::m;
template <>
inline constexpr int unit_powers::*power_of_dimension<boost::units::mass_base_dimension> = &unit_powers::kg;
template <>
inline constexpr int unit_powers::*power_of_dimension<boost::units::time_base_dimension> = &unit_powers::s;
template <>
inline constexpr int unit_powers::*power_of_dimension<boost::units::current_base_dimension> = &unit_powers::A;
template <>
inline constexpr int unit_powers::*power_of_dimension<boost::units::plane_angle_base_dimension> =
    &unit_powers::rad;
template <> inline constexpr int unit_powers::*power_of_dimension<frequency_dimension> = &unit_powers::Hz;

constexpr unit_powers powers_of(boost::units::dimensionless_type) { return {}; }
template <class Tag, class Power, class Rest>
constexpr unit_powers powers_of(boost::units::list<boost::units::dim<Tag, Power>, Rest>) {
    unit_powers out = powers_of(Rest{});
    if constexpr (power_of_dimension<Tag> == nullptr || Power::Denominator != 1)
        out.known = false;
    else
        out.*power_of_dimension<Tag> = static_cast<int>(Power::Numerator);
    return out;
}

/// The letters of a unit, with a space before them; ends in a zero.
struct unit_letters {
    std::array<char, 32> text{};
    std::size_t used = 0;
    constexpr void add(const char* letters) {
        for (; *letters != '\0' && used + 1 < text.size(); ++letters) text[used++] = *letters;
    }
};

constexpr int size_of(int power) { return power < 0 ? -power : power; }

/// What is left of a unit beside `volt` volts and `newton` newtons.
constexpr unit_powers without(unit_powers p, int volt, int newton) {
    p.kg -= volt + newton;
    p.m -= 2 * volt + newton;
    p.s += 3 * volt + 2 * newton;
    p.A += volt;
    return p;
}

/// How long a unit becomes when it is written so. Extra for what nobody writes: kilograms beside seconds or
/// newtons, and newtons beside amperes where volts would do.
constexpr int effort(const unit_powers& left, int volt, int newton) {
    return 2 * (size_of(volt) + size_of(newton) + size_of(left.m) + size_of(left.kg) + size_of(left.s) +
                size_of(left.A)) +
           (left.kg != 0 && (left.s != 0 || newton != 0) ? 4 : 0) +
           (newton != 0 && volt == 0 && left.A != 0 ? 3 : 0);
}

constexpr unit_letters letters_of(const unit_powers& powers) {
    unit_letters out;
    if (!powers.known) return out;
    int volt = 0, newton = 0;
    for (int v = -2; v <= 2; ++v)
        for (int n = -2; n <= 2; ++n)
            if (effort(without(powers, v, n), v, n) < effort(without(powers, volt, newton), volt, newton))
                volt = v, newton = n;
    unit_powers left = without(powers, volt, newton);
    if (powers.kg != 0 && volt == 0) left.rad = 0; // N m, kg m^2: as they are written everywhere
    struct part {
        const char* name;
        int power;
    };
    const std::array<part, 8> parts{{{"V", volt},
                                     {"N", newton},
                                     {"kg", left.kg},
                                     {"A", left.A},
                                     {"Hz", left.Hz},
                                     {"rad", left.rad},
                                     {"m", left.m},
                                     {"s", left.s}}};
    bool above = false;
    const auto write = [&](const part& p, const char* before) {
        const char digit[2] = {static_cast<char>('0' + size_of(p.power)), '\0'};
        out.add(before);
        out.add(p.name);
        if (size_of(p.power) > 1) out.add("^"), out.add(digit);
    };
    for (const part& p : parts)
        if (p.power > 0) write(p, " "), above = true;
    int below = 0;
    for (const part& p : parts) below += p.power < 0;
    if (below == 0) return out;
    out.add(above ? "/" : " per ");
    if (below > 1) out.add("(");
    bool first = true;
    for (const part& p : parts)
        if (p.power < 0) write(p, first ? "" : " "), first = false;
    if (below > 1) out.add(")");
    return out;
}

/// " Hz" for a quantity in hertz, nothing for a bare number.
template <class Value> inline constexpr unit_letters unit_text{};
template <class Dimension, class System, class Real>
inline constexpr unit_letters unit_text<boost::units::quantity<boost::units::unit<Dimension, System>, Real>> =
    letters_of(powers_of(Dimension{}));

} // namespace quadrant::inline v0::detail
