// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/lanes.hpp"

#include <array>
#include <cmath>
#include <concepts>

namespace quadrant::inline v0 {

/// Friction of a guideway and its screw, with parameters of its own in each direction: the static level dies
/// out as the axis gets faster, the Coulomb level builds up.
///   T = {static e^{-|w| / fall} + coulomb (1 - e^{-|w| / rise})} sign(w) + viscous w, sign(0) = 0
/// Source: [Yeung2006] eqs. (1-18), Td; [Erkorkmaz2001] for its identification.
/// Ports: velocity in, torque or force out with the sign of the velocity (a plant subtracts it, a feedforward
/// adds it).
/// State: none but the last good output; `reset` and `settle` clear the fault flag.
/// At rest a plant needs more than T(w): it asks breakaway(toward) and slip(w), see plant/ball_screw_drive.hpp
/// and, for a linear motor, stick_slip.hpp.
/// Range: static_level >= 0, coulomb >= 0, fall > 0, rise > 0 in either direction, viscous >= 0. With rise >
/// fall the
/// level dips below coulomb before it comes back.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "asymmetric_stribeck.<side>.<field> = ...: must ..." and for viscous and the period.
/// Cost: 2 exponentials; of doubles both in one register (within 1 unit in the last place). The same in both
/// directions: `stribeck`.
template <signal_tag In = signal::angular_velocity, signal_tag Out = signal::torque, class Real = double>
class asymmetric_stribeck {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Magnitudes in one direction.
    struct side {
        quantity_of<Out, number> static_level{}; ///< what has to be overcome from rest; >= 0
        quantity_of<Out, number> coulomb{};      ///< level at speed; >= 0
        quantity_of<In, number> fall{};          ///< where the static part has died out to 1/e; > 0
        quantity_of<In, number> rise{};          ///< where the Coulomb part is up to 1 - 1/e; > 0
    };
    /// Levels of both directions, and the viscous slope that they share.
    struct parameters {
        side forward, backward;
        gain_of<Out, In, number> viscous{}; ///< >= 0
    };
    struct state {};

    asymmetric_stribeck(const parameters& p, duration period)
        : given_(p), forward_(p.forward), backward_(p.backward), viscous_(in_real<Real>(p.viscous)) {
        require_positive<Real>("asymmetric_stribeck.period", period);
        require_not_negative<Real>("asymmetric_stribeck.forward.static_level", p.forward.static_level);
        require_not_negative<Real>("asymmetric_stribeck.forward.coulomb", p.forward.coulomb);
        require_positive<Real>("asymmetric_stribeck.forward.fall", p.forward.fall);
        require_positive<Real>("asymmetric_stribeck.forward.rise", p.forward.rise);
        require_not_negative<Real>("asymmetric_stribeck.backward.static_level", p.backward.static_level);
        require_not_negative<Real>("asymmetric_stribeck.backward.coulomb", p.backward.coulomb);
        require_positive<Real>("asymmetric_stribeck.backward.fall", p.backward.fall);
        require_positive<Real>("asymmetric_stribeck.backward.rise", p.backward.rise);
        require_not_negative<Real>("asymmetric_stribeck.viscous", p.viscous);
    }

    value operator()(argument w) noexcept {
        const value y = at(w);
        return finite(y) ? out_.keep(y) : out_.hold();
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument w) noexcept {
        const value y = at(w);
        finite(y) ? out_.reset(y) : out_.raise();
    }

    /// Magnitude of the dry part: what holds a resting axis that is pushed `forward` or back, and what brakes a
    /// moving one.
    value breakaway(bool forward) const noexcept { return forward ? forward_.dying : backward_.dying; }
    value slip(argument w) const noexcept { return w < argument() ? backward_(-w) : forward_(w); }
    gain_of<Out, In, Real> viscous() const noexcept { return viscous_; }
    /// The magnitude in one direction, in two: one falls with the speed, one rises.
    struct two_parts {
        value falling, rising;
        gain_of<Out, In, Real> falling_slope, rising_slope; ///< by the speed: <= 0, >= 0
        gain_of<Out, In, Real> steepest;                    ///< no |slope| of their sum is larger,
        argument scale;                                     ///< and no |curvature| than steepest / scale
    };
    two_parts parts(bool forward, argument speed) const noexcept {
        return forward ? forward_.parts(speed) : backward_.parts(speed);
    }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    /// One direction, in the number type of the loop.
    struct curve {
        explicit curve(const side& s)
            : dying(in_real<Real>(s.static_level)), level(in_real<Real>(s.coulomb)),
              fall(in_real<Real>(s.fall)), rise(in_real<Real>(s.rise)) {}
        value operator()(argument speed) const noexcept {
            const both left = decays(speed);
            return dying * left.fallen + level * (Real(1) - left.missing);
        }
        two_parts parts(argument speed) const noexcept {
            const both of = decays(speed);
            const value left = dying * of.fallen, missing = level * of.missing;
            return {left,
                    level - missing,
                    -(left / fall),
                    missing / rise,
                    dying / fall + level / rise,
                    fall < rise ? fall : rise};
        }
        /// e^{-speed / fall} and e^{-speed / rise}.
        struct both {
            Real fallen, missing;
        };
        both decays(argument speed) const noexcept {
            if constexpr (std::same_as<Real, double>) {
                const lanes<2> left =
                    decayed(lanes<2>(std::array{(speed / fall).value(), (speed / rise).value()}));
                return {left[0], left[1]};
            } else {
                using std::exp;
                return {Real(exp(-Real(speed / fall))), Real(exp(-Real(speed / rise)))};
            }
        }
        value dying, level;
        argument fall, rise;
    };
    value at(argument w) const noexcept {
        return (w > argument() ? forward_(w) : w < argument() ? -backward_(-w) : value()) + viscous_ * w;
    }

    parameters given_;
    curve forward_, backward_;
    gain_of<Out, In, Real> viscous_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
