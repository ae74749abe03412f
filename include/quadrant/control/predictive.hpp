// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "axis_law.hpp"
#include "predictive_design.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

namespace quadrant::inline v0 {

/// A control law of a feed drive that knows what the trajectory will ask for: each sample it takes the first
/// move of the best plan over the coming `horizon` periods, in changes of the command, so that it integrates.
///   du = sum over i = 1 ... horizon of kp_i (r_{k+i} - x) + kv_i (dr_{k+i} - v), less k_x (x - x_{k-1}) + k_v (v - v_{k-1})
///   u = u_applied + du;   the least J of predictive_design.hpp, with every du of the horizon free
/// A constant force is in no difference: no error stays, with any force constant and mass that leave the loop
/// stable.
/// Source: the law of [LowKeck2003] (eqs. 1-8: increments of position and speed, integral of the error, preview
/// of position and speed), designed as the incremental predictive control of [Wang2009].
/// Limits: du is clipped to rate_limit, then u to limit; the next sample starts from what was applied, so
/// nothing winds up. The clipped move is not the best one under limits (that takes a quadratic program a
/// sample).
/// Ports: those of `axis_law`; lead() is the horizon.
/// State: the coming references, position and speed of the sample before, the command applied. `reset`: at rest
/// at zero; `settle(x, u)`: at rest at x, held by u, and so stays the reference.
/// `retune(next, ..., u)`: as `retunable_law` says, for the same horizon; it starts from u. |u'[k] - u| is
/// the first move of the new plan, at most its rate_limit times T. Another horizon is refused as another
/// period is: the references in store belong to it.
/// Range: gain of the plant > 0 (else the command does not control the axis), damping >= 0, 1 <= horizon <=
/// Preview, weights as they say. The speed measured should lag little: `kalman` with its disturbance.
/// NaN and infinities: holds the last command, takes nothing in, raises faulted().
/// Throws "predictive.<field> = ...: must ..." for each, and for horizon and weights whose loop is not stable.
/// Cost: 2 horizon + 2 multiplications; 16 (Preview + 3) bytes of state. Nothing to preview: `pid`,
/// `sliding_mode`.
template <std::size_t Preview = 10, class Real = double, signal_tag Command = signal::voltage>
requires(Preview > 0) class predictive {
public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using number = parameter_real<Real>; ///< of parameters
    static constexpr std::size_t most_lead = Preview;

    /// The axis as believed, what an error and a move cost, how far ahead is planned, and the limits.
    struct parameters {
        axis_model<Command, number> plant;  ///< as the law believes it
        predictive_weights<number> weights; ///< bryson_weights(...)
        std::size_t horizon = Preview;      ///< periods; 1 ... Preview
        quantity_of<Command, number> limit =
            quantity_of<Command, number>::from_value(number(std::numeric_limits<double>::infinity())); ///< > 0
        quantity<unit_quotient<typename Command::unit, si::time>, number> rate_limit =
            decltype(rate_limit)::from_value(number(std::numeric_limits<double>::infinity())); ///< > 0
    };
    /// References that are still to come, the last measurement, and the command that acts.
    struct state {
        std::array<position, Preview> r{};  ///< a ring over the first `horizon`
        std::array<velocity, Preview> dr{}; ///< likewise
        std::size_t next = 0;               ///< where the coming reference goes
        position x{};                       ///< of the last sample
        velocity v{};
        value applied{}; ///< from the last sample on
    };

    predictive(const parameters& p, duration period)
        : given_(checked(p, period)), period_(period), limit_(in_real<Real>(p.limit)),
          change_(value::from_value(Real(p.rate_limit.value() * number(period.value())))) {
        const auto g = design_predictive<Preview>(p.plant, p.weights, p.horizon, period);
        radius_ = g.radius;
        require(radius_ < 1, "predictive.horizon", double(p.horizon),
                "must be longer, or the change of the command weigh less: the loop is not stable");
        for (std::size_t i = 0; i < p.horizon; ++i) {
            to_position_[i] = kp::from_value(Real(g.to_position[i]));
            to_velocity_[i] = kv::from_value(Real(g.to_velocity[i]));
        }
        on_position_change_ = kp::from_value(Real(g.on_position_change));
        on_velocity_change_ = kv::from_value(Real(g.on_velocity_change));
    }

    value operator()(const axis_motion<Real>& reference, position measured, velocity tachometer) noexcept {
        if (!finite(reference.position, reference.velocity, measured, tachometer)) return out_.hold();
        // The oldest is read no more; the next step takes the same place after a fault.
        state_.r[state_.next] = reference.position, state_.dr[state_.next] = reference.velocity;
        value du = -on_position_change_ * (measured - state_.x) - on_velocity_change_ * (tachometer - state_.v);
        std::size_t i = 0;
        const auto add = [&](std::size_t from, std::size_t to) noexcept {
            for (std::size_t j = from; j < to; ++j, ++i)
                du +=
                    to_position_[i] * (state_.r[j] - measured) + to_velocity_[i] * (state_.dr[j] - tachometer);
        };
        add(state_.next + 1, given_.horizon);
        add(0, state_.next + 1);
        const value slowed = clipped(du, change_), u = clipped(state_.applied + slowed, limit_);
        if (!finite(du, u)) return out_.hold();
        limited_ = slowed != du || u != state_.applied + slowed;
        state_.next = state_.next + 1 < given_.horizon ? state_.next + 1 : 0;
        state_.x = measured, state_.v = tachometer, state_.applied = u;
        return out_.keep(u);
    }
    /// What was applied of the last command.
    void applied(value u) noexcept {
        if (!finite(u)) return out_.raise();
        state_.applied = u;
    }
    void reset() noexcept { settle(position(), value()); }
    void settle(position x, value u) noexcept {
        if (!finite(x, u)) return out_.raise();
        state_ = {};
        state_.r.fill(x);
        state_.x = x;
        state_.applied = u;
        limited_ = false;
        out_.reset(u);
    }

    void retune(const predictive& next, const axis_motion<Real>&, position, velocity, value u) noexcept {
        auto kept = state_;
        kept.applied += u - out_.last();
        if (next.period_ != period_ || next.given_.horizon != given_.horizon || !finite(kept.applied))
            return out_.raise();
        const auto out = out_;
        const bool limited = limited_;
        *this = next;
        state_ = kept;
        out_ = out;
        limited_ = limited;
    }

    std::size_t lead() const noexcept { return given_.horizon; }
    /// Of the unlimited law.
    law_response response(frequency f) const {
        using complex = std::complex<double>;
        const double angle = 2 * std::numbers::pi * f.value() * period_.value();
        const complex change = 1.0 - std::polar(1.0, -angle);
        law_response y{};
        double position_sum = 0, velocity_sum = 0;
        for (std::size_t i = 0; i < given_.horizon; ++i) {
            const double p = detail::plain(to_position_[i]), v = detail::plain(to_velocity_[i]);
            const complex late = std::polar(1.0, -angle * double(given_.horizon - 1 - i)) / change;
            y.to_position += p * late, y.to_velocity += v * late;
            position_sum += p, velocity_sum += v;
        }
        y.from_position = position_sum / change + detail::plain(on_position_change_);
        y.from_velocity = velocity_sum / change + detail::plain(on_velocity_change_);
        return y;
    }
    /// Of the loop around the model; errors shrink at least so much a period.
    double radius() const noexcept { return radius_; }
    bool limited() const noexcept { return limited_; } ///< the last command was clipped here
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    using kp = gain_of<Command, signal::position, Real>;
    using kv = gain_of<Command, signal::velocity, Real>;

    static const parameters& checked(const parameters& p, duration period) {
        using detail::plain;
        require_positive<Real>("predictive.period", period);
        require(detail::is_finite(plain(p.plant.gain)) && plain(p.plant.gain) > 0, "predictive.plant.gain",
                p.plant.gain, "must be finite and above 0: the command has to control the axis");
        require_not_negative<Real>("predictive.plant.viscous_rate", p.plant.viscous_rate);
        require(p.horizon >= 1 && p.horizon <= Preview, "predictive.horizon", double(p.horizon),
                "must lie between 1 and the preview (" + detail::shortest(double(Preview)) + " periods)");
        const auto& w = p.weights.error;
        const double xx = plain(w[0][0]), xv = plain(w[0][1]), vx = plain(w[1][0]), vv = plain(w[1][1]);
        require_positive<Real>("predictive.weights.error[0][0]",
                               xx); // else nothing brings the axis to its place
        require(detail::is_finite(vv) && vv >= 0 && xv == vx && xv * xv <= xx * vv * (1 + 1e-12),
                "predictive.weights.error (determinant)", xx * vv - xv * vx,
                "must be symmetric and positive semidefinite");
        require_positive<Real>("predictive.weights.increment", p.weights.increment);
        require(plain(p.limit) > 0, "predictive.limit", p.limit, "must be above 0");
        require(plain(p.rate_limit) > 0, "predictive.rate_limit", p.rate_limit, "must be above 0");
        return p;
    }
    static value clipped(value x, value most) noexcept { return x > most ? most : x < -most ? -most : x; }

    parameters given_;
    duration period_;
    value limit_, change_; ///< of the command, and of it in a period
    std::array<kp, Preview> to_position_{};
    std::array<kv, Preview> to_velocity_{};
    kp on_position_change_{};
    kv on_velocity_change_{};
    double radius_ = 0;
    bool limited_ = false;
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<predictive<>>);

} // namespace quadrant::inline v0
