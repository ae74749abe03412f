// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "least_squares.hpp"
#include "response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

/// The filters and weights of a `repetitive` memory: smoothing Q, learning L, W. What the memory then does:
/// repetitive_design.hpp.
namespace quadrant::inline v0::analysis {

/// A FIR filter that looks `ahead` samples ahead: taps[i] weighs the sample ahead - i from now.
template <std::size_t Taps> struct fir {
    std::array<double, Taps> taps{};
    std::size_t ahead = 0;
    duration period;

    complex operator()(frequency f) const {
        const complex back = std::polar(1.0, -laplace(f).imag() * period.value());
        complex sum = 0;
        for (std::size_t i = Taps; i-- > 0;) sum = sum * back + taps[i];
        return sum * std::pow(back, -double(ahead));
    }
};

/// Zero-phase low-pass Q: a sinc behind a Hamming window, symmetric, gain at standstill one; -6 dB at
/// `corner`. Ripple of some 0.002 in the pass band: what it leaves of every harmonic, and why a memory whose
/// loop is open grows.
template <std::size_t Taps = 61>
requires(Taps % 2 == 1) fir<Taps> smoothing_filter(frequency corner, duration period) {
    require_positive("smoothing_filter.period", period);
    require_below_nyquist("smoothing_filter.corner", corner, period);
    fir<Taps> q{{}, Taps / 2, period};
    const std::size_t middle = Taps / 2;
    double sum = 0;
    for (std::size_t i = 0; i < Taps; ++i) {
        const double k = double(i) - double(middle), x = 2 * corner.value() * period.value() * k;
        const double sinc = k == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
        q.taps[i] = sinc * (0.54 + 0.46 * std::cos(2 * std::numbers::pi * k / double(Taps + 1)));
        sum += q.taps[i];
    }
    for (double& each : q.taps) each /= sum;
    return q;
}

/// Frequencies spaced evenly, the designs' own grid: (i + 1/2)/count of the way.
struct span {
    frequency from, to;
    std::size_t count = 1000;
    frequency operator[](std::size_t i) const {
        return from + ((double(i) + 0.5) / double(count)) * (to - from);
    }
};
/// All that a sampled loop has. A measured T needs a narrower one; the checks then hold for it only.
inline span up_to_nyquist(duration period) { return {frequency(), 0.5 * once_per(period)}; }
namespace detail {
inline void require_span(const span& s, duration period) {
    require_positive("period", period);
    require(s.count > 0 && s.from >= frequency() && s.to > s.from &&
                s.to.value() <= 0.5 / period.value() * (1 + 1e-12),
            "span.to", s.to,
            "must lie above span.from and not above half the sampling rate (" +
                quadrant::detail::shortest(quadrant::detail::in_unit(0.5 / period.value(), " Hz")) +
                "), with one line or more");
}
} // namespace detail

/// Learning filter L, the inverse of T by least squares: least mean over the span of |Q (1 - L T)|^2, plus
/// ridge^2 times the taps' squares, so that where Q is small L stays small too: the low-pass in it. Then
/// `rounds` times the same with more weight where the mismatch was large, which takes its largest value down by
/// half; the best is kept. Throws when T or Q is not finite in the span.
template <std::size_t Taps = 90, frequency_response Loop, frequency_response Smoothing>
fir<Taps> learning_filter(const Loop& t, const Smoothing& q, std::size_t ahead, duration period,
                          const std::optional<span>& over = {}, double ridge = 1e-4, std::size_t rounds = 4) {
    const span s = over.value_or(up_to_nyquist(period));
    detail::require_span(s, period);
    require(ahead < Taps, "learning_filter.ahead", double(ahead),
            "must be below the taps (" + quadrant::detail::shortest(double(Taps)) + ")");
    require_positive("learning_filter.ridge", ridge);
    std::vector<complex> weight(s.count), through(s.count);
    for (std::size_t line = 0; line < s.count; ++line) {
        weight[line] = complex(q(s[line])) / std::sqrt(double(s.count));
        through[line] = complex(t(s[line]));
        require(std::isfinite(std::abs(through[line] * weight[line])), "learning_filter, T or Q at f", s[line],
                "must be finite");
    }
    fir<Taps> l{{}, ahead, period}, best = l;
    double least_worst = std::numeric_limits<double>::infinity();
    std::vector<double> re(Taps), im(Taps), emphasis(s.count, 1.0), off(s.count);
    for (std::size_t round = 0; round <= rounds; ++round) {
        least_squares equations(Taps);
        for (std::size_t line = 0; line < s.count; ++line) {
            const complex w = weight[line] * std::sqrt(emphasis[line]);
            const double angle = laplace(s[line]).imag() * period.value();
            for (std::size_t i = 0; i < Taps; ++i) {
                const complex tap = w * through[line] * std::polar(1.0, angle * (double(ahead) - double(i)));
                re[i] = tap.real(), im[i] = tap.imag();
            }
            equations.add(re, w.real());
            equations.add(im, w.imag());
        }
        for (std::size_t i = 0; i < Taps; ++i) {
            std::vector<double> small(Taps);
            small[i] = ridge;
            equations.add(small, 0);
        }
        const auto found = equations.solve();
        std::copy(found.x.begin(), found.x.end(), l.taps.begin());
        double worst = 0, mean = 0;
        for (std::size_t line = 0; line < s.count; ++line) {
            off[line] = std::abs(weight[line] * (1.0 - l(s[line]) * through[line]));
            worst = std::max(worst, off[line]);
        }
        if (worst < least_worst) least_worst = worst, best = l;
        for (std::size_t line = 0; line < s.count; ++line)
            mean += (emphasis[line] *= off[line] / worst + 0.02) / double(s.count);
        for (double& each : emphasis) each /= mean;
    }
    return best;
}

/// W = sum w[i] e^{-j 2 pi f i cycle}: the memory.
template <std::size_t Order>
complex memory_response(const std::array<double, Order>& weights, duration cycle, frequency f) {
    complex sum = 0;
    for (std::size_t i = 0; i < Order; ++i)
        sum += weights[i] * std::exp(-laplace(f) * (double(i + 1) * cycle.value()));
    return sum;
}

/// Weights for a stated amplification of what does not repeat: 1 - W = (1 - z^-N)(1 - a z^-N)^(Order - 1), with
/// the a in 0 ... 1 that makes |1 - W| half-way between two harmonics, 2 (1 + a)^(Order - 1), just
/// `amplification_db`. a = 0 is order 1 (6.02 dB, widest choice for noise), a = 1 the flattest zero at every
/// harmonic (widest for the cycle). Throws outside 6.02 ... 6.02 Order dB.
template <std::size_t Order> std::array<double, Order> repetitive_weights(double amplification_db) {
    const double ratio = std::pow(10.0, amplification_db / 20), most = std::pow(2.0, double(Order));
    require(ratio >= 2 * (1 - 1e-3) && ratio <= most * (1 + 1e-3), "repetitive_weights.amplification_db",
            quadrant::detail::in_unit(amplification_db, " dB"),
            "must lie between 6.02 and " +
                quadrant::detail::shortest(quadrant::detail::in_unit(6.02 * double(Order), " dB")));
    double a = 0;
    if constexpr (Order > 1) a = std::clamp(std::pow(ratio / 2, 1 / double(Order - 1)) - 1, 0.0, 1.0);
    std::array<double, Order + 1> polynomial{1};
    for (std::size_t factor = 0; factor < Order; ++factor)
        for (std::size_t i = Order; i-- > 0;) polynomial[i + 1] -= (factor == 0 ? 1 : a) * polynomial[i];
    std::array<double, Order> w{};
    for (std::size_t i = 0; i < Order; ++i) w[i] = -polynomial[i + 1];
    return w;
}

} // namespace quadrant::inline v0::analysis
