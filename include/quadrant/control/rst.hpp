// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/fine_sum.hpp"
#include "../base/finite.hpp"
#include "../base/standstill.hpp"
#include "axis_law.hpp"
#include "diophantine.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

namespace detail {
/// lead() and most_lead of a law that previews Lead periods; nothing of one that does not.
template <std::size_t Lead> struct previewing {
    static constexpr std::size_t most_lead = Lead;
    static constexpr std::size_t lead() noexcept { return Lead; }
};
template <> struct previewing<0> {};
} // namespace detail

/// What an `rst` is: polynomials in z^-1 by rising power, of the degrees R, S, T.
template <std::size_t R, std::size_t S, std::size_t T, signal_tag Command = signal::voltage,
          class Number = double>
struct rst_polynomials {
    z_polynomial<R, Number> r{};                                               ///< r[0] = 1
    std::array<gain_of<Command, signal::position, Number>, S + 1> feedback{};  ///< s
    std::array<gain_of<Command, signal::position, Number>, T + 1> reference{}; ///< t; the same sum as s
    z_polynomial<R> recovery = {1}; ///< w, anti-windup: [0] = 1, roots inside the unit circle; 1 alone: at once
};

/// A control law of a feed drive of two degrees of freedom, any linear one on positions: what pole placement,
/// zero phase error tracking, generalized predictive control and lead-lag compensation are.
///   R u = T x_ref - S x,   R, S, T polynomials in z^-1
///   under a limit: W u = T x_ref - S x + (W - R) u_applied
/// Source: [Astrom1997] ch. 5 (two degrees of freedom), 3.5 (anti-windup by the observer polynomial W).
/// Ports: those of `axis_law`; velocities and acceleration are not used. Designs: `place_rst`,
/// `zero_phase_rst`, `generalized_predictive`, `design_lead_lag`; they check that the loop around their plant
/// is stable.
/// State: past references, positions, commands applied. `reset` at rest at zero; `settle(x, u)`: at rest at x,
/// held by u when R has a root at z = 1 (integral); else the command starts from u and goes where the position
/// asks.
/// `retune(next, ..., u)`: as `retunable_law` says; the past of reference and position stays, that of the
/// command is moved by as much as brings the last one to u. Then u'[k] - u = T'(1) (x_ref - x) - R'(1) u +
/// sums of t', s', r', w' times differences of the last samples: with an integral, R'(1) = 0, the step that
/// the new law would have made anyway.
/// Range: S and T have the same sum (with an integral in axis or law a constant reference is reached);
/// positions count from where the axis is, so that no digits are lost far from zero, and all sums are of
/// differences, so that a slow law keeps its digits at a high rate. With Lead > 0 the reference is taken so
/// many periods ahead (`preview`).
/// NaN and infinities in any input: holds the last command, keeps the state, raises faulted().
/// Throws "rst.r[0] = ...: must be 1", "rst.reference = ...: must have the sum of feedback", "rst.recovery =
/// ...: must ...".
/// Cost: 2 R + S + T + 1 multiplications, 8 (2 R + S + T) bytes of state. Of states instead: `state_feedback`.
template <std::size_t R, std::size_t S, std::size_t T, std::size_t Lead = 0, class Real = double,
          signal_tag Command = signal::voltage>
