// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/portable.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// Reads the whole of `cell`, whatever the locale. Returns what is wrong with it, or nullptr.
inline const char* parse_number(std::string_view cell, double& value) {
    constexpr double largest = 1e12; // beyond it no SI value of a machine, and squares still far from overflow
    if (cell.empty()) return "is empty";
    if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);
    const auto [end, fault] =
        quadrant::detail::number_from_chars(cell.data(), cell.data() + cell.size(), value);
    if (fault == std::errc::invalid_argument || end != cell.data() + cell.size()) return "is not a number";
    if (fault != std::errc{}) return "is out of range";
    if (!std::isfinite(value)) return "is not finite";
    return std::abs(value) > largest ? "is out of range" : nullptr;
}

/// How finely a column is written, from the text of its cells: the digits say what the numbers cannot.
class written_step {
public:
    void add(std::string_view cell, double value) {
        if (rows_ > 0 && value != last_) ++changes_;
        ++rows_;
        last_ = value;

        int decimals = 0, significant = 0;
        bool after_point = false;
        std::size_t at = 0;
        for (; at < cell.size() && cell[at] != 'e' && cell[at] != 'E'; ++at) {
            if (cell[at] == '.') after_point = true;
            if (cell[at] < '0' || cell[at] > '9') continue;
            decimals += after_point;
            significant += significant > 0 || cell[at] != '0';
        }
        if (!after_point && at == cell.size()) return; // "10" among "9.75": trailing zeros are dropped
        const int digit = exponent(cell.substr(std::min(at + 1, cell.size()))) - decimals;
        finest_ = std::min(finest_, digit);
        if (significant == 0) return;
        const int size = std::clamp(digit + significant - 1, -top, top) + top;
        auto& same_size = decades_[static_cast<std::size_t>(size)];
        same_size.finest = std::min(same_size.finest, digit);
        if (value != same_size.last) ++same_size.changes;
        same_size.last = value;
    }

    /// Decimal unit of the last digit that the column keeps; 0: nothing was rounded. A format of a fixed number
    /// of significant digits (%g, %e) rounds large values more coarsely than small ones: the coarsest counts.
    double step() const {
        constexpr std::size_t seldom = 100, enough = 20;
        if (finest_ == none || changes_ * seldom < rows_) return 0; // set values: whole as they stand
        int coarsest = finest_;
        for (const auto& d : decades_)
            if (d.changes >= enough) coarsest = std::max(coarsest, d.finest);
        return power_of_ten(coarsest);
    }

    /// Decimal unit of the last digit that stands in the column: what writes it again without loss, set values
    /// too. 1: whole numbers.
    double last_digit() const { return finest_ == none ? 1 : power_of_ten(finest_); }

private:
    static constexpr int none = std::numeric_limits<int>::max(), top = 12;

    static int exponent(std::string_view text) {
        if (text.starts_with('+')) text.remove_prefix(1);
        int value = 0;
        std::from_chars(text.data(), text.data() + text.size(), value);
        return std::clamp(value, -400, 400);
    }
    static double power_of_ten(int power) {
        const std::string text = "1e" + std::to_string(power);
        double value = 0; // stays so below the smallest double
        quadrant::detail::number_from_chars(text.data(), text.data() + text.size(), value);
        return value;
    }

    struct decade { ///< cells with the same power of ten in front
        double last = 0;
        int finest = none;
        unsigned changes = 0;
    };
    std::array<decade, 2 * top + 1> decades_{};
    int finest_ = none;
    double last_ = 0;
    std::size_t rows_ = 0, changes_ = 0;
};

} // namespace quadrant::inline v0::diagnosis::detail
