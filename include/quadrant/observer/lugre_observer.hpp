// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../friction/lugre.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// Friction by a LuGre model whose bristles are bent further as long as the axis stays behind, so that what the
/// model lacks is learned where it acts.
///   dz/dt = v + correction e - stiffness |v| z/g(v),   F = stiffness z + s1(v) dz/dt + viscous v,   e = reference - position
/// Source: the friction observer of [CanudasDeWit1995] (there dz/dt less k e, e = position - reference).
/// z is the exact solution for what stands during the period, held to what the bristles bear at most: a resting
/// axis under a lasting error would bend them for ever.
/// Ports: speed in, friction out with the sign of the resistance (a loop adds it to the command); the second
/// argument is e, default 0. Feed it the speed of the reference. The axis' own, as in the source, comes back
/// with the sign that helps
/// it: with friction overrated, or a coarse encoder, the axis then hunts at rest.
/// State: stiffness z, in the unit of the output. `reset` leaves it relaxed; `settle(v)` as if v had been
/// applied for ever without error.
/// `retune(next)`: other friction or correction from the next step on; z stays as a force, as far as the new
/// breakaway level bears it, as that of `lugre`.
/// Range: friction as `lugre`; correction >= 0, in 1/s (0: only the model).
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "lugre_observer.correction = ...: must ...", and what `lugre` throws.
/// Cost: as `lugre`. Without a model of friction: `kalman` or `disturbance_observer`.
template <signal_tag Out = signal::force, class Real = double> class lugre_observer {
    using law = lugre<signal::velocity, Out, Real>;

public:
    using input = signal::velocity;
    using output = Out;
    using argument = quantity_of<signal::velocity, Real>;
    using value = quantity_of<Out, Real>;
    using position = quantity_of<signal::position, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The friction as believed, and how strongly an error bends the bristles.
    struct parameters {
        typename law::parameters friction{};        ///< as believed
        quantity<si::frequency, number> correction; ///< k; >= 0
    };
    /// How far the bristles are bent, as the force of their spring.
    struct state {
        value force{}; ///< stiffness z
    };

    lugre_observer(const parameters& p, duration period)
        : given_(p), curve_(p.friction.curve, period), stiffness_(in_real<Real>(p.friction.stiffness)),
          damping_(in_real<Real>(p.friction.damping)),
          damping_velocity_(in_real<Real>(p.friction.damping_velocity)),
          correction_(in_real<Real>(p.correction)),
          period_(quantity<si::time, Real>::from_value(Real(period.value()))) {
        law(p.friction, period); // checks
        require_not_negative<Real>("lugre_observer.correction", p.correction);
    }

    value operator()(argument v, position behind = position()) noexcept {
        using std::exp;
        const argument speed = v >= argument() ? v : -v;
        const gain_of<Out, signal::velocity, Real> stiff = stiffness_ * period_;
        const Real way(stiff * speed / curve_.slip(v)), kept = exp(-way);
        // (1 - exp(-way)) / way, without the cancellation
        const Real reach = way < Real(1e-3)
                               ? Real(1) - way * (Real(0.5) - way * (Real(1) / Real(6) - way / Real(24)))
                               : (Real(1) - kept) / way;
        const value most = curve_.breakaway();
        value bent = state_.force * kept + stiff * (v + correction_ * behind) * reach;
        bent = bent > most ? most : bent < -most ? -most : bent;
        const value u = bent + damping(v) * ((bent - state_.force) / stiff) + curve_.viscous() * v;
        if (!finite(v, behind, u, bent)) return out_.hold();
        state_.force = bent;
        return out_.keep(u);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(argument v) noexcept {
        const value level = curve_.slip(v), bent = v > argument() ? level : v < argument() ? -level : value();
        const value u = bent + curve_.viscous() * v;
        if (!finite(v, u)) return out_.raise();
        state_.force = bent;
        out_.reset(u);
    }

    void retune(const lugre_observer& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        const value most = next.curve_.breakaway(), bent = limited_to(state_.force, most);
        const auto out = out_;
        *this = next;
        state_.force = bent;
        out_ = out;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    gain_of<Out, signal::velocity, Real> damping(argument v) const noexcept {
        using std::exp;
        if (!(damping_velocity_ > argument())) return damping_;
        const Real ratio(v / damping_velocity_);
        return damping_ * Real(exp(-ratio * ratio));
    }

    parameters given_;
    stribeck<signal::velocity, Out, Real> curve_;
    gain_rate_of<Out, signal::velocity, Real> stiffness_;
    gain_of<Out, signal::velocity, Real> damping_;
    argument damping_velocity_;
    quantity<si::frequency, Real> correction_;
    quantity<si::time, Real> period_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
