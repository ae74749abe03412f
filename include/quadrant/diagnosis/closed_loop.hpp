// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller_box.hpp"
#include "plant_model.hpp"

namespace quadrant::diagnosis {

struct closed_loop_run {
    std::vector<double> position, command;
};

/// The whole simulation as its owner would run it: described controller and given plant from the logged reference,
/// started where the log starts. Sub-steps keep stick and the held command apart from the sampling.
inline closed_loop_run simulate_closed_loop(const controller_description& c, const axis_description& axis,
                                            const plant_model& plant, double period,
                                            std::span<const double> reference, std::span<const double> position,
                                            std::span<const double> command) {
    constexpr int substeps = 4;
    return with_cascade(c, axis.actuator, period, [&](auto controller) {
        closed_loop_run out;
        const std::size_t n = reference.size();
        out.position.resize(n);
        out.command.resize(n);
        start_at_row_0(controller, reference[0], reference[1], position[0], position[1], command[0], period);
        const auto whole = static_cast<std::size_t>(std::max(0.0, plant.delay) / period);
        const double first = std::max(0.0, plant.delay) - static_cast<double>(whole) * period;
        const plant_model::stepper older(plant, (first > 0 ? first : period) / substeps),
            newer(plant, (period - first) / substeps);
        plant_model::state s{.x = position[0], .v = (position[1] - position[0]) / period};
        for (std::size_t k = 0; k < n; ++k) {
            const double q = axis.encoder_resolution_m;
            out.position[k] = q > 0 ? std::round(s.x / q) * q : s.x;
            out.command[k] = k == 0 ? command[0]
                                    : controller(quantity_of<signal::position>::from_value(reference[k]),
                                                 quantity_of<signal::position>::from_value(out.position[k]))
                                          .value();
            const auto past = [&](std::size_t back) { return out.command[k >= back ? k - back : 0]; };
            for (int i = 0; i < substeps && first > 0; ++i) older(s, past(whole + 1));
            for (int i = 0; i < substeps; ++i) newer(s, past(whole));
        }
        return out;
    });
}

} // namespace quadrant::diagnosis
