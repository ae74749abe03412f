// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The cubic through four points (at[i], x[i]), at `where` [Lagrange]. The points may be unevenly spaced.
inline double cubic_through(const std::array<double, 4>& at, const std::array<double, 4>& x, double where) {
    double out = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        double weight = 1;
        for (std::size_t j = 0; j < 4; ++j)
            if (j != i) weight *= (where - at[j]) / (at[i] - at[j]);
        out += weight * x[i];
    }
    return out;
}

/// Readings of a position that no motion explains: `wrong` ones (a bus glitch) and `stale` ones (the previous
/// reading once more, while the axis moved).
struct wrong_readings {
    std::vector<unsigned char> bad{}; ///< of every row: 1 where it is one of them
    std::size_t wrong = 0, stale = 0;
};

/// Finds them. A reading is compared with the cubic through the two before it and the two after it. What motion
/// and noise leave there is measured around it, robustly, so the limits follow from the record itself:
/// - wrong: it departs by more than eight times that, from the straight lines through the two before it and the
///   two after it, too, and without it its neighbours agree with theirs (where the velocity jumps, the reading
///   agrees with one of the lines, or its neighbours do not agree);
/// - stale: it repeats the reading before it, the axis moved on by more than four times that and two counts,
///   and the next new reading makes up for it by a jump longer than the steps before and after.
class reading_check {
public:
    /// Stamps that increase, readings, and the step of the reading (its count, or its last digit).
    reading_check(std::span<const double> t, std::span<const double> x, double count)
        : t_(t), x_(x.begin(), x.end()), count_(count) {
        out_.bad.assign(x.size(), 0);
    }

    wrong_readings take() {
        if (x_.size() < least_rows) return std::move(out_);
        find_stale();
        find_wrong();
        return std::move(out_);
    }

private:
    static constexpr std::size_t least_rows = 16, around = 32;
    static constexpr std::size_t longest_repeat = 4;

    /// What the reading of row k departs from the cubic through its neighbours.
    double off(std::size_t k) const {
        return x_[k] - cubic_through({t_[k - 2], t_[k - 1], t_[k + 1], t_[k + 2]},
                                     {x_[k - 2], x_[k - 1], x_[k + 1], x_[k + 2]}, t_[k]);
    }

    /// Usual size of off() around each row: its median, as the standard deviation of noise that has this
    /// median.
    std::vector<double> usual_off() const {
        constexpr double of_median = 1.4826;
        const std::size_t n = x_.size();
        std::vector<double> size(n, 0.0), out(n, 0.0), near;
        for (std::size_t k = 2; k + 2 < n; ++k) size[k] = std::abs(off(k));
        constexpr std::size_t stride = 8; // the median changes slowly
        for (std::size_t begin = 0; begin < n; begin += stride) {
            const std::size_t first = begin > around ? begin - around : 0,
                              last = std::min(n, begin + stride + around);
            near.assign(size.begin() + static_cast<std::ptrdiff_t>(first),
                        size.begin() + static_cast<std::ptrdiff_t>(last));
            const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
            std::nth_element(near.begin(), middle, near.end());
            for (std::size_t k = begin; k < std::min(n, begin + stride); ++k) out[k] = of_median * *middle;
        }
        const double floor = of_median * usual_where_it_moves(size);
        for (double& usual : out) usual = std::max(usual, floor);
        return out;
    }

    /// The median over the rows that depart at all: an axis at rest shows no noise of its count.
    double usual_where_it_moves(std::vector<double> size) const {
        const auto [low, high] = std::minmax_element(x_.begin(), x_.end());
        std::erase_if(size, [least = 1e-9 * (*high - *low)](double s) { return s <= least; });
        if (size.empty()) return 0;
        const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
        std::nth_element(size.begin(), middle, size.end());
        return *middle;
    }

