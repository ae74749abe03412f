// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

#include <complex>

namespace quadrant::diagnosis {

namespace detail {

/// Power of the residual force against spatial frequency: sum of the residual times exp(2 pi i x f) over the moving
/// rows, thinned to about 2.5 ms. Returns the frequencies of the largest peaks, the largest first.
inline std::vector<double> spatial_peaks(const screening& s, double longest, double shortest,
                                         std::size_t count) {
    const auto every = std::max<std::size_t>(1, static_cast<std::size_t>(0.0025 / s.record.period));
    std::vector<double> x, f;
    double low = s.record.position[0], high = low;
    for (std::size_t k = s.record.score.skip; k < s.residual.size(); k += every) {
        x.push_back(s.record.position[k]);
        f.push_back(s.residual[k]);
        low = std::min(low, x.back());
        high = std::max(high, x.back());
    }
    if (high <= low || x.empty()) return {};
    const double first = 1 / longest, step = 0.25 / (high - low);
    const auto n = static_cast<std::size_t>(std::max(0.0, (1 / shortest - first) / step)) + 1;
    std::vector<std::complex<double>> phasor(x.size()), turn(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        phasor[i] = f[i] * std::polar(1.0, 2 * std::numbers::pi * first * x[i]);
        turn[i] = std::polar(1.0, 2 * std::numbers::pi * step * x[i]);
    }
    std::vector<double> power(n);
    for (std::size_t j = 0; j < n; ++j) {
        double re = 0, im = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double pr = phasor[i].real(), pi_ = phasor[i].imag(), tr = turn[i].real(),
                         ti = turn[i].imag();
            re += pr;
            im += pi_;
            phasor[i] = {pr * tr - pi_ * ti, pr * ti + pi_ * tr};
        }
        power[j] = re * re + im * im;
    }
    std::vector<std::size_t> peaks;
    for (std::size_t j = 1; j + 1 < n; ++j)
        if (power[j] > power[j - 1] && power[j] >= power[j + 1]) peaks.push_back(j);
    std::sort(peaks.begin(), peaks.end(), [&](auto a, auto b) { return power[a] > power[b]; });
    std::vector<double> out;
    for (auto j : peaks) {
        if (out.size() == count) break;
        out.push_back(first + step * static_cast<double>(j));
    }
    return out;
}

template <std::size_t I> parameter cosine(double size) {
    return {.key = "cogging_N",
            .of = [](plant_model& p) -> double& { return p.cogging.cosine[I]; },
            .start = 0,
            .low = -size,
            .high = size,
            .step = 1e-4 * size};
}
template <std::size_t I> parameter sine(double size) {
    return {.key = "cogging_N",
            .of = [](plant_model& p) -> double& { return p.cogging.sine[I]; },
            .start = 0,
            .low = -size,
            .high = size,
            .step = 1e-4 * size};
}

} // namespace detail

} // namespace quadrant::diagnosis

namespace quadrant::diagnosis::suspect {
/// Force periodic in position: sum of N_i sin(2 pi i x / period + phase_i), the magnets' pitch of a motor or one turn
/// of a screw. Joins the force. Shows as a residual that repeats with position whatever the speed; as a motion it
/// fades with the square of the speed, which tells it from an encoder's cyclic error. Periods up to half the travel:
/// a longer one is a slope or an offset by another name.
inline constexpr effect cogging{
    .name = "cogging",
    .box = "mechanics",
    .exciting_motion = "slow strokes in both directions over several periods",
    .untried_relatives = "encoder_cyclic_error, force_ripple, position_dependent_friction",
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const auto [low, high] = std::minmax_element(s.record.position.begin(), s.record.position.end());
        const double travel = *high - *low, longest = 0.5 * travel, shortest = std::max(travel / 400, 2e-4);
        if (longest <= shortest) return {};
        const double size = 2 * s.leader.force_constant;
        std::vector<std::vector<parameter>> out;
        for (double f : detail::spatial_peaks(s, longest, shortest, 2)) {
            std::vector<parameter> ps{{.key = "cogging_period_m",
                                       .of = [](plant_model& p) -> double& { return p.cogging.period; },
                                       .start = 1 / f,
                                       .low = std::max(shortest, 0.9 / f),
                                       .high = std::min(longest, 1.1 / f),
                                       .logarithmic = true,
                                       .step = 1e-4}};
            for (const auto& h : {detail::cosine<0>(size), detail::sine<0>(size), detail::cosine<1>(size),
                                  detail::sine<1>(size), detail::cosine<2>(size), detail::sine<2>(size)})
                ps.push_back(h);
            out.push_back(ps);
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        key_value n{"cogging_N", {}}, phase{"cogging_phase_rad", {}};
        for (std::size_t i = 0; i < p.cogging.harmonics; ++i) {
            n.values.push_back(std::hypot(p.cogging.sine[i], p.cogging.cosine[i]));
            phase.values.push_back(std::atan2(p.cogging.cosine[i], p.cogging.sine[i]));
        }
        return {{"cogging_period_m", {p.cogging.period}}, n, phase};
    },
    .join = [](plant_model& p) { p.cogging.harmonics = 3; }};

} // namespace quadrant::diagnosis::suspect
