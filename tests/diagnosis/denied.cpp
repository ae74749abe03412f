// SPDX-License-Identifier: BSL-1.0
// A cause of one motion alone must not take the name from one of both.
#include "claims.hpp"

using namespace quadrant::diagnosis;

TEST_CASE("diagnose: a force that the hold-out log has the other way round takes no name from the friction") {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.coulomb += 70;
    real.constant_force = 60;
    const auto log = workshop::as_log(workshop::run(real));
    real.constant_force = -60;
    const auto holdout = workshop::as_log(workshop::run(real, 8.15, 7));
    const auto d = diagnose(file, log, &holdout);
    CAPTURE(workshop::said(d));
    CHECK(workshop::says(d, "it is left out"));
    for (const cause& c : d.causes) CHECK(c.effect != "constant_force");
    REQUIRE(!d.causes.empty());
    CHECK(d.causes.front().effect == "coulomb_friction");
}
