// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/signal.hpp"
#include "../plant/harmonic_series.hpp"
#include "tool_entry.hpp"
#include "turning_phase.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// Harmonics of a periodic force as a Fourier transform gives them: harmonic i is Re (real + j imaginary) e^{j
/// i w t}.
template <std::size_t Harmonics, class Number = double> struct harmonic_table {
    std::array<Number, Harmonics> real{}, imaginary{};
};
/// The lowest Count of them.
template <std::size_t Count, std::size_t Harmonics, class Number>
requires(Count <= Harmonics) constexpr harmonic_table<Count, Number> lowest(
    const harmonic_table<Harmonics, Number>& table) {
    harmonic_table<Count, Number> out;
    for (std::size_t i = 0; i < Count; ++i) {
        out.real[i] = table.real[i];
        out.imaginary[i] = table.imaginary[i];
    }
    return out;
}

/// The force of the cutter on an axis, from harmonics that were measured once: a source for a plant's external
/// force.
///   F(t) = scale sum_{i=1..Harmonics} real_i cos(w_i t) - imaginary_i sin(w_i t),  w_i = 2 pi i fundamental,  t = k period
/// Source: [Jamaludin2008] eq. (3.10); its tables of 15 harmonics: `process/milling_harmonics.hpp`.
/// Ports: no input; the force [N] at the coming sample out, the first call gives F(0). Positive pushes the axis
/// forward. engage(false) lets the tool leave the cut, engage(true) enter it again: the force fades within
/// `entry`, its phase goes on.
/// State: the spindle's angle as an integer that never drifts (`turning_phase`), and how far the tool is in the
/// cut. `reset`: t = 0, in the cut; `settle(t, engaged)`: so long after that, faded to the end.
/// Range: the highest harmonic below half the sampling rate. A plant that holds the force over the period sees
/// it half a period late and, at the harmonic f, smaller by sinc(f period).
/// NaN: no input, so none; finite for ever. A dual carries derivatives by scale and harmonics, not by the
/// fundamental. Throws "cutting_force.<field> = ...: must ..." for every field and the period.
/// Cost: one sine, one cosine and 6 multiplications per harmonic. From feed, depths and edges instead:
/// `milling_force`.
template <std::size_t Harmonics, class Real = double>
requires(Harmonics > 0) class cutting_force {
public:
    using output = signal::force;
    using value = quantity_of<signal::force, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The spindle's frequency, the harmonics of the force, and how it fades in and out.
    struct parameters {
        frequency fundamental;                       ///< 0 < Harmonics * fundamental < half the sampling rate
        quantity_of<signal::force, number> scale;    ///< of one unit of the table; finite
        harmonic_table<Harmonics, number> harmonics; ///< finite
        duration entry{};                            ///< in which the tool enters or leaves the cut; >= 0
    };
    /// Where the cutter stands, and how far it is in the cut.
    struct state {
        turning_phase turn;
        tool_entry tool; ///< how far in the cut
    };

    cutting_force(const parameters& p, duration period) : given_(checked(p, period)) {
        for (std::size_t i = 0; i < Harmonics; ++i) {
            series_.cosine[i] = in_real<Real>(p.scale * p.harmonics.real[i]);
            series_.sine[i] = -in_real<Real>(p.scale * p.harmonics.imaginary[i]);
        }
        state_.turn = turning_phase(p.fundamental, period);
        state_.tool = tool_entry("cutting_force.entry", p.entry, period);
    }

    value operator()() noexcept {
        const double angle = state_.turn.angle();
        const value sum = series_(Real(std::cos(angle)), Real(std::sin(angle)));
        const value force = sum * Real(state_.tool.depth());
        state_.turn.advance();
        state_.tool.advance();
        return force;
    }
    void engage(bool in_the_cut) noexcept { state_.tool.engage(in_the_cut); }
    void reset() noexcept { settle(duration()); }
    /// Not finite: changes nothing.
    void settle(duration t, bool engaged = true) noexcept {
        if (!detail::is_finite(t.value())) return;
        state_.turn.settle(t);
        state_.tool.settle(engaged);
    }

    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("cutting_force.period", period);
        const double highest = 0.5 / (period.value() * static_cast<double>(Harmonics));
        require(p.fundamental.value() > 0 && p.fundamental.value() < highest, "cutting_force.fundamental",
                p.fundamental,
                "must lie between 0 and half the sampling rate by the number of harmonics (" +
                    detail::shortest(detail::in_unit(highest, " Hz")) + ")");
        require_finite<Real>("cutting_force.scale", p.scale);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            require_finite<Real>("cutting_force.harmonics.real", p.harmonics.real[i] * p.scale);
            require_finite<Real>("cutting_force.harmonics.imaginary", p.harmonics.imaginary[i] * p.scale);
        }
        return p;
    }

    parameters given_;
    detail::harmonic_series<Harmonics, value, Real> series_;
    state state_;
};

} // namespace quadrant::inline v0
