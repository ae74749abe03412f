// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../words.hpp"
#include "html.hpp"

/// One axis at a glance: the servo loop with the boxes at fault, and the gaps.
namespace quadrant_gap {

inline std::string badge(verdict v) {
    return fmt::format("<span class=\"badge {}\">{}</span>", name_of(v), spaced(name_of(v)));
}

inline std::string loop(const axis_result& a) {
    std::vector<std::string> guilty;
    const auto box = [&](std::string_view name, int x, int y, int height) {
        double share = 0;
        bool found = false;
        for (const place& p : a.where)
            if (p.view == "block" && p.block == name) {
                share += p.share.value;
                found = true;
            }
        const bool marked = share >= 0.2;
        if (marked) guilty.push_back(fmt::format("{} ({} of the gap)", name, percent(share)));
        return fmt::format(
            "<g class=\"box{}\"><rect x=\"{}\" y=\"{}\" width=\"126\" height=\"{}\" rx=\"6\"/><text x=\"{}\" "
            "y=\"{}\">{}</text>{}</g>",
            marked ? " guilty" : "", x, y, height, x + 63, y + (found ? 23 : height / 2 + 5), name,
            found ? fmt::format("<text class=\"share\" x=\"{}\" y=\"{}\">{}{}</text>", x + 63, y + 43,
                                percent(share), marked ? " of the gap" : "")
                  : "");
    };
    const std::string boxes = box("controller", 92, 34, 56) + box("actuator", 302, 34, 56) +
                              box("mechanics", 302, 138, 56) + box("sensor", 92, 138, 56) +
                              box("process", 302, 236, 54);
    const std::string text = guilty.empty() ? "no box stands out" : "the gap sits in " + listed(guilty);
    return fmt::format(R"svg(<svg viewBox="0 0 480 294" role="img" aria-label="Servo loop of axis {0}: {1}">
<title>Servo loop of axis {0}: {1}</title>
<g class="wire"><path d="M2 62H39"/><path d="M62 62H91"/><path d="M218 62H301"/><path d="M428 62H462V166H429"/>
<path d="M302 166H219"/><path d="M92 166H51V74"/><path d="M365 236V195"/></g>
<circle class="sum" cx="51" cy="62" r="11"/><path class="sign" d="M46 62h10M51 57v10M58 84h9"/>
<g class="signal"><text x="36" y="40">reference</text><text x="260" y="52">command</text><text x="450" y="52">force</text>
<text x="260" y="156">position</text><text x="51" y="184">feedback</text><text x="388" y="220">force</text></g>
{2}</svg>
)svg",
                       escape(a.name), text, boxes);
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
