// SPDX-License-Identifier: BSL-1.0
// Long: the three filters of one memory, and what the memory then does.
#pragma once
#include "../memory/repetitive.hpp"
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

/// Filters, stability and performance of a `repetitive` memory loop, from the loop's complementary sensitivity
/// T (position over reference, `loop.hpp` tracking()): a model or a measured FRF. [Jamaludin2008], repetitive
/// control.
///   added to the error: L W Q / (1 - W Q), W = sum w[i] z^{-i N}
///   error with over error without:  M = (1 - W Q) / (1 - W Q (1 - L T));   stable when |Q W (1 - L T)| < 1
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

/// The largest value of a response in a span, and its frequency.
struct largest {
    double value;
    frequency at;
};
/// Largest |Q (1 - L T)| of the span.
template <frequency_response Loop, frequency_response Learning, frequency_response Smoothing>
largest mismatch(const Loop& t, const Learning& l, const Smoothing& q, const span& over) {
    largest out{0, over[0]};
    for (std::size_t i = 0; i < over.count; ++i) {
        const frequency f = over[i];
        const double now = std::abs(complex(q(f)) * (1.0 - complex(l(f)) * complex(t(f))));
        require(std::isfinite(now), "mismatch, response at f", f, "must be finite");
        if (now > out.value) out = {now, f};
    }
    return out;
}
/// What |Q W (1 - L T)| can at most be, whatever the cycle: mismatch times sum |w|. Below 1 the loop converges.
template <frequency_response Loop, frequency_response Learning, frequency_response Smoothing, std::size_t Order>
largest stability(const Loop& t, const Learning& l, const Smoothing& q,
                  const std::array<double, Order>& weights, const span& over) {
    largest out = mismatch(t, l, q, over);
    double sum = 0;
    for (const double w : weights) sum += std::abs(w);
    out.value *= sum;
    return out;
}

/// How well it does when the cycle is off, [Jamaludin2008]: both of |M|, error with over error without.
struct repetitive_performance {
    double periodic; ///< gamma_p: the worst over the harmonics, each off by up to `uncertainty`; 0 is perfect
    frequency worst_harmonic;
    double non_periodic_db; ///< gamma_np: worst amplification within the bandwidth [dB]
    frequency worst_between;
};
/// How well the cycle of a memory loop is known, and up to where its error counts.
struct performance_case {
    duration cycle;            ///< the memory's
    double uncertainty = 0.01; ///< of the cycle, either way
    std::size_t harmonics = 1; ///< 1 ... this
    frequency bandwidth;       ///< for gamma_np
};
/// |M| over the harmonics of an uncertain cycle (100 steps either way), and between them up to the bandwidth
/// (200 lines a harmonic).
template <frequency_response Loop, frequency_response Learning, frequency_response Smoothing, std::size_t Order>
repetitive_performance performance(const Loop& t, const Learning& l, const Smoothing& q,
                                   const std::array<double, Order>& weights, const performance_case& c) {
    require_positive("performance.cycle", c.cycle);
    require(c.uncertainty >= 0 && c.uncertainty < 0.5, "performance.uncertainty", c.uncertainty,
            "must lie between 0 and 0.5");
    require(c.harmonics > 0, "performance.harmonics", double(c.harmonics), "must be above 0");
    require_positive("performance.bandwidth", c.bandwidth);
    const auto off = [&](frequency f) {
        const complex wq = memory_response(weights, c.cycle, f) * complex(q(f));
        return std::abs((1.0 - wq) / (1.0 - wq * (1.0 - complex(l(f)) * complex(t(f)))));
    };
    repetitive_performance out{0, {}, 0, {}};
    constexpr int steps = 100; // either way
    for (std::size_t i = 1; i <= c.harmonics; ++i)
        for (int k = -steps; k <= steps; ++k) {
            const frequency f = double(i) * (1 + c.uncertainty * k / steps) * once_per(c.cycle);
            if (const double now = off(f); now > out.periodic) out.periodic = now, out.worst_harmonic = f;
        }
    double most = 0;
    const auto lines = std::size_t(std::ceil(200 * c.bandwidth.value() * c.cycle.value()));
    for (std::size_t i = 1; i <= lines; ++i) { // 200 a harmonic: half-way between two of them is one
        const frequency f = std::min(c.bandwidth, (double(i) / 200) * once_per(c.cycle));
        if (const double now = off(f); now > most) most = now, out.worst_between = f;
    }
    out.non_periodic_db = decibel(most);
    return out;
}

/// Parameters of a `repetitive` block from its filters; refuses a loop that does not converge for every cycle,
/// or has less
/// margin than stated: largest |Q W (1 - L T)| not below 1 - margin.
template <class Block, frequency_response Loop, std::size_t Order, std::size_t Learning, std::size_t Smoothing>
typename Block::parameters repetitive_parameters(const Loop& t, const std::array<double, Order>& weights,
                                                 const fir<Learning>& l, const fir<Smoothing>& q,
                                                 duration cycle, const span& over, double margin = 0) {
    detail::require_span(over, l.period);
    require(margin >= 0 && margin < 1, "repetitive_parameters.margin", margin, "must lie between 0 and 1");
    const largest worst = stability(t, l, q, weights, over);
    require(worst.value < 1 - margin, "repetitive: largest |Q W (1 - L T)|", worst.value,
            "must be below " + quadrant::detail::shortest(1 - margin) + " (at " +
                quadrant::detail::shortest(worst.at.value()) +
                " Hz): lower the corner of Q or give L more taps");
    return {.cycle = cycle, .weights = weights, .learning = l.taps, .ahead = l.ahead, .smoothing = q.taps};
}

} // namespace quadrant::inline v0::analysis
