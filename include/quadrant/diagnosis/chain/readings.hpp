// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../model/harmonics.hpp"
#include "model.hpp"

namespace quadrant::inline v0::diagnosis::chain {

/// How many rows an equation system has at most; of a longer record every n-th row is taken.
inline constexpr std::size_t most_rows = 30000;

/// One link made ready: the part of its equations that does not depend on a model.
class readings {
public:
    explicit readings(position_link l)
        : link_(std::move(l)), noise_(link_.noise()), travel_(link_.travel()), middle_(link_.middle()) {
        const double band = link_.force_band_Hz;
        first_ = band > 0 ? zero_phase(link_.first, band, link_.period) : link_.first;
        last_ = band > 0 ? zero_phase(link_.last, band, link_.period) : link_.last;
        velocity_ = derivative(first_, link_.period);
        if (band > 0) noise_ = std::max(noise_ * std::sqrt(2 * band * link_.period), 0.1 * link_.count());
        for (double v : velocity_) speed_ = std::max(speed_, std::abs(v));
        choose_rows();
        if (band > 0) round_again();
        noise_ = noise_with(link_.compliance);
    }

    const position_link& of() const { return link_; }
    /// Noise and rounding of the difference, in the band to which it is smoothed [m].
    double noise() const { return noise_; }
    /// The same behind a transmission of this compliance [m/N]: the force that winds it up is found with the
    /// acceleration of the motor's reading, so that the rounding of that reading is in it twice.
    double noise_with(double compliance) const;
    double travel() const { return travel_; }
    double middle() const { return middle_; }
    double speed() const { return speed_; }
    std::span<const double> first() const { return first_; }
    const std::vector<std::size_t>& rows() const { return rows_; }
    /// Place on the travel, -1 to 1 from end to end.
    double along(double x) const { return 2 * (x - middle_) / travel_; }

    /// Where what lies behind the play stands beside what drives it. With a force its sign shows which side is
    /// in contact; without, friction holds the load where it is.
    std::vector<double> offset(const link_model& m, std::span<const double> driven, double width) const {
        if (link_.force.empty()) return play_of(driven, width).offset;
        std::vector<double> out(driven.size());
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = -width / 2 * (passed(m, k) > 0 ? 1 : -1);
        return out;
    }
    /// Force that goes through the spring [N].
    double passed(const link_model& m, std::size_t k) const {
        return link_.force[k] - m.motor_coulomb * link_.motor_direction[k];
    }

    equations of_model(const link_model& m) const;
    /// A function of the place, at every row, as smooth as the readings.
    template <class Value> std::vector<double> along_travel(const link_model& m, Value value) const {
        return as_smooth(m.follows(link_.first, link_.period), value);
    }
    /// The same of the place where the scale is read.
    template <class Value> std::vector<double> along_scale(Value value) const {
        return as_smooth(link_.last, value);
    }
    template <class Value> std::vector<double> as_smooth(std::vector<double> out, Value value) const {
        for (double& x : out) x = value(x);
        return link_.force_band_Hz > 0 ? zero_phase(out, link_.force_band_Hz, link_.period) : out;
    }

private:
    void choose_rows();
    void leave_bends_out(std::vector<unsigned char>& out);
    void round_again();
    std::vector<Eigen::VectorXd> columns_of(const link_model& m, term t, std::span<const double> driven) const;

    position_link link_;
    double noise_, travel_, middle_, speed_ = 0;
    std::vector<double> first_, last_, velocity_;
    std::vector<std::size_t> rows_;
    /// What rounding once more does to the difference and to the force, at each row that counts [m], [N].
    std::vector<double> rounded_, rounded_force_;
};

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "readings.ipp"
#endif
