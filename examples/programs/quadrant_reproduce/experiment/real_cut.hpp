// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../real_cut.hpp"
#include "cutting.hpp"

namespace quadrant_reproduce {

template <class Configuration> outcome real_cut_case(const std::string& id, const std::string& name) {
    const auto c = thesis::real_circle();
    thesis::cutter_force cutter(thesis::cutter(), thesis::period);
    const auto found = thesis::mill<Configuration, thesis::gms_plant>(c, cutter);
    outcome out{{radial_row(id, "radial_rms", found)}, {}};
    if (found.diverged) return out;
    out.rows.push_back({id, "radial_max", "um", found.largest, {}, {}, {}, ""});
    if constexpr (std::same_as<Configuration, thesis::learning>) {
        auto first = c;
        first.weights = thesis::first_order;
        out.rows.push_back(radial_row(
            id, "radial_rms_first_order", thesis::mill<Configuration, thesis::gms_plant>(first, cutter),
            "weights [1]: the memory repeats half as much of what friction does at a reversal"));
    }
    line turn{.name = name, .x = {}, .y = {}};
    for (std::size_t k = 0; k < found.radial.size(); k += 4)
        turn.x.push_back(found.angle[k]), turn.y.push_back(found.radial[k]);
    out.pictures = {
        {"Radial error in the real cut",
         "Circle of 25 mm at 5 mm/s, cutter of Table 5.5; polar plot in um about the nominal circle.",
         {panel{
             .x_label = "", .y_label = "um", .lines = {std::move(turn)}, .polar = true, .polar_zero = 40.0}}}};
    return out;
}

inline experiment real_cut() {
    using namespace thesis;
    const std::string id = "thesis.real_cut.";
    return {
        "The real cut",
        "[Jamaludin2008] section 5.5, Tables 5.5 and 5.6, Figs. 5.26 to 5.28",
        "The circle of 25 mm at 5 mm/s with the force of an end mill of 16 mm and 4 edges at 1360 rpm, 4 mm "
        "deep and 1 "
        "mm wide, computed from the chip. Cutting coefficients, runout and the way of milling are not printed: "
        "usual "
        "ones for aluminium, none, and up. Configurations (i) to (iii) as in Table 5.4, the memory over 88 "
        "periods.",
        0.10,
        {{id + "i", [=] { return real_cut_case<uncompensated>(id + "i", "(i) none"); }},
         {id + "ii", [=] { return real_cut_case<compensated>(id + "ii", "(ii) observer and GMS"); }},
         {id + "iii", [=] { return real_cut_case<thesis::learning>(id + "iii", "(iii) and repetitive"); }}}};
}

} // namespace quadrant_reproduce
