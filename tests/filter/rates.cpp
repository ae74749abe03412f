// SPDX-License-Identifier: BSL-1.0
// Every block with a corner, from a hundred thousandth of the sampling rate to half of it: float and lanes
// beside double.
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>
#include <quadrant/plant/flexible_modes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

namespace {
constexpr double rates_kHz[] = {1, 4, 20, 40};
constexpr double ratios[] = {1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.45, 0.49};

template <class Make> struct entry {
    std::string name;
    Make make; ///< (Real(), corner, period)
};
template <class Make> entry(const char*, Make) -> entry<Make>;
template <class R> using hertz = quantity<hertz_unit, parameter_real<R>>;
template <class R, class Unit> auto all(quantity<Unit> q) {
    return quantity<Unit, parameter_real<R>>::from_value(parameter_real<R>(q.value()));
}

const std::tuple in_lanes{
    entry{"notch",
          []<class R>(R, hertz<R> f, duration T) {
              return notch<s::force, R>({f, R(0.1)}, T);
          }},
    entry{"butterworth", []<class R>(R, hertz<R> f, duration T) { return butterworth<s::force, R>({f}, T); }},
    entry{"lowpass", []<class R>(R, hertz<R> f, duration T) { return lowpass<s::force, R>({f}, T); }},
    entry{"series",
          []<class R>(R, hertz<R> f, duration T) {
              using in_row = series<notch<s::force, R>, lowpass<s::force, R>>;
              return in_row({{f, R(0.5)}, {f}}, T);
          }},
    entry{"filtered_derivative",
          []<class R>(R, hertz<R> f, duration T) {
              return filtered_derivative<s::position, s::velocity, R>({f}, T);
          }},
    entry{"disturbance_observer",
          []<class R>(R, hertz<R> f, duration T) {
              return disturbance_observer<s::voltage, s::position, 2, 0, 2, 0, R>(
                  {f, axis_model<s::voltage, parameter_real<R>>{all<R>(4.526_mps2 / 1_V), all<R>(28.57 / 1_s)}},
                  T);
          }},
    entry{"disturbance_observer of order 3",
          []<class R>(R, hertz<R> f, duration T) {
              return disturbance_observer<s::voltage, s::position, 3, 0, 2, 0, R>(
                  {f, axis_model<s::voltage, parameter_real<R>>{all<R>(4.526_mps2 / 1_V), all<R>(28.57 / 1_s)}},
                  T);
          }},
};
const std::tuple one_at_a_time{
    entry{"transfer_function of differences",
          []<class R>(R, hertz<R> f, duration T) { // a lead-lag with a low-pass of third order
              using block = transfer_function<s::force, s::force, 3, R>;
              const double w = 2 * pi * f.value();
              return block::of(
                  bilinear_differences(
                      continuous<3>{{w * w * w, w * w / 3, w}, {w * w * w, 2 * w * w, 2 * w, 1}}, T),
                  T);
          }},
    entry{"ferraris_force_estimator of order 3",
          []<class R>(R, hertz<R> f, duration T) {
              return ferraris_force_estimator<s::voltage, 3, 1, R>(
                  {.mass = 170_kg, .force_constant = 1470_N / 1_V, .corner = f}, T);
          }},
    entry{"reduced_order_observer",
          []<class R>(R, hertz<R> f, duration T) {
              return reduced_order_observer<s::voltage, R>(
                  {.mass = 170_kg, .force_constant = 1470_N / 1_V, .viscous = 3400_N / 1_mps, .corner = f}, T);
          }},
    entry{"flexible_modes",
          []<class R>(R, hertz<R> f, duration T) {
              return flexible_modes<1, R>({340_kg, {{{f, 0.05, 0.2}}}}, T);
          }},
};
template <class F> void for_each(F&& f, const auto& of) {
    std::apply([&](const auto&... each) { (f(each), ...); }, of);
}

/// Held, a sine at the corner, a fast sine under noise.
std::vector<float> signal_of(int kind, double ratio) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<float> x(std::size_t(std::min(3e5, 1000 + 3 / ratio)));
    for (std::size_t k = 0; k < x.size(); ++k) {
        const float sine =
            float(std::sin(2 * pi * (kind == 2 ? std::min(0.3, 30 * ratio) : ratio) * double(k)));
        x[k] = kind == 0 ? 100 : kind == 1 ? 100 * sine : 100 * sine + 30 * unit(engine);
    }
    return x;
}
/// A rounding error of every sample stays for 1/(pi damping ratio) samples, damping from 0.1 on; near half the
/// sampling rate it grows as tan^2.
double bound(double ratio) {
    const double t = std::tan(pi * ratio);
    return double(std::numeric_limits<float>::epsilon()) * (8 + 1 / (0.1 * pi * ratio) + 4 * t * t);
}
template <class Real, class Block> double give(Block& block, Real x) {
    return detail::plain(block(Block::argument::from_value(x)));
}
} // namespace

