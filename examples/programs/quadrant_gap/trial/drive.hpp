// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"
#include "random.hpp"

/// Drives of the trial's machines: written from the equations of docs/formats.md, without the library's blocks.
namespace quadrant_gap::trial {

class inner_loops {
public:
    using drive_kind = drive_truth::drive_kind;
    inner_loops(const drive_truth& d, double period, dice random)
        : d_(d), period_(period), random_(random), integral_(d.began) {}

    /// The next row's set-point: volts, or a position. A lost one repeats the one before.
    void set_point(double r) {
        if (!(d_.loss > 0 && !told_.empty() && random_.chance(d_.loss))) kept_ = r;
        told_.push_back(kept_);
    }
    /// Force over [t, t + h] with the motor at x and v in the middle of it.
    double force(double t, double h, double x, double v) {
        const double r = followed(t, t + h);
        if (d_.kind == drive_kind::position_servo) return servo(r, h, x);
        const double asked =
            d_.kind == drive_kind::velocity ? d_.velocity_per_V * r : d_.position_gain * (r - x);
        const double most = d_.force_limit > 0 ? d_.force_limit : HUGE_VAL;
        const double half = h / 2 * d_.velocity_integral * (asked - v), now = integral_ + half;
        integral_ = std::clamp(now + half, -most, most);
        return std::clamp(d_.velocity_gain * (asked - v) + now, -most, most);
    }
    double duty() const { return duty_; }

private:
    double at_row(double n) const {
        if (told_.empty()) return 0;
        const auto row = static_cast<std::size_t>(std::max(0.0, n));
        return told_[std::min(row, told_.size() - 1)];
    }
    /// What the loops see: the drive takes the newest row on its own clock.
    double followed(double t) const {
        const double every = 1 + d_.clock_slip, ticks = (t - d_.delay) / period_ / every;
        const double tick = std::floor(ticks + 1e-9);
        const double newest = at_row(std::floor(tick * every + 1e-6));
        if (!d_.linear) return newest;
        const double before = at_row(std::floor((tick - 1) * every + 1e-6));
        return before + (newest - before) * std::clamp(ticks - tick, 0.0, 1.0);
    }
    /// On average from one moment to another, with no more than one arrival between: those of a row are far
    /// apart.
    double followed(double from, double to) const {
        const double row = period_ * (1 + d_.clock_slip);
        const double arrival = std::floor((to - d_.delay) / row) * row + d_.delay;
        if (arrival <= from || arrival >= to) return followed((from + to) / 2);
        const double before = followed((from + arrival) / 2), after = followed((arrival + to) / 2);
        return (before * (arrival - from) + after * (to - arrival)) / (to - from);
    }
    double servo(double r, double h, double x) {
        const double step = d_.rate_limit > 0 ? h * d_.rate_limit : HUGE_VAL;
        profile_ = std::clamp(r, profile_ - step, profile_ + step);
        const double e = profile_ - x, least = e > 0 ? d_.minimum_duty : e < 0 ? -d_.minimum_duty : 0;
        duty_ = std::clamp(d_.duty_gain * e + least, -d_.maximum_duty, d_.maximum_duty);
        return duty_;
    }

    const drive_truth& d_;
    double period_;
    dice random_;
    std::vector<double> told_;
    double kept_ = 0, integral_ = 0, profile_ = 0, duty_ = 0;
};

} // namespace quadrant_gap::trial
