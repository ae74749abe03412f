// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/fit_gms.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const auto T = 500_us;
const auto kf = 1450_N / 1_V;
using law = maxwell_slip<3>;

law::parameters springs(double static_level) {
    const auto k = [](double per_um) { return per_um * 1e6 * 1_N / 1_m; };
    return {.curve = {122_N, static_level * 1_N, 2.2_mmps, {}},
            .weights = {0.5, 0.3, 0.2},
            .stiffness = {k(30), k(6), k(1)},
            .attraction = 1e5 * 1_N / 1_s};
}
/// sum k_i min(x, W_i/k_i), by hand.
double virgin(double um, double level = 122) {
    return std::min(30 * um, 0.5 * level) + std::min(6 * um, 0.3 * level) + std::min(1 * um, 0.2 * level);
}
/// The law alone, moved along the sinusoid; encoder and force noise if asked for.
test_run<> sinusoid(const law::parameters& p, double amplitude, double count, double noise, unsigned seed) {
    law friction(p, T);
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    test_run<> out;
    double before = 0;
    for (int i = 0; i < 4 * 20000; ++i) {
        const double x = amplitude * (1 - std::cos(2 * std::numbers::pi * 0.1 * i * 5e-4));
        const auto f = friction((x - before) / 5e-4 * 1_mps);
        before = x;
        const double read = x + 20e-9 * (count > 0) * gauss(random);
        out.position.push_back((count > 0 ? count * std::round(read / count) : read) * 1_m);
        out.command.push_back((f.value() + noise * gauss(random)) / 1450 * 1_V);
    }
    return out;
}
bool holds(const estimated<quantity_of<signal::force>>& e, double truth) { return e.holds(truth * 1_N); }
} // namespace

