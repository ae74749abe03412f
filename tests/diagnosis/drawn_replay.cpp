// SPDX-License-Identifier: BSL-1.0
#include "workshop.hpp"

#include <doctest/doctest.h>
#include <quadrant/diagnosis/diagnose.hpp>

using namespace quadrant::diagnosis;

TEST_CASE("the command that a report draws as replayed is the one that is judged: rows that do not count are "
          "no part of it") {
    workshop::machine real;
    real.mass *= 1.15; // something to explain, of which a simulated loop is drawn
    auto axis = workshop::run(real, workshop::strokes);
    constexpr std::size_t first = 3000, behind = 3200;
    axis.left_out.assign(axis.position.size(), 0);
    for (std::size_t k = first; k < behind; ++k) {
        axis.position[k] = axis.position[first - 1] + 0.01; // what no axis does
        axis.left_out[k] = 1;
    }
    const auto found =
        diagnose(workshop::described({}), workshop::as_log(axis), nullptr, [](const std::string&) {});
    const auto& drawn = found.axes.at(0).signals.command_replayed;
    REQUIRE(drawn.size() == axis.command.size());
    double most = 0;
    for (std::size_t k = 100; k < drawn.size(); ++k)
        if (k < first || k >= behind) most = std::max(most, std::abs(drawn[k] - axis.command[k]));
    CHECK(most < 3 * workshop::dac);
}