requires(R > 0 && S > 0 && T > 0) class rst : public detail::previewing<Lead> {
public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters
    using parameters = rst_polynomials<R, S, T, Command, number>;
    static constexpr bool fine = std::same_as<Real, float>; ///< the command is held in two numbers
    /// The past of reference, position and command that the polynomials see; newest first. In float `rest` is
    /// what rounding left over of the last command.
    struct state : detail::rest_of_sum<value, fine> {
        std::array<position, T> reference{};
        std::array<position, S> measured{};
        std::array<value, R> applied{}, excess{}; ///< excess: command minus applied
    };

    rst(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("rst.period", period);
        require_lanes([&](std::size_t i) { return detail::plain(lane(p.r[0], i)) == 1; }, "rst.r[0]", p.r[0],
                      "must be 1");
        require(p.recovery[0] == 1, "rst.recovery[0]", p.recovery[0], "must be 1");
        number size{}, difference{};
        const auto take = [&](auto& own, const auto& from, const detail::field_name& name, number sign) {
            for (std::size_t i = 0; i < from.size(); ++i) {
                require_finite<Real>(name, from[i]);
                own[i] = in_real<Real>(from[i]);
                size += absolute(detail::bare(from[i])), difference += sign * detail::bare(from[i]);
            }
        };
        take(t_, p.reference, "rst.reference", 1);
        take(s_, p.feedback, "rst.feedback", -1);
        require_lanes(
            [&](std::size_t i) {
                return std::abs(detail::plain(lane(difference, i))) <= 1e-9 * detail::plain(lane(size, i));
            },
            "rst.reference", difference, "must have the sum of feedback (difference)");
        for (std::size_t i = 0; i <= R; ++i) {
            require_finite<Real>("rst.r", p.r[i]);
            require_finite<Real>("rst.recovery", p.recovery[i]);
            r_[i] = Real(p.r[i]), w_[i] = Real(p.recovery[i]);
        }
        // Of the parameters as they are given, before they are rounded to Real.
        number leak{}, gain{};
        for (const number& each : p.r) leak += each;
        for (const auto& each : p.reference) gain += each.value();
        leak_ = Real(leak);
        gain_ = gain_of<Command, signal::position, Real>::from_value(Real(gain));
        const double slowest = detail::largest_root(p.recovery);
        require(slowest < 1, "rst.recovery", slowest, "must have its roots inside the unit circle (largest)");
    }

    /// In differences: R u = u - u' + R(1) u' + sum from 2 on of r_i (u_i - u'), u' the last command; T and S
    /// likewise.
    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        const value last = state_.applied[0];
        value more = gain_ * (reference.position - measured) - leak_ * last;
        for (std::size_t i = 1; i <= T; ++i) more += t_[i] * (state_.reference[i - 1] - reference.position);
        for (std::size_t i = 1; i <= S; ++i) more -= s_[i] * (state_.measured[i - 1] - measured);
        for (std::size_t i = 2; i <= R; ++i) more -= r_[i] * (state_.applied[i - 1] - last);
        for (std::size_t i = 1; i <= R; ++i) more -= w_[i] * state_.excess[i - 1];
        const auto sum = summed(more);
        const value u = unless_died_out(sum.high);
        const auto good = finite(reference.velocity, reference.acceleration, tachometer, measured, u);
        if (none(good)) return out_.hold();
        push(good, state_.reference, reference.position);
        push(good, state_.measured, measured);
        push(good, state_.applied, u);
        push(good, state_.excess, value());
        if constexpr (fine) state_.rest = unless_died_out(sum.low);
        return out_.keep(good, u);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept {
        const value excess = out_.last() - u;
        const auto good = finite(excess);
        set_where(good, state_.applied[0], u);
        set_where(good, state_.excess[0], excess);
        if constexpr (fine)
            if (excess != value()) state_.rest = value();
        out_.raise(!good);
    }
    void reset() noexcept { settle(position(), value()); }
    void settle(position x, value u) noexcept {
        const auto good = finite(x, u);
        for (position& each : state_.reference) set_where(good, each, x);
        for (position& each : state_.measured) set_where(good, each, x);
        for (value& each : state_.applied) set_where(good, each, u);
        for (value& each : state_.excess) set_where(good, each, value());
        if constexpr (fine)
            if (good) state_.rest = value();
        out_.settle(good, u);
    }

    void retune(const rst& next, const axis_motion<Real>&, position, velocity, value u) noexcept {
        const value by = u - out_.last();
        const auto good = finite(by);
        if (next.period_ != period_ || none(good)) return out_.raise();
        auto kept = state_;
        if constexpr (fine)
            if (by != value()) kept.rest = value();
        for (value& each : kept.applied) set_where(good, each, each + by); // their differences stay
        const auto out = out_;
        *this = next;
        state_ = kept;
        out_ = out;
        out_.raise(!good);
    }

    /// Of the unlimited law; `to` of the reference as it is given, ahead by lead().
    law_response response(frequency f) const {
        const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * f.value() * period_.value()),
                                   under = detail::polynomial(r_, back);
        law_response y;
        std::complex<double> power = 1;
        for (std::size_t i = 0; i <= T; ++i, power *= back) {
            y.to_position += detail::plain(t_[i]) * power / under;
            y.from_position += detail::plain(t_[i]) / under;
        }
        power = back;
        for (std::size_t i = 1; i <= S; ++i, power *= back)
            y.from_position += detail::plain(s_[i]) * (power - 1.0) / under;
        return y;
    }
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    template <class Value, std::size_t N>
    static void push(const mask_of<Real>& where, std::array<Value, N>& past, Value x) noexcept {
        for (std::size_t i = N - 1; i > 0; --i) set_where(where, past[i], past[i - 1]);
        set_where(where, past[0], x);
    }

    fine_sum<value, fine> summed(value more) const noexcept {
        if constexpr (fine)
            return fine_sum<value>{state_.applied[0], state_.rest}.plus(more);
        else
            return fine_sum<value, false>{state_.applied[0]}.plus(more);
    }

    parameters given_;
    duration period_;
    Real leak_{};                                   ///< R(1); 0: integrates
    gain_of<Command, signal::position, Real> gain_; ///< T(1)
    std::array<Real, R + 1> r_{}, w_{};
    std::array<gain_of<Command, signal::position, Real>, S + 1> s_{};
    std::array<gain_of<Command, signal::position, Real>, T + 1> t_{};
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<rst<2, 2, 2>> && retunable_law<rst<2, 2, 5, 2>>);

/// Largest |pole| of the loop that the polynomials close around a plant: below 1 it is stable.
template <std::size_t A, std::size_t B, std::size_t R, std::size_t S, std::size_t T, signal_tag Command,
          class Number>
double loop_radius(const sampled_plant<A, B, Number>& plant,
                   const rst_polynomials<R, S, T, Command, Number>& law) {
    z_polynomial<S, Number> s;
    for (std::size_t i = 0; i <= S; ++i) s[i] = law.feedback[i].value();
    // Each by powers of z - 1 before they are multiplied: the poles of a slow loop lie close to one.
    const auto ar = detail::product(detail::about_one(plant.a), detail::about_one(law.r)),
               bs = detail::product(detail::about_one(plant.b), detail::about_one(s));
    z_polynomial<std::max(A + R, B + S), Number> c{};
    const auto add = [&c]<std::size_t N>(std::array<Number, N> p) {
        // (z - 1)^N and (z - 1)^M belong to different powers of z: z^(M - N) more on the shorter one.
        std::array<Number, std::tuple_size_v<decltype(c)>> all{};
        for (std::size_t i = 0; i < N; ++i) all[i] = p[i];
        for (std::size_t i = N; i < all.size(); ++i) detail::multiply(all, 1.0);
        for (std::size_t i = 0; i < all.size(); ++i) c[i] += all[i];
    };
    add(ar), add(bs);
    return detail::largest_root_about_one(c);
}

} // namespace quadrant::inline v0
