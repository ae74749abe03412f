// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

/// What the suspects of a drive with loops of its own share.
namespace quadrant::inline v0::diagnosis::detail {

/// A number that is freed between a quarter and four times its value, from the best of several ratios: where
/// friction holds a model that is driven too weakly, no slope leads out.
inline parameter freed_from_the_best(const screening& s, const char* key, double& (*of)(plant_model&)) {
    plant_model leader = s.leader;
    const double value = of(leader);
    parameter out = freed(key, of, value);
    out.start =
        best_start(s, of, {value, 0.3 * value, 0.5 * value, 0.7 * value, 1.4 * value, 2 * value, 3.3 * value});
    return out;
}

/// One start that frees a number of the drive between a quarter and four times its value; none where the drive
/// has no such number.
inline void free_if_there(std::vector<std::vector<parameter>>& starts, const screening& s, const char* key,
                          double& (*of)(plant_model&)) {
    plant_model leader = s.leader;
    const double value = of(leader);
    if (value > 0 && std::isfinite(value)) starts.push_back({freed_from_the_best(s, key, of)});
}

/// The largest of what the drive gives, in the unit of its law: duty of a position servo, else force.
inline double most_given(const screening& s) {
    const driven_motion* drive = s.record.observer.drive;
    if (!drive) return 0;
    double most = 0;
    for (double u : drive->tapped() ? drive->measured : drive->given(s.leader.drive))
        most = std::max(most, std::abs(u));
    return most;
}

/// The largest force that the measured motion needs of this machine [N]: about what a drive at its limit gave,
/// whatever its law asks for.
inline double most_taken(const screening& s) {
    const plant_model& p = s.leader;
    double most = 0;
    for (std::size_t k = 0; k < s.record.velocity.size(); ++k)
        most = std::max(most, std::abs(p.moving_mass() * s.record.acceleration[k] +
                                       p.friction.viscous_slope * s.record.velocity[k]));
    return most + p.friction.coulomb + p.friction.excess;
}

/// Of these numbers the one that a model has farthest from the described one, by ratio.
inline std::vector<key_value> farthest(const plant_model& p,
                                       std::span<const std::pair<const char*, double drive_model::*>> keys) {
    std::vector<key_value> out;
    double most = -1;
    for (const auto& [key, of] : keys) {
        const double now = p.drive.*of, was = p.drive_as_described.*of;
        if (!(now > 0) || !(was > 0) || !std::isfinite(now)) continue;
        const double ratio = std::abs(std::log(now / was));
        if (ratio <= most) continue;
        most = ratio;
        out = {{key, {now}}};
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
