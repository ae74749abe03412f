// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

/// Random numbers that are the same with every standard library: the engine is the standard's, the
/// distributions are ours.
namespace quadrant_gap::trial {

class dice {
public:
    explicit dice(std::uint64_t seed) : engine_(seed) {}
    /// A stream of its own for each purpose, so that what one draws does not shift another.
    dice(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) ^ mixed(stream + 1))) {}

    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; } ///< 0 to below 1
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
    bool chance(double probability) { return uniform() < probability; }
    double sign() { return chance(0.5) ? 1 : -1; }
    double phase() { return uniform(-std::numbers::pi, std::numbers::pi); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform() * static_cast<double>(n)); }
    int whole(int low, int high) {
        return low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1)));
    }
    double normal() {
        const double radius = std::sqrt(-2 * std::log(1 - uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }
    template <class T> const T& one_of(const std::vector<T>& all) { return all[below(all.size())]; }
    template <class T> void shuffle(std::vector<T>& all) {
        for (std::size_t k = all.size(); k > 1; --k) std::swap(all[k - 1], all[below(k)]);
    }

private:
    static std::uint64_t mixed(std::uint64_t x) { // splitmix64
        x += 0x9e3779b97f4a7c15U;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
        return x ^ (x >> 31);
    }
    std::mt19937_64 engine_;
};

} // namespace quadrant_gap::trial
