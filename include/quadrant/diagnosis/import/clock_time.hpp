// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <charconv>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// A moment that a log writes as people do.
struct clock_stamp {
    long day = 0;           ///< of the calendar; 0 without a date
    double second = 0;      ///< of the day; that of another zone may lie in the day before or after
    std::size_t digits = 0; ///< behind the point
};

/// Reads a stamp of ISO 8601: "2025-11-09T09:27:03.748Z", with a blank for the T, a decimal comma, another zone
/// or none, and "09:27:03.748" without a date. Nothing where the text is none.
class clock_reader {
public:
    static std::optional<clock_stamp> read(std::string_view text) {
        clock_reader in(text);
        clock_stamp out;
        const bool dated = text.size() > 4 && text[4] == '-';
        if (dated && !in.date(out.day)) return {};
        if (!in.time(out) || !in.zone(out.second) || !in.rest_.empty()) return {};
        return out;
    }

private:
    explicit clock_reader(std::string_view text) : rest_(text) {}

    /// So many digits, in this range.
    bool number(std::size_t digits, int least, int most, int& out) {
        if (rest_.size() < digits) return false;
        const auto end = rest_.data() + digits;
        if (*rest_.data() < '0' || *rest_.data() > '9') return false;
        if (const auto [at, fault] = std::from_chars(rest_.data(), end, out); fault != std::errc() || at != end)
            return false;
        rest_.remove_prefix(digits);
        return out >= least && out <= most;
    }
    bool mark(std::string_view any) {
        if (rest_.empty() || any.find(rest_.front()) == any.npos) return false;
        rest_.remove_prefix(1);
        return true;
    }
    bool date(long& day) {
        int y = 0, m = 0, d = 0;
        if (!number(4, 1, 9999, y) || !mark("-") || !number(2, 1, 12, m) || !mark("-") || !number(2, 1, 31, d))
            return false;
        const std::chrono::year_month_day calendar{std::chrono::year(y), std::chrono::month(unsigned(m)),
                                                   std::chrono::day(unsigned(d))};
        day = static_cast<long>(std::chrono::sys_days(calendar).time_since_epoch().count());
        return calendar.ok() && mark("T ");
    }
    bool time(clock_stamp& out) {
        int h = 0, m = 0, s = 0; // 60: a leap second
        if (!number(2, 0, 23, h) || !mark(":") || !number(2, 0, 59, m) || !mark(":") || !number(2, 0, 60, s))
            return false;
        double part = 0, unit = 1;
        if (mark(".,")) {
            for (; !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; rest_.remove_prefix(1)) {
                unit /= 10;
                part += unit * (rest_.front() - '0');
                ++out.digits;
            }
            if (out.digits == 0) return false;
        }
        out.second = 3600 * h + 60 * m + s + part;
        return true;
    }
    /// "Z", "+01:00", "-0500", "+01", or nothing.
    bool zone(double& second) {
        if (rest_.empty() || mark("Z")) return true;
        const bool west = rest_.front() == '-';
        int h = 0, m = 0;
        if (!mark("+-") || !number(2, 0, 14, h)) return false;
        if (mark(":") && rest_.empty()) return false;
        if (!rest_.empty() && !number(2, 0, 59, m)) return false;
        second += (west ? 1 : -1) * (3600 * h + 60 * m);
        return true;
    }

    std::string_view rest_;
};

} // namespace quadrant::inline v0::diagnosis::detail