TEST_CASE(
    "virgin curve: by Masing's rule the branches of both sinusoids give sum k_i min(x, W_i/k_i), within 1 %") {
    const auto p = springs(122);
    const auto curve = find_virgin_curve<>({sinusoid(p, 450e-6, 0, 0, 1), sinusoid(p, 15e-6, 0, 0, 2)}, T, kf);
    CHECK(curve.points.size() > 50);
    CHECK(curve.points.back().way.value() > 400e-6);
    for (const auto& each : curve.points) {
        const double um = 1e6 * each.way.value();
        CAPTURE(um);
        CHECK(std::abs(each.force.value() - virgin(um)) < 0.01 * virgin(um) + 0.3);
    }
}
TEST_CASE("virgin curve: inertia and viscous friction are taken off") {
    auto p = springs(122);
    auto run = sinusoid(p, 450e-6, 0, 0, 1);
    const double w = 2 * std::numbers::pi * 0.1;
    for (std::size_t i = 0; i < run.command.size();
         ++i) { // a hundred times what the table has, so that it shows
        const double t = double(i) * 5e-4, v = 450e-6 * w * std::sin(w * t),
                     a = 450e-6 * w * w * std::cos(w * t);
        run.command[i] += (32000 * a + 170000 * v) / 1450 * 1_V;
    }
    const auto off = [&](const virgin_options& o) {
        double worst = 0;
        for (const auto& each : find_virgin_curve<>({run}, T, kf, o).points)
            worst = std::max(worst, std::abs(each.force.value() - virgin(1e6 * each.way.value())));
        return worst;
    };
    CHECK(off({.mass = 32000_kg, .viscous = 170000_N / 1_mps}) < 1);
    CHECK(off({.mass = 32000_kg}) > 10);
    CHECK(off({.viscous = 170000_N / 1_mps}) > 2);
}
TEST_CASE("virgin curve: a level that falls with speed is brought back to Fs") {
    const auto p = springs(177);
    const std::vector runs{sinusoid(p, 15e-6, 0, 0, 1), sinusoid(p, 450e-6, 0, 0, 2)};
    const auto as_it_ran = find_virgin_curve<>(runs, T, kf),
               level = find_virgin_curve<>(runs, T, kf, {.level = p.curve});
    double raw = 0, corrected = 0;
    for (std::size_t i = 0; i < level.points.size(); ++i) {
        double mean = 0, branches = 0;
        for (const auto& branch : level.branches)
            if (std::isfinite(branch[i])) mean += branch[i], ++branches;
        CHECK(mean / branches == doctest::Approx(level.points[i].force.value()).epsilon(1e-9));
        const double um = 1e6 * level.points[i].way.value();
        if (um < 60 || um > 250) continue; // all slip, at 190 to 280 um/s
        raw = std::max(raw, std::abs(as_it_ran.points[i].force.value() - virgin(um, 177)));
        corrected = std::max(corrected, std::abs(level.points[i].force.value() - virgin(um, 177)));
    }
    CHECK(raw > 3);
    CHECK(corrected < 0.5);
}
TEST_CASE("fit_gms: gives back knots and stiffness of the springs, and parameters that maxwell_slip takes") {
    const auto p = springs(122);
    const auto fit =
        fit_gms<3>(find_virgin_curve<>({sinusoid(p, 15e-6, 0, 0, 1), sinusoid(p, 450e-6, 0, 0, 2)}, T, kf));
    const std::array knot{61 / 30., 36.6 / 6, 24.4 / 1}, k{30., 6., 1.}, force{61., 36.6, 24.4};
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(1e6 * fit.knots[i].value() == doctest::Approx(knot[i]).epsilon(0.03).scale(0));
        CHECK(1e-6 * fit.stiffness[i].value() == doctest::Approx(k[i]).epsilon(0.03).scale(0));
        CHECK(fit.forces[i].value() == doctest::Approx(force[i]).epsilon(0.03));
    }
    CHECK(fit.limits.empty());
    CHECK(fit.residual < 0.3);
    const auto given = fit.parameters(p.curve, p.attraction);
    CHECK_NOTHROW(maxwell_slip<3>(given, T));
    CHECK(given.weights[0] == doctest::Approx(0.5).epsilon(0.03).scale(0));
}
TEST_CASE("fit_gms: with an encoder of 0.25 um and 3 N of noise the intervals hold the curve, and are no wider "
          "than 12 %") {
    const auto p = springs(122);
    int held = 0, asked = 0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const auto fit = fit_gms<3>(find_virgin_curve<>(
            {sinusoid(p, 15e-6, 0.25e-6, 3, seed), sinusoid(p, 450e-6, 0.25e-6, 3, seed + 50)}, T, kf));
        for (const double um : {1., 2., 5., 10., 15., 30., 100.}) {
            const auto e = fit.at(um * 1e-6 * 1_m);
            held += holds(e, virgin(um)), ++asked;
            CHECK((e.high - e.low).value() < 0.12 * virgin(um) + 8);
        }
    }
    CHECK(held >= asked - 2);
}
TEST_CASE("fit_gms: two knots within a tenth are said to be one") {
    virgin_curve curve{{}, {}, 0.25_um};
    std::vector<double> branch;
    for (double um = 0.2; um < 60; um *= 1.08) {
        const double f =
            std::min(30 * um, 60.) + std::min(6 * um, 36.) + std::min(5 * um, 31.5); // 2, 6 and 6.3 um
        curve.points.push_back({um * 1e-6 * 1_m, f * 1_N, 0.1, 0});
        branch.push_back(f);
    }
    curve.branches.assign(3, branch);
    const auto fit = fit_gms<3>(curve);
    CHECK(fit.limits.find("cannot be distinguished") != std::string::npos);
    CHECK(fit.at(6.15_um).value.value() == doctest::Approx(60 + 36 + 5 * 6.15).epsilon(0.01));
    const auto two = fit_gms<2>(curve); // and two springs do
    CHECK(two.limits.empty());
    CHECK(two.stiffness[1].value() * 1e-6 == doctest::Approx(11).epsilon(0.03));
}
TEST_CASE(
    "virgin curve: refuses runs that are too short, unequal, not finite; fit_gms a curve with too few points") {
    auto run = sinusoid(springs(122), 15e-6, 0, 0, 1);
    auto brief = run;
    brief.position.resize(40000), brief.command.resize(40000);
    CHECK_THROWS_AS(find_virgin_curve<>({brief}, T, kf), invalid_parameter);
    brief.position.resize(30000);
    CHECK_THROWS_AS(find_virgin_curve<>({brief}, T, kf), invalid_parameter);
    CHECK_THROWS_AS(find_virgin_curve<>({}, T, kf), invalid_parameter);
    CHECK_THROWS_AS(find_virgin_curve<>({run}, T, kf, {.points = 3}), invalid_parameter);
    auto curve = find_virgin_curve<>({run}, T, kf);
    curve.points.resize(11);
    CHECK_THROWS_AS(fit_gms<3>(curve), invalid_parameter);
    run.position[700] = double(NAN) * 1_m;
    CHECK_THROWS_AS(find_virgin_curve<>({run}, T, kf), invalid_parameter);
}
