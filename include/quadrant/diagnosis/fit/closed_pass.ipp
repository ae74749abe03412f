// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<double> predictor::beside_tap(const drive_model& d,
                                                                  std::vector<double> beside) const {
    if (d.kind != drive_kind::position_servo) return as_reading(d, std::move(beside), period, pole());
    for (double& duty : beside) duty *= drive->to_position;
    return beside;
}

QUADRANT_DIAGNOSIS_DECL void predictor::drive_each(std::span<const plant_model> plants,
                                                   std::array<std::vector<double>, abreast>& own,
                                                   std::array<const double*, abreast>& command_of,
                                                   std::span<std::vector<double>> innovation) const {
    const auto n = static_cast<std::ptrdiff_t>(position.size());
    for (std::size_t i = 0; i < plants.size(); ++i) {
        std::size_t same = 0;
        while (same < i && !(plants[same].drive == plants[i].drive)) ++same;
        if (same == i) {
            auto replay = drive->run(plants[i].drive);
            own[i] = std::move(replay.command);
            const auto beside = beside_tap(plants[i].drive, std::move(replay.beside));
            std::copy(beside.begin(), beside.end(), innovation[i].begin() + n);
        } else if (drive->tapped()) {
            std::copy(innovation[same].begin() + n, innovation[same].end(), innovation[i].begin() + n);
        }
        command_of[i] = own[same].data();
    }
}

QUADRANT_DIAGNOSIS_DECL void predictor::pass_closed(std::span<const plant_model> plants,
                                                    std::span<const double> u,
                                                    std::span<std::vector<double>> innovation,
                                                    std::vector<double>* acceleration) const {
    if (acceleration) pass(plants, u, innovation, acceleration, {position.data(), l1(), l2(), 1});
    std::array<std::vector<double>, abreast> own;
    std::array<const double*, abreast> command_of{};
    for (auto& rows_of : innovation) rows_of.resize(rows());
    if (drive->tapped()) drive_each(plants, own, command_of, innovation);
    std::size_t steps = 1;
    for (const plant_model& p : plants)
        steps = std::max(steps, static_cast<std::size_t>(steps_of_drive(p, period)));
    std::array<std::shared_ptr<const followed_set_points>, abreast> follows;
    std::array<closed_input::plant, abreast> each;
    std::array<double*, abreast> e{};
    for (std::size_t i = 0; i < plants.size(); ++i) {
        const drive_model& d = plants[i].drive;
        follows[i] = drive->follows(d, steps);
        each[i] = {axis_parameters(plants[i]), loops_of(d, *drive), follows[i]->value.data(),
                   follows[i]->velocity.data(), drive->in_volts ? d.velocity_per_V : 1};
        e[i] = innovation[i].data();
    }
    passes().closed({.period = period,
                     .rows = position.size(),
                     .steps = steps,
                     .position = position.data(),
                     .velocity = *closed,
                     .begins = drive->begins,
                     .other_acceleration = other_acceleration.empty() ? nullptr : other_acceleration.data(),
                     .off = drive->off.empty() ? nullptr : drive->off.data(),
                     .plants = plants.size(),
                     .plant_of = each.data(),
                     .innovation = e.data()});
}

} // namespace quadrant::inline v0::diagnosis
