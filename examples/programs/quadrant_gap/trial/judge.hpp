// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant/diagnosis/effect/effect_list.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// What was said of one machine beside what is true of it, judged as gap/check.py judges. Pure functions of two
/// files.
namespace quadrant_gap::trial {

using nlohmann::ordered_json;

enum class found { named, silent, another }; ///< the effect itself, no claim at all, a claim for something else

struct judged_parameter {
    std::string effect, key;
    double truth = 0, value = 0, low = 0, high = 0;
    bool covered() const { // a count is known exactly: the interval has no width
        const double rounding = 1e-6 * std::abs(truth);
        return low - rounding <= truth && truth <= high + rounding;
    }
};

struct judgement {
    std::size_t index = 0;
    std::string kind, truth, said;
    bool answered = false, right = false, blamed_falsely = false;
    std::optional<bool> box;
    double size = 0; ///< of the only effect; of the smaller of two
    found outcome = found::silent;
    std::vector<std::pair<double, bool>> named; ///< probability of each listed cause, and whether it is there
    std::vector<judged_parameter> parameters;   ///< of causes that are there
    std::string first; ///< what a confusion matrix enters: the first claim, or the verdict
};

/// Names that are one model on most records (docs/formats.md, known equivalences).
inline bool same_model(const std::string& said, const std::string& true_name) {
    if (said == true_name) return true;
    const auto pair = [&](const char* a, const char* b) {
        return (said == a && true_name == b) || (said == b && true_name == a);
    };
    return pair("mass", "force_constant") || pair("constant_force", "asymmetric_friction") ||
           pair("drive_gain", "supply_voltage") || pair("drive_gain", "force_constant") ||
           pair("supply_voltage", "force_constant");
}

inline std::string_view box_of(const std::string& effect) {
    const auto* e = quadrant::diagnosis::effect_named(effect);
    return e ? e->box : std::string_view("mechanics");
}

namespace detail {

struct cause_view {
    std::string axis, effect;
    double probability = 1, group_probability = 1;
    std::vector<std::string> confusable;
    const ordered_json* whole = nullptr;
};

inline std::vector<cause_view> causes_of(const ordered_json& d) {
    std::vector<cause_view> out;
    for (const ordered_json& c : d.value("causes", ordered_json::array()))
        out.push_back({c.value("axis", "x"), c.value("effect", ""), c.value("probability", 1.0),
                       c.value("group_probability", c.value("probability", 1.0)),
                       c.value("confusable_with", std::vector<std::string>{}), nullptr});
    if (const auto list = d.find("causes"); list != d.end())
        for (std::size_t k = 0; k < out.size(); ++k) out[k].whole = &(*list)[k];
    return out;
}

/// A wave that repeats along the travel may be found with a multiple of its period: its harmonic n of that is
/// the same wave. The n of this cause; 1: the period itself, or none.
inline std::size_t harmonic_of(const ordered_json& effect, const ordered_json& found) {
    for (const auto& [key, value] : effect.at("parameters").items()) {
        if (key.find("_period_") == key.npos || !value.is_number() || !found.contains(key)) continue;
        const ordered_json& period = found.at(key).at("value");
        if (!period.is_number() || !(value.get<double>() > 0)) continue;
        const double ratio = period.get<double>() / value.get<double>(), n = std::round(ratio);
        if (n >= 2 && std::abs(ratio / n - 1) < 0.02) return static_cast<std::size_t>(n);
    }
    return 1;
}

inline void judge_parameters(judgement& j, const ordered_json& effect, const cause_view& c) {
    const auto parameters = c.whole->find("parameters");
    if (parameters == c.whole->end() || c.effect != effect.at("effect")) return;
    const std::size_t n = harmonic_of(effect, *parameters);
    for (const auto& [key, value] : effect.at("parameters").items()) {
        const auto given = parameters->find(key);
        if (!value.is_number() || given == parameters->end()) continue;
        const ordered_json &estimated = given->at("value"), &interval = given->at("ci95");
        const bool list = estimated.is_array(); // harmonics: the one with the true period is compared
        if (list && estimated.size() < n) continue;
        const ordered_json& ends = list ? interval.at(n - 1) : interval;
        if (!ends.is_array() || !ends.at(0).is_number() || !ends.at(1).is_number()) continue;
        const double by = key.find("_period_") == key.npos ? 1 : 1 / static_cast<double>(n);
        const double v = list ? estimated.at(n - 1).get<double>() : by * estimated.get<double>();
        j.parameters.push_back({c.effect, key, value.get<double>(), v, by * ends.at(0).get<double>(),
                                by * ends.at(1).get<double>()});
    }
}

/// Names what is true of the machine, and returns the effects that are to be named.
inline std::vector<std::string> wanted(judgement& j, const ordered_json& truth) {
    std::vector<std::string> want;
    j.index = truth.at("index");
    j.kind = truth.at("kind");
    j.size = HUGE_VAL;
    for (const ordered_json& e : truth.at("effects")) {
        want.push_back(e.at("effect"));
        j.size = std::min(j.size, e.at("size").is_number() ? e.at("size").get<double>() : HUGE_VAL);
        j.truth += (j.truth.empty() ? "" : "+") + want.back();
        if (want.back() == "unknown") j.truth = e.at("parameters").at("unknown");
    }
    if (want.empty()) j.truth = "none", j.size = 0;
    if (j.kind == "removed") j.truth += " (removed)";
    return want;
}

inline bool is(const cause_view& c, const std::string& name) {
    return c.axis == "x" && same_model(c.effect, name);
}

/// Of at least 0.5; a group whose names are one model is a claim as a whole.
inline bool claimed(const cause_view& c) {
    const bool one_model = std::all_of(c.confusable.begin(), c.confusable.end(),
                                       [&](const std::string& n) { return same_model(c.effect, n); });
    return c.probability >= 0.5 || (one_model && c.group_probability >= 0.5);
}

/// What a diagnosis of this kind of machine has to say. `wrong`: claims of what is not there.
inline bool right(const std::string& kind, const std::vector<std::string>& want, const std::string& verdict,
                  const std::vector<cause_view>& causes, const std::vector<cause_view>& wrong, bool silent) {
    if (kind == "none") return silent && (verdict == "no_gap" || verdict == "within_tolerance");
    if (kind == "unknown" || kind == "removed")
        return silent && (verdict == "unexplained" || verdict == "partly_explained");
    if (kind == "single")
        return !causes.empty() && is(causes[0], want[0]) && verdict == "explained" && wrong.empty();
    if (kind == "pair")
        return causes.size() >= 2 && verdict == "explained" && wrong.empty() &&
               std::all_of(want.begin(), want.end(),
                           [&](const std::string& w) { return is(causes[0], w) || is(causes[1], w); });
    // Poor excitation: a small group that holds the truth, and no claim outside it.
    if (causes.empty()) return false;
    std::vector<std::string> group = causes[0].confusable;
    group.insert(group.begin(), causes[0].effect);
    const bool holds =
        std::any_of(group.begin(), group.end(), [&](const std::string& n) { return same_model(n, want[0]); });
    const bool outside = std::any_of(wrong.begin(), wrong.end(), [&](const cause_view& c) {
        return std::find(group.begin(), group.end(), c.effect) == group.end();
    });
    return holds && group.size() <= 3 && !outside;
}

/// Whether the first place of an axis is the box of the effect, with what docs/formats.md lets pass.
inline bool right_box(const ordered_json& said, const std::string& effect) {
    const ordered_json axes = said.value("axes", ordered_json::object());
    for (const ordered_json& axis : axes) {
        const auto places = axis.find("where");
        if (places == axis.end() || places->empty()) continue;
        std::string block = (*places)[0].value("block", "");
        if (block.empty()) // behind the command nothing is wrong: what two encoders say
            for (const ordered_json& place : *places)
                if (block.empty() && place.value("view", "") == "readings") block = place.value("block", "");
        for (const std::string& w : {effect, std::string(effect == "mass" ? "force_constant" : effect),
                                     std::string(effect == "force_constant" ? "mass" : effect)})
            if (block == box_of(w)) return true;
        if (effect == "cogging" && block == "actuator") return true;
    }
    return false;
}

} // namespace detail

/// `said` is null when the program wrote no diagnosis.
inline judgement judge(const ordered_json& truth, const ordered_json& said) {
    judgement j;
    const std::vector<std::string> want = detail::wanted(j, truth);
    const bool one = j.kind == "single" || j.kind == "poor_excitation";
    if (!said.is_object()) {
        j.said = j.first = "no answer";
        if (one) j.box = false;
        return j;
    }
    j.answered = true;
    const auto causes = detail::causes_of(said);
    const std::string verdict = said.value("verdict", "");
    const auto there = [&](const detail::cause_view& c) {
        return std::any_of(want.begin(), want.end(), [&](const std::string& w) { return detail::is(c, w); });
    };
    j.said = verdict;
    std::vector<detail::cause_view> claims, wrong;
    for (const auto& c : causes) {
        j.named.emplace_back(c.probability, there(c));
        char text[96];
        std::snprintf(text, sizeof text, " %s %.2f", c.effect.c_str(), c.probability);
        j.said += text;
        if (c.axis != "x") j.said += " on " + c.axis;
        if (detail::claimed(c)) claims.push_back(c);
    }
    std::copy_if(claims.begin(), claims.end(), std::back_inserter(wrong),
                 [&](const detail::cause_view& c) { return !there(c); });
    j.blamed_falsely = !wrong.empty();
    j.first = claims.empty() ? verdict : claims.front().effect;
    if (!claims.empty())
        j.outcome = std::any_of(claims.begin(), claims.end(), there) ? found::named : found::another;
    j.right = detail::right(j.kind, want, verdict, causes, wrong, claims.empty());
    if (one) j.box = detail::right_box(said, want[0]);
    for (const ordered_json& e : truth.at("effects"))
        for (const auto& c : causes)
            if (c.axis == "x" && c.probability >= 0.5) detail::judge_parameters(j, e, c);
    return j;
}

/// How far the gap in force shrinks on another log of another motion: forecast from its reference, and achieved
/// on what the machine recorded.
struct shrink_pair {
    double forecast = 0, achieved = 0;
};

/// Something is claimed: a cause of one half or more.
inline bool claims(const ordered_json& said) {
    if (!said.is_object()) return false;
    const auto causes = detail::causes_of(said);
    return std::any_of(causes.begin(), causes.end(), [](const auto& c) { return c.probability >= 0.5; });
}

/// Shrink of the axis with the effects, as `forecast --json` writes it.
inline std::optional<double> forecast_shrink(const ordered_json& forecast) {
    if (!forecast.is_object()) return std::nullopt;
    const ordered_json shrink = forecast.value(ordered_json::json_pointer("/axes/x/shrink"), ordered_json());
    return shrink.is_number() ? std::optional(shrink.get<double>()) : std::nullopt;
}

/// Residual force of the axis with the effects, as `simulate --json` writes it.
inline std::optional<double> remaining_force(const ordered_json& simulated) {
    if (!simulated.is_object()) return std::nullopt;
    const ordered_json force =
        simulated.value(ordered_json::json_pointer("/axes/x/gap/force_rms_N"), ordered_json());
    return force.is_number() ? std::optional(force.get<double>()) : std::nullopt;
}

} // namespace quadrant_gap::trial
