// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "stage_moves.hpp"

namespace quadrant_reproduce {

inline outcome stage_cycle_case(const std::string& id) {
    using stage::linear_cycle;
    double worst = 0, at_targets = 0, squares = 0, counts = 0, samples = 0;
    const auto empty = [](const char* name) { return line{.name = name, .x = {}, .y = {}}; };
    line reference = empty("reference"), position = empty("axis"), measured = empty("encoder"),
         estimate = empty("estimate");
    stage::run<stage::fed_forward>(stage::real, stage::believed, stage::tight, linear_cycle(),
                                   linear_cycle::end(), [&](const stage::moment& m) {
                                       const double off = 1e6 * std::abs(m.error()),
                                                    since = std::fmod(m.time, linear_cycle::lasts);
                                       worst = std::max(worst, off);
                                       if (since > linear_cycle::lasts - 0.02)
                                           at_targets = std::max(at_targets, off);
                                       squares += 1e12 * (m.estimate - m.position) * (m.estimate - m.position);
                                       counts += 1e12 * (m.measured - m.position) * (m.measured - m.position);
                                       samples += 1;
                                       const auto draw = [&](line& into, double y) {
                                           into.x.push_back(m.time), into.y.push_back(1e6 * y);
                                       };
                                       draw(reference, m.reference), draw(position, m.position);
                                       if (m.time < 2) draw(measured, m.measured), draw(estimate, m.estimate);
                                   });
    outcome out;
    out.rows = {
        {id, "max_error", "um", worst, {}, {}, {}, "on the way between targets"},
        {id, "max_error_at_targets", "um", at_targets, {}, {}, {}, "in the last 20 ms of each stop"},
        {id,
         "rms_estimate_error",
         "um",
         std::sqrt(squares / samples),
         {},
         {},
         {},
         "Kalman filter against axis"},
        {id, "rms_encoder_error", "um", std::sqrt(counts / samples), {}, {}, {}, "encoder against axis"}};
    line zoomed = position;
    const auto first = std::size_t(2 / stage::period.value());
    zoomed.x.resize(first), zoomed.y.resize(first);
    out.pictures = {
        {"Linear cycle of BS 3800 with targets of 10 um",
         "Below: the counts of the encoder, and what the Kalman filter makes of them.",
         {panel{.x_label = "time [s]", .y_label = "position [um]", .lines = {reference, position}},
          panel{.x_label = "time [s]", .y_label = "position [um]", .lines = {measured, estimate, zoomed}}}}};
    return out;
}

inline experiment stage_cycle() {
    return {"The linear cycle of BS 3800",
            stage_source,
            "Three targets of 10 um forward, half a step over, the same three back, half a step over; 0.1 s to "
            "each and "
            "0.4 s there. Tight gains, LuGre friction fed forward.",
            0.02,
            {{"stage.bs3800", [] { return stage_cycle_case("stage.bs3800"); }}}};
}

} // namespace quadrant_reproduce
