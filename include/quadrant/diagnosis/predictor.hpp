// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "plant_model.hpp"

#include <span>
#include <vector>

namespace quadrant::diagnosis {

/// The plant inside an observer: driven by the logged command, corrected by the logged position, judged by what the
/// correction had to be. One pass, no drift of the double integrator, and a right model leaves only the encoder's
/// rounding: the innovation
///   e[k] = y[k] - x(t_k);  x += L1 e, v += L2 e;  then one period of the plant
/// with both observer poles at exp(-2 pi corner T): L1 = 1 - z^2, L2 = (1 - z)^2 / T [Franklin1998] ch. 8.
/// A constant force error d shows as e = d / (M (2 pi corner)^2) about.
struct predictor {
    double period;         ///< T [s]
    double corner_Hz = 60; ///< lower: more sensitive to slow forces; higher: friction's sign is surer at creep
    std::span<const double> position, command;

    /// The command row that acts `back` rows ago; before the log: its first row.
    double past(std::size_t k, std::size_t back) const { return command[k >= back ? k - back : 0]; }

    /// Innovations; when `acceleration` is given, also the model's mean acceleration over each period [m/s^2].
    void run(const plant_model& plant, std::vector<double>& innovation,
             std::vector<double>* acceleration = nullptr) const {
        const double z = std::exp(-2 * std::numbers::pi * corner_Hz * period);
        const double l1 = 1 - z * z, l2 = (1 - z) * (1 - z) / period;
        const auto whole = static_cast<std::size_t>(std::max(0.0, plant.delay) / period);
        const double first =
            std::max(0.0, plant.delay) - static_cast<double>(whole) * period; // the older command's part
        const plant_model::stepper older(plant, first > 0 ? first : period), newer(plant, period - first);
        innovation.resize(position.size());
        if (acceleration) acceleration->resize(position.size());
        plant_model::state s{.x = position[0], .v = 0};
        for (std::size_t k = 0; k < position.size(); ++k) {
            const double e = position[k] - s.x;
            innovation[k] = e;
            s.x += l1 * e;
            s.v += l2 * e;
            const double before = s.v;
            if (first > 0) older(s, past(k, whole + 1));
            newer(s, past(k, whole));
            if (acceleration) (*acceleration)[k] = (s.v - before) / period;
        }
    }
};

} // namespace quadrant::diagnosis
