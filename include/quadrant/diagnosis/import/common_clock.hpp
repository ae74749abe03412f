// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/even_rows.hpp"
#include "../log/sensor_box.hpp"
#include "../log/slow_readings.hpp"
#include "../log/wrong_readings.hpp"
#include "../text/bad_input.hpp"
#include "foreign_table.hpp"
#include "map.hpp"
#include "import_choice.hpp"
#include "own_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The rows of all files on one even clock.
class common_clock {
public:
    common_clock(const import_map& map, std::span<const foreign_file> files, const import_choice& choice,
                 std::vector<foreign_table>& tables, tell_of_file tell)
        : map_(map), files_(files), choice_(choice), tables_(tables), tell_(std::move(tell)) {}

    /// All files onto one even clock, that of the first file's rows or of the period that was asked for.
    void take() {
        const foreign_table& first = tables_.front();
        period_ = choice_.period_s > 0 ? choice_.period_s : usual_period(first);
        for (std::size_t i = 0; i < tables_.size(); ++i) find_slow_readings(i);
        const double period = period_;
        double begin = std::max(0.0, choice_.from_s), end = std::min(first.t.back(), choice_.to_s);
        for (const auto& table : tables_) {
            begin = std::max(begin, table.t.front());
            end = std::min(end, table.t.back());
        }
        begin = period * std::ceil(begin / period - 1e-6);
        if (!(end - begin > 2 * period))
            throw bad_input(files_.back().name,
                            fmt::format("the files have no time in common, or --from and --to "
                                        "leave none: {:.6g} to {:.6g} s",
                                        begin, end));
        constexpr double most = 100; // samples for each row: more is a pause, or a period that is not meant
        if ((end - begin) / period > most * static_cast<double>(first.t.size()))
            throw bad_input(
                files_.front().name,
                fmt::format("{:.3g} s at a period of {:.3g} s are far more samples than its {} rows: take a "
                            "part with --from and --to, or give --sample-period",
                            end - begin, period, first.t.size()));
        samples_ = static_cast<std::size_t>(std::floor((end - begin) / period + 1e-6)) + 1;
        left_out_.assign(samples_, 0);
        for (std::size_t i = 0; i < tables_.size(); ++i) resample(i, begin, period);
    }
    std::size_t samples() const { return samples_; }
    bool left_out(std::size_t k) const { return left_out_[k] != 0; }
    double period() const { return period_; }

private:
    /// The period of rows that are even, else the median step of their stamps.
    static double usual_period(const foreign_table& table) {
        const auto clock = clock_of_rows(table.t, table.written);
        if (clock.even && clock.gaps == 0) return clock.period;
        std::vector<double> steps;
        for (std::size_t k = 1; k < table.t.size(); ++k) steps.push_back(table.t[k] - table.t[k - 1]);
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::nth_element(steps.begin(), middle, steps.end());
        // Steps that are rounded to the last digit of the stamps differ from the period by up to it.
        return *middle > 0 && std::abs(*middle - clock.period) > table.written ? *middle : clock.period;
    }
    /// What is read more slowly than the rows come. No period that was not asked for is shorter than that.
    void find_slow_readings(std::size_t file) {
        const foreign_table& table = tables_[file];
        for (const auto& c : table.columns) {
            if (c.name.find("_pos_") == c.name.npos) continue;
            auto found = slow_reading_check(table.t, c.values, observed_count(c.values, c.step())).take();
            if (!found) continue;
            tell_(file, fmt::format("{}: {:.0f} % of the rows of a motion repeat the reading before; a new one "
                                    "comes every {:.2g} s, and only these count",
                                    c.name, 100 * found.share, found.interval));
            if (!(choice_.period_s > 0)) period_ = std::max(period_, found.interval);
            slow_.push_back({file, c.name.substr(0, c.name.find("pos_")), std::move(found)});
        }
    }
    const slow_readings* slow_readings_of(std::size_t file, const foreign_column& c) const {
        for (const auto& slow : slow_)
            if (slow.file == file && c.name.starts_with(slow.axis) && comes_with(slow.readings, c.values))
                return &slow.readings;
        return nullptr;
    }

