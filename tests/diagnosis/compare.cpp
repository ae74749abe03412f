// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/compare.hpp"
#include "quadrant/diagnosis/init.hpp"
#include "quadrant/diagnosis/log/at_period.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/write_comparison.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace quadrant::diagnosis;

namespace {

machine_log log_of(const workshop::machine& m, double seconds, unsigned seed) {
    return workshop::as_log(workshop::run(m, seconds, seed));
}

/// A machine whose description lacks what both logs have.
workshop::machine worn() {
    workshop::machine m;
    m.cogging = 25;
    return m;
}

/// A machine beside its sister with twice the viscous friction, `turned`: the sister first.
void viscous_friction_is_named(bool turned) {
    const auto description = workshop::described(workshop::machine{});
    auto sister = worn();
    sister.viscous *= 2;
    const auto one = log_of(worn(), workshop::strokes, 1), other = log_of(sister, 8.15, 2);
    const auto found = turned ? compare(description, other, one) : compare(description, one, other);
    CHECK(found.likeness == likeness::differ);
    REQUIRE(found.differences.size() == 1);
    const difference& d = found.differences[0];
    CHECK(d.effect == "viscous_friction");
    CHECK(d.probability > 0.8);
    CHECK(d.gain > 15);
    CHECK(d.loss > 15);
    const auto& more = turned ? d.first : d.second;
    REQUIRE(more.size() == 1);
    CHECK(more[0].values[0].value == doctest::Approx(sister.viscous).epsilon(0.05));
    CHECK(d.gap_after_force_rms_N.value < 0.3 * d.gap_before_force_rms_N.value);
    const auto json = to_json(found);
    CHECK(json["likeness"] == "differ");
    CHECK(json["differences"][0]["effect"] == "viscous_friction");
    CHECK(json["axes"]["x"]["explained"] == (d.found_in_second ? "second" : "first"));
}

} // namespace

TEST_CASE("compare: two logs of one machine are alike, whatever its description lacks" *
          doctest::test_suite("all")) {
    const auto description = workshop::described(workshop::machine{});
    const auto found = compare(description, log_of(worn(), 8.15, 1), log_of(worn(), workshop::strokes, 2));
    CHECK(found.first.verdict == verdict::explained); // cogging, in both
    CHECK(found.likeness == likeness::alike);
    CHECK(found.differences.empty());
}

TEST_CASE("compare: what one of two machines has is named, and what both have is not") {
    viscous_friction_is_named(false);
}

TEST_CASE("compare: what one of two machines has is named where it comes first, too" *
          doctest::test_suite("all")) {
    viscous_friction_is_named(true);
}

TEST_CASE("compare: a log at another rate is brought to the rate of the machine" * doctest::test_suite("all")) {
    const auto description = workshop::described(workshop::machine{});
    const auto as_logged = log_of(workshop::machine{}, workshop::strokes, 1);
    const auto slow = at_period(log_of(workshop::machine{}, workshop::strokes, 2), 2 * workshop::period);
    const auto found = compare(description, as_logged, slow);
    CHECK(found.differences.empty());
    CHECK(std::any_of(found.notes.begin(), found.notes.end(),
                      [](const std::string& note) { return note.find("resampled") != note.npos; }));
}

TEST_CASE("compare: what one log cannot separate is not separated by the other, which lacks it" *
          doctest::test_suite("all")) {
    const auto description = workshop::described(workshop::machine{});
    workshop::machine slow; // in its current loop: within a row as good as late
    slow.lag = 0.4 * workshop::period;
    const auto plain = log_of(workshop::machine{}, workshop::strokes, 1), late = log_of(slow, 8.15, 2);
    for (const bool turned : {false, true}) {
        CAPTURE(turned);
        const auto found = turned ? compare(description, late, plain) : compare(description, plain, late);
        const auto& own = turned ? found.first : found.second;
        REQUIRE(own.causes.size() == 1);
        REQUIRE(own.causes[0].confusable_with.size() == 1);
        REQUIRE(found.differences.size() == 1);
        const difference& d = found.differences[0];
        const std::set names{d.effect, d.confusable_with.at(0)};
        CHECK(names == std::set<std::string>{"time_delay", "actuator_lag"});
        CHECK(names == std::set{own.causes[0].effect, own.causes[0].confusable_with[0]});
    }
}

TEST_CASE("compare: without a machine file the first log describes the machine, in units of its command" *
          doctest::test_suite("all")) {
    workshop::machine lighter;
    lighter.mass *= 0.7;
    const auto one = log_of(workshop::machine{}, 8.15, 1), other = log_of(lighter, 8.15, 2);
    const auto begun = machine_from_log(one);
    const auto description = read_machine(begun.machine.dump(), "the log");
    CHECK(description.axes[0].plant.force_constant_N_per_V == 1);
    CHECK(description.axes[0].plant.mass_kg ==
          doctest::Approx(workshop::machine{}.mass / workshop::machine{}.force_constant).epsilon(0.05));
    CHECK(compare(description, one, log_of(workshop::machine{}, 8.15, 3)).differences.empty());
    const auto found = compare(description, one, other);
    REQUIRE(found.differences.size() == 1);
    const auto& d = found.differences[0];
    const bool by_inertia = d.effect == "mass" || d.effect == "force_constant";
    CHECK_MESSAGE(by_inertia, d.effect);
}
