// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../memory/repetitive.hpp"
#include "repetitive_filters.hpp"
#include "response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

/// Filters, stability and performance of a `repetitive` memory loop, from the loop's complementary sensitivity
/// T (position over reference, `loop.hpp` tracking()): a model or a measured FRF. [Jamaludin2008], repetitive
/// control.
///   added to the error: L W Q / (1 - W Q), W = sum w[i] z^{-i N}
///   error with over error without:  M = (1 - W Q) / (1 - W Q (1 - L T));   stable when |Q W (1 - L T)| < 1
namespace quadrant::inline v0::analysis {

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