    void resample(std::size_t file, double begin, double period) {
        foreign_table& table = tables_[file];
        const auto clock = clock_of_rows(table.t, table.written);
        // Rows that are even are evener than their stamps, unless the stamps are asked to count.
        const bool by_row =
            clock.even && clock.gaps == 0 && (!choice_.resample || table.written > 0.01 * clock.period);
        std::vector<double> at;
        for (std::size_t k = 0; k < table.t.size(); ++k) {
            const double t = by_row ? table.t[0] + static_cast<double>(k) * clock.period : table.t[k];
            at.push_back((t - begin) / period);
        }
        std::vector<unsigned char> apart = clock.after_gap;
        if (choice_.period_s > 0 || !slow_.empty()) // on a slower clock a gap is what leaves samples out
            for (std::size_t k = 1; k < apart.size(); ++k)
                if (table.t[k] - table.t[k - 1] <= longest_step * period) apart[k] = 0;
        const even_rows rows(at, std::move(apart), samples_);
        tell_clock(file, clock, period);
        for (auto& c : table.columns) {
            const slow_readings* slow = is_held(c.name) ? nullptr : slow_readings_of(file, c);
            slow ? resample_new_readings(file, table.t, at, *slow, c) : resample(file, table.t, rows, c);
        }
    }
    /// A column of which only some rows are new.
    void resample_new_readings(std::size_t file, std::span<const double> t, std::span<const double> at,
                               const slow_readings& slow, foreign_column& c) {
        std::vector<double> fresh, values, place;
        std::vector<unsigned char> after_gap;
        for (std::size_t k = 0; k < at.size(); ++k) {
            if (slow.repeated[k]) continue;
            const double step = fresh.empty() ? 0 : t[k] - fresh.back();
            after_gap.push_back(step > slow_reading_check::longest * slow.interval);
            fresh.push_back(t[k]);
            values.push_back(c.values[k]);
            place.push_back(at[k]);
        }
        c.values = std::move(values);
        resample(file, fresh, even_rows(std::move(place), std::move(after_gap), samples_), c);
    }
    void resample(std::size_t file, std::span<const double> t, const even_rows& rows, foreign_column& c) {
        if (is_held(c.name)) {
            c.values = rows.held(c.values);
            leave_out(rows.left_out());
            return;
        }
        const bool position = c.name.find("_pos_") != c.name.npos;
        wrong_readings found;
        if (position) {
            found = reading_check(t, c.values, observed_count(c.values, c.step())).take();
            if (found.wrong + found.stale > 0)
                tell_(file, fmt::format("{}: {} wrong and {} repeated readings are left out", c.name,
                                        found.wrong, found.stale));
        }
        leave_out(rows.left_out(found.bad));
        const std::span<const unsigned char> bad = found.bad;
        if (const double error = position ? rows.interpolation_error(c.values, bad) : 0; error > 0)
            tell_(file, fmt::format(
                            "{}: resampling makes an error of at most about {:.2g} {} rms (what the curvature "
                            "adds between rows); a stamp that is itself wrong adds the speed times its error",
                            c.name, error, c.name.ends_with("rad") ? "rad" : "m"));
        c.values = rows.smooth(c.values, bad);
    }
    void leave_out(const std::vector<unsigned char>& samples) {
        for (std::size_t k = 0; k < samples_; ++k) left_out_[k] |= samples[k];
    }
    void tell_clock(std::size_t file, const row_clock& clock, double period) {
        if (!map_.files[file].time && std::abs(clock.period / period - 1) < 1e-9)
            return; // the rows as they are
        tell_(file, fmt::format(
                        "resampled onto a period of {:.6g} s; its rows come every {:.6g} s, single steps up to "
                        "{:.2g} % off, with {} gaps ({} rows missing)",
                        period, clock.period, 100 * clock.spread, clock.gaps, clock.missing));
        tell_of_pieces(file, clock);
    }
    /// Where rows are missing every other moment, the clock on which they are not.
    void tell_of_pieces(std::size_t file, const row_clock& clock) {
        const auto& t = tables_[file].t;
        constexpr std::size_t many = 30; // rows from gap to gap, below which the pieces are too short to use
        if (choice_.period_s > 0 || !slow_.empty() || clock.gaps < 3 || t.size() > many * clock.gaps) return;
        std::vector<double> steps; // across the gaps
        for (std::size_t k = 1; k < t.size(); ++k)
            if (clock.after_gap[k]) steps.push_back(t[k] - t[k - 1]);
        if (steps.empty()) return;
        const auto at = steps.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(steps.size()));
        std::nth_element(steps.begin(), at, steps.end());
        tell_(file, fmt::format("rows are missing every {} rows or so: --sample-period {:.2g} bridges most of "
                                "the gaps",
                                t.size() / clock.gaps, 1.05 * *at / longest_step));
    }
    static constexpr double longest_step = 1.5; ///< of the period: a longer one leaves a sample out

    static bool is_held(const std::string& name) {
        for (const signal_kind& kind : signal_kinds)
            if (kind.held && name.find(kind.infix) != name.npos) return true;
        return false;
    }

    const import_map& map_;
    std::span<const foreign_file> files_;
    const import_choice& choice_;
    std::vector<foreign_table>& tables_;
    tell_of_file tell_;
    struct slow_axis {
        std::size_t file;
        std::string axis; ///< and the stroke behind it, as its columns begin
        slow_readings readings;
    };
    std::vector<slow_axis> slow_{};
    double period_ = 0;
    std::size_t samples_ = 0;
    std::vector<unsigned char> left_out_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
