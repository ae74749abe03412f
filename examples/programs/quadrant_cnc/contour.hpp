// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/path/segment.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

/// How far the machine is from the path that the program asks for: the distance to the geometry itself, lines,
/// arcs and splines, not to samples of it.
namespace quadrant_cnc {

using quadrant::path::point;
using quadrant::path::segment;

/// The path length of the place on an arc or a spline that is nearest to `at`; of several, as on a circle
/// driven twice, the one around `guess`.
inline double nearest_on_curve(const segment& path, point at, double guess) noexcept {
    const double length = path.length();
    double s = std::clamp(guess, 0.0, length);
    if (const auto* round = std::get_if<quadrant::path::arc>(&path.shape())) {
        const point c = round->centre(), from = path.position(s);
        const double ux = from.x - c.x, uy = from.y - c.y, vx = at.x - c.x, vy = at.y - c.y;
        const double turned = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
        s = std::clamp(s + turned * length / round->sweep(), 0.0, length);
        if (round->end().z == round->start().z) return s;
    }
    for (int i = 0; i < 8; ++i) { // Newton on the derivative of the squared distance
        const point off = at - path.position(s);
        const double bend = std::max(0.1, 1 - dot(off, path.curvature(s)));
        const double next = std::clamp(s + dot(off, path.tangent(s)) / bend, 0.0, length);
        const bool there = std::abs(next - s) < 1e-12;
        s = next;
        if (there) break;
    }
    return s;
}

/// A place on a piece of path, and how far another place is from it.
struct foot_of {
    double s; ///< along the piece [m]
    point foot;
    double away; ///< [m]
    /// The place nearest to `at`; of several, the one around `guess`.
    [[gnu::always_inline]] foot_of(const segment& path, point at, double guess) noexcept {
        if (const auto* straight = std::get_if<quadrant::path::line>(&path.shape())) {
            s = std::clamp(dot(at - straight->start(), straight->tangent(0)), 0.0, straight->length());
            foot = straight->position(s);
        } else {
            s = nearest_on_curve(path, at, guess);
            foot = path.position(s);
        }
        away = distance(at, foot);
    }
};

/// Walks along the program with the reference and keeps no more of it than lies around it. The distance is that
/// to the stretch of path on both sides of the reference that is twice as long as the table is away from it:
/// where a path crosses itself or comes back, the other branch does not count.
class contour {
public:
    static constexpr std::size_t kept = 512; ///< pieces, those ahead included

    struct deviation {
        point foot;                                                 ///< nearest place of the path [m]
        point off;                                                  ///< from there to where the machine is [m]
        double distance() const noexcept { return magnitude(off); } ///< [m]
    };

    /// The next piece; `line` of the program.
    void add(const segment& path, std::size_t line) {
        if (pieces_.size() < kept)
            pieces_.push_back({path, line});
        else
            pieces_[count_ % kept] = {path, line};
        ++count_;
    }
    /// One period on: the reference is there and went `way` since the last call. Needs a piece.
    void follow(point reference, std::size_t line, double way) noexcept {
        const std::size_t before = here_;
        reference_ = reference;
        while (here_ + 1 < count_ && at(here_).line < line) ++here_, s_ = 0, way = 0;
        foot_of here(at(here_).path, reference, s_ + way);
        while (here_ + 1 < count_ && at(here_ + 1).line <= line &&
               here.s >= at(here_).path.length() * (1 - 1e-9)) {
            const foot_of next(at(here_ + 1).path, reference, 0);
            if (next.away > here.away + 1e-12) break;
            ++here_, here = next;
        }
        s_ = here.s, off_ = here.away;
        passed_ = here_ != before;
    }
    /// Where the reference is on the path [m]; when it has just passed a joint: there, so that a line through
    /// these places cuts no corner.
    point path_place() const noexcept { return passed_ ? at(here_).path.start() : at(here_).path.position(s_); }
    deviation operator()(point place) const noexcept {
        // Further along the path than this only another branch of it can be nearer, which is not the one that
        // is driven.
        const double reach = 2 * (distance(place, reference_) + off_) + 1e-9;
        const segment& here = at(here_).path;
        foot_of best(here, place, s_);
        const auto look_at = [&](const segment& path, double guess) {
            const foot_of other(path, place, guess);
            if (other.away < best.away) best = other;
        };
        double way = s_;
        for (std::size_t i = here_; way < reach && i > 0 && count_ - i < kept; --i) {
            const segment& path = at(i - 1).path;
            look_at(path, path.length());
            way += path.length();
        }
        way = here.length() - s_;
        for (std::size_t i = here_ + 1; way < reach && i < count_; ++i) {
            const segment& path = at(i).path;
            look_at(path, 0);
            way += path.length();
        }
        return {best.foot, place - best.foot};
    }

private:
    struct piece {
        segment path;
        std::size_t line;
    };
    const piece& at(std::size_t i) const noexcept { return pieces_[i % kept]; }

    std::vector<piece> pieces_;
    std::size_t count_ = 0, here_ = 0; ///< of all pieces
    double s_ = 0, off_ = 0;           ///< along the piece; of the reference from it
    point reference_{};
    bool passed_ = false;
};

} // namespace quadrant_cnc
