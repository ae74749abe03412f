// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../fit/record.hpp"
#include "../fit/scales.hpp"
#include "../log/log.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Mean squares that a model leaves, those of a servo's tap beside the noise that the model's own drive makes
/// of the reading there: a gain three times as high as described carries three times as much of it to the tap.
inline std::vector<std::vector<double>> beside_own_noise(std::vector<std::vector<double>> ms,
                                                         const axis_record& r, const axis_log& log,
                                                         const plant_model& plant) {
    const auto& drive = r.observer.drive;
    if (!drive || !drive->tapped() || plant.drive.kind != drive_kind::position_servo) return ms;
    double most = 0;
    for (double u : drive->measured) most = std::max(most, std::abs(u));
    const double step = std::max({log.duty_step, log.effort_step, 1e-12 * most});
    const double own = drive->to_position *
                       duty_noise(drive->run(plant.drive).beside, step, plant.drive.duty_gain, r.resolution),
                 times = own / reading_noise(r.position, r.resolution);
    for (std::size_t i = 0; i < ms.size(); ++i)
        if (r.score.channels[i].of_tap)
            for (double& block : ms[i]) block /= times * times;
    return ms;
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
