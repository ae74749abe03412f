// SPDX-License-Identifier: BSL-1.0
// An observer of two inputs that does not say which command it is fed: this cycle's wish or the last one that
// acted.
// MUST SAY: observes_disturbance
// AT MOST: gcc 1900, clang 2900
#include "quadrant/loop/milling_axis_boxes.hpp"
using namespace quadrant;

struct my_observer {
    using value = quantity_of<signal::voltage>;
    struct parameters {};
    my_observer(const parameters&, duration) {}
    value operator()(quantity_of<signal::position>, value) noexcept { return {}; }
    void reset() noexcept {}
#ifdef MEND
    static constexpr bool takes_last_applied = true;
#endif
};
static_assert(milling_boxes<milling_axis_boxes<absent<signal::velocity, signal::voltage>, my_observer>>);
