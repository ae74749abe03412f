// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "presliding.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// Friction of bristles that bend, slip, and slip at a lower level when the axis is faster.
///   dz/dt = v - stiffness |v| z/g(v), g(v) = Fc + (Fs - Fc) exp(-|v/vs|^delta), Fc, Fs, vs, delta of the curve
///   F = stiffness z + s1(v) dz/dt + viscous v, s1 = damping, or damping exp(-(v/damping_velocity)^2)
/// Source: [CanudasDeWit1995]; [Jamaludin2008] eq. (3.2-3.4); [LowKeck2003] with delta = 2.
/// Explicit Euler diverges in any fast move. Here z is the exact solution for a velocity that is constant over
/// the step, and dz/dt its mean over the step: docs/derivations/lugre.md.
/// Ports: scalar velocity in (mean of the period that ends now), scalar out with the sign of the resistance (a
/// plant subtracts it, a feedforward adds it). As plant friction: after(v, h) and become(next), see
/// presliding.hpp.
/// State: stiffness z, in the unit of the output. `reset` leaves it relaxed; `settle(v)` as if v had been
/// applied for ever. `retune(next)`: another law from the next step on; the bristles keep their force, but for
/// what is beyond the new Fs. Jump <= (K + K' + |viscous' - viscous|) |v| + (|stiffness z| - Fs' or 0), K =
/// (1 + Fs/Fc) (stiffness T + damping): the step of each.
/// Range: 0 < coulomb <= static_level and the rest of `stribeck`, stiffness > 0, damping >= 0, damping_velocity
/// >= 0 (0: the damping does not fall); 1/(stiffness T) and 1/damping_velocity at most the root of the largest
/// number (1.8e19 in float). Stable at any step. passive(p) says whether no motion can get energy
/// out of it; with constant damping that needs viscous >= damping (Fs - Fc)/Fc [Barahanov2000].
/// Does not remember inner loops: they drift. Breakaway falls with the rate of the pull.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "lugre.<field> = ...: must ..." for curve.coulomb, stiffness, damping, damping_velocity, and what
/// `stribeck` throws for the curve and the period.
/// Cost: 2 exponentials (1 more for damping that falls), 8 bytes. Loops that close: `maxwell_slip`.
template <signal_tag In = signal::velocity, signal_tag Out = signal::force, class Real = double> class lugre {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using time = quantity<si::time, Real>;

    /// Curve of the sliding level, and spring and damping of the bristles.
    struct parameters {
        typename stribeck<In, Out, Real>::parameters curve{}; ///< g(v), and the viscous part; coulomb > 0
        gain_rate_of<Out, In, number> stiffness{};            ///< sigma0, of all bristles; > 0
        gain_of<Out, In, number> damping{};                   ///< sigma1, of all bristles; >= 0
        quantity_of<In, number> damping_velocity{};           ///< where damping has fallen to 1/e; 0: nowhere
    };
    /// How far the bristles are bent, as the force of their spring.
    struct state {
        value force{}; ///< stiffness z
    };
    using outcome = friction_outcome<In, Out, state, Real>;

    lugre(const parameters& p, duration period)
        : given_(p), curve_(p.curve, period), stiffness_(in_real<Real>(p.stiffness)),
          damping_(in_real<Real>(p.damping)), damping_velocity_(in_real<Real>(p.damping_velocity)),
          period_(time::from_value(Real(period.value()))) {
        require_positive<Real>("lugre.curve.coulomb", p.curve.coulomb);
        require_positive<Real>("lugre.stiffness", p.stiffness);
        require_coefficients<Real>("lugre.stiffness", p.stiffness,
                                   Real(1) / Real((stiffness_ * period_).value()));
        require_not_negative<Real>("lugre.damping", p.damping);
        require_not_negative<Real>("lugre.damping_velocity", p.damping_velocity);
        if (damping_velocity_ > argument())
            require_coefficients<Real>("lugre.damping_velocity", p.damping_velocity,
                                       Real(1) / Real(damping_velocity_.value()));
    }

    value operator()(argument v) noexcept { return memory_.step(v, after(v, period_)); }
    void reset() noexcept { memory_.reset(); }
    void settle(argument v) noexcept {
        const value level = curve_.slip(v);
        const state to{v > argument() ? level : v < argument() ? -level : value()};
        memory_.settle(v, to.force + curve_.viscous() * v, to);
    }

    /// The force after moving at v for h; changes nothing.
    outcome after(argument v, time h) const noexcept {
        using std::exp;
        const bool forward = v >= argument();
        const argument speed = forward ? v : -v;
        const value along = forward ? now().force : -now().force; // positive: bent the way the axis goes
        const value level = curve_.slip(v);
        const auto fall = detail::slip_slope(curve_, v, level); // of the level by the speed, <= 0
        const gain_of<Out, In, Real> stiff = stiffness_ * h;
        const Real way(stiff * speed / level);
        const Real kept = exp(-way);
        const value bent = along + (level - along) * (Real(1) - kept);
        // d way/d speed = stiff/level - way fall/level; at great speeds kept is zero and so is the product.
        const gain_of<Out, In, Real> bends =
            kept > Real(0) ? gain_of<Out, In, Real>(fall * (Real(1) - kept) +
                                                    (level - along) * kept * ((stiff - way * fall) / level))
                           : fall;
        const gain_of<Out, In, Real> s1 = damping(v);
        outcome to;
        to.next.force = forward ? bent : -bent;
        to.force = to.next.force + s1 * ((to.next.force - now().force) / stiff) + curve_.viscous() * v;
        to.slope = bends + s1 * Real(bends / stiff) + curve_.viscous();
        if (damping_velocity_ > argument()) // and s1 falls
            to.slope -= s1 * (Real(2) * Real(speed / damping_velocity_) *
                              Real((bent - along) / stiff / damping_velocity_));
        return to;
    }
    value at_rest() const noexcept { return now().force; } ///< the force of after(0, h)
    void become(const state& next) noexcept { memory_.become({unless_died_out(next.force)}); }
    void retune(const lugre& next) noexcept {
        if (next.period_ != period_) return memory_.raise();
        auto memory = memory_;
        *this = next;
        memory.become({detail::borne(memory.now().force, curve_.breakaway())});
        memory_ = memory;
    }

    /// True when no motion gets energy out of friction, bristle energy counted: for all speeds and bends
    ///   y^2/v - s1(v) y + (s1(v) + viscous) g(v) >= 0 for 0 <= y <= Fs; constant damping: viscous >= damping (Fs - Fc)/Fc
    /// For damping that falls, on 60 speeds a decade. Allocates nothing, but is no step.
    static bool passive(const parameters& p);

    bool faulted() const noexcept { return memory_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return memory_.now(); }

private:
    gain_of<Out, In, Real> damping(argument v) const noexcept {
        using std::exp;
        if (!(damping_velocity_ > argument())) return damping_;
        const Real ratio(v / damping_velocity_);
        return damping_ * Real(exp(-ratio * ratio));
    }

    parameters given_;
    stribeck<In, Out, Real> curve_;
    gain_rate_of<Out, In, Real> stiffness_;
    gain_of<Out, In, Real> damping_;
    argument damping_velocity_;
    time period_;
    detail::friction_memory<outcome, argument> memory_;
};

template <signal_tag In, signal_tag Out, class Real> bool lugre<In, Out, Real>::passive(const parameters& p) {
    const auto plain = [](const auto& q) { return detail::plain(q); };
    const double fc = plain(p.curve.coulomb), fs = plain(p.curve.static_level), s2 = plain(p.curve.viscous),
                 s1 = plain(p.damping), slow = plain(p.damping_velocity);
    if (!(slow > 0)) return s2 * fc >= s1 * (fs - fc);
    const stribeck<In, Out, Real> curve(p.curve, duration::from_value(1));
    const double vs = plain(p.curve.stribeck_velocity);
    const double first = 1e-3 * (slow < vs ? slow : vs),
                 last = 30 * slow; // beyond, exp(-900) is left of the damping
    for (double v = first; v <= last; v *= 1.04) {
        const double d = s1 * std::exp(-(v / slow) * (v / slow));
        const double g = plain(curve.slip(argument::from_value(Real(v))));
        const double worst = d * v / 2 < fs ? d * v / 2 : fs; // the bend at which the left side is least
        if (worst * worst / v - d * worst + (d + s2) * g < 0) return false;
    }
    return true;
}

} // namespace quadrant::inline v0
