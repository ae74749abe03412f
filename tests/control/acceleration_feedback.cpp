// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/impulse_test.hpp>
#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/acceleration_feedback.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/loop/feed_control.hpp>
#include <quadrant/loop/feed_drive.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using law = acceleration_feedback<pid<>>;
const duration T = 1_ms;
const pid<>::parameters gains{
    .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};

/// Motion and measurement of sample k, of whatever kind.
axis_motion<> asked(int k) {
    return {1e-3 * std::sin(0.1 * k) * 1_m, 0.1 * std::cos(0.1 * k) * 1_mps, -3 * std::sin(0.1 * k) * 1_mps2};
}

/// The x axis of a virtual CNC without friction and rounding.
feed_drive_boxes<>::parameters machine() {
    const asymmetric_stribeck<>::side none{0_Nm, 0_Nm, 1_radps, 1_radps};
    return {.amplifier = 6.4898_A / 1_V,
            .drive = {.inertia = 0.0077736_kgm2,
                      .viscous = 0.019811_Nm / 1_radps,
                      .torque_constant = 0.4769_Nm / 1_A,
                      .pitch = 10_mm,
                      .friction = {none, none, {}}}};
}

/// Its linear part by the matrix exponential of B / (s (s + A)), under a law, as an impulse test takes it.
template <class Law> struct running {
    axis_model<signal::voltage> plant = model_of(feed_drive_boxes<>(machine(), T));
    feed_control<feed_control_boxes<Law>> control;
    double x = 0, v = 0, a = 0;

    explicit running(const typename Law::parameters& p)
        : control{.box = {{.law = p,
                           .limit = quantity<si::electric_potential>::from_value(
                               std::numeric_limits<double>::infinity())},
                          T}} {}
    void rest() {
        x = v = a = 0;
        control.settle(0_m);
    }
    std::size_t lead() const { return 0; }
    analysis::loop_sample step(const axis_motion<>& r, double push) {
        const double A = plant.viscous_rate.value(), B = plant.gain.value(), h = T.value(),
                     kept = std::exp(-A * h);
        const double place = x, u = control(r, {x * 1_m, v * 1_mps, a * 1_mps2}).value() + push;
        const double goal = B * u / A, next = goal + (v - goal) * kept;
        x += goal * h + (v - goal) * (1 - kept) / A;
        a = (next - v) / h, v = next;
        return {u, place, r.position.value()};
    }
};
} // namespace

TEST_CASE("acceleration_feedback: with gain 0 it is the law itself") {
    law with({.law = gains, .gain = {}, .corner = 100_Hz}, T);
    pid<> alone(gains, T);
    for (int k = 0; k < 200; ++k) {
        const auto r = asked(k);
        const auto x = 0.9 * r.position;
        const auto v = 0.8 * r.velocity;
        CHECK(with(r, x, v, 0.5 * r.acceleration).value() == alone(r, x, v).value());
    }
}

TEST_CASE(
    "acceleration_feedback: adds the gain times what a bilinear low pass makes of the missing acceleration") {
    const double corner = 100, gain = 1.5, t = std::tan(std::acos(-1.0) * corner * 1e-3);
    law with({.law = gains, .gain = gain * 1_V / 1_mps2, .corner = 100_Hz}, T);
    pid<> alone(gains, T);
    double before = 0, filtered = 0;
    for (int k = 0; k < 200; ++k) {
        const auto r = asked(k);
        const auto measured = double(k % 7 - 3) * 0.4_mps2;
        const double missing = r.acceleration.value() - measured.value();
        filtered = ((1 - t) * filtered + t * (missing + before)) / (1 + t);
        before = missing;
        const double u = with(r, 0.9 * r.position, 0.8 * r.velocity, measured).value(),
                     of_law = alone(r, 0.9 * r.position, 0.8 * r.velocity).value();
        CHECK(u - of_law == doctest::Approx(gain * filtered).epsilon(1e-9).scale(1));
    }
}

