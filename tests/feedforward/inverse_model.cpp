// SPDX-License-Identifier: BSL-1.0
#include "linear_plant.hpp"

#include <quadrant/analysis/loop.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using axis = milling_axis<milling_axis_boxes<>>;
constexpr double A = 28.57, B = 4.526; // x axis of [Jamaludin2008]
axis::motion motion(double x, double v, double a) { return {x * 1_m, v * 1_mps, a * 1_mps2}; }
axis loop(duration period) {
    return {.box = {{.position_gain = 150.0 / 1_s,
                     .velocity_gain = 60_V / 1_mps,
                     .velocity_integral = 450_V / 1_m,
                     .estimator_corner = 942.5 / (2 * pi) * 1_Hz,
                     .notch = {330_Hz, 0.0606},
                     .plant_gain = B * 1_mps2 / 1_V,
                     .plant_pole = A / 1_s,
                     .friction = {},
                     .disturbance = {},
                     .memory = {},
                     .limit = 10_V,
                     .dac_step = {}},
                    period}};
}

/// Tracking errors along `path`, a function of the sample, of the loop on the linear plant.
template <class Path>
std::vector<double> errors(duration period, double delay, duration lead, int samples, Path path) {
    axis control = loop(period);
    preview<2, axis::motion> look{{lead}, period};
    linear_plant plant(A, B, delay, period.value());
    std::vector<double> out;
    double y = 0;
    for (int k = 0; k < samples; ++k) {
        const auto r = look(path(k));
        out.push_back(r.reference.position.value() - y);
        y = plant(control(r.reference, r.ahead, y * 1_m).value());
    }
    return out;
}
double largest(const std::vector<double>& e, std::size_t skip = 0) {
    double most = 0;
    for (std::size_t k = skip; k < e.size(); ++k) most = std::max(most, std::abs(e[k]));
    return most;
}
} // namespace

