// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../controller/kinds.hpp"
#include "../fit/scales.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// A number of a controller that may be found to be another.
struct searched_key {
    std::string key;
    std::function<double&(controller_description&)> of;
    double scale; ///< a sensible size when the described value is zero
    std::function<bool(double)> allowed = [](double) { return true; };
    std::vector<double> only{}; ///< the values that it may have; empty: any
};

/// A small size of a quantity on this axis, a hundredth of what its unit is made of there: largest command,
/// speed and time constant of the record. 0: the word holds no unit.
inline double size_of(std::string_view words, const record_scales& of) {
    double size = 0.01;
    bool divides = false, any = false;
    while (!words.empty()) {
        const std::string_view word = words.substr(0, words.find('_'));
        words.remove_prefix(std::min(words.size(), word.size() + 1));
        const auto times = [&](double x) {
            size *= divides ? 1 / x : x;
            any = true;
        };
        const bool was_unit = any;
        if (word == "per")
            divides = true;
        else if (word == "V" || word == "A" || word == "N")
            times(of.command);
        else if (word == "m" || word == "rad")
            times(of.speed * of.response());
        else if (word == "s")
            times(of.response());
        else if (word == "s2")
            times(of.response() * of.response());
        else if (word == "s3")
            times(of.response() * of.response() * of.response());
        else if (word == "Hz")
            return of.bandwidth_Hz();
        else if (was_unit)
            return 0; // a word behind a unit: it was none
    }
    return any ? size : 0;
}
inline double size_of(const controller_key& key, const controller_kind& kind, const given_values& values,
                      const record_scales& of) {
    const double size = size_of(key.of_unit.empty() ? key.last() : key.of_unit, of);
    if (size == 0) return key.scale;
    const bool in_units_of_its_own =
        !key.of_unit.empty() && key.of_unit.find("per_m") != key.of_unit.npos &&
        std::any_of(kind.keys.begin(), kind.keys.end(), [](auto& k) { return k.name == "units_per_m"; });
    return in_units_of_its_own ? size / values["units_per_m"] : size;
}

/// The numbers of a controller that are searched for the one that differs; the sizes of those that are 0 follow
/// from the record.
inline std::vector<searched_key> searched_keys(const controller_description& c, const record_scales& of = {}) {
    using d = controller_description;
    std::vector<searched_key> out;
    if (c.own) {
        for (std::size_t i = 0; i < c.own->keys.size(); ++i)
            out.push_back({c.own->keys[i].key, [i](d& x) -> double& { return x.own->keys[i].value; },
                           c.own->keys[i].scale});
        return out;
    }
    const controller_kind& kind = kind_of(c);
    const given_values values(kind, c);
    for (const controller_key& key : kind.keys) {
        const bool there = values.has(key.name) || (!key.in_box() && std::isfinite(key.otherwise)),
                   in_box = key.in_box() && values.has_box(key.box()) && std::isfinite(key.otherwise),
                   sized = key.scale != 0 || values[key.name] != 0,
                   one_number = key.form == key_form::number || key.form == key_form::yes_no;
        if (!key.searched || !one_number || !sized || !(there || in_box)) continue;
        const double scale =
            key.scale_of.empty() ? size_of(key, kind, values, of) : values[key.scale_of] * size_of("per_s", of);
        out.push_back({std::string(key.name),
                       [name = std::string(key.name), start = values[key.name]](d& x) -> double& {
                           auto& place = x.values[name];
                           if (place.empty()) place = {start};
                           return place.front();
                       },
                       scale, key.rule.holds});
        if (key.form == key_form::yes_no) out.back().only = {0, 1};
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
