// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/effect_list.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Whether a number says after what way or time something repeats.
inline bool is_cycle(const parameter_estimate& p) {
    return p.key.find("frequency") != p.key.npos || p.key.find("period") != p.key.npos ||
           p.key == "process.fundamental_Hz";
}

QUADRANT_DIAGNOSIS_DECL void in_lowest_terms(std::vector<parameter_estimate>& values) {
    parameter_estimate *cycle = nullptr, *phases = nullptr, *sizes = nullptr;
    for (parameter_estimate& p : values) {
        if (is_cycle(p)) cycle = &p;
        if (p.key.ends_with("phase_rad")) phases = &p;
    }
    for (parameter_estimate& p : values)
        if (phases && &p != phases && p.values.size() == phases->values.size() && p.values.size() > 1)
            sizes = &p;
    if (!cycle || !sizes) return;
    std::vector<double> amplitudes;
    for (const estimate& e : sizes->values) amplitudes.push_back(e.value);
    const std::size_t n = repeats_in_its_period(amplitudes);
    if (n == 1) return;
    for (parameter_estimate* p : {sizes, phases}) {
        std::vector<estimate> kept;
        for (std::size_t i = n; i <= p->values.size(); i += n) kept.push_back(p->values[i - 1]);
        p->values = kept;
    }
    const double factor = std::pow(static_cast<double>(n), cycle->key.ends_with("_Hz") ? 1 : -1);
    for (estimate& e : cycle->values) e = {factor * e.value, factor * e.low, factor * e.high};
}

QUADRANT_DIAGNOSIS_DECL void add_model_error(std::vector<parameter_estimate>& values, const effect& e,
                                             const axis_case& c, double left) {
    in_lowest_terms(values);
    const double relative = std::min(1.0, std::hypot(0.01, left));
    for (auto& p : values)
        for (estimate& v : p.values) {
            const double part = relative * (p.key.ends_with("_rad") ? 1.0 : std::abs(v.value));
            const machine_key* key = key_named(p.key);
            // A length on a rotary axis is not read by its encoder.
            const bool counts = p.key.ends_with("_m") && !(key && key->same_when_rotary);
            const double error = std::hypot(part, counts ? 0.5 * c.resolution : 0.0);
            v.low = v.value - std::hypot(v.value - v.low, error);
            v.high = v.value + std::hypot(v.high - v.value, error);
        }
    for (estimate& v : values.front().values) v.high *= e.by_another_law;
}

QUADRANT_DIAGNOSIS_DECL void widen(std::vector<parameter_estimate>& mine,
                                   const std::vector<parameter_estimate>& other) {
    for (auto& p : mine)
        for (const auto& o : other)
            if (o.key == p.key)
                for (std::size_t k = 0; k < std::min(p.values.size(), o.values.size()); ++k) {
                    p.values[k].low = std::min(p.values[k].low, o.values[k].low);
                    p.values[k].high = std::max(p.values[k].high, o.values[k].high);
                }
}

QUADRANT_DIAGNOSIS_DECL bool is_undetermined(const std::vector<parameter_estimate>& values) {
    return std::any_of(values.begin(), values.end(), [](const parameter_estimate& p) {
        return is_cycle(p) && p.values[0].high - p.values[0].low > 2 * p.values[0].value;
    });
}

QUADRANT_DIAGNOSIS_DECL bool may_be_nothing(const std::vector<parameter_estimate>& values) {
    const auto is_size = [](const parameter_estimate& p) { // of a wave, or one of two differences
        const machine_key* key = key_named(p.key);
        return key && (!key->components.empty() || p.key.ends_with("_asymmetry"));
    };
    const auto reaches_neutral = [](const parameter_estimate& p) {
        const machine_key* key = key_named(p.key);
        return key && std::all_of(p.values.begin(), p.values.end(), [&](const estimate& value) {
                   return value.low <= key->neutral && key->neutral <= value.high;
               });
    };
    if (std::none_of(values.begin(), values.end(), is_size)) return reaches_neutral(values.front());
    return std::all_of(values.begin(), values.end(),
                       [&](const parameter_estimate& p) { return !is_size(p) || reaches_neutral(p); });
}

} // namespace quadrant::inline v0::diagnosis::detail
