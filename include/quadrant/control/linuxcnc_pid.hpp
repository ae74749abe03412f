// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../block/retuned.hpp"
#include "axis_law.hpp"

#include <cmath>

namespace quadrant::inline v0 {

/// The stock component `pid` of LinuxCNC as a control law: a machine that runs under it is simulated and
/// replayed with the same command, bit for bit in double.
///   e = dead zone(limit(command - feedback)),  i += e T,  de = dr - dy
///   dr, ddr, dddr: differences of the command, each behind its own limit; dy: that of the feedback
///   u = limit((bias + Pgain e + Igain i + Dgain de) + (command FF0 + dr FF1 + ddr FF2 + dddr FF3))
/// The derivative part has neither limit nor dead zone of the error in it. The integral rests while the last
/// output was at its limit and the error points there. Each limit of 0 is none. T counts whole nanoseconds, as
/// in HAL.
/// Source: [LinuxCNC] man page pid(9); checked against the component (tests/linuxcnc/pid_table.sh).
/// Ports: those of `axis_law`, of which position reference and measured position are read (the pins command and
/// feedback). With error_previous_target the error is that against the command of the sample before.
/// State: the integral, last command and feedback, the derivatives of the command, which limit the output is
/// at. `reset`: as the component when it is loaded; `settle(x, u)`: at rest at x, held by u as far as the
/// integral can; `settle(start)`: in the middle of an even motion, the next sample after the one that start
/// describes.
/// `retune(next, ...)`: as the component when its pins are set: the integral of the error stays as it is, in m
/// s, and nothing takes up what the gains change. Jump: the sum of each gain's change times what it multiplies.
/// Range: gains finite, limits and dead zone finite and >= 0. The pins enable, index-enable, command-deriv,
/// feedback-deriv and the automatic tuning are not modelled.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "linuxcnc_pid.<field> = ...: must ..." for each field and the period.
/// Cost: 12 multiplications, 64 bytes of state. With an anti-windup that learns what was applied: `pid`.
template <class Real = double, signal_tag Command = signal::voltage> class linuxcnc_pid {
    using per_second = unit_quotient<si::acceleration, si::time>;

public:
    using output = Command;
    using value = quantity_of<Command, Real>;
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;
    using acceleration = quantity_of<signal::acceleration, Real>;
    using jerk = quantity<per_second, Real>;
    using integral = quantity<unit_product<si::length, si::time>, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// The pins, under their names with `_` for what cannot stand in a name; the values of a loaded component.
    struct parameters {
        gain_of<Command, signal::position, number> pgain = decltype(pgain)::from_value(number(1));
        gain_rate_of<Command, signal::position, number> igain{};
        gain_of<Command, signal::velocity, number> dgain{};
        gain_of<Command, signal::position, number> ff0{};
        gain_of<Command, signal::velocity, number> ff1{};
        gain_of<Command, signal::acceleration, number> ff2{};
        quantity<unit_quotient<typename Command::unit, per_second>, number> ff3{};
        quantity_of<Command, number> bias{};
        quantity_of<signal::position, number> deadband{};                  ///< >= 0
        quantity_of<signal::position, number> maxerror{};                  ///< >= 0; 0: no limit, as all below
        quantity<unit_product<si::length, si::time>, number> maxerror_i{}; ///< of the integral
        quantity_of<signal::velocity, number> maxerror_d{};                ///< of the derivative of the error
        quantity_of<signal::velocity, number> maxcmd_d{};                  ///< of the command's derivatives:
        quantity_of<signal::acceleration, number> maxcmd_dd{};             ///< second
        quantity<per_second, number> maxcmd_ddd{};                         ///< third
        quantity_of<Command, number> maxoutput{};
        bool error_previous_target = true;
    };
    /// What the component keeps from sample to sample.
    struct state {
        integral error_i{};
        position command{}, feedback{};
        velocity cmd_d{};
        acceleration cmd_dd{};
        int at_limit = 0; ///< of the output: 1, -1, or 0
    };
    /// The sample before the next one, of an even motion.
    struct start {
        linuxcnc_pid::position reference{}, measured{};
        velocity reference_velocity{}, measured_velocity{};
        value command{};
    };

    linuxcnc_pid(const parameters& p, duration period) : given_(checked(p, period)) {
        const double seconds = std::round(period.value() / 1e-9) * 0.000000001;
        period_ = seconds;
        per_period_ = 1.0 / seconds;
        pgain_ = in_real<Real>(p.pgain), igain_ = in_real<Real>(p.igain), dgain_ = in_real<Real>(p.dgain);
        ff0_ = in_real<Real>(p.ff0), ff1_ = in_real<Real>(p.ff1), ff2_ = in_real<Real>(p.ff2);
        ff3_ = in_real<Real>(p.ff3), bias_ = in_real<Real>(p.bias);
        deadband_ = in_real<Real>(p.deadband), maxerror_ = in_real<Real>(p.maxerror);
        maxerror_i_ = in_real<Real>(p.maxerror_i), maxerror_d_ = in_real<Real>(p.maxerror_d);
        maxcmd_d_ = in_real<Real>(p.maxcmd_d), maxcmd_dd_ = in_real<Real>(p.maxcmd_dd);
        maxcmd_ddd_ = in_real<Real>(p.maxcmd_ddd), maxoutput_ = in_real<Real>(p.maxoutput);
    }

    value operator()(const axis_motion<Real>& reference, position feedback, velocity) noexcept {
        return (*this)(reference.position, feedback);
    }
    value operator()(position command, position feedback) noexcept {
        const state& was = state_;
        const position e = seen((given_.error_previous_target ? was.command : command) - feedback);
        state next{was.error_i, command, feedback, {}, {}, 0};
        if (!(e.value() * Real(was.at_limit) > Real(0)))
            next.error_i += integral::from_value(e.value() * Real(period_));
        next.error_i = limited_to(next.error_i, maxerror_i_);
        const velocity dr = rate<velocity>(command - was.command), dy = rate<velocity>(feedback - was.feedback);
        const velocity error_d = limited_to(velocity(dr - dy), maxerror_d_);
        next.cmd_d = limited_to(dr, maxcmd_d_);
        next.cmd_dd = limited_to(rate<acceleration>(next.cmd_d - was.cmd_d), maxcmd_dd_);
        const jerk cmd_ddd = limited_to(rate<jerk>(next.cmd_dd - was.cmd_dd), maxcmd_ddd_);
        value u = bias_ + pgain_ * e + igain_ * next.error_i + dgain_ * error_d;
        u += command * ff0_ + next.cmd_d * ff1_ + next.cmd_dd * ff2_ + cmd_ddd * ff3_;
        const value asked = u;
        u = limited_to(u, maxoutput_);
        next.at_limit = maxoutput_ == value() ? 0 : asked > maxoutput_ ? 1 : asked < -maxoutput_ ? -1 : 0;
        if (!finite(command, feedback, asked, next.error_i)) return out_.hold();
        state_ = next;
        return out_.keep(u);
    }
    void reset() noexcept {
        state_ = {};
        out_.reset();
    }
    void settle(position x, value u) noexcept { settle(start{x, x, {}, {}, u}); }
    void settle(const start& s) noexcept {
        if (!finite(s.reference, s.measured, s.reference_velocity, s.measured_velocity, s.command))
            return out_.raise();
        const position command_before =
            s.reference - position::from_value(s.reference_velocity.value() * Real(period_));
        const position e = seen((given_.error_previous_target ? command_before : s.reference) - s.measured);
        const velocity d = limited_to(velocity(s.reference_velocity - s.measured_velocity), maxerror_d_),
                       cmd_d = limited_to(s.reference_velocity, maxcmd_d_);
        const value rest = s.command - bias_ - pgain_ * e - dgain_ * d - s.reference * ff0_ - cmd_d * ff1_;
        integral i{};
        if (igain_.value() != Real(0)) i = limited_to(integral(rest / igain_), maxerror_i_);
        state_ = {i, s.reference, s.measured, cmd_d, {}, 0};
        out_.reset(s.command);
    }

    void retune(const linuxcnc_pid& next, const axis_motion<Real>&, position, velocity, value) noexcept {
        detail::retuned(*this, next, next.period_ == period_, out_, state_);
    }

    bool limited() const noexcept { return state_.at_limit != 0; } ///< the last output was at its limit
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    /// The limit of a pin, where 0 is none.
    template <class Q> static Q limited_to(Q x, Q most) noexcept {
        if (most == Q()) return x;
        return x > most ? most : x < -most ? -most : x;
    }
    template <class Rate, class Q> Rate rate(Q change) const noexcept {
        return Rate::from_value(change.value() * Real(per_period_));
    }
    position seen(position error) const noexcept {
        const position e = limited_to(error, maxerror_);
        return e > deadband_ ? position(e - deadband_) : e < -deadband_ ? position(e + deadband_) : position();
    }
    static const parameters& checked(const parameters& p, duration period) {
        require_positive<Real>("linuxcnc_pid.period", period);
        require_finite<Real>("linuxcnc_pid.pgain", p.pgain);
        require_finite<Real>("linuxcnc_pid.igain", p.igain);
        require_finite<Real>("linuxcnc_pid.dgain", p.dgain);
        require_finite<Real>("linuxcnc_pid.ff0", p.ff0);
        require_finite<Real>("linuxcnc_pid.ff1", p.ff1);
        require_finite<Real>("linuxcnc_pid.ff2", p.ff2);
        require_finite<Real>("linuxcnc_pid.ff3", p.ff3);
        require_finite<Real>("linuxcnc_pid.bias", p.bias);
        require_not_negative<Real>("linuxcnc_pid.deadband", p.deadband);
        require_not_negative<Real>("linuxcnc_pid.maxerror", p.maxerror);
        require_not_negative<Real>("linuxcnc_pid.maxerror_i", p.maxerror_i);
        require_not_negative<Real>("linuxcnc_pid.maxerror_d", p.maxerror_d);
        require_not_negative<Real>("linuxcnc_pid.maxcmd_d", p.maxcmd_d);
        require_not_negative<Real>("linuxcnc_pid.maxcmd_dd", p.maxcmd_dd);
        require_not_negative<Real>("linuxcnc_pid.maxcmd_ddd", p.maxcmd_ddd);
        require_not_negative<Real>("linuxcnc_pid.maxoutput", p.maxoutput);
        return p;
    }

    parameters given_;
    double period_ = 0, per_period_ = 0;
    gain_of<Command, signal::position, Real> pgain_, ff0_;
    gain_rate_of<Command, signal::position, Real> igain_;
    gain_of<Command, signal::velocity, Real> dgain_, ff1_;
    gain_of<Command, signal::acceleration, Real> ff2_;
    quantity<unit_quotient<typename Command::unit, per_second>, Real> ff3_;
    value bias_, maxoutput_;
    position deadband_, maxerror_;
    integral maxerror_i_;
    velocity maxerror_d_, maxcmd_d_;
    acceleration maxcmd_dd_;
    jerk maxcmd_ddd_;
    state state_;
    held_output<value> out_;
};
static_assert(retunable_law<linuxcnc_pid<>>);

} // namespace quadrant::inline v0
