// SPDX-License-Identifier: BSL-1.0
// The decision table, the classification, and the tuning of the virtual machine of [Yeung2006].
#include "quadrant_reproduce/fuzzy_trial.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;
using analysis::tuning_state;

namespace {
analysis::tuning_result<> tuned(double gain, double adaptation) {
    auto start = vcnc::sliding_mode_of(vcnc::x_axis);
    start.gain = gain * 1000_V / 1_mps, start.adaptation = adaptation * 1000_V / 1_m;
    return analysis::tune<signal::voltage>(start, vcnc::fuzzy_trial());
}
std::vector<double> sine(double hertz, double amplitude, std::vector<double> onto) {
    for (std::size_t k = 0; k < onto.size(); ++k)
        onto[k] += amplitude * std::cos(2 * std::numbers::pi * hertz * 1e-3 * double(k));
    return onto;
}
} // namespace

TEST_CASE("fuzzy tuning: the decision table to the four digits that the source prints") {
    // Table 7: OSC, PHM, TRE; of each set the change of Ks and of rho.
    const double given[3][5][2] = {
        {{-0.2545, -0.1552}, {-0.2456, 0}, {0, 0}, {0.1552, 0}, {0.2456, 0.1552}},
        {{-0.2456, -0.2456}, {-0.1552, -0.2456}, {0, 0}, {0, 0.1552}, {0.1552, 0.2456}},
        {{-0.1552, -0.2545}, {0, -0.2456}, {0.1552, 0.2545}, {0.1552, 0.1552}, {0, 0}}};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t s = 0; s < 5; ++s) {
            CHECK(std::abs(analysis::decision_table[a][s].gain - given[a][s][0]) <= 0.5001e-4);
            CHECK(std::abs(analysis::decision_table[a][s].adaptation - given[a][s][1]) <= 0.5001e-4);
        }
}
TEST_CASE("fuzzy tuning: all 30 entries are the centroid of the cuts of the rules, level by level") {
    // Memberships are tenths. A level is reached at an output when some rule and some input set have it in all
    // four rows.
    const int in[5] = {10, 7, 3, 0, 0};
    const int rules[3][5][2] = {{{-3, -1}, {-2, 0}, {0, 0}, {1, 0}, {2, 1}},
                                {{-2, -2}, {-1, -2}, {0, 0}, {0, 1}, {1, 2}},
                                {{-1, -3}, {0, -2}, {1, 3}, {1, 1}, {0, 0}}};
    for (std::size_t a = 0; a < 3; ++a)
        for (int state = 0; state < 5; ++state)
            for (int gain = 0; gain < 2; ++gain) {
                int moment = 0, sum = 0;
                for (int level = 1; level <= 10; ++level)
                    for (int out = -3; out <= 3; ++out) {
                        bool reached = false;
                        for (int i = 0; i < 5; ++i)
                            for (int rule = 0; rule < 5; ++rule)
                                reached = reached || (in[std::abs(i - state)] >= level &&
                                                      in[std::abs(i - rule)] >= level &&
                                                      10 - std::abs(out - rules[a][rule][gain]) >= level);
                        moment += out * reached, sum += reached;
                    }
                const auto& entry = analysis::decision_table[a][std::size_t(state)];
                CHECK(std::abs((gain == 0 ? entry.gain : entry.adaptation) - double(moment) / sum) < 1e-12);
            }
}
TEST_CASE("fuzzy tuning: a trial is classed by its limits; without a phase margin its error is that of a limit "
          "cycle") {
    using enum tuning_state;
    CHECK(analysis::classified({0.5, 42, 10_um}) == std::array{acceptable, acceptable, highly_over});
    CHECK(analysis::classified({0.1, 75, 130_um}) == std::array{highly_over, highly_over, little_over});
    CHECK(analysis::classified({0.75, 30, 5_mm}) == std::array{little_under, little_under, little_under});
    CHECK(analysis::classified({1, std::nan(""), 5_um}) ==
          std::array{highly_under, highly_under, highly_under});
    const auto none = analysis::action({acceptable, acceptable, highly_over});
    CHECK(std::abs(none.gain) + std::abs(none.adaptation) < 1e-12);
    const auto all = analysis::action({highly_under, highly_under, highly_under});
    CHECK(all.gain == doctest::Approx(-0.2545 - 0.2456 - 0.1552).epsilon(2e-4));
}
TEST_CASE("oscillation_index: is the power of a sine above the threshold beside that of one below") {
    // Both lines on bins of the FFT: max - mean of a part is the line less its share of the part's bins.
    const std::size_t n = 1024;
    const auto command = sine(250, 0.01, sine(31.25, 1, std::vector<double>(n, 3.0)));
    const double low = 51, high = 511 - 51; // lines up to and above 50 Hz
    const double expected = 2000 * 1e-4 * (1 - 1 / high) / (1 - 1 / low);
    CHECK(analysis::oscillation_index(command, 1_ms, 50_Hz) == doctest::Approx(expected).epsilon(1e-9));
}
TEST_CASE("fuzzy tuning: the gains that the source tuned are acceptable by its own limits, with its tracking "
          "errors to 10 %") {
    const double published[3][3] = {{363, 47.16e3, 9}, {315, 39.12e3, 11}, {269, 37.16e3, 12}}; // Table 9
    for (const auto& p : published) {
        const auto trial = vcnc::fuzzy_trial()(p[0] * 1_V / 1_mps, p[1] * 1_V / 1_m);
        const auto states = analysis::classified(trial);
        CAPTURE(p[0]);
        CHECK(states[0] == tuning_state::acceptable);
        CHECK(states[1] == tuning_state::acceptable);
        CHECK(states[2] == tuning_state::highly_over);
        CHECK(1e6 * trial.tracking_error.value() == doctest::Approx(p[2]).epsilon(0.1));
    }
}
TEST_CASE(
    "fuzzy tuning: noisy, sluggish and unstable gains of the source end within a quarter of its tuned ones") {
    struct tuning {
        double gain, adaptation, tuned_gain, tuned_adaptation;
    };
    for (const tuning& p :
         {tuning{1, 100, 363, 47.16e3}, tuning{0.01, 1, 315, 39.12e3}, tuning{10, 10000, 269, 37.16e3}}) {
        const auto t = tuned(p.gain, p.adaptation);
        const auto& end = t.steps.back();
        CAPTURE(p.gain);
        CHECK(t.settled);
        CHECK(end.gain.value() == doctest::Approx(p.tuned_gain).epsilon(0.25));
        CHECK(end.adaptation.value() == doctest::Approx(p.tuned_adaptation).epsilon(0.25));
        CHECK(end.trial.tracking_error < 13_um); // published 9 to 12
    }
}
TEST_CASE("fuzzy tuning: each change is the product of the sum of actions; what cannot be tuned is refused") {
    const auto t = tuned(1, 100);
    REQUIRE(t.steps.size() > 1);
    for (std::size_t i = 1; i < t.steps.size(); ++i) {
        const auto change = analysis::action(t.steps[i - 1].states);
        CHECK(t.steps[i].gain / t.steps[i - 1].gain == doctest::Approx(1 + change.gain));
        CHECK(t.steps[i].adaptation / t.steps[i - 1].adaptation == doctest::Approx(1 + change.adaptation));
    }
    const auto refused = [](double gain, const analysis::tuning_trial& trial, const char* words) {
        auto start = vcnc::sliding_mode_of(vcnc::x_axis);
        start.gain = gain * 1_V / 1_mps;
        try {
            analysis::tune<signal::voltage>(start, [&](auto, auto) { return trial; });
        } catch (const invalid_parameter& e) {
            return std::string(e.what()).find(words) == 0;
        }
        return false;
    };
    CHECK(refused(0, {}, "tune.gain = 0 V s/m: must be finite and above 0"));
    CHECK(refused(1, {1, 40, std::nan("") * 1_m}, "tune.trial.tracking_error"));
}
TEST_CASE("fuzzy tuning: trials end at their number when the actions go round in a circle") {
    auto start = vcnc::sliding_mode_of(vcnc::x_axis);
    const auto t = analysis::tune<signal::voltage>(
        start,
        [](auto, auto) {
            return analysis::tuning_trial{0.5, 42, 1_mm};
        },
        {}, 7);
    CHECK(t.steps.size() == 7);
    CHECK_FALSE(t.settled);
}
