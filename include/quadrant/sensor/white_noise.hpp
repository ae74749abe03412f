// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/signal.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quadrant::inline v0 {

/// Noise of a sensor, normally distributed and independent from sample to sample: what a tachometer or an
/// interpolated encoder adds to its wire. The same seed gives the same noise on every machine.
///   y[k] = deviation sqrt(-2 ln u) cos(2 pi v),  u and v in (0, 1] from `splitmix64` of seed and k
/// Source: [Box1958] for the normal distribution, [Steele2014] for the generator, which is one of k: no state
/// but a count.
/// Ports: no input; noise of the coming sample out. Mean 0, variance deviation^2, never beyond 8.6 deviations.
/// State: k; `reset`: k = 0; `settle(t)`: so long after that.
/// Range: deviation >= 0; 0: none. Give every wire another seed, or their noise is the same.
/// NaN: no input, so none; finite for ever.
/// Throws "white_noise.deviation = ...: must be finite and not below 0", and for the period.
/// Cost: one logarithm, one root, one cosine (a sum of 9 terms), 6 integer multiplications; nothing with
/// deviation 0.
template <signal_tag Signal, class Real = double> class white_noise {
public:
    using output = Signal;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How strong the noise is, in the unit of the wire, and the seed that distinguishes its sequence from all
    /// others.
    struct parameters {
        quantity_of<Signal, number> deviation{}; ///< standard deviation; >= 0
        std::uint64_t seed = 1;
    };
    /// The count that the next number is drawn by.
    struct state {
        std::uint64_t k = 0; ///< of the coming sample
    };

    white_noise(const parameters& p, duration period)
        : given_(p), deviation_(in_real<Real>(p.deviation)), period_(period) {
        require_positive<Real>("white_noise.period", period);
        require_not_negative<Real>("white_noise.deviation", p.deviation);
    }

    value operator()() noexcept {
        const std::uint64_t k = state_.k++;
        if (!(deviation_ > value())) return value();
        const std::uint64_t at = first_ + 2 * k;
        const double u = uniform(at), v = uniform(at + 1);
        return deviation_ * Real(std::sqrt(-2 * std::log(u)) * cosine(v));
    }
    void reset() noexcept { state_ = {}; }
    void settle(duration t) noexcept {
        state_.k = static_cast<std::uint64_t>(std::llround(t.value() / period_.value()));
    }

    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static std::uint64_t mixed(std::uint64_t n) noexcept {
        n = (n + 1) * 0x9e3779b97f4a7c15u;
        n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
        n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
        return n ^ (n >> 31);
    }
    /// 2^-53 ... 1: its logarithm is finite.
    static double uniform(std::uint64_t n) noexcept { return double((mixed(n) >> 11) + 1) * 0x1p-53; }

    /// cos(2 pi v), 0 <= v <= 1, to 3e-16: Taylor's sum of the cosine or the sine around the nearest quarter
    /// turn. Without a branch, which random numbers would mislead.
    static double cosine(double v) noexcept {
        static constexpr double sums[2][9] = {{1, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800,
                                               1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000},
                                              {1, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880,
                                               -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000,
                                               1.0 / 355687428096000}};
        static constexpr double of_one[5] = {1, 0, -1, 0, 1}, of_angle[5] = {0, -1, 0, 1, 0};
        const int quarter = (int(8 * v) + 1) / 2; // the nearest
        const double angle = 2 * std::numbers::pi * (v - 0.25 * quarter), x = angle * angle, x2 = x * x;
        const double* const s = sums[quarter & 1];
        const double low = (s[0] + s[1] * x) + x2 * (s[2] + s[3] * x),
                     high = (s[4] + s[5] * x) + x2 * ((s[6] + s[7] * x) + x2 * s[8]);
        return (of_one[quarter] + of_angle[quarter] * angle) * (low + x2 * x2 * high);
    }

    parameters given_;
    value deviation_;
    std::uint64_t first_ = mixed(given_.seed);
    duration period_;
    state state_;
};

} // namespace quadrant::inline v0
