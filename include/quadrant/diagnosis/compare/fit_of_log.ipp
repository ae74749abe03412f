// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/for_machine.hpp"
#include "../fit/neighbour.hpp"
#include "../log/sensor_box.hpp"
#include "../result/result.hpp"
#include "../which/pieces.hpp"
#include "../which/search.hpp"

namespace quadrant::inline v0::diagnosis::detail::beside {

inline axis_record prepared(const axis_description& axis, const axis_log& log, double period) {
    const double count = observed_count(log.position, log.position_step);
    const bool coarse = axis.encoder.resolution_m > 0 && count > 1.5 * axis.encoder.resolution_m;
    const double resolution = std::max({axis.encoder.resolution_m, coarse ? count : 0.0, log.position_step});
    std::size_t motions = 0;
    return for_machine(
        in_pieces(prepare(log, period, resolution, scales_of(axis.plant, log, period, resolution)), motions),
        axis);
}

QUADRANT_DIAGNOSIS_DECL log_of_axis::log_of_axis(const machine_description& machine,
                                                 const axis_description& axis, const machine_log& log, rules r)
    : limits_(r), excluded_{machine.excluded_effects},
      log_(with_neighbour(log, *named(log.axes, axis.name), machine.sample_period_s,
                          bandwidth_of(axis, *named(log.axes, axis.name), machine.sample_period_s))),
      record_(prepared(axis, log_, machine.sample_period_s)) {}

QUADRANT_DIAGNOSIS_DECL fit_of_log log_of_axis::explained_by(const axis_description& axis) {
    record_.observer.substeps = std::max(record_.observer.substeps,
                                         substeps_of(plant_model(axis, record_.scale.give()), record_.period));
    const search models(record_, axis, excluded_, limits_, [](const std::string&) {});
    const candidate& c = models.calibrated();
    return {c.total, models.held_out_force(c), models.floor_force(c), models.suspects().size()};
}

} // namespace quadrant::inline v0::diagnosis::detail::beside
