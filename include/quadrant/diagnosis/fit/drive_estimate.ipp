// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_fit.hpp"

#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The numbers of a drive and its axis, and how well they are known.
class drive_numbers : public drive_fit {
public:
    using drive_fit::drive_fit;

    drive_estimate take() {
        drive_estimate out;
        candidate best = fitted(starts());
        const auto compare = [&](candidate c) {
            if (c.objective < best.objective) best = std::move(c);
        };
        if (tries_integral()) compare(with_one_more(fitted(with_integral(best.plant))));
        if (axis_.drive.takes_position() && !axis_.drive.between) compare(fitted(with_lines(best.plant)));
        if (may_come_between_rows(axis_.drive, path_.set_point))
            compare(with_one_more(fitted(with_more_set_points(best.plant))));
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
        if (!axis_.drive.set_point_period_s && best.plant.drive.set_point_period > 0)
            out.set_point_period_s = best.plant.drive.set_point_period;
        out.path_noise = noise_;
        out.path_rms = std::sqrt(best.ms);
        return out;
    }

private:
    /// One number more has to pay for itself as a number of the record's size does.
    candidate with_one_more(candidate c) const {
        c.objective += 0.5 * std::log(static_cast<double>(rows_));
        return c;
    }
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
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL drive_estimate estimate_drive(const axis_description& axis, const axis_log& log,
                                                      double period, const std::set<std::string>& known) {
    return detail::drive_numbers(axis, log, period, known).take();
}

} // namespace quadrant::inline v0::diagnosis
