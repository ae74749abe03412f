// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"
#include "drive_record.hpp"
#include "fit.hpp"

#include <array>
#include <fmt/format.h>

namespace quadrant::inline v0::diagnosis::detail {

/// What of a drive and its axis is free, and where it begins.
class drive_starts : public drive_record {
public:
    using drive_record::drive_record;

protected:
    /// With and without an integral, where nobody says so.
    bool tries_integral() const {
        return axis_.drive.kind != drive_kind::position_servo && !knows("drive.velocity_integral_N_per_m");
    }
    /// Around a P loop that was found.
    std::vector<plant_model> with_integral(const plant_model& found) const {
        std::vector<plant_model> out;
        for (const double slower : {0.4, 0.7, 1.0, 1.5})
            for (const double share : {0.05, 0.2, 0.5}) {
                plant_model p = found;
                if (!knows("drive.velocity_gain_N_s_per_m")) p.drive.velocity_gain *= slower;
                p.drive.velocity_integral = share * p.drive.velocity_gain * p.drive.velocity_gain / p.mass;
                out.push_back(p);
            }
        return out;
    }
    /// Held set-points as lines: up to a row later.
    std::vector<plant_model> with_lines(const plant_model& found) const {
        return with_set_points(found, {0, -0.5, -1}, interpolation::linear, found.drive.set_point_period);
    }
    /// Set-points between the rows, too: a held one is half a row late there.
    std::vector<plant_model> with_more_set_points(const plant_model& found) const {
        return with_set_points(found, {0, 0.5, 1}, found.drive.between, period_ / set_points_in_a_row);
    }
    /// The loops that were found, with other set-points, which are used so many rows later.
    std::vector<plant_model> with_set_points(const plant_model& found, std::array<double, 3> later,
                                             interpolation between, double every) const {
        std::vector<plant_model> out(later.size(), found);
        for (std::size_t i = 0; i < out.size(); ++i) {
            for (drive_model* d : {&out[i].drive, &out[i].drive_as_described})
                d->between = between, d->set_point_period = every;
            double& delay = out[i].drive.delay;
            if (!knows("drive.command_delay_s")) delay = std::max(0.0, delay + later[i] * period_);
        }
        return out;
    }

    /// `of`: the number of the plant; `spread`: of a prior around 0, 0: none.
    static parameter free(const char* key, double& (*of)(plant_model&), double start, double low, double high,
                          bool logarithmic, double spread = 0) {
        parameter p{.key = key, .of = of, .start = start, .low = low, .high = high, .logarithmic = logarithmic};
        p.expected = 0;
        p.spread = spread;
        p.step = logarithmic ? 1e-4 : 1e-4 * std::max(std::abs(start), high == low ? 1 : 0.01 * (high - low));
        return p;
    }
    void add(std::vector<parameter>& to, parameter p) const {
        if (!knows(p.key.c_str())) to.push_back(std::move(p));
    }
    void add_ratio(std::vector<parameter>& to, const char* key, double& (*of)(plant_model&),
                   plant_model& at) const {
        const double start = of(at);
        add(to, free(key, of, start, 1e-3 * start, 1e3 * start, true));
    }
    void add_servo(std::vector<parameter>& out, plant_model& p) const {
        if (!tapped())
            add_ratio(
                out, "drive.position_gain_per_m", [](plant_model& m) -> double& { return m.drive.duty_gain; },
                p);
        add_ratio(
            out, "plant.mass_kg", [](plant_model& m) -> double& { return m.mass; }, p);
        add_ratio(
            out, "plant.force_constant_N_per_V", [](plant_model& m) -> double& { return m.force_constant; }, p);
        add(out, free(
                     "plant.load_friction", [](plant_model& m) -> double& { return m.friction.load; },
                     p.friction.load, 0, 0.9, false, 0.3));
    }
    void add_loops(std::vector<parameter>& out, plant_model& p, double force) const {
        if (path_.in_volts)
            add_ratio(
                out, "drive.velocity_per_V", [](plant_model& m) -> double& { return m.drive.velocity_per_V; },
                p);
        if (axis_.drive.kind == drive_kind::position)
            add_ratio(
                out, "drive.position_gain_per_s",
                [](plant_model& m) -> double& { return m.drive.position_gain; }, p);
        add_ratio(
            out, "drive.velocity_gain_N_s_per_m",
            [](plant_model& m) -> double& { return m.drive.velocity_gain; }, p);
        if (p.drive.velocity_integral > 0)
            add_ratio(
                out, "drive.velocity_integral_N_per_m",
                [](plant_model& m) -> double& { return m.drive.velocity_integral; }, p);
        add(out, free(
                     "plant.constant_force_N", [](plant_model& m) -> double& { return m.constant_force; }, 0,
                     -100 * force, 100 * force, false, 10 * force));
    }
    /// Everything of this drive that is not known, around a first guess.
    std::vector<parameter> parameters_at(plant_model& p) const {
        std::vector<parameter> out;
        const double force = p.mass * acceleration_ + p.gravity.torque;
        const bool servo = axis_.drive.kind == drive_kind::position_servo;
        if (servo)
            add_servo(out, p);
        else
            add_loops(out, p, force);
        add(out, free(
                     "drive.command_delay_s", [](plant_model& m) -> double& { return m.drive.delay; },
                     p.drive.delay, 0, 0.05 * seconds_, false, 0));
        add(out,
            free(
                "plant.viscous_N_s_per_m", [](plant_model& m) -> double& { return m.friction.viscous_slope; },
                p.friction.viscous_slope, 0, 1000 * force / speed_, false, (servo ? 10 : 1) * force / speed_));
        add(out, free(
                     "plant.coulomb_N", [](plant_model& m) -> double& { return m.friction.coulomb; },
                     p.friction.coulomb, 0, 100 * force, false, 10 * force));
        if (turns_weight()) {
            add(out, free(
                         "plant.gravity_torque_Nm", [](plant_model& m) -> double& { return m.gravity.torque; },
                         p.gravity.torque, 0, 100 * force, false, 10 * force));
            add(out, free(
                         "plant.gravity_phase_rad", [](plant_model& m) -> double& { return m.gravity.phase; },
                         p.gravity.phase, -4, 4, false, 2));
        }
        for (parameter& each : out) {
            // A step of a delay is a part of a row: the path goes on in steps of the drive's clock.
            if (each.key == "drive.command_delay_s") each.step = 0.05 * period_;
        }
        return out;
    }
    /// A weight that an arm turns: of servos, which carry one as a rule, and where a file says so.
    bool turns_weight() const {
        return axis_.kind == axis_kind::rotary &&
               (axis_.drive.kind == drive_kind::position_servo || axis_.plant.gravity_torque_Nm);
    }

