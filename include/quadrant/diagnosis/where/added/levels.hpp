// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"
#include "constant_parts.hpp"

#include <numeric>
#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// Parts of constant level, as a waveform: single constants, or levels that repeat.
class level_finder {
public:
    explicit level_finder(const added_signal& s) : s_(s), parts_(s.values, s.noise, most_parts) {
        if (parts_.size() < 2) return;
        group();
        find_zero();
        if (!(zero_ < groups_)) return;
        find_pattern();
    }

    std::optional<waveform_candidate> candidate() const {
        constexpr std::size_t most_single = 8; // more of them are no simple form
        if (parts_.size() < 2 || !(zero_ < groups_) || (!repeat_ && parts_.size() > most_single)) return {};
        waveform_candidate out;
        for (std::size_t g = 0; g < groups_; ++g) {
            if (g == zero_) continue;
            out.columns.emplace_back(s_.values.size(), 0.0);
            for (std::size_t p = 0; p < parts_.size(); ++p)
                if (group_[p] == g)
                    std::fill(out.columns.back().begin() + static_cast<std::ptrdiff_t>(parts_.begin(p)),
                              out.columns.back().begin() + static_cast<std::ptrdiff_t>(parts_.end(p)), 1.0);
        }
        out.numbers = repeat_ ? repeat_ + 2 : parts_.size() - 1;
        out.form = described();
        return out;
    }

private:
    static constexpr std::size_t most_parts = 400;

    double level(std::size_t part) const { return parts_.level(part); }

    /// Parts whose levels agree to a twentieth of the largest difference, or to their noise, are one level.
    void group() {
        std::vector<std::size_t> order(parts_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return level(a) < level(b); });
        const double range = level(order.back()) - level(order.front());
        group_.assign(parts_.size(), 0);
        double first = level(order.front());
        groups_ = 1;
        for (std::size_t i : order) {
            const double noise = 4 * s_.noise / std::sqrt(static_cast<double>(parts_.length(i)));
            if (level(i) - first > std::max(0.05 * range, noise)) {
                first = level(i);
                ++groups_;
            }
            group_[i] = groups_ - 1;
        }
        mean_.assign(groups_, 0);
        rows_.assign(groups_, 0);
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            mean_[group_[p]] += level(p) * static_cast<double>(parts_.length(p));
            rows_[group_[p]] += static_cast<double>(parts_.length(p));
        }
        for (std::size_t g = 0; g < groups_; ++g) mean_[g] /= rows_[g];
    }
    /// The level at which nothing is added. Where the first integral is unknown, no log shows it, and it is the
    /// level before the first change; of one that repeats from the first row on, the level that lasts longest.
    void find_zero() {
        zero_ = groups_;
        if (!s_.offset_unknown) {
            const double range =
                *std::max_element(mean_.begin(), mean_.end()) - *std::min_element(mean_.begin(), mean_.end());
            for (std::size_t g = 0; g < groups_; ++g)
                if (std::abs(mean_[g]) <= std::max(0.05 * range, s_.noise)) zero_ = g;
            if (zero_ == groups_) { // it is never zero: a level without rows
                mean_.push_back(0);
                rows_.push_back(0);
                zero_ = groups_++;
            }
            return;
        }
        zero_ = group_.front();
        std::size_t longest = 0, again = 0;
        for (std::size_t p = 1; p < parts_.size(); ++p)
            if (group_[p] == zero_) {
                longest = std::max(longest, parts_.length(p));
                ++again;
            }
        if (again >= 2 && parts_.length(0) <= longest + longest / 50 + 2)
            zero_ = static_cast<std::size_t>(std::max_element(rows_.begin(), rows_.end()) - rows_.begin());
    }
    /// Levels that come back in the same order and for as long, twice at least. What stands before the first
    /// and behind the last of them is zero, or a cut part.
    void find_pattern() {
        const std::size_t first = group_.front() == zero_ ? 1 : 0;
        for (std::size_t q = 2; q <= 6 && parts_.size() >= first + 2 * q; ++q)
            if (repeats(first, parts_.size(), q)) {
                repeat_ = q;
                first_ = first;
                return;
            }
    }
    bool repeats(std::size_t first, std::size_t last, std::size_t q) const {
        for (std::size_t p = first; p + q < last; ++p) {
            if (group_[p] != group_[p + q]) return false;
            const bool cut = p == 0 || p + q + 2 >= last; // by the ends of the record, or of the signal
            const auto a = static_cast<double>(parts_.length(p)), b = static_cast<double>(parts_.length(p + q));
            if (!cut && std::abs(a - b) > 2 + 0.02 * a) return false;
        }
        return true;
    }
    added_waveform described() const {
        added_waveform w;
        const double T = s_.period;
        const auto time = [&](std::size_t row) { return s_.time(row); };
        std::size_t begin = parts_.size(), end = 0;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            if (group_[p] != zero_) begin = std::min(begin, p), end = p;
        w.from_s = time(parts_.begin(begin));
        w.to_s = time(parts_.end(end));
        w.from_start = begin == 0;
        w.to_end = parts_.end(end) == s_.values.size();
        const std::size_t one = repeat_ ? repeat_ : end + 1 - begin;
        const std::size_t from = repeat_ ? first_ : begin;
        for (std::size_t i = 0; i < one; ++i) {
            double length = 0, times = 0;
            for (std::size_t p = from + i; p < parts_.size(); p += repeat_ ? repeat_ : parts_.size()) {
                if (repeat_ && (p == 0 || p + 1 == parts_.size())) continue; // cut
                length += static_cast<double>(parts_.length(p));
                ++times;
            }
            w.levels.push_back({mean_[group_[from + i]] - mean_[zero_], times > 0 ? T * length / times : 0,
                                time(parts_.begin(from + i))});
        }
        w.form = waveform_form::constant;
        if (!repeat_) return w;
        const std::size_t turns = (parts_.size() - 1 - first_) / repeat_;
        w.period_s = (time(parts_.begin(first_ + turns * repeat_)) - time(parts_.begin(first_))) /
                     static_cast<double>(turns);
        if (w.to_end || group_.back() == zero_) { // the last part may be the pattern's, cut
            const double quiet = T * static_cast<double>(parts_.length(parts_.size() - 1));
            w.to_end = w.to_end || quiet < 1.05 * w.levels[(parts_.size() - 1 - first_) % repeat_].duration_s;
        }
        if (w.to_end) w.to_s = time(s_.values.size());
        w.form = is_square(w) ? waveform_form::square : waveform_form::pattern;
        return w;
    }
    /// One level above or below zero, or two of opposite sign that take turns, with zero between them or not.
    static bool is_square(const added_waveform& w) {
        std::vector<double> sizes;
        for (const auto& l : w.levels)
            if (l.value != 0) sizes.push_back(l.value);
        if (sizes.size() == 1) return true;
        return sizes.size() == 2 && std::abs(sizes[0] + sizes[1]) < 0.1 * std::abs(sizes[0]) &&
               (w.levels.size() == 2 ||
                (w.levels.size() == 4 && (w.levels[0].value == 0) == (w.levels[2].value == 0)));
    }

    const added_signal& s_;
    constant_parts parts_;
    std::vector<std::size_t> group_; ///< level of each part
    std::vector<double> mean_, rows_;
    std::size_t groups_ = 0, zero_ = 0, repeat_ = 0, first_ = 0;
};

} // namespace quadrant::inline v0::diagnosis::detail
