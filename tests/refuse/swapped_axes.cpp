// SPDX-License-Identifier: BSL-1.0
// The command of y is sent to x and that of x to y.
// MUST SAY: use of deleted function | invokes a deleted function
// MUST SAY: y_direction
// AT MOST: gcc 3600, clang 1900
#include "quadrant/loop/xy_table.hpp"
using namespace quadrant;

using table = xy_table<table_axis_boxes<>, table_axis_boxes<>>;
using volts = quantity_of<signal::voltage>;
table::positions step(table& t, along<x_direction, volts> ux, along<y_direction, volts> uy) {
#ifdef MEND
    const table::commands u{.x = ux, .y = uy};
#else
    const table::commands u{.x = uy, .y = ux};
#endif
    return t(u);
}
