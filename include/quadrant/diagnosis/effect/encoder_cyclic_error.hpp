// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "repeating.hpp"

namespace quadrant::diagnosis::detail {
inline harmonics& encoder_cyclic_error_harmonics(plant_model& p) { return p.cyclic; }
} // namespace quadrant::diagnosis::detail

namespace quadrant::diagnosis::suspect {

/// Reading = x + cyclic sin(2 pi x / period + phase): the interpolation error of an encoder, or an eccentric scale. Joins the
/// measurement. Keeps its size in position at every speed, so that as a force it grows with the square of the speed; a
/// periodic force does the reverse.
inline constexpr effect encoder_cyclic_error{
    .name = "encoder_cyclic_error",
    .box = "sensor",
    .exciting_motion = "the same stroke slowly and fast, over several periods",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const double travel = detail::travel(s);
        std::vector<double> innovation;
        s.record.observer.run(s.leader, innovation);
        std::vector<std::vector<parameter>> out;
        // Coarse and fine periods apart: at constant speed the rows themselves are a grating, and alias one into the other.
        const double shortest = std::max(8 * s.record.resolution, travel / 1e5);
        for (double longest = 0.5 * travel; longest > shortest; longest /= 20)
            for (double period : spatial_peaks(innovation, s.record.position, longest,
                                               std::max(shortest, longest / 20), 1, s.record.score.skip))
                out.push_back(detail::repeating<detail::encoder_cyclic_error_harmonics, 1>(
                    "encoder.cyclic_period_m", "encoder.cyclic_m", period, travel,
                    std::min(5e-4 * travel, 0.1 * period)));
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"encoder.cyclic_m", p.cyclic.sizes()},
                {"encoder.cyclic_period_m", {p.cyclic.period}},
                {"encoder.cyclic_phase_rad", p.cyclic.phases()}};
    },
    .join = [](plant_model& p, const screening&) { p.cyclic.count = 1; }};

} // namespace quadrant::diagnosis::suspect
