// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::diagnosis::detail {
inline harmonics& cogging_harmonics(plant_model& p) { return p.cogging; }
} // namespace quadrant::diagnosis::detail

namespace quadrant::diagnosis::suspect {

/// Force periodic in position: sum of N_i sin(2 pi i x / period + phase_i), the magnets' pitch of a motor or one turn
/// of a screw. Joins the force. Shows as a residual that repeats with position whatever the speed; as a motion it
/// fades with the square of the speed, which tells it from an encoder's cyclic error. Periods up to half the travel:
/// a longer one is a slope or an offset by another name.
inline constexpr effect cogging{
    .name = "cogging",
    .box = "mechanics",
    .exciting_motion = "slow strokes in both directions over several periods",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double travel = detail::travel(s);
        std::vector<std::vector<parameter>> out;
        for (double period : spatial_peaks(s.residual, s.record.position, 0.5 * travel,
                                           std::max(travel / 400, 2e-4), 2, s.record.score.skip))
            out.push_back(detail::repeating<detail::cogging_harmonics, 3>(
                "cogging_period_m", "cogging_N", period, travel, 2 * s.leader.force_constant));
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"cogging_period_m", {p.cogging.period}},
                {"cogging_N", p.cogging.sizes()},
                {"cogging_phase_rad", p.cogging.phases()}};
    },
    .join = [](plant_model& p) { p.cogging.count = 3; }};

} // namespace quadrant::diagnosis::suspect
