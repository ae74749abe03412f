// SPDX-License-Identifier: BSL-1.0
// Long: the vocabulary of all pages and of the terminal, one table after the other;
// Long: sentence_of_a_linear_axis() has one sentence for each thing that can be said first.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "quadrant/diagnosis/effect/effect_list.hpp"
#include "quadrant/diagnosis/fit/scoring.hpp"
#include "quadrant/diagnosis/result/result.hpp"
#include "quadrant/diagnosis/result/words.hpp"

/// A diagnosis in the words of a machine-tool engineer: names, numbers with units, verdict sentences.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

// ---- numbers ----

inline std::string fixed(double value, int decimals) {
    if (!std::isfinite(value)) return "-";
    const double step = std::pow(10.0, -decimals);
    return fmt::format("{:.{}f}", std::round(value / step) * step + 0.0,
                       std::max(decimals, 0)); // + 0.0: no "-0"
}

/// As many decimals as a gap deserves: 124, 20.7, 2.4, 0.92, 0.0031.
inline std::string number(double value) {
    const double size = std::abs(value);
    if (size == 0 || size >= 100) return fixed(value, 0);
    return fixed(value, size >= 1 ? 1 : std::min(6, 1 - static_cast<int>(std::floor(std::log10(size)))));
}

struct scale {
    double factor;
    std::string_view unit;
};

/// The unit in which a value of this size is read: 2.5e-6 m is 2.5 um.
inline scale scale_of(std::string_view unit, double size) {
    struct step {
        std::string_view unit;
        double from;
        scale shown;
    };
    static constexpr step steps[] = {
        {"m", 1, {1, "m"}},
        {"m", 1e-3, {1e3, "mm"}},
        {"m", 1e-7, {1e6, "µm"}},
        {"m", 1e-12, {1e9, "nm"}},
        {"m/s", 1, {1, "m/s"}},
        {"m/s", 1e-3, {1e3, "mm/s"}},
        {"m/s", 1e-9, {1e6, "µm/s"}},
        {"s", 1, {1, "s"}},
        {"s", 1e-4, {1e3, "ms"}},
        {"s", 1e-9, {1e6, "µs"}},
        {"N", 1e4, {1e-3, "kN"}},
        {"N", 0.05, {1, "N"}},
        {"N", 1e-6, {1e3, "mN"}},
        {"V", 0.1, {1, "V"}},
        {"V", 1e-6, {1e3, "mV"}},
        {"N/m", 1e6, {1e-6, "N/µm"}},
        {"rad", 1, {1, "rad"}},
        {"rad", 1e-3, {1e3, "mrad"}},
        {"rad", 1e-7, {1e6, "µrad"}},
        {"rad", 1e-12, {1e9, "nrad"}},
        {"rad/s", 1, {1, "rad/s"}},
        {"rad/s", 1e-3, {1e3, "mrad/s"}},
        {"rad/s", 1e-9, {1e6, "µrad/s"}},
        {"N m", 1e4, {1e-3, "kN m"}},
        {"N m", 0.05, {1, "N m"}},
        {"N m", 1e-6, {1e3, "mN m"}},
        {"N m/rad", 1e6, {1e-6, "N m/µrad"}},
        {"phase", 0, {57.29577951308232, "deg"}},
        {"%", 0, {100, "%"}},
    };
    for (const step& s : steps)
        if (s.unit == unit && std::abs(size) >= s.from) return s.shown;
    return {1, unit};
}

