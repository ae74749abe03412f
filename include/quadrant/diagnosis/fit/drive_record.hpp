// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/log.hpp"
#include "../machine/machine.hpp"
#include "../model/driven_motion.hpp"
#include "identified_number.hpp"
#include "predictor.hpp"
#include "scales.hpp"

#include <numeric>
#include <set>
#include <span>
#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

/// A record of an axis whose drive closes its loops, and the paths that plants make of its set-points.
class drive_record {
public:
    drive_record(const axis_description& axis, const axis_log& log, double period,
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

protected:
    bool tapped() const { return axis_.drive.kind == drive_kind::position_servo && log_.drive->tapped(); }
    bool knows(const char* key) const { return known_.contains(key); }

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

} // namespace quadrant::inline v0::diagnosis::detail
