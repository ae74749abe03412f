// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/signal.hpp"

#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>

namespace quadrant::inline v0 {

/// Refuses a corner that is too slow for the number type: below, a period takes less than eight units in the
/// last place off a state, and the decay is lost in rounding. `damping` below 1 makes the decay of a section of
/// second order that much slower.
template <class Real, class Number, class Isa = isa::here>
void require_held(const detail::field_name& field, const quantity<hertz_unit, Number>& corner, duration period,
                  const Number& damping = Number(1)) {
    using plain = std::conditional_t<std::same_as<Real, float>, float, double>;
    constexpr double least = 8 * double(std::numeric_limits<plain>::epsilon()) / std::numbers::pi;
    for (std::size_t i = 0; i < lane_count<Real>; ++i) {
        const double k = detail::plain(lane(damping, i)), smallest = k < 1 ? least / k : least;
        require(detail::plain(lane(corner, i)) * period.value() >= smallest, field, lane(corner, i),
                "must be at least " + detail::shortest(smallest) +
                    " of the sampling rate in this number type (" +
                    detail::shortest(detail::in_unit(smallest / period.value(), " Hz")) + ")");
    }
}

} // namespace quadrant::inline v0