    void find_stale() {
        const auto usual = usual_off();
        const std::size_t n = x_.size();
        for (std::size_t a = 1; a + 1 < n; ++a) {
            std::size_t b = a;
            while (b + 1 < n && x_[b + 1] == x_[a]) ++b;
            if (b == a) continue;
            if (b - a <= longest_repeat && a > 1 && b + 2 < n && made_up_for(a, b, 4 * usual[a] + 2 * count_)) {
                for (std::size_t k = a + 1; k <= b; ++k) {
                    x_[k] = cubic_through({t_[a - 1], t_[a], t_[b + 1], t_[b + 2]},
                                          {x_[a - 1], x_[a], x_[b + 1], x_[b + 2]}, t_[k]);
                    out_.bad[k] = 1;
                    ++out_.stale;
                }
            }
            a = b;
        }
    }
    /// Rows a + 1 to b repeat row a. The axis moved on meanwhile, and row b + 1 catches up.
    bool made_up_for(std::size_t a, std::size_t b, double enough) const {
        const double jump = x_[b + 1] - x_[b], before = x_[a] - x_[a - 1], after = x_[b + 2] - x_[b + 1];
        const auto rate = [&](double step, std::size_t from, std::size_t to) {
            return step / (t_[to] - t_[from]);
        };
        const double v_before = rate(before, a - 1, a), v_after = rate(after, b + 1, b + 2);
        const double v_here = rate(jump, a, b + 1), v_jump = rate(jump, b, b + 1);
        const double missed = v_here * (t_[b] - t_[a]);
        const bool one_way = v_before * v_here > 0 && v_after * v_here > 0;
        const bool catches_up = std::abs(v_jump) > 1.25 * std::max(std::abs(v_before), std::abs(v_after));
        return one_way && catches_up && std::abs(missed) > enough;
    }

    void find_wrong() {
        const auto usual = usual_off();
        const std::size_t n = x_.size();
        const double span = usual_span();
        for (std::size_t k = 2; k + 2 < n; ++k) {
            const double limit = 8 * std::max(usual[k], count_);
            const double here = off(k);
            if (out_.bad[k] || !(std::abs(here) > limit) || beside_gap(k, span) || !largest_near(k, here) ||
                goes_on_from_one_side(k, limit))
                continue;
            const double kept = x_[k];
            x_[k] -= here;
            double left = 0;
            for (std::size_t j = std::max<std::size_t>(k, 4) - 2; j <= std::min(k + 2, n - 3); ++j)
                left = std::max(left, std::abs(off(j)));
            if (left > 0.1 * std::abs(here) + 0.2 * limit) {
                x_[k] = kept; // a jolt of the machine, not of one reading
                continue;
            }
            out_.bad[k] = 1;
            ++out_.wrong;
        }
    }
    /// Time that five rows usually take.
    double usual_span() const {
        std::vector<double> spans;
        for (std::size_t k = 2; k + 2 < t_.size(); ++k) spans.push_back(t_[k + 2] - t_[k - 2]);
        const auto middle = spans.begin() + static_cast<std::ptrdiff_t>(spans.size() / 2);
        std::nth_element(spans.begin(), middle, spans.end());
        return *middle;
    }
    /// Over a gap the cubic says less: what it leaves there is no measure of a reading.
    bool beside_gap(std::size_t k, double span) const {
        const std::size_t first = std::max<std::size_t>(k, 4) - 4, last = std::min(k + 4, t_.size() - 1);
        for (std::size_t j = first + 1; j <= last; ++j)
            if (t_[j] - t_[j - 1] > 0.375 * span) return true; // one and a half of its four steps
        return false;
    }
    bool largest_near(std::size_t k, double here) const {
        const std::size_t n = x_.size();
        for (std::size_t j = std::max<std::size_t>(k, 4) - 2; j <= std::min(k + 2, n - 3); ++j)
            if (j != k && std::abs(off(j)) > std::abs(here)) return false;
        return true;
    }

    /// Whether the reading continues the motion before it, or leads to the motion after it: between the two the
    /// velocity jumps, as where the motor meets the load across a play.
    bool goes_on_from_one_side(std::size_t k, double limit) const {
        const auto off_line = [&](std::size_t a, std::size_t b) {
            return std::abs(x_[k] - x_[a] - (x_[b] - x_[a]) * (t_[k] - t_[a]) / (t_[b] - t_[a]));
        };
        return std::min(off_line(k - 1, k - 2), off_line(k + 1, k + 2)) < limit;
    }

    std::span<const double> t_;
    std::vector<double> x_; ///< with the wrong readings replaced
    double count_;
    wrong_readings out_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
