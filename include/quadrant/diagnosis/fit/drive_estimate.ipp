// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/driven_motion.hpp"
#include "../text/bad_input.hpp"
#include "fit.hpp"
#include "predictor.hpp"
#include "scales.hpp"

#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Fits plants with their drive's loops closed on them to the path of one record.
class drive_fitter {
public:
    drive_fitter(const axis_description& axis, const axis_log& log, double period,
                 const std::set<std::string>& known)
        : axis_(axis), log_(log), period_(period), known_(known), rows_(log.position.size()),
          seconds_(period * static_cast<double>(rows_)), noise_(reading_noise(log.position, log.position_step)),
          path_(*log.drive), run_{.period = period,
                                  .corner_Hz = 1 / (20 * period),
                                  .position = log.position,
                                  .command = log.command,
                                  .resolution = log.position_step,
                                  .drive = &path_,
                                  .closed =
                                      (log.position[std::min<std::size_t>(2, rows_ - 1)] - log.position[0]) /
                                      (2 * period)} {
        path_.measured.clear(); // the gain is identified from it (gain_by_duty), not from the path
        velocity_ = derivative(zero_phase(log.position, 0.1 / period, period), period);
        acceleration_ = rms(derivative(velocity_, period));
        speed_ = rms(velocity_);
    }

    drive_estimate take() {
        drive_estimate out;
        candidate best = fitted(starts());
        const auto compare = [&](candidate c) {
            if (c.objective < best.objective) best = std::move(c);
        };
        if (tries_integral()) {
            candidate c = fitted(with_integral(best.plant));
            // One number more has to pay for itself as a number of the record's size does.
            c.objective += 0.5 * std::log(static_cast<double>(rows_));
            compare(std::move(c));
        }
        if (axis_.drive.takes_position() && !axis_.drive.between) compare(fitted(with_lines(best.plant)));
        look_at(best);
        std::vector<identified_number> all = conclude(best);
        // A force that few axes have and that is not identified is not written: the others are fitted once more
        // without it. Their intervals stay as wide as they were beside it.
        std::vector<identified_number> loose = without(best, all);
        if (!loose.empty()) {
            look_at(best);
            improve(best, 40);
            const std::vector<identified_number> beside = std::exchange(all, conclude(best));
            for (identified_number& n : all)
                for (const identified_number& wider : beside)
                    if (n.key == wider.key) {
                        n.low = std::min(n.low, n.value - (wider.value - wider.low));
                        n.high = std::max(n.high, n.value + (wider.high - wider.value));
                    }
            all.insert(all.end(), loose.begin(), loose.end());
        }
        out.numbers = std::move(all);
        out.between = best.plant.drive.between;
        out.path_noise = noise_;
        out.path_rms = std::sqrt(best.ms);
        return out;
    }

private:
    struct candidate {
        plant_model plant{};
        std::vector<parameter> parameters{};
        Eigen::VectorXd x{};
        std::vector<double> residual{};
        double ms = 1; ///< of the residual [m^2]
        double objective = std::numeric_limits<double>::infinity();
    };

    bool tapped() const { return axis_.drive.kind == drive_kind::position_servo && log_.drive->tapped(); }
    bool knows(const char* key) const { return known_.contains(key); }
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
    /// The loops that were found with held set-points, their set-points as lines: half a row later.
    std::vector<plant_model> with_lines(const plant_model& found) const {
        std::vector<plant_model> out;
        for (const double earlier : {0.0, 0.5, 1.0}) {
            plant_model p = found;
            p.drive.between = p.drive_as_described.between = interpolation::linear;
            if (!knows("drive.command_delay_s"))
                p.drive.delay = std::max(0.0, p.drive.delay - earlier * period_);
            out.push_back(p);
        }
        return out;
    }

    // ---- What is free, and where it begins.

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

