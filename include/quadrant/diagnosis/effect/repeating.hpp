// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/spatial_spectrum.hpp"
#include "effect.hpp"

#include <complex>
#include <span>

/// What the effects share whose force, friction or reading repeats along the travel or in time.
namespace quadrant::inline v0::diagnosis::detail {

using harmonics_of = harmonics& (*)(plant_model&);

/// Both components of each harmonic of a wave in a model, for `machine_key::components`.
template <harmonics_of Box>
inline constexpr auto components_of = []<std::size_t... I>(std::index_sequence<I...>) {
    using component = double& (*)(plant_model&);
    return std::array<component, 2 * sizeof...(I)>{
        [](plant_model& p) -> double& { return Box(p).cosine[I]; }...,
        [](plant_model& p) -> double& { return Box(p).sine[I]; }...};
}
(std::make_index_sequence<harmonics::most>());

template <harmonics_of Box, std::size_t I>
void add_harmonic(std::vector<parameter>& ps, const char* key, double size) {
    const auto amplitude = [&](double& (*of)(plant_model&)) {
        ps.push_back({.key = key, .of = of, .start = 0, .low = -size, .high = size, .step = 1e-4 * size});
    };
    amplitude([](plant_model& p) -> double& { return Box(p).cosine[I]; });
    amplitude([](plant_model& p) -> double& { return Box(p).sine[I]; });
}

/// Period and amplitudes of the harmonics, one to `Count`, each up to `size`. The period moves by one line of
/// the spectrum, period/length of the record along z, or by a tenth.
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

/// Power of a signal at each of the first multiples of 1/period along z.
template <std::size_t Count>
std::array<double, Count> comb(std::span<const double> signal, std::span<const double> z, double period) {
    std::array<std::complex<double>, Count> sum{};
    for (std::size_t k = 0; k < signal.size(); ++k) {
        const auto turn = std::polar(1.0, 2 * std::numbers::pi * z[k] / period);
        auto phasor = turn;
        for (auto& of : sum) {
            of += signal[k] * phasor;
            phasor *= turn;
        }
    }
    std::array<double, Count> power{};
    for (std::size_t i = 0; i < Count; ++i) power[i] = std::norm(sum[i]);
    return power;
}

/// Whether the residual surely holds a harmonic beyond the first three of this period, all eight fitted side by
/// side: its power is ten times what noise gives it, one case of e^10. The residual holds its noise below its
/// bandwidth.
QUADRANT_DIAGNOSIS_DECL bool holds_more_than_three(const screening& s, double period);

/// The two periods whose harmonics, down to `shortest`, gather most of the signal. A peak of the spectrum may
/// be any harmonic, but a longer period gathers a line's own power again and must find more of its own, else it
/// is the same line under a name that repeats.
template <std::size_t Count>
std::vector<double> comb_periods(std::span<const double> signal, std::span<const double> z, double longest,
                                 double shortest, std::size_t skip) {
    struct found {
        double period, power;
    };
    std::vector<found> all;
    for (double peak : spatial_peaks(signal, z, longest, shortest, 4, skip)) {
        double gathered = 0;
        for (double order = 1; order <= 4 && order * peak <= longest; ++order) {
            const auto powers = comb<Count>(signal.subspan(skip), z.subspan(skip), order * peak);
            double power = 0;
            for (std::size_t i = 0; i < Count && order * peak >= static_cast<double>(i + 1) * shortest; ++i)
                power += powers[i];
            if (power < 1.1 * gathered) continue;
            gathered = power;
            all.push_back({order * peak, power});
        }
    }
    if (all.empty()) return {};
    std::stable_sort(all.begin(), all.end(), [](const found& a, const found& b) { return a.power > b.power; });
    const auto [low, high] = std::minmax_element(z.begin(), z.end());
    const auto is = [line = all.front().period / (*high - *low)](double ratio) { // a whole number
        return std::abs(ratio / std::round(ratio) - 1) < line;
    };
    // Beside the one that gathers most the shortest that it may be a multiple of; where there is none, the next
    // best.
    const found* second = nullptr;
    for (const found& f : all)
        if (const double ratio = all.front().period / f.period; ratio > 1.5 && is(ratio) &&
                                                                f.power > 0.7 * all.front().power &&
                                                                (!second || f.period < second->period))
            second = &f;
    for (const found& f : all)
        if (!second && !is(all.front().period / f.period)) second = &f;
    std::vector<double> out{all.front().period};
    if (second) out.push_back(second->period);
    return out;
}

/// The same along the travel, and where it is no harmonic of these, the period that least squares finds. An
/// axis that dwells in a part of its travel sees the wave through that one window most of the time, and the
/// side lobes of the window are higher in the transform than the line. A harmonic is the same line where the
/// two differ by less than half a wave over the travel.
template <std::size_t Count>
std::vector<double> comb_periods_along(std::span<const double> signal, std::span<const double> z,
                                       double longest, double shortest, std::size_t skip) {
    std::vector<double> out = comb_periods<Count>(signal, z, longest, shortest, skip);
    const std::vector<double> everywhere(z.size(), 1);
    const auto ends = std::minmax_element(z.begin(), z.end());
    const double travelled = *ends.second - *ends.first;
    for (const double period : carried_peaks(signal, everywhere, z, longest, shortest, 1, skip)) {
        const auto holds = [&](double of) {
            const double order = std::round(of / period);
            return order >= 1 && order <= Count && std::abs(order / of - 1 / period) * travelled < 0.5;
        };
        if (std::none_of(out.begin(), out.end(), holds)) out.push_back(period);
    }
    return out;
}

/// Whether the motion repeats with one of the first multiples of this period: it is then where it was one time
/// before, and was not in between. What repeats in time with the motion cannot be distinguished from what
/// follows the motion.
inline bool motion_repeats(std::span<const double> position, double rows) {
    const auto apart = [&](double shift) {
        const auto by = static_cast<std::size_t>(std::lround(shift));
        double sum = 0;
        for (std::size_t k = by; k < position.size(); ++k) {
            const double d = position[k] - position[k - by];
            sum += d * d;
        }
        return by < position.size() ? sum / static_cast<double>(position.size() - by) : 0;
    };
    for (double order = 1; order <= 4 && 2 * order * rows < static_cast<double>(position.size()); ++order)
        if (apart(order * rows) < 0.05 * std::max(apart(order * rows / 2), apart(order * rows / 3)))
            return true;
    return false;
}

/// Whether a force of this period would repeat with the strokes, or with one of their first harmonics: what
/// follows the motion, by whatever law, does so too. A stroke's frequency is that of the triangle with this way
/// and this mean speed.
inline bool strokes_repeat(const axis_record& r, double period) {
    const auto rows = static_cast<double>(r.position.size());
    double mean = 0, square = 0, speed = 0;
    for (double x : r.position) mean += x / rows;
    for (double x : r.position) square += (x - mean) * (x - mean) / rows;
    for (double v : r.velocity) speed += std::abs(v) / rows;
    return speed * period > std::sqrt(3 * square);
}

/// Whether an axis that goes one way shows more of a line of this period along its travel than in time: then it
/// is bound to the position, at whatever speed. The wavelength is that of the mean speed, or a few lines of the
/// spectrum beside it.
inline bool bound_to_position(const screening& s, double period, std::span<const double> time) {
    const auto& x = s.record.position;
    double way = 0;
    for (std::size_t k = 1; k < x.size(); ++k) way += std::abs(x[k] - x[k - 1]);
    const double moved = x.back() - x.front();
    constexpr double one_way = 0.9;
    if (!(std::abs(moved) > one_way * way)) return false;
    const auto skip = s.record.score.skip;
    const auto power = [&](std::span<const double> z, double length) {
        double sum = 0;
        for (double p : comb<4>(std::span(s.residual).subspan(skip), z.subspan(skip), length)) sum += p;
        return sum;
    };
    const double wave = period * std::abs(moved) / (time.back() - time.front()), line = wave / way;
    double along = 0;
    for (int j = -8; j <= 8; ++j) along = std::max(along, power(x, wave * (1 + line * j / 2)));
    return along > power(time, period);
}

inline double travel(const screening& s) {
    const auto [low, high] = std::minmax_element(s.record.position.begin(), s.record.position.end());
    return *high - *low;
}
inline double recorded_time(const screening& s) {
    return s.record.period * static_cast<double>(s.record.position.size());
}
/// The logs behind the first one in the record of a drive.
inline std::span<const log_start> other_logs(const screening& s) {
    const auto& drive = s.record.observer.drive;
    return drive ? drive->begins : std::span<const log_start>{};
}
inline std::size_t rows_of_first_log(const screening& s) {
    const auto others = other_logs(s);
    return others.empty() ? s.residual.size() : others.front().row;
}
/// Time of each row since its log began.
inline std::vector<double> times_in_their_logs(const screening& s) {
    std::vector<double> out(s.residual.size());
    auto others = other_logs(s);
    std::size_t first = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
        if (!others.empty() && others.front().row == k) {
            first = k;
            others = others.subspan(1);
        }
        out[k] = static_cast<double>(k - first) * s.record.period;
    }
    return out;
}
inline double largest_command(const screening& s) {
    double most = 0;
    for (double u : s.record.command) most = std::max(most, std::abs(u));
    return most;
}

} // namespace quadrant::inline v0::diagnosis::detail

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "repeating.ipp"
#endif
