// SPDX-License-Identifier: BSL-1.0
// Long: the laws with a design of their own, on the same axis and with the same checks.
// p_pi, state_feedback, rst and its designs: pole placement, zero phase error tracking, generalized predictive
// control, lead-lag.
#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/analysis/margins.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/generalized_predictive.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>
#include <quadrant/observer/kalman.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using cd = std::complex<double>;
constexpr double B = 0.63364, A = 2.5485; // x of [Yeung2006]
const axis_model<signal::voltage> plant{B * 1_mps2 / 1_V, A / 1_s};
const duration T = 1_ms;

axis_motion<> motion(double x, double v = 0, double a = 0) { return {x * 1_m, v * 1_mps, a * 1_mps2}; }
double random(unsigned& n) {
    n = n * 1664525u + 1013904223u;
    return (n >> 16) / 32768.0 - 1;
}
/// The axis itself, in many small steps of Heun's rule: shares nothing with the designs.
struct linear_axis {
    double x = 0, v = 0, gain = B;
    void step(double u) {
        constexpr int n = 2000;
        const double h = 1e-3 / n;
        for (int i = 0; i < n; ++i) {
            const double a = gain * u - A * v, later = v + h * a;
            x += h * (v + later) / 2;
            v += h * (a + gain * u - A * later) / 2;
        }
    }
};
/// The same as a table of its step, for long runs.
struct quick_axis {
    double x = 0, v = 0, gain = B;
    void step(double u) {
        static const auto unit = [](double v0, double u0) {
            linear_axis one{0, v0, B};
            one.step(u0);
            return one;
        };
        static const linear_axis moving = unit(1, 0), driven = unit(0, 1);
        x += moving.x * v + driven.x * gain / B * u;
        v = moving.v * v + driven.v * gain / B * u;
    }
};
template <class F> bool says(F&& make, const char* words) {
    try {
        make();
    } catch (const invalid_parameter& e) {
        return std::string(e.what()).find(words) == 0;
    }
    return false;
}
const rst_poles poles{.natural = 20_Hz, .damping = 0.8, .observer = 30_Hz};
const predictive_costs<> costs{.effort = 1e-5 * 1_m / 1_V};
const state_feedback_poles states{.natural = 25_Hz, .encoder_noise = 0.35_um};

template <class Law> Law designed() {
    if constexpr (std::same_as<Law, p_pi<>>)
        return {place_p_pi(plant, {.natural = 20_Hz}, T), T};
    else if constexpr (std::same_as<Law, pole_placement<>>)
        return {place_rst(plant, poles, T), T};
    else if constexpr (std::same_as<Law, zero_phase_tracking<>>)
        return {zero_phase_rst(plant, poles, T), T};
    else if constexpr (std::same_as<Law, generalized_predictive_law<20>>)
        return {generalized_predictive<20, 2>(plant, costs, T), T};
    else
        return {place_state_feedback(plant, states, 10_V, T), T};
}
} // namespace

