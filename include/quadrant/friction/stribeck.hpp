// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <cmath>
#include <concepts>
#include <cstddef>

namespace quadrant::inline v0 {

/// Friction that falls from a breakaway level to the Coulomb level as the axis gets faster, plus a viscous
/// part.
///   F = {Fc + (Fs - Fc) exp(-|v / vs|^delta)} sign(v) + viscous v, sign(0) = 0
/// Source: [Jamaludin2008] eq. (3.5), delta = 1 there; [Armstrong1994] section 2.
/// Ports: scalar velocity in, scalar out with the sign of the velocity (a plant subtracts it, a feedforward
/// adds it).
/// State: none but the last good output; `reset` and `settle` clear the fault flag.
/// At rest a plant needs more than F(v): it asks breakaway() and slip(v), see stick_slip.hpp.
/// Range: 0 <= coulomb <= static_level, stribeck_velocity > 0, 0.25 <= shape <= 4, viscous >= 0.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "stribeck.<field> = ...: must ..." for coulomb, static_level, stribeck_velocity, viscous, shape.
/// Cost: 1 exponential (2 more functions when shape is not 1). Without the fall: `coulomb_viscous`.
template <signal_tag In = signal::velocity, signal_tag Out = signal::force, class Real = double>
class stribeck {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// Levels at breakaway and at speed, what lies between, and the viscous slope.
    struct parameters {
        quantity_of<Out, number> coulomb{};          ///< Fc, level at speed; >= 0
        quantity_of<Out, number> static_level{};     ///< Fs, level at breakaway; >= coulomb
        quantity_of<In, number> stribeck_velocity{}; ///< vs, where the excess has fallen to 1/e; > 0
        gain_of<Out, In, number> viscous{};          ///< >= 0
        double shape = 1;                            ///< delta; 0.25 ... 4
    };
    struct state {};

    stribeck(const parameters& p, duration period)
        : given_(p), coulomb_(in_real<Real>(p.coulomb)),
          excess_(in_real<Real>(quantity_of<Out, number>(p.static_level - p.coulomb))),
          velocity_(in_real<Real>(p.stribeck_velocity)), viscous_(in_real<Real>(p.viscous)) {
        require_positive<Real>("stribeck.period", period);
        require_not_negative<Real>("stribeck.coulomb", p.coulomb);
        require_finite<Real>("stribeck.static_level", p.static_level);
        require_lanes([&](std::size_t i) { return lane(p.static_level, i) >= lane(p.coulomb, i); },
                      "stribeck.static_level", p.static_level,
                      "must not be below coulomb (" + detail::shortest(lane(p.coulomb, 0)) + ")");
        require_positive<Real>("stribeck.stribeck_velocity", p.stribeck_velocity);
        require_not_negative<Real>("stribeck.viscous", p.viscous);
        require(p.shape >= 0.25 && p.shape <= 4, "stribeck.shape", p.shape, "must lie between 0.25 and 4");
    }

    value operator()(argument v) noexcept {
        const value y = at(v);
        return out_.keep(finite(y), y);
    }
    void reset() noexcept { out_.reset(); }
    void settle(argument v) noexcept {
        const value y = at(v);
        out_.settle(finite(y), y);
    }
    void retune(const stribeck& next) noexcept { ///< jump: what the curve changes at v
        const held_output<value> out = out_;
        *this = next;
        out_ = out;
    }

