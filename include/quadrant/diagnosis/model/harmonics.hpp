// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../plant/harmonic_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {
/// The largest n whose multiples are the only harmonics that matter: the others hold less than a hundredth of
/// the energy together, so that the wave repeats n times in its period. 1: it does not.
inline std::size_t repeats_in_its_period(const std::vector<double>& sizes) {
    double all = 0;
    for (const double size : sizes) all += size * size;
    for (std::size_t n = sizes.size(); n > 1; --n) {
        double others = 0;
        for (std::size_t i = 1; i <= sizes.size(); ++i)
            if (i % n != 0) others += sizes[i - 1] * sizes[i - 1];
        if (others < 0.01 * all) return n;
    }
    return 1;
}
} // namespace detail

/// sum of cosine_i cos(2 pi i z / period) + sine_i sin(2 pi i z / period), i = 1, 2, ...: what repeats along z,
/// a position or a time. In the files size_i sin(2 pi i z / period + phase_i).
struct harmonics {
    static constexpr std::size_t most = 8;
    double period = 0;     ///< in the unit of z
    std::size_t count = 0; ///< 0: none
    std::array<double, most> cosine{}, sine{};

    harmonics() = default;
    harmonics(double period_, const std::vector<double>& size, const std::vector<double>& phase)
        : period(period_), count(period_ > 0 ? std::min(size.size(), most) : 0) {
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = i < phase.size() ? phase[i] : 0;
            cosine[i] = size[i] * std::sin(angle);
            sine[i] = size[i] * std::cos(angle);
        }
    }
    double at(double z) const {
        return count == 0
                   ? 0
                   : quadrant::detail::harmonic_series<most, double, double>{cosine, sine, count}(z / period);
    }
    /// Up to the last harmonic that has a size.
    std::vector<double> sizes() const {
        std::vector<double> out;
        for (std::size_t i = 0; i < used(); ++i) out.push_back(std::hypot(sine[i], cosine[i]));
        return out;
    }
    std::vector<double> phases() const {
        std::vector<double> out;
        for (std::size_t i = 0; i < used(); ++i) out.push_back(std::atan2(cosine[i], sine[i]));
        return out;
    }

    /// The same wave by its shortest period, n times shorter: its harmonics are every n-th of these.
    harmonics in_lowest_terms(std::size_t n) const {
        harmonics out;
        out.period = period / static_cast<double>(n);
        out.count = count;
        for (std::size_t i = n; i <= count; i += n) {
            out.cosine[i / n - 1] = cosine[i - 1];
            out.sine[i / n - 1] = sine[i - 1];
        }
        return out;
    }

private:
    std::size_t used() const {
        std::size_t n = count;
        while (n > 1 && sine[n - 1] == 0 && cosine[n - 1] == 0) --n;
        return n;
    }
};

} // namespace quadrant::inline v0::diagnosis
