// SPDX-License-Identifier: BSL-1.0
// Control laws of an axis at high rates: designed for poles far below the sampling rate, and run in float and
// in lanes beside double, each around an axis of its own.
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>
#include <quadrant/filter/viscous_step.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
constexpr double B = 0.63364, A = 2.5485; // x of [Yeung2006]
const axis_model<signal::voltage> plant{B * 1_mps2 / 1_V, A / 1_s};
constexpr double rates_kHz[] = {1, 4, 20, 40};
constexpr double ratios[] = {1e-4, 3e-4, 1e-3, 1e-2, 0.1, 0.3};

struct axis {
    double x = 0, v = 0;
    void step(const viscous_step<>& by, double u) {
        x += by.gained * v + B * by.way * u;
        v = by.kept * v + B * by.gained * u;
    }
};
/// The command at a sample, in any number type; lanes: that of the last one.
template <class Law> double command(Law& law, double r, double v, double a, const axis& at) {
    using real = real_of<Law>;
    const auto typed = [](auto signal, double x) {
        return quantity_of<decltype(signal), real>::from_value(real(float(x))); // both see the same digits
    };
    const auto u =
        law({typed(signal::position(), r), typed(signal::velocity(), v), typed(signal::acceleration(), a)},
            typed(signal::position(), at.x), typed(signal::velocity(), at.v))
            .value();
    if constexpr (multi_lane<real>)
        return u[1];
    else
        return double(u);
}
/// Largest difference of the positions that two laws move an axis to, as a share of the distance. A constant
/// force acts.
template <class First, class Second> double apart(First one, Second other, double ratio, duration T) {
    const viscous_step<> step(A, T.value());
    const double w = std::numbers::pi * ratio, rate = w / T.value();
    axis a, b;
    double off = 0, most = 0;
    for (int k = 0; k < int(std::min(2e5, 2000 + 4 / ratio)); ++k) {
        const double r = 0.1 * (1 - std::cos(w * k)), v = 0.1 * rate * std::sin(w * k),
                     acceleration = 0.1 * rate * rate * std::cos(w * k);
        a.step(step, command(one, r, v, acceleration, a) + 3);
        b.step(step, command(other, r, v, acceleration, b) + 3);
        off = std::max(off, std::abs(a.x - b.x));
        most = std::max(most, std::abs(a.x));
    }
    CHECK_FALSE(one.faulted());
    CHECK_FALSE(other.faulted());
    return off / most;
}
/// What a design gives, in other number types.
template <class Real, std::size_t R, std::size_t S, std::size_t T> auto in(const rst_polynomials<R, S, T>& p) {
    rst_polynomials<R, S, T, signal::voltage, parameter_real<Real>> q;
    for (std::size_t i = 0; i <= R; ++i) q.r[i] = parameter_real<Real>(p.r[i]);
    for (std::size_t i = 0; i <= S; ++i)
        q.feedback[i] = decltype(q.feedback)::value_type::from_value(p.feedback[i].value());
    for (std::size_t i = 0; i <= T; ++i)
        q.reference[i] = decltype(q.reference)::value_type::from_value(p.reference[i].value());
    q.recovery = p.recovery;
    return q;
}
template <class F> auto if_possible(F&& design) -> std::optional<decltype(design())> {
    try {
        return design();
    } catch (const invalid_parameter&) {
        return std::nullopt; // no such loop around this axis, for reasons of its own
    }
}
} // namespace

TEST_CASE("place_rst: the poles of the sampled loop lie where they were asked for, down to 1e-4 of the "
          "sampling rate") {
    for (const double kHz : rates_kHz)
        for (const double ratio : ratios) {
            CAPTURE(kHz);
            CAPTURE(ratio);
            const duration T = 1_ms / kHz;
            const rst_poles poles{ratio * once_per(T), 0.8, std::min(1.5 * ratio, 0.45) * once_per(T)};
            // The pair is slower than the observer's poles: its |z| is the radius.
            const double decay = -std::log(loop_radius(pulse_transfer(plant, T), place_rst(plant, poles, T)));
            CHECK(decay ==
                  doctest::Approx(0.8 * 2 * std::numbers::pi * ratio).epsilon(ratio < 1e-3 ? 0.2 : 0.02));
        }
}

