// SPDX-License-Identifier: BSL-1.0
// The combined loop on the milling table: what examples/05_milling_table.cpp shows, and the experiments
// cutting, robustness and sensitivity.
#include "quadrant_reproduce/experiment/robustness.hpp"
#include "quadrant_reproduce/experiment/sensitivity.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant_reproduce;
using thesis::cut;

namespace {
template <class Configuration, class PlantFriction = thesis::gms_plant> double rms(const cut& c = {}) {
    const auto found = thesis::mill<Configuration, PlantFriction>(c);
    CHECK_FALSE(found.diverged);
    return found.rms;
}
template <class PlantFriction = thesis::gms_plant> void check_order(cut c) {
    c.cycle = thesis::exact_cycle;
    const double none = rms<thesis::uncompensated, PlantFriction>(c),
                 compensated = rms<thesis::compensated, PlantFriction>(c);
    CHECK(compensated < 0.5 * none);
    CHECK(rms<thesis::learning, PlantFriction>(c) < 0.5 * compensated);
}
bool about(double found, double wanted, double part) { return std::abs(found - wanted) <= part * wanted; }
} // namespace

TEST_CASE(
    "milling table: (i) and (ii) within 10 % of the reference computation, (iii) between its ends with one "
    "weighting and the other; sub-steps of 100 us tell the same to 0.5 %, with memory to 10 %") {
    const double none = rms<thesis::uncompensated>(), compensated = rms<thesis::compensated>(),
                 learning = rms<thesis::learning>();
    CHECK(about(none, 11.4, 0.1));
    CHECK(about(compensated, 4.4, 0.1));
    CHECK(about(learning, 0.3, 0.1));
    CHECK(about(rms<thesis::learning>({.weights = thesis::first_order}), 0.7, 0.1));
    const cut coarse{.substeps = 5};
    CHECK(about(rms<thesis::uncompensated>(coarse), none, 0.005));
    CHECK(about(rms<thesis::compensated>(coarse), compensated, 0.005));
    CHECK(about(rms<thesis::learning>(coarse), learning, 0.1));
}
TEST_CASE("milling table: with a cycle 1 % off weights 2, -1 converge to what they leave with the right one, "
          "weights 1 "
          "leave five times as much") {
    const double exact = rms<thesis::learning>({.cycle = thesis::exact_cycle});
    for (const double spindle : {0.99, 1.01}) {
        const cut off{.spindle = spindle, .cycle = thesis::exact_cycle};
        CHECK(rms<thesis::learning>(off) < 1.3 * exact);
    }
    cut off{.spindle = 1.01, .cycle = thesis::exact_cycle, .weights = thesis::first_order};
    const double left = rms<thesis::learning>(off);
    off.spindle = 1;
    CHECK(left > 4 * rms<thesis::learning>(off));
}
TEST_CASE("milling table: what weights 1 leave with a cycle 1 % off is 2 sin(0.01 pi i) of harmonic i without "
          "memory") {
    const cut off{.spindle = 1.01, .cycle = thesis::exact_cycle, .weights = thesis::first_order};
    const auto before = thesis::mill<thesis::compensated>(off);
    const auto lines = radial_spectrum("", before.radial);
    double squares = 0;
    for (std::size_t k = 0; k < lines.x.size(); ++k) { // Hann: a power spread over 1.5 lines
        const double i = std::round(lines.x[k] / (1.01 * 23.294));
        const double ratio = 2 * std::sin(0.01 * thesis::pi_ * i / 1.01);
        if (i <= 8) squares += 0.5 * lines.y[k] * lines.y[k] / 1.5 * ratio * ratio; // above: Q
    }
    const double left = rms<thesis::learning>(off);
    CAPTURE(std::sqrt(squares));
    CHECK(about(left, std::sqrt(squares), 0.15));
}
TEST_CASE(
    "milling table: a learning filter too strong by 1.2 converges, by 1.5 it is stopped: |3 (1 - 1.5)| > 1") {
    CHECK(rms<thesis::learning>({.learning = 1.2}) < 0.5);
    const auto wild = thesis::mill<thesis::learning>({.learning = 1.5});
    CHECK(wild.diverged);
    CHECK(wild.rms == 0);
    CHECK(wild.radial.empty());
    CHECK(wild.stopped < 1);
}
TEST_CASE("milling table: friction by another law, friction of Table 4.3b, noise of one count: still (iii) < "
          "(ii) < (i)") {
    check_order<thesis::lugre_plant>({});
    check_order({.friction_y = thesis::y_adjusted});
    check_order({.noise = 0.25});
}
TEST_CASE("robustness: half as much mass again makes weights 2, -1 unstable, which is a row without a figure; "
          "weights 1 hold") {
    const auto out = learning_on("id", {"mass", {.mass = 1.5, .cycle = thesis::exact_cycle}});
    REQUIRE(out.rows.size() == 5);
    CHECK_FALSE(out.rows[0].simulated);
    CHECK(out.rows[0].note == stopped_note);
    CHECK(out.rows[1].simulated.value() < 0.5);
    CHECK(out.rows[2].simulated.value() < 1); // |Q (1 - L T)|; three times that with weights 2, -1
    CHECK(3 * out.rows[2].simulated.value() > 1);
}
TEST_CASE("divergence guard: not finite, beyond the limit, or growing from window to window after the first") {
    thesis::divergence_guard limit(10);
    CHECK_FALSE(limit(9));
    CHECK(limit(-11));
    CHECK(limit(0)); // stays
    CHECK(thesis::divergence_guard(10)(std::numeric_limits<double>::quiet_NaN()));
    const auto stops_at = [](double ratio, double start) {
        thesis::divergence_guard guard(1e9, 10);
        for (int k = 0; k < 100; ++k)
            if (guard((k % 2 ? 1 : -1) * std::pow(ratio, k / 10) + (k < 10 ? start : 0))) return k;
        return 100;
    };
    CHECK(stops_at(1.0, 50) == 100); // a start does not count
    CHECK(stops_at(1.4, 0) == 100);
    CHECK(stops_at(1.6, 0) == 29); // at the end of the third window
}
TEST_CASE("sensitivity: nothing wrong leaves what the friction experiment leaves, to the bit") {
    CHECK(thesis::reversals_with({})->glitch ==
          thesis::run<thesis::gms_model>(thesis::y, {.cycles = 3}).glitch);
}
TEST_CASE("sensitivity: the size found leaves 10 um, and 1 % less of it does not; where none does, the note "
          "says so") {
    const auto rows_of = [](const std::string& name) {
        for (const run_case& each : sensitivity().cases)
            if (each.id == "milling.sensitivity." + name) return each.run().rows;
        return std::vector<row>{};
    };
    const auto level = rows_of("friction_above").at(0);
    const auto glitch = [](double percent) {
        return thesis::reversals_with({.level = 1 + percent / 100})->glitch;
    };
    CHECK(glitch(level.simulated.value()) >= 10);
    CHECK(glitch(0.99 * level.simulated.value()) < 10);
    const auto delay = rows_of("delay").at(0);
    CHECK_FALSE(delay.simulated);
    CHECK(delay.note.find("unstable from") != std::string::npos);
}
