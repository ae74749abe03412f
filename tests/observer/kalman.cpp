// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/observer/kalman.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
namespace s = quadrant::signal;
using doctest::Approx;
const duration T = 500_us;
using filter = kalman<s::voltage>;
static_assert(maps<filter, s::position, s::velocity>); // may stand where a cascade has its differentiator

// The x axis of [Jamaludin2008] with its encoder of 0.25 um.
const filter::parameters x_axis{.mass = 340_kg,
                                .force_constant = 1450_N / 1_V,
                                .viscous = 9713.8_N / 1_mps,
                                .encoder_noise = 0.25_um / std::sqrt(12.0),
                                .drift = 20_N};

/// The axis, exact for a held command and force.
struct plant {
    double position = 0, velocity = 0;
    void step(double force) {
        const double m = 340, c = 9713.8, e = std::exp(-c / m * T.value()), to = force / c;
        position += to * T.value() + (velocity - to) * (1 - e) * m / c;
        velocity = to + (velocity - to) * e;
    }
};

/// The same filter without the disturbance: the force noise that gives about the bandwidth of the other.
struct two_states {
    sampled_system<2> model;
    column<2> gain;
    two_states() {
        const double m = 340, c = 9713.8, sigma = x_axis.encoder_noise.value(), h = T.value();
        model = sampled<2, double>({{{0, 1}, {0, -c / m * h}}}, {0, 1450 * h * h / (m * sigma)},
                                   {{{0, 0}, {0, 1e-4}}},
                                   1.0); // in units of sigma and period
        gain = kalman_gain<2, double>(model.step, {1, 0}, model.noise, 1).gain;
    }
    double operator()(double encoder, double u) { // velocity in m/s
        const double sigma = x_axis.encoder_noise.value();
        column<2> p{x_[0] + model.step[0][1] * x_[1] + model.from_input[0] * u,
                    model.step[1][1] * x_[1] + model.from_input[1] * u};
        const double off = encoder / sigma - p[0];
        x_ = {p[0] + gain[0] * off, p[1] + gain[1] * off};
        return x_[1] * sigma / T.value();
    }
    column<2> x_{};
};
} // namespace

