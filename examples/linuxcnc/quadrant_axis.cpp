// SPDX-License-Identifier: BSL-1.0
// loadrt quadrant_axis count=2
#include "quadrant_axis.hpp"

#include "component.hpp"

#include <rtapi_app.h>

#pragma GCC visibility push(default)
static int count = 1;
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("Cascade with friction feedforward, disturbance observer and repetitive memory");
RTAPI_MP_INT(count, "number of axes");

static hal::component<hal::hal_axis> all;
extern "C" int rtapi_app_main() { return all.start(count); }
extern "C" void rtapi_app_exit() { all.stop(); }
#pragma GCC visibility pop
