// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// The cells of one CSV line (RFC 4180), blanks around them dropped. A quoted cell may hold commas and doubled
/// quotes, no line break.
class csv_cells {
public:
    explicit csv_cells(std::string_view line) : line_(line) {}

    bool next() {
        if (at_ > line_.size()) return false;
        begin_ = skip_blanks(at_);
        const bool in_quotes = begin_ < line_.size() && line_[begin_] == '"';
        if (in_quotes)
            take_quoted();
        else
            take_plain();
        return true;
    }

    std::string_view text() const { return cell_; }
    std::size_t offset() const { return begin_; } ///< of the cell in the line
    bool broken() const { return broken_; }       ///< a quote without its partner, or text after it

private:
    std::size_t skip_blanks(std::size_t from) const {
        return std::min(line_.find_first_not_of(" \t", from), line_.size());
    }

    void take_plain() {
        const std::size_t end = std::min(line_.find(',', begin_), line_.size());
        cell_ = line_.substr(begin_, end - begin_);
        cell_ = cell_.substr(0, cell_.find_last_not_of(" \t") + 1);
        at_ = end + 1;
    }

    void take_quoted() {
        std::size_t close = line_.find('"', begin_ + 1);
        while (close != line_.npos && close + 1 < line_.size() && line_[close + 1] == '"')
            close = line_.find('"', close + 2);
        broken_ = close == line_.npos;
        if (broken_) return;
        cell_ = line_.substr(begin_ + 1, close - begin_ - 1);
        const std::size_t end = skip_blanks(close + 1);
        broken_ = end < line_.size() && line_[end] != ',';
        at_ = end + 1;
    }

    std::string_view line_, cell_;
    std::size_t at_ = 0, begin_ = 0;
    bool broken_ = false;
};

} // namespace quadrant::inline v0::diagnosis::detail