TEST_CASE(
    "diophantine: the polynomials put together are the one that was asked for; a shared root is refused") {
    const z_polynomial<3> a{1, -2.7, 2.4, -0.7}, c_upper{1, 0.2, -0.3, 0.05};
    const z_polynomial<2> b{0, 0.3, 0.2};
    const z_polynomial<4> c{c_upper[0], c_upper[1], c_upper[2], c_upper[3], 0.01};
    const diophantine<3, 2> d(a, b, c);
    for (std::size_t k = 0; k <= 4; ++k) { // sums of products, by hand
        double sum = -c[k];
        for (std::size_t i = 0; i <= k; ++i) {
            if (i <= 3 && k - i < d.r.size()) sum += a[i] * d.r[k - i];
            if (i <= 2 && k - i < d.s.size()) sum += b[i] * d.s[k - i];
        }
        CHECK(std::abs(sum) < 1e-12);
    }
    CHECK(says([] { diophantine<2, 2>({1, -1.5, 0.5}, {0, 1, -1}, {1, 0, 0, 0}); }, "diophantine.b = "));
}
TEST_CASE(
    "pulse_transfer: polynomials give the positions that the axis runs through, with a delay late by it") {
    const auto p = pulse_transfer(plant, T);
    const auto late = pulse_transfer<2>(plant, T);
    linear_axis axis;
    std::vector<double> u(3), x(3), y(3);
    unsigned n = 1;
    for (int k = 3; k < 40; ++k) {
        u.push_back(random(n));
        x.push_back(axis.x);
        double now = 0, then = 0;
        const auto i = std::size_t(k);
        for (std::size_t j = 1; j <= 2; ++j) now += p.b[j] * u[i - j] - p.a[j] * x[i - j];
        if (k > 4)
            for (std::size_t j = 1; j <= 2; ++j) then += late.b[2 + j] * u[i - j - 2] - late.a[j] * y[i - j];
        y.push_back(then);
        CHECK(std::abs(now - axis.x) < 1e-13);
        if (k > 4) CHECK(std::abs(y[i] - x[i - 2]) < 1e-10);
        axis.step(u.back());
    }
}
TEST_CASE("place_rst: a step is answered by the pair that was asked for, and by nothing else") {
    auto law = designed<pole_placement<>>();
    quick_axis axis;
    // The sampled pair from its roots, driven through the zeros of the plant: x = g (b1 r[k-1] + b2 r[k-2]) -
    // ...
    const double w = 2 * std::numbers::pi * 20e-3;
    const cd root = std::exp(cd(-0.8 * w, 0.6 * w));
    const double p1 = -2 * root.real(), p2 = std::norm(root);
    const auto b = pulse_transfer(plant, T).b;
    double before = 0, now = 0;
    for (int k = 0; k < 300; ++k) {
        CHECK(std::abs(axis.x - now) < 1e-9);
        axis.step(law(motion(0.01), axis.x * 1_m, 0_mps).value());
        const double next = -p1 * now - p2 * before + (1 + p1 + p2) * 0.01 * (k > 0 ? 1 : b[1] / (b[1] + b[2]));
        before = now, now = next;
    }
    CHECK(std::abs(axis.x - 0.01) < 1e-10);
}
TEST_CASE("place_rst: the disturbance dies out with the observer's poles as well: a R + b S is their product") {
    auto law = designed<pole_placement<>>();
    quick_axis axis;
    const double w = 2 * std::numbers::pi * 20e-3, o = std::exp(-2 * std::numbers::pi * 30e-3);
    const cd root = std::exp(cd(-0.8 * w, 0.6 * w));
    std::vector<cd> c{1};
    for (const cd r : {root, std::conj(root), cd(o), cd(o)}) {
        c.push_back(0);
        for (std::size_t i = c.size() - 1; i > 0; --i) c[i] -= r * c[i - 1];
    }
    std::vector<double> x;
    for (int k = 0; k < 200; ++k) {
        x.push_back(axis.x);
        axis.step(law(motion(0), axis.x * 1_m, 0_mps).value() + 1); // 1 V of constant force
    }
    double most = 0, off = 0;
    for (std::size_t k = 10; k < x.size(); ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < c.size(); ++i) sum += c[i].real() * x[k - i];
        off = std::max(off, std::abs(sum)), most = std::max(most, std::abs(x[k]));
    }
    CHECK(most > 1e-5);
    CHECK(off < 1e-9 * most);
    CHECK(std::abs(x.back()) < 1e-3 * most);
}
TEST_CASE("zero_phase_rst: follows a sine without phase, smaller by the square of the zeros' gain") {
    for (const double hertz : {5.0, 50.0, 150.0}) {
        auto law = designed<zero_phase_tracking<>>();
        quick_axis axis;
        const double wt = 2 * std::numbers::pi * hertz * 1e-3;
        cd sum = 0;
        for (int k = 0; k < 2000; ++k) {
            if (k >= 1800) sum += axis.x * std::polar(2.0 / 200, -wt * k);
            axis.step(law(motion(1e-3 * std::cos(wt * (k + int(law.lead())))), axis.x * 1_m, 0_mps).value());
        }
        const auto b = pulse_transfer(plant, T).b;
        const double expected = std::norm(b[1] + b[2] * std::polar(1.0, wt)) / ((b[1] + b[2]) * (b[1] + b[2]));
        CHECK(std::abs(sum / 1e-3 - expected) < 1e-7);
        CHECK(std::abs(expected - std::pow(std::cos(wt / 2), 2)) < 1e-3); // the zero is near -1
    }
}
TEST_CASE("zero_phase_rst: with 20 % more gain than believed it still follows, and a constant force leaves no "
          "error") {
    auto law = designed<zero_phase_tracking<>>();
    quick_axis axis{0, 0, 1.2 * B};
    const double wt = 2 * std::numbers::pi * 2e-3;
    double error = 0;
    for (int k = 0; k < 3000; ++k) {
        if (k >= 2500) error = std::max(error, std::abs(axis.x - 1e-3 * std::cos(wt * k)));
        axis.step(law(motion(1e-3 * std::cos(wt * (k + 2))), axis.x * 1_m, 0_mps).value() + 0.5);
    }
    CHECK(error < 5e-3 * 1e-3);
    CHECK(error > 1e-5 * 1e-3); // it is felt
}
TEST_CASE("designs: an axis whose command acts two periods late is held and followed without phase") {
    const auto late = pulse_transfer<2>(plant, T);
    using placed = rst<4, 2, 2>;
    using tracking = rst<4, 2, 9, 4>;
    placed hold{place_rst(late, {.natural = 10_Hz, .observer = 15_Hz}, T), T};
    tracking follow{zero_phase_rst(late, {.natural = 10_Hz, .observer = 15_Hz}, T), T};
    quick_axis held, followed;
    std::array<double, 2> first{}, second{}; // commands under way
    const double wt = 2 * std::numbers::pi * 20e-3;
    cd sum = 0;
    for (int k = 0; k < 2000; ++k) {
        if (k >= 1800) sum += followed.x * std::polar(2.0 / 200, -wt * k);
        const double u1 = hold(motion(1e-3), held.x * 1_m, 0_mps).value(),
                     u2 = follow(motion(1e-3 * std::cos(wt * (k + 4))), followed.x * 1_m, 0_mps).value();
        held.step(first[0] + 1), followed.step(second[0]);
        first = {first[1], u1}, second = {second[1], u2};
    }
    CHECK(std::abs(held.x - 1e-3) < 1e-9);
    CHECK(std::abs(sum.imag()) < 1e-9);
    CHECK(std::abs(sum.real() / 1e-3 - std::pow(std::cos(wt / 2), 2)) < 1e-4);
}
TEST_CASE(
    "place_rst: a third-order axis, its current loop a lag of 0.8 ms, settles where it is sent under a force") {
    const double lag = 0.8e-3; // x/u = B / (s (s + A)(lag s + 1))
    const nominal_plant<3> slow{{B}, {0, A, 1 + lag * A, lag}};
    rst<3, 3, 3> law{
        place_rst(pulse_transfer(slow, T), {.natural = 15_Hz, .damping = 0.8, .observer = 30_Hz}, T), T};
    double x = 0, v = 0, drive = 0;
    for (int k = 0; k < 600; ++k) {
        const double u = law(motion(1e-3), x * 1_m, 0_mps).value();
        for (int i = 0; i < 200; ++i) { // midpoint rule
            const double h = 1e-3 / 200, d2 = drive + h / 2 * (u - drive) / lag,
                         v2 = v + h / 2 * (B * (drive + 1) - A * v);
            x += h * v2, v += h * (B * (d2 + 1) - A * v2), drive += h * (u - d2) / lag;
        }
    }
    CHECK(std::abs(x - 1e-3) < 1e-8);
}
TEST_CASE("generalized_predictive: each move is the first of the best plan, found by trying plans") {
    constexpr std::size_t horizon = 20;
    auto law = designed<generalized_predictive_law<horizon>>();
    quick_axis axis;
    std::vector<double> r(100 + horizon);
    unsigned n = 3;
    for (double& each : r) each = 1e-3 * random(n);
    double u = 0;
    for (std::size_t k = 0; k < 60; ++k) {
        const auto cost = [&](double du0, double du1) {
            quick_axis plan = axis;
            double J = 0, command = u + du0;
            for (std::size_t j = 1; j <= horizon; ++j) {
                plan.step(command);
                if (j == 1) command += du1;
                // The reference of the preview: what was given before the first sample is that of rest.
                const double due = k + j >= horizon ? r[k + j] : 0;
                J += (due - plan.x) * (due - plan.x);
            }
            return J + 1e-10 * (du0 * du0 + du1 * du1);
        };
        // A parabola in both: its least by its values at six plans.
        const double c = cost(0, 0), x = cost(1, 0), mx = cost(-1, 0), y = cost(0, 1), my = cost(0, -1),
                     xy = cost(1, 1);
        const double gx = (x - mx) / 2, gy = (y - my) / 2, hx = x + mx - 2 * c, hy = y + my - 2 * c,
                     h = xy - c - gx - gy - hx / 2 - hy / 2;
        const double best = (-gx * hy + gy * h) / (hx * hy - h * h);
        const double next = law(motion(r[k + horizon]), axis.x * 1_m, 0_mps).value();
        CHECK(std::abs(next - u - best) < 1e-6 * (1 + std::abs(best)));
        u = next;
        axis.step(u);
    }
}
TEST_CASE("generalized_predictive: holds a constant force without error; a plant that its horizon does not "
          "reach is refused") {
    auto law = designed<generalized_predictive_law<20>>();
    quick_axis axis;
    for (int k = 0; k < 2000; ++k) axis.step(law(motion(1e-3), axis.x * 1_m, 0_mps).value() - 1);
    CHECK(std::abs(axis.x - 1e-3) < 1e-9);
    CHECK(says([] { generalized_predictive<2>(pulse_transfer<2>(plant, T), costs, T); },
               "generalized_predictive.effort = 1"));
    CHECK(says([] { generalized_predictive<5>(plant, {.effort = 1e-5 * 1_m / 1_V, .first = 6}, T); },
               "generalized_predictive.first = 6: must lie between 1 and the horizon (5)"));
}
TEST_CASE("design_lead_lag: the open loop on the sampled axis has the crossover and phase margin asked for") {
    for (const double margin : {30.0, 50.0}) {
        const lead_lag<> law{design_lead_lag(plant, {.crossover = 40_Hz, .phase_margin = margin}, T), T};
        const analysis::law_loop loop{law, analysis::sampled_axis<>{plant, T}};
        const auto m = analysis::margins([&](frequency f) { return loop.open(f); },
                                         {analysis::hertz(1), analysis::hertz(499)});
        REQUIRE(m.phase_crossings.size() == 1);
        CHECK(std::abs(m.phase()->value - margin) < 1e-6);
        CHECK(std::abs(m.phase()->at.value() - 40) < 1e-6);
    }
    CHECK(says([] { design_lead_lag(plant, {.crossover = 200_Hz, .phase_margin = 60}, T); },
               "design_lead_lag.phase_margin = 10"));
}
TEST_CASE("p_pi: is P around PI written out, sum and all, and its reference parts") {
    p_pi<> law{{.position_gain = 31.0 / 1_s,
                .gain = 250_V / 1_mps,
                .integral_gain = 9000_V / 1_m,
                .velocity_weight = 0.9,
                .acceleration_gain = 1.5_V / 1_mps2},
               T};
    double sum = 0;
    unsigned n = 1;
    for (int k = 0; k < 200; ++k) {
        const double xr = 1e-5 * random(n), vr = 1e-2 * random(n), ar = random(n), x = 1e-5 * random(n),
                     v = 1e-2 * random(n);
        const double e = 31 * (xr - x) + 0.9 * vr - v;
        sum += 1e-3 * e;
        CHECK(std::abs(law(motion(xr, vr, ar), x * 1_m, v * 1_mps).value() -
                       (250 * e + 9000 * sum + 1.5 * ar)) < 1e-11);
    }
}
TEST_CASE("place_p_pi: in small periods the velocity loop is the pair asked for; too fast for the period is "
          "refused") {
    const auto p = place_p_pi(plant, {.natural = 10_Hz, .damping = 0.6, .position = 0.2}, T);
    const double w = 2 * std::numbers::pi * 10;
    const cd s = w * cd(-0.6, 0.8);
    CHECK(std::abs(s * (s + A) + B * (p.gain.value() * s + p.integral_gain.value())) < 1e-9 * w * w);
    CHECK(p.position_gain.value() == doctest::Approx(0.2 * w));
    CHECK(says([] { place_p_pi(plant, {.natural = 250_Hz}, T); }, "place_p_pi.natural = "));
}
TEST_CASE("state_feedback: with its states known an error dies out as the pair asked for, whatever the "
          "tachometer says") {
    auto law = designed<state_feedback<>>();
    quick_axis axis{.x = 0.3};
    law.settle(0.3_m, 0_V);
    const double w = 2 * std::numbers::pi * 25e-3;
    const cd root = std::exp(cd(-0.7 * w, std::sqrt(1 - 0.49) * w));
    double before = 0, now = -1e-3;
    for (int k = 0; k < 100; ++k) {
        const double e = axis.x - 0.301;
        if (k > 1) CHECK(std::abs(e - 2 * root.real() * now + std::norm(root) * before) < 1e-11);
        before = now, now = e;
        axis.step(law(motion(0.301), axis.x * 1_m, 7_mps).value());
    }
    CHECK(std::abs(now) < 1e-3 * 1e-3);
}
TEST_CASE("state_feedback: its estimates are those of a kalman that knows the axis as a mass of 1 kg") {
    auto law = designed<state_feedback<>>();
    kalman<signal::voltage> observer{{.mass = 1_kg,
                                      .force_constant = B * 1_N / 1_V,
                                      .viscous = A * 1_N / 1_mps,
                                      .encoder_noise = 0.35_um,
                                      .drift = B * 10_N},
                                     T};
    unsigned n = 5;
    quantity<si::electric_potential> u{};
    for (int k = 0; k < 100; ++k) {
        const auto x = 1e-5 * random(n) * 1_m;
        observer(x, u);
        u = law(motion(1e-5 * random(n)), x, 0_mps);
        law.applied(u = std::min(u, 2_V));
        CHECK(std::abs((law.now().x - observer.position()).value()) < 1e-15);
        CHECK(std::abs((law.now().v - observer.velocity()).value()) < 1e-12);
        CHECK(std::abs(law.now().disturbance.value() * B - observer.disturbance().value()) < 1e-10);
    }
}
TEST_CASE(
    "state_feedback: names a constant force and leaves no error, with 20 % less gain than believed, too") {
    for (const double gain : {B, 0.8 * B}) {
        auto law = designed<state_feedback<>>();
        quick_axis axis{0, 0, gain};
        for (int k = 0; k < 3000; ++k) {
            const auto u = law(motion(1e-3), axis.x * 1_m, 0_mps);
            law.applied(u);
            axis.step(u.value() - 0.7);
        }
        CHECK(std::abs(axis.x - 1e-3) < 1e-9);
        CHECK(std::abs(law.now().disturbance.value() + 0.7) < 1e-6);
    }
}
TEST_CASE_TEMPLATE("designed laws: settle(x, u) is held, and a start at x has no bump", Law, p_pi<>,
                   pole_placement<>, zero_phase_tracking<>, generalized_predictive_law<20>, state_feedback<>) {
    auto law = designed<Law>();
    for (int k = 0; k < 9; ++k) law(motion(1e-3 * k), 0_m, 0_mps);
    law.settle(0.2_m, 1.3_V);
    for (int k = 0; k < 30; ++k) CHECK(std::abs(law(motion(0.2), 0.2_m, 0_mps).value() - 1.3) < 1e-9);
}
TEST_CASE_TEMPLATE("designed laws: told what the amplifier applied they do not wind up, not told they do", Law,
                   p_pi<>, pole_placement<>, generalized_predictive_law<20>, state_feedback<>) {
    const auto overshoot = [](bool told) { // 10 mm that the limit of 2 V takes a fifth of a second for
        auto law = designed<Law>();
        quick_axis axis;
        double most = 0;
        for (int k = 0; k < 2000; ++k) {
            const double t = k * 1e-3, x = 0.01 * std::min(t / 0.05, 1.0), v = t < 0.05 ? 0.2 : 0;
            const auto u = law(motion(x, v), axis.x * 1_m, axis.v * 1_mps);
            const double applied = std::max(-2.0, std::min(2.0, u.value()));
            if (told) law.applied(applied * 1_V);
            axis.step(applied);
            most = std::max(most, axis.x - 0.01);
        }
        return most;
    };
    CHECK(overshoot(true) < 0.8 * overshoot(false));
}
TEST_CASE_TEMPLATE("designed laws: law_loop of their response() is what the loop does, preview and all", Law,
                   p_pi<>, pole_placement<>, zero_phase_tracking<>, generalized_predictive_law<20>,
                   state_feedback<>) {
    const analysis::law_loop loop{designed<Law>(), analysis::sampled_axis<>{plant, T}};
    for (const double hertz : {5.0, 50.0}) {
        const double wt = 2 * std::numbers::pi * hertz * 1e-3, w = wt * 1e3;
        const auto measure = [&](double reference, double push) {
            Law law = designed<Law>();
            quick_axis axis;
            cd sum = 0;
            int lead = 0;
            if constexpr (requires { Law::most_lead; }) lead = int(law.lead());
            for (int k = 0; k < 3000 + 400; ++k) {
                if (k >= 3000) sum += axis.x * std::polar(2.0 / 400, -wt * k);
                const double c = reference * std::cos(wt * (k + lead)),
                             s = reference * std::sin(wt * (k + lead));
                const auto u = law(motion(c, -w * s, -w * w * c), axis.x * 1_m, axis.v * 1_mps);
                axis.step(u.value() + push * std::cos(wt * k));
            }
            return sum;
        };
        const cd tracked = measure(1e-3, 0) / 1e-3, pushed = measure(0, 1);
        CHECK(std::abs(tracked - loop.tracking(analysis::hertz(hertz))) < 1e-6);
        CHECK(std::abs(pushed - loop.disturbance(analysis::hertz(hertz))) < 1e-6 * std::abs(pushed));
    }
}
TEST_CASE("designed laws: what no law can be is refused by name") {
    auto p = place_rst(plant, poles, T);
    p.reference[0] *= 1.01;
    CHECK(says([&] { pole_placement<>{p, T}; }, "rst.reference = "));
    p = place_rst(plant, poles, T);
    p.recovery = {1, -1.1, 0};
    CHECK(says([&] { pole_placement<>{p, T}; }, "rst.recovery = 1."));
    CHECK(says([] { place_rst(plant, {.natural = 600_Hz, .observer = 10_Hz}, T); },
               "place_rst.natural = 600 Hz"));
    auto s = place_state_feedback(plant, states, 10_V, T);
    s.velocity_gain = -s.velocity_gain;
    CHECK(says([&] { state_feedback<>{s, T}; }, "state_feedback.position_gain = "));
    s = place_state_feedback(plant, states, 0_V, T);
    CHECK(says([&] { state_feedback<>{s, T}; }, "state_feedback.drift = 0 V: must be finite and above 0"));
}
