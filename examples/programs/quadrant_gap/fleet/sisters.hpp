// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

#include <algorithm>
#include <map>
#include <set>

/// Which machine differs from its sisters, and by what: logs that were diagnosed with one machine file are of
/// machines that are meant to be alike.
namespace quadrant_gap::fleet {

/// One difference of one log from the others of its machine file.
struct odd_one {
    std::string log, axis, effect;
    std::string own, others; ///< in words
    double force = 0;        ///< rms of what differs, in the unit of the axis [N, N m]
    std::string unit = "N";
    double over_floor = 0; ///< the same over what sensor and rounding leave: the order
};

namespace detail {

inline double median(std::vector<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    if (x.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(x.begin(), middle)) / 2;
}

/// What a log was found to have of an effect on an axis; null: it was not claimed.
inline const finding* found_in(const row& r, const std::string& axis, const std::string& effect) {
    for (const finding& f : r.findings)
        if (f.axis == axis && f.effect == effect) return &f;
    return nullptr;
}

inline std::string value_of(const finding& f, double value) { return quantity(value, label_of(f.key).second); }

/// One effect of one log beside the same of the others; force 0: no difference.
inline odd_one beside(const row& r, const std::string& axis, const std::string& effect,
                      const std::vector<const row*>& others) {
    odd_one out{.log = r.name, .axis = axis, .effect = effect, .own = {}, .others = {}};
    std::vector<const finding*> have;
    for (const row* o : others)
        if (const finding* f = found_in(*o, axis, effect)) have.push_back(f);
    const finding* own = found_in(r, axis, effect);
    const bool usual = 2 * have.size() > others.size();
    const std::string count = fmt::format("{} of {} have it", have.size(), others.size());
    if (!own && !usual) return out;
    const finding& any = own ? *own : *have.front();
    out.unit = any.unit;
    if (own && !usual) {
        out.own = own->key.empty() ? "has it" : value_of(*own, own->value);
        out.others = have.empty() ? "none has it" : count;
        out.force = own->force;
    } else if (!own) {
        std::vector<double> forces;
        for (const finding* f : have) forces.push_back(f->force);
        out.own = "does not have it, or its motion does not show it";
        out.others = count;
        out.force = median(forces);
    } else {
        std::vector<double> values, apart, widths;
        for (const finding* f : have)
            if (!f->key.empty() && f->key == own->key) {
                values.push_back(f->value);
                widths.push_back((f->high - f->low) / 2);
            }
        if (values.size() < 2) return out;
        const double middle = median(values);
        for (const double v : values) apart.push_back(std::abs(v - middle));
        constexpr double sigma = 1.4826, far = 3; // of a normal spread over its median deviation; in sigmas
        constexpr std::size_t few = 6;            // of which the median deviation says little
        const double off = std::abs(own->value - middle);
        double usual_spread = far * std::max(sigma * median(apart), median(widths) / 2);
        if (values.size() < few)
            usual_spread = std::max(usual_spread, *std::max_element(apart.begin(), apart.end()));
        if ((own->low <= middle && middle <= own->high) || off <= usual_spread) return out;
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        out.own = value_of(*own, own->value);
        out.others = fmt::format("{} to {}", value_of(*own, *least), value_of(*own, *most));
        out.force = own->force * off / std::max(std::abs(own->value), std::abs(middle));
    }
    if (out.force <= any.floor) out.force = 0; // no more than sensor and rounding leave
    out.over_floor = any.floor > 0 ? out.force / any.floor : out.force;
    return out;
}

} // namespace detail

/// Every difference, the largest over its floor first. Machines with fewer than two sisters are left out: of
/// two it is not known which is the odd one (quadrant-gap compare says what differs between them).
inline std::vector<odd_one> odd_ones(const std::vector<row>& rows) {
    std::map<std::string, std::vector<const row*>> families;
    for (const row& r : rows)
        if (r.verdict != "failed" && r.verdict != "not_done") families[r.machine].push_back(&r);
    std::vector<odd_one> out;
    for (const auto& [machine, family] : families) {
        if (machine.empty() || family.size() < 3) continue;
        std::set<std::pair<std::string, std::string>> effects;
        for (const row* r : family)
            for (const finding& f : r->findings) effects.emplace(f.axis, f.effect);
        for (const row* r : family) {
            std::vector<const row*> others;
            for (const row* o : family)
                if (o != r) others.push_back(o);
            for (const auto& [axis, effect] : effects)
                if (odd_one found = detail::beside(*r, axis, effect, others); found.force > 0)
                    out.push_back(std::move(found));
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const odd_one& a, const odd_one& b) { return a.over_floor > b.over_floor; });
    return out;
}

/// "press 3: cogging, axis x: 31 N; none has it (12 N rms)"
inline std::string sentence(const odd_one& o) {
    return fmt::format("{}: {}, axis {}: {}; sisters: {} ({} rms)", o.log, name_of_effect(o.effect), o.axis,
                       o.own, o.others, quantity(o.force, o.unit));
}

} // namespace quadrant_gap::fleet
