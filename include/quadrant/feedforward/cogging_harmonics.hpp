// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// What holds the axis against cogging, from where it is: the harmonics of the pitch (that of the poles, or a
/// turn) that were worth keeping.
///   u = sum over i of amplitude_i sin(2 pi order_i x / pitch + phase_i)
/// Source: `analysis::identify_cogging` finds them from slow runs in both directions.
/// Ports: position in (of the reference, or measured), command out in whatever the amplitudes are: N, V or A.
/// Added by the loop.
/// State: none but the last good output; `reset` and `settle` clear the fault flag.
/// `retune(next)`: other harmonics from the next step on; jump: the difference of both curves at x.
/// Range: pitch > 0; orders in any sequence, an amplitude of 0 for one that is not used. Any position; its
/// rounding becomes one of phase, 2 pi order |x| / pitch times 2e-16 (float 1e-7): in float count from near the
/// place where the axis works. At speed the force comes late: feed the position `ahead` of a `preview`.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "cogging_harmonics.pitch = ...: must ...", "...order", "...amplitude", "...phase".
/// Cost: a sine and a cosine per harmonic. Constant cost for any number of them: `cogging_table`.
template <std::size_t Harmonics, signal_tag Out = signal::force, signal_tag In = signal::position,
          class Real = double>
requires(Harmonics > 0) class cogging_harmonics {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// One sine over the pitch.
    struct harmonic {
        unsigned order = 1;                   ///< waves per pitch; >= 1
        quantity_of<Out, number> amplitude{}; ///< finite
        number phase{};                       ///< [rad]; finite
    };
    /// The pitch, and the sines that repeat in it.
    struct parameters {
        quantity_of<In, number> pitch{}; ///< > 0
        std::array<harmonic, Harmonics> harmonics{};
    };
    struct state {};

    cogging_harmonics(const parameters& p, duration period) : given_(p), pitch_(in_real<Real>(p.pitch)) {
        using std::cos, std::sin;
        require_positive<Real>("cogging_harmonics.period", period);
        require_positive<Real>("cogging_harmonics.pitch", p.pitch);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const harmonic& h = p.harmonics[i];
            require(h.order >= 1, "cogging_harmonics.order", double(h.order), "must be 1 or more");
            require_finite<Real>("cogging_harmonics.amplitude", h.amplitude);
            require_finite<Real>("cogging_harmonics.phase", h.phase);
            sine_[i] = in_real<Real>(quantity_of<Out, number>(h.amplitude * number(cos(h.phase))));
            cosine_[i] = in_real<Real>(quantity_of<Out, number>(h.amplitude * number(sin(h.phase))));
        }
    }

    value operator()(argument x) noexcept {
        const value u = at(x);
        return finite(u) ? out_.keep(u) : out_.hold();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument x) noexcept {
        const value u = at(x);
        finite(u) ? out_.reset(u) : out_.raise();
    }

    void retune(const cogging_harmonics& next) noexcept {
        const auto out = out_;
        *this = next;
        out_ = out;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value at(argument x) const noexcept {
        using std::cos, std::sin;
        const Real turns = Real(x / pitch_), turn = turns - Real(std::floor(detail::plain(turns)));
        value u{};
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const Real angle = Real(2 * std::numbers::pi * double(given_.harmonics[i].order)) * turn;
            u += sine_[i] * Real(sin(angle)) + cosine_[i] * Real(cos(angle));
        }
        return u;
    }

    parameters given_;
    argument pitch_;
    std::array<value, Harmonics> sine_{}, cosine_{};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
