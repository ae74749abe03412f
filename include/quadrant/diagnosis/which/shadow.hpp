// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/cogging.hpp"
#include "../effect/position_dependent_friction.hpp"
#include "axis_case.hpp"

#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::diagnosis::detail {

/// Whether two waves have one period, but for half a line of the spectrum over this travel, and the second one
/// lies a quarter of it aside, as far as either phase is known: in the harmonic that is the first one's
/// largest.
inline bool lies_a_quarter_aside(const harmonics& wave, const harmonics& other, double travel) {
    constexpr double aside = 0.35; // cosine of 70 degrees
    const auto sizes = wave.sizes(), phases = wave.phases(), of_other = other.phases();
    const auto largest = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    return largest < std::min(sizes.size(), of_other.size()) &&
           std::abs(1 / wave.period - 1 / other.period) < 0.5 / travel &&
           std::abs(std::cos(phases[largest] - of_other[largest])) < aside;
}

/// Whether a friction along the travel is the shadow of a cogging: where force and position are late against
/// one another, as behind the filter of a sensor, a cogging leaves its slope along the travel with the sign of
/// the velocity, which is such a friction.
inline bool is_shadow_of_cogging(const axis_case& c, const effect& e) {
    const auto& effects = c.best().effects;
    const plant_model& plant = c.best().fit.plant;
    return &e == &suspect::position_dependent_friction &&
           std::find(effects.begin(), effects.end(), &suspect::cogging) != effects.end() &&
           lies_a_quarter_aside(plant.cogging, plant.friction.along, c.record.scale.travel);
}

} // namespace quadrant::inline v0::diagnosis::detail
