// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../friction/maxwell_slip.hpp"

#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

/// Friction by a `maxwell_slip` model whose level is learned while the axis moves: warm oil, more load or a
/// tightened gib scale the springs, their shape over the displacement stays.
///   f = springs of the model,   F = level f + viscous v
///   d level/dt = left f/(settles_in coulomb^2),   lowest <= level <= highest
/// `left` is the force still missing, as an observer estimates it: where it is (true level - level) f, the
/// level approaches the true one with the time constant settles_in as long as the axis slips. What does not go
/// with f (cutting, gravity) averages out.
/// Source: the model of [AlBender2005], [Jamaludin2008] eq. (3.6-3.8); a level beside a friction model that is
/// otherwise known [CanudasDeWit1997].
/// Ports: velocity in, friction out with the sign of the resistance (a loop adds it to the command); the second
/// argument is `left`, in the unit and with the sign of the output, default 0. A `milling_axis` feeds it the
/// velocity of the reference and what its observer says.
/// State: that of the model, and the level. `reset`: relaxed, level 1; `settle(v)`: as if v had acted for
/// ever, the level as it is. `retune(next)`: another model, the level held to its bounds, the jump as of
/// `maxwell_slip`.
/// Range: friction as `maxwell_slip`; settles_in > 0; 0 < lowest <= 1 <= highest.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "maxwell_slip_observer.<field> = ...: must ...", and what `maxwell_slip` throws.
/// Cost: as `maxwell_slip`, 4 multiplications more. One bristle that learns where it acts: `lugre_observer`.
template <std::size_t N, signal_tag Out = signal::force, class Real = double>
requires detail::some_springs<N>
class maxwell_slip_observer {
public:
    using law = maxwell_slip<N, signal::velocity, Out, Real>;
    using input = signal::velocity;
    using output = Out;
    using argument = quantity_of<signal::velocity, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The friction as believed, and how its level is learned.
    struct parameters {
        typename law::parameters friction{}; ///< as believed: level 1
        duration settles_in{};               ///< time constant of the level while the axis slips; > 0
        number lowest = number(0.5), highest = number(2);
    };
    /// The springs, and by how much they are scaled.
    struct state {
        typename law::state springs{};
        Real level{1};
    };

    maxwell_slip_observer(const parameters& p, duration period)
        : given_(p), springs_(without_viscous(p.friction), period),
          viscous_(in_real<Real>(p.friction.curve.viscous)),
          rate_(Real(number(period.value() / p.settles_in.value()) /
                     (p.friction.curve.coulomb.value() * p.friction.curve.coulomb.value()))) {
        law(p.friction, period); // checks the viscous part, too
        require_positive<Real>("maxwell_slip_observer.settles_in", p.settles_in);
        require_coefficients<Real>("maxwell_slip_observer.friction.curve.coulomb", p.friction.curve.coulomb,
                                   rate_);
        require(detail::plain(p.lowest) > 0 && detail::plain(p.lowest) <= 1, "maxwell_slip_observer.lowest",
                p.lowest, "must be above 0 and not above 1");
        require(finite(detail::plain(p.highest)) && detail::plain(p.highest) >= 1,
                "maxwell_slip_observer.highest", p.highest, "must be finite and not below 1");
    }

    value operator()(argument v, value left = value()) noexcept {
        const value drag = viscous_ * v;
        if (!finite(v, left, drag)) return out_.hold();
        const value f = springs_(v);
        const Real next = held(level_ + rate_ * (Real(left.value()) * Real(f.value())));
        const value u = next * f + drag;
        if (!finite(f, u)) return out_.hold();
        level_ = next;
        return out_.keep(u);
    }
    void reset() noexcept {
        springs_.reset();
        level_ = Real(1);
        out_.reset();
    }
    void settle(argument v) noexcept {
        if (!finite(v, viscous_ * v)) return out_.raise();
        springs_.settle(v);
        value f{};
        for (const auto& each : springs_.now().elements) f += each.force;
        out_.reset(level_ * f + viscous_ * v);
    }
    void retune(const maxwell_slip_observer& next) noexcept {
        springs_.retune(next.springs_);
        given_ = next.given_;
        viscous_ = next.viscous_;
        rate_ = next.rate_;
        level_ = held(level_);
    }

    Real level() const noexcept { return level_; } ///< of the machine over the one believed
    bool faulted() const noexcept { return out_.faulted() || springs_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {springs_.now(), level_}; }

private:
    static typename law::parameters without_viscous(typename law::parameters p) {
        p.curve.viscous = {};
        return p;
    }
    Real held(const Real& level) const noexcept {
        const Real low = static_cast<Real>(given_.lowest), high = static_cast<Real>(given_.highest);
        return level < low ? low : level > high ? high : level;
    }

    parameters given_;
    law springs_;
    gain_of<Out, signal::velocity, Real> viscous_;
    Real rate_; ///< of the level, by the product of two bare forces
    Real level_{1};
    held_output<value> out_;
};

} // namespace quadrant::inline v0
