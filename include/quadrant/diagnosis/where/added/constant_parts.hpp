// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../log/signals.hpp"

#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// A signal cut where its level changes: binary segmentation. A part is cut in two where that takes most off
/// the sum of squares, as long as that is more than noise would give anywhere in the record.
class constant_parts {
public:
    /// `sigma`: noise of a row. Nothing is found where more than `most` parts would be needed.
    constant_parts(const std::vector<double>& x, double sigma, std::size_t most) : sum_(x.size() + 1) {
        for (std::size_t k = 0; k < x.size(); ++k) sum_[k + 1] = sum_[k] + x[k];
        // Twice the logarithm of the rows is what the best of all cuts takes off white noise; the rest is
        // margin.
        least_ = 8 * std::log(static_cast<double>(std::max<std::size_t>(2, x.size()))) * sigma * sigma;
        ends_ = {0, x.size()};
        std::vector<std::pair<std::size_t, std::size_t>> open{{0, x.size()}};
        while (!open.empty() && ends_.size() <= most + 1) {
            const auto [a, b] = open.back();
            open.pop_back();
            const auto [at, gain] = best_cut(a, b);
            if (gain <= least_) continue;
            ends_.insert(std::upper_bound(ends_.begin(), ends_.end(), at), at);
            open.push_back({a, at});
            open.push_back({at, b});
        }
        if (ends_.size() > most + 1) {
            ends_.clear();
            return;
        }
        settle();
    }

    bool found() const { return !ends_.empty(); }
    std::size_t size() const { return found() ? ends_.size() - 1 : 0; }
    std::size_t begin(std::size_t part) const { return ends_[part]; }
    std::size_t end(std::size_t part) const { return ends_[part + 1]; }
    std::size_t length(std::size_t part) const { return end(part) - begin(part); }
    double level(std::size_t part) const { return mean(begin(part), end(part)); }

private:
    struct cut {
        std::size_t at;
        double gain;
    };
    double mean(std::size_t a, std::size_t b) const { return (sum_[b] - sum_[a]) / static_cast<double>(b - a); }
    cut best_cut(std::size_t a, std::size_t b) const {
        cut best{a, 0};
        const double whole = mean(a, b);
        for (std::size_t j = a + 1; j < b; ++j) {
            const auto n1 = static_cast<double>(j - a), n2 = static_cast<double>(b - j);
            const double off = mean(a, j) - whole, gain = off * off * n1 * (n1 + n2) / n2;
            if (gain > best.gain) best = {j, gain};
        }
        return best;
    }
    /// Each cut where it is best between its neighbours; one that gains nothing there goes.
    void settle() {
        for (int round = 0; round < 3; ++round)
            for (std::size_t i = 1; i + 1 < ends_.size();) {
                const cut again = best_cut(ends_[i - 1], ends_[i + 1]);
                if (again.gain > least_)
                    ends_[i++] = again.at;
                else
                    ends_.erase(ends_.begin() + static_cast<std::ptrdiff_t>(i));
            }
    }

    std::vector<double> sum_; ///< of the rows before
    double least_ = 0;
    std::vector<std::size_t> ends_;
};

} // namespace quadrant::inline v0::diagnosis::detail
