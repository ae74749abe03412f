// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "presliding.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// Friction that gives way like a spring before it slides: bristles that bend to a level which does not depend
/// on speed.
///   dF/dx = stiffness |r|^shape sign(r), r = 1 - F sign(v)/coulomb; out = F + viscous v
/// Source: [Dahl1968]; [Jamaludin2008] eq. (3.1), shape = 1 there. Solved exactly for a velocity that is
/// constant over the step, so a step is as good as many and only the path counts, not the speed:
/// docs/derivations/dahl.md.
/// Ports: scalar velocity in (mean of the period that ends now), scalar out with the sign of the resistance (a
/// plant subtracts it, a feedforward adds it). As plant friction: after(v, h) and become(next), see
/// presliding.hpp.
/// State: F without the viscous part, in the unit of the output. `reset` leaves it relaxed; `settle(v)` as if v
/// had been
/// applied for ever: +-coulomb, relaxed for v = 0.
/// `retune(next)`: another law from the next step on; the bristles keep their force, but for what is beyond the
/// new level. Jump <= max(K, K') |v| T + |viscous' - viscous| |v| + (|F| - coulomb' or 0), K = 2^shape
/// stiffness: the step that either makes.
/// Range: coulomb > 0, stiffness > 0, 0 <= shape <= 4, viscous >= 0. Shape 0: a spring up to the level; below 1
/// the level is reached within a finite displacement, from 1 on never quite. Stable at any step.
/// Does not remember inner loops: they drift. Breakaway is the sliding level.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "dahl.<field> = ...: must ..." for period, coulomb, stiffness, shape, viscous.
/// Cost: 1 exponential (6 functions when shape is neither 0 nor 1), 8 bytes. A level that falls: `lugre`; loops
/// that
/// close: `maxwell_slip`.
template <signal_tag In = signal::velocity, signal_tag Out = signal::force, class Real = double> class dahl {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using time = quantity<si::time, Real>;

    /// The sliding level, and the spring that it is reached by.
    struct parameters {
        quantity_of<Out, number> coulomb{};        ///< sliding level; > 0
        gain_rate_of<Out, In, number> stiffness{}; ///< at the start of a motion, per unit of displacement; > 0
        double shape = 1;                          ///< exponent; 0 ... 4
        gain_of<Out, In, number> viscous{};        ///< >= 0
    };
    /// How far the bristles are bent, as their force.
    struct state {
        value force{}; ///< of the bristles
    };
    using outcome = friction_outcome<In, Out, state, Real>;

    dahl(const parameters& p, duration period)
        : given_(p), coulomb_(in_real<Real>(p.coulomb)), stiffness_(in_real<Real>(p.stiffness)),
          viscous_(in_real<Real>(p.viscous)), period_(time::from_value(Real(period.value()))) {
        require_positive<Real>("dahl.period", period);
        require_positive<Real>("dahl.coulomb", p.coulomb);
        require_positive<Real>("dahl.stiffness", p.stiffness);
        require(p.shape >= 0 && p.shape <= 4, "dahl.shape", p.shape, "must lie between 0 and 4");
        require_not_negative<Real>("dahl.viscous", p.viscous);
    }

    value operator()(argument v) noexcept { return memory_.step(v, after(v, period_)); }
    void reset() noexcept { memory_.reset(); }
    void settle(argument v) noexcept {
        const state to{v > argument() ? coulomb_ : v < argument() ? -coulomb_ : value()};
        memory_.settle(v, to.force + viscous_ * v, to);
    }

    /// The force after moving at v for h; changes nothing.
    outcome after(argument v, time h) const noexcept {
        const bool forward = v >= argument();
        const value along = forward ? now().force : -now().force; // positive: bent the way the axis goes
        const Real gap = Real(1) - Real(along / coulomb_);        // r: 0 slides, 2 bent the other way
        const Real way = Real(stiffness_ * (forward ? v : -v) * h / coulomb_);
        const Real left = remaining(gap, way);
        const value bent = along + coulomb_ * (gap - left);
        outcome to;
        to.next.force = forward ? bent : -bent;
        to.force = to.next.force + viscous_ * v;
        to.slope = viscous_ + stiffness_ * h * (given_.shape == 1 ? left : power(left, Real(given_.shape)));
        return to;
    }
    void become(const state& next) noexcept { memory_.become({unless_died_out(next.force)}); }
    void retune(const dahl& next) noexcept {
        if (next.period_ != period_) return memory_.raise();
        auto memory = memory_;
        *this = next;
        memory.become({detail::borne(memory.now().force, coulomb_)});
        memory_ = memory;
    }

    bool faulted() const noexcept { return memory_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return memory_.now(); }

private:
    /// r^p for 0 <= r, with 0^0 = 0: a spring at its level pushes back no further.
    static Real power(Real r, Real p) noexcept {
        using std::exp, std::log;
        return r > Real(0) ? Real(exp(p * log(r))) : Real(0);
    }
    /// r after the displacement a: dr/da = -r^shape.
    Real remaining(Real r, Real a) const noexcept {
        using std::exp;
        if (!(r > Real(0))) return Real(0);
        if (a == Real(0)) return r - a * power(r, Real(given_.shape)); // r, and its derivative
        if (given_.shape == 1) return r * exp(-a);
        const Real e = Real(1 - given_.shape);
        const Real base = given_.shape == 0 ? r - a : power(r, e) - e * a;
        if (!(base > Real(0))) return Real(0);
        return given_.shape == 0 ? base : power(base, Real(1) / e);
    }

    parameters given_;
    value coulomb_;
    gain_rate_of<Out, In, Real> stiffness_;
    gain_of<Out, In, Real> viscous_;
    time period_;
    detail::friction_memory<outcome, argument> memory_;
};

} // namespace quadrant::inline v0
