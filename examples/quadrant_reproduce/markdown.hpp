// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "run.hpp"
#include "words.hpp"

namespace quadrant_reproduce {

/// A text in a cell: its bars do not end it.
inline std::string cell(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

inline std::string markdown(const std::vector<section>& all) {
    std::string out =
        "# Published figures, reproduced\n\n"
        "Written by `quadrant-reproduce --markdown docs/reproduction.md`; do not edit. Every figure under "
        "\"ours\" is computed "
        "in the run (`--html` draws the pictures, `--json` has all digits). In brackets: how far ours lies "
        "from the figure "
        "before the bracket.\n\n"
        "- published, simulated or on the model: by the source of the section in its own simulation\n"
        "- published, measured: by the source on its machine, or on the frequency response measured "
        "there\n"
        "- reference: our own earlier computation from the source's parameters by another program, "
        "`../shared/reference/`; asked is 2 % for loops and the memory, 10 % for friction\n\n"
        "| experiment | has a reference | within what is asked |\n|---|---|---|\n";
    std::string outside;
    for (const section& s : all) {
        const tally t = count(s.rows, s.what.tolerance);
        out +=
            fmt::format("| {} | {} | {} |\n", s.what.title, t.compared,
                        t.compared == 0 ? "-" : fmt::format("{} ({:g} %)", t.within, 100 * s.what.tolerance));
        for (const row* r : t.outside)
            outside +=
                fmt::format("- `{}` {}: {} {} instead of {}. {}\n", r->id, r->quantity, number(r->simulated),
                            unit_sign(r->unit), compared(*r, r->reference_computation), r->note);
    }
    out += outside.empty() ? "\nNone lies outside.\n" : "\nOutside:\n\n" + outside;
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
    return out;
}

} // namespace quadrant_reproduce
