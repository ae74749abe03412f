// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "circle_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace quadrant::inline v0::analysis {

/// A place in the plane of two axes.
struct plane_position {
    displacement x{}, y{};
};

/// How far a place is from a path. Sign: positive to the left of the direction of travel; on a circle that is
/// driven counterclockwise to the inside.
struct contour_deviation {
    displacement error;     ///< signed distance to the nearest place of the path
    displacement travelled; ///< of that place, along the path from its start
};

/// Straight path, no ends.
struct line_path {
    plane_position from, to; ///< not the same
    contour_deviation operator()(plane_position at) const {
        const auto dx = to.x - from.x, dy = to.y - from.y;
        const auto length = displacement::from_value(std::hypot(dx.value(), dy.value()));
        require_positive("line_path.length", length);
        return {(dx * (at.y - from.y) - dy * (at.x - from.x)) / length,
                (dx * (at.x - from.x) + dy * (at.y - from.y)) / length};
    }
};

/// Full circle; travelled from angle 0 on, in the direction of travel, within one turn.
struct circle_path {
    circle nominal; ///< radius > 0
    bool counterclockwise = true;
    contour_deviation operator()(plane_position at) const {
        require_positive("circle_path.radius", nominal.radius);
        const double dx = (at.x - nominal.x).value(), dy = (at.y - nominal.y).value(),
                     way = counterclockwise ? 1 : -1;
        double angle = way * std::atan2(dy, dx);
        if (angle < 0) angle += 2 * std::numbers::pi;
        return {way * (nominal.radius - displacement::from_value(std::hypot(dx, dy))), angle * nominal.radius};
    }
};

/// Any path, as places along it; straight between them, so on a curve of radius R sampled every s its error is
/// within s^2/(8 R) of that to the curve.
/// operator() follows: it looks within `window` along the path to either side of where the last sample was
/// nearest (so at a crossing it stays on its branch), the first time along all of it, and again when the end of
/// the window or of the path is nearest (a closed path may be driven on). Beyond an end: the distance to the
/// end.
/// State: where it was; `reset` forgets. Cost: the segments in the window; allocates at construction only.
/// Throws for fewer than two places, two neighbours at the same place, what is not finite, window not above 0.
class sampled_path {
public:
    sampled_path(std::vector<plane_position> places, displacement window)
        : places_(std::move(places)), window_(window) {
        require(places_.size() >= 2, "sampled_path.places", double(places_.size()), "must be two or more");
        require_positive("sampled_path.window", window);
        travelled_.push_back({});
        for (std::size_t i = 1; i < places_.size(); ++i) {
            const double length = std::hypot((places_[i].x - places_[i - 1].x).value(),
                                             (places_[i].y - places_[i - 1].y).value());
            require(std::isfinite(length) && length > 0, "sampled_path.places", double(i),
                    "must be finite and differ from the place before it");
            travelled_.push_back(travelled_.back() + displacement::from_value(length));
        }
    }

