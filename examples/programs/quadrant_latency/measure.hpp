// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// How long one call of the two-axis loop takes on this computer.
namespace quadrant_latency {

struct plan {
    double seconds = 60;
    double period_us = 500;
    int core = -1;                    ///< -1: the last one that this process may use
    std::size_t samples = 10'000'000; ///< at most, cache warm
};

/// Durations of one kind, in microseconds, sorted.
struct durations {
    const char *name, *what;
    std::vector<float> us;

    double at(double share) const; ///< 0.5: the median; NaN when there are none
    double median() const { return at(0.5); }
    double p999() const { return at(0.999); }
    double max() const { return at(1); }
};

struct result {
    durations warm{"cache warm", "one call after another, both axes on a circle", {}};
    durations standing{"standing", "the same, both axes at rest for 32 000 periods", {}};
    durations reversing{"reversing", "the same, both axes turn round every ten periods", {}};
    durations cold{"cache cold", "before each call a block larger than the caches is written", {}};
    durations tick{"every period",
                   "from the tick of a timer to the end of the call: the operating system's delay is in it",
                   {}};
    durations clock{
        "the clock alone", "two readings of the clock with nothing between; it is in all others", {}};
    std::size_t overruns = 0; ///< ticks whose call ended after the next tick
    std::size_t block = 0;    ///< bytes written before a cold call
    bool real_time = false;
    std::vector<std::string> setup; ///< what was granted, and what not
};

result measure(const plan& p);

} // namespace quadrant_latency