    /// Everything of this drive that is not known, around a first guess.
    std::vector<parameter> parameters_at(plant_model& p) const {
        std::vector<parameter> out;
        const double force = p.mass * acceleration_ + p.gravity.torque;
        const auto kind = axis_.drive.kind;
        if (kind == drive_kind::position_servo) {
            if (!tapped())
                add_ratio(
                    out, "drive.position_gain_per_m",
                    [](plant_model& m) -> double& { return m.drive.duty_gain; }, p);
            add_ratio(
                out, "plant.mass_kg", [](plant_model& m) -> double& { return m.mass; }, p);
            add_ratio(
                out, "plant.force_constant_N_per_V", [](plant_model& m) -> double& { return m.force_constant; },
                p);
            add(out, free(
                         "plant.load_friction", [](plant_model& m) -> double& { return m.friction.load; },
                         p.friction.load, 0, 0.9, false, 0.3));
        } else {
            if (path_.in_volts)
                add_ratio(
                    out, "drive.velocity_per_V",
                    [](plant_model& m) -> double& { return m.drive.velocity_per_V; }, p);
            if (kind == drive_kind::position)
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
                         "plant.constant_force_N", [](plant_model& m) -> double& { return m.constant_force; },
                         0, -100 * force, 100 * force, false, 10 * force));
        }
        add(out, free(
                     "drive.command_delay_s", [](plant_model& m) -> double& { return m.drive.delay; },
                     p.drive.delay, 0, 0.05 * seconds_, false, 0));
        add(out,
            free(
                "plant.viscous_N_s_per_m", [](plant_model& m) -> double& { return m.friction.viscous_slope; },
                p.friction.viscous_slope, 0, 1000 * force / speed_, false,
                (kind == drive_kind::position_servo ? 10 : 1) * force / speed_));
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
    /// P of a servo whose duty was measured: regression of the duty on the error, with the set-point that
    /// leaves least, up to four rows old. Rows in which the bridge is at its end say nothing.
    identified_number gain_by_duty() const {
        const auto& duty = log_.drive->measured;
        identified_number best{.key = "drive.position_gain_per_m"};
        double least = std::numeric_limits<double>::infinity();
        for (int quarter = 0; quarter <= 16; ++quarter) {
            std::array<double, parts> up{}, down{};
            double left = 0;
            std::vector<std::pair<double, double>> used;
            for (std::size_t k = 4; k < rows_; ++k) {
                if (path_.is_off(k) || std::abs(duty[k]) > 0.95 * axis_.drive.maximum_duty.value_or(1))
                    continue;
                const auto back = static_cast<std::size_t>(quarter / 4);
                const double part = 0.25 * (quarter % 4);
                const double e = (1 - part) * path_.set_point[k - back] +
                                 part * path_.set_point[k - std::min<std::size_t>(back + 1, 4)] -
                                 log_.position[k];
                up[k * parts / rows_] += e * duty[k];
                down[k * parts / rows_] +=
                    e * e - noise_ * noise_; // noise in the error would make the gain smaller
                used.emplace_back(e, duty[k]);
            }
            const double all_up = std::accumulate(up.begin(), up.end(), 0.0),
                         all_down = std::accumulate(down.begin(), down.end(), 0.0), gain = all_up / all_down;
            for (const auto& [e, d] : used) left += (d - gain * e) * (d - gain * e);
            if (!(left < least)) continue;
            least = left;
            double scatter = 0; // of the score between the parts
            for (std::size_t b = 0; b < parts; ++b)
                scatter += (up[b] - gain * down[b]) * (up[b] - gain * down[b]);
            const double s = 2.1 * std::sqrt(scatter) / all_down;
            best.value = gain;
            best.low = gain - s;
            best.high = gain + s;
        }
        return best;
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

    // ---- The fit.

    /// What a path leaves, ready to be squared: rows that nobody read are left out, and the first part of the
    /// record, in which the loops forget how they began. A path behind a velocity command drifts with whatever
    /// is wrong: there a high-pass of a hundredth of the record takes the drift out.
    void make_ready(std::vector<double>& e) const {
        if (axis_.drive.kind == drive_kind::velocity)
            predictor::take_drift_out(e, 1 - 100 / static_cast<double>(rows_));
        const std::size_t first = rows_ / parts;
        for (std::size_t k = 0; k < rows_; ++k)
            if (k < first || (k < log_.left_out.size() && log_.left_out[k])) e[k] = 0;
    }
    std::vector<std::vector<double>> run(std::span<const plant_model> plants) const {
        std::vector<std::vector<double>> e(plants.size());
        for (std::size_t i = 0; i < plants.size(); i += predictor::in_a_group) {
            const std::size_t many = std::min(predictor::in_a_group, plants.size() - i);
            run_.run(plants.subspan(i, many), std::span(e).subspan(i, many));
        }
        for (auto& each : e) make_ready(each);
        return e;
    }
    void judge(candidate& c) const {
        c.ms = rms(c.residual) * rms(c.residual);
        c.objective = 0.5 * static_cast<double>(rows_) * std::log(c.ms + 0.01 * noise_ * noise_);
        for (Eigen::Index i = 0; i < c.x.size(); ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            if (q.spread > 0) c.objective += 0.5 * (c.x[i] / q.spread) * (c.x[i] / q.spread);
        }
        if (!std::isfinite(c.objective)) c.objective = std::numeric_limits<double>::infinity();
    }
    void look_at(candidate& c) const {
        fitter::put(c.plant, c.parameters, c.x);
        c.residual = run({&c.plant, 1})[0];
        judge(c);
    }
    /// Slopes of the residual; its own plant runs beside those that are moved, on the same clock.
    Eigen::MatrixXd slopes(const candidate& c) const {
        const auto n = static_cast<Eigen::Index>(c.residual.size());
        Eigen::MatrixXd out(n, c.x.size());
        constexpr auto moved = static_cast<Eigen::Index>(predictor::in_a_group) - 1;
        for (Eigen::Index i = 0; i < c.x.size(); i += moved) {
            std::vector<plant_model> plants{c.plant};
            std::vector<double> step;
            const Eigen::Index end = std::min(i + moved, c.x.size());
            for (Eigen::Index j = i; j < end; ++j) {
                const parameter& p = c.parameters[static_cast<std::size_t>(j)];
                Eigen::VectorXd x = c.x;
                step.push_back(x[j] + p.step > p.to_fit(p.high) ? -p.step : p.step);
                x[j] += step.back();
                plants.push_back(c.plant);
                fitter::put(plants.back(), c.parameters, x);
            }
            const auto e = run(plants);
            for (Eigen::Index j = i; j < end; ++j) {
                const auto at = static_cast<std::size_t>(j - i);
                for (Eigen::Index k = 0; k < n; ++k)
                    out(k, j) =
                        (e[at + 1][static_cast<std::size_t>(k)] - e[0][static_cast<std::size_t>(k)]) / step[at];
            }
        }
        return out;
    }
    double weight(const candidate& c) const { return 1 / (c.ms + 0.01 * noise_ * noise_); }
    static void add_prior(const candidate& c, Eigen::MatrixXd& a, Eigen::VectorXd& g) {
        for (Eigen::Index i = 0; i < c.x.size(); ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            if (!(q.spread > 0)) continue;
            a(i, i) += 1 / (q.spread * q.spread);
            g[i] += c.x[i] / (q.spread * q.spread);
        }
    }
    void improve(candidate& c, int iterations) const {
        const auto p = c.x.size();
        Eigen::VectorXd low(p), high(p);
        for (Eigen::Index i = 0; i < p; ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            low[i] = q.to_fit(q.low);
            high[i] = q.to_fit(q.high);
        }
        double damping = 1e-3;
        for (int i = 0; i < iterations && damping < 1e6; ++i) {
            const Eigen::MatrixXd j = slopes(c);
            const double w = weight(c);
            const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(
                c.residual.data(), static_cast<Eigen::Index>(c.residual.size()));
            Eigen::MatrixXd a = w * j.transpose() * j;
            Eigen::VectorXd g = w * j.transpose() * e;
            add_prior(c, a, g);
            a.diagonal() = a.diagonal().cwiseMax(1e-12);
            const double before = c.objective;
            while (damping < 1e6) {
                Eigen::MatrixXd damped = a;
                damped.diagonal() *= 1 + damping;
                candidate next = c;
                next.x += bounded_step(damped, g, low - c.x, high - c.x);
                look_at(next);
                if (next.objective < c.objective) {
                    c = std::move(next);
                    damping *= 0.1;
                    break;
                }
                damping *= 10;
            }
            if (before - c.objective < 1e-3) return; // nats
        }
    }
    candidate fitted(std::vector<plant_model> plants) const {
        std::vector<candidate> all;
        std::sort(plants.begin(), plants.end(), [&](const plant_model& a, const plant_model& b) {
            return steps_of_drive(a, period_) < steps_of_drive(b, period_);
        });
        auto e = run(plants);
        for (std::size_t i = 0; i < plants.size(); ++i) {
            candidate c;
            c.plant = plants[i];
            c.parameters = parameters_at(c.plant);
            c.x.resize(static_cast<Eigen::Index>(c.parameters.size()));
            for (std::size_t j = 0; j < c.parameters.size(); ++j)
                c.x[static_cast<Eigen::Index>(j)] = c.parameters[j].to_fit(c.parameters[j].start);
            c.residual = std::move(e[i]);
            judge(c);
            all.push_back(std::move(c));
        }
        std::sort(all.begin(), all.end(),
                  [](const candidate& a, const candidate& b) { return a.objective < b.objective; });
        constexpr std::size_t followed = 3;
        if (all.size() > followed) all.resize(followed);
        for (candidate& c : all) improve(c, 8);
        candidate best = *std::min_element(all.begin(), all.end(), [](const candidate& a, const candidate& b) {
            return a.objective < b.objective;
        });
        improve(best, 40);
        return best;
    }

    // ---- How well it is known.

    /// Takes a weight, with its direction, and a load friction that are not identified out of a model, and
    /// returns them: few axes have them. What every axis has stays free beside the gains that it trades with.
    static std::vector<identified_number> without(candidate& c, const std::vector<identified_number>& all) {
        std::vector<identified_number> out;
        const auto loose = [&](const std::string& key) {
            return std::any_of(all.begin(), all.end(),
                               [&](const identified_number& n) { return n.key == key && !n.identified(); });
        };
        std::vector<parameter> kept;
        std::vector<double> x;
        for (std::size_t i = 0; i < c.parameters.size(); ++i) {
            const parameter& p = c.parameters[i];
            const bool of_weight = p.key.starts_with("plant.gravity");
            if ((of_weight || p.key == "plant.load_friction") &&
                loose(of_weight ? "plant.gravity_torque_Nm" : p.key)) {
                p.of(c.plant) = 0;
                for (const identified_number& n : all)
                    if (n.key == p.key && !n.identified()) out.push_back(n);
            } else {
                kept.push_back(p);
                x.push_back(c.x[static_cast<Eigen::Index>(i)]);
            }
        }
        c.parameters = std::move(kept);
        c.x = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
        return out;
    }
    std::vector<identified_number> conclude(const candidate& c) const {
        std::vector<identified_number> out;
        if (tapped() && !knows("drive.position_gain_per_m")) out.push_back(gain_by_duty());
        const Eigen::MatrixXd j = slopes(c);
        const double w = weight(c);
        const auto p = c.x.size();
        Eigen::MatrixXd a = w * j.transpose() * j, scatter = Eigen::MatrixXd::Zero(p, p);
        for (std::size_t b = 0; b < parts; ++b) {
            Eigen::VectorXd g = Eigen::VectorXd::Zero(p);
            for (std::size_t k = b * rows_ / parts; k < (b + 1) * rows_ / parts; ++k)
                g += w * c.residual[k] * j.row(static_cast<Eigen::Index>(k)).transpose();
            scatter += g * g.transpose();
        }
        scatter *=
            static_cast<double>(parts) / std::max(1.0, static_cast<double>(parts) - static_cast<double>(p));
        Eigen::VectorXd unused = Eigen::VectorXd::Zero(p);
        add_prior(c, a, unused);
        for (Eigen::Index i = 0; i < p; ++i)
            if (const double s = c.parameters[static_cast<std::size_t>(i)].spread; s > 0)
                scatter(i, i) += 1 / (s * s);
        a.diagonal() = a.diagonal().cwiseMax(1e-12) * (1 + 1e-9);
        const Eigen::MatrixXd inverse = inverted(a), covariance = inverse * scatter * inverse;
        constexpr double two_sided = 2.1; // of Student's distribution, with some twenty parts more than numbers
        for (Eigen::Index i = 0; i < p; ++i) {
            const parameter& q = c.parameters[static_cast<std::size_t>(i)];
            const double s = std::hypot(two_sided * std::sqrt(std::max(covariance(i, i), inverse(i, i))),
                                        of_the_clock(c.plant, q));
            const auto bounded = [&](double x) { return std::clamp(q.from_fit(x), q.low, q.high); };
            out.push_back({q.key, q.from_fit(c.x[i]), bounded(c.x[i] - s), bounded(c.x[i] + s)});
        }
        return out;
    }

    /// What half a step of the simulation's clock is worth in a number: a drive has a clock of its own, which
    /// is not known and of that size, and a loop that sees the motion so much later has another damping.
    double of_the_clock(const plant_model& p, const parameter& q) const {
        const drive_model& d = p.drive;
        const double late = 0.5 * period_ / steps_of_drive(p, period_);
        const bool servo = d.kind == drive_kind::position_servo;
        const double stiffness = servo ? d.duty_gain * d.supply * p.force_constant
                                       : d.velocity_integral + d.velocity_gain * d.position_gain;
        if (q.key == "drive.command_delay_s") return late;
        if (q.key == "plant.viscous_N_s_per_m") return late * stiffness;
        const double rate = servo ? std::sqrt(stiffness / p.mass) : d.velocity_gain / p.mass;
        if (q.logarithmic && q.key != "drive.velocity_per_V") return 0.5 * late * rate;
        if (q.key == "plant.coulomb_N") return 0.5 * late * rate * p.friction.coulomb;
        return 0;
    }

    static constexpr std::size_t parts = 32; ///< of the record

    const axis_description& axis_;
    const axis_log& log_;
    double period_;
    const std::set<std::string>& known_;
    std::size_t rows_;
    double seconds_, noise_;
    driven_motion path_;
    predictor run_;
    std::vector<double> velocity_{};
    double acceleration_ = 0, speed_ = 0;
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL drive_estimate estimate_drive(const axis_description& axis, const axis_log& log,
                                                      double period, const std::set<std::string>& known) {
    return detail::drive_fitter(axis, log, period, known).take();
}

} // namespace quadrant::inline v0::diagnosis
