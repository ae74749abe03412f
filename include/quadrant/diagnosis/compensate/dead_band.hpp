// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compensation.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The error that a controller has to ignore so as not to answer the reading of an axis that stands where it
/// was asked to: the reading goes to and fro between two counts and by its noise (three standard deviations),
/// and where the encoder reads behind a play, an integral hunts through half of it. [m]
inline double least_dead_band(double count, double noise, double play) {
    return std::max({count, count / 2 + 3 * noise, play / 2});
}

/// The dead band beside the keys that a controller was given last, which bear most: what it costs in following
/// error is forecast with them. None where the kind of the controller has no such key.
inline std::optional<compensation> with_dead_band(const controller_description& c,
                                                  const std::vector<compensation>& others, double band) {
    const controller_kind& kind = kind_of(c);
    if (kind.dead_band.empty() || !(band > 0)) return std::nullopt;
    compensation out{.name = "dead band"};
    for (const compensation& other : others)
        if (other.by_keys() && !other.keys.empty()) {
            out.name = other.name + ", dead band";
            out.effects = other.effects;
            out.keys = other.keys;
        }
    out.keys.push_back({std::string(kind.dead_band), {band * given_values(kind, c)[kind.length_unit]}});
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
