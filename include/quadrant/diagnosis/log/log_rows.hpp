// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "even_rows.hpp"

#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// A step of the stamps may be this share of the period off, if the log is resampled (docs/formats.md).
inline constexpr double most_spread = 0.5 + 0.01;

/// The rows of a log and the even clock that its columns are put on. Where every row stands on the clock and
/// none is missing the columns stay as they are.
class log_rows {
public:
    /// Stamps of all rows, the rows to keep, and the last digit of the stamps [s].
    log_rows(std::span<const double> stamps, std::vector<std::size_t> kept, double written)
        : kept_(std::move(kept)), doubled_(stamps.size() - kept_.size()), t_(taken(stamps)),
          clock_(clock_of_rows(t_, written)) {
        if (clock_.even && clock_.gaps == 0) return;
        std::vector<double> at(t_.size());
        for (std::size_t k = 1; k < t_.size(); ++k) // a long pause is as short as its slots
            at[k] = clock_.even           ? static_cast<double>(clock_.slot[k])
                    : clock_.after_gap[k] ? at[k - 1] + static_cast<double>(clock_.slot[k] - clock_.slot[k - 1])
                                          : at[k - 1] + (t_[k] - t_[k - 1]) / clock_.period;
        const auto samples = static_cast<std::size_t>(std::floor(at.back() + 1e-6)) + 1;
        rows_.emplace(std::move(at), clock_.after_gap, samples);
    }

    const row_clock& clock() const { return clock_; }
    std::size_t samples() const { return rows_ ? rows_->samples() : kept_.size(); }
    /// The row of the file behind the k-th that is kept.
    std::size_t row(std::size_t k) const { return kept_[k]; }

    /// Of each row of the file, whether rows are missing before it.
    std::vector<unsigned char> after_gap() const {
        std::vector<unsigned char> out(kept_.size() + doubled_, 0);
        for (std::size_t k = 0; k < kept_.size(); ++k) out[kept_[k]] = clock_.after_gap[k];
        return out;
    }

    /// What to report of the clock.
    std::vector<std::string> notes() const {
        std::vector<std::string> out;
        if (doubled_ > 0)
            out.push_back(fmt::format("{} rows have the stamp of the row before and are dropped", doubled_));
        if (clock_.gaps > 0)
            out.push_back(fmt::format(
                "{} rows are missing in {} places, {:.3g} s at most: the record is read as {} pieces",
                clock_.missing, clock_.gaps, clock_.longest_gap, clock_.gaps + 1));
        if (!clock_.even)
            out.push_back(
                fmt::format("the stamps jitter by up to {:.2g} % of the sample period from step to step: "
                            "resampled onto an even clock; the controller cannot be replayed",
                            100 * clock_.spread));
        else if (clock_.jitter > 1e-3)
            out.push_back(
                fmt::format("the stamps jitter by up to {:.2g} % of the sample period", 100 * clock_.jitter));
        return out;
    }

    /// Wrong readings among the values of all rows of the file.
    wrong_readings check(std::span<const double> x, double count) const {
        return reading_check(t_, taken(x), count).take();
    }
    std::vector<double> smooth(std::span<const double> x, std::span<const unsigned char> bad = {}) const {
        auto values = taken(x);
        if (rows_) return rows_->smooth(values, bad);
        if (std::none_of(bad.begin(), bad.end(), [](auto b) { return b != 0; })) return values;
        return as_they_stand().smooth(values, bad);
    }
    std::vector<double> held(std::span<const double> x) const {
        const auto values = taken(x);
        return rows_ ? rows_->held(values) : values;
    }
    /// Of each sample: 1 where there is no good reading.
    std::vector<unsigned char> left_out(std::span<const unsigned char> bad) const {
        if (rows_) return rows_->left_out(bad);
        return {bad.begin(), bad.end()};
    }

private:
    std::vector<double> taken(std::span<const double> x) const {
        std::vector<double> out;
        out.reserve(kept_.size());
        for (const std::size_t k : kept_) out.push_back(x[k]);
        return out;
    }
    even_rows as_they_stand() const {
        std::vector<double> at(kept_.size());
        for (std::size_t k = 0; k < at.size(); ++k) at[k] = static_cast<double>(k);
        return even_rows(std::move(at), std::vector<unsigned char>(kept_.size(), 0), kept_.size());
    }

    std::vector<std::size_t> kept_;
    std::size_t doubled_;
    std::vector<double> t_;
    row_clock clock_;
    std::optional<even_rows> rows_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
