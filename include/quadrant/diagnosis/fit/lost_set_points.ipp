// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "lost_set_points.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL lossy_commands predictor::set_points_with_loss(const plant_model& plant,
                                                                       const std::vector<double>& innovation,
                                                                       const loss_assumption& a) const {
    constexpr std::size_t lasting = 64; // rows of a pulse at most
    const std::size_t n = position.size();
    const bool tapped = drive->tapped();
    lossy_commands nothing{.applied = drive->set_point, .probability = a.probability};
    if (n < 4 * lasting) return nothing;
    const auto arrival = detail::arrivals(plant.drive, drive->set_point, period, drive->begins);
    std::vector<double> asked(n);
    for (std::size_t i = 0; i < arrival.size(); ++i)
        std::fill(asked.begin() + static_cast<std::ptrdiff_t>(arrival[i]),
                  i + 1 < arrival.size() ? asked.begin() + static_cast<std::ptrdiff_t>(arrival[i + 1])
                                         : asked.end(),
                  drive->set_point[arrival[i]]);
    // A tap may show a set-point in the row of its arrival, a position in the row behind it.
    const auto seen = [&](const std::vector<double>& rows) {
        if (!tapped) return std::vector<double>(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(n));
        std::vector<double> out(rows.begin() + static_cast<std::ptrdiff_t>(n) - 1, rows.end() - 1);
        out[0] = 0;
        return out;
    };
    const auto pulses = detail::largest_steps(asked, arrival, lasting);
    if (pulses.empty()) return nothing;
    driven_motion other = *drive;
    double energy = 0;
    for (std::size_t row : pulses) {
        const double step = asked[row - 1] - asked[row];
        other.set_point[row] += step;
        energy += step * step;
    }
    std::vector<double> with;
    on(other).pass(std::span(&plant, 1), command, std::span(&with, 1), nullptr);
    const auto left = seen(innovation), there = seen(with);
    const auto more = [&](std::size_t row) { return left[row] - there[row]; };
    // From the row of the arrival on, beside what earlier pulses left behind, in an integral for ever.
    std::vector<double> response(lasting, 0.0);
    for (std::size_t row : pulses)
        for (std::size_t j = 0; j < lasting; ++j)
            response[j] += (asked[row - 1] - asked[row]) * (more(row + j) - more(row - 1)) / energy;
    double most = 0;
    for (double r : response) most = std::max(most, std::abs(r));
    if (!(most > 0)) return nothing;
    std::size_t late = 1;
    while (late < lasting && std::abs(response[late]) < 1e-3 * most) ++late;
    response.erase(response.begin(), response.begin() + static_cast<std::ptrdiff_t>(late));
    auto out = lost_commands::find(asked, left, response, late - 1, resolution / std::sqrt(12.0), a);
    // Between its arrivals a drive does not look.
    auto applied = drive->set_point;
    for (std::size_t row : arrival) applied[row] = out.applied[row];
    out.applied = std::move(applied);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::shared_ptr<const received_set_points>
predictor::received(const plant_model& plant) const {
    plant_model whole = plant;
    whole.drive.loss = 0;
    std::vector<double> innovation;
    pass(std::span(&whole, 1), command, std::span(&innovation, 1), nullptr);
    auto found = set_points_with_loss(whole, innovation, {.probability = plant.drive.loss, .learned = true});
    return std::make_shared<const received_set_points>(
        received_set_points{std::move(found.applied), found.choices});
}

} // namespace quadrant::inline v0::diagnosis
