// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "foreign_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Tells something of file i.
using tell_of_file = std::function<void(std::size_t, const std::string&)>;

/// The columns of other programs' files as the text of one log of ours.
class own_text {
public:
    own_text(const std::vector<foreign_table>& tables, bool resampled, tell_of_file tell)
        : tables_(tables), resampled_(resampled), tell_(std::move(tell)) {}

    /// Names of the columns.
    void head() {
        text_ = "t_s";
        for (std::size_t i = 0; i < tables_.size(); ++i)
            for (const auto& c : tables_[i].columns) {
                text_ += ',' + c.name;
                const auto [d, exact] = decimals(c);
                digits_.push_back(d);
                if (!exact && c.step() > 0 && d < most_decimals) // 15 digits are no rounding to speak of
                    tell_(i, fmt::format("{} is written with {} decimals; its own rounding is {:.3g}", c.name,
                                         d, c.step()));
            }
        text_ += '\n';
    }
    void row(double t, const std::vector<double>& row) {
        text_ += fmt::format("{:.9f}", t);
        for (std::size_t i = 0; i < row.size(); ++i) text_ += fmt::format(",{:.{}f}", row[i], digits_[i]);
        text_ += '\n';
    }
    std::string take() { return std::move(text_); }

private:
    static constexpr int most_decimals = 15;

    /// Digits behind the point that a column needs; no more than it had, where its factor is a power of ten, so
    /// that its rounding is still seen. What was resampled has digits of its own. Values that are set and stay,
    /// as the steps of a command, were not rounded, and keep the digits that they had.
    std::pair<int, bool> decimals(const foreign_column& c) const {
        const double step = c.written.step() > 0 ? c.written.step() : c.written.last_digit(),
                     power = -std::log10(step * std::abs(c.factor));
        const bool exact = !resampled_ && std::abs(power - std::round(power)) < 1e-9;
        constexpr int guard = 3;
        const double digits = exact ? std::round(power) : std::ceil(power) + guard; // of a step of 0: infinite
        return {static_cast<int>(std::clamp(digits, 0.0, double{most_decimals})), exact};
    }

    const std::vector<foreign_table>& tables_;
    bool resampled_;
    tell_of_file tell_;
    std::vector<int> digits_{};
    std::string text_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