    /// Magnitude of the dry part: what holds a resting axis, and what brakes a moving one.
    value breakaway() const noexcept { return coulomb_ + excess_; }
    [[gnu::always_inline]] value slip(argument v) const noexcept {
        using std::abs, std::exp, std::log;
        Real ratio;
        if constexpr (multi_lane<Real>) // off by half a unit in the last place, and a division shorter
            ratio = abs(Real((v * inverse_velocity_).value()));
        else
            ratio = abs((v / velocity_).value());
        if (given_.shape == 1) return coulomb_ + excess_ * decayed(ratio);
        if constexpr (!multi_lane<Real>) // which log and exp get right
            if (ratio == Real(0)) return breakaway();
        return coulomb_ + excess_ * exp(-exp(Real(given_.shape) * log(ratio)));
    }
    gain_of<Out, In, Real> viscous() const noexcept { return viscous_; }
    /// The level at a speed and its slope there; for shape 1, where the curve is convex. The level may be off
    /// from `slip` by a unit in the last place: a multiplication stands here in place of its division, on which
    /// a plant would wait in every sub-step.
    struct falling {
        value level;
        gain_of<Out, In, Real> slope; ///< <= 0
        decltype(Real(1) /
                 argument()) inverse_scale; ///< of the speed over which slope and curvature change e-fold
    };
    bool convex() const noexcept { return given_.shape == 1; }
    [[gnu::always_inline]] falling fall(argument speed) const noexcept { ///< speed >= 0
        const value excess = excess_ * decayed(Real((speed * inverse_velocity_).value()));
        return {coulomb_ + excess, -(excess * inverse_velocity_), inverse_velocity_};
    }

    /// The same law for the sub-steps of one period. From one sub-step to the next the speed changes by little:
    /// the exponential at the new speed is the last one times that of the difference, a short sum (difference
    /// up to 1/64 of the Stribeck velocity; else the exponential itself). Each sub-step adds up to 4e-16 to the
    /// relative error of the part above Coulomb. Refers to the law, which must not change meanwhile.
    class sub_steps {
    public:
        explicit sub_steps(const stribeck& law) noexcept : law_(law) {}
        value breakaway() const noexcept { return law_.breakaway(); }
        value slip(argument v) const noexcept { return law_.slip(v); }
        gain_of<Out, In, Real> viscous() const noexcept { return law_.viscous(); }
        bool convex() const noexcept { return law_.convex(); }
        [[gnu::always_inline]] falling fall(argument speed) noexcept { ///< speed >= 0
            const Real ratio = Real((speed * law_.inverse_velocity_).value()), d = ratio_ - ratio;
            if (d < Real(near) && d > Real(-near)) {
                const Real d2 = d * d, low = Real(1) + d + d2 * (Real(0.5) + d * Real(1.0 / 6)),
                           high = Real(1.0 / 24) + d * Real(1.0 / 120) + d2 * Real(1.0 / 720);
                excess_ = excess_ * (low + d2 * d2 * high);
            } else
                excess_ = law_.excess_ * decayed(ratio);
            ratio_ = ratio;
            return {law_.coulomb_ + excess_, -(excess_ * law_.inverse_velocity_), law_.inverse_velocity_};
        }

        /// The speed at the end of a sub-step that begins at `speed`, from the two before it: an even
        /// change goes on. So the law is evaluated while the sub-step before is still being solved.
        [[gnu::always_inline]] argument foreseen(argument speed) noexcept { ///< speed > 0
            const argument ahead = last_ + (last_ - before_) * Real(2);
            before_ = last_, last_ = speed;
            if (ahead > speed * Real(0.5) && ahead < speed * Real(2)) [[likely]]
                return ahead;
            return speed;
        }

    private:
        static constexpr double near = 1.0 / 64;
        argument last_{}, before_{}; ///< speeds
        const stribeck& law_;
        Real ratio_ = Real(-1); ///< speed / Stribeck velocity of the last call; none yet
        value excess_{};
    };
    sub_steps in_sub_steps() const noexcept requires std::floating_point<Real> { return sub_steps(*this); }

    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value at(argument v) const noexcept {
        if constexpr (multi_lane<Real>) {
            const value level = slip(v);
            return select(greater(v, argument()), level, select(less(v, argument()), -level, value())) +
                   viscous_ * v;
        } else
            return (v > argument() ? slip(v) : v < argument() ? -slip(v) : value()) + viscous_ * v;
    }

    parameters given_;
    value coulomb_, excess_;
    argument velocity_;
    decltype(Real(1) / argument()) inverse_velocity_ = Real(1) / velocity_;
    gain_of<Out, In, Real> viscous_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
