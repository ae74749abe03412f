// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"

#include <algorithm>
#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// A plant that does the same by shorter periods, where only every n-th harmonic of one of a model's waves
/// matters (repeats_in_its_period); the periods of the model are then searched there. Nothing: no wave is like
/// that, or the machine file has its period.
inline std::optional<plant_model> in_lowest_terms(candidate& c) {
    plant_model& plant = c.fit.plant;
    plant_model shorter = plant;
    const auto shorten = [&](const harmonics& own, harmonics& there) {
        const std::size_t n = own.count > 0 ? repeats_in_its_period(own.sizes()) : 1;
        const auto period = std::find_if(c.fit.parameters.begin(), c.fit.parameters.end(),
                                         [&](const parameter& p) { return &p.of(plant) == &own.period; });
        if (n == 1 || period == c.fit.parameters.end() || period->spread > 0) return false;
        for (double* end : {&period->low, &period->high}) *end /= static_cast<double>(n);
        there = own.in_lowest_terms(n);
        return true;
    };
    bool any = shorten(plant.ripple, shorter.ripple);
    any |= shorten(plant.cogging, shorter.cogging);
    any |= shorten(plant.cutting, shorter.cutting);
    any |= shorten(plant.cyclic, shorter.cyclic);
    any |= shorten(plant.friction.along, shorter.friction.along);
    return any ? std::optional(shorter) : std::nullopt;
}

} // namespace quadrant::inline v0::diagnosis::detail
