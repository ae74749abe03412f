// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "response.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <type_traits>

namespace quadrant::inline v0::analysis {

/// Continuous-time responses of the thesis' parts, as callables. For the sampled blocks use their own
/// response(): it has their zero-order hold not in it.

/// A linear axis from command to position: G(s) = B e^{-s Td} / (s (s + A)), [Jamaludin2008] eq. (2.2).
template <signal_tag Command = signal::voltage> struct rigid_axis_model {
    per_second viscous_rate;                     ///< A: viscous friction over mass; >= 0
    gain_of<signal::acceleration, Command> gain; ///< B, acceleration per command
    duration delay;                              ///< Td

    complex operator()(frequency f) const {
        const complex s = laplace(f);
        return gain.value() * std::exp(-s * delay.value()) / (s * (s + viscous_rate.value()));
    }
};

/// PI(s) = kp + ki / s, velocity error to command.
template <signal_tag Command = signal::voltage> struct pi_model {
    gain_of<Command, signal::velocity> gain;               ///< kp
    gain_rate_of<Command, signal::velocity> integral_gain; ///< ki

    complex operator()(frequency f) const { return gain.value() + integral_gain.value() / laplace(f); }
};

/// Velocity from position: wc s / (s + wc), wc = 2 pi corner.
struct derivative_model {
    frequency corner; ///< 150 Hz for 942.5 rad/s

    complex operator()(frequency f) const {
        const complex s = laplace(f);
        const double wc = 2 * std::numbers::pi * corner.value();
        return wc * s / (s + wc);
    }
};

/// (s^2 + w^2) / (s^2 + width w s + w^2), w = 2 pi centre: the parameters of the block `notch`.
struct notch_model {
    frequency centre;
    double width;

    complex operator()(frequency f) const {
        const complex s = laplace(f);
        const double w = 2 * std::numbers::pi * centre.value();
        return (s * s + w * w) / (s * s + width * w * s + w * w);
    }
};

/// Two responses one after the other.
template <frequency_response A, frequency_response B> struct in_series {
    A first;
    B second;
    complex operator()(frequency f) const { return complex(first(f)) * complex(second(f)); }
};
template <class A, class B> in_series(A, B) -> in_series<A, B>;

/// Every closed loop of a P/PI cascade, from the response of its plant: a model, or a measured
/// `tabulated_response`.
///   L_v = PI G F           open velocity loop, F = velocity estimate and notch in the feedback
///   L_p = P PI G/(1 + L_v) open position loop
///   S   = 1/(1 + L_v + P PI G)      sensitivity; its -3 dB from below is the bandwidth that the thesis quotes
///   T   = P PI G S                  position over reference, without feedforward
///   k   = kf/(G S)                  dynamic stiffness, force at the motor over deflection
/// Source: [Jamaludin2008] eqs. (2.22) to (2.34).
/// Units: Plant in position per command, Velocity in command per velocity, Feedback in velocity per position,
/// all SI; position gain in 1/s. Continuous or sampled, but all of one kind: a sampled controller meets a plant
/// with its hold. The disturbance observer and the memory loop are not in it.
template <frequency_response Plant, frequency_response Velocity, frequency_response Feedback,
          signal_tag Command = signal::voltage>
struct p_pi_loop {
    Plant plant;
    Velocity velocity;
    Feedback feedback;
    per_second position_gain; ///< kv

    complex open_velocity(frequency f) const { return at(f).velocity; }
    complex open_position(frequency f) const {
        const parts p = at(f);
        return p.position / (1.0 + p.velocity);
    }
    complex sensitivity(frequency f) const { return 1.0 / return_difference(f); }
    /// 1/(1 + L_v): of the velocity loop by itself.
    complex velocity_sensitivity(frequency f) const { return 1.0 / (1.0 + at(f).velocity); }
    /// 1/(1 + L_p): of the position loop around the closed velocity loop.
    complex position_sensitivity(frequency f) const { return 1.0 / (1.0 + open_position(f)); }
    complex tracking(frequency f) const {
        const parts p = at(f);
        return p.position / (1.0 + p.velocity + p.position);
    }
    /// Tracking error over reference, no feedforward: 1 - T.
    complex error_ratio(frequency f) const { return 1.0 - tracking(f); }
    /// Deflection over force; `force_constant` in newton per command.
    complex compliance(frequency f, gain_of<signal::force, Command> force_constant) const {
        return complex(plant(f)) / (force_constant.value() * return_difference(f));
    }
    /// Force over deflection [N/m].
    complex dynamic_stiffness(frequency f, gain_of<signal::force, Command> force_constant) const {
        return 1.0 / compliance(f, force_constant);
    }

private:
    struct parts {
        complex velocity, position; ///< L_v, P PI G
    };
    parts at(frequency f) const {
        const complex forward = complex(velocity(f)) * complex(plant(f));
        return {forward * complex(feedback(f)), position_gain.value() * forward};
    }
    complex return_difference(frequency f) const {
        const parts p = at(f);
        return 1.0 + p.velocity + p.position;
    }
};
template <class P, class V, class F> p_pi_loop(P, V, F, per_second) -> p_pi_loop<P, V, F>;

/// What pole placement on B/s^2 promises: [Jamaludin2008] eqs. (2.38) to (2.40); no delay, no notch.
struct ideal_corners {
    double velocity; ///< w_s = kp B [rad/s]
    double position; ///< w_p = sqrt(kv w_s) [rad/s]
    double damping;  ///< zeta = 0.5 sqrt(w_s / kv)
};
template <signal_tag Command>
ideal_corners corners(const rigid_axis_model<Command>& plant, const pi_model<Command>& velocity,
                      per_second position_gain) {
    require_positive("corners.position_gain", position_gain);
    const double ws = std::abs(velocity.gain.value() * plant.gain.value()), kv = position_gain.value();
    return {ws, std::sqrt(kv * ws), 0.5 * std::sqrt(ws / kv)};
}

} // namespace quadrant::inline v0::analysis
