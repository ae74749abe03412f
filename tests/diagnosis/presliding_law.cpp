// SPDX-License-Identifier: BSL-1.0
// A contact that gives way before it slips, by LuGre's bristle where the diagnosis has sticking contacts: after
// a full turn it follows the same branch with twice the length, and its damping makes it look stiffer still.
#include "claims.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {
/// A machine with such a bristle, its damping over the root of stiffness and mass, and the length described.
diagnosis_result of_bristle(double length, double damping, double described) {
    workshop::machine m;
    m.bristle = length;
    m.bristle_damping = damping;
    machine_description file = workshop::described(m);
    file.axes[0].plant.presliding_length_m = described;
    const auto log = workshop::as_log(workshop::run(m)), holdout = workshop::as_log(workshop::run(m, 8.15, 2));
    return diagnose(file, log, &holdout);
}
} // namespace

TEST_CASE("presliding friction: a contact of the described length that follows another law is no claim" *
          doctest::test_suite("all")) {
    for (const double length : {3e-6, 8e-6, 2e-5})
        for (const double damping : {0.0, 0.7, 1.4}) {
            CAPTURE(length);
            CAPTURE(damping);
            const auto found = of_bristle(length, damping, length);
            CAPTURE(workshop::said(found));
            CHECK(workshop::claims(found).empty());
        }
}

TEST_CASE("presliding friction: the interval of a length holds that of a contact that follows another law" *
          doctest::test_suite("all")) {
    int named = 0;
    for (const double length : {3e-6, 8e-6, 2e-5})
        for (const double damping : {0.0, 0.7, 1.4}) {
            CAPTURE(length);
            CAPTURE(damping);
            const auto found = of_bristle(length, damping, length / 8);
            CAPTURE(workshop::said(found));
            for (const cause& c : found.causes) {
                if (!claimed(c)) continue;
                CHECK(c.effect == "presliding_friction");
                const estimate& value = workshop::value_of(c, "presliding_length_m");
                CHECK(value.low <= length);
                CHECK(length <= value.high);
                ++named;
            }
        }
    CHECK(named >= 6);
}
