// SPDX-License-Identifier: BSL-1.0
// Two plain voltages: which is whose?
// MUST SAY: along<quadrant::v0::x_direction | along<quadrant::x_direction | along<x_direction
// MUST SAY: could not convert | no viable conversion | chosen constructor is explicit
// AT MOST: gcc 4600, clang 9500
#include "quadrant/loop/xy_table.hpp"
using namespace quadrant;

using table = xy_table<table_axis_boxes<>, table_axis_boxes<>>;
using volts = quantity_of<signal::voltage>;
table::positions step(table& t, volts ux, volts uy) {
#ifdef MEND
    const table::commands u{.x = on_x(ux), .y = on_y(uy)};
#else
    const table::commands u{ux, uy};
#endif
    return t(u);
}
