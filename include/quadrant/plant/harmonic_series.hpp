// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0::detail {

/// What repeats: sum_{i=1..Harmonics} cosine_i cos(i angle) + sine_i sin(i angle). The one place of this law;
/// forces, ripples, reading errors and processes ask it. Value is a number or a quantity; the first `count`
/// harmonics are summed.
template <std::size_t Harmonics, class Value, class Real> struct harmonic_series {
    std::array<Value, Harmonics> cosine{}, sine{};
    std::size_t count = Harmonics;

    /// From cosine and sine of the first harmonic's angle; the others follow by angle addition.
    Value operator()(const Real& c1, const Real& s1) const noexcept {
        Real c = c1, s = s1;
        Value sum{};
        for (std::size_t i = 0; i < count; ++i) {
            sum += sine[i] * s + cosine[i] * c;
            const Real next = c * c1 - s * s1;
            s = s * c1 + c * s1;
            c = next;
        }
        return sum;
    }
    /// At so many periods; only the part beyond whole periods is turned into an angle, so that far away is as
    /// exact as near.
    Value operator()(const Real& turns) const noexcept {
        using std::cos, std::sin;
        const Real part = turns - whole(turns);
        if constexpr (multi_lane<Real>) { // lanes bring their own; see lanes/turns.hpp
            const auto at = circle_of_turns(part);
            return (*this)(at.cosine, at.sine);
        } else {
            const Real angle = part * Real(2 * std::numbers::pi);
            return (*this)(Real(cos(angle)), Real(sin(angle)));
        }
    }

private:
    static Real whole(const Real& turns) noexcept {
        using std::floor;
        if constexpr (requires { turns.partial; }) // a dual's slope is that of the turns
            return Real(floor(plain(turns)));
        else
            return floor(turns);
    }
};

} // namespace quadrant::inline v0::detail
