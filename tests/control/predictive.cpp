// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/least_squares.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/predictive.hpp>
#include <quadrant/loop/feed_control.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const axis_model<signal::voltage> plant{6.7_mps2 / 1_V, 2.5 / 1_s};
const auto weights = bryson_weights(1_um, 2_mmps, 0.05_V);
constexpr double T = 2e-3;

axis_motion<> motion(double x, double v = 0) { return {x * 1_m, v * 1_mps, 0_mps2}; }

/// x'' = B u - A x' + push, solved with exponentials.
struct axis {
    double B = 6.7, A = 2.5, x = 0, v = 0;
    void step(double u, double push = 0) {
        const double kept = std::exp(-A * T), end = (B * u + push) / A; // speed that it nears
        x += end * T + (v - end) * (1 - kept) / A;
        v = end + (v - end) * kept;
    }
};

/// The whole plan over the horizon at once: every prediction by running the axis itself, and one least-squares
/// solve.
template <class Reference>
double best_first_move(const axis& from, double u, double push, const predictive_weights<>& w, int horizon,
                       const Reference& r, int k) {
    const auto run = [&](const std::vector<double>& du) {
        axis a = from;
        double command = u;
        std::vector<double> y;
        for (const double each : du) {
            a.step(command += each, push);
            y.push_back(a.x), y.push_back(a.v);
        }
        return y;
    };
    const auto n = std::size_t(horizon);
    const auto rest = run(std::vector<double>(n));
    std::vector<std::vector<double>> answer;
    for (std::size_t j = 0; j < n; ++j) {
        std::vector<double> du(n);
        du[j] = 1;
        auto y = run(du);
        for (std::size_t i = 0; i < y.size(); ++i) y[i] -= rest[i];
        answer.push_back(y);
    }
    // Cholesky of the 2 x 2 weight makes squares of it.
    const double l00 = std::sqrt(w.error[0][0]), l10 = w.error[0][1] / l00,
                 l11 = std::sqrt(std::max(0.0, w.error[1][1] - l10 * l10));
    analysis::least_squares all(n);
    for (std::size_t i = 0; i < n; ++i) {
        const axis_motion<> m = r(k + int(i) + 1);
        const double ex = m.position.value() - rest[2 * i], ev = m.velocity.value() - rest[2 * i + 1];
        std::vector<double> first(n), second(n), change(n);
        for (std::size_t j = 0; j < n; ++j) {
            first[j] = l00 * answer[j][2 * i] + l10 * answer[j][2 * i + 1];
            second[j] = l11 * answer[j][2 * i + 1];
        }
        change[i] = std::sqrt(w.increment);
        all.add(first, l00 * ex + l10 * ev);
        all.add(second, l11 * ev);
        all.add(change, 0);
    }
    return all.solve().x[0];
}
template <std::size_t N> double far_from_best(const predictive_weights<>& w) {
    predictive<N> law{{.plant = plant, .weights = w}, T * 1_s};
    const auto reference = [](int k) { // no model of it anywhere: a swing and a jump
        const double t = k * T;
        return motion(1e-3 * std::sin(20 * t) + (k > 40 ? 2e-5 : 0), 2e-2 * std::cos(20 * t));
    };
    axis a;
    double u = 0, worst = 0, largest = 0;
    const double push = 0.8;
    for (int k = 0; k < 80; ++k) {
        const double before = u;
        u = law(reference(k + int(N)), a.x * 1_m, a.v * 1_mps).value();
        if (k >= int(N)) { // the ring is full, and the force has been there for a sample
            const double best = best_first_move(a, before, push, w, int(N), reference, k);
            worst = std::max(worst, std::abs(u - before - best)), largest = std::max(largest, std::abs(best));
        }
        a.step(u, push);
    }
    return worst / largest;
}
template <class Make> bool says(Make&& make, const std::string& words) {
    try {
        make();
    } catch (const invalid_parameter& e) {
        return std::string(e.what()).find(words) == 0;
    }
    return false;
}
} // namespace

