// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "measure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>

/// The result in words.
namespace quadrant_latency {

inline constexpr std::array periods_us{500.0, 125.0, 50.0};

inline std::array<const durations*, 3> measured(const result& r) { return {&r.warm, &r.cold, &r.tick}; }

/// The longest of all calls, from wherever it was started.
inline double worst(const result& r) {
    double us = 0;
    for (const durations* d : measured(r)) us = std::max(us, d->us.empty() ? 0 : d->max());
    return us;
}
inline bool fits(const result& r, double period_us) { return worst(r) <= period_us; }

/// Three digits that count: 1.36, 41.2, 1250.
inline std::string digits(double v) {
    if (!std::isfinite(v)) return "-";
    const int leading = v == 0 ? 0 : int(std::floor(std::log10(std::abs(v))));
    return fmt::format("{:.{}f}", v, std::clamp(2 - leading, 0, 4));
}
inline std::string percent(double us, double period_us) { return digits(100 * us / period_us) + " %"; }

/// "Yes: ..." or "No: ...".
inline std::string answer(const result& r, double period_us) {
    const double longest = worst(r);
    std::string text =
        fits(r, period_us)
            ? fmt::format("Yes, it fits {} us: the longest of {} calls took {} us, {} of the period; the "
                          "margin is {} us.",
                          digits(period_us), r.warm.us.size() + r.cold.us.size() + r.tick.us.size(),
                          digits(longest), percent(longest, period_us), digits(period_us - longest))
            : fmt::format("No, it does not fit {} us: the longest call took {} us, {} of the period.",
                          digits(period_us), digits(longest), percent(longest, period_us));
    if (fits(r, period_us)) return text;
    if (const double alone = r.cold.median(); alone <= period_us) {
        text += fmt::format(" With cold caches it takes {} us (median): ", digits(alone));
        text += r.real_time ? "what is longer are interruptions; look at the kernel (PREEMPT_RT, isolcpus)."
                            : "what is longer are interruptions, and there was no real-time priority.";
    }
    return text;
}

inline std::string text(const result& r, double period_us) {
    std::string out = "The two-axis loop: cascade, notch, GMS friction, disturbance observer, repetitive "
                      "memory with 90 and 61 taps.\n";
    for (const std::string& s : r.setup) out += s + "\n";
    out += fmt::format("\n{:16}{:>10}{:>11}{:>11}{:>11}   max in % of {:g}, {:g}, {:g} us\n", "us", "calls",
                       "median", "p99.9", "max", periods_us[0], periods_us[1], periods_us[2]);
    for (const durations* d : {&r.warm, &r.cold, &r.tick, &r.clock}) {
        out += fmt::format("{:16}{:>10}{:>11}{:>11}{:>11}", d->name, d->us.size(), digits(d->median()),
                           digits(d->most_of()), digits(d->max()));
        if (d != &r.clock)
            for (const double period : periods_us) out += fmt::format("{:>9}", digits(100 * d->max() / period));
        out += "\n";
    }
    out += fmt::format(
        "cold: {} MiB written before each call. every period: from the tick to the end, {} of {} too late.\n\n",
        r.block >> 20, r.overruns, r.tick.us.size());
    return out + answer(r, period_us) + "\n";
}

} // namespace quadrant_latency
