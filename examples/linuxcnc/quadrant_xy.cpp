// SPDX-License-Identifier: BSL-1.0
// loadrt quadrant_xy
#include "quadrant_xy.hpp"

#include "component.hpp"

#include <rtapi_app.h>

#pragma GCC visibility push(default)
static int count = 1;
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION(
    "The whole loop of an xy-table: both axes with friction feedforward, disturbance observer and memory");
RTAPI_MP_INT(count, "number of tables");

static hal::component<hal::hal_xy> all;
extern "C" int rtapi_app_main() { return all.start(count); }
extern "C" void rtapi_app_exit() { all.stop(); }
#pragma GCC visibility pop
