// SPDX-License-Identifier: BSL-1.0
// Long: sentence_of_a_linear_axis() has one sentence for each thing that can be said first.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "number_words.hpp"
#include "quadrant/diagnosis/effect/effect_list.hpp"
#include "quadrant/diagnosis/fit/scoring.hpp"
#include "quadrant/diagnosis/result/result.hpp"
#include "quadrant/diagnosis/result/words.hpp"

/// A diagnosis in the words of a machine-tool engineer: names, numbers with units, verdict sentences.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

// ---- names ----

inline std::string spaced(std::string_view name) {
    std::string text(name);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '_' || c == '.'; }, ' ');
    return text;
}

/// An effect in words; one that is not of the list keeps its name.
inline std::string name_of_effect(std::string_view name) {
    const effect* e = effect_named(name);
    return e ? std::string(e->label) : spaced(name);
}

inline std::string capital(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

/// "a", "a and b", "a, b and c".
inline std::string listed(const std::vector<std::string>& items, std::string_view last = "and") {
    std::string text;
    for (std::size_t k = 0; k < items.size(); ++k)
        text += (k == 0 ? "" : k + 1 == items.size() ? fmt::format(" {} ", last) : ", ") + items[k];
    return text;
}

inline std::string named(const std::vector<std::string>& effects, std::string_view last) {
    std::vector<std::string> names;
    for (const std::string& e : effects) names.push_back(name_of_effect(e));
    return listed(names, last);
}

/// A machine key without its unit in words: names of people are capital, and a friction is called one.
inline std::string words_of_stem(std::string_view stem) {
    std::string text = spaced(stem);
    for (const auto& [key, word] :
         {std::pair{"stribeck", "Stribeck"}, {"coulomb", "Coulomb"}, {"gms ", "GMS "}})
        if (text.starts_with(key)) text.replace(0, std::string_view(key).size(), word);
    if (text == "Coulomb" || text == "static" || text == "viscous") text += " friction";
    return text;
}

/// A machine key as label and SI unit: "stribeck_velocity_m_per_s" is {"Stribeck velocity", "m/s"}.
inline std::pair<std::string, std::string> label_of(std::string_view key) {
    const auto [stem, unit] = parts_of(key);
    const machine_key* known = key_named(key);
    const std::string shown = known && known->percent   ? "%"
                              : stem.ends_with("phase") ? "phase"
                                                        : unit_text(unit);
    return {words_of_stem(stem), shown};
}

/// How a result speaks of one axis: in its own words, and in the unit of its command.
struct axis_voice {
    axis_kind kind = axis_kind::linear;
    std::string command_unit = "V";

    std::string operator()(std::string_view of_a_linear_axis) const { return text_of(of_a_linear_axis, kind); }
    /// Keys name volts whatever the command is in.
    std::string in_command_unit(std::string_view unit) const {
        std::string text(unit);
        if (const auto volt = text.find('V'); volt != text.npos && command_unit != "V")
            text.replace(volt, 1, command_unit == "Nm" ? "N m" : command_unit);
        return text;
    }
};

inline axis_voice voice_of(const axis_result& a) { return {a.kind, a.command_unit}; }
inline axis_voice voice_of(const diagnosis_result& d, const std::string& axis) {
    for (const axis_result& a : d.axes)
        if (a.name == axis) return voice_of(a);
    return {};
}

/// "Coulomb friction: 20.3 N (19.9 to 20.7)"; one line a harmonic.
inline std::vector<std::string> lines_of(const parameter_estimate& p, const axis_voice& voice = {}) {
    const auto [label, volts] = label_of(p.key);
    const std::string unit = voice.in_command_unit(volts);
    std::vector<std::string> lines;
    for (std::size_t k = 0; k < p.values.size(); ++k) {
        const std::string harmonic = p.values.size() > 1 ? fmt::format(" {}", k + 1) : "";
        lines.push_back(fmt::format("{}{}: {}", label, harmonic, interval(p.values[k], unit)) +
                        (p.on_bound ? "; at the end of what was searched, it may lie beyond" : ""));
    }
    return lines;
}

inline std::vector<std::string> lines_of(const std::vector<parameter_estimate>& parameters,
                                         const axis_voice& voice) {
    std::vector<std::string> lines;
    for (const parameter_estimate& p : parameters)
        for (std::string& line : lines_of(p, voice)) lines.push_back(std::move(line));
    return lines;
}

// ---- sentences ----

/// What is added to a command, in the unit of its axis.
inline std::string waveform_in_words(const diagnosis_result& d, const cause& c) {
    return in_words(*c.waveform, voice_of(d, c.axis).in_command_unit("V"));
}

/// "cogging", or "a or b" when the record does not say which.
inline std::string claim(const cause& c) {
    if (c.probability >= 0.5) return name_of_effect(c.effect);
    std::vector<std::string> names{c.effect};
    names.insert(names.end(), c.confusable_with.begin(), c.confusable_with.end());
    return named(names, "or");
}

namespace detail {
/// suspect: the nearest one, or none. before, floor: of the gap.
inline std::string sentence_without_a_claim(const axis_result& a, const cause* suspect,
                                            const std::string& before, const std::string& floor) {
    const bool takes_most = suspect && suspect->shrink.value > 0.5;
    const char* nothing = a.cut        ? "The time was up before a known effect explained"
                          : takes_most ? "No known effect surely explains"
                                       : "No known effect explains";
    const std::string unit = a.positions_only ? "" : " of force";
    // Calibration alone took the rest: a suspect would have its share of it.
    if (!suspect && !a.positions_only && a.gap_after.force_rms_N < 0.8 * a.gap.force_rms_N)
        return fmt::format(
            "{} what calibration leaves of the gap of axis {}: {} of {}{}, where sensor noise and "
            "rounding leave {}.",
            nothing, a.name, quantity_beside(a.gap.force_rms_N, a.gap_after.force_rms_N, "N"), before, unit,
            floor);
    std::string hint;
    if (suspect) {
        const std::string name = claim(*suspect), odds = probability(suspect->probability);
        hint = takes_most
                   ? fmt::format("; with the nearest suspect, {} (probability {}), it shrinks by {:.0f} %",
                                 name, odds, 100 * suspect->shrink.value)
                   : fmt::format("; the nearest suspect is {} (probability {})", name, odds);
    }
    return fmt::format("{} the gap of axis {}: {}{} where sensor noise and rounding leave {}{}.", nothing,
                       a.name, before, unit, floor, hint);
}

/// What calibration does to a gap inside the tolerances, in words.
inline std::string left_by_calibration(const axis_result& a) {
    constexpr double closed = 1.5; // of the floor
    const bool stops = std::any_of(a.calibrated.begin(), a.calibrated.end(),
                                   [](const parameter_estimate& p) { return p.on_bound; });
    if (a.positions_only || !(a.gap_after.force_rms_N > closed * a.gap_after.noise_floor_force_rms_N))
        return stops
                   ? "calibrate its values; some of them stop at the end of their tolerance and may lie beyond "
                     "it (see the notes)"
                   : "calibrate its values, nothing is missing";
    constexpr double nothing = 0.9; // of the gap, that is taken off
    const bool helps = a.gap_after.force_rms_N < nothing * a.gap.force_rms_N;
    return fmt::format(
        "{}: a cause shows once mass, force constant and friction are known better",
        helps
            ? fmt::format(
                  "calibrate its values; that leaves {}, by which machines inside these tolerances may differ",
                  quantity(a.gap_after.force_rms_N, "N"))
            : "calibrating its values takes little of it off, but machines within them may differ by as much");
}

inline std::string sentence_of_a_linear_axis(const diagnosis_result& d, const axis_result& a) {
    const std::string before = a.positions_only ? quantity(a.gap.position_rms_m, "m")
                                                : quantity(a.gap.force_rms_N, "N"),
                      floor = a.positions_only
                                  ? quantity_beside(a.gap.position_rms_m, a.gap.noise_floor_position_rms_m, "m")
                                  : quantity_beside(a.gap.force_rms_N, a.gap.noise_floor_force_rms_N, "N"),
                      gap = a.positions_only ? "position gap" : "force gap";
    if (a.verdict == verdict::no_gap)
        return fmt::format("Simulation and machine agree on axis {}: the {} is {}, and sensor noise and "
                           "rounding alone leave {}.",
                           a.name, gap, before, floor);
    if (a.verdict == verdict::within_tolerance)
        return fmt::format("The {} of axis {}, {} (floor {}), lies within the tolerances of the machine file: "
                           "{}.",
                           gap, a.name, before, floor, left_by_calibration(a));
    std::vector<std::string> missing, wrong;
    std::string added; // to a command: the simulation lacks nothing
    const cause *suspect = nullptr, *first = nullptr, *last = nullptr, *last_of_positions = nullptr;
    for (const cause& c : d.causes) {
        if (c.axis != a.name) continue;
        if (claimed(c)) {
            if (c.waveform)
                added = waveform_in_words(d, c);
            else
                (c.described ? wrong : missing).push_back(claim(c));
            if (!first) first = &c;
            last = &c;
            if (c.gap_before_force_rms_N.value == 0) last_of_positions = &c;
        } else if (!suspect) {
            suspect = &c;
        }
    }
    if (!first) return sentence_without_a_claim(a, suspect, before, floor);
    const auto are = [](const auto& names) { return names.size() > 1 ? "are" : "is"; };
    std::string what;
    if (!missing.empty())
        what = fmt::format("{} {} missing from the simulation of axis {}", capital(listed(missing)),
                           are(missing), a.name);
    if (!wrong.empty())
        what += fmt::format("{} {}{} {} not as the machine file says", missing.empty() ? "The" : ", and the",
                            listed(wrong), missing.empty() ? " of axis " + a.name : "", are(wrong));
    if (!added.empty())
        what = what.empty() ? fmt::format("{} of axis {}", capital(added), a.name)
                            : fmt::format("{}, and {}", what, added);
    const char* rest = a.verdict == verdict::partly_explained ? ", but part of the gap stays unexplained"
                       : a.verdict == verdict::unexplained    ? ", but most of the gap stays unexplained"
                                                              : "";
    // The numbers are those of what is claimed, not of the suspects behind it.
    if (first->gap_before_force_rms_N.value == 0) { // two positions were compared
        const double from = first->gap_before_position_rms_m.value;
        return fmt::format("{}: {} {}, the difference of the positions shrinks from {} to {}{}.", what, "with",
                           first != last ? "them" : "it", quantity(from, "m"),
                           quantity_beside(from, last_of_positions->gap_after_position_rms_m.value, "m"), rest);
    }
    const double from = first->gap_before_force_rms_N.value;
    return fmt::format("{}: {} {}, the force gap shrinks from {} to {} (floor {}){}.", what,
                       first->waveform ? "without" : "with", first != last ? "them" : "it", quantity(from, "N"),
                       quantity_beside(from, last->gap_after_force_rms_N.value, "N"),
                       quantity_beside(from, a.gap.noise_floor_force_rms_N, "N"), rest);
}

} // namespace detail

/// "Coulomb friction is missing from the simulation of axis x: with it, ..."
inline std::string sentence(const diagnosis_result& d, const axis_result& a) {
    return voice_of(a)(detail::sentence_of_a_linear_axis(d, a));
}

/// The sentence of the worst axis.
inline std::string verdict_sentence(const diagnosis_result& d) {
    const auto worst =
        std::max_element(d.axes.begin(), d.axes.end(),
                         [](const axis_result& a, const axis_result& b) { return a.verdict < b.verdict; });
    return worst == d.axes.end() ? "The log has no axis." : sentence(d, *worst);
}

} // namespace quadrant_gap
