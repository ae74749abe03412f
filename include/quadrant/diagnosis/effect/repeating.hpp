// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../spatial_spectrum.hpp"
#include "effect.hpp"

/// What the effects share whose force, friction or reading repeats along the travel or in time.
namespace quadrant::diagnosis::detail {

using harmonics_of = harmonics& (*)(plant_model&);

template <harmonics_of Box, std::size_t I>
void add_harmonic(std::vector<parameter>& ps, const char* key, double size) {
    const auto amplitude = [&](double& (*of)(plant_model&)) {
        ps.push_back({.key = key, .of = of, .start = 0, .low = -size, .high = size, .step = 1e-4 * size});
    };
    amplitude([](plant_model& p) -> double& { return Box(p).cosine[I]; });
    amplitude([](plant_model& p) -> double& { return Box(p).sine[I]; });
}

/// Period and amplitudes of the harmonics, one to `Count`, each up to `size`. The period moves by one line of the
/// spectrum, period/length of the record along z, or by a tenth.
template <harmonics_of Box, std::size_t Count>
std::vector<parameter> repeating(const char* period_key, const char* size_key, double period, double length,
                                 double size) {
    const double line = std::min(0.1, period / length);
    std::vector<parameter> ps{{.key = period_key,
                               .of = [](plant_model& p) -> double& { return Box(p).period; },
                               .start = period,
                               .low = period / (1 + line),
                               .high = period * (1 + line),
                               .logarithmic = true,
                               .step = 1e-3 * line}};
    [&]<std::size_t... I>(std::index_sequence<I...>) { (add_harmonic<Box, I>(ps, size_key, size), ...); }
    (std::make_index_sequence<Count>());
    return ps;
}

inline double travel(const screening& s) {
    const auto [low, high] = std::minmax_element(s.record.position.begin(), s.record.position.end());
    return *high - *low;
}
inline double duration(const screening& s) {
    return s.record.period * static_cast<double>(s.record.position.size());
}
inline double largest_command(const screening& s) {
    double most = 0;
    for (double u : s.record.command) most = std::max(most, std::abs(u));
    return most;
}

} // namespace quadrant::diagnosis::detail
