// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "identify.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// What the procedures find, beside what the runs were simulated with.
inline outcome identification_case(const thesis::axis& a) {
    outcome out;
    line found{.name = "identified", .x = {}, .y = {}, .drawn = line::style::points};
    for (const auto& r : thesis::identification::identify(a)) {
        out.rows.push_back({r.id,
                            r.quantity,
                            r.unit,
                            r.simulated,
                            {},
                            {},
                            r.reference,
                            fmt::format("interval {:.4g} to {:.4g}, which {} what was simulated", r.low, r.high,
                                        r.held() ? "holds" : "misses")});
        int um = 0;
        if (std::sscanf(r.quantity.c_str(), "virgin_%dum", &um) == 1) {
            found.x.push_back(um);
            found.y.push_back(r.simulated);
        }
    }
    line simulated{.name = "simulated", .x = {}, .y = {}};
    for (double um = 0; um <= 200; um += 0.25) {
        simulated.x.push_back(um);
        simulated.y.push_back(thesis::identification::virgin_force(a, um * 1e-6));
    }
    out.pictures = {
        {fmt::format("Axis {}: the virgin curve", a.name),
         "Friction over the way from rest: what was simulated, and what was identified at 1, 5, 15 and 30 um.",
         {panel{.x_label = "way [um]",
                .y_label = "friction [N]",
                .lines = {simulated, found},
                .x_range = std::pair{0.0, 60.0}}}}};
    return out;
}

inline experiment identification() {
    return {"Identification from simulated runs",
            "[Jamaludin2008] eqs. (3.5), (3.9)",
            "Friction map from constant speeds of 0.01 to 30 mm/s and virgin curve from sinusoids of 15 and "
            "450 um at 0.1 Hz, on an "
            "axis with an encoder that counts and jitters and a controller that is 2 % off. The reference here "
            "is what was "
            "simulated.",
            0.10,
            {{"thesis.identify.x", [] { return identification_case(thesis::x); }},
             {"thesis.identify.y", [] { return identification_case(thesis::y); }}}};
}

} // namespace quadrant_reproduce
