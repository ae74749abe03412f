// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

/// What a report draws of a run of any length, in memory that does not grow with it.
namespace quadrant_cnc {

/// Several signals of one clock: of every stretch of time the smallest and the largest value of each, so that
/// no peak is lost. When all stretches are full, two become one.
class decimated {
public:
    static constexpr std::size_t most = 1600; ///< stretches; even

    explicit decimated(std::size_t signals) : signals_(signals), open_(signals) {}

    void add(const double* values) {
        if (filled_ == 0) {
            for (std::size_t i = 0; i < signals_; ++i) open_[i] = {values[i], values[i], false};
        } else
            for (std::size_t i = 0; i < signals_; ++i) {
                extremes& e = open_[i];
                if (values[i] < e.low) e.low = values[i], e.high_last = false;
                if (values[i] > e.high) e.high = values[i], e.high_last = true;
            }
        ++samples_;
        if (++filled_ == width_) close();
    }
    /// Ends the last stretch.
    void finish() {
        if (filled_ > 0) close();
    }

    std::size_t signals() const { return signals_; }
    std::size_t samples() const { return samples_; } ///< that were added
    std::size_t width() const { return width_; }     ///< samples of a stretch
    /// In samples from the first one: two for each stretch, or one where a stretch is a sample.
    std::vector<double> times() const {
        std::vector<double> out;
        for (std::size_t i = 0; i < stretches(); ++i) {
            out.push_back(double(i * width_));
            if (width_ > 1) out.push_back(double(i * width_) + 0.5 * double(width_));
        }
        return out;
    }
    std::vector<double> values(std::size_t signal) const {
        std::vector<double> out;
        for (std::size_t i = 0; i < stretches(); ++i) {
            const extremes& e = closed_[i * signals_ + signal];
            out.push_back(e.high_last ? e.low : e.high);
            if (width_ > 1) out.push_back(e.high_last ? e.high : e.low);
        }
        return out;
    }

private:
    struct extremes {
        double low = 0, high = 0;
        bool high_last = false;
    };
    std::size_t stretches() const { return closed_.size() / signals_; }
    void close() {
        closed_.insert(closed_.end(), open_.begin(), open_.end());
        filled_ = 0;
        if (stretches() < most) return;
        for (std::size_t i = 0; i < most / 2; ++i)
            for (std::size_t k = 0; k < signals_; ++k) {
                const extremes a = closed_[2 * i * signals_ + k], b = closed_[(2 * i + 1) * signals_ + k];
                const bool low_in_b = b.low < a.low;
                const bool high_in_b = a.high < b.high;
                closed_[i * signals_ + k] = {std::min(a.low, b.low), std::max(a.high, b.high),
                                             low_in_b != high_in_b ? high_in_b
                                             : high_in_b           ? b.high_last
                                                                   : a.high_last};
            }
        closed_.resize(most / 2 * signals_);
        width_ *= 2;
    }

    std::size_t signals_, width_ = 1, filled_ = 0, samples_ = 0;
    std::vector<extremes> open_, closed_;
};

/// Of every stretch the sample that weighs most.
template <class Sample> class heaviest {
public:
    explicit heaviest(std::size_t most) : most_(most + most % 2) {}
    void add(const Sample& sample, double weight) {
        if (filled_ == 0 || weight > open_.weight) open_ = {sample, weight};
        if (++filled_ < width_) return;
        finish();
        if (all_.size() < most_) return;
        for (std::size_t i = 0; i < most_ / 2; ++i)
            all_[i] = all_[2 * i].weight >= all_[2 * i + 1].weight ? all_[2 * i] : all_[2 * i + 1];
        all_.resize(most_ / 2);
        width_ *= 2;
    }
    void finish() {
        if (filled_ > 0) all_.push_back(open_);
        filled_ = 0;
    }
    std::vector<Sample> samples() const {
        std::vector<Sample> out;
        for (const one& each : all_) out.push_back(each.sample);
        return out;
    }

private:
    struct one {
        Sample sample{};
        double weight = 0;
    };
    std::size_t most_, width_ = 1, filled_ = 0;
    one open_;
    std::vector<one> all_;
};

} // namespace quadrant_cnc
