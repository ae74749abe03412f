// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <numeric>

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<double> residual_force(const plant_model& plant,
                                                           std::span<const double> position,
                                                           std::span<const double> model_acceleration,
                                                           double period, double bandwidth_Hz,
                                                           std::span<const unsigned char> left_out) {
    const std::size_t n = position.size();
    auto raw = acceleration_of(plant, position, period);
    const double mass = plant.moving_mass();
    for (std::size_t k = 1; k + 1 < n; ++k) raw[k] = mass * (model_acceleration[k] - raw[k]);
    for (std::size_t k = 0; k < left_out.size(); ++k)
        if (left_out[k]) raw[k] = 0;
    return zero_phase(raw, bandwidth_Hz, period);
}

QUADRANT_DIAGNOSIS_DECL force_floors::force_floors(double period, double bandwidth_Hz,
                                                   std::span<const double> reaction) {
    std::vector<double> impulse(reaction.empty() ? 4001 : reaction.size(), 0.0);
    const std::size_t at = impulse.size() / 2;
    impulse[at - 1] = impulse[at + 1] = 1 / (period * period);
    impulse[at] = -2 * impulse[at + 1];
    const auto accelerates = zero_phase(impulse, bandwidth_Hz, period);
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    of_mass = product(accelerates, accelerates);
    if (reaction.empty()) return;
    const auto reacts = zero_phase(std::vector<double>(reaction.begin(), reaction.end()), bandwidth_Hz, period);
    of_both = product(accelerates, reacts);
    of_reaction = product(reacts, reacts);
}

QUADRANT_DIAGNOSIS_DECL double residual_force_floor(double mass, double sigma, double period,
                                                    double bandwidth_Hz, std::span<const double> reaction) {
    return force_floors(period, bandwidth_Hz, reaction)(mass, sigma);
}

} // namespace quadrant::inline v0::diagnosis
