// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "driven_motion.hpp"
#include "plant_axis.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// How finely a row is simulated when a drive closes its loop inside the plant: its fastest loop turns by a
/// twentieth of a radian at most in a step, in two hundred steps at most.
inline int steps_of_drive(const plant_model& plant, double period) {
    const drive_model& d = plant.drive;
    const double mass = plant.moving_mass();
    const double stiffness = d.kind == drive_kind::position_servo
                                 ? d.duty_gain * d.supply * plant.force_constant
                                 : d.velocity_integral + d.velocity_gain * d.position_gain;
    double rate = std::max(d.velocity_gain / mass, std::sqrt(stiffness / mass));
    if (std::isfinite(d.velocity_filter_Hz)) rate = std::max(rate, 2 * std::numbers::pi * d.velocity_filter_Hz);
    return static_cast<int>(std::clamp(std::ceil(20 * period * rate), 8.0, 200.0));
}

/// The numbers of a drive's loops and what they give, one of each or a lane each.
template <class Real> struct loop_numbers {
    using number = parameter_real<Real>;

    drive_kind kind = drive_kind::current; ///< of all lanes
    typename position_servo<Real>::parameters servo{};
    typename position_loop<Real>::parameters loop{};
    number of_duty{1};     ///< actuator command a unit of what the loops give: supply [V], or 1/[N/V]
    number start_force{0}; ///< of the velocity loop [N]
    number off_from{0}, off_until{0}; ///< part of the record in which the drive gives nothing [s]
    bool reads_log =
        false; ///< of all lanes: the drive reads the encoder of the log, with what it reads wrongly
};

inline loop_numbers<double> loops_of(const drive_model& d, const driven_motion& motion) {
    return {.kind = d.kind,
            .servo = d.servo_numbers(),
            .loop = d.position_loop_numbers(),
            .of_duty = d.kind == drive_kind::position_servo ? d.supply : 1 / motion.constant,
            .start_force = d.start_force,
            .off_from = d.off_from,
            .off_until = d.off_until,
            .reads_log = motion.one_encoder};
}

/// An axis with its drive's loops closed on it, one of them or one in each lane: what a drive does on the
/// machine. Its clock is finer than the log's.
template <class Real, class Axis> class closed_axis {
public:
    using surroundings = typename Axis::surroundings;

    closed_axis(const typename Axis::parameters& p, const loop_numbers<Real>& n, Real step)
        : numbers_(n), half_step_(Real(0.5) * step), mechanics_(p, step, already_checked()),
          servo_(n.servo, half_step_, already_checked()), outer_(n.loop, step, already_checked()),
          inner_(n.loop.velocity, step, already_checked()) {}

    /// Before the first step of a record: where axis and set-points are, and how fast the axis moves.
    void begin(Real position, Real velocity, Real set_point) {
        state_ = Axis::state::at(mechanics_.position_of(position), velocity);
        velocity_before_ = velocity;
        read_wrongly_ = mechanics_.reading_error(state_);
        loop_ = velocity_loop<Real>::state::at(velocity, Real(numbers_.start_force));
        follower_ = position_servo<Real>::state::at(set_point);
    }
    Real reading() const { return mechanics_.reading(state_); }
    /// From now on the drive adds this to the force that its velocity loop gives, within its limit [N].
    void add(Real force) { added_ = force; }

    /// One step with this set-point, of this velocity [a second]; returns the actuator's command. `off`: the
    /// drive is switched off. `began`: in the record, the log whose time is `now` [s].
    Real operator()(Real set_point, Real its_velocity, bool off, const surroundings& now, double began = 0) {
        const auto loop = velocity_loop<Real>::state::at(state_.v); // as they wake
        const auto follower = position_servo<Real>::state::at(state_.x);
        Real u(0);
        if (off) {
            loop_ = loop;
            follower_ = follower;
        } else {
            u = Real(numbers_.of_duty) * with_added(given(set_point, its_velocity));
            const Real time = now.time + Real(began);
            const auto gives =
                either(less(time, Real(numbers_.off_from)), greater_equal(time, Real(numbers_.off_until)));
            u = select(gives, u, Real(0));
            loop_ = {select(gives, loop_.integral, loop.integral),
                     select(gives, loop_.filtered, loop.filtered)};
            follower_ = {select(gives, follower_.followed, follower.followed)};
        }
        velocity_before_ = state_.v;
        mechanics_.advance(state_, u, now);
        return u;
    }

private:
    /// Only an axis that is simulated alone is added to: no model of a search is.
    Real with_added(Real force) const {
        if constexpr (std::is_same_v<Real, double>) {
            const double most = numbers_.loop.velocity.limit;
            if (added_ != 0) force = std::clamp(force + added_, -most, most);
        }
        return force;
    }
    /// Duty of a servo, else force [N], from the motion in the middle of the step. A loop that saw the motion
    /// at the step's beginning would be half a step late, and the axis would lose damping by it.
    Real given(Real set_point, Real its_velocity) {
        const auto moves = either(less(state_.v, Real(0)), greater(state_.v, Real(0)));
        Real v = select(moves, state_.v + Real(0.5) * (state_.v - velocity_before_), state_.v);
        Real x = state_.x + half_step_ * state_.v;
        if (numbers_.reads_log && mechanics_.has_reading_error()) {
            const Real wrong = mechanics_.reading_error(state_), more = Real(0.5) * (wrong - read_wrongly_);
            x += wrong + more;
            v += more / half_step_;
            read_wrongly_ = wrong;
        }
        if (numbers_.kind == drive_kind::position_servo) {
            const Real duty = servo_(follower_, set_point, x);
            servo_.follow(follower_, set_point); // its profile is in the middle of the step, too
            return duty;
        }
        if (numbers_.kind == drive_kind::velocity) return inner_(loop_, set_point, v);
        return outer_(loop_, set_point, its_velocity, x, v);
    }

    loop_numbers<Real> numbers_;
    Real half_step_;
    Axis mechanics_;
    position_servo<Real> servo_;
    position_loop<Real> outer_;
    velocity_loop<Real> inner_;
    typename Axis::state state_{};
    Real velocity_before_{0}; ///< of the step
    Real read_wrongly_{0};    ///< as the step before began
    Real added_{0};
    typename velocity_loop<Real>::state loop_{};
    typename position_servo<Real>::state follower_{};
};

