// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

namespace {
/// The difference equation of a section in direct form, in the widest number there is.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 wide;
#else
using wide = long double;
#endif
struct direct_form {
    wide b0, b1, b2, a1, a2, x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    static direct_form of(wide top2, wide top0, double ratio,
                          double damping) { // (top2 s^2 + top0 w^2)/(s^2 + damping w s + w^2)
        const wide t = std::tan(3.141592653589793238462643383279502884L * static_cast<long double>(ratio));
        const wide a0 = 1 + damping * t + t * t;
        return {(top2 + top0 * t * t) / a0, 2 * (top0 * t * t - top2) / a0, (top2 + top0 * t * t) / a0,
                2 * (t * t - 1) / a0, (1 - damping * t + t * t) / a0};
    }
    double operator()(double x) {
        const wide y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
        x2 = x1, x1 = x, y2 = y1, y1 = y;
        return double(y);
    }
};
constexpr double ratios[] = {1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.45, 0.49};
} // namespace

TEST_CASE("second_order: notch and butterworth are their difference equations, from 1e-5 to 0.49 of the "
          "sampling rate") {
    if (std::numeric_limits<long double>::digits < 64) return; // no reference: its tangent would be a double's
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> unit(-100, 100);
    const duration T = 50_us;
    for (const double ratio : ratios) {
        // A rounding error stays for 1/(pi damping ratio) samples, near half the sampling rate it grows as
        // tan^2.
        const double t = std::tan(pi * ratio);
        const double bound = 2.2e-16 * (8 + 1 / (0.1 * pi * ratio) + 4 * t * t);
        CAPTURE(ratio);
        const auto check = [&](auto block, direct_form reference) {
            double off = 0, most = 0;
            for (int k = 0; k < int(2000 + 3 / ratio); ++k) {
                const double x = 50 * std::sin(2 * pi * ratio * k) + unit(engine), y = reference(x);
                off = std::max(off, std::abs(block(x * 1_N).value() - y));
                most = std::max(most, std::abs(y));
            }
            CHECK(off <= bound * most);
        };
        check(notch<s::force>({ratio * once_per(T), 0.1}, T), direct_form::of(1, 1, ratio, 0.1));
        check(butterworth<s::force>({ratio * once_per(T)}, T),
              direct_form::of(0, 1, ratio, std::numbers::sqrt2));
    }
}
TEST_CASE("second_order: a sample that overflows the section is refused as a whole") {
    constexpr double most = std::numeric_limits<double>::max();
    for (const double centre : {30.0, 330.0, 900.0}) {
        notch<s::force> f({centre * 1_Hz, 0.1}, 500_us);
        f(3_N);
        const auto last = f(4_N);
        auto twin = f;
        f(most * 1_N), f(-most * 1_N); // may pass, in part
        if (!f.faulted()) f(most * 1_N);
        CHECK(f.faulted());
        for (const double x : {1.0, 2.0}) CHECK(std::isfinite(f(x * 1_N).value()));
        CHECK(twin(std::numeric_limits<double>::quiet_NaN() * 1_N) == last);
    }
}
TEST_CASE("transfer_function: by differences of z it is the same filter, and keeps poles that coefficients in "
          "z have lost") {
    using block = transfer_function<s::force, s::force, 3>;
    const duration T = 25_us;
    const auto filter = [](double w) {
        return continuous<3>{{w * w * w, w * w / 3, w}, {w * w * w, 2 * w * w, 2 * w, 1}};
    };
    const auto quick = filter(2 * pi * 300);
    block in_z(block::parameters::in_si(bilinear(quick, T)), T),
        in_d = block::of(bilinear_differences(quick, T), T);
    double off = 0;
    for (int k = 0; k < 5000; ++k) {
        const auto x = std::sin(1e-5 * k * k) * 100_N;
        off = std::max(off, std::abs((in_z(x) - in_d(x)).value()));
    }
    CHECK(off < 1e-8);                        // [N] of 100; 1e-16 over (w T)^3, of the coefficients in z
    for (const double ratio : {1e-6, 1e-4}) { // gain at a tenth and at the corner, from the continuous filter
        const auto slow = filter(2 * pi * ratio * once_per(T).value());
        const block f = block::of(bilinear_differences(slow, T), T);
        CHECK_FALSE(f.integrates());
        for (const double of : {0.1, 1.0}) {
            const std::complex<double> j(0, of);
            const auto expected = (1.0 + j / 3.0 + j * j) / (1.0 + 2.0 * j + 2.0 * j * j + j * j * j);
            CHECK(std::abs(f.response(of * ratio * once_per(T)) - expected) < 1e-6);
        }
    }
}
