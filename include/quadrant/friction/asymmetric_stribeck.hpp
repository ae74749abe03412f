// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

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
/// Cost: 2 exponentials. The same in both directions: `stribeck`.
template <signal_tag In = signal::angular_velocity, signal_tag Out = signal::torque, class Real = double>
class asymmetric_stribeck {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

private:
    struct curve;

public:
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

    /// The same law for sub-steps that hold the level of their beginning. From one to the next the speed
    /// changes by little, so each exponential is the last one times that of the difference, a short sum
    /// (difference up to 1/64 of fall and rise; otherwise the exponential itself). Each sub-step adds up to
    /// 4e-16 to the relative error of a part. Refers to the law, which must not change meanwhile.
    class held_steps {
    public:
        explicit held_steps(const asymmetric_stribeck& law) noexcept : law_(law) {}
        value breakaway(bool forward) const noexcept { return law_.breakaway(forward); }
        value slip(argument w) noexcept {
            const bool forward = !(w < argument());
            const curve& side = forward ? law_.forward_ : law_.backward_;
            const argument speed = forward ? w : -w, change = last_ - speed;
            const Real d = Real(change * side.inverse_fall), e = Real(change * side.inverse_rise);
            last_ = speed;
            if (side_ == &side && d < Real(near) && d > Real(-near) && e < Real(near) && e > Real(-near)) {
                left_ = left_ * short_exp(d);
                missing_ = missing_ * short_exp(e);
            } else {
                using std::exp;
                side_ = &side;
                left_ = side.dying * Real(exp(-Real(speed / side.fall)));
                missing_ = side.level * Real(exp(-Real(speed / side.rise)));
            }
            return left_ + (side.level - missing_);
        }

    private:
        static constexpr double near = 1.0 / 64;
        static Real short_exp(Real d) noexcept { // to 5e-17 at 1/64
            const Real d2 = d * d, low = Real(1) + d + d2 * (Real(0.5) + d * Real(1.0 / 6)),
                       high = Real(1.0 / 24) + d * Real(1.0 / 120) + d2 * Real(1.0 / 720);
            return low + d2 * d2 * high;
        }
        const asymmetric_stribeck& law_;
        const curve* side_ = nullptr; ///< of the last call; none yet
        argument last_{};             ///< speed
        value left_{}, missing_{};
    };
    held_steps in_held_steps() const noexcept requires std::floating_point<Real> { return held_steps(*this); }

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
            using std::exp;
            return dying * Real(exp(-Real(speed / fall))) + level * (Real(1) - Real(exp(-Real(speed / rise))));
        }
        two_parts parts(argument speed) const noexcept {
            using std::exp;
            const value left = dying * Real(exp(-Real(speed / fall))),
                        missing = level * Real(exp(-Real(speed / rise)));
            return {left,
                    level - missing,
                    -(left / fall),
                    missing / rise,
                    dying / fall + level / rise,
                    fall < rise ? fall : rise};
        }
        value dying, level;
        argument fall, rise;
        decltype(Real(1) / argument()) inverse_fall = Real(1) / fall, inverse_rise = Real(1) / rise;
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