inline std::string with_unit(std::string text, std::string_view unit) {
    return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

inline std::string quantity(double value, std::string_view unit) {
    const scale s = scale_of(unit, value);
    return with_unit(number(value * s.factor), s.unit);
}

/// "20.7 → 2.4 N", both in the unit of the larger.
inline std::string change(double before, double after, std::string_view unit) {
    const scale s = scale_of(unit, std::max(std::abs(before), std::abs(after)));
    return fmt::format("{} → {} {}", number(before * s.factor), number(after * s.factor), s.unit);
}

/// "20.3 N (19.9 to 20.7)": the digits are those that the 95 % interval leaves.
inline std::string interval(const estimate& e, std::string_view unit) {
    if (!(e.high > e.low)) return quantity(e.value, unit);
    const scale s = scale_of(unit, std::max({std::abs(e.value), std::abs(e.low), std::abs(e.high)}));
    const double half_width = (e.high - e.low) * s.factor / 2;
    const int decimals = std::min(9, -static_cast<int>(std::floor(std::log10(half_width / 1.999))));
    return fmt::format("{} ({} to {})", with_unit(fixed(e.value * s.factor, decimals), s.unit),
                       fixed(e.low * s.factor, decimals), fixed(e.high * s.factor, decimals));
}

inline std::string percent(double share) { return fmt::format("{} %", fixed(100 * share, 0)); }

inline std::string percent(const estimate& e) {
    if (!(e.high > e.low)) return percent(e.value);
    return fmt::format("{} ({} to {})", percent(e.value), fixed(100 * e.low, 0), fixed(100 * e.high, 0));
}

/// A probability is never said to be 0 or 1.
inline std::string probability(double p) {
    if (p > 0.99) return "> 99 %";
    if (p < 0.01) return "< 1 %";
    return percent(p);
}

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

/// A machine key as label and SI unit: "stribeck_velocity_m_per_s" is {"stribeck velocity", "m/s"}.
inline std::pair<std::string, std::string> label_of(std::string_view key) {
    const auto [stem, unit] = parts_of(key);
    const machine_key* known = key_named(key);
    const std::string shown = known && known->percent   ? "%"
                              : stem.ends_with("phase") ? "phase"
                                                        : unit_text(unit);
    return {spaced(stem), shown};
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

/// "coulomb: 20.3 N (19.9 to 20.7)"; one line a harmonic.
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
inline std::string sentence_of_a_linear_axis(const diagnosis_result& d, const axis_result& a) {
    const std::string before = a.positions_only ? quantity(a.gap.position_rms_m, "m")
                                                : quantity(a.gap.force_rms_N, "N"),
                      floor = a.positions_only ? quantity(a.gap.noise_floor_position_rms_m, "m")
                                               : quantity(a.gap.noise_floor_force_rms_N, "N"),
                      gap = a.positions_only ? "position gap" : "force gap";
    if (a.verdict == verdict::no_gap)
        return fmt::format("Simulation and machine agree on axis {}: the {} is {}, and sensor noise and "
                           "rounding alone leave {}.",
                           a.name, gap, before, floor);
    if (a.verdict == verdict::within_tolerance)
        return fmt::format("The {} of axis {}, {} (floor {}), lies within the tolerances of the machine file: "
                           "calibrate its values, nothing is missing.",
                           gap, a.name, before, floor);
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
    if (a.verdict == verdict::unexplained || !first) {
        const std::string hint = !suspect ? ""
                                          : fmt::format("; the nearest suspect is {} (probability {})",
                                                        claim(*suspect), probability(suspect->probability));
        return fmt::format("{} the gap of axis {}: {}{} remain where sensor noise and rounding leave {}{}.",
                           a.cut ? "The time was up before a known effect explained"
                                 : "No known effect explains",
                           a.name, before, a.positions_only ? "" : " of force", floor, hint);
    }
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
    // The numbers are those of what is claimed, not of the suspects behind it.
    if (first->gap_before_force_rms_N.value == 0) // two positions were compared
        return fmt::format("{}: {} {}, the difference of the positions shrinks from {} to {}{}.", what, "with",
                           first != last ? "them" : "it", quantity(first->gap_before_position_rms_m.value, "m"),
                           quantity(last_of_positions->gap_after_position_rms_m.value, "m"),
                           a.verdict == verdict::partly_explained ? ", but part of the gap stays unexplained"
                                                                  : "");
    return fmt::format("{}: {} {}, the force gap shrinks from {} to {} (floor {}){}.", what,
                       first->waveform ? "without" : "with", first != last ? "them" : "it",
                       quantity(first->gap_before_force_rms_N.value, "N"),
                       quantity(last->gap_after_force_rms_N.value, "N"), floor,
                       a.verdict == verdict::partly_explained ? ", but part of the gap stays unexplained" : "");
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

/// What the causes leave of the gap. In energy: 1 % of it is a tenth of the rms value.
inline std::string unexplained_share(const diagnosis_result& d) {
    if (!(d.share_unexplained > 0)) return "Nothing that matters.";
    return fmt::format("{} of the gap's energy (the square of its rms value) stays unexplained.",
                       d.share_unexplained < 0.005 ? "Less than 1 %" : percent(d.share_unexplained));
}

inline std::string experiment_gain(const experiment& e) {
    if (e.expected_gain <= 0) return "";
    const double score = e.expected_gain / score_temperature; // as the probabilities are weighed
    return fmt::format("Expected to separate them by a log-score of {} or more, odds of {} to 1.",
                       number(e.expected_gain), score > 7 ? "more than 1000" : number(std::exp(score)));
}

/// What is said below the motion, a sentence a line.
inline std::vector<std::string> experiment_lines(const experiment& e) {
    std::vector<std::string> out;
    if (!e.separates.empty() && !e.motion.starts_with("none"))
        out.push_back(fmt::format("{} {}{}.", e.expected_gain > 0 ? "It separates" : "It is meant to separate",
                                  named(e.separates, "and"), e.axis.empty() ? "" : ", axis " + e.axis));
    if (e.expected_gain > 0) out.push_back(experiment_gain(e));
    if (!e.finding.empty()) out.push_back(capital(e.finding) + ".");
    return out;
}

inline bool closed_loop(const axis_result& a) { return !a.signals.simulated_position_before.empty(); }

struct gap_row {
    std::string name, before, after, floor;
};

/// The gap that a cause takes off, before and after: in force, or where two positions were compared, in
/// position.
inline std::string gap_of(const cause& c, const axis_voice& voice) {
    if (c.gap_before_force_rms_N.value == 0 && c.gap_before_position_rms_m.value > 0)
        return "position gap " +
               change(c.gap_before_position_rms_m.value, c.gap_after_position_rms_m.value, voice("m"));
    return voice("force") + " gap " +
           change(c.gap_before_force_rms_N.value, c.gap_after_force_rms_N.value, voice("N"));
}

/// In the order in which an engineer asks; a row is in the unit of its first number.
inline std::vector<gap_row> gap_rows(const axis_result& a) {
    const gap_numbers &b = a.gap, &c = a.gap_after;
    const axis_voice voice = voice_of(a);
    const auto row = [&](std::string_view name, double before, double after, const std::string& unit) {
        const scale s = scale_of(unit, before);
        return gap_row{voice(name), fmt::format("{} {}", number(before * s.factor), s.unit),
                       fmt::format("{} {}", number(after * s.factor), s.unit), ""};
    };
    if (a.positions_only) {
        std::vector<gap_row> of_positions{
            row("position, rms", b.position_rms_m, c.position_rms_m, voice("m")),
            row("position, peak", b.position_peak_m, c.position_peak_m, voice("m"))};
        of_positions[0].floor = quantity(b.noise_floor_position_rms_m, voice("m"));
        return of_positions;
    }
    std::vector<gap_row> rows{row("force, rms", b.force_rms_N, c.force_rms_N, voice("N"))};
    rows[0].floor = quantity(b.noise_floor_force_rms_N, voice("N"));
    if (!closed_loop(a)) return rows;
    rows.push_back(row("position, rms", b.position_rms_m, c.position_rms_m, voice("m")));
    rows.push_back(row("position, peak", b.position_peak_m, c.position_peak_m, voice("m")));
    rows.push_back(row("command, rms", b.command_rms_V, c.command_rms_V, voice.in_command_unit("V")));
    return rows;
}

inline std::string gap_basis(const axis_result& a) {
    if (a.positions_only)
        return fmt::format("Difference of two positions, judged on {}. Nothing is known of forces.",
                           a.evaluated_on);
    return voice_of(a)("Residual force ") +
           fmt::format(
               "up to {}{}{}.{}", quantity(a.gap.bandwidth_Hz, "Hz"),
               a.evaluated_on.empty() ? "" : ", judged on ", a.evaluated_on,
               closed_loop(a) ? "" : " No closed loop was simulated: there are no position and command gaps.");
}

inline constexpr std::pair<std::string_view, std::string_view> views[] = {
    {"block", "by box of the loop"},
    {"readings", "between the two encoders"},
    {"velocity", "by velocity"},
    {"reversal", "at reversals"},
    {"position", "along the travel"},
    {"time", "in time"},
    {"frequency", "by frequency"},
    {"acceleration", "by acceleration"},
    {"other_axis", "by the motion of the other axis"},
};

} // namespace quadrant_gap
