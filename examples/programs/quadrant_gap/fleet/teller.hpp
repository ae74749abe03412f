// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fleet.hpp"
#include "pool.hpp"

#include <chrono>
#include <cstdio>
#include <unistd.h>

namespace quadrant_gap::fleet {

/// One line on a terminal that is overwritten; into a file a line every half minute; with --verbose a line a
/// log.
class teller {
public:
    explicit teller(const options& o) : quiet_(o.quiet), verbose_(o.verbose), live_(isatty(STDERR_FILENO)) {}
    void log(const std::string& name, const outcome& o) {
        if (verbose_)
            say(fmt::format("{}: {} in {:.1f} s\n", name, o.error.empty() ? "done" : o.error, o.seconds));
    }
    void progress(const std::string& text, bool last) {
        const auto now = std::chrono::steady_clock::now();
        if (quiet_ ||
            (!last && now - told_ < (live_ ? std::chrono::milliseconds(200) : std::chrono::seconds(30))))
            return;
        told_ = now;
        say(live_ ? fmt::format("\r\033[K{:.78}{}", text, last ? "\n" : "") : text + "\n");
    }

private:
    static void say(const std::string& text) { std::fputs(text.c_str(), stderr); }
    bool quiet_, verbose_, live_;
    std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

} // namespace quadrant_gap::fleet
