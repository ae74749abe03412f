// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compare.hpp"
#include "write_diagnosis.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline ordered_json difference_json(const difference& d, axis_kind kind) {
    return {{"axis", d.axis},
            {"effect", d.effect},
            {"probability", d.probability},
            {"confusable_with", d.confusable_with},
            {"first", parameters_json(d.first)},
            {"second", parameters_json(d.second)},
            {"found_in", d.found_in_second ? "second" : "first"},
            {key_of("gap_before_force_rms_N", kind), d.gap_before_force_rms_N.value},
            {key_of("gap_after_force_rms_N", kind), d.gap_after_force_rms_N.value},
            {key_of("gap_before_position_rms_m", kind), d.gap_before_position_rms_m.value},
            {key_of("gap_after_position_rms_m", kind), d.gap_after_position_rms_m.value},
            {"gain", d.gain},
            {"loss", d.loss}};
}

} // namespace detail

/// The comparison file (docs/schema/comparison.schema.json): what differs, and each log's own verdict.
inline nlohmann::ordered_json to_json(const comparison_result& c) {
    using detail::ordered_json;
    ordered_json axes = ordered_json::object();
    const auto listed = [&](const std::vector<difference>& all) {
        ordered_json out = ordered_json::array();
        for (const difference& d : all) out.push_back(detail::difference_json(d, c.first.kind_of(d.axis)));
        return out;
    };
    for (const compared_axis& a : c.axes)
        axes[a.name] = {{"likeness", name_of(a.likeness)},
                        {"kind", name_of(a.kind)},
                        {"explained", a.found_in_second ? "second" : "first"},
                        {key_of("force_before_N", a.kind), a.force_before_N},
                        {key_of("force_after_N", a.kind), a.force_after_N},
                        {key_of("force_own_N", a.kind), a.force_own_N},
                        {key_of("force_common_N", a.kind), a.force_common_N},
                        {key_of("floor_N", a.kind), a.floor_N},
                        {"calibrated_first", detail::parameters_json(a.first)},
                        {"calibrated_second", detail::parameters_json(a.second)}};
    ordered_json out = {{"schema", "quadrant.comparison/1"},
                        {"likeness", name_of(c.likeness)},
                        {"verdict_first", name_of(c.first.verdict)},
                        {"verdict_second", name_of(c.second.verdict)},
                        {"axes", axes},
                        {"differences", listed(c.differences)},
                        {"undecided", listed(c.undecided)},
                        {"notes", c.notes}};
    auto files = detail::files_json({{"machine", c.machine_file, c.machine_sha256},
                                     {"first", c.first_file, c.first_sha256},
                                     {"second", c.second_file, c.second_sha256}});
    if (!files.empty()) out["files"] = std::move(files);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