TEST_CASE("acceleration_feedback: its response is what a pulse finds in the running loop, sample by sample") {
    const law::parameters p{.law = gains, .gain = 0.9_V / 1_mps2, .corner = 80_Hz};
    running<law> loop(p);
    const analysis::impulse_test found(loop, T, 0.01, 1e-6);
    REQUIRE(found.decays());
    const analysis::law_loop written{law(p, T), analysis::sampled_axis<>{loop.plant, T}};
    for (const double f : {3.0, 20.0, 47.0, 90.0, 200.0, 390.0}) {
        CAPTURE(f);
        const auto at = analysis::hertz(f);
        CHECK(std::abs(found.open(at) / written.open(at) - 1.0) < 1e-5);
        CHECK(std::abs(found.disturbance(at) / written.disturbance(at) - 1.0) < 1e-5);
    }
}

TEST_CASE(
    "acceleration_feedback: a disturbance meets an axis heavier by 1 + gain B, below the filter's corner") {
    const auto plant = running<pid<>>(gains).plant;
    pid<>::parameters soft = gains; // so that 40 Hz is far above its bandwidth
    soft.gain *= 1e-3, soft.integral_gain *= 1e-3, soft.derivative_gain *= 1e-2;
    const double heavier = 0.5; // gain B
    const law with({.law = soft, .gain = heavier / plant.gain, .corner = 400_Hz}, T);
    const analysis::sampled_axis<> axis{plant, T};
    const analysis::law_loop a{with, axis};
    const analysis::law_loop b{pid<>(soft, T), axis};
    const double ratio = std::abs(a.disturbance(20_Hz)) / std::abs(b.disturbance(20_Hz));
    CHECK(ratio == doctest::Approx(1 / (1 + heavier)).epsilon(0.01));
}

TEST_CASE("feed_drive: the accelerometer reads the mean acceleration of the last period, and its noise") {
    auto parts = machine();
    feed_drive<feed_drive_boxes<>> quiet{.box = {parts, T}};
    parts.accelerometer_noise = 0.2_mps2;
    feed_drive<feed_drive_boxes<>> noisy{.box = {parts, T}};
    double before = 0, squares = 0;
    constexpr int samples = 4000;
    for (int k = 0; k < samples; ++k) {
        const auto u = std::sin(0.03 * k) * 0.5_V;
        const auto now = quiet(u);
        CHECK(now.acceleration.value() ==
              doctest::Approx((now.velocity.value() - before) / 1e-3).epsilon(1e-9));
        before = now.velocity.value();
        const double off = noisy(u).acceleration.value() - now.acceleration.value();
        squares += off * off / samples;
    }
    CHECK(std::sqrt(squares) == doctest::Approx(0.2).epsilon(0.05));
}

TEST_CASE(
    "acceleration_feedback: what the amplifier cuts off is charged to the law, not to the accelerometer") {
    law with({.law = gains, .gain = 1.5_V / 1_mps2, .corner = 100_Hz}, T);
    pid<> alone(gains, T);
    for (int k = 0; k < 50; ++k) {
        const auto r = asked(k);
        const auto u = with(r, 0_m, 0_mps, 0_mps2), of_law = alone(r, 0_m, 0_mps);
        const auto cut = 0.25 * u;
        with.applied(u - cut);
        alone.applied(of_law - cut);
        CHECK((u - with.added()).value() == doctest::Approx(of_law.value()).epsilon(1e-9));
    }
}

TEST_CASE("acceleration_feedback: refuses what it cannot run, and holds through NaN") {
    const auto message = [](const law::parameters& p) -> std::string {
        try {
            law(p, T);
        } catch (const invalid_parameter& e) {
            return e.what();
        }
        return {};
    };
    CHECK(message({.law = gains, .gain = -1_V / 1_mps2, .corner = 100_Hz})
              .find("acceleration_feedback.gain = -1") == 0);
    CHECK(message({.law = gains, .gain = 1_V / 1_mps2, .corner = 500_Hz}).find("lowpass.corner") == 0);
    law with({.law = gains, .gain = 1_V / 1_mps2, .corner = 100_Hz}, T);
    const auto last = with(asked(3), 0_m, 0_mps, 0_mps2);
    CHECK(with(asked(4), 0_m, 0_mps, std::nan("") * 1_mps2) == last);
    CHECK(with.faulted());
    with.settle(1_m, 2_V);
    CHECK_FALSE(with.faulted());
    CHECK(with({1_m, 0_mps, 0_mps2}, 1_m, 0_mps, 0_mps2).value() == doctest::Approx(2));
}
