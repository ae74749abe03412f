// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"

#include <algorithm>
#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// A plant that does the same by shorter periods, where only every n-th harmonic of one of a model's waves
/// matters (repeats_in_its_period); the periods of the model are then searched there. Nothing: no wave is like
/// that, or the machine file has its period.
inline std::optional<plant_model> by_shortest_periods(candidate& c) {
    plant_model shorter = c.fit.plant;
    const auto waves = c.fit.plant.waves(), there = shorter.waves();
    bool any = false;
    for (std::size_t w = 0; w < waves.size(); ++w) {
        const harmonics& own = *waves[w];
        const std::size_t n = own.count > 0 ? repeats_in_its_period(own.sizes()) : 1;
        const auto period = std::find_if(c.fit.parameters.begin(), c.fit.parameters.end(),
                                         [&](const parameter& p) { return &p.of(c.fit.plant) == &own.period; });
        if (n == 1 || period == c.fit.parameters.end() || period->spread > 0) continue;
        for (double* end : {&period->low, &period->high}) *end /= static_cast<double>(n);
        *there[w] = own.in_lowest_terms(n);
        any = true;
    }
    return any ? std::optional(shorter) : std::nullopt;
}

} // namespace quadrant::inline v0::diagnosis::detail
