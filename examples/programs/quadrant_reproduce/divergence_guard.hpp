// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <cstddef>

namespace thesis {

/// Tells a run that runs away, so that none of its figures is taken for a result: an error that is not finite
/// or beyond a limit, or, slower, a window (one turn, one cycle) with more than `growth` times the rms of the
/// window before.
class divergence_guard {
public:
    explicit divergence_guard(double limit, std::size_t window = 0, double growth = 1.5)
        : limit_(limit), window_(window), growth_(growth) {}

    /// True: stop. Of every sample, in the unit of the limit.
    bool operator()(double error) noexcept {
        squares_ += error * error;
        if (window_ > 0 && ++count_ == window_) {
            ++windows_;
            grows_ = windows_ > 2 && squares_ > growth_ * growth_ * before_; // the first one holds the start
            before_ = squares_;
            squares_ = 0;
            count_ = 0;
        }
        return diverged_ = diverged_ || !(std::abs(error) < limit_) || grows_;
    }
    bool diverged() const noexcept { return diverged_; }

private:
    double limit_;
    std::size_t window_;
    double growth_, squares_ = 0, before_ = 0;
    std::size_t count_ = 0, windows_ = 0;
    bool grows_ = false, diverged_ = false;
};

} // namespace thesis