    /// Speeds of a loop that a record can show [rad/s].
    std::vector<double> rates(std::size_t most) const {
        const double slowest = 2 * std::numbers::pi * 5 / seconds_, fastest = 1.5 / period_;
        std::vector<double> out;
        for (std::size_t i = 0; i < most; ++i)
            out.push_back(slowest *
                          std::pow(fastest / slowest, static_cast<double>(i) / static_cast<double>(most - 1)));
        return out;
    }
    double lag_gain() const { // of the position loop, from velocity over error
        const auto& r = path_.set_point;
        double up = 0, down = 0;
        const auto smooth_r = zero_phase(r, 0.1 / period_, period_),
                   smooth_q = zero_phase(log_.position, 0.1 / period_, period_);
        for (std::size_t k = 0; k < rows_; ++k) {
            up += velocity_[k] * velocity_[k];
            down += velocity_[k] * (smooth_r[k] - smooth_q[k]);
        }
        return down > 0 ? std::min(up / down, 0.5 / period_) : 0.5 / period_;
    }
    double velocity_of_volt() const {
        const auto& u = path_.set_point;
        double up = 0, down = 0;
        for (std::size_t k = 0; k < rows_; ++k) {
            up += velocity_[k] * u[k];
            down += u[k] * u[k];
        }
        return up / down;
    }

    std::vector<plant_model> starts() const {
        const double travel = *std::max_element(log_.position.begin(), log_.position.end()) -
                              *std::min_element(log_.position.begin(), log_.position.end());
        // Less than scales_of() has it: a path shows on average what no single reading does.
        plant_model base(axis_,
                         std::max(0.05 * observed_count(log_.position, log_.position_step), 1e-6 * travel));
        std::vector<double> delays{base.drive.delay};
        if (!knows("drive.command_delay_s")) delays = {0, period_, 3 * period_};
        std::vector<plant_model> out;
        if (axis_.drive.kind == drive_kind::position_servo) {
            servo_starts(base, delays, out);
            return out;
        }
        if (path_.in_volts && !knows("drive.velocity_per_V")) {
            const double of_volt = velocity_of_volt();
            if (!(of_volt > 0))
                throw bad_input("init", fmt::format("axis {}: the velocity runs against the command: check the "
                                                    "sign of one column",
                                                    log_.name));
            base.drive.velocity_per_V = of_volt;
        }
        std::vector<double> outer{base.drive.position_gain};
        if (axis_.drive.kind == drive_kind::position && !knows("drive.position_gain_per_s")) {
            const double least = lag_gain();
            outer = {least, 1.4 * least, 2 * least};
        }
        for (const double rate : rates(12))
            for (const double of_outer : outer)
                for (const double delay : delays) {
                    plant_model p = base;
                    p.drive.delay = delay;
                    p.drive.position_gain = of_outer;
                    if (!knows("drive.velocity_gain_N_s_per_m")) p.drive.velocity_gain = rate * p.mass;
                    out.push_back(p);
                    if (knows("drive.velocity_gain_N_s_per_m") && rate > rates(12)[0]) out.pop_back();
                }
        return out;
    }
    void servo_starts(const plant_model& base, const std::vector<double>& delays,
                      std::vector<plant_model>& out) const {
        const bool free_mass = !knows("plant.mass_kg"), free_constant = !knows("plant.force_constant_N_per_V");
        double gain = base.drive.duty_gain;
        if (tapped() && !knows("drive.position_gain_per_m")) {
            gain = gain_by_duty().value;
            if (!(gain > 0))
                throw bad_input("init", fmt::format("axis {}: the duty runs against the error: check the sign "
                                                    "of one column",
                                                    log_.name));
        }
        const double volts = base.drive.supply;
        std::vector<double> strengths{1};
        if (free_mass && free_constant) strengths = {0.3, 1, 3, 10}; // of the servo beside the weight
        for (const double rate : rates(12))
            for (const double damping : {0.3, 1.0, 4.0})
                for (const double strength : strengths)
                    for (const double delay : delays) {
                        plant_model p = base;
                        p.drive.delay = delay;
                        p.drive.duty_gain = gain;
                        if (free_mass && free_constant)
                            p.force_constant = strength * base.gravity.torque / (gain * volts);
                        if (free_mass)
                            p.mass = gain * volts * p.force_constant / (rate * rate);
                        else if (free_constant)
                            p.force_constant = rate * rate * p.mass / (gain * volts);
                        else if (!knows("drive.position_gain_per_m") && !tapped())
                            p.drive.duty_gain = rate * rate * p.mass / (p.force_constant * volts);
                        if (!knows("plant.viscous_N_s_per_m"))
                            p.friction.viscous_slope = 2 * damping * rate * p.mass;
                        out.push_back(p);
                    }
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
