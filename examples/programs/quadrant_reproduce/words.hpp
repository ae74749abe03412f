// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

/// How figures are written, in the page and in the text file.
namespace quadrant_reproduce {

inline std::string unit_sign(std::string_view unit) {
    return unit == "1"      ? ""
           : unit == "um"   ? "µm"
           : unit == "N/um" ? "N/µm"
           : unit == "deg"  ? "°"
                            : std::string(unit);
}
/// Four digits that count; "-" where there is none.
inline std::string number(const std::optional<double>& v) {
    if (!v) return "-";
    const int leading = *v == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(*v))));
    if (leading < -4 || leading > 5) return fmt::format("{:.3e}", *v);
    return fmt::format("{:.{}f}", *v, std::max(0, 3 - leading));
}
/// "15.56 dB", no break between the two.
inline std::string with_unit(const row& r) {
    const std::string sign = unit_sign(r.unit);
    return number(r.simulated) + (sign.empty() || sign == "°" ? sign : "\u00a0" + sign);
}
/// As the thesis prints it.
inline std::string as_printed(const std::optional<double>& v) { return v ? fmt::format("{:g}", *v) : "-"; }

inline std::optional<double> distance(const row& r, const std::optional<double>& other) {
    if (!r.simulated || !other || *other == 0) return std::nullopt;
    return *r.simulated / *other - 1;
}
/// "-0.3 %"
inline std::string percent(double off) {
    const double p = 100 * off;
    return fmt::format("{:+.{}f} %", std::abs(p) < 0.05 ? 0.0 : p, std::abs(p) < 9.95 ? 1 : 0);
}
/// "15.6 (-0.3 %)": a given figure, and how far ours lies from it.
inline std::string compared(const row& r, const std::optional<double>& other) {
    const auto off = distance(r, other);
    return off ? fmt::format("{} ({})", as_printed(other), percent(*off)) : as_printed(other);
}

/// "4 of 6": how many of the given figures ours comes near to; a dash where none is given.
inline std::string near_words(const std::vector<row>& rows, std::optional<double> row::*given, double limit) {
    std::size_t all = 0, near = 0;
    for (const row& r : rows)
        if (const auto off = distance(r, r.*given)) {
            ++all;
            near += std::abs(*off) <= limit;
        }
    return all == 0 ? "-" : fmt::format("{} of {}", near, all);
}

/// What is asked: loop figures within 2 %, friction figures within 10 % of reference_computation.
struct tally {
    std::size_t compared = 0, within = 0;
    std::vector<const row*> outside{};
};
inline tally count(const std::vector<row>& rows, double tolerance) {
    tally t;
    for (const row& r : rows) {
        if (!r.reference_computation) continue;
        ++t.compared;
        const auto off = distance(r, r.reference_computation);
        if (off && std::abs(*off) <= tolerance)
            ++t.within;
        else
            t.outside.push_back(&r);
    }
    return t;
}

} // namespace quadrant_reproduce
