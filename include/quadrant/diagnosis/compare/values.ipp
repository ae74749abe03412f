// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../write_machine.hpp"

#include <cmath>
#include <iterator>

namespace quadrant::inline v0::diagnosis::detail::beside {

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> described(const machine_description& machine,
                                                                  const cause& c) {
    const nlohmann::ordered_json all = to_json(machine), &axis = all["axes"][c.axis];
    std::vector<parameter_estimate> out;
    for (const parameter_estimate& p : c.parameters) {
        const auto dot = p.key.find('.');
        const std::string box = c.effect == "controller_mismatch" ? "controller"
                                : dot == p.key.npos               ? "plant"
                                                                  : p.key.substr(0, dot);
        const nlohmann::ordered_json* at = axis.contains(box) ? &axis[box] : nullptr;
        std::string rest =
            c.effect == "controller_mismatch" || dot == p.key.npos ? p.key : p.key.substr(dot + 1);
        for (auto end = rest.find('.'); at && end != rest.npos; rest.erase(0, end + 1), end = rest.find('.'))
            at = at->contains(rest.substr(0, end)) ? &(*at)[rest.substr(0, end)] : nullptr;
        if (at && !at->contains(rest) && rest.ends_with("_per_V")) rest.back() = 'A';
        if (!at || !at->contains(rest)) continue;
        parameter_estimate found{.key = p.key, .values = {}};
        const auto add = [&](const nlohmann::ordered_json& v) {
            if (v.is_number()) found.values.push_back({v.get<double>(), v.get<double>(), v.get<double>()});
        };
        const nlohmann::ordered_json& value = (*at)[rest];
        if (value.is_array())
            for (const auto& v : value) add(v);
        else
            add(value);
        if (!found.values.empty()) out.push_back(std::move(found));
    }
    return out;
}

/// Size of a value, or of all its harmonics together, with its interval.
inline estimate size_of(const parameter_estimate& p) {
    if (p.values.size() == 1) return p.values.front();
    double size = 0, half = 0;
    for (const estimate& e : p.values) {
        size = std::hypot(size, e.value);
        half = std::hypot(half, (e.high - e.low) / 2);
    }
    return {size, size - half, size + half};
}

QUADRANT_DIAGNOSIS_DECL bool same_size(const std::vector<parameter_estimate>& a,
                                       const std::vector<parameter_estimate>& b) {
    for (const parameter_estimate& p : a)
        for (const parameter_estimate& q : b) {
            if (p.key != q.key || p.key.ends_with("phase_rad")) continue;
            const estimate x = size_of(p), y = size_of(q);
            if (x.low > y.high || y.low > x.high) return false;
        }
    return true;
}

/// The values of an effect in a diagnosis, as a cause or as the other reading of one; empty: it is in none.
inline std::vector<parameter_estimate> values_in(const diagnosis_result& d, const std::string& axis,
                                                 const std::string& effect) {
    if (const cause* c = cause_in(d, axis, effect)) return c->parameters;
    for (const cause& c : d.causes)
        for (const reading& r : c.readings)
            if (c.axis == axis && r.effect == effect) return r.parameters;
    return {};
}

QUADRANT_DIAGNOSIS_DECL bool is_in(const diagnosis_result& d, const cause& c) {
    const auto same = [&](const std::string& effect, const std::vector<parameter_estimate>& values) {
        const auto there = values_in(d, c.axis, effect);
        return !there.empty() && same_size(there, values);
    };
    return same(c.effect, c.parameters) ||
           std::any_of(c.readings.begin(), c.readings.end(),
                       [&](const auto& r) { return same(r.effect, r.parameters); });
}

QUADRANT_DIAGNOSIS_DECL diagnosis_result lent(diagnosis_result d, const diagnosis_result& to) {
    std::erase_if(d.causes, [](const cause& c) { return is_process(c.effect); });
    std::copy_if(to.causes.begin(), to.causes.end(), std::back_inserter(d.causes),
                 [](const cause& c) { return is_process(c.effect); });
    for (cause& c : d.causes) {
        const cause* there = cause_in(to, c.axis, c.effect);
        const auto values = values_in(to, c.axis, c.effect);
        if (values.empty() || !same_size(c.parameters, values)) continue;
        c.parameters = values;
        c.with_suspects = there ? there->with_suspects : std::vector<parameter_estimate>{};
    }
    return d;
}

} // namespace quadrant::inline v0::diagnosis::detail::beside
