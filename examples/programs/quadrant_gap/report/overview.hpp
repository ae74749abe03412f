// SPDX-License-Identifier: BSL-1.0
// Long: loop() draws one picture from left to right.
#pragma once
#include "../gap_words.hpp"
#include "html.hpp"

/// One axis at a glance: the servo loop with the boxes at fault, and the gaps.
namespace quadrant_gap {

inline std::string badge(verdict v) {
    return fmt::format("<span class=\"badge {}\">{}</span>", name_of(v), spaced(name_of(v)));
}

/// A chain of positions as boxes, in the same words.
inline std::string chain_picture(const axis_result& a, const std::string& boxes, const std::string& text) {
    return fmt::format(
        R"svg(<svg class="loop" viewBox="0 0 378 120" role="img" aria-label="Positions of axis {0}: {1}">
<title>Positions of axis {0}: {1}</title>
<g class="wire"><path d="M2 62H11"/><path d="M117 62H136"/><path d="M242 62H261"/></g>
<g class="signal"><text class="left" x="2" y="24">asked or counted</text><text class="right" x="370" y="24">read</text></g>
{2}</svg>
<p class="hint loop-says">{3}.</p>
)svg",
        escape(a.name), text, boxes, capital(text));
}

/// The servo loop as boxes, narrow enough for a phone: the share of each box in it, and a box at fault marked
/// by a thick frame, bold letters and an exclamation mark, so that it is seen without colour too.
inline std::string loop(const axis_result& a) {
    std::vector<std::string> guilty;
    const bool two_encoders =
        std::any_of(a.where.begin(), a.where.end(), [](const place& p) { return p.view == "readings"; });
    const auto box = [&](std::string_view name, int x, int y, int height) {
        // Between two encoders the gap is the difference of their readings.
        const bool between = two_encoders && name == "transmission";
        double share = 0;
        bool found = false;
        for (const place& p : a.where)
            if (p.view == (between ? "readings" : "block") && p.block == name) {
                share += p.share.value;
                found = true;
            }
        const bool marked = share >= 0.2;
        if (marked)
            guilty.push_back(fmt::format("{} ({} of the {})", name, percent(share),
                                         between ? "difference of the two readings" : "gap"));
        std::string svg = fmt::format(
            "<g class=\"box{}\" data-box=\"{}\"><rect x=\"{}\" y=\"{}\" width=\"104\" height=\"{}\" rx=\"6\"/>"
            "<text x=\"{}\" y=\"{}\"{}>{}</text>",
            marked ? " guilty" : "", name, x, y, height, x + 52, y + (found ? 23 : height / 2 + 5),
            name.size() > 10 ? " textLength=\"94\" lengthAdjust=\"spacingAndGlyphs\"" : "", name);
        if (found)
            svg += fmt::format("<text class=\"share\" x=\"{}\" y=\"{}\">{}</text>", x + 52, y + 43,
                               percent(share));
        if (marked)
            svg += fmt::format(
                "<circle class=\"flag\" cx=\"{0}\" cy=\"{1}\" r=\"10\"/><text class=\"mark\" x=\"{0}\" "
                "y=\"{2}\">!</text>",
                x + 104, y, y + 5);
        return svg + "</g>";
    };
    if (a.positions_only) {
        const std::string boxes =
            box("drive", 12, 34, 56) + box("transmission", 137, 34, 56) + box("sensor", 262, 34, 56);
        return chain_picture(
            a, boxes, guilty.empty() ? "no box stands out" : fmt::format("the gap sits in {}", listed(guilty)));
    }
    // From the command down to the mechanics, one row each: a drive with loops of its own in front of the
    // actuator, a transmission between two encoders behind it.
    std::vector<std::string_view> column;
    if (a.driven) column.push_back("drive");
    column.push_back("actuator");
    if (two_encoders) column.push_back("transmission");
    const int down = 104 * (static_cast<int>(column.size()) - 1);
    std::string boxes = box("controller", 72, 34, 56), between_rows;
    for (std::size_t row = 0; row < column.size(); ++row) {
        const int y = 34 + 104 * static_cast<int>(row);
        boxes += box(column[row], 246, y, 56);
        if (row > 0) between_rows += fmt::format("<path d=\"M298 {}V{}\"/>", y + 56, y + 103);
    }
    boxes += box("mechanics", 246, 138 + down, 56) + box("sensor", 72, 138 + down, 56) +
             box("process", 246, 236 + down, 54);
    const std::string wires = fmt::format(
        R"(<path d="M2 62H22"/><path d="M45 62H71"/><path d="M176 62H245"/><path d="M350 62H368V166H351"/>
{}<path d="M246 {}H177"/><path d="M72 {}H34V74"/><path d="M298 {}V{}"/>)",
        between_rows, 166 + down, 166 + down, 236 + down, 195 + down);
    const std::string text =
        guilty.empty() ? "no box stands out" : fmt::format("the gap sits in {}", listed(guilty));
    return fmt::format(
        R"svg(<svg class="loop" viewBox="0 0 378 {5}" role="img" aria-label="Servo loop of axis {0}: {1}">
<title>Servo loop of axis {0}: {1}</title>
<g class="wire">{6}</g>
<circle class="sum" cx="34" cy="62" r="11"/><path class="sign" d="M29 62h10M34 57v10M41 84h9"/>
<g class="signal"><text class="left" x="2" y="42">reference</text><text x="210" y="54">command</text>
<text class="right" x="362" y="119">{7}</text><text x="210" y="{8}">position</text><text class="left" x="2" y="{9}">feedback</text>
<text class="left" x="305" y="{10}">{3}</text></g>
{2}</svg>
<p class="hint loop-says">{4}.</p>
)svg",
        escape(a.name), text, boxes, voice_of(a)("force"), capital(text), 294 + down, wires,
        down > 0 ? "" : voice_of(a)("force"), 158 + down, 186 + down, 220 + down);
}

inline std::string paragraph(const std::string& text) {
    return text.empty() ? "" : fmt::format("<p>{}</p>", escape(text));
}

inline std::string overview(const diagnosis_result& d, const axis_result& a) {
    std::string rows;
    for (const gap_row& r : gap_rows(a))
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                            capital(r.name), r.before, r.after, r.floor);
    return fmt::format(
        "<section data-axis-name=\"{0}\"><h2>Axis {0} {1}</h2>{2}<div class=\"overview\"><div>{3}</div>"
        "<table class=\"gap\"><caption>{4}</caption><thead><tr><th scope=\"col\">Gap</th><th "
        "scope=\"col\">before</th>"
        "<th scope=\"col\">after</th><th "
        "scope=\"col\">floor</th></tr></thead><tbody>\n{5}</tbody></table></div></section>\n",
        escape(a.name), d.axes.size() > 1 ? badge(a.verdict) : "",
        sentence(d, a) == verdict_sentence(d) ? "" : paragraph(sentence(d, a)), loop(a), escape(gap_basis(a)),
        rows);
}

} // namespace quadrant_gap
