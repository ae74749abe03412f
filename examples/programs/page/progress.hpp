// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <chrono>
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
        const double share = of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 0;
        const std::string left =
            done > 0 && done < of ? ", about " + about(since() * (1 - share) / share) + " left" : "";
        say(fmt::format("{:3.0f} %{}: {}", 100 * share, left, what));
    }
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
