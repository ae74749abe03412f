// SPDX-License-Identifier: BSL-1.0
#include "measure.hpp"

#include "loop.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>
#include <utility>

namespace quadrant_latency {

double durations::at(double share) const {
    if (us.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto place = static_cast<std::size_t>(std::ceil(share * double(us.size())));
    return double(us[std::max<std::size_t>(place, 1) - 1]);
}

namespace {

using nanoseconds = std::int64_t;

nanoseconds now() {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return nanoseconds(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}
void sleep_until(nanoseconds at) {
    const timespec t{time_t(at / 1'000'000'000), long(at % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
}
float us_since(nanoseconds begin) { return float(double(now() - begin) * 1e-3); }

/// The loop on one motion for ever.
class runner {
public:
    explicit runner(std::vector<sample> in) : in_(std::move(in)) {
        for (std::size_t k = 0; k < 32'000; ++k) step(); // what dies out has died out
    }
    void step() {
        const commands u = loop_.step(in_[k_]);
        sum_ = sum_ + u.x + u.y;
        k_ = k_ + 1 == in_.size() ? 0 : k_ + 1;
    }
    float timed() {
        const nanoseconds begin = now();
        step();
        return us_since(begin);
    }

private:
    typed_loop<memory> loop_;
    std::vector<sample> in_;
    std::size_t k_ = 0;
    volatile double sum_ = 0; // a consumer
};

/// Takes samples until time or place is over, with rests: the kernel stops a real-time program that never
/// sleeps.
template <class Take> void collect(durations& into, std::size_t most, double seconds, Take&& take) {
    constexpr nanoseconds busy = 5'000'000, rest = 1'000'000;
    const nanoseconds end = now() + nanoseconds(seconds * 1e9);
    while (into.us.size() < most && now() < end) {
        const nanoseconds pause = std::min(now() + busy, end);
        do into.us.push_back(take());
        while (into.us.size() < most && now() < pause);
        sleep_until(now() + rest);
    }
    std::sort(into.us.begin(), into.us.end());
}

void reserve(durations& into, std::size_t n) { // its pages too
    into.us.resize(n);
    into.us.clear();
}

std::size_t larger_than_the_caches() {
    const long last = std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), sysconf(_SC_LEVEL2_CACHE_SIZE));
    return std::clamp<std::size_t>(2 * std::size_t(std::max(last, 0L)), 8 << 20, 128 << 20);
}

/// "granted", or the reason why not.
std::string outcome(const char* what, bool granted, const char* remedy) {
    if (granted) return fmt::format("{}: granted", what);
    return fmt::format("{}: not granted ({}); {}", what, std::strerror(errno), remedy);
}

std::string pin(int core) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0 && core < 0)
        for (int c = 0; c < CPU_SETSIZE; ++c)
            if (CPU_ISSET(c, &allowed)) core = c;
    cpu_set_t one;
    CPU_ZERO(&one);
    if (core >= 0 && core < CPU_SETSIZE) CPU_SET(core, &one);
    const bool granted = sched_setaffinity(0, sizeof one, &one) == 0;
    return outcome(fmt::format("pinned to core {}", core).c_str(), granted,
                   "the cores of this process are limited");
}

} // namespace

result measure(const plan& p) {
    result r;
    const double share = p.seconds / 5;
    reserve(r.warm, p.samples);
    reserve(r.standing, p.samples / 10);
    reserve(r.reversing, p.samples / 10);
    reserve(r.cold, std::min<std::size_t>(p.samples, 1'000'000));
    reserve(r.tick, std::size_t(std::min(double(p.samples), share * 1e6 / p.period_us + 2)));
    reserve(r.clock, 10'000);
    r.block = larger_than_the_caches();
    std::vector<unsigned char> block(r.block);
    runner loop(circle()), parked(standing()), turning(reversing());

    r.setup.push_back(pin(p.core));
    sched_param priority{};
    priority.sched_priority = 80;
    r.real_time = sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
    r.setup.push_back(outcome("real-time priority (SCHED_FIFO, 80)", r.real_time,
                              "run as root, or give your user rtprio in /etc/security/limits.d"));
    const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    r.setup.push_back(
        outcome("memory locked", locked, "run as root, or raise memlock in /etc/security/limits.d"));

    collect(r.clock, r.clock.us.capacity(), 1, [] { return us_since(now()); });
    collect(r.warm, p.samples, share, [&] { return loop.timed(); });
    collect(r.standing, p.samples / 10, share, [&] { return parked.timed(); });
    collect(r.reversing, p.samples / 10, share, [&] { return turning.timed(); });
    unsigned char mark = 0;
    collect(r.cold, r.cold.us.capacity(), share, [&] {
        std::fill(block.begin(), block.end(), ++mark);
        return loop.timed();
    });

    const auto period = std::max<nanoseconds>(1, nanoseconds(p.period_us * 1e3));
    const nanoseconds begin = now() + period, end = begin + nanoseconds(share * 1e9);
    for (nanoseconds tick = begin; tick < end && r.tick.us.size() < r.tick.us.capacity();) {
        sleep_until(tick);
        loop.step();
        const nanoseconds late = now() - tick;
        r.tick.us.push_back(float(double(late) * 1e-3));
        r.overruns += late > period;
        tick += (late / period + 1) * period; // the ticks that were missed are gone
    }
    std::sort(r.tick.us.begin(), r.tick.us.end());
    munlockall(); // what follows is not urgent
    priority.sched_priority = 0;
    sched_setscheduler(0, SCHED_OTHER, &priority);
    return r;
}

} // namespace quadrant_latency
