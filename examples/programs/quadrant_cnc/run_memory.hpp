// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "run_result.hpp"

#include <quadrant/trajectory/interpolator.hpp>

#include <array>
#include <vector>

/// What a run remembers of the periods before.
namespace quadrant_cnc {

/// What is due in one period.
struct due_sample {
    std::array<quadrant::trajectory::motion, 3> axis;
    double speed = 0;
    std::size_t line = 0;
};

/// References on their way: laws that look ahead get them first, all axes answer to the same period.
class waiting_line {
public:
    explicit waiting_line(std::size_t periods) : ring_(periods + 1) {}
    void settle(const due_sample& at) { ring_.assign(ring_.size(), at); }
    void push(const quadrant::trajectory::path_reference& r) noexcept {
        now_ = now_ + 1 < ring_.size() ? now_ + 1 : 0;
        ring_[now_] = {r.axis, r.speed, r.line};
    }
    const due_sample& ago(std::size_t periods) const noexcept {
        return ring_[now_ >= periods ? now_ - periods : now_ + ring_.size() - periods];
    }
    std::size_t longest() const noexcept { return ring_.size() - 1; }

private:
    std::vector<due_sample> ring_;
    std::size_t now_ = 0;
};

/// The last samples, to be kept when one of them was the worst.
class close_up {
public:
    static constexpr std::size_t around = 128;
    void add(const contour_sample& s, bool worst) {
        ring_[count_++ % ring_.size()] = s;
        if (worst) left_ = around + 1;
        if (left_ > 0 && --left_ == 0) keep();
    }
    std::vector<contour_sample> finish() {
        if (left_ > 0) keep();
        return std::move(kept_);
    }

private:
    void keep() {
        kept_.clear();
        const std::size_t n = std::min(count_, ring_.size());
        for (std::size_t i = count_ - n; i < count_; ++i) kept_.push_back(ring_[i % ring_.size()]);
        left_ = 0;
    }
    std::array<contour_sample, 2 * around + 1> ring_{};
    std::size_t count_ = 0, left_ = 0;
    std::vector<contour_sample> kept_;
};

} // namespace quadrant_cnc
