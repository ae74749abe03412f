// SPDX-License-Identifier: BSL-1.0
// Two causes behind the loops of a drive, one of which hides the other (drive_simulator.hpp).
#include "position_drive.hpp"

#include <algorithm>
#include <doctest/doctest.h>
#include <string_view>

using namespace quadrant::diagnosis;

TEST_CASE("position drive: a drag that a delay hides is named beside it") {
    const drive_simulator::machine described{
        .mass = 147, .viscous = 86, .gain = 19400, .position_gain = 19.6, .delay = 1.3e-3, .count = 1e-7};
    const nlohmann::json tolerance{{"mass", 0.03},
                                   {"viscous", 0.1},
                                   {"velocity_gain", 0.01},
                                   {"position_gain", 0.01},
                                   {"command_delay", 0.05}};
    auto m = described;
    m.mass *= 1.01;
    m.viscous *= 0.98;
    m.delay = 7e-3;
    m.drag = 50;
    const auto d = position_drive::diagnosed(described, tolerance, 1e-3, m, m);
    REQUIRE(d.causes.size() == 2);
    const auto is_named = [&](std::string_view effect, double value) {
        const auto c = std::find_if(d.causes.begin(), d.causes.end(),
                                    [&](const cause& each) { return each.effect == effect; });
        REQUIRE_MESSAGE(c != d.causes.end(), effect);
        CHECK(c->probability >= 0.9);
        CHECK(c->parameters.at(0).values.at(0).value == doctest::Approx(value).epsilon(0.02));
    };
    is_named("command_delay", m.delay);
    is_named("quadratic_drag", m.drag);
    CHECK(d.verdict == verdict::explained);
}