TEST_CASE("inverse_model: x axis by hand: 2 m/s^2 at 0.1 m/s need (2 + 2.857) / 4.526 = 1.07313 V") {
    inverse_model<signal::voltage> f{{B * 1_mps2 / 1_V, A / 1_s}, 500_us};
    CHECK(f(0.1_mps, 2_mps2).value() == doctest::Approx(1.07313).epsilon(1e-5));
    CHECK(f(axis_motion<>{3_m, 0.1_mps, 2_mps2}) == f(0.1_mps, 2_mps2));
    CHECK(f(-0.1_mps, -2_mps2) == -f(0.1_mps, 2_mps2));
}
TEST_CASE("inverse_model: times the plant it is one, at any frequency") {
    const inverse_model<signal::voltage> f{{B * 1_mps2 / 1_V, A / 1_s}, 500_us};
    const analysis::rigid_axis_model<> plant{A / 1_s, B * 1_mps2 / 1_V, 0_s};
    for (const double at : {0.1, 5.0, 80.0, 900.0})
        CHECK(std::abs(f.response(at * 1_Hz) * plant(at * 1_Hz) - 1.0) < 1e-12);
}
TEST_CASE("inverse_model: is the inertia and drag of a milling_axis in one box") {
    axis a = loop(500_us);
    inverse_model<signal::voltage> f{{B * 1_mps2 / 1_V, A / 1_s}, 500_us};
    const auto m = motion(0.01, 0.07, 1.3);
    a(m, 0_m);
    CHECK(f(m).value() == doctest::Approx((a.wire.inertia + a.wire.drag).value()).epsilon(1e-14));
}
TEST_CASE("inverse_model: advanced by the delay the error of the whole loop is zero to rounding (1e-13 m), for "
          "a path "
          "whose exact command changes at the samples only") {
    // The path that u[k], held for a period each, drives without delay; T = 0.325 ms, so that 0.65 ms are two
    // of them.
    const double T = 0.325e-3;
    struct {
        double x = 0, v = 0;
    } s;
    linear_plant exact(A, B, 0, T);
    std::vector<axis::motion> path;
    for (int k = 0; k < 12000; ++k) {
        const double u = 0.8 * ((k / 1500) % 2 ? -1 : 1) + 0.3 * std::sin(0.02 * k);
        path.push_back(motion(s.x, s.v, B * u - A * s.v));
        s.x = exact(u), s.v = exact.velocity();
    }
    const auto of = [&](int k) { return path[std::size_t(k)]; };
    CHECK(largest(errors(T * 1_s, 0.65e-3, 0.65_ms, 12000, of)) < 1e-13);
    CHECK(largest(errors(T * 1_s, 0.65e-3, 0_s, 12000, of)) > 5e-6);
}
TEST_CASE(
    "inverse_model: on the thesis' sine (30 mm, 100 mm/s, 2 kHz, delay 0.40 ms and the hold) without preview "
    "the "
    "error is the closed form |1 - exp(-s Td)| |S| r to 0.1 %, with it the hold's (w T)^2/24 |S| r to 1 %") {
    const double w = 0.1 / 0.03, Td = 0.65e-3;
    const auto path = [&](int k) {
        const double t = k * 5e-4;
        return motion(0.03 * (1 - std::cos(w * t)), 0.03 * w * std::sin(w * t), 0.03 * w * w * std::cos(w * t));
    };
    const int samples = 24000; // 12 s: the slowest pole, 7.5 1/s, is long gone
    const std::size_t skip = 20000;
    const analysis::p_pi_loop closed{analysis::rigid_axis_model<>{A / 1_s, B * 1_mps2 / 1_V, Td * 1_s},
                                     analysis::pi_model<>{60_V / 1_mps, 450_V / 1_m},
                                     analysis::in_series{analysis::derivative_model{942.5 / (2 * pi) * 1_Hz},
                                                         analysis::notch_model{330_Hz, 0.0606}},
                                     150.0 / 1_s};
    const std::complex<double> s(0, w);
    const double through = std::abs(closed.sensitivity(w / (2 * pi) * 1_Hz)) * 0.03;
    const double expected = std::abs(1.0 - std::exp(-s * Td)) * through;
    const double of_hold = std::pow(w * 5e-4, 2) / 24 * through;
    const double late = largest(errors(500_us, 0.4e-3, 0_s, samples, path), skip);
    const double early = largest(errors(500_us, 0.4e-3, 0.65_ms, samples, path), skip);
    CHECK(late == doctest::Approx(expected).epsilon(1e-3).scale(0));
    CHECK(expected == doctest::Approx(62.2e-9).epsilon(1e-3).scale(0));
    CHECK(early == doctest::Approx(of_hold).epsilon(0.01).scale(0));
    CHECK(of_hold == doctest::Approx(3.3e-12).epsilon(0.01).scale(0));
}
TEST_CASE("inverse_model: not finite holds the last command, also at settle") {
    inverse_model<signal::voltage> f{{B * 1_mps2 / 1_V, A / 1_s}, 500_us};
    const auto u = f(0.1_mps, 2_mps2);
    CHECK(f(std::numeric_limits<double>::quiet_NaN() * 1_mps, 0_mps2) == u);
    CHECK(f.faulted());
    f.settle(0.2_mps, 0_mps2);
    CHECK_FALSE(f.faulted());
    CHECK(f(0_mps, std::numeric_limits<double>::infinity() * 1_mps2).value() == doctest::Approx(0.2 * A / B));
}
TEST_CASE("inverse_model: refuses a gain that is not positive and a negative pole") {
    const auto refusal = [](double b, double a) -> std::string {
        try {
            inverse_model<signal::voltage>{{b * 1_mps2 / 1_V, a * 1_per_s}, 500_us};
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return "";
    };
    CHECK(refusal(0, 1) == "inverse_model.gain = 0 m/(V s^2): must be finite and above 0");
    CHECK(refusal(4, -1) == "inverse_model.viscous_rate = -1 per s: must be finite and not below 0");
    CHECK(refusal(4, 0) == "");
}
