// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller_floor.hpp"
#include "searched_keys.hpp"

#include <stdexcept>

namespace quadrant::inline v0::diagnosis::detail {

/// Sum over the blocks of log(mean square + floor): free of scale, and no block gains from being below the
/// floor.
inline double replay_score(const std::vector<double>& d, std::size_t block, double floor) {
    double sum = 0;
    for (double ms : block_ms(d, 0, block)) sum += std::log(ms + floor);
    return sum;
}

inline double inner(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

/// One key moved alone to where the replay agrees best with the log.
struct key_fit {
    std::string key{};
    double described = 0, value = 0;
    double score = std::numeric_limits<double>::infinity(); ///< replay_score() at the value
    controller_description controller{};                    ///< with the value
    std::vector<double> left{};                             ///< replayed less logged, without the converter
    std::vector<double> slope{};                            ///< change of that per change of the value
};

/// The search of one key. What a small change of the key does to the command is a signal; the share of it that
/// the difference holds (least squares) says where the value lies, and how large a value that is absent is.
/// From there, and from a scan for keys that are far from linear, golden section and two Newton steps lead to
/// the best.
class key_search {
public:
    key_search(const controller_description& described, const searched_key& key, const replay_box& box,
               const std::vector<double>& difference, double floor)
        : box_(box), key_(key), trial_(described), value_(key.of(trial_)), given_(value_),
          scale_(given_ != 0 ? std::abs(given_) : std::abs(key.scale)), floor_(floor), difference_(difference),
          described_(left(given_).value_or(difference)) {}
    key_search(const key_search&) = delete; // the value stands in the controller that is tried

    /// Nothing where no value of the key gives a finite command.
    std::optional<key_fit> best() {
        if (!key_.only.empty()) return settled(lowest(key_.only).value);
        std::vector<double> grid = scan();
        std::erase_if(grid, [&](double x) { return x != given_ && !key_.allowed(x); });
        std::sort(grid.begin(), grid.end());
        const valley low = lowest(grid);
        double x = golden(low.from, low.to);
        for (int step = 0; step < 2; ++step)
            if (const double next = x + newton(x); key_.allowed(next) && score(next) < score(x)) x = next;
        return settled(score(x) <= low.score ? x : low.value);
    }
    /// What a unit of the key adds to the command at the described value; empty: nothing that can be measured.
    std::vector<double> slope() {
        const double step = given_ != 0 ? 1e-3 * scale_ : size_from_record();
        return step > 0 ? slope_at(given_, step, described_) : std::vector<double>();
    }

private:
    struct valley {
        double value, score, from, to;
    };

    std::optional<std::vector<double>> left(double x, bool limited = true) {
        // A corner above half the sampling rate is none.
        value_ = key_.key.ends_with("_Hz") ? std::min(x, 0.499 / box_.period()) : x;
        try {
            auto d = box_.difference(trial_, limited ? box_.smooth(trial_) : box_.unlimited(trial_));
            if (std::all_of(d.begin(), d.end(), [](double v) { return std::isfinite(v); })) return d;
        } catch (const std::exception&) { // no controller has this value
        }
        return {};
    }
    double score(double x) {
        const auto d = left(x);
        return d ? replay_score(*d, box_.block(), floor_) : std::numeric_limits<double>::infinity();
    }
    std::vector<double> slope_at(double x, double step, const std::vector<double>& here, bool limited = true) {
        auto there = left(x + step, limited);
        if (!there) there = left(x + (step = -step), limited);
        if (!there) return {};
        for (std::size_t k = 0; k < there->size(); ++k) (*there)[k] = ((*there)[k] - here[k]) / step;
        return *there;
    }
    /// The size at which an absent key changes the command by as much as the difference; 0: none does.
    double size_from_record() {
        const double wanted = rms(difference_);
        double size = scale_;
        for (int round = 0; round < 8; ++round) {
            const auto slope = slope_at(given_, size, described_);
            const double response = slope.empty() ? 0 : size * rms(slope);
            if (response > 0.3 * wanted && response < 3 * wanted) return size;
            size *= response > 0 ? std::clamp(wanted / response, 1e-4, 1e4) : 1e-2;
        }
        return 0;
    }
    /// Change of the value that the difference at `x` asks for.
    double newton(double x, bool limited = true) {
        const auto here = left(x, limited);
        if (!here) return 0;
        const double step = x != 0 ? 1e-3 * std::abs(x) : 1e-3 * scale_;
        const auto slope = slope_at(x, step, *here, limited);
        const double size = inner(slope, slope);
        return size > 0 ? -inner(slope, *here) / size : 0;
    }
    std::vector<double> scan() {
        std::vector<double> grid{given_};
        const double size = given_ != 0 ? scale_ : size_from_record();
        if (!(size > 0)) return grid;
        const double sign = given_ < 0 ? -1 : 1;
        for (double x :
             {0.0, 0.1, 0.25, 0.4, 0.55, 0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.25, 1.5, 1.8, 2.3, 3.0, 4.5})
            grid.push_back(sign * x * size);
        const auto slope = slope_at(given_, given_ != 0 ? 1e-3 * size : size, described_);
        if (const double square = inner(slope, slope); square > 0) {
            const double change = -inner(slope, described_) / square;
            for (double x : {0.5, 0.9, 1.0, 1.1, 2.0}) grid.push_back(given_ + x * change);
        }
        // Replayed with a wrong value an integral runs into its limit and stays there: neither the slope nor a
        // value beside the true one leads to it. Without the limit both do.
        if (box_.limited()) {
            double x = given_;
            for (int step = 0; step < 2; ++step)
                if (const double next = x + newton(x, false); key_.allowed(next)) grid.push_back(x = next);
        }
        return grid;
    }
    valley lowest(const std::vector<double>& grid) {
        valley out{given_, std::numeric_limits<double>::infinity(), given_, given_};
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (const double s = score(grid[i]); s < out.score)
                out = {grid[i], s, grid[i == 0 ? 0 : i - 1], grid[std::min(i + 1, grid.size() - 1)]};
        return out;
    }
    double golden(double a, double b) {
        constexpr double part = 0.6180339887498949;
        double x1 = b - part * (b - a), x2 = a + part * (b - a), f1 = score(x1), f2 = score(x2);
        for (int i = 0; i < 16; ++i) {
            if (f1 < f2) {
                b = x2, x2 = x1, f2 = f1;
                f1 = score(x1 = b - part * (b - a));
            } else {
                a = x1, x1 = x2, f1 = f2;
                f2 = score(x2 = a + part * (b - a));
            }
        }
        return 0.5 * (a + b);
    }
    std::optional<key_fit> settled(double x) {
        const auto here = left(x);
        if (!here) return {};
        key_fit out{.key = key_.key, .described = given_, .value = value_, .left = *here};
        out.controller = trial_;
        out.score = replay_score(*here, box_.block(), floor_);
        const double towards = x > given_ ? -1 : 1; // towards what it can have
        out.slope = slope_at(x, towards * 1e-3 * std::max(std::abs(x), 1e-3 * scale_), *here);
        return out;
    }

    const replay_box& box_;
    const searched_key& key_;
    controller_description trial_;
    double& value_;
    double given_, scale_, floor_;
    const std::vector<double>& difference_;
    std::vector<double> described_; ///< replayed less logged as described, without the converter
};

} // namespace quadrant::inline v0::diagnosis::detail