TEST_CASE("kalman: gain and deviations are those of scipy's Riccati solution") {
    // F=[[0,1,0],[0,-28.57,1/340],[0,0,0]], Qc=diag(0,0,20^2), van Loan's Phi, Qd over 0.5 ms;
    // states scaled by S=diag(1/s, T/s, T^2/(340 s)), s=.25e-6/sqrt(12):
    // P=scipy.linalg.solve_discrete_are((S@Phi@inv(S)).T, [[1],[0],[0]], S@Qd@S, [[1]]);
    // K=inv(S)@P[:,:1]/(P[0,0]+1)/s
    constexpr std::array K{0.2721735310252471, 86.27823279110281, 5286637.533312757};
    filter f{x_axis, T};
    f(1_m); // from rest at zero, the first reading moves every state by its gain
    CHECK(f.position().value() == Approx(K[0]).epsilon(1e-9));
    CHECK(f.velocity().value() == Approx(K[1]).epsilon(1e-9));
    CHECK(f.disturbance().value() == Approx(K[2]).epsilon(1e-9));
    CHECK(f.expected().innovation.value() == Approx(8.459320176235473e-08).epsilon(1e-9).scale(0));
    CHECK(f.expected().position.value() == Approx(3.7650e-08).epsilon(1e-3).scale(0));
    // log of the slowest of numpy.linalg.eigvals(Phi - Phi K C) over 2 pi T
    CHECK(f.bandwidth().value() == Approx(26.417849179844286).epsilon(1e-9));
}
TEST_CASE("kalman: without the disturbance as a state a constant force biases the speed; with it, not") {
    filter three{x_axis, T};
    two_states two;
    plant p;
    const double push = 150, u = 0.5; // N that the command does not know of, V
    double bias = 0, none = 0;
    for (int k = 0; k < 4000; ++k) {
        p.step(1450 * u + push);
        none = three(p.position * 1_m, u * 1_V).value() - p.velocity;
        bias = two(p.position, u) - p.velocity;
    }
    CHECK(std::abs(none) < 1e-9);
    // Error e of the estimate at rest: a period adds w to it, a reading takes g r off, r the innovation. So
    // g_x r = e_x' + w_x and g_v r = w_v - (1 - a) e_v, with e_x' = h e_v for the position; r is eliminated.
    const double w_x = two.model.from_input[0] * push / 1450, w_v = two.model.from_input[1] * push / 1450;
    const double h = two.model.step[0][1], a = two.model.step[1][1], share = two.gain[0] / two.gain[1];
    const double e_v = (share * w_v - w_x) / (h + share * (1 - a)); // in encoder noise over period
    CHECK(bias == Approx(-e_v * x_axis.encoder_noise.value() / T.value()).epsilon(1e-6).scale(0));
    CHECK(std::abs(bias) > 2e-3);
    CHECK(three.disturbance().value() == Approx(push).epsilon(1e-6));
}
TEST_CASE("kalman: no lag while the command accelerates the axis") {
    filter f{x_axis, T};
    plant p;
    double worst = 0;
    for (int k = 0; k < 2000; ++k) {
        const double u = 5 * std::sin(0.02 * k) * std::sin(0.003 * k);
        p.step(1450 * u);
        worst = std::max(worst, std::abs(f(p.position * 1_m, u * 1_V).value() - p.velocity));
    }
    CHECK(worst < 1e-12); // m/s, exact discretization
}
TEST_CASE("kalman: on noise as declared the innovations are white and the errors as large as expected") {
    filter f{x_axis, T};
    plant p;
    std::mt19937 bits(7);
    std::normal_distribution<double> normal;
    double d = 0, sum_x = 0, sum_v = 0, sum_d = 0;
    std::vector<double> e;
    constexpr int n = 40000;
    for (int k = 0; k < n + 500; ++k) {
        const double u = 3 * std::sin(0.01 * k);
        d += 20 * std::sqrt(T.value()) * normal(bits);
        p.step(1450 * u + d);
        f((p.position + x_axis.encoder_noise.value() * normal(bits)) * 1_m, u * 1_V);
        if (k < 500) continue;
        e.push_back(f.innovation().value());
        sum_x += std::pow(f.position().value() - p.position, 2);
        sum_v += std::pow(f.velocity().value() - p.velocity, 2);
        sum_d += std::pow(f.disturbance().value() - d, 2);
    }
    double power = 0;
    for (const double each : e) power += each * each;
    for (std::size_t lag = 1; lag <= 50; ++lag) {
        double product = 0;
        for (std::size_t k = lag; k < e.size(); ++k) product += e[k] * e[k - lag];
        CAPTURE(lag);
        CHECK(std::abs(product / power) < 4 / std::sqrt(double(n))); // four standard deviations of white noise
    }
    // 40000 samples hold some 2000 independent errors: 2 % in a deviation, times three.
    CHECK(std::sqrt(power / n) == Approx(f.expected().innovation.value()).epsilon(0.02).scale(0));
    CHECK(std::sqrt(sum_x / n) == Approx(f.expected().position.value()).epsilon(0.06).scale(0));
    CHECK(std::sqrt(sum_v / n) == Approx(f.expected().velocity.value()).epsilon(0.06).scale(0));
    CHECK(std::sqrt(sum_d / n) == Approx(f.expected().disturbance.value()).epsilon(0.06).scale(0));
}
TEST_CASE("kalman: behind an encoder of 0.25 um it is 5 times quieter than the thesis' derivative of 150 Hz") {
    filter f{x_axis, T};
    filtered_derivative<s::position, s::velocity> derivative{{150_Hz}, T};
    quantizer<s::position> encoder{{0.25_um}, T};
    plant p;
    double noise = 0, rough = 0;
    for (int k = 0; k < 20000; ++k) {
        const double u = 1.3 + 0.1 * std::sin(0.001 * k); // slow changes: no lag that counts in either
        p.step(1450 * u);
        const auto reading = encoder(p.position * 1_m);
        const double v = f(reading, u * 1_V).value(), w = derivative(reading).value();
        if (k < 4000) continue;
        noise += std::pow(v - p.velocity, 2);
        rough += std::pow(w - p.velocity, 2);
    }
    CHECK(std::sqrt(rough / noise) > 5);
}
TEST_CASE("kalman: at rest far from zero nothing moves, to the last bit; a bad command is a bad sample") {
    filter f{x_axis, T};
    f(0.1_um);
    f.settle(0.7_m);
    CHECK(f.innovation() == 0_m);
    for (int k = 0; k < 100; ++k) CHECK(f(0.7_m) == 0_mps);
    f(0.701_m);
    const auto last = f.velocity();
    const auto before = f.now();
    CHECK(f(0.7_m, std::nan("") * 1_V) == last);
    CHECK(f(std::numeric_limits<double>::infinity() * 1_m) == last);
    CHECK(f.faulted());
    CHECK(f.now().position == before.position);
    CHECK(f.now().disturbance == before.disturbance);
}
TEST_CASE("kalman: with half_step a reading within half a step of the prediction changes nothing, one outside "
          "counts from "
          "there") {
    auto p = x_axis;
    filter noisy(p, T);
    p.half_step = 0.125_um;
    filter bounded(p, T);
    CHECK(bounded(0.12_um) == 0_mps);
    CHECK(bounded.position() == 0_m);
    CHECK(bounded.innovation() == 0_m);
    for (const double way : {1.0, -1.0}) {
        bounded.reset(), noisy.reset();
        CHECK(bounded(way * 0.525_um).value() == Approx(noisy(way * 0.4_um).value()).scale(0));
        CHECK(bounded.disturbance().value() == Approx(noisy.disturbance().value()).scale(0));
    }
    bounded.settle(1_um);
    CHECK(bounded(std::nan("") * 1_m) == 0_mps); // not taken for a reading inside
    CHECK(bounded.faulted());
    CHECK(bounded.position() == 1_um);
}
TEST_CASE("kalman: with half_step an axis that stands anywhere is told to stand still; with noise every "
          "reading shakes it") {
    auto p = x_axis;
    filter noisy(p, T);
    p.half_step = 0.125_um;
    filter bounded(p, T);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.02e-6, 0.02e-6); // at the edge of two counts
    double shaken = 0, still = 0;
    for (int k = 0; k < 4000; ++k) {
        const auto reading = 0.25_um * std::floor((10.25e-6 + jitter(random)) / 0.25e-6) + 0.125_um;
        const double a = noisy(reading).value(), b = bounded(reading).value();
        if (k >= 3000) shaken = std::max(shaken, std::abs(a)), still = std::max(still, std::abs(b));
    }
    CHECK(shaken > 5e-6);
    CHECK(still < 0.02 * shaken);
}
TEST_CASE("kalman: refuses noise that is none, and a mass that is none") {
    const auto with = [](auto change) {
        auto p = x_axis;
        change(p);
        return filter(p, T);
    };
    CHECK_THROWS_WITH_AS(with([](auto& p) { p.encoder_noise = 0_m; }),
                         "kalman.encoder_noise = 0 m: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS(with([](auto& p) { p.drift = -1_N; }),
                         "kalman.drift = -1 N: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS(with([](auto& p) { p.half_step = -1_um; }),
                         "kalman.half_step = -1e-06 m: must be finite and not below 0", invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.mass = 0_kg; }), invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.force_constant = 0_N / 1_V; }), invalid_parameter);
    CHECK_THROWS_AS(with([](auto& p) { p.viscous = -1_N / 1_mps; }), invalid_parameter);
    CHECK_THROWS_AS(filter(x_axis, 0_s), invalid_parameter);
    CHECK_NOTHROW(with([](auto& p) { p.viscous = 0_N / 1_mps; }));
    CHECK_NOTHROW(with([](auto& p) { p.drift = 1e5_N; }));
    CHECK_NOTHROW(with([](auto& p) { p.drift = 0.01_N; })); // 2 Hz
}
