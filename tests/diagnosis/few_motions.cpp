// SPDX-License-Identifier: BSL-1.0
#include "workshop.hpp"

#include <quadrant/diagnosis/which/pieces.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

using namespace quadrant::diagnosis;

// Robots are recorded over two or three slow swings. To leave one of two motions out would leave half of the
// record, and half of a warm-up, to find the numbers from.

namespace {

/// A slow axis at 100 Hz that swings for 12 s.
axis_record swings(double seconds_each, double corner_Hz) {
    axis_log log;
    log.name = "q";
    for (int k = 0; k < 1200; ++k) {
        const double turn = std::numbers::pi * 0.01 * k / seconds_each;
        log.position.push_back(std::sin(turn));
        log.command.push_back(-std::sin(turn));
    }
    return prepare(log, 0.01, 1e-4,
                   {.travel = 2, .speed = 1, .command = 1, .count = 1e-4, .corner_Hz = corner_Hz});
}
std::set<std::size_t> segments_of_blocks(const axis_record& r) {
    const auto& of = r.score.channels.front().segment_of_block;
    return {of.begin(), of.end()};
}

} // namespace

TEST_CASE("few motions: a record of fewer motions than folds is cut into as many pieces") {
    const axis_record two = swings(5, 5);
    REQUIRE(two.segments > 1);
    REQUIRE(two.segments < folds);
    std::size_t motions = 0;
    const axis_record cut = in_pieces(two, motions);
    CHECK(motions == two.segments);
    CHECK(cut.segments == folds);
    CHECK(segments_of_blocks(cut).size() == folds);
    for (const channel& c : cut.score.channels)
        CHECK(std::is_sorted(c.segment_of_block.begin(), c.segment_of_block.end()));
}

TEST_CASE("few motions: a record of many motions stays as it is") {
    const axis_record many = swings(1, 25);
    REQUIRE(many.segments > folds);
    std::size_t motions = 0;
    CHECK(in_pieces(many, motions).segment == many.segment);
    CHECK(motions == many.segments);
}
