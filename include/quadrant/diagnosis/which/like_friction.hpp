// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "axis_case.hpp"

#include <map>
#include <tuple>

namespace quadrant::inline v0::diagnosis::detail {

/// A force without what a law of friction could hold: without its mean wherever the axis moves in one direction
/// with one speed, one way after it turned, and while that speed grows or falls. Speeds and ways are taken
/// together by octaves. Of rows at rest nothing is left: friction takes any force there.
inline std::vector<double> beside_friction(const axis_record& r, std::vector<double> force) {
    struct sum {
        double rows = 0, force = 0;
    };
    std::map<std::tuple<bool, bool, int, int>, sum> alike;
    std::vector<sum*> of_row(force.size(), nullptr);
    const double rest = 0.01 * r.scale.speed, nearest = std::max(r.resolution, 1e-4 * r.scale.travel);
    double turned = r.position.empty() ? 0 : r.position[0];
    bool forward = true;
    for (std::size_t k = r.score.skip; k < force.size(); ++k) {
        const double v = r.velocity[k];
        if (std::abs(v) < rest || (!r.left_out.empty() && r.left_out[k])) continue;
        if ((v > 0) != forward) {
            forward = v > 0;
            turned = r.position[k];
        }
        const double way = std::max(std::abs(r.position[k] - turned), nearest);
        const bool faster = r.acceleration[k] * v > 0;
        of_row[k] = &alike[{forward, faster, std::ilogb(std::abs(v) / rest), std::ilogb(way / nearest)}];
        ++of_row[k]->rows;
        of_row[k]->force += force[k];
    }
    for (std::size_t k = 0; k < force.size(); ++k)
        force[k] = of_row[k] ? force[k] - of_row[k]->force / of_row[k]->rows : 0;
    return force;
}

} // namespace quadrant::inline v0::diagnosis::detail
