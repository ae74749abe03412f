// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/effect_list.hpp"

namespace quadrant::inline v0::diagnosis {

/// What to do about an effect that no feedforward of the reference pays, with the numbers of the corrected
/// plant `p` where the effect has such words, else its remedy; empty: a feedforward pays it.
inline std::string advice_on(std::string_view effect, const plant_model& p, double resolution,
                             std::string_view unit) {
    const auto* known = effect_named(effect);
    if (!known || !known->compensation.empty()) return {};
    return known->advice ? known->advice(p, resolution, unit) : std::string(known->remedy);
}

} // namespace quadrant::inline v0::diagnosis
