// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// A reading that comes more slowly than the rows of its log, as over a bus: while the axis moves by many
/// counts most rows repeat the one before.
struct slow_readings {
    std::vector<unsigned char> repeated{}; ///< of every row: 1 inside a motion, between two new readings
    double interval = 0;                   ///< usual, from new reading to new reading of a motion [s]
    double share = 0;                      ///< of the rows of a motion that repeat one

    explicit operator bool() const { return interval > 0; }
};

/// Finds them in stamps that increase, readings and their count; nothing where the axis may have done what was
/// read: an axis that really moves in steps has them at intervals that its speed decides, a bus has not.
class slow_reading_check {
public:
    slow_reading_check(std::span<const double> t, std::span<const double> x, double count) : rows_(x.size()) {
        std::vector<std::size_t> fresh{0};
        for (std::size_t k = 1; k < x.size(); ++k)
            if (x[k] != x[k - 1]) fresh.push_back(k);
        for (std::size_t i = 0; i + 1 < fresh.size(); ++i)
            steps_.push_back(
                {fresh[i], fresh[i + 1], t[fresh[i + 1]] - t[fresh[i]], x[fresh[i + 1]] - x[fresh[i]]});
        std::erase_if(steps_, [&](const step& s) { return std::abs(s.way) < many * count; });
    }

    slow_readings take() const {
        const std::vector<step> motion = in_motion();
        if (motion.size() < least_steps || !keeps_its_interval(motion)) return {};
        std::size_t repeats = 0;
        for (const step& s : motion) repeats += s.to - s.from - 1;
        slow_readings out;
        out.share = static_cast<double>(repeats) / static_cast<double>(repeats + motion.size());
        if (out.share < 0.5) return {};
        out.interval = usual_interval(motion);
        out.repeated.assign(rows_, 0);
        const auto mark = [&](const step& s) {
            for (std::size_t k = s.from + 1; k < s.to; ++k) out.repeated[k] = 1;
        };
        for (const step& s : motion) mark(s);
        for (const step& s : steps_) // at a reversal, too; a longer one is a rest
            if (s.interval < longest * out.interval) mark(s);
        return out;
    }

    static constexpr double longest = 4; ///< of the usual intervals: nothing is known inside a longer one

private:
    /// From a new reading to the next.
    struct step {
        std::size_t from, to; ///< their rows
        double interval, way; ///< [s], [m]
        double speed() const { return std::abs(way) / interval; }
    };
    static constexpr double many = 4; ///< counts
    static constexpr std::size_t least_steps = 30;

    /// Those amid steps of the same direction, before which the axis did not rest.
    std::vector<step> in_motion() const {
        std::vector<step> out;
        for (std::size_t i = 1; i + 1 < steps_.size(); ++i) {
            const step &before = steps_[i - 1], &now = steps_[i], &next = steps_[i + 1];
            const bool joined = before.to == now.from && now.to == next.from;
            const bool one_way = before.way * now.way > 0 && now.way * next.way > 0;
            const bool rested = 2 * now.speed() < std::min(before.speed(), next.speed());
            if (joined && one_way && !rested) out.push_back(now);
        }
        return out;
    }
    static double usual_interval(std::span<const step> steps) {
        std::vector<double> intervals;
        for (const step& s : steps) intervals.push_back(s.interval);
        const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
        std::nth_element(intervals.begin(), middle, intervals.end());
        return *middle;
    }
    /// Whether the interval is not that of the speed: its slope over the speed, both as logarithms, is nearer
    /// to 0 than to the -1 of an axis in steps. At one speed nobody can tell.
    static bool keeps_its_interval(std::span<const step> steps) {
        constexpr double least_spread = 0.1; // of the speed, relative
        const auto n = static_cast<double>(steps.size());
        double v = 0, i = 0, vv = 0, vi = 0;
        for (const step& s : steps) v += std::log(s.speed()) / n, i += std::log(s.interval) / n;
        for (const step& s : steps) {
            const double off = std::log(s.speed()) - v;
            vv += off * off / n;
            vi += off * (std::log(s.interval) - i) / n;
        }
        return vv > least_spread * least_spread && vi > -0.5 * vv;
    }

    std::vector<step> steps_{};
    std::size_t rows_;
};

/// Whether another signal of the axis comes with its readings: it changes in few of the rows that repeat one.
inline bool comes_with(const slow_readings& readings, std::span<const double> y) {
    std::size_t changes = 0, apart = 0;
    for (std::size_t k = 1; k < y.size(); ++k)
        if (y[k] != y[k - 1]) ++changes, apart += readings.repeated[k];
    return changes > 0 && 10 * apart < changes;
}

} // namespace quadrant::inline v0::diagnosis::detail
