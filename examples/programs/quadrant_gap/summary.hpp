// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "gap_words.hpp"

/// A diagnosis as text for a terminal of 100 columns.
namespace quadrant_gap {

/// Columns that a UTF-8 text takes.
inline std::size_t columns(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

inline std::string padded(std::string text, std::size_t width) {
    const std::size_t used = columns(text);
    return used < width ? text.append(width - used, ' ') : text;
}

/// Lines of at most 100 columns, indented; longer words are cut and control characters (of file names) shown as
/// "?".
inline std::string wrapped(std::string text, std::size_t indent) {
    constexpr std::size_t width = 100;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == 127; }, '?');
    std::string out, line, word;
    const auto flush = [&] {
        if (!line.empty()) out += std::string(indent, ' ') + line + "\n";
        line.clear();
    };
    const auto place = [&] {
        if (!line.empty() && columns(line) + 1 + columns(word) > width - indent) flush();
        line += (line.empty() || word.empty() ? "" : " ") + word;
        word.clear();
    };
    for (const char c : text) {
        const bool starts_character = (c & 0xC0) != 0x80;
        if (c == ' ' || (starts_character && columns(word) == width - indent)) place();
        if (c != ' ') word += c;
    }
    place();
    flush();
    return out;
}

inline std::string summary_of(const diagnosis_result& d, const axis_result& a) {
    std::string text = wrapped(fmt::format("Axis {}: {}", a.name, spaced(name_of(a.verdict))), 0);
    if (d.axes.size() > 1) text += wrapped(sentence(d, a), 2);
    text += wrapped(gap_basis(a), 2);
    const auto row = [](std::string_view name, std::string_view before, std::string_view after,
                        std::string_view floor) {
        std::string line = "  " + padded(std::string(name), 18) + padded(std::string(before), 12) +
                           padded(std::string(after), 12);
        line += floor;
        return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    };
    text += row("gap", "before", "after", "floor");
    for (const gap_row& r : gap_rows(a)) text += row("  " + r.name, r.before, r.after, r.floor);
    std::size_t shares = 14; // the widest of them; the text begins two columns behind
    for (const place& p : a.where) shares = std::max(shares, percent(p.share).size());
    for (const auto& [view, title] : views) {
        std::string places;
        for (const place& p : a.where)
            if (p.view == view) {
                const std::string share = percent(p.share),
                                  box = p.block + (p.block.empty() || p.finding.empty() ? "" : ": ");
                places += wrapped(box + p.finding + (p.basis.empty() ? "" : fmt::format(" (by {})", p.basis)),
                                  shares + 6)
                              .replace(4, share.size(), share);
            }
        if (!places.empty()) text += fmt::format("  where, {}\n{}", title, places);
    }
    return text + "\n";
}

inline std::string summary_of(const diagnosis_result& d, const cause& c) {
    const axis_voice voice = voice_of(d, c.axis);
    std::string text =
        wrapped(fmt::format("{}, axis {}: probability {}{}", capital(voice(name_of_effect(c.effect))), c.axis,
                            probability(c.probability), claimed(c) ? "" : ", a suspect, not a claim"),
                2);
    if (c.waveform) text += wrapped(capital(waveform_in_words(d, c)) + ".", 4);
    for (const std::string& line : lines_of(c.parameters, voice)) text += wrapped(line, 4);
    text += wrapped(fmt::format("{}, {}", gap_of(c, voice), shrinkage(c.shrink)), 4);
    if (!c.confusable_with.empty())
        text += wrapped(fmt::format("cannot be distinguished on this record from {}; probability of the group {}",
                                    voice(named(c.confusable_with, "or")), probability(c.group_probability)),
                        4);
    for (const reading& r : c.readings)
        text +=
            wrapped(fmt::format("{}: {}",
                                r.effect == c.effect ? "this record is explained as well by"
                                                     : fmt::format("as {}", voice(name_of_effect(r.effect))),
                                listed(lines_of(r.parameters, voice))),
                    6);
    if (!c.exciting_motion.empty()) text += wrapped("shown by: " + c.exciting_motion, 4);
    if (const effect* known = effect_named(c.effect))
        text += wrapped(fmt::format("what to do: {}", voice(known->remedy)), 4);
    return text;
}

inline std::string summary(const diagnosis_result& d, bool verbose = false) {
    std::string text = wrapped(
        fmt::format("{}: {} against {}", capital(spaced(name_of(d.verdict))), d.log_file, d.machine_file), 0);
    text += wrapped(verdict_sentence(d), 0) + "\n";
    for (const axis_result& a : d.axes) text += summary_of(d, a);
    if (!d.causes.empty()) {
        text += "Causes\n";
        for (const cause& c : d.causes) text += summary_of(d, c);
        text += "\n";
    }
    if (d.verdict > verdict::within_tolerance) {
        text += "What is left\n" + wrapped(unexplained_share(d), 2) + wrapped(d.remaining_structure, 2) + "\n";
    }
    if (!d.next.motion.empty()) {
        text += "Next experiment\n" + wrapped(capital(d.next.motion), 2);
        for (const std::string& line : experiment_lines(d.next)) text += wrapped(line, 2);
        text += "\n";
    }
    if (verbose && !d.not_seen.empty()) {
        text += "What this log cannot see\n";
        for (const unseen& u : d.not_seen)
            text += wrapped(fmt::format("axis {}: {}; {} would", u.axis, u.what, u.instrument), 2);
        text += "\n";
    }
    for (const std::string& note : d.notes) text += wrapped("Note: " + note, 0);
    return text;
}

} // namespace quadrant_gap
