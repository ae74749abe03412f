// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "publication.hpp"
#include "through_loop.hpp"

#include <algorithm>

namespace quadrant_reproduce {

/// A text in a cell: its bars do not end it.
inline std::string cell(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

/// The sources by the name that stands in the list.
inline constexpr std::array source_titles{std::pair{thesis_source, "the thesis: the milling table"},
                                          std::pair{vcnc_source, "the Virtual CNC"},
                                          std::pair{low_source, "the precision stage"}};

/// "15.56", and "-" where there is none; short numbers as they are.
inline std::string own(const std::optional<double>& v) { return v ? fmt::format("{:.4g}", *v) : "-"; }

/// Where ours stands, or why there is none.
inline std::string found_at(const printed& p) {
    if (p.used) return "used as a parameter" + (p.reason.empty() ? p.reason : "; " + p.reason);
    if (p.cannot()) return "cannot be computed: " + p.reason;
    std::string at = fmt::format("`{}` {}", p.id, p.quantity);
    if (p.how == reading::reduction || p.how == reading::rise)
        at += fmt::format(" against `{}` {}", p.base_id, p.base_quantity);
    if (p.how == reading::difference || p.how == reading::deviation) at += " against the measured figure";
    return at;
}
inline const char* origin_words(origin o) {
    return o == origin::simulated ? "simulated" : o == origin::measured ? "measured" : "given";
}

/// Every printed number with ours beside it, place by place.
inline std::string printed_markdown(const printed_list& list, const row_index& rows) {
    std::string out;
    for (const auto& [source, title] : source_titles) {
        out += fmt::format("\n### {} {}\n\n| place | number | origin | printed | ours | off | where |\n"
                           "|---|---|---|---|---|---|---|\n",
                           source, title);
        for (const printed& p : list) {
            if (p.source != source) continue;
            const auto ours = rows.ours(p);
            const auto distance = off(p, ours);
            out += fmt::format("| {} | {} | {} | {} {} | {} | {} | {} |\n", p.place, cell(p.what),
                               origin_words(p.from), p.text, p.unit, own(ours),
                               distance ? percent(*distance) : "-", cell(found_at(p)));
        }
    }
    return out;
}

/// What a part points at is there: a picture of this run, a case of it, or a file.
inline bool is_there(const std::string& where, const std::vector<section>& all) {
    if (where.empty() || where.find('/') != std::string::npos) return true;
    for (const section& s : all) {
        for (const picture& p : s.pictures)
            if (p.title == where) return true;
        for (const row& r : s.rows)
            if (r.id.starts_with(where)) return true;
    }
    return false;
}

/// Tables from the printed numbers, everything else from the list of parts.
inline std::string parts_markdown(const std::vector<part>& all, const printed_list& list, const row_index& rows,
                                  const std::vector<section>& sections) {
    std::string out;
    for (const auto& [source, title] : source_titles) {
        out += fmt::format("\n### {} {}: parts\n\n| part | what | state | ours |\n|---|---|---|---|\n", source,
                           title);
        for (const part& p : all)
            if (p.source == source)
                out += fmt::format("| {} | {} | {} | {}{}{} |\n", p.name, cell(p.what),
                                   is_there(p.where, sections) ? words_of(p.is) : "missing", cell(p.where),
                                   p.why.empty() || p.where.empty() ? "" : "; ", cell(p.why));
        std::vector<std::string> places;
        for (const printed& p : list)
            if (p.source == source && (places.empty() || places.back() != p.place) &&
                std::find(places.begin(), places.end(), p.place) == places.end())
                places.push_back(p.place);
        for (const std::string& place : places) {
            if (!place.starts_with("Table")) continue;
            std::size_t numbers = 0, have = 0, cannot = 0;
            double furthest = 0;
            for (const printed& p : list) {
                if (p.source != source || p.place != place) continue;
                ++numbers;
                cannot += p.cannot();
                const auto ours = rows.ours(p);
                have += ours.has_value();
                if (const auto distance = off(p, ours)) furthest = std::max(furthest, std::abs(*distance));
            }
            out += fmt::format("| {} | {} numbers | {} | {} of {} beside ours, the furthest {:.3g} % off{} |\n",
                               place, numbers,
                               cannot == numbers         ? "cannot be computed"
                               : have + cannot < numbers ? "missing"
                               : furthest <= 0.1         ? "done"
                                                         : "done, differs",
                               have, numbers, 100 * furthest,
                               cannot ? fmt::format("; {} cannot be computed", cannot) : "");
        }
    }
    return out;
}

/// Which experiments run through `xy_loop`, and why the others do not.
inline std::string through_loop_markdown(const std::vector<section>& all) {
    std::string out = "| experiment | runs | how, or why not |\n|---|---|---|\n";
    for (const section& s : all) {
        const through_loop* t = through_loop_of(s.what.title);
        out += fmt::format("| {} | {} | {} |\n", s.what.title,
                           !t        ? "missing"
                           : t->runs ? "yes"
                                     : "no",
                           t ? t->words : "");
    }
    return out;
}

inline std::string agreement_markdown(const publication& p) {
    return fmt::format(
        "- figures that the sources simulated: {}\n- figures that they measured: {}\n- what they derive from "
        "these "
        "(reductions, differences, deviations): {}\n- parameters that we use as "
        "they are printed: {}, {} of them with ours equal within 2 %\n- printed again in another table: {}\n- "
        "cannot be computed: {}, each with its reason\n",
        p.simulated.words(), p.measured.words(), p.derived.words(), p.given.all,
        p.given.up_to(0) + p.given.zero, p.repeated, p.cannot);
}

inline constexpr const char* beginning =
    "# Published figures, reproduced\n\n"
    "For whoever asks how near the library comes to published figures. You get each printed number, ours "
    "beside it, and the reason where there is none.\n\n"
    "Written by `quadrant-reproduce --markdown docs/reproduction.md`; do not edit. Every figure under "
    "\"ours\" is computed in the run (`--html` draws the pictures, `--json` has all digits). In brackets: "
    "how "
    "far ours lies from the figure before the bracket. "
    "Where a source does not print a parameter, the section says what we took; only the modes of the "
    "milling table are fitted, to its printed margins.\n\n"
    "How near ours comes to what the three sources print, each number once:\n\n";

inline std::string markdown(const std::vector<section>& all) {
    const printed_list list = printed_numbers();
    const row_index rows(all);
    std::string out = beginning;
    out += agreement_markdown(publication(list, rows));
    out += "\nPublished, simulated: by the source in its own simulation or on its model. Published, measured: "
           "on its "
           "machine, or on the frequency response measured there, which has modes, cogging and friction of its "
           "own. "
           "Reference: a footnote, our own earlier computation from the source's parameters by another program "
           "(not in this repository; asked is 2 % for loops and the memory, 10 % for friction). "
           "A second program (`tests/reproduce/independent.py`) computes loops and a circle on GMS friction "
           "from the "
           "tables alone, figures that the reference does not hold among them; a test compares.\n\n"
           "| experiment | figures | published, simulated: within 10 % | published, measured: within 25 % | "
           "reference: within what is asked |\n|---|---|---|---|---|\n";
    std::string outside;
    for (const section& s : all) {
        const tally t = count(s.rows, s.what.tolerance);
        out += fmt::format(
            "| {} | {} | {} | {} | {} |\n", s.what.title, s.rows.size(),
            near_words(s.rows, &row::published_simulated, 0.10),
            near_words(s.rows, &row::published_measured, 0.25),
            t.compared == 0 ? "-"
                            : fmt::format("{} of {} ({:g} %)", t.within, t.compared, 100 * s.what.tolerance));
        for (const row* r : t.outside)
            outside +=
                fmt::format("- `{}` {}: {} {} instead of {}. {}\n", r->id, r->quantity, number(r->simulated),
                            unit_sign(r->unit), compared(*r, r->reference_computation), r->note);
    }
    if (!outside.empty()) out += "\nOutside of the reference:\n\n" + outside;
    out += "\n## Every part of the sources\n" + parts_markdown(parts(), list, rows, all);
    out += "\n## Through the loop of the whole table\n\n"
           "`xy_loop` is the library's loop of both axes: controllers, table and process in one type. Tests "
           "run the "
           "experiments of one axis again as an axis of it, while the other one moves, too.\n\n" +
           through_loop_markdown(all);
    for (const section& s : all) {
        out += fmt::format("\n## {}\n\n{}\n\nSource: {}.\n\n", s.what.title, s.what.text, s.what.source);
        out +=
            "| id | quantity | unit | ours | published, simulated | published, measured | reference | note |\n"
            "|---|---|---|---|---|---|---|---|\n";
        for (const row& r : s.rows)
            out += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} |\n", r.id, r.quantity,
                               unit_sign(r.unit), number(r.simulated), compared(r, r.published_simulated),
                               compared(r, r.published_measured), compared(r, r.reference_computation),
                               cell(r.note));
    }
    out += "\n## Every printed number\n" + printed_markdown(list, rows);
    return out;
}

} // namespace quadrant_reproduce
