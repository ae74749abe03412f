// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

#include <concepts>

namespace quadrant::inline v0 {

/// What the friction feedforward does with the dry part while the reference rests.
enum class at_rest {
    off, ///< fades to nothing as the reference stops: nothing pushes a resting axis
    /// keeps the sign of the last motion, as sticking friction does, and turns over when the reference reverses
    held
};

/// A friction law without memory: dry level by speed, and a viscous slope.
template <class F, class In, class Out, class Real>
concept static_friction = requires(const F& f, quantity_of<In, Real> v) {
    { f.slip(v) } -> std::convertible_to<quantity_of<Out, Real>>;
    { f.viscous() } -> std::convertible_to<gain_of<Out, In, Real>>;
};

/// Pays the friction that the reference is about to cause: any static law (`stribeck`, `coulomb_viscous`) at
/// the velocity of the reference, through the force constant to the command. At a reversal the law jumps by
/// twice its level; here it turns over within `width` of velocity, continuously.
///   u = scale (slip(v) s + viscous v) / force_constant
///   off:  s = v / width between -width and width, else the sign of v
///   held: s moves as little as 2 v / width - 1 <= s (v > 0), s <= 2 v / width + 1 (v < 0) and |s| <= 1 allow
/// Source: [Jamaludin2008] eq. (3.5), static friction feedforward; held: a play operator on the velocity.
/// Ports: velocity of the reference in, command out, sign of the motion (a loop adds it). Never feed the
/// measured
/// velocity: positive feedback. To act earlier, feed it `at(lead).velocity` of a `preview`.
/// State: s; `reset` leaves 0; `settle(v)` as if v had been applied for ever after that. Held, a reference that
/// dithers by less than width / 2 either way does not turn it over.
/// `retune(next)`: another law, scale or width from the next step on, s as far as the new width lets it; jump:
/// the difference of both commands at v.
/// Range: force_constant > 0 (1 for a law in units of the command), scale >= 0 (1 = all of the friction; below
/// 1 leaves some, above 1 makes the axis jump ahead), width > 0: small against the velocities of the path; at
/// acceleration a the turn-over takes 2 width / a, held width / a.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "friction_feedforward.<field> = ...: must ..." for force_constant, scale, width; the law in its own
/// name.
/// Cost: that of the law, 4 multiplications, 1 division. Laws with memory (`dahl`, `lugre`, `maxwell_slip`)
/// turn over
/// by themselves, over the displacement: use them bare, in units of the command.
template <class Law, signal_tag Command = typename Law::output, class Real = typename Law::value::value_type>
requires static_friction<Law, typename Law::input, typename Law::output, Real>
class friction_feedforward {
public:
    using input = typename Law::input;
    using output = Command;
    using argument = quantity_of<input, Real>;
    using value = quantity_of<Command, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The law of the friction, the motor that has to overcome it, and how softly the sign turns over.
    struct parameters {
        typename Law::parameters law{};
        gain_of<typename Law::output, Command, number> force_constant{}; ///< of motor and amplifier; > 0
        quantity_of<input, number> width{};                              ///< where the law is whole; > 0
        number scale = 1;                                                ///< >= 0
        at_rest rest = at_rest::off;
    };
    /// The sign of the dry part, turned over so far.
    struct state {
        Real side{}; ///< s; -1 ... 1
    };

    friction_feedforward(const parameters& p, duration period)
        : given_(p), law_(p.law, period), width_(in_real<Real>(p.width)) {
        require_positive<Real>("friction_feedforward.period", period);
        require_positive<Real>("friction_feedforward.force_constant", p.force_constant);
        require_positive<Real>("friction_feedforward.width", p.width);
        require_not_negative<Real>("friction_feedforward.scale", p.scale);
        share_ = in_real<Real>(gain_of<Command, typename Law::output, number>(p.scale / p.force_constant));
    }

    value operator()(argument v) noexcept {
        const Real side = turned(v, state_.side);
        const value u = at(v, side);
        const auto good = finite(v, u);
        if (none(good)) return out_.hold();
        set_where(good, state_.side, side);
        return out_.keep(good, u);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(argument v) noexcept {
        const Real side = turned(v, Real(0));
        const value u = at(v, side);
        const auto good = finite(v, u);
        set_where(good, state_.side, side);
        out_.settle(good, u);
    }

    void retune(const friction_feedforward& next) noexcept {
        const auto kept = state_;
        const auto out = out_;
        *this = next;
        state_ = kept;
        out_ = out;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    Real turned(argument v, Real side) const noexcept {
        const Real x = Real(v / width_);
        if (given_.rest == at_rest::off) return limited_to(x, Real(-1), Real(1));
        const Real low = limited_to(Real(2) * x - Real(1), Real(-1), Real(1)),
                   high = limited_to(Real(2) * x + Real(1), Real(-1), Real(1));
        return limited_to(side, low, high);
    }
    value at(argument v, Real side) const noexcept {
        return share_ * (law_.slip(v) * side + law_.viscous() * v);
    }

    parameters given_;
    Law law_;
    argument width_;
    gain_of<Command, typename Law::output, Real> share_;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
