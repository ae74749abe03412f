// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/memory/fir.hpp>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

/// The sum of a FIR filter in the ways one could write it, and two axes beside each other in the lanes of one
/// register.
namespace sums {
inline constexpr std::size_t taps = 90;
using quadrant::detail::fir_taps;
using quadrant::detail::fir_window;

/// Tap i, the newest sample's first; even, so that the symmetric sum computes the same.
inline double tap(std::size_t i) {
    const double from_middle = double(i) - double(taps - 1) / 2;
    return std::exp(-0.002 * from_middle * from_middle) / 40;
}
inline std::array<double, taps> newest_last() {
    std::array<double, taps> c{};
    for (std::size_t i = 0; i < taps; ++i) c[taps - 1 - i] = tap(i);
    return c;
}

/// Around a ring, one sum: as repetitive was before.
struct around_a_ring {
    std::array<double, taps> c = newest_last(), x{}; // of even filters newest_last is also newest_first
    std::size_t at = 0;
    double operator()(double in) {
        x[at] = in;
        double y = 0;
        for (std::size_t j = 0; j <= at; ++j) y += c[j] * x[at - j];
        for (std::size_t j = at + 1; j < taps; ++j) y += c[j] * x[at + taps - j];
        at = at + 1 == taps ? 0 : at + 1;
        return y;
    }
};
/// Over a window that does not wrap, by any way of summing.
template <class Sum, std::size_t Size = taps> struct over_a_window {
    Sum sum;
    fir_window<double, Size> window{};
    double operator()(double in) {
        window.put(in);
        const double y = sum(window.oldest());
        window.advance();
        return y;
    }
};
template <std::size_t Sums> struct in_sums {
    static constexpr std::size_t size = (taps + Sums - 1) / Sums * Sums;
    std::array<double, size> c{};
    in_sums() {
        for (std::size_t i = 0; i < taps; ++i) c[size - 1 - i] = tap(i);
    }
    double operator()(const double* x) const {
        std::array<double, Sums> s{};
        for (std::size_t i = 0; i < size; i += Sums)
            for (std::size_t j = 0; j < Sums; ++j) s[j] += c[i + j] * x[i + j];
        for (std::size_t half = Sums / 2; half > 0; half /= 2)
            for (std::size_t j = 0; j < half; ++j) s[j] += s[j + half];
        return s[0];
    }
};
struct by_halves { // of an even filter: half the multiplications
    std::array<double, taps> c = newest_last();
    double operator()(const double* x) const {
        double even = 0, odd = c[taps / 2 - 1] * (x[taps / 2 - 1] + x[taps / 2]);
        for (std::size_t i = 0; i + 1 < taps / 2; i += 2) {
            even += c[i] * (x[i] + x[taps - 1 - i]);
            odd += c[i + 1] * (x[i + 1] + x[taps - 2 - i]);
        }
        return even + odd;
    }
};
struct by_eigen {
    Eigen::Matrix<double, int(taps), 1> c;
    by_eigen() {
        for (std::size_t i = 0; i < taps; ++i) c[int(taps - 1 - i)] = tap(i);
    }
    double operator()(const double* x) const { return c.dot(Eigen::Map<const decltype(c)>(x)); }
};
using as_in_repetitive = fir_taps<double, taps>;
inline as_in_repetitive repetitive_taps() {
    as_in_repetitive c;
    for (std::size_t i = 0; i < taps; ++i) c[i] = tap(i);
    return c;
}

/// Two axes, the second at nine tenths of the first: one after the other,
template <class Step> struct after_each_other {
    Step x, y;
    double operator()(double in) { return x(in) + y(0.9 * in); }
};
/// or beside each other: pairs in the window, each tap twice, two lanes and two sums for either axis.
struct taps_beside_each_other {
    std::array<double, 2 * taps> c{};
    fir_window<std::array<double, 2>, taps> window{};
    taps_beside_each_other() {
        for (std::size_t i = 0; i < taps; ++i) c[2 * i] = c[2 * i + 1] = newest_last()[i];
    }
    double operator()(double in) {
        window.put({in, 0.9 * in});
        const double* x = window.oldest()->data();
        std::array<double, 4> s{};
        for (std::size_t i = 0; i < 2 * taps; i += 4)
            for (std::size_t j = 0; j < 4; ++j) s[j] += c[i + j] * x[i + j];
        window.advance();
        return (s[0] + s[2]) + (s[1] + s[3]);
    }
};
/// A second-order section of both axes in two lanes.
template <class Section> struct sections_beside_each_other {
    using pair = std::array<double, 2>;
    pair b0, b1, b2, a1, a2, s0{}, s1{};
    explicit sections_beside_each_other(const Section& f)
        : b0{f.b0, f.b0}, b1{f.b1, f.b1}, b2{f.b2, f.b2}, a1{f.a1, f.a1}, a2{f.a2, f.a2} {}
    double operator()(double in) {
        const pair x{in, 0.9 * in};
        pair y;
        for (std::size_t i = 0; i < 2; ++i) y[i] = b0[i] * x[i] + s0[i];
        for (std::size_t i = 0; i < 2; ++i) s0[i] = b1[i] * x[i] - a1[i] * y[i] + s1[i];
        for (std::size_t i = 0; i < 2; ++i) s1[i] = b2[i] * x[i] - a2[i] * y[i];
        return y[0] + y[1];
    }
};
} // namespace sums
