// SPDX-License-Identifier: BSL-1.0
// What the program says in words.
#include <doctest/doctest.h>
#include <quadrant_gap/words.hpp>

TEST_CASE("words: calibration that takes nothing off a gap is not said to leave more than there was") {
    quadrant::diagnosis::axis_result a;
    a.gap.force_rms_N = 0.27;
    a.gap.noise_floor_force_rms_N = 0.05;
    const auto said = [&](double after) {
        a.gap_after.force_rms_N = after;
        return quadrant_gap::detail::left_by_calibration(a);
    };
    CHECK(said(0.29).starts_with("calibrating its values takes little of it off"));
    CHECK(said(0.15).starts_with("calibrate its values; that leaves 0.15 N, by which"));
    CHECK(said(0.06) == "calibrate its values, nothing is missing");
}
