// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "maxwell_slip.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// In lanes: every spring of every lane lies in one wide number, and no branch depends on a spring. Per lane
/// the same result as `maxwell_slip` in double, but for the two exponentials, which are those of the lanes
/// (docs/lanes.md). A feedforward and an estimate; as friction of a plant (`after`) one instance in double.
/// Cost: 2 exponentials for all lanes and about 16 operations per N lanes of a register.
template <std::size_t N, signal_tag In, signal_tag Out, several_lanes Real>
requires detail::some_springs<N>
class maxwell_slip<N, In, Out, Real> {
    static constexpr std::size_t W = lane_count<Real>;
    using one = maxwell_slip<N, In, Out, double>;
    using wide = typename Real::template times<N>;

public:
    using input = In;
    using output = Out;
    using argument = quantity_of<In, Real>;
    using value = quantity_of<Out, Real>;
    using number = Real; ///< of parameters

    /// As those of one law, each for all lanes; the shape of the curve is common to them.
    struct parameters {
        typename stribeck<In, Out, Real>::parameters curve{};
        std::array<Real, N> weights{};
        std::array<value, N> forces{};
        std::array<gain_rate_of<Out, In, Real>, N> stiffness{};
        quantity<unit_quotient<typename Out::unit, si::time>, Real> attraction{};

        /// Those of lane i.
        typename one::parameters of(std::size_t i) const {
            typename one::parameters p{.curve = {lane(curve.coulomb, i), lane(curve.static_level, i),
                                                 lane(curve.stribeck_velocity, i), lane(curve.viscous, i),
                                                 curve.shape},
                                       .attraction = lane(attraction, i)};
            for (std::size_t k = 0; k < N; ++k) {
                p.weights[k] = lane(weights[k], i);
                p.forces[k] = lane(forces[k], i);
                p.stiffness[k] = lane(stiffness[k], i);
            }
            return p;
        }
    };
    /// The springs of all lanes: spring k of lane i is number k W + i.
    struct state {
        wide force{};
        typename wide::mask slips{};
        /// The memory of lane i, as that of one law.
        typename one::state of(std::size_t i) const noexcept {
            typename one::state s;
            for (std::size_t k = 0; k < N; ++k)
                s.elements[k] = {quantity_of<Out>::from_value(force[k * W + i]), slips[k * W + i]};
            return s;
        }
        void set(std::size_t i, const typename one::state& s) noexcept {
            for (std::size_t k = 0; k < N; ++k) {
                force.set(k * W + i, s.elements[k].force.value());
                slips.set(k * W + i, s.elements[k].slips);
            }
        }
    };

    maxwell_slip(const parameters& p, duration period) : given_(p), period_(period), curve_(p.curve, period) {
        for (std::size_t i = 0; i < W; ++i) {
            const one each(p.of(i), period); // checks
            for (std::size_t k = 0; k < N; ++k) {
                share_.set(k * W + i, each.weights()[k]);
                stiffness_.set(k * W + i, (lane(p.stiffness[k], i) * period).value());
            }
        }
        attraction_ = Real(p.attraction.value() * Real(period.value()));
    }

    value operator()(argument v) noexcept {
        const Real level = curve_.slip(v).value(), kept = decayed(Real(attraction_ / level));
        const wide along_v = repeated<N>(v.value()), speed = turned_as(along_v, along_v), zero{};
        const detail::spring_law<wide, wide> springs{share_ * repeated<N>(level), repeated<N>(kept)};
        const wide along = turned_as(state_.force, along_v); // positive: bent the way the axis goes
        const wide reached = along + stiffness_ * speed;
        const auto moves = less(zero, speed), slips_on = state_.slips & greater(along, zero);
        const auto slips = moves & (slips_on | springs.gives_way(reached));
        const wide next = turned_as(select(slips, springs.slips(along, slips_on), reached), along_v);
        value y = curve_.viscous() * v;
        for (std::size_t k = 0; k < N; ++k) y += value::from_value(part<W>(next, k));
        const auto good = finite(v, y);
        if constexpr (steps_together<Real>)
            state_ = {next, slips};
        else {
            if (none(good)) return out_.hold();
            const wide all = repeated<N>(select(good, Real(1), Real(0)));
            const auto taken = greater(all, zero);
            set_where(taken, state_.force, next);
            set_where(taken, state_.slips, slips);
        }
        return out_.keep(good, y);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(argument v) noexcept {
        const auto good = v.value().finite_mask();
        value y = out_.last();
        for (std::size_t i = 0; i < W; ++i) {
            if (!good[i]) continue;
            one each = lane_of(i);
            each.settle(lane(v, i));
            state_.set(i, each.now());
            set_lane(y, i, each(lane(v, i)));
        }
        if constexpr (steps_together<Real>)
            out_.reset(y);
        else
            out_.settle(good, y);
    }
    /// As that of one law, lane by lane: out of the hot path.
    void retune(const maxwell_slip& next) noexcept {
        if (next.period_ != period_) return out_.raise();
        const auto out = out_;
        std::array<typename one::state, W> each;
        for (std::size_t i = 0; i < W; ++i) {
            one law = lane_of(i);
            law.retune(next.lane_of(i));
            each[i] = law.now();
        }
        *this = next;
        out_ = out;
        for (std::size_t i = 0; i < W; ++i) state_.set(i, each[i]);
    }

    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    /// Lane i as one law, with its memory.
    one lane_of(std::size_t i) const {
        one law(given_.of(i), period_); // was checked
        law.become(state_.of(i));
        return law;
    }

    parameters given_;
    duration period_;
    stribeck<In, Out, Real> curve_;
    Real attraction_{};
    wide share_{}, stiffness_{};
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
