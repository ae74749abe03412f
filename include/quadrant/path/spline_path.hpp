// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "spline.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace quadrant::inline v0::path {

/// Which polynomial joins two places.
enum class spline_degree {
    quintic, ///< tangent and curvature are the same on both sides of a place
    cubic    ///< the tangent is; the curvature may jump
};

/// A smooth path through a run of places that come one after the other; what is known of it leaves again at
/// once, so that a run may be as long as it likes. At each place, tangent and curvature are those of the
/// quartic over the chord length through the five places around it (the first or last five near an end; fewer
/// in a shorter run). Each piece is nearly parametrised by its length and cut in halves until the feed is off
/// by no more than `feed_tolerance`.
/// Source: [Erkorkmaz2005], [Wang1999]; see spline.hpp. The local estimate of the knots is a choice of ours: a
/// spline over the whole run would have to be in memory.
/// Throws invalid_parameter for two neighbours less than 1 nm apart, and where the run turns back. Allocates.
class spline_path {
public:
    static constexpr double feed_tolerance = 1e-4; ///< share

    /// One polynomial of the path, and which of the places it leads to.
    struct piece {
        spline curve;
        std::size_t knot; ///< the piece is part of the way to this place; 0 is the first of the run
        bool last;        ///< it ends there
    };

    explicit spline_path(spline_degree degree) : degree_(degree) {}

    void add(point place) { ///< [m]
        require(finite(place), "spline_path.place", double(count_), "must be finite");
        if (count_ > 0) {
            const double chord = distance(window_.back().place, place);
            require(chord > same_place, "spline_path.place", double(count_),
                    "must not coincide with the place before it");
            window_.push_back({place, window_.back().travelled + chord});
        } else {
            window_.push_back({place, 0});
        }
        ++count_;
        if (count_ == around) join(0), join(1); // and place 2 below
        if (count_ >= around) join(count_ - 3);
    }
    /// No place comes any more: the rest of the pieces. Fewer than two places: none.
    void finish() {
        for (std::size_t i = joined_; count_ >= 2 && i < count_; ++i) join(i);
    }
    std::optional<piece> next() {
        if (ready_.empty()) return {};
        const piece first = ready_.front();
        ready_.pop_front();
        return first;
    }
    std::size_t count() const noexcept { return count_; } ///< places so far
    /// Places that the pieces so far lead to; after a throw the place where the run turns back.
    std::size_t joined() const noexcept { return joined_; }

private:
    static constexpr std::size_t around = 5;
    struct visited {
        point place;
        double travelled; ///< along the chords [m]
    };

    /// The polynomial through the window (Newton's form), its first two derivatives at place i.
    spline_knot knot(std::size_t i) const {
        const std::size_t n = window_.size();
        std::array<point, around> c{};
        for (std::size_t k = 0; k < n; ++k) c[k] = window_[k].place;
        for (std::size_t order = 1; order < n; ++order)
            for (std::size_t k = n - 1; k >= order; --k)
                c[k] = (c[k] - c[k - 1]) / (window_[k].travelled - window_[k - order].travelled);
        const visited& at = window_[i - (count_ - n)];
        point value = c[n - 1], first, second;
        for (std::size_t k = n - 1; k-- > 0;) {
            const double t = at.travelled - window_[k].travelled;
            second = t * second + 2.0 * first;
            first = t * first + value;
            value = t * value + c[k];
        }
        const double speed = magnitude(first);
        require(speed > 1e-2, "spline_path.place", double(i), "must not be where the run turns back");
        const point tangent = first / speed;
        return {at.place, tangent, (second - dot(second, tangent) * tangent) / (speed * speed)};
    }
    /// The path from the place before to place i.
    void join(std::size_t i) {
        while (window_.size() > around) window_.pop_front();
        const spline_knot to = knot(i);
        if (i > 0)
            cut(degree_ == spline_degree::quintic ? spline::quintic(from_, to) : spline::cubic(from_, to), i,
                true, 0);
        from_ = to, joined_ = i + 1;
    }
    void cut(const spline& curve, std::size_t knot, bool last, int depth) {
        if (curve.feed_fluctuation() <= feed_tolerance) return ready_.push_back({curve, knot, last});
        require(depth < 8, "spline_path.place", double(knot), "must not be where the run turns back");
        cut(curve.part(0, 0.5), knot, false, depth + 1);
        cut(curve.part(0.5, 1), knot, last, depth + 1);
    }

    spline_degree degree_;
    std::deque<visited> window_;
    std::deque<piece> ready_;
    std::size_t count_ = 0, joined_ = 0;
    spline_knot from_{};
};

/// The whole path through `places` [m] at once. Throws as spline_path does, and for fewer than two places.
inline std::vector<spline> splines_through(const std::vector<point>& places,
                                           spline_degree degree = spline_degree::quintic) {
    require(places.size() >= 2, "splines_through.places", double(places.size()), "must be two or more");
    spline_path path(degree);
    std::vector<spline> out;
    const auto take = [&] {
        while (const auto piece = path.next()) out.push_back(piece->curve);
    };
    for (const point& place : places) {
        path.add(place);
        take();
    }
    path.finish();
    take();
    return out;
}

} // namespace quadrant::inline v0::path
