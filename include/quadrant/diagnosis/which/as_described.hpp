// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/effect.hpp"
#include "../result/result.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// What a model has under a key of an effect; nothing: no such key. An effect of one of several numbers reads
/// the one that differs.
inline std::vector<double> values_of(const effect& e, plant_model& model, std::string_view key) {
    for (key_value& read : e.read(model))
        if (read.key == key) return std::move(read.values);
    for (const machine_key& k : e.keys)
        if (k.name == key && k.of) return {k.of(model)};
    return {};
}

/// Whether what was found of an effect does not say that its numbers are others than the file's: each
/// described one is in the interval of its value. Of a law that others imitate the first one decides, whose
/// interval is as wide as they read it otherwise.
inline bool is_as_described(const cause& found, const effect& e, plant_model as_given) {
    if (!found.described) return false;
    const std::size_t told = e.by_another_law > 1 ? 1 : found.parameters.size();
    for (const parameter_estimate& p : std::span(found.parameters).first(told)) {
        const auto described = values_of(e, as_given, p.key);
        const bool turns = p.key.ends_with("phase_rad");
        for (std::size_t i = 0; i < std::min(described.size(), p.values.size()); ++i) {
            const estimate& value = p.values[i];
            const double apart = described[i] - value.value;
            const double at = value.value + (turns ? std::remainder(apart, 2 * std::numbers::pi) : apart);
            if (at < value.low || value.high < at) return false;
        }
    }
    return true;
}

} // namespace quadrant::inline v0::diagnosis::detail