TEST_CASE("predictive: each move is the first of the dense least-squares plan, under a force that it does not "
          "know") {
    CHECK(far_from_best<2>(weights) < 1e-8);
    CHECK(far_from_best<10>(weights) < 1e-8);
    CHECK(far_from_best<25>(weights) < 1e-8);
    CHECK(far_from_best<10>(bryson_weights(1_um, HUGE_VAL * 1_mps, 0.2_V)) < 1e-8); // position alone
    auto crossed = weights;
    crossed.error[0][1] = crossed.error[1][0] = 0.7 / (1e-6 * 2e-3);
    CHECK(far_from_best<10>(crossed) < 1e-8);
}

TEST_CASE("predictive: no error stays under a constant force, with mass and friction 30 % off") {
    predictive<> law{{.plant = plant, .weights = weights}, 2_ms};
    axis a{.B = 0.7 * 6.7, .A = 1.3 * 2.5};
    double u = 0;
    for (int k = 0; k < 2000; ++k) a.step(u = law(motion(0.01), a.x * 1_m, a.v * 1_mps).value(), -3);
    CHECK(std::abs(a.x - 0.01) < 1e-12);
    CHECK(u == doctest::Approx(3 / a.B).epsilon(1e-9)); // what the force asks for
}
TEST_CASE("predictive: at constant speed nothing lags, with mass and friction 30 % off") {
    predictive<> law{{.plant = plant, .weights = weights}, 2_ms};
    axis a{.B = 1.3 * 6.7, .A = 0.7 * 2.5};
    for (int k = 0; k < 3000; ++k)
        a.step(law(motion(0.2 * T * (k + 10), 0.2), a.x * 1_m, a.v * 1_mps).value(), 1);
    CHECK(std::abs(a.x - 0.2 * T * 3000) < 1e-9);
}
TEST_CASE("predictive: what the reference will do is answered `horizon` samples ahead and no earlier") {
    predictive<8> law{{.plant = plant, .weights = weights, .horizon = 6}, 2_ms};
    CHECK(law.lead() == 6);
    std::vector<double> u;
    for (int k = 0; k < 20; ++k) u.push_back(law(motion(k + 6 >= 10 ? 1e-6 : 0), 0_m, 0_mps).value());
    for (std::size_t k = 0; k < 4; ++k) CHECK(u[k] == 0);
    CHECK(u[4] != 0);
    // In a feed_control the reference is due most_lead samples late, whatever the horizon.
    using axis_control = feed_control<feed_control_boxes<predictive<8>>>;
    axis_control control{
        .box = {{.law = {.plant = plant, .weights = weights, .horizon = 6}, .limit = 10_V}, 2_ms}};
    axis a;
    double worst = 0;
    const auto ramp = [](int k) { return motion(k < 0 ? 0 : 2.5e-2 * k * T, k < 0 ? 0 : 2.5e-2); };
    for (int k = 0; k < 400; ++k) {
        if (k > 200) worst = std::max(worst, std::abs(a.x - ramp(k - 8).position.value()));
        a.step(control(ramp(k), {a.x * 1_m, a.v * 1_mps}).value());
    }
    CHECK(worst < 1e-9);
}
TEST_CASE("predictive: a clipped command does not wind up, and clipping outside is told by applied()") {
    auto p = predictive<>::parameters{.plant = plant, .weights = weights};
    predictive<> free{p, 2_ms};
    p.limit = 0.5_V;
    predictive<> inside{p, 2_ms};
    predictive<> untold = free;
    axis a, b, c;
    double beyond = 0, untold_beyond = 0;
    bool clipped = false;
    for (int k = 0; k < 1000; ++k) {
        const auto r = motion(k > 50 ? 1e-3 : 0); // a step: more than 0.5 V could do
        const double u = inside(r, a.x * 1_m, a.v * 1_mps).value(),
                     wanted = free(r, b.x * 1_m, b.v * 1_mps).value(),
                     w = wanted > 0.5    ? 0.5
                         : wanted < -0.5 ? -0.5
                                         : wanted;
        free.applied(w * 1_V);
        REQUIRE(u == w);
        clipped = clipped || inside.limited();
        const double x = untold(r, c.x * 1_m, c.v * 1_mps).value();
        a.step(u), b.step(w), c.step(x > 0.5 ? 0.5 : x < -0.5 ? -0.5 : x);
        beyond = std::max(beyond, a.x - 1e-3), untold_beyond = std::max(untold_beyond, c.x - 1e-3);
    }
    CHECK(clipped);
    CHECK_FALSE(inside.limited());
    CHECK(std::abs(a.x - 1e-3) < 1e-12);
    CHECK(beyond < 1e-3); // of a step of 1 mm, with a brake as weak as the drive
    CHECK(untold_beyond > 3 * beyond);
}
TEST_CASE("predictive: the command changes no faster than its limit") {
    predictive<> law{{.plant = plant, .weights = weights, .rate_limit = 60_V / 1_s}, 2_ms};
    axis a;
    double before = 0, steepest = 0;
    for (int k = 0; k < 1500; ++k) {
        const double u = law(motion(k > 50 ? 20e-6 : 0), a.x * 1_m, a.v * 1_mps).value();
        steepest = std::max(steepest, std::abs(u - before));
        a.step(before = u);
    }
    CHECK(steepest == doctest::Approx(0.12).epsilon(1e-12));
    CHECK(std::abs(a.x - 20e-6) < 1e-12);
}
TEST_CASE("predictive: only the ratios of the weights matter, and the radius is how fast the loop forgets") {
    auto doubled = weights;
    for (auto& row : doubled.error)
        for (double& each : row) each *= 2;
    doubled.increment *= 2;
    const auto one = design_predictive<10>(plant, weights, 10, 2_ms),
               two = design_predictive<10>(plant, doubled, 10, 2_ms);
    for (std::size_t i = 0; i < 10; ++i)
        CHECK(one.to_position[i] == doctest::Approx(two.to_position[i]).epsilon(1e-12));
    predictive<> law{{.plant = plant, .weights = weights}, 2_ms};
    axis a{.x = 1e-3};
    const auto size = [&] { return std::hypot(a.x, a.v * T); };
    double at = 0;
    for (int k = 0; k < 60; ++k) {
        if (k == 20) at = size();
        a.step(law(motion(0), a.x * 1_m, a.v * 1_mps).value());
    }
    CHECK(std::pow(size() / at, 1.0 / 40) == doctest::Approx(law.radius()).epsilon(0.05));
}
TEST_CASE("predictive: refuses what cannot be planned, by name and rule") {
    const auto with = [](auto&& change) {
        return [change] {
            predictive<>::parameters p{.plant = plant, .weights = weights};
            change(p);
            predictive<>{p, 2_ms};
        };
    };
    CHECK(says(with([](auto& p) { p.horizon = 11; }),
               "predictive.horizon = 11: must lie between 1 and the preview (10 periods)"));
    CHECK(says(with([](auto& p) { p.horizon = 0; }), "predictive.horizon = 0: must lie between"));
    CHECK(says(with([](auto& p) { p.plant.gain = {}; }), "predictive.plant.gain = 0 m/(V s^2): must be finite "
                                                         "and above 0: the command has to control the axis"));
    CHECK(says(with([](auto& p) { p.weights.error[1][1] = -1; }), "predictive.weights.error (determinant) = "));
    CHECK(says(with([](auto& p) { p.weights.error[0][1] = p.weights.error[1][0] = 1e9; }),
               "predictive.weights.error (determinant) = "));
    CHECK(says(with([](auto& p) { p.weights.error[0][1] = 1; }), "predictive.weights.error (determinant) = "));
    CHECK(
        says(with([](auto& p) { p.weights.error[0][0] = 0; }), "predictive.weights.error[0][0] = 0: must be"));
    CHECK(says(with([](auto& p) { p.weights.increment = 0; }), "predictive.weights.increment = 0: must be"));
    CHECK(says(with([](auto& p) { p.limit = 0_V; }), "predictive.limit = 0 V: must be above 0"));
    CHECK(says(with([](auto& p) { p.rate_limit = {}; }), "predictive.rate_limit = 0 V/s: must be above 0"));
    CHECK(says(with([](auto& p) { p.horizon = 1; }), "predictive.horizon = 1: must be longer, or"));
}