TEST_CASE(
    "every control law: float and lanes move an axis as double does, within eps (30 + 1/ratio) of the way, at "
    "every rate and ratio") {
    int tried = 0;
    for (const double kHz : rates_kHz)
        for (const double ratio : ratios) {
            CAPTURE(kHz);
            CAPTURE(ratio);
            const duration T = 1_ms / kHz;
            const frequency f = ratio * once_per(T);
            const rst_poles poles{f, 0.8, std::min(1.5 * ratio, 0.45) * once_per(T)};
            const double bound = double(std::numeric_limits<float>::epsilon()) * (30 + 1 / ratio);
            const auto as_rst = [&]<std::size_t R, std::size_t S, std::size_t N>(
                                    const rst_polynomials<R, S, N>& p) {
                const rst<R, S, N> exact(p, T);
                CHECK(apart(exact, rst<R, S, N, 0, float>(in<float>(p), T), ratio, T) <= bound);
                CHECK(apart(exact, rst<R, S, N, 0, lanes<2>>(in<lanes<2>>(p), T), ratio, T) <= 1e-10 / ratio);
                ++tried;
            };
            if (const auto p = if_possible([&] { return place_rst(plant, poles, T); })) as_rst(*p);
            if (const auto p = if_possible([&] { return design_lead_lag(plant, {.crossover = f}, T); }))
                as_rst(*p);
            const auto both = [&](const auto& exact, const auto& rough) {
                CHECK(apart(exact, rough, ratio, T) <= bound);
                ++tried;
            };
            if (const auto p = if_possible([&] { return place_p_pi(plant, {.natural = f}, T); }))
                if (p->gain.value() >= 0)
                    both(p_pi<>(*p, T), p_pi<float>({.position_gain = p->position_gain,
                                                     .gain = p->gain,
                                                     .integral_gain = p->integral_gain,
                                                     .velocity_weight = p->velocity_weight,
                                                     .acceleration_gain = p->acceleration_gain},
                                                    T));
            if (const auto p = place_pid(plant, {f}); ratio < 0.05 && p.derivative_gain.value() >= 0)
                both(pid<>(p, T), pid<float>({.gain = p.gain,
                                              .integral_gain = p.integral_gain,
                                              .derivative_gain = p.derivative_gain},
                                             T));
            // An observer as fast as the loop: its three poles lie at (B drift / (noise sqrt(T)))^(1/3).
            const double speed = 2 * std::numbers::pi * f.value();
            const auto noise = B * 10 / (std::sqrt(T.value()) * speed * speed * speed) * 1_m;
            if (const auto p = if_possible([&] {
                    return place_state_feedback(plant, {.natural = f, .encoder_noise = noise}, 10_V, T);
                }))
                both(state_feedback<>(*p, T),
                     state_feedback<float>({.plant = {p->plant.gain, p->plant.viscous_rate},
                                            .position_gain = p->position_gain,
                                            .velocity_gain = p->velocity_gain,
                                            .encoder_noise = p->encoder_noise,
                                            .drift = p->drift},
                                           T));
            if (ratio < 0.05) {
                const auto w = 2 * std::numbers::pi * ratio / T;
                const auto gain = w / plant.gain;
                both(sliding_mode<>({plant, w, gain, w * gain}, T),
                     sliding_mode<float>({{plant.gain, plant.viscous_rate}, w, gain, w * gain}, T));
            }
        }
    CHECK(tried > 40);
}

TEST_CASE_TEMPLATE("proportional_integral in float: parts below the last digit of the integral are not lost",
                   Rule, integral_clamp, conditional_integration, back_calculation) {
    using pi_loop = proportional_integral<signal::velocity, signal::voltage, Rule, float>;
    typename pi_loop::parameters p{0.0 * (1_V / 1_mps), 1_V / 1_m, 100_V};
    if constexpr (std::same_as<Rule, back_calculation>) p.anti_windup = {10_ms};
    pi_loop loop(p, 25_us);
    using velocity = quantity_of<signal::velocity, float>;
    using voltage = quantity_of<signal::voltage, float>;
    loop.settle(velocity(), voltage::from_value(10));
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> part(1e-3f,
                                               2e-3f); // 5e-8 V a sample; the last digit of 10 V is 9.5e-7
    double sum = 10;
    for (int k = 0; k < 1'000'000; ++k) {
        const float e = part(engine);
        sum += double(float(25e-6)) * double(e);
        loop(velocity::from_value(e));
    }
    CHECK(double(loop.now().integral.value()) == doctest::Approx(sum).epsilon(2e-7));
    CHECK(sum > 10.03);
}
