// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

/// Signal arithmetic of the diagnosis, off line and in plain SI numbers.
namespace quadrant::inline v0::diagnosis {

/// The product with itself.
inline double square(double x) { return x * x; }

/// Root of the mean square; 0 of nothing.
inline double rms(std::span<const double> x) {
    double sum = 0;
    for (double v : x) sum += v * v;
    return x.empty() ? 0 : std::sqrt(sum / static_cast<double>(x.size()));
}

/// Quantile f of a copy of x (0 ... 1).
inline double quantile(std::vector<double> x, double f) {
    if (x.empty()) return 0;
    const auto at = x.begin() + static_cast<std::ptrdiff_t>(f * static_cast<double>(x.size() - 1));
    std::nth_element(x.begin(), at, x.end());
    return *at;
}

/// Low-pass without phase: a second-order Butterworth run forwards and backwards, -3 dB at `corner` in all.
/// Both ends are continued by point reflection, so that a record that begins in motion has no step.
/// Real: double, or lanes, of several signals side by side.
template <class Real>
std::vector<Real> zero_phase_of(std::span<const Real> x, double corner_Hz, double period) {
    const std::size_t n = x.size();
    if (n < 3) return {x.begin(), x.end()};
    const double each_way = corner_Hz / std::pow(std::numbers::sqrt2 - 1, 0.25); // two passes narrow the band
    const double t = std::tan(std::numbers::pi * std::min(each_way * period, 0.45));
    const double a0 = 1 + std::numbers::sqrt2 * t + t * t, b = t * t / a0;
    const double a1 = 2 * (t * t - 1) / a0, a2 = (1 - std::numbers::sqrt2 * t + t * t) / a0;
    const auto pad = std::min(n - 1, static_cast<std::size_t>(3 / (each_way * period)) + 1);
    std::vector<Real> y(n + 2 * pad);
    for (std::size_t i = 0; i < pad; ++i) {
        y[i] = Real(2) * x[0] - x[pad - i];
        y[n + pad + i] = Real(2) * x[n - 1] - x[n - 2 - i];
    }
    std::copy(x.begin(), x.end(), y.begin() + static_cast<std::ptrdiff_t>(pad));
    const Real b0(b), b1(2 * b), c1(a1), c2(a2);
    const auto run = [&](auto first, auto last) {
        Real s1 = *first * Real(1 - b), s2 = *first * Real(b - a2);
        for (; first != last; ++first) {
            const Real in = *first, out = b0 * in + s1;
            s1 = b1 * in - c1 * out + s2;
            s2 = b0 * in - c2 * out;
            *first = out;
        }
    };
    run(y.begin(), y.end());
    run(y.rbegin(), y.rend());
    return {y.begin() + static_cast<std::ptrdiff_t>(pad), y.begin() + static_cast<std::ptrdiff_t>(pad + n)};
}
/// The same of numbers.
inline std::vector<double> zero_phase(std::span<const double> x, double corner_Hz, double period) {
    return zero_phase_of<double>(x, corner_Hz, period);
}

/// Central difference, one-sided at the ends.
inline std::vector<double> derivative(std::span<const double> x, double period) {
    const std::size_t n = x.size();
    std::vector<double> d(n, 0.0);
    for (std::size_t k = 1; k + 1 < n; ++k) d[k] = (x[k + 1] - x[k - 1]) / (2 * period);
    if (n > 1) {
        d[0] = (x[1] - x[0]) / period;
        d[n - 1] = (x[n - 1] - x[n - 2]) / period;
    }
    return d;
}

} // namespace quadrant::inline v0::diagnosis
