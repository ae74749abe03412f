// SPDX-License-Identifier: BSL-1.0
// Long: one block: its step, and what every block has.
#pragma once
#include "presliding.hpp"
#include "spring_law.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrant::inline v0 {

namespace detail {
template <std::size_t N>
concept some_springs = N >
0;
} // namespace detail

/// Friction of N springs side by side, each of which sticks until its share of the level and then slips
/// (Generalized Maxwell-slip): small loops close, and after them the force is back on the curve of the large
/// one.
///   sticks: dF_i/dt = stiffness_i v, until F_i sign(v) = w_i s(v)
///   slips:  dF_i/dt = sign(v) attraction (w_i - |F_i|/s(v)), until v is zero or reverses
///   out = sum F_i + viscous v, s(v) = Fc + (Fs - Fc) exp(-|v/vs|^delta), one curve for all elements
/// Source: [AlBender2005]; [Jamaludin2008] eq. (3.6-3.8). Solved exactly for a velocity that is constant over
/// the step, stick
/// before slip: docs/derivations/maxwell_slip.md.
/// Ports: scalar velocity in (mean of the period that ends now), scalar out with the sign of the resistance (a
/// plant subtracts it, a feedforward adds it). As plant friction: after(v, h) and become(next), see
/// presliding.hpp.
/// State: per element its force, in the unit of the output, and whether it slips. `reset` leaves all relaxed
/// and sticking; `settle(v)` as if v had been applied for ever (relaxed for v = 0).
/// `retune(next)`: another law from the next step on; the sum of the springs stays, but for what is beyond the
/// new Fs: force beyond an element's limit goes to the others. A changed level is then reached as the law says:
/// at once by what sticks, with s/C by what slips. Jump <= (K + K') T + |viscous' - viscous| |v| + (|sum F_i| -
/// Fs' or 0),
/// K = sum max(stiffness_i |v|, C w_i max(1, Fs/Fc - 1)).
/// Shares of the level: either `weights` (their sum is 1), or `forces` at breakaway of the virgin curve, as
/// tables print them, divided by their sum, which must not be above Fs. The other stays zero.
/// Range: 0 < coulomb <= static_level and the rest of `stribeck`; each share and stiffness > 0, attraction > 0.
/// Stable at any step.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "maxwell_slip.<field> = ...: must ..." for curve.coulomb, weights, forces, stiffness, attraction, and
/// what `stribeck` throws for the curve and the period.
/// Cost: 2 exponentials and about 4 multiplications an element; 16 bytes an element. One bristle, smooth:
/// `lugre`.
template <std::size_t N, signal_tag In = signal::velocity, signal_tag Out = signal::force, class Real = double>
requires detail::some_springs<N>
class maxwell_slip {
public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using time = quantity<si::time, Real>;

    /// Curve of the sliding level, and each spring's stiffness and share of the level.
    struct parameters {
        typename stribeck<In, Out, Real>::parameters curve{};     ///< s(v), and the viscous part; coulomb > 0
        std::array<number, N> weights{};                          ///< sum 1; or
        std::array<quantity_of<Out, number>, N> forces{};         ///< sum <= Fs
        std::array<gain_rate_of<Out, In, number>, N> stiffness{}; ///< of each element; > 0
        quantity<unit_quotient<typename Out::unit, si::time>, number> attraction{}; ///< C; > 0
    };
    /// One spring: its force, and whether it slips in the direction of that force.
    struct element {
        value force{};
        bool slips = false; ///< the way its force points
    };
    /// All springs; their forces add up to the friction without its viscous part.
    struct state {
        std::array<element, N> elements{};
    };
    using outcome = friction_outcome<In, Out, state, Real>;

