// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

/// Calls of the two-axis loop that take every path of a sample, for a count of instructions: on this computer
/// (bound.cpp) and on a Cortex-M7 (cortex_m7.cpp).
namespace quadrant_latency {

/// The kinds of calls, in their order, and how many of each.
struct kind {
    const char* name;
    std::size_t calls;
};
inline constexpr std::array kinds{kind{"first sample", 1},
                                  kind{"moving", 300},
                                  kind{"reversing", 100},
                                  kind{"held for a NaN", 3},
                                  kind{"retune", 1},
                                  kind{"cycle fades", 90},
                                  kind{"standing, after 32 000", 50},
                                  kind{"beyond the limit", 20}};

/// count(number of the kind, what is called, its input), in the order of `kinds`.
template <class Loop, class Count> void directed_calls(Count&& count) {
    using control = typename Loop::control;
    const auto loop = std::make_unique<Loop>();
    const auto step = [&](const sample& s) { return loop->step(s); };
    const auto calls = [&](std::size_t number, const std::vector<sample>& in) {
        for (std::size_t k = 0; k < kinds[number].calls; ++k) count(number, step, in[k % in.size()]);
    };
    calls(0, circle(1));
    calls(1, circle(1000));
    calls(2, reversing(1000));
    auto lost = circle(1);
    lost[0].y.measured = std::numeric_limits<double>::quiet_NaN();
    calls(3, lost);

    auto x = parameters_of<memory>(thesis::x), y = parameters_of<memory>(thesis::y);
    x.memory.cycle = y.memory.cycle = 87.2 * thesis::period;
    x.friction.curve.coulomb = 0.9 * x.friction.curve.coulomb;
    const auto next = std::make_unique<control>(typename control::parameters{x, y}, thesis::period);
    const auto retune = [&](const typename control::motions& r) {
        loop->both.retune(*next, r);
        return 0;
    };
    count(4, retune, typename control::motions{});
    calls(5, circle(1000));
    const auto rest = standing(1);
    for (int k = 0; k < 32'000; ++k) loop->step(rest[0]);
    calls(6, rest);
    auto far = standing(1);
    far[0].x.position = far[0].y.position = 0.01; // metres away
    calls(7, far);
}

} // namespace quadrant_latency
