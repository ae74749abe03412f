// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/finite.hpp"
#include "../plant/periodic.hpp"

#include <numbers>

namespace quadrant::inline v0 {

/// What an encoder's interpolation, or an eccentric scale, adds to the position.
///   y = x + sum_{i=1..Harmonics} size_i sin(2 pi i x / period + phase_i)
/// Source: docs/formats.md (effect encoder_cyclic_error: cyclic_m, cyclic_period_m, cyclic_phase_rad), the same
/// signs.
/// Ports: position [m] in, reading [m] out. The period is that of the scale's signal (4 um on the table of
/// [Jamaludin2008]), or of a turn of the screw.
/// State: none; `reset` and `settle` set the held output and clear the fault. With phases, y(0) is not zero.
/// Range: 2 pi sum i size_i <= period, or the reading would run backwards.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "cyclic_error.<field> = ...: must ..." for period, size, phase and "cyclic_error.sample_period".
/// Cost: one sine, one cosine, 6 multiplications per harmonic. The counts of the encoder: `quantizer`, behind
/// it.
template <std::size_t Harmonics = 1, class Real = double> class cyclic_error {
public:
    using input = signal::position;
    using output = signal::position;
    using argument = quantity_of<signal::position, Real>;
    using value = quantity_of<signal::position, Real>;
    using number = parameter_real<Real>; ///< of parameters

    using parameters = periodic<signal::position, Harmonics, number>;
    struct state {};

    cyclic_error(const parameters& p, duration sample_period) : given_(p), sum_("cyclic_error", p) {
        require_positive<Real>("cyclic_error.sample_period", sample_period);
        const auto runs_forward = [&](std::size_t which) {
            double steepest = 0;
            for (std::size_t i = 0; i < Harmonics; ++i)
                steepest +=
                    2 * std::numbers::pi * static_cast<double>(i + 1) *
                    std::abs(detail::plain(lane(p.size[i], which)) / detail::plain(lane(p.period, which)));
            return steepest <= 1;
        };
        require_lanes(runs_forward, "cyclic_error.size", p.size[0],
                      "must not let the reading run backwards (2 pi sum i size_i <= period)");
    }

    value operator()(argument x) noexcept {
        const value y = x + sum_(x);
        return out_.keep(finite(x, y), y);
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept {
        const value y = x + sum_(x);
        out_.settle(finite(x, y), y);
    }

    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    parameters given_;
    detail::periodic_sum<signal::position, Harmonics, Real> sum_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
