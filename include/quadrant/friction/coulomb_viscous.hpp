// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

namespace quadrant::inline v0 {

/// Friction of one level plus a part that grows with speed; as plant friction, or as feedforward against it.
///   F = coulomb sign(v) + viscous v, sign(0) = 0
/// Source: [Armstrong1994] section 2; the feedforward of docs/formats.md when Out is a voltage.
/// Ports: scalar velocity in, scalar out with the sign of the velocity (a plant subtracts it, a feedforward
/// adds it).
/// State: none but the last good output; `reset` and `settle` clear the fault flag.
/// Range: coulomb >= 0, viscous >= 0. At rest a plant needs more than F(v): it asks breakaway() and slip(v),
/// see stick_slip.hpp.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "coulomb_viscous.<field> = ...: must be finite and not below 0" for coulomb and viscous.
/// Cost: 1 multiplication, 2 comparisons. For a level that falls with speed: `stribeck`.
template <signal_tag In = signal::velocity, signal_tag Out = signal::force, class Real = double>
class coulomb_viscous {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The level that opposes any motion, and the slope over speed.
    struct parameters {
        quantity_of<Out, number> coulomb{}; ///< level at any speed; >= 0
        gain_of<Out, In, number> viscous{}; ///< per unit of speed; >= 0
    };
    struct state {};

    coulomb_viscous(const parameters& p, duration period)
        : given_(p), coulomb_(in_real<Real>(p.coulomb)), viscous_(in_real<Real>(p.viscous)) {
        require_positive<Real>("coulomb_viscous.period", period);
        require_not_negative<Real>("coulomb_viscous.coulomb", p.coulomb);
        require_not_negative<Real>("coulomb_viscous.viscous", p.viscous);
    }

    value operator()(argument v) noexcept {
        const value y = at(v);
        return finite(y) ? out_.keep(y) : out_.hold();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument v) noexcept {
        const value y = at(v);
        finite(y) ? out_.reset(y) : out_.raise();
    }
    void
    retune(const coulomb_viscous& next) noexcept { ///< jump <= change of coulomb + that of viscous times |v|
        coulomb_ = next.coulomb_;
        viscous_ = next.viscous_;
        given_ = next.given_;
    }

    /// Magnitude of the dry part: what holds a resting axis, and what brakes a moving one.
    value breakaway() const noexcept { return coulomb_; }
    value slip(argument) const noexcept { return coulomb_; }
    gain_of<Out, In, Real> viscous() const noexcept { return viscous_; }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value at(argument v) const noexcept {
        return (v > argument() ? coulomb_ : v < argument() ? -coulomb_ : value()) + viscous_ * v;
    }

    parameters given_;
    value coulomb_;
    gain_of<Out, In, Real> viscous_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
