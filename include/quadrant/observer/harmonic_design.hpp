// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "dare.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>

/// Designs of a `harmonic_force_observer`: its gain from poles, or from noise.
namespace quadrant::inline v0 {

/// Design by eigenvalues: where the errors of the 2 + 2 Harmonics states die out, as poles in s [1/s].
template <std::size_t Harmonics> struct placed_poles {
    std::array<std::complex<double>, 2 + 2 * Harmonics> poles{}; ///< left of the axis, in conjugate pairs

    /// All at -decay. Gains grow with the power 2 + 2 Harmonics of it: for one or two harmonics.
    static placed_poles equal(per_second decay) {
        placed_poles p;
        p.poles.fill(-decay.value());
        return p;
    }
    /// Each at its own frequency, shifted left by decay; position and velocity at -decay. For any number of
    /// harmonics.
    static placed_poles shifted(const std::array<frequency, Harmonics>& harmonics, per_second decay) {
        placed_poles p = equal(decay);
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const double w = 2 * std::numbers::pi * harmonics[i].value();
            p.poles[2 + 2 * i] = {-decay.value(), w};
            p.poles[3 + 2 * i] = {-decay.value(), -w};
        }
        return p;
    }
};
/// Design by noise (LQE): a steady Kalman filter.
template <signal_tag Command> struct expected_noise {
    quantity_of<signal::position> encoder; ///< standard deviation of a reading; > 0
    quantity_of<Command> drift;            ///< that each amplitude gathers in one second; > 0
};
/// How the gains of a `harmonic_force_observer` are found.
template <class D, class Command, std::size_t Harmonics>
concept harmonic_design = std::same_as<D, placed_poles<Harmonics>> || std::same_as<D, expected_noise<Command>>;

namespace detail {

/// The axis and its harmonics over one period, in units of one metre, the period, and the command that moves by
/// one in the
/// other: all of order one.
template <std::size_t Harmonics> struct harmonic_model {
    static constexpr std::size_t order = 2 + 2 * Harmonics;
    matrix<order> step{};
    column<order> from_command{};

    /// `slow`: what a period takes off the speed; `angles`: by which each harmonic turns in it.
    static harmonic_model of(double slow, const std::array<double, Harmonics>& angles) {
        harmonic_model m;
        const auto axis = sampled<2, double>({{{0, 1}, {0, -slow}}}, {0, 1}, {}, 1.0);
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 0; j < 2; ++j) m.step[i][j] = axis.step[i][j];
            for (std::size_t j = 2; j < order; j += 2) m.step[i][j] = axis.from_input[i];
            m.from_command[i] = axis.from_input[i];
        }
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const std::size_t q = 2 + 2 * i;
            m.step[q][q] = m.step[q + 1][q + 1] = std::cos(angles[i]);
            m.step[q][q + 1] = std::sin(angles[i]);
            m.step[q + 1][q] = -std::sin(angles[i]);
        }
        return m;
    }
    /// Of a steady Kalman filter; `wander`: variance that each amplitude gathers in a period, over that of the
    /// encoder.
    column<order> gain_for(double wander) const {
        matrix<order> noise{};
        for (std::size_t i = 2; i < order; ++i) noise[i][i] = wander;
        return kalman_gain(step, column<order>{1}, noise, 1.0).gain;
    }
    /// det(z - F (1 - L C)) = prod(z - p_j): residues at the eigenvalues of F, carried back by its
    /// eigenvectors.
    column<order> gain_for(const std::array<std::complex<double>, order>& poles, double T) const {
        using complex = std::complex<double>;
        std::array<complex, order> pole, mode; // wanted; of F
        for (std::size_t i = 0; i < order; ++i) {
            const complex s = poles[i];
            require(detail::is_finite(s.real()) && s.real() < 0, "harmonic_force_observer.design.poles",
                    in_unit(s.real(), " per s"), "must be finite and left of the imaginary axis");
            std::size_t pairs = 0, same = 0;
            for (const complex& other : poles) pairs += other == std::conj(s), same += other == s;
            require(pairs == same, "harmonic_force_observer.design.poles", in_unit(s.imag(), " per s"),
                    "must come in conjugate pairs");
            pole[i] = std::exp(s * T);
        }
        mode[0] = 1;
        mode[1] = step[1][1];
        for (std::size_t i = 0; i < Harmonics; ++i) {
            mode[2 + 2 * i] = {step[2 + 2 * i][2 + 2 * i], step[2 + 2 * i][3 + 2 * i]};
            mode[3 + 2 * i] = std::conj(mode[2 + 2 * i]);
        }
        const auto residue = [&](std::size_t i) {
            complex product = 1.0;
            for (std::size_t j = 0; j < order; ++j)
                product *= (mode[i] - pole[j]) / (j == i ? mode[i] : mode[i] - mode[j]);
            return product;
        };
        column<order> gain{};
        const double at_rest = residue(0).real(), coasting = residue(1).real();
        gain[0] = at_rest + coasting; // all eigenvectors are scaled to a position of one
        gain[1] = coasting * (step[1][1] - 1) / step[0][1];
        for (std::size_t i = 0; i < Harmonics; ++i) {
            const complex z = mode[2 + 2 * i], v = from_command[1] / (z - step[1][1]); // of q = 1, r = j
            const complex x = (step[0][1] * v + from_command[0]) / (z - 1.0), q = 2.0 * residue(2 + 2 * i) / x;
            gain[0] += (q * x).real();
            gain[1] += (q * v).real();
            gain[2 + 2 * i] = q.real();
            gain[3 + 2 * i] = -q.imag();
        }
        return gain;
    }
    /// Largest |eigenvalue| of the error's step.
    double radius(const column<order>& gain) const {
        auto rest = identity<order>();
        for (std::size_t i = 0; i < order; ++i) rest[i][0] -= gain[i];
        return spectral_radius(multiplied(step, rest));
    }
};

} // namespace detail

} // namespace quadrant::inline v0
