// SPDX-License-Identifier: BSL-1.0
// Long: tally() writes one field of its JSON after the other.
#pragma once
#include "judge.hpp"
#include "recalibration.hpp"

#include <array>
#include <cmath>
#include <map>

/// From judgements to the figures of a trial, as the JSON that --json writes. Intervals of shares are those of
/// Clopper and Pearson.
namespace quadrant_gap::trial {

struct judged_machine {
    judgement judged;
    std::optional<shrink_pair> shrink;
};

namespace detail {

/// Probability of at most `hits` hits in `of` tries with probability p each, 0 < p < 1.
inline double at_most(std::size_t hits, std::size_t of, double p) {
    const double n = static_cast<double>(of);
    double sum = 0;
    for (std::size_t i = 0; i <= hits; ++i) {
        const double k = static_cast<double>(i);
        sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
                        (n - k) * std::log1p(-p));
    }
    return sum;
}

/// Probability for which `at_most` is `chance`, by bisection: `at_most` falls with p.
inline double bound_of_p(std::size_t hits, std::size_t of, double chance) {
    double low = 0, high = 1;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = (low + high) / 2;
        (at_most(hits, of, middle) > chance ? low : high) = middle;
    }
    return (low + high) / 2;
}

struct share {
    std::size_t hits = 0, of = 0;
    void add(bool hit) { ++of, hits += hit; }
    ordered_json json() const {
        ordered_json out{{"right", hits}, {"of", of}};
        if (of == 0) return out;
        out["share"] = static_cast<double>(hits) / static_cast<double>(of);
        out["ci95"] = {hits == 0 ? 0.0 : bound_of_p(hits - 1, of, 0.975),
                       hits == of ? 1.0 : bound_of_p(hits, of, 0.025)};
        return out;
    }
};

/// One-sided upper 95 % bound of a probability that showed `hits` times.
inline double upper_bound(std::size_t hits, std::size_t of) {
    if (of == 0 || hits == of) return 1;
    return bound_of_p(hits, of, 0.05);
}

} // namespace detail

inline constexpr std::array size_steps{0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, HUGE_VAL};
inline constexpr double material_size = 3; ///< clouds; from here on a single effect has to be named

/// Whether a machine tests what is asked of the diagnosis: one without an effect, or whose only effect has two
/// clouds, each of two effects three. What is smaller than the owner's tolerances may stay within them.
inline bool asks_for_an_answer(const judgement& j) {
    return j.kind == "none" || j.size >= (j.kind == "pair" ? 3 : 2);
}

inline ordered_json tally(const std::vector<judged_machine>& all) {
    using detail::share;
    std::map<std::string, share> by_kind;
    share single_material, asked, box, coverage, forecast;
    std::map<std::string, share> coverage_by_key, single_by_effect;
    std::map<std::string, std::map<std::string, std::size_t>> confusion;
    std::size_t free = 0, blamed = 0, unanswered = 0;
    struct bin {
        std::size_t of = 0, right = 0;
        double sum = 0;
    };
    std::array<bin, 10> bins{};
    struct step {
        std::size_t of = 0, named = 0, silent = 0, another = 0;
    };
    std::array<step, size_steps.size() - 1> steps{};
    double brier = 0;
    std::size_t causes = 0;
    std::vector<std::pair<double, bool>> every_cause;
    ordered_json cases = ordered_json::array();

    for (const auto& [j, shrink] : all) {
        by_kind[j.kind].add(j.right);
        if (asks_for_an_answer(j)) asked.add(j.right);
        unanswered += !j.answered;
        if (j.kind == "none") ++free, blamed += j.blamed_falsely;
        if (j.kind == "single") {
            if (j.size >= material_size) single_material.add(j.right), single_by_effect[j.truth].add(j.right);
            for (std::size_t k = 0; k + 1 < size_steps.size(); ++k)
                if (j.size >= size_steps[k] && j.size < size_steps[k + 1]) {
                    ++steps[k].of;
                    steps[k].named += j.outcome == found::named;
                    steps[k].silent += j.outcome == found::silent;
                    steps[k].another += j.outcome == found::another;
                }
        }
        if (j.box && (j.size >= material_size || j.kind == "poor_excitation")) box.add(*j.box);
        ++confusion[j.truth][j.first];
        for (const auto& [p, right] : j.named) {
            bin& b = bins[std::min<std::size_t>(9, static_cast<std::size_t>(p * 10))];
            ++b.of, b.right += right, b.sum += p;
            brier += (p - right) * (p - right);
            ++causes;
            every_cause.emplace_back(p, right);
        }
        for (const judged_parameter& p : j.parameters)
            coverage.add(p.covered()), coverage_by_key[p.key].add(p.covered());
        if (shrink) forecast.add(std::abs(shrink->forecast - shrink->achieved) <= 0.10);
        ordered_json c{{"index", j.index}, {"kind", j.kind},   {"truth", j.truth},
                       {"size", j.size},   {"right", j.right}, {"said", j.said}};
        if (j.box) c["box_right"] = *j.box;
        for (const judged_parameter& p : j.parameters)
            c["parameters"].push_back(
                {{"key", p.key}, {"truth", p.truth}, {"value", p.value}, {"ci95", {p.low, p.high}}});
        if (shrink) c["shrink"] = {{"forecast", shrink->forecast}, {"achieved", shrink->achieved}};
        cases.push_back(std::move(c));
    }

    ordered_json out;
    for (const auto& [name, s] : by_kind) out["top1"][name] = s.json();
    out["top1"]["single_from_3_clouds"] = single_material.json();
    out["top1"]["from_2_clouds"] = asked.json();
    for (const auto& [name, s] : single_by_effect) out["top1_by_effect_from_3_clouds"][name] = s.json();
    out["box"] = box.json();
    out["false_blame"] = {{"blamed", blamed}, {"of", free}, {"upper95", detail::upper_bound(blamed, free)}};
    out["unanswered"] = unanswered;
    for (std::size_t k = 0; k < steps.size(); ++k)
        out["detection"].push_back({{"from_clouds", size_steps[k]},
                                    {"of", steps[k].of},
                                    {"named", steps[k].named},
                                    {"silent", steps[k].silent},
                                    {"another", steps[k].another}});
    out["coverage"] = coverage.json();
    for (const auto& [key, s] : coverage_by_key) out["coverage"]["by_key"][key] = s.json();
    out["calibration"]["brier"] = causes ? brier / static_cast<double>(causes) : 0;
    out["calibration"]["causes"] = causes;
    for (std::size_t k = 0; k < bins.size(); ++k)
        if (bins[k].of > 0)
            out["calibration"]["bins"].push_back(
                {{"from", 0.1 * static_cast<double>(k)},
                 {"of", bins[k].of},
                 {"said", bins[k].sum / static_cast<double>(bins[k].of)},
                 {"right", static_cast<double>(bins[k].right) / static_cast<double>(bins[k].of)}});
    const recalibration line = recalibrate(every_cause);
    out["calibration"]["slope"] = {{"value", line.slope},
                                   {"ci95", {line.slope_95.first, line.slope_95.second}}};
    out["calibration"]["offset"] = {{"value", line.offset},
                                    {"ci95", {line.offset_95.first, line.offset_95.second}}};
    out["forecast_within_10_points"] = forecast.json();
    for (const auto& [truth, said] : confusion)
        for (const auto& [name, n] : said) out["confusion"][truth][name] = n;
    out["cases"] = std::move(cases);
    return out;
}

} // namespace quadrant_gap::trial
