// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drawn_machine.hpp"
#include "strangers.hpp"

/// How large a gap is, in what the machine's tolerances, noise and rounding alone can do.
namespace quadrant_gap::trial {

namespace detail {

/// Of the force that the controller, or a drive with loops of its own, asks for, below some 60 Hz. Where the
/// current of such a drive is measured: what the file takes it for.
inline std::vector<double> asked_force(const axis_record& r, double force_constant, double period) {
    const auto half = static_cast<std::size_t>(std::max(0.0, std::round(0.004 / period)));
    const bool closes = !r.force.empty(), measured = !r.current.empty(); // the drive asks for it
    std::vector<double> sum(r.command.size() + 1, 0.0), out(r.command.size());
    for (std::size_t k = 0; k < r.command.size(); ++k)
        sum[k + 1] = sum[k] + (measured ? force_constant * r.current[k]
                               : closes ? r.force[k]
                                        : force_constant * r.command[k]);
    for (std::size_t k = 0; k < out.size(); ++k) {
        const std::size_t a = k > half ? k - half : 0, b = std::min(out.size(), k + half + 1);
        out[k] = (sum[b] - sum[a]) / static_cast<double>(b - a);
    }
    return out;
}

inline double rms_of_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

} // namespace detail

/// The gap in asked force of a drawn machine, against the machine as described, on the log's motion.
class gap_meter {
public:
    explicit gap_meter(const drawn_machine& m) : m_(m) {
        std::vector<axis_truth> plain;
        for (const axis_truth& a : m.described) plain.push_back(ideal(a));
        baseline_ = trial::run(plain, m.log_reference, m.period, m.noise_seed);
        asked_ = asked(baseline_);
    }
    /// Infinite for a machine that runs away.
    double operator()(const std::vector<axis_truth>& axes) const {
        const auto other = trial::run(axes, m_.log_reference, m_.period, m_.noise_seed);
        for (const axis_record& r : other)
            if (std::isnan(r.position.back())) return HUGE_VAL;
        double away = 0;
        for (std::size_t k = 0; k < other[0].position.size(); ++k)
            away = std::max(away, std::abs(other[0].position[k] - baseline_[0].position[k]));
        const double gap = detail::rms_of_difference(asked(other), asked_);
        const drive_truth& d = m_.described[0].drive;
        // A servo that is too weak stays behind.
        const double farthest = d.supply > 0 ? 1 : m_.described[0].turns ? 0.3 : 0.02;
        return away > farthest ? HUGE_VAL : gap;
    }
    const axis_record& baseline() const { return baseline_[0]; }
    bool runs() const { return !std::isnan(baseline_[0].position.back()); }

private:
    std::vector<double> asked(const std::vector<axis_record>& r) const {
        return detail::asked_force(r[0], m_.described[0].actuator.force_constant, m_.period);
    }
    const drawn_machine& m_;
    std::vector<axis_record> baseline_;
    std::vector<double> asked_;
};

namespace detail {

inline surroundings around(const drawn_machine& m, const gap_meter& meter) {
    surroundings s;
    s.period = m.period;
    const auto& r = meter.baseline();
    const auto [low, high] = std::minmax_element(r.reference.begin(), r.reference.end());
    s.travel = std::max(1e-3, *high - *low);
    s.peak_command = s.peak_velocity = 0;
    for (std::size_t k = 1; k < r.command.size(); ++k) {
        s.peak_command = std::max(s.peak_command, std::abs(r.command[k]));
        s.peak_velocity = std::max(s.peak_velocity, std::abs(r.reference[k] - r.reference[k - 1]) / m.period);
    }
    const auto& a = m.described[0];
    s.peak_force = s.peak_command * a.actuator.force_constant;
    if (a.drive.closes()) {
        s.peak_force = 0;
        for (double f : r.force) s.peak_force = std::max(s.peak_force, std::abs(f));
    }
    s.seconds = static_cast<double>(r.command.size()) * m.period;
    s.crossover = a.drive.closes() ? a.drive.velocity_gain / a.mechanics.mass
                                   : a.controller.velocity_gain * a.actuator.force_constant / a.mechanics.mass;
    return s;
}

/// 95th percentile of twelve machines from the tolerance box, with their noise and rounding.
inline double tolerance_cloud(const drawn_machine& m, const gap_meter& meter, dice random) {
    std::vector<double> gaps;
    for (int n = 0; n < 12; ++n) {
        std::vector<axis_truth> moved = m.described;
        for (axis_truth& a : moved) move_inside(a, m.tolerance, random);
        gaps.push_back(meter(moved));
    }
    std::sort(gaps.begin(), gaps.end());
    return gaps[10] + 0.45 * (gaps[11] - gaps[10]);
}

} // namespace detail

} // namespace quadrant_gap::trial
