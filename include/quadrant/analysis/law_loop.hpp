// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../control/axis_law.hpp"
#include "../filter/viscous_step.hpp"
#include "../observer/nominal_plant.hpp"
#include "response.hpp"

#include <complex>
#include <numbers>

namespace quadrant::inline v0::analysis {

/// An axis x/u = B / (s (s + A)) behind the hold of its D/A converter, as encoder, tachometer and accelerometer
/// see it at the samples: exact.
///   velocity B gained/(z - kept),  position B {way + gained^2/(z - kept)}/(z - 1),  of `viscous_step`
///   acceleration (1 - 1/z)/T times the velocity: the mean of the last period
/// Source: [Franklin1998] zero-order hold.
template <signal_tag Command = signal::voltage> struct sampled_axis {
    quadrant::axis_model<Command> plant;
    duration period;

    complex velocity(frequency f) const {
        const auto [z, step] = at(f);
        return plant.gain.value() * step.gained / (z - step.kept);
    }
    complex acceleration(frequency f) const { return (1.0 - 1.0 / at(f).z) / period.value() * velocity(f); }
    complex position(frequency f) const {
        const auto [z, step] = at(f);
        return plant.gain.value() * (step.way + step.gained * step.gained / (z - step.kept)) / (z - 1.0);
    }

private:
    struct parts {
        complex z;
        viscous_step<> step;
    };
    parts at(frequency f) const {
        return {std::polar(1.0, 2 * std::numbers::pi * f.value() * period.value()),
                {plant.viscous_rate.value(), period.value()}};
    }
};

/// Every loop of one feed axis under a linear law: the blocks' own response around the sampled axis.
///   L = S_x G_x + S_v G_v + S_a G_a,   open at the command: what the margins are read from
///   tracking     (T_x + s T_v + s^2 T_a) G_x / (1 + L), of a reference that knows its derivatives (s = j w)
///   sensitivity  1/(1 + L)
///   disturbance  G_x/(1 + L), position over what is added to the command
/// Source: [Yeung2006] eq. (19). Friction, play, rounding and limits are not in it.
template <class Law>
requires axis_law<Law> && requires(const Law& law, frequency f) {
    { law.response(f) } -> std::same_as<law_response>;
}
struct law_loop {
    Law law;
    sampled_axis<typename Law::output> axis;

    complex open(frequency f) const {
        const law_response r = law.response(f);
        return r.from_position * axis.position(f) + r.from_velocity * axis.velocity(f) +
               r.from_acceleration * axis.acceleration(f);
    }
    complex sensitivity(frequency f) const { return 1.0 / (1.0 + open(f)); }
    complex disturbance(frequency f) const { return axis.position(f) * sensitivity(f); }
    complex tracking(frequency f) const {
        const law_response r = law.response(f);
        const complex s = laplace(f);
        complex to = r.to_position + s * r.to_velocity + s * s * r.to_acceleration;
        if constexpr (requires { Law::most_lead; })
            to *= std::exp(s * double(law.lead()) * axis.period.value());
        return to * axis.position(f) * sensitivity(f);
    }
};
template <class Law> law_loop(Law, sampled_axis<typename Law::output>) -> law_loop<Law>;

} // namespace quadrant::inline v0::analysis
