// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <time.h>
#include <type_traits>
#include <vector>

namespace quadrant::inline v0 {

/// One call of a loop, never inlined: what `measure` times, and what callgrind finds by its name
/// (benchmarks/bound.sh).
template <class Loop, class Input>
[[gnu::noinline]] decltype(auto) measured_call(Loop& loop, const Input& input) {
    return loop(input);
}

/// How long calls of a loop took, in nanoseconds, sorted. The time of reading the clock is in them.
struct call_times {
    std::vector<double> ns{};
    double clock = 0; ///< median of two readings with nothing between

    /// The time that this share of the calls did not exceed; NaN when there are none.
    double at(double share) const {
        if (ns.empty()) return std::numeric_limits<double>::quiet_NaN();
        const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(ns.size())));
        return ns[std::min(std::max<std::size_t>(place, 1), ns.size()) - 1];
    }
    double median() const { return at(0.5); }
    double p999() const { return at(0.999); }
    double longest() const { return at(1); }
};

namespace detail {
inline std::int64_t nanoseconds_now() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}
/// Keeps what a loop gave, so that no compiler leaves the loop out.
template <class Value> void use(const Value& value) { asm volatile("" : : "g"(&value) : "memory"); }
/// One call, and what it gave or left in the loop.
template <class Loop, class Input> void call(Loop& loop, const Input& input) {
    if constexpr (std::is_void_v<decltype(measured_call(loop, input))>) {
        measured_call(loop, input);
        use(loop);
    } else
        use(measured_call(loop, input));
}
} // namespace detail

/// Times `calls` calls of a loop on this computer, cache warm, over the inputs again and again: loop(input) is
/// one sample, whether it returns something or keeps it. Inputs: a vector, an array, whatever has size() and
/// operator[]. The first pass over the inputs is not counted if there are more calls than inputs. POSIX.
///   const quadrant::call_times t = quadrant::measure(my_loop, inputs);
/// The longest calls are those in which something else had the processor; what the loop itself may need at most
/// is said by benchmarks/bound.sh in instructions.
template <class Loop, class Inputs>
requires requires(Loop& loop, const Inputs& inputs) {
    inputs.size();
    loop(inputs[0]);
}
call_times measure(Loop&& loop, const Inputs& inputs, std::size_t calls = 200'000) {
    call_times result;
    if (inputs.size() == 0) return result;
    result.ns.reserve(calls);
    if (calls > inputs.size())
        for (const auto& input : inputs) detail::call(loop, input);
    for (std::size_t k = 0; result.ns.size() < calls; k = k + 1 == inputs.size() ? 0 : k + 1) {
        const std::int64_t begin = detail::nanoseconds_now();
        detail::call(loop, inputs[k]);
        result.ns.push_back(static_cast<double>(detail::nanoseconds_now() - begin));
    }
    std::sort(result.ns.begin(), result.ns.end());
    std::vector<double> alone(1001);
    for (double& each : alone) {
        const std::int64_t begin = detail::nanoseconds_now();
        each = static_cast<double>(detail::nanoseconds_now() - begin);
    }
    std::nth_element(alone.begin(), alone.begin() + 500, alone.end());
    result.clock = alone[500];
    return result;
}

} // namespace quadrant::inline v0
