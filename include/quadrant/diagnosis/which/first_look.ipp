// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The valleys of a path are narrow: the first of these parameters begins at the best of its start, its
/// described value and fractions and multiples of both.
inline void begin_at_the_best(std::vector<parameter>& ps, std::size_t first, const fitter& fit,
                              plant_model plant) {
    parameter& p = ps[first];
    std::vector<double> values{p.start};
    for (const double around : {p.start, p.of(plant)})
        for (const double times : {0.2, 0.3, 0.45, 0.7, 1.0, 1.4, 2.2, 3.3, 5.0})
            if (const double v = std::clamp(times * around, p.low, p.high);
                v != 0 && std::none_of(values.begin(), values.end(),
                                       [&](double x) { return std::abs(x - v) < 0.05 * std::abs(v); }))
                values.push_back(v);
    for (const parameter& q : ps) q.of(plant) = q.start;
    std::vector<plant_model> plants(values.size(), plant);
    for (std::size_t i = 0; i < values.size(); ++i) p.of(plants[i]) = values[i];
    const auto looks = fit.objectives(plants);
    p.start = values[static_cast<std::size_t>(std::min_element(looks.begin(), looks.end()) - looks.begin())];
}

QUADRANT_DIAGNOSIS_DECL std::optional<std::vector<parameter>>
begun_where(const fit_result& found, const std::vector<std::vector<parameter>>& starts) {
    plant_model there = found.plant;
    for (std::vector<parameter> out : starts) {
        bool all = !out.empty(), new_to_all = false;
        for (parameter& p : out) {
            const auto q = std::find_if(found.parameters.begin(), found.parameters.end(),
                                        [&](const parameter& each) { return &each.of(there) == &p.of(there); });
            if (!(all = q != found.parameters.end())) break;
            const double x = std::clamp(p.of(there), p.low, p.high);
            new_to_all = new_to_all || std::abs(x - p.start) > 0.05 * std::abs(x);
            p.start = x;
        }
        if (all) return new_to_all ? std::optional(std::move(out)) : std::nullopt;
    }
    return std::nullopt;
}

/// A constant force that is searched takes the difference of the directions' friction to it: of both, fitted
/// together, neither is known. True where `q` is that difference.
inline bool gives_way_to_constant(const parameter& q, plant_model& plant, std::vector<parameter>& start) {
    const auto constant = std::find_if(start.begin(), start.end(),
                                       [](const parameter& p) { return p.key == "constant_force_N"; });
    if (q.key != "coulomb_asymmetry" || !(q.spread > 0) || constant == start.end()) return false;
    const double described = q.from_fit(q.expected), found = std::exchange(q.of(plant), described);
    constant->start = std::clamp(constant->start - plant.friction.coulomb * (found - described), constant->low,
                                 constant->high);
    return true;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<fit_course> first_looks(const fitter& fit, const candidate& from,
                                                            const effect& added, const screening& look,
                                                            const shared_slopes& slopes, int steps,
                                                            const fit_result* found) {
    std::vector<fit_course> out;
    const auto resumed_from = resumed(from.fit);
    auto starts = added.starts(look);
    if (found) {
        auto where = detail::begun_where(*found, starts);
        starts.assign(where ? 1 : 0, where.value_or(std::vector<parameter>()));
    }
    for (auto& start : starts) {
        plant_model plant = from.fit.plant;
        added.join(plant, look);
        std::vector<parameter> ps;
        const bool bends = added.bends_calibration && start.size() > 1; // slopes without it lead away from it
        known_slopes known{.from = &slopes};
        for (std::size_t i = 0; i < resumed_from.size(); ++i) {
            // The effect's own parameters replace the described ones.
            const parameter& q = resumed_from[i];
            const auto its = [&](const parameter& p) { return &p.of(plant) == &q.of(plant); };
            if (std::none_of(start.begin(), start.end(), its) &&
                !detail::gives_way_to_constant(q, plant, start))
                ps.push_back(q), known.which.push_back(i);
        }
        const std::size_t own = ps.size();
        ps.insert(ps.end(), start.begin(), start.end());
        if (look.record.closed() && !start.empty()) detail::begin_at_the_best(ps, own, fit, plant);
        out.emplace_back(fit, plant, ps, bends ? std::max(8, steps) : steps, bends ? known_slopes() : known,
                         bends ? 4 : 0);
    }
    return out;
}

namespace detail {

/// Whether two fits move the same numbers.
inline bool are_of_a_kind(const fit_result& a, const fit_result& b) {
    return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end(),
                      [](const parameter& p, const parameter& q) { return p.key == q.key; });
}

QUADRANT_DIAGNOSIS_DECL void take_best(candidate& sketch, const candidate& from, std::span<fit_course> starts,
                                       double share) {
    std::vector<fit_result*> order;
    for (fit_course& c : starts) order.push_back(&c.result());
    std::stable_sort(order.begin(), order.end(),
                     [](fit_result* a, fit_result* b) { return cost_of(*a) < cost_of(*b); });
    const auto gain = [&](const fit_result& way) { return from.fit.objective - way.objective; };
    for (fit_result* way : order) {
        if (way == order.front()) {
            sketch.fit = std::move(*way);
            continue;
        }
        const bool met = are_of_a_kind(*way, sketch.fit) ||
                         std::any_of(sketch.other_ways.begin(), sketch.other_ways.end(),
                                     [&](const fit_result& o) { return are_of_a_kind(*way, o); });
        if (met || !(gain(*way) > share * gain(sketch.fit))) continue;
        way->innovation = {}; // it is fitted again before anything is asked of it
        way->quadratic = {};
        sketch.other_ways.push_back(std::move(*way));
    }
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