    maxwell_slip(const parameters& p, duration period)
        : given_(p), curve_(p.curve, period), weights_(normalised(p)), attraction_(in_real<Real>(p.attraction)),
          period_(time::from_value(Real(period.value()))) {
        require_positive<Real>("maxwell_slip.curve.coulomb", p.curve.coulomb);
        for (std::size_t i = 0; i < N; ++i) {
            require_positive<Real>("maxwell_slip.stiffness", p.stiffness[i]);
            stiffness_[i] = in_real<Real>(p.stiffness[i]);
            stiffness_step_[i] = stiffness_[i] * period_;
        }
        require_positive<Real>("maxwell_slip.attraction", p.attraction);
        attraction_step_ = attraction_ * period_;
    }

    value operator()(argument v) noexcept {
        const passage way(curve_, v, attraction_step_);
        value y = curve_.viscous() * v;
        std::array<value, N> forces;
        std::array<bool, N> slips;
        for (std::size_t i = 0; i < N; ++i) {
            const element next = moved(i, way, stiffness_step_[i], [](auto&&...) {});
            forces[i] = next.force;
            slips[i] = next.slips;
            y += next.force;
        }
        return memory_.step(v, y, [&](state& memory) {
            for (std::size_t i = 0; i < N; ++i) memory.elements[i] = {forces[i], slips[i]};
        });
    }
    void reset() noexcept { memory_.reset(); }
    void settle(argument v) noexcept {
        state to;
        value y = curve_.viscous() * v;
        const value level = v > argument() ? curve_.slip(v) : v < argument() ? -curve_.slip(v) : value();
        for (std::size_t i = 0; i < N; ++i) {
            to.elements[i] = {weights_[i] * level, v != argument()};
            y += to.elements[i].force;
        }
        memory_.settle(v, y, to);
    }

    /// The force after moving at v for h; changes nothing.
    outcome after(argument v, time h) const noexcept {
        const passage way(curve_, v, attraction_ * h);
        const slope fall = detail::slip_slope(curve_, v, way.level); // of the level by the speed, <= 0
        outcome to{.force = curve_.viscous() * v, .slope = curve_.viscous(), .next = {}};
        for (std::size_t i = 0; i < N; ++i) {
            const slope stiff = stiffness_[i] * h;
            to.next.elements[i] = moved(i, way, stiff, [&](bool sticks, bool holds_more, value off) {
                if (sticks)
                    to.slope += stiff;
                else if (holds_more)
                    to.slope += fall * (weights_[i] * (Real(1) - way.kept) +
                                        Real(off / way.level) * way.kept * way.relaxes);
                else
                    to.slope += fall * weights_[i];
            });
            to.force += to.next.elements[i].force;
        }
        return to;
    }
    /// The force of after(0, h): what the springs hold.
    value at_rest() const noexcept {
        value sum{};
        for (const element& each : now().elements) sum += each.force;
        return sum;
    }
    void become(state next) noexcept {
        for (element& each : next.elements) each.force = unless_died_out(each.force);
        memory_.become(next);
    }
    void retune(const maxwell_slip& next) noexcept {
        if (next.period_ != period_) return memory_.raise();
        auto memory = memory_;
        *this = next;
        memory.become(borne(memory.now()));
        memory_ = memory;
    }

    /// Shares of the level as they are used, sum 1.
    const std::array<Real, N>& weights() const noexcept { return weights_; }
    bool faulted() const noexcept { return memory_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return memory_.now(); }

private:
    using slope = gain_of<Out, In, Real>;

    /// What a step means for all elements. Inlined by name: clang++ would call it with every quantity in
    /// memory.
    struct passage {
        Real sign; ///< of the velocity; one at rest
        bool moves;
        argument speed;
        value level;
        Real relaxes, kept; ///< kept: what is left of the distance to its share of one that slips

