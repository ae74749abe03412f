// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace thesis {

/// Numbers with a normal distribution of rms 1, by Box and Muller: the standard libraries' own differ from one
/// another.
class white_noise {
public:
    explicit white_noise(std::uint64_t seed) : random_(seed) {}
    double operator()() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

private:
    double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) / 9007199254740992.0; }
    std::mt19937_64 random_;
};

} // namespace thesis
