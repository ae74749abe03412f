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

inline std::array<const durations*, 5> measured(const result& r) {
    return {&r.warm, &r.standing, &r.reversing, &r.cold, &r.tick};
}

/// The kind with the longest of all calls.
inline const durations& slowest(const result& r) {
    const durations* slow = &r.warm;
    for (const durations* d : measured(r))
        if (d->max() > slow->max()) slow = d;
    return *slow;
}
inline bool fits(const result& r, double period_us) { return slowest(r).max() <= period_us; }

/// Three digits that count: 1.36, 41.2, 1250.
inline std::string digits(double v) {
    if (!std::isfinite(v)) return "-";
    const int leading = v == 0 ? 0 : int(std::floor(std::log10(std::abs(v))));
    return fmt::format("{:.{}f}", v, std::clamp(2 - leading, 0, 4));
}
inline std::string percent(double us, double period_us) { return digits(100 * us / period_us) + " %"; }

/// "Yes, ...", "No, ...", or what was the loop and what the computer.
inline std::string answer(const result& r, double period_us) {
    const durations& slow = slowest(r);
    std::size_t calls = 0;
    for (const durations* d : measured(r)) calls += d->us.size();
    const std::string longest = fmt::format("the longest of {} calls ({}) took {} us, {} of the period", calls,
                                            slow.name, digits(slow.max()), percent(slow.max(), period_us));
    if (fits(r, period_us))
        return fmt::format("Yes, it fits {} us: {}; the margin is {} us.", digits(period_us), longest,
                           digits(period_us - slow.max()));
    // What the loop itself needs: a call with cold caches, of which half take less whatever else runs.
    const double alone = r.cold.median();
    if (!(alone <= period_us))
        return fmt::format(
            "No, it does not fit {} us: with cold caches one call computes for {} us (median), {} of the "
            "period.",
            digits(period_us), digits(alone), percent(alone, period_us));
    return fmt::format(
        "The loop fits {} us: with cold caches it computes for {} us (median), {} of the period. This computer "
        "did not keep the period: {}. What is beyond the computing is interruptions and late wake-ups{}.",
        digits(period_us), digits(alone), percent(alone, period_us), longest,
        r.real_time ? ": look at the kernel (PREEMPT_RT, isolcpus) and at what else runs"
                    : ", and there was no real-time priority");
}

inline std::string text(const result& r, double period_us) {
    std::string out = "The two-axis loop: cascade, notch, GMS friction, disturbance observer, repetitive "
                      "memory with 90 and 61 taps.\n";
    for (const std::string& s : r.setup) out += s + "\n";
    out += fmt::format("\n{:16}{:>10}{:>11}{:>11}{:>11}   max in % of {:g}, {:g}, {:g} us\n", "us", "calls",
                       "median", "p99.9", "max", periods_us[0], periods_us[1], periods_us[2]);
    for (const durations* d : {&r.warm, &r.standing, &r.reversing, &r.cold, &r.tick, &r.clock}) {
        out += fmt::format("{:16}{:>10}{:>11}{:>11}{:>11}", d->name, d->us.size(), digits(d->median()),
                           digits(d->p999()), digits(d->max()));
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
