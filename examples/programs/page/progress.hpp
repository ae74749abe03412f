// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

namespace quadrant_page {

/// "40 s", "12 min", "3.2 h".
inline std::string about(double seconds) {
    return seconds < 90     ? fmt::format("{:.0f} s", seconds)
           : seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60)
                            : fmt::format("{:.1f} h", seconds / 3600);
}

/// "  7 %", " 42 %, about 12 s left": of work of which a share is done after some time. The time that is left
/// is given once a twentieth is done. 100 % only when all is done.
inline std::string in_per_cent(double share, double seconds) {
    const double whole = share < 1 ? std::min(99.0, std::floor(100 * share)) : 100;
    const bool known = share >= 0.05 && share < 1 && seconds > 0.5;
    return fmt::format("{:3.0f} %{}", whole,
                       known ? ", about " + about(seconds * (1 - share) / share) + " left" : "");
}

/// How far a program is, on standard error: one line that is overwritten on a terminal, else a line every ten
/// seconds.
class progress_line {
public:
    explicit progress_line(bool quiet) : quiet_(quiet) {}
    ~progress_line() { clear(); }
    progress_line(const progress_line&) = delete;
    progress_line& operator=(const progress_line&) = delete;

    /// `done` of `of` pieces of about equal work: in per cent, with the time that is left.
    void operator()(std::size_t done, std::size_t of, const std::string& what) {
        (*this)(what, of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 0);
    }
    /// The share of the work that is done, and the time that is left if the rest goes on as fast.
    void operator()(const std::string& what, double share) { say(so_far(share) + ": " + what); }
    std::string so_far(double share) const { return in_per_cent(share, since()); }
    /// Of work whose amount is not known: with the time that has gone.
    void operator()(const std::string& what) { say(fmt::format("{}: {}", about(since()), what)); }

    void clear() {
        if (shown_) std::fputs("\r\033[K", stderr);
        shown_ = false;
    }

private:
    using clock = std::chrono::steady_clock;
    double since() const { return std::chrono::duration<double>(clock::now() - began_).count(); }
    void say(const std::string& text) {
        constexpr double pause_s = 10;
        if (quiet_ || (!terminal_ && since() < next_)) return;
        next_ = since() + pause_s;
        fmt::print(stderr, "{}{:.78}{}", terminal_ ? "\r\033[K" : "", text, terminal_ ? "" : "\n");
        std::fflush(stderr);
        shown_ = terminal_;
    }
    bool quiet_, terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
    clock::time_point began_ = clock::now();
    double next_ = 10;
};

} // namespace quadrant_page
