// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "program_text.hpp"
#include "spline_path.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace quadrant::inline v0::path::detail {

/// A run of places in a program, as moves that join without a corner. The path to each place has the feed and
/// the line of that place.
class spline_moves {
public:
    spline_moves(spline_degree degree, point start, std::size_t line) : path_(degree) {
        knots_.push_back({line, 0});
        path_.add(start);
    }
    bool goes() const noexcept { return path_.count() > 1; }

    /// `fail(message)` must throw.
    void add(point to, double feed, std::size_t line, waiting_moves& out, auto fail) {
        knots_.push_back({line, feed});
        grow([&] { path_.add(to); }, out, fail);
    }
    void finish(waiting_moves& out, auto fail) {
        grow([&] { path_.finish(); }, out, fail);
    }

private:
    struct knot {
        std::size_t line;
        double feed;
    };
    void grow(auto how, waiting_moves& out, auto fail) {
        try {
            how();
        } catch (const invalid_parameter&) {
            const std::size_t at = std::min(path_.joined() - first_, knots_.size() - 1);
            fail(joined({"the spline turns back at the point of line ", std::to_string(knots_[at].line)}));
        }
        while (const auto piece = path_.next()) {
            for (; first_ < piece->knot; ++first_) knots_.pop_front();
            out.add({.path = piece->curve,
                     .feed = knots_.front().feed,
                     .ending = path_ending::continuous,
                     .line = knots_.front().line});
        }
    }

    spline_path path_;
    std::deque<knot> knots_; ///< those that moves are still to lead to
    std::size_t first_ = 0;
};

} // namespace quadrant::inline v0::path::detail
