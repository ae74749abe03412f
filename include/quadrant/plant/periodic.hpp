// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/signal.hpp"
#include "harmonic_series.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// A quantity that repeats along the travel: sum_{i=1..Harmonics} size_i sin(2 pi i x / period + phase_i).
template <signal_tag Signal, std::size_t Harmonics, class Real = double>
requires(Harmonics > 0) struct periodic {
    quantity_of<signal::position, Real> period;              ///< of the first harmonic; > 0
    std::array<quantity_of<Signal, Real>, Harmonics> size{}; ///< finite
    std::array<Real, Harmonics> phase{};                     ///< [rad]
};

namespace detail {
/// The sum above, its phases worked in: one sine and one cosine a call. Source of the parameters' convention:
/// docs/formats.md.
template <signal_tag Signal, std::size_t Harmonics, class Real> class periodic_sum {
public:
    template <class Number>
    periodic_sum(const char* block, const periodic<Signal, Harmonics, Number>& p)
        : period_(in_real<Real>(p.period)) {
        using std::cos, std::sin;
        require_positive<Real>({block, ".period"}, p.period);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            require_finite<Real>({block, ".size"}, p.size[i]);
            require_finite<Real>({block, ".phase"}, p.phase[i]);
            series_.sine[i] = in_real<Real>(p.size[i] * Number(cos(p.phase[i])));
            series_.cosine[i] = in_real<Real>(p.size[i] * Number(sin(p.phase[i])));
        }
    }
    quantity_of<Signal, Real> operator()(quantity_of<signal::position, Real> x) const noexcept {
        return series_(Real(x / period_));
    }

private:
    quantity_of<signal::position, Real> period_;
    harmonic_series<Harmonics, quantity_of<Signal, Real>, Real> series_;
};
} // namespace detail

} // namespace quadrant::inline v0
