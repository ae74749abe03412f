// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "milling_table.hpp"

namespace thesis {

inline constexpr std::size_t edges = 4;
using cutter_force = milling_force<edges>;

/// The cut of [Jamaludin2008] section 5.5, Table 5.5: 25 mm at 5 mm/s. The table's 0.1 mm per tooth would be 9
/// mm/s at its 1360
/// rpm and 4 edges, so the chip follows from the speed of the text: 0.055 mm. Which way it was milled is not
/// printed: up.
/// The memory has whole periods, as the thesis rounds: 88 of 88.2.
inline cut real_circle() { return {.radius = 0.025, .feed = 0.005, .cycle = 88, .turns = 2}; }

/// The cutter of Table 5.5. Its coefficients are not printed; ours are usual for aluminium 7050: Kt 796, Kr 168
/// N/mm^2, edges 27.7 and 30.8 N/mm. Runout, without which an edge is like the others, is not printed either:
/// none.
inline const cutter_force::parameters& cutter() {
    static const cutter_force::parameters p = [] {
        cutter_force::parameters c;
        c.spindle = 1360 / 60.0 * 1_Hz;
        c.diameter = 16_mm;
        c.feed_per_tooth = 5e-3 / (1360 / 60.0 * edges) * 1_m;
        c.axial_depth = 4_mm;
        c.radial_depth = 1_mm;
        c.tangential = 796e6 * (1_N / 1_m / 1_m);
        c.radial = 168e6 * (1_N / 1_m / 1_m);
        c.edge_tangential = 27.7e3 * (1_N / 1_m);
        c.edge_radial = 30.8e3 * (1_N / 1_m);
        return c;
    }();
    return p;
}

/// The cut of Table 3.4, on another machine, whose forces the thesis measured: what the table prints, depth in
/// mm. Not printed: width (ours: a slot), material coefficients (those of `cutter`), runout (none). The table's
/// 0.1 mm per tooth contradicts its feed of 320 mm/min, which is 0.078 mm; the feed is taken.
inline constexpr std::size_t measured_edges = 3;
inline constexpr duration measured_period = duration::from_value(1 / 3000.0);
inline milling_force<measured_edges>::parameters measured_cutter(double depth) {
    milling_force<measured_edges>::parameters c;
    c.spindle = 1360 / 60.0 * 1_Hz;
    c.diameter = 10_mm;
    c.feed_per_tooth = 0.32 / (1360.0 * double(measured_edges)) * 1_m;
    c.axial_depth = depth * 1_mm;
    c.radial_depth = c.diameter;
    c.tangential = cutter().tangential;
    c.radial = cutter().radial;
    c.edge_tangential = cutter().edge_tangential;
    c.edge_radial = cutter().edge_radial;
    return c;
}

} // namespace thesis
