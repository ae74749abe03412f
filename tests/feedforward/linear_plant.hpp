// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

/// dv/dt = B u(t - delay) - A v, dx/dt = v, with u held over the period: solved exactly (exponentials), bare
/// numbers. The tests' own plant: it shares nothing with quadrant::linear_motor.
class linear_plant {
public:
    linear_plant(double a, double b, double delay, double period) : a_(a), b_(b), period_(period) {
        const double periods = delay / period;
        double whole = std::floor(periods + 1e-9);
        late_ = std::max(0.0, (periods - whole) * period);
        if (late_ < 1e-9 * period) late_ = 0;
        past_.assign(std::size_t(whole) + 2, 0.0);
    }
    /// Holds u for a period; the position at its end.
    double operator()(double u) {
        past_.insert(past_.begin(), u);
        past_.pop_back();
        move(past_[past_.size() - 1], late_);
        move(past_[past_.size() - 2], period_ - late_);
        return x_;
    }
    double velocity() const { return v_; }

private:
    void move(double u, double h) {
        const double end = b_ * u / a_, gone = -std::expm1(-a_ * h);
        x_ += end * h + (v_ - end) * gone / a_;
        v_ += (end - v_) * gone;
    }
    double a_, b_, period_, late_ = 0, x_ = 0, v_ = 0;
    std::vector<double> past_; ///< newest first; the last two act in the coming period
};
