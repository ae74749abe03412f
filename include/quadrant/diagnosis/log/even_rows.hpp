// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row_clock.hpp"
#include "wrong_readings.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Puts the columns of a log onto an even clock. A row that stands on the clock keeps its numbers as they are.
/// Between rows a smooth signal follows the cubic through the four nearest good readings, and a held one (a
/// command) the mean of its staircase over the sample, which keeps its impulse. Where rows are missing a
/// straight line fills in, and the samples are marked.
class even_rows {
public:
    /// `at`: place of every row on the clock, in samples, increasing; `after_gap` as in row_clock. Samples
    /// count from 0.
    even_rows(std::vector<double> at, std::vector<unsigned char> after_gap, std::size_t samples)
        : at_(std::move(at)), after_gap_(std::move(after_gap)), samples_(samples) {}

    std::size_t samples() const { return samples_; }

    /// Of each sample: 1 where there is no good reading: `bad` rows (empty: none), and gaps.
    std::vector<unsigned char> left_out(std::span<const unsigned char> bad = {}) const {
        const auto rows = good_rows(bad);
        std::vector<unsigned char> out(samples_, 0);
        each_sample(rows, [&](std::size_t k, std::size_t i) {
            out[k] = !on_row(k, rows[i]) && (i + 1 == rows.size() || !whole(rows, i));
        });
        return out;
    }
    /// A signal between whose rows something lies.
    std::vector<double> smooth(std::span<const double> x, std::span<const unsigned char> bad = {}) const {
        const auto rows = good_rows(bad);
        std::vector<double> out(samples_);
        each_sample(rows, [&](std::size_t k, std::size_t i) {
            if (on_row(k, rows[i]) || i + 1 == rows.size())
                out[k] = x[rows[i]];
            else
                out[k] = between(x, rows, i, static_cast<double>(k));
        });
        return out;
    }
    /// A signal that is held from each row to the next.
    std::vector<double> held(std::span<const double> x) const {
        std::vector<double> out(samples_);
        std::size_t i = 0;
        for (std::size_t k = 0; k < samples_; ++k) {
            const auto begin = static_cast<double>(k);
            while (i + 1 < at_.size() && at_[i + 1] <= begin + tiny) ++i;
            if (on_row(k, i) && (i + 1 == at_.size() || at_[i + 1] >= begin + 1 - tiny)) {
                out[k] = x[i];
                continue;
            }
            double sum = 0, from = begin;
            for (std::size_t j = i; from < begin + 1; ++j) {
                const double to = j + 1 < at_.size() ? std::min(begin + 1, at_[j + 1]) : begin + 1;
                sum += (to - from) * x[j];
                from = to;
            }
            out[k] = sum;
        }
        return out;
    }
    /// rms of what the curvature adds to a straight line between the rows, at the samples: no less than the
    /// error of the cubic.
    double interpolation_error(std::span<const double> x, std::span<const unsigned char> bad = {}) const {
        const auto rows = good_rows(bad);
        double sum = 0;
        std::size_t count = 0;
        each_sample(rows, [&](std::size_t k, std::size_t i) {
            if (on_row(k, rows[i]) || i + 1 == rows.size() || !whole(rows, i)) return;
            const double d =
                between(x, rows, i, static_cast<double>(k)) - line(x, rows, i, static_cast<double>(k));
            sum += d * d;
            ++count;
        });
        return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
    }

private:
    static constexpr double tiny = 1e-6; ///< of a sample: no stamp is that exact

    bool on_row(std::size_t k, std::size_t row) const {
        return std::abs(at_[row] - static_cast<double>(k)) <= tiny;
    }
    std::vector<std::size_t> good_rows(std::span<const unsigned char> bad) const {
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < at_.size(); ++i)
            if (bad.empty() || !bad[i] || i == 0) out.push_back(i);
        return out;
    }
    /// Calls use(sample, i): rows[i] is the last good row that is not behind the sample.
    template <class Use> void each_sample(const std::vector<std::size_t>& rows, Use use) const {
        std::size_t i = 0;
        for (std::size_t k = 0; k < samples_; ++k) {
            while (i + 1 < rows.size() && at_[rows[i + 1]] <= static_cast<double>(k) + tiny) ++i;
            use(k, i);
        }
    }
    /// No row is missing or bad between two good ones.
    bool whole(const std::vector<std::size_t>& rows, std::size_t i) const {
        return rows[i + 1] == rows[i] + 1 && !after_gap_[rows[i + 1]];
    }
    double line(std::span<const double> x, const std::vector<std::size_t>& rows, std::size_t i,
                double where) const {
        const std::size_t a = rows[i], b = rows[i + 1];
        return x[a] + (x[b] - x[a]) * (where - at_[a]) / (at_[b] - at_[a]);
    }
    double between(std::span<const double> x, const std::vector<std::size_t>& rows, std::size_t i,
                   double where) const {
        if (rows.size() < 4 || after_gap_[rows[i + 1]]) return line(x, rows, i, where);
        const std::size_t first = std::min(i > 0 ? i - 1 : 0, rows.size() - 4);
        for (std::size_t j = 1; j < 4; ++j)
            if (after_gap_[rows[first + j]]) return line(x, rows, i, where);
        const auto of = [&](std::size_t j) { return rows[first + j]; };
        return cubic_through({at_[of(0)], at_[of(1)], at_[of(2)], at_[of(3)]},
                             {x[of(0)], x[of(1)], x[of(2)], x[of(3)]}, where);
    }

    std::vector<double> at_;
    std::vector<unsigned char> after_gap_;
    std::size_t samples_;
};

} // namespace quadrant::inline v0::diagnosis::detail
