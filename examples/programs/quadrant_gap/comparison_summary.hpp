// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "summary.hpp"

#include <quadrant/diagnosis/compare.hpp>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

/// A comparison of two logs in words, and as text for a terminal of 100 columns.
namespace quadrant_gap {

/// The machine that a log shows, where no machine file is given.
inline machine_description described_by(const machine_log& log) {
    const auto begun = machine_from_log(log);
    auto machine = read_machine(begun.machine.dump(), "what " + log.file + " says of its machine");
    machine.notes.push_back("There is no machine file: the description is what the first log says of its "
                            "machine; what both logs have beyond it is no difference.");
    for (const axis_log& a : log.axes)
        if (!is_force(a.command_unit))
            machine.notes.push_back(fmt::format(
                "axis {}: its force constant is not known, and counts as 1: forces and masses are in units of "
                "the command ({}), their ratios are right.",
                a.name, a.command_unit));
    return machine;
}

inline axis_voice voice_of(const compared_axis& a) { return {a.kind, a.command_unit}; }
inline axis_voice voice_of(const comparison_result& c, const std::string& axis) {
    for (const compared_axis& a : c.axes)
        if (a.name == axis) return voice_of(a);
    return {};
}

/// "cogging", or "cogging or force ripple".
inline std::string claim(const difference& d) {
    std::vector<std::string> names{d.effect};
    names.insert(names.end(), d.confusable_with.begin(), d.confusable_with.end());
    return named(names, "or");
}

/// Of one value in both logs: "Coulomb friction: 20.3 N (19.9 to 20.7) in the first, 24.1 N (23.8 to 24.4) in
/// the second".
inline std::vector<std::string> lines_of(const difference& d, const axis_voice& voice) {
    std::vector<std::string> out;
    const auto say = [&](const std::vector<parameter_estimate>& from, const std::string& key) {
        for (const parameter_estimate& p : from)
            if (p.key == key) return lines_of(p, voice);
        return std::vector<std::string>{};
    };
    std::vector<std::string> keys;
    for (const auto* values : {&d.first, &d.second})
        for (const parameter_estimate& p : *values)
            if (std::find(keys.begin(), keys.end(), p.key) == keys.end()) keys.push_back(p.key);
    for (const std::string& key : keys) {
        const auto one = say(d.first, key), other = say(d.second, key);
        for (std::size_t k = 0; k < std::max(one.size(), other.size()); ++k)
            out.push_back(fmt::format("{}; {}",
                                      k < one.size() ? "first log: " + one[k] : "first log: not there",
                                      k < other.size() ? "second log: " + other[k] : "second log: not there"));
    }
    return out;
}

inline std::string sentence(const comparison_result& c, const compared_axis& a) {
    const axis_voice voice = voice_of(a);
    const std::string force = voice("N"), other = a.found_in_second ? "second" : "first",
                      reference = a.found_in_second ? "first" : "second";
    std::vector<std::string> names, open;
    for (const difference& d : c.differences)
        if (d.axis == a.name) names.push_back(voice(claim(d)));
    for (const difference& d : c.undecided)
        if (d.axis == a.name) open.push_back(voice(claim(d)));
    switch (a.likeness) {
    case likeness::alike:
        return fmt::format(
            "The two logs of axis {} are of machines that are alike, within the tolerances{}.", a.name,
            a.force_common_N > 0
                ? fmt::format(": one model leaves {} of force in the one and {} in the other",
                              quantity(a.force_common_N, force), quantity(a.force_before_N, force))
                : "");
    case likeness::undecided:
        return fmt::format("Whether the two logs of axis {} differ cannot be said: the one shows {}, and the "
                           "other neither shows nor excludes it.",
                           a.name, listed(open));
    case likeness::differ: {
        // Of what is named, the largest gap before and the smallest after.
        const difference *most = nullptr, *least = nullptr;
        for (const difference& d : c.differences) {
            if (d.axis != a.name || !(d.gap_before_force_rms_N.value > 0)) continue;
            if (!most || d.gap_before_force_rms_N.value > most->gap_before_force_rms_N.value) most = &d;
            if (!least || d.gap_after_force_rms_N.value < least->gap_after_force_rms_N.value) least = &d;
        }
        return fmt::format("The two logs of axis {} differ by {}{}.", a.name, listed(names),
                           most ? fmt::format(": the force gap of the {} log to the machine of the {} is {}, "
                                              "and {} with {}",
                                              most->found_in_second ? "second" : "first",
                                              most->found_in_second ? "first" : "second",
                                              quantity(most->gap_before_force_rms_N.value, force),
                                              quantity(least->gap_after_force_rms_N.value, force),
                                              names.size() > 1 ? "these" : "this")
                                : "");
    }
    default:
        return fmt::format("The two logs of axis {} differ, and no known effect is the cause: the model of the "
                           "{} log leaves {} of force there and {} in the {} one, whose own model leaves {}.",
                           a.name, reference, quantity(a.force_common_N, force),
                           quantity(a.force_before_N, force), other, quantity(a.force_own_N, force));
    }
}

/// The sentence of the axis that differs most.
inline std::string sentence(const comparison_result& c) {
    const auto worst = std::max_element(c.axes.begin(), c.axes.end(),
                                        [](const auto& a, const auto& b) { return a.likeness < b.likeness; });
    return worst == c.axes.end() ? "The logs have no axis that moves in both." : sentence(c, *worst);
}

/// How far the two come together with a difference, in force and in position.
inline std::vector<std::string> gaps_of(const difference& d, const axis_voice& voice) {
    std::vector<std::string> gaps;
    if (d.gap_before_force_rms_N.value > 0)
        gaps.push_back(voice("force") + " gap " +
                       change(d.gap_before_force_rms_N.value, d.gap_after_force_rms_N.value, voice("N")));
    if (d.gap_before_position_rms_m.value > 0)
        gaps.push_back("position gap " +
                       change(d.gap_before_position_rms_m.value, d.gap_after_position_rms_m.value, voice("m")));
    if (gaps.empty()) gaps.emplace_back("no gap of force or position");
    return gaps;
}

inline std::string summary_of(const comparison_result& c, const difference& d, bool decided) {
    const axis_voice voice = voice_of(c, d.axis);
    std::string text =
        wrapped(fmt::format("{}, axis {}: probability {}{}", capital(voice(claim(d))), d.axis,
                            probability(d.probability), decided ? "" : "; the other log does not exclude it"),
                2);
    for (const std::string& line : lines_of(d, voice)) text += wrapped(line, 4);
    text += wrapped(
        fmt::format("{} log: {}", d.found_in_second ? "second" : "first", listed(gaps_of(d, voice))), 4);
    if (decided && d.gain > 0)
        text += wrapped(fmt::format("asked of both: log-score {} better with it, {} worse in the other log",
                                    number(d.gain), number(d.loss)),
                        4);
    if (const effect* known = effect_named(d.effect); known && !decided)
        text += wrapped(fmt::format("record in both: {}", voice(known->exciting_motion)), 4);
    return text;
}

/// Values inside the owner's tolerance in either log.
inline std::vector<std::string> calibrated_lines(const compared_axis& a) {
    difference values;
    values.first = a.first;
    values.second = a.second;
    for (auto* log : {&values.first, &values.second}) // how a contact that gives way is written says nothing
        std::erase_if(*log, [](const parameter_estimate& p) { return p.key.starts_with("gms"); });
    return lines_of(values, voice_of(a));
}

inline std::string summary(const comparison_result& c) {
    std::string text = wrapped(fmt::format("{}: {} beside {}, both against {}", capital(name_of(c.likeness)),
                                           c.first_file, c.second_file, c.machine_file),
                               0);
    for (const compared_axis& a : c.axes) text += wrapped(sentence(c, a), 0);
    text += wrapped("First log alone: " + verdict_sentence(c.first), 2) +
            wrapped("Second log alone: " + verdict_sentence(c.second), 2) + "\n";
    if (!c.differences.empty()) {
        text += "Differences\n";
        for (const difference& d : c.differences) text += summary_of(c, d, true);
        text += "\n";
    }
    if (!c.undecided.empty()) {
        text += "Not decided\n";
        for (const difference& d : c.undecided) text += summary_of(c, d, false);
        text += "\n";
    }
    for (const std::string& note : c.notes) text += wrapped("Note: " + note, 0);
    return text;
}

} // namespace quadrant_gap
