// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "arc.hpp"
#include "line.hpp"
#include "spline.hpp"

#include <variant>

namespace quadrant::inline v0::path {

/// One smooth piece of a tool path, whatever its shape: all by path length s [m] from its start, held beyond
/// the ends. No call throws or allocates; copying it copies numbers.
class segment {
    template <class Ask> auto each(Ask ask) const noexcept {
        if (const auto* straight = std::get_if<line>(&shape_)) return ask(*straight);
        if (const auto* round = std::get_if<arc>(&shape_)) return ask(*round);
        return ask(*std::get_if<spline>(&shape_));
    }

public:
    using shapes = std::variant<line, arc, spline>;

    segment(const line& of) : shape_(of) {}
    segment(const arc& of) : shape_(of) {}
    segment(const spline& of) : shape_(of) {}

    double length() const noexcept { ///< [m], above 0
        return each([](const auto& of) { return of.length(); });
    }
    point start() const noexcept { ///< [m]
        return each([](const auto& of) { return of.start(); });
    }
    point end() const noexcept { ///< [m]
        return each([](const auto& of) { return of.end(); });
    }
    point position(double s) const noexcept { ///< [m]
        return each([s](const auto& of) { return of.position(s); });
    }
    point tangent(double s) const noexcept { ///< unit vector, dr/ds
        return each([s](const auto& of) { return of.tangent(s); });
    }
    point curvature(double s) const noexcept { ///< vector d^2r/ds^2 [1/m]
        return each([s](const auto& of) { return of.curvature(s); });
    }
    const shapes& shape() const noexcept { return shape_; }

private:
    shapes shape_;
};

} // namespace quadrant::inline v0::path