TEST_CASE(
    "every filter and observer: float follows double within eps (3/ratio + 4 tan^2), at every rate and ratio") {
    for (const double kHz : rates_kHz)
        for (const double ratio : ratios)
            for (int kind = 0; kind < 3; ++kind) {
                const duration T = 1_ms / kHz;
                const auto x = signal_of(kind, ratio);
                const auto check = [&](const auto& e) {
                    auto exact = e.make(double(), ratio * once_per(T), T);
                    auto rough = e.make(float(), ratio * once_per(T), T);
                    double off = 0, most = 0;
                    for (const float one : x) {
                        const double y = give(exact, double(one));
                        off = std::max(off, std::abs(give(rough, one) - y));
                        most = std::max(most, std::abs(y));
                    }
                    const bool faulted = exact.faulted() || rough.faulted();
                    CAPTURE(e.name);
                    CAPTURE(kHz);
                    CAPTURE(ratio);
                    CAPTURE(kind);
                    CAPTURE(off / most);
                    CHECK_FALSE(faulted);
                    CHECK(off <= bound(ratio) * most);
                };
                for_each(check, in_lanes);
                for_each(check, one_at_a_time);
            }
}

TEST_CASE("every filter and observer that runs in lanes: a lane is a double, at every ratio") {
    using four = lanes<4>;
    for (const double ratio : ratios) {
        const duration T = 50_us;
        const auto x = signal_of(2, ratio);
        const auto check = [&](const auto& e) {
            auto single = e.make(double(), ratio * once_per(T), T);
            auto wide = e.make(four(), hertz<four>::from_value(four((ratio * once_per(T)).value())), T);
            using in = typename decltype(wide)::argument;
            double off = 0, most = 0;
            for (std::size_t k = 0; k < std::min<std::size_t>(x.size(), 20'000); ++k) {
                const double y = give(single, double(x[k]));
                const four all = wide(in::from_value(four(double(x[k])))).value();
                off = std::max({off, std::abs(all[0] - y), std::abs(all[3] - y)});
                most = std::max(most, std::abs(y));
            }
            CAPTURE(e.name);
            CAPTURE(ratio);
            CHECK(off <= 1e-12 * most); // zero without fused products
        };
        for_each(check, in_lanes);
    }
}

TEST_CASE_TEMPLATE(
    "notch, butterworth and lowpass: a constant comes out as it is, to the last bit, at any ratio", Real,
    double, float) {
    const duration T = 50_us;
    for (const double ratio : ratios) {
        CAPTURE(ratio);
        const auto check = [&](auto block) {
            using in = typename decltype(block)::argument;
            std::mt19937 engine(5);
            std::uniform_real_distribution<double> unit(-100, 100);
            for (int k = 0; k < 1000; ++k) block(in::from_value(Real(unit(engine))));
            const Real held = Real(0.1) * Real(unit(engine));
            const int rest = int(4000 + 60 / ratio); // until nothing is left of a decay
            Real y(0);
            for (int k = 0; k < rest; ++k) y = block(in::from_value(held)).value();
            CHECK(y == held);
        };
        check(notch<s::force, Real>({ratio * once_per(T), 1}, T));
        check(butterworth<s::force, Real>({ratio * once_per(T)}, T));
        if constexpr (std::same_as<Real, float>) // in double it is one number: 1e-16 / ratio is left
            check(lowpass<s::force, Real>({ratio * once_per(T)}, T));
    }
}

TEST_CASE("every corner that a constructor takes, reset and settle take too; what a number type cannot hold is "
          "refused by ratio") {
    const duration T = 1_ms;
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> exponent(-17, 0);
    int made = 0, refused = 0;
    const auto check = [&]<class Real>(Real, double ratio) {
        try {
            notch<s::force, Real> n({ratio * once_per(T), 0.1}, T);
            butterworth<s::force, Real> b({ratio * once_per(T)}, T);
            n.reset(), b.reset();
            const auto x = quantity_of<s::force, Real>::from_value(Real(3));
            n.settle(x), b.settle(x);
            CHECK_FALSE((n.faulted() || b.faulted() || n(x) != x || b(x) != x));
            ++made;
        } catch (const invalid_parameter&) {
            ++refused;
        }
    };
    for (int i = 0; i < 20'000; ++i) {
        const double ratio = std::pow(10, exponent(engine));
        check(double(), ratio);
        check(float(), ratio);
    }
    CHECK(made > 10'000);
    CHECK(refused > 1000);
    notch<s::force> slow({1e-10 * once_per(T), 0.1}, T);
    slow.reset();
    CHECK_FALSE(slow.faulted());
    CHECK_THROWS_WITH_AS(
        (butterworth<s::force, float>({1e-4_Hz}, T)),
        "butterworth.corner = 1e-04 Hz: must be at least 3.0356396311167783e-07 of the sampling rate in this "
        "number type (0.00030356396311167783 Hz)",
        invalid_parameter);
}
