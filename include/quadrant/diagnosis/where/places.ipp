// SPDX-License-Identifier: BSL-1.0
// Long: regimes() asks one regime after the other of the same rows.
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL estimate predicted_share(const std::vector<double>& residual, const axis_record& r,
                                                 const std::vector<int>& bin, int bins,
                                                 const std::vector<std::vector<double>>& draws) {
    const auto n = static_cast<std::size_t>(bins);
    const std::size_t folds = 5, first = r.score.skip;
    std::vector<std::vector<double>> sum(folds, std::vector<double>(n)), count = sum;
    for (std::size_t k = first; k < residual.size(); ++k)
        if (bin[k] >= 0) {
            sum[r.segment[k] % folds][static_cast<std::size_t>(bin[k])] += residual[k];
            count[r.segment[k] % folds][static_cast<std::size_t>(bin[k])] += 1;
        }
    std::vector<double> energy(r.segments, 0.0), left(r.segments, 0.0);
    for (std::size_t k = first; k < residual.size(); ++k) {
        double mean = 0;
        if (bin[k] >= 0) {
            const auto b = static_cast<std::size_t>(bin[k]);
            double s = 0, c = 0;
            for (std::size_t f = 0; f < folds; ++f)
                if (f != r.segment[k] % folds) {
                    s += sum[f][b];
                    c += count[f][b];
                }
            mean = c > 0 ? s / c : 0;
        }
        energy[r.segment[k]] += residual[k] * residual[k];
        left[r.segment[k]] += (residual[k] - mean) * (residual[k] - mean);
    }
    return resampled(draws, r.segments, [&](const std::vector<double>& w) {
        double e = 0, l = 0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            e += w[i] * energy[i];
            l += w[i] * left[i];
        }
        return e > 0 ? std::clamp(1 - l / e, 0.0, 1.0) : 0;
    });
}

QUADRANT_DIAGNOSIS_DECL std::vector<bool> near_reversal(const axis_record& r) {
    const std::size_t width = r.score.block;
    std::vector<bool> out(r.velocity.size(), false);
    for (std::size_t k = 1; k < r.velocity.size(); ++k)
        if (r.velocity[k] * r.velocity[k - 1] < 0)
            for (std::size_t i = k >= width ? k - width : 0; i < std::min(out.size(), k + width); ++i)
                out[i] = true;
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<place> regimes(const std::vector<double>& residual, const axis_record& r) {
    using detail::worded;
    const auto draws = segment_draws(r.segments, 200);
    const std::size_t n = residual.size();
    std::vector<place> out;
    std::vector<int> bin(n, -1);
    const auto binned = [&](const std::vector<double>& x, int bins, auto apart) {
        double low = x[0], high = x[0];
        for (std::size_t k = 0; k < n; ++k) {
            low = std::min(low, x[k]);
            high = std::max(high, x[k]);
        }
        for (std::size_t k = 0; k < n; ++k)
            bin[k] = apart(k) || high <= low
                         ? -1
                         : std::min(bins - 1, static_cast<int>((x[k] - low) / (high - low) * bins));
        return detail::predicted_share(residual, r, bin, bins, draws);
    };
    const auto reversal = detail::near_reversal(r);
    const auto nowhere = [](std::size_t) { return false; };
    const auto at_reversal = [&](std::size_t k) { return static_cast<bool>(reversal[k]); };

    double forward = 0, backward = 0, nf = 0, nb = 0;
    for (std::size_t k = 0; k < n; ++k)
        if (!reversal[k] && r.velocity[k] != 0) {
            (r.velocity[k] > 0 ? forward : backward) += residual[k];
            (r.velocity[k] > 0 ? nf : nb) += 1;
        }
    out.push_back({"velocity", "",
                   worded("follows the velocity, reversals apart: mean %+.2f N forwards, %+.2f N backwards",
                          nf > 0 ? forward / nf : 0, nb > 0 ? backward / nb : 0),
                   binned(r.velocity, 24, at_reversal), ""});
    out.push_back({"reversal", "", worded("within %.2g s of a change of direction", r.scale.block()),
                   detail::share_on(residual, r, draws, at_reversal), ""});
    const std::vector<double> position(r.position.begin(), r.position.end());
    out.push_back(
        {"position", "", "repeats with the position along the travel", binned(position, 100, nowhere), ""});
    out.push_back({"time", "", "in the first half of the record (50 %: no trend)",
                   detail::share_on(residual, r, draws, [&](std::size_t k) { return 2 * k < n; }), ""});
    out.push_back({"acceleration", "", "follows the acceleration", binned(r.acceleration, 24, nowhere), ""});

    // Frequency: energy by band, cut with the zero-phase filter so that the bands add up.
    std::vector<double> rest = residual;
    double lower = 0;
    for (double upper : {r.bandwidth_Hz / 20, r.bandwidth_Hz / 5, r.bandwidth_Hz}) {
        const auto below = upper < r.bandwidth_Hz ? zero_phase(residual, upper, r.period) : residual;
        std::vector<double> energy(r.segments, 0.0), band(r.segments, 0.0);
        for (std::size_t k = r.score.skip; k < n; ++k) {
            energy[r.segment[k]] += residual[k] * residual[k];
            const double v = below[k] - (lower > 0 ? rest[k] : 0);
            band[r.segment[k]] += v * v;
        }
        const auto share = resampled(draws, r.segments, [&](const std::vector<double>& w) {
            double e = 0, b = 0;
            for (std::size_t i = 0; i < w.size(); ++i) {
                e += w[i] * energy[i];
                b += w[i] * band[i];
            }
            return e > 0 ? std::min(1.0, b / e) : 0;
        });
        out.push_back({"frequency", "", worded("between %.3g and %.3g Hz", lower, upper), share, ""});
        rest = below;
        lower = upper;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void spectrum(const std::vector<double>& x, double period, double up_to_Hz,
                                      std::vector<double>& frequency, std::vector<double>& density) {
    frequency.clear();
    density.clear();
    const auto window = std::min(x.size(), static_cast<std::size_t>(100 / (up_to_Hz * period)));
    if (window < 8) return;
    const double weight = 3.0 / 8.0; // mean square of the Hann window
    for (int line = 1; line <= 100; ++line) {
        const double f = up_to_Hz * line / 100;
        double power = 0, count = 0;
        for (std::size_t first = 0; first + window <= x.size(); first += window / 2) {
            double re = 0, im = 0, c = 1, s = 0;
            const double dc = std::cos(2 * std::numbers::pi * f * period),
                         ds = std::sin(2 * std::numbers::pi * f * period);
            double hc = 1, hs = 0;
            const double wc = std::cos(2 * std::numbers::pi / static_cast<double>(window)),
                         ws = std::sin(2 * std::numbers::pi / static_cast<double>(window));
            for (std::size_t i = 0; i < window; ++i) {
                const double v = x[first + i] * 0.5 * (1 - hc);
                re += v * c;
                im += v * s;
                const double nc = c * dc - s * ds;
                s = c * ds + s * dc;
                c = nc;
                const double nh = hc * wc - hs * ws;
                hs = hc * ws + hs * wc;
                hc = nh;
            }
            power += 2 * period * (re * re + im * im) / (weight * static_cast<double>(window));
            count += 1;
        }
        frequency.push_back(f);
        density.push_back(std::sqrt(power / count));
    }
}

} // namespace quadrant::inline v0::diagnosis