    contour_deviation operator()(plane_position at) noexcept {
        std::size_t first = 0, last = places_.size() - 2; // segments
        if (known_) {
            const auto segment = [&](displacement where) {
                const auto after = std::upper_bound(travelled_.begin() + 1, travelled_.end() - 1, where);
                return std::size_t(after - travelled_.begin()) - 1;
            };
            first = segment(travelled_[nearest_] - window_), last = segment(travelled_[nearest_ + 1] + window_);
        }
        found best = search(at, first, last);
        const bool ahead = best.segment == last && best.share >= 1,
                   behind = best.segment == first && best.share <= 0;
        if (ahead || behind) best = search(at, 0, places_.size() - 2);
        if (!(best.distance < HUGE_VAL)) return {displacement::from_value(best.distance), {}}; // not finite
        nearest_ = best.segment, known_ = true;
        return {displacement::from_value(best.left ? best.distance : -best.distance),
                travelled_[best.segment] +
                    best.share * (travelled_[best.segment + 1] - travelled_[best.segment])};
    }
    void reset() noexcept { known_ = false; }
    displacement length() const noexcept { return travelled_.back(); }

private:
    struct found {
        double distance = HUGE_VAL;
        std::size_t segment = 0;
        double share = 0; ///< of the segment, 0 ... 1
        bool left = true;
    };
    found search(plane_position at, std::size_t first, std::size_t last) const noexcept {
        found best;
        for (std::size_t i = first; i <= last; ++i) {
            const double dx = (places_[i + 1].x - places_[i].x).value(),
                         dy = (places_[i + 1].y - places_[i].y).value();
            const double x = (at.x - places_[i].x).value(), y = (at.y - places_[i].y).value();
            const double share = std::clamp((dx * x + dy * y) / (dx * dx + dy * dy), 0.0, 1.0);
            const double distance = std::hypot(x - share * dx, y - share * dy);
            if (distance < best.distance) best = {distance, i, share, dx * y - dy * x >= 0};
        }
        const std::size_t corner = best.segment + (best.share >= 1);
        if ((best.share >= 1 || best.share <= 0) && corner > 0 && corner + 1 < places_.size()) {
            // Outside of a corner, which may be on either side of one of its legs: the side that it does not
            // turn to.
            const double ax = (places_[corner].x - places_[corner - 1].x).value(),
                         ay = (places_[corner].y - places_[corner - 1].y).value(),
                         bx = (places_[corner + 1].x - places_[corner].x).value(),
                         by = (places_[corner + 1].y - places_[corner].y).value();
            const double turn = ax * by - ay * bx;
            if (std::abs(turn) > 1e-9 * std::hypot(ax, ay) * std::hypot(bx, by)) best.left = turn < 0;
        }
        return best;
    }

    std::vector<plane_position> places_;
    std::vector<displacement> travelled_;
    displacement window_;
    std::size_t nearest_ = 0;
    bool known_ = false;
};

/// What a controller estimates in each period from the tracking error and the direction of travel, as
/// cross-coupled
/// control does: the component of (measured - reference) to the left of the motion; with the radius of the path
/// there (positive: it turns left) the distance to the circle of curvature instead.
///   line: n.d,   circle: (|d - R n| - |R|) with the sign that makes it n.d for large R
/// Bound: with a tracking error t along the path the line is off by t^2/(2|R|), to third order in t/R; the
/// circle by how much the radius changes along t. At rest there is no direction: none.
/// Source: [Koren1980] for the line; the circle of curvature is the usual correction.
inline std::optional<displacement> estimated_contour_error(plane_position reference, plane_position measured,
                                                           quantity_of<signal::velocity> vx,
                                                           quantity_of<signal::velocity> vy,
                                                           std::optional<displacement> radius = {}) noexcept {
    const double speed = std::hypot(vx.value(), vy.value());
    if (!(speed > 0)) return {};
    const double tx = vx.value() / speed, ty = vy.value() / speed;
    const double dx = (measured.x - reference.x).value(), dy = (measured.y - reference.y).value();
    const double across = tx * dy - ty * dx, along = tx * dx + ty * dy;
    if (!radius) return displacement::from_value(across);
    const double R = radius->value(), away = R > 0 ? 1 : -1;
    return displacement::from_value(R - away * std::hypot(along, across - R));
}

/// Contour error of a whole log, sample by sample, along any of these paths.
template <class Path>
std::vector<displacement> contour_errors(Path path, const std::vector<displacement>& x,
                                         const std::vector<displacement>& y) {
    require(x.size() == y.size(), "contour_errors.x", double(x.size()),
            "must hold as many samples as y (" + quadrant::detail::shortest(double(y.size())) + ")");
    std::vector<displacement> out;
    out.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        require(std::isfinite(x[i].value()) && std::isfinite(y[i].value()), "contour_errors.sample", double(i),
                "must be finite");
        out.push_back(path(plane_position{x[i], y[i]}).error);
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
