// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "signal.hpp"

/// Literals for parameters: `125_us`, `330_Hz`, `12_kg`. A rate is written `60_per_s` or `60.0 / 1_s`
/// (integers do not divide by a quantity), and is not a frequency: see units.hpp.
namespace quadrant::inline v0::detail {
template <class Unit> constexpr quantity<Unit> of(long double value) {
    return quantity<Unit>::from_value(static_cast<double>(value));
}
} // namespace quadrant::inline v0::detail

namespace quadrant::inline v0::literals {

constexpr auto operator""_m(long double v) { return detail::of<si::length>(v); }
constexpr auto operator""_mm(long double v) { return detail::of<si::length>(v * 1e-3L); }
constexpr auto operator""_um(long double v) { return detail::of<si::length>(v * 1e-6L); }
constexpr auto operator""_nm(long double v) { return detail::of<si::length>(v * 1e-9L); }
constexpr auto operator""_mps(long double v) { return detail::of<si::velocity>(v); }
constexpr auto operator""_mmps(long double v) { return detail::of<si::velocity>(v * 1e-3L); }
constexpr auto operator""_mps2(long double v) { return detail::of<si::acceleration>(v); }
constexpr auto operator""_s(long double v) { return detail::of<si::time>(v); }
constexpr auto operator""_ms(long double v) { return detail::of<si::time>(v * 1e-3L); }
constexpr auto operator""_us(long double v) { return detail::of<si::time>(v * 1e-6L); }
constexpr auto operator""_Hz(long double v) { return detail::of<hertz_unit>(v); }
constexpr auto operator""_kHz(long double v) { return detail::of<hertz_unit>(v * 1e3L); }
constexpr auto operator""_per_s(long double v) { return detail::of<si::frequency>(v); }
constexpr auto operator""_kg(long double v) { return detail::of<si::mass>(v); }
constexpr auto operator""_N(long double v) { return detail::of<si::force>(v); }
constexpr auto operator""_Nm(long double v) { return detail::of<si::torque>(v); }
constexpr auto operator""_radps(long double v) { return detail::of<si::angular_velocity>(v); }
constexpr auto operator""_kgm2(long double v) { return detail::of<si::moment_of_inertia>(v); }
constexpr auto operator""_V(long double v) { return detail::of<si::electric_potential>(v); }
constexpr auto operator""_A(long double v) { return detail::of<si::current>(v); }

constexpr auto operator""_m(unsigned long long v) {
    return detail::of<si::length>(static_cast<long double>(v));
}
constexpr auto operator""_mm(unsigned long long v) { return operator""_mm(static_cast<long double>(v)); }
constexpr auto operator""_um(unsigned long long v) { return operator""_um(static_cast<long double>(v)); }
constexpr auto operator""_nm(unsigned long long v) { return operator""_nm(static_cast<long double>(v)); }
constexpr auto operator""_mps(unsigned long long v) { return operator""_mps(static_cast<long double>(v)); }
constexpr auto operator""_mmps(unsigned long long v) { return operator""_mmps(static_cast<long double>(v)); }
constexpr auto operator""_mps2(unsigned long long v) { return operator""_mps2(static_cast<long double>(v)); }
constexpr auto operator""_s(unsigned long long v) { return operator""_s(static_cast<long double>(v)); }
constexpr auto operator""_ms(unsigned long long v) { return operator""_ms(static_cast<long double>(v)); }
constexpr auto operator""_us(unsigned long long v) { return operator""_us(static_cast<long double>(v)); }
constexpr auto operator""_Hz(unsigned long long v) { return operator""_Hz(static_cast<long double>(v)); }
constexpr auto operator""_kHz(unsigned long long v) { return operator""_kHz(static_cast<long double>(v)); }
constexpr auto operator""_per_s(unsigned long long v) { return operator""_per_s(static_cast<long double>(v)); }
constexpr auto operator""_kg(unsigned long long v) { return operator""_kg(static_cast<long double>(v)); }
constexpr auto operator""_N(unsigned long long v) { return operator""_N(static_cast<long double>(v)); }
constexpr auto operator""_Nm(unsigned long long v) { return operator""_Nm(static_cast<long double>(v)); }
constexpr auto operator""_radps(unsigned long long v) { return operator""_radps(static_cast<long double>(v)); }
constexpr auto operator""_kgm2(unsigned long long v) { return operator""_kgm2(static_cast<long double>(v)); }
constexpr auto operator""_V(unsigned long long v) { return operator""_V(static_cast<long double>(v)); }
constexpr auto operator""_A(unsigned long long v) { return operator""_A(static_cast<long double>(v)); }

} // namespace quadrant::inline v0::literals
