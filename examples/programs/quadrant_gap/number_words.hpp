// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "quadrant/diagnosis/result/result.hpp"

/// Numbers as an engineer reads them: digits, units, intervals.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

inline std::string fixed(double value, int decimals) {
    if (!std::isfinite(value)) return "-";
    const double step = std::pow(10.0, -decimals);
    return fmt::format("{:.{}f}", std::round(value / step) * step + 0.0,
                       std::max(decimals, 0)); // + 0.0: no "-0"
}

/// As many decimals as a gap deserves: 124, 20.7, 2.4, 0.92, 0.0031.
inline std::string number(double value) {
    const double size = std::abs(value);
    if (size == 0 || size >= 100) return fixed(value, 0);
    return fixed(value, size >= 1 ? 1 : std::min(6, 1 - static_cast<int>(std::floor(std::log10(size)))));
}

struct scale {
    double factor;
    std::string_view unit;
};

/// The unit in which a value of this size is read: 2.5e-6 m is 2.5 um.
inline scale scale_of(std::string_view unit, double size) {
    struct step {
        std::string_view unit;
        double from;
        scale shown;
    };
    static constexpr step steps[] = {
        {"m", 1, {1, "m"}},
        {"m", 1e-3, {1e3, "mm"}},
        {"m", 1e-7, {1e6, "µm"}},
        {"m", 1e-12, {1e9, "nm"}},
        {"m/s", 1, {1, "m/s"}},
        {"m/s", 1e-3, {1e3, "mm/s"}},
        {"m/s", 1e-9, {1e6, "µm/s"}},
        {"s", 1, {1, "s"}},
        {"s", 1e-4, {1e3, "ms"}},
        {"s", 1e-9, {1e6, "µs"}},
        {"N", 1e4, {1e-3, "kN"}},
        {"N", 0.05, {1, "N"}},
        {"N", 1e-6, {1e3, "mN"}},
        {"V", 0.1, {1, "V"}},
        {"V", 1e-6, {1e3, "mV"}},
        {"N/m", 1e6, {1e-6, "N/µm"}},
        {"rad", 1, {1, "rad"}},
        {"rad", 1e-3, {1e3, "mrad"}},
        {"rad", 1e-7, {1e6, "µrad"}},
        {"rad", 1e-12, {1e9, "nrad"}},
        {"rad/s", 1, {1, "rad/s"}},
        {"rad/s", 1e-3, {1e3, "mrad/s"}},
        {"rad/s", 1e-9, {1e6, "µrad/s"}},
        {"N m", 1e4, {1e-3, "kN m"}},
        {"N m", 0.05, {1, "N m"}},
        {"N m", 1e-6, {1e3, "mN m"}},
        {"N m/rad", 1e6, {1e-6, "N m/µrad"}},
        {"phase", 0, {57.29577951308232, "deg"}},
        {"%", 0, {100, "%"}},
    };
    for (const step& s : steps)
        if (s.unit == unit && std::abs(size) >= s.from) return s.shown;
    return {1, unit};
}

inline std::string with_unit(std::string text, std::string_view unit) {
    return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

inline std::string quantity(double value, std::string_view unit) {
    const scale s = scale_of(unit, value);
    return with_unit(number(value * s.factor), s.unit);
}

/// In the unit in which `other` is said, so that two numbers of one sentence are compared at a glance; in its
/// own below a hundredth of that.
inline std::string quantity_beside(double other, double value, std::string_view unit) {
    const scale s = scale_of(unit, std::abs(value) < 0.01 * std::abs(other) ? value : other);
    return with_unit(number(value * s.factor), s.unit);
}

/// "20.7 → 2.4 N", both in the unit of the larger.
inline std::string change(double before, double after, std::string_view unit) {
    const scale s = scale_of(unit, std::max(std::abs(before), std::abs(after)));
    return fmt::format("{} → {} {}", number(before * s.factor), number(after * s.factor), s.unit);
}

/// "20.3 N (19.9 to 20.7)": the digits are those that the 95 % interval leaves.
inline std::string interval(const estimate& e, std::string_view unit) {
    if (!(e.high > e.low)) return quantity(e.value, unit);
    const scale s = scale_of(unit, std::max({std::abs(e.value), std::abs(e.low), std::abs(e.high)}));
    const double half_width = (e.high - e.low) * s.factor / 2;
    const int decimals = std::min(9, -static_cast<int>(std::floor(std::log10(half_width / 1.999))));
    return fmt::format("{} ({} to {})", with_unit(fixed(e.value * s.factor, decimals), s.unit),
                       fixed(e.low * s.factor, decimals), fixed(e.high * s.factor, decimals));
}

inline std::string percent(double share) { return fmt::format("{} %", fixed(100 * share, 0)); }

inline std::string percent(const estimate& e) {
    if (!(e.high > e.low)) return percent(e.value);
    return fmt::format("{} ({} to {})", percent(e.value), fixed(100 * e.low, 0), fixed(100 * e.high, 0));
}

/// What a gap does that shrinks by this share of itself: one that grows has no per cent from its double on.
inline std::string shrinkage(const estimate& e) {
    if (!(e.value < 0)) return "shrinks by " + percent(e);
    return e.value < -1 ? fmt::format("grows to {:.3g} times", 1 - e.value) : "grows by " + percent(-e.value);
}

/// A probability is never said to be 0 or 1.
inline std::string probability(double p) {
    if (p > 0.99) return "> 99 %";
    if (p < 0.01) return "< 1 %";
    return percent(p);
}

} // namespace quadrant_gap
