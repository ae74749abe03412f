// SPDX-License-Identifier: BSL-1.0
// What the program says in words.
#include <doctest/doctest.h>
#include <quadrant_gap/gap_words.hpp>
#include <quadrant_gap/words.hpp>

TEST_CASE("words: calibration that takes nothing off a gap is not said to leave more than there was") {
    quadrant::diagnosis::axis_result a;
    a.gap.force_rms_N = 0.27;
    a.gap.noise_floor_force_rms_N = a.gap_after.noise_floor_force_rms_N = 0.05;
    const auto said = [&](double after) {
        a.gap_after.force_rms_N = after;
        return quadrant_gap::detail::left_by_calibration(a);
    };
    CHECK(said(0.29).starts_with("calibrating its values takes little of it off"));
    CHECK(said(0.15).starts_with("calibrate its values; that leaves 0.15 N, by which"));
    CHECK(said(0.06) == "calibrate its values, nothing is missing");
}

TEST_CASE("words: what is left of an open gap does not contradict its verdict") {
    using quadrant::diagnosis::verdict;
    quadrant::diagnosis::diagnosis_result d;
    const auto left = [&](verdict v, double probability) {
        d.verdict = v;
        d.causes = {{.effect = "drive_limit", .probability = probability, .group_probability = probability}};
        return quadrant_gap::unexplained_share(d);
    };
    CHECK(left(verdict::explained, 0.97) == "Nothing that matters.");
    CHECK(left(verdict::partly_explained, 0.97) == "Only what is slow and smaller than the noise of a row.");
    CHECK(left(verdict::partly_explained, 0.4) == "With the suspects added, nothing that matters.");
    d.share_unexplained = 0.2;
    CHECK(left(verdict::partly_explained, 0.4).starts_with("20 % of the gap's energy"));
}