/// An axis whose drive closes its loops on the plant itself. The set-points are those of `motion`; its measured
/// motion is not used, but for where it starts. seen(row, reading, set-points): called as each row begins, may
/// give the set-point of that row. Returns the actuator's command, mean over each row.
template <class Seen>
std::vector<double> run_closed(const plant_model& plant, const driven_motion& motion, double period,
                               double velocity, std::span<const double> other_acceleration, Seen&& seen) {
    const std::size_t n = motion.set_point.size();
    const int steps = steps_of_drive(plant, period);
    const double h = period / steps, scale = motion.in_volts ? plant.drive.velocity_per_V : 1;
    closed_axis<double, plant_axis> axis(axis_parameters(plant), loops_of(plant.drive, motion), h);
    axis.begin(motion.position[0], velocity, motion.set_point[0]);
    auto anew = motion.begins.begin();
    const auto received = motion.set_points_of(plant.drive);
    std::vector<double> set_point(received.begin(), received.end()), command(n);
    set_point_clock clock(plant.drive, set_point, period, motion.begins);
    const double late = plant.drive.delay / period;
    std::size_t first = 0; // row of the log that runs
    for (std::size_t k = 0; k < n; ++k) {
        if (anew != motion.begins.end() && anew->row == k) {
            first = k;
            axis.begin(motion.position[k], anew->velocity, motion.set_point[k]);
            ++anew;
        }
        seen(k, axis.reading(), set_point);
        plant_axis::surroundings now{.time = static_cast<double>(k - first) * period,
                                     .other_acceleration =
                                         other_acceleration.empty() ? 0 : other_acceleration[k]};
        for (int i = 0; i < steps; ++i, now.time += h) {
            const double begin = static_cast<double>(k) + static_cast<double>(i) / steps;
            const auto r = clock.between(begin, begin + 1.0 / steps);
            if (!motion.added.empty())
                axis.add(motion.added[static_cast<std::size_t>(std::max(0.0, begin - late + 1e-9))]);
            command[k] += axis(scale * r.value, r.velocity / period, motion.is_off(k), now,
                               static_cast<double>(first) * period) /
                          steps;
        }
    }
    return command;
}

} // namespace quadrant::inline v0::diagnosis
