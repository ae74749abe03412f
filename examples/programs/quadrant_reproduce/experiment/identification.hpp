// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "identify.hpp"

#include <fmt/format.h>

namespace quadrant_reproduce {

/// Fig. 3.4: friction over speed, both ways, and the curve of Table 3.1.
inline picture friction_map_picture(const thesis::axis& a, const quadrant::analysis::friction_map& map) {
    line points{.name = "constant speeds", .x = {}, .y = {}, .drawn = line::style::points},
        curve{.name = "eq. (3.5), Table 3.1, and A'", .x = {}, .y = {}};
    for (const auto& p : map.points)
        for (const double way : {-1.0, 1.0}) {
            points.x.push_back(way * 1e3 * p.speed.value());
            points.y.push_back(way * p.friction.value() + p.offset.value());
        }
    const double viscous = (a.curve.viscous + a.A_gms * (a.kf / a.B)).value();
    for (double v = -35; v <= 35; v += 0.05) {
        const double speed = std::abs(v) * 1e-3;
        const double force = a.curve.coulomb.value() +
                             (a.curve.static_level - a.curve.coulomb).value() *
                                 std::exp(-speed / a.curve.stribeck_velocity.value()) +
                             viscous * speed;
        curve.x.push_back(v), curve.y.push_back(v < 0 ? -force : force);
    }
    return {fmt::format("Axis {}: friction over speed", a.name),
            "Mean command at the thesis' 17 speeds, each driven both ways, and the curve that was simulated.",
            {panel{.x_label = "speed [mm/s]",
                   .y_label = "friction [N]",
                   .lines = {std::move(curve), std::move(points)}}}};
}

/// What the procedures find, beside what the runs were simulated with.
inline outcome identification_case(const thesis::axis& a) {
    outcome out;
    line found{.name = "identified", .x = {}, .y = {}, .drawn = line::style::points};
    const auto findings = thesis::identification::identify(a);
    for (const auto& r : findings.rows) {
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
    out.pictures = {{fmt::format("Axis {}: the virgin curve", a.name),
                     "Friction over the displacement from rest: what was simulated, and what was identified at "
                     "1, 5, 15 and 30 um.",
                     {panel{.x_label = "displacement [um]",
                            .y_label = "friction [N]",
                            .lines = {simulated, found},
                            .x_range = std::pair{0.0, 60.0}}}},
                    friction_map_picture(a, findings.map)};
    return out;
}

inline experiment identification() {
    return {"Identification from simulated runs",
            "[Jamaludin2008] eqs. (3.5), (3.9), sections 3.3.2 and 3.4.2, Table 3.1, Figs. 3.4 to 3.11",
            "Friction map from the thesis' 17 constant speeds of 0.01 to 30 mm/s and virgin curve from "
            "sinusoids of 15 and "
            "450 um at 0.1 Hz, on an "
            "axis with an encoder that counts and jitters and a controller that is 2 % off. The reference here "
            "is what was "
            "simulated.",
            0.10,
            {{"thesis.identify.x", [] { return identification_case(thesis::x); }},
             {"thesis.identify.y", [] { return identification_case(thesis::y); }}}};
}

} // namespace quadrant_reproduce