        [[gnu::always_inline]] passage(const stribeck<In, Out, Real>& curve, argument v,
                                       value attraction_step) noexcept
            : sign(v >= argument() ? 1 : -1), moves(v != argument()), speed(sign * v), level(curve.slip(v)),
              relaxes(attraction_step / level), kept(fallen(relaxes)) {}
        static Real fallen(const Real& by) noexcept {
            using std::exp;
            return exp(-by);
        }
    };
    /// Element i after it; tell(sticks, is relaxing towards its share, from how far).
    element moved(std::size_t i, const passage& way, slope stiff, auto&& tell) const noexcept {
        const element& now = memory_.now().elements[i];
        const value along = way.sign * now.force; // positive: bent the way the axis goes
        const detail::spring_law<value, Real> spring{weights_[i] * way.level, way.kept};
        element next;
        if (way.moves && now.slips && along > value()) { // slips on
            next = {spring.slips_on(along), true};
            tell(false, true, along - spring.share);
        } else if (const value reached = along + stiff * way.speed;
                   !way.moves || spring.sticks(reached)) { // sticks
            next = {reached, false};
            tell(true, false, value());
        } else { // breaks away, with what it holds where the level has fallen below that
            next = {spring.breaks_away(along), true};
            const bool more = along > spring.share;
            tell(false, more, more ? value(along - spring.share) : value());
        }
        next.force *= way.sign;
        return next;
    }
    /// What an element holds beyond its share of the breakaway level goes to the others, as far as they can
    /// hold it; an element whose force changes sticks.
    state borne(const state& of) const noexcept {
        state to = of;
        value left{};
        const auto hold = [&](std::size_t i, value force) {
            to.elements[i].force = detail::borne(force, weights_[i] * curve_.breakaway());
            left += force - to.elements[i].force;
            to.elements[i].slips = of.elements[i].slips && to.elements[i].force == of.elements[i].force;
        };
        for (std::size_t i = 0; i < N; ++i) hold(i, of.elements[i].force);
        for (std::size_t i = 0; i < N; ++i) {
            const value more = left;
            left = value();
            hold(i, to.elements[i].force + more);
        }
        return to;
    }
    static std::array<Real, N> normalised(const parameters& p) {
        number weights(0), forces(0);
        bool by_force = true, none = true; // no weight given; neither weight nor force
        for (std::size_t i = 0; i < N; ++i) {
            weights += p.weights[i];
            forces += p.forces[i].value();
            by_force = by_force && detail::plain(p.weights[i]) == 0;
            none = none && by_force && detail::plain(p.forces[i].value()) == 0;
        }
        if (none)
            require(false, "maxwell_slip.weights (sum)", weights,
                    "must be 1, or forces must be given in their place");
        for (std::size_t i = 0; i < N; ++i) {
            if (by_force)
                require_positive<Real>("maxwell_slip.forces", p.forces[i]);
            else {
                require_positive<Real>("maxwell_slip.weights", p.weights[i]);
                require(p.forces[i].value() == number(0), "maxwell_slip.forces", p.forces[i],
                        "must be zero where weights are given");
            }
        }
        if (by_force)
            require(forces <= p.curve.static_level.value(), "maxwell_slip.forces (sum)",
                    decltype(p.curve.static_level)::from_value(forces),
                    "must not be above static_level (" + detail::shortest(p.curve.static_level) + ")");
        else
            require(std::abs(detail::plain(weights) - 1) <= 1e-9, "maxwell_slip.weights (sum)", weights,
                    "must be 1; shares given as forces go into forces");
        std::array<Real, N> w;
        for (std::size_t i = 0; i < N; ++i)
            w[i] = Real(by_force ? number(p.forces[i].value() / forces) : number(p.weights[i] / weights));
        return w;
    }

    parameters given_;
    stribeck<In, Out, Real> curve_;
    std::array<Real, N> weights_;
    quantity<unit_quotient<typename Out::unit, si::time>, Real> attraction_;
    time period_;
    value attraction_step_{};
    std::array<gain_rate_of<Out, In, Real>, N> stiffness_{};
    std::array<slope, N> stiffness_step_{};
    detail::friction_memory<outcome, argument> memory_;
};

} // namespace quadrant::inline v0
