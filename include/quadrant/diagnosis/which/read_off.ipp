// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL double rounding_force(const axis_case& c, double count) {
    return residual_force_floor(c.axis.plant.mass_kg, count / std::sqrt(12.0), c.record.period,
                                c.record.bandwidth_Hz);
}

QUADRANT_DIAGNOSIS_DECL std::optional<cause> count_cause(const axis_case& c) {
    if (!c.coarse() || c.count_unnamed) return {};
    cause out;
    out.axis = c.axis.name;
    out.effect = "encoder_quantization";
    out.exciting_motion = "any: the steps of the reading are counted";
    out.described = true;
    out.probability = out.group_probability = c.counts_digits() ? 0.4 : 0.97;
    out.parameters.push_back({"encoder.resolution_m", {{c.count, c.count, c.count}}});
    return out;
}

QUADRANT_DIAGNOSIS_DECL cause added_cause(const axis_case& c) {
    const added_finding& found = *c.controller->added;
    cause out;
    out.axis = c.axis.name;
    out.effect = "added_command";
    out.exciting_motion = "any: the controller is replayed from the log";
    out.probability = out.group_probability = found.probability;
    out.waveform = found.waveform;
    if (found.of_controller > 0.01) {
        out.confusable_with = {"controller_mismatch"};
        out.group_probability += found.of_controller;
        const double value = c.controller->value;
        out.readings.push_back({out.confusable_with.front(), {{c.controller->key, {{value, value, value}}}}});
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::optional<cause> controller_cause(const axis_case& c) {
    if (!c.controller_differs() || c.controller_unnamed) return {};
    if (c.command_is_added()) return added_cause(c);
    cause out;
    out.axis = c.axis.name;
    out.effect = "controller_mismatch";
    out.exciting_motion = "any: the controller is replayed from the log";
    out.described = true;
    out.probability = out.group_probability = c.controller->mended ? 0.97 : 0.4;
    if (!c.controller->key.empty())
        out.parameters.push_back(
            {c.controller->key, {{c.controller->value, c.controller->low, c.controller->high}}});
    for (const auto& other : c.controller->alternatives)
        out.readings.push_back({out.effect, {{other.key, {{other.value, other.value, other.value}}}}});
    return out;
}

} // namespace quadrant::inline v0::diagnosis
