// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace quadrant_gap::trial {

/// What a probability said should have been: logit(true) = offset + slope logit(said) [Cox1958]. Slope 1 and
/// offset 0: calibrated.
/// Slope below 1: too sure of itself. A positive offset: too modest on the whole.
struct recalibration {
    double slope = 1, offset = 0;
    std::pair<double, double> slope_95{}, offset_95{};
};

/// The most probable line with a normal prior of width 1 about (1, 0), which keeps it finite when everything
/// was right; intervals from the curvature there. Newton's iteration with halved steps; the objective is
/// convex.
inline recalibration recalibrate(const std::vector<std::pair<double, bool>>& said) {
    const auto logit = [](double p) {
        const double safe = std::clamp(p, 1e-6, 1 - 1e-6);
        return std::log(safe / (1 - safe));
    };
    const auto cost = [&](double offset, double slope) { // negative log posterior
        double sum = 0.5 * (offset * offset + (slope - 1) * (slope - 1));
        for (const auto& [p, right] : said)
            sum += std::log1p(std::exp((right ? -1 : 1) * (offset + slope * logit(p))));
        return sum;
    };
    recalibration r;
    for (int round = 0;; ++round) {
        double ga = r.offset, gb = r.slope - 1, aa = 1, ab = 0,
               bb = 1; // gradient and curvature; a: offset, b: slope
        for (const auto& [p, right] : said) {
            const double x = logit(p), q = 1 / (1 + std::exp(-r.offset - r.slope * x)), w = q * (1 - q);
            ga += q - right, gb += (q - right) * x;
            aa += w, ab += w * x, bb += w * x * x;
        }
        const double det = aa * bb - ab * ab, of_offset = (bb * ga - ab * gb) / det,
                     of_slope = (aa * gb - ab * ga) / det, here = cost(r.offset, r.slope);
        double part = 1;
        while (part > 1e-9 && cost(r.offset - part * of_offset, r.slope - part * of_slope) > here) part /= 2;
        r.offset -= part * of_offset;
        r.slope -= part * of_slope;
        if (round == 50 || std::hypot(of_offset, of_slope) < 1e-9) {
            const double slope_95 = 1.96 * std::sqrt(aa / det), offset_95 = 1.96 * std::sqrt(bb / det);
            r.slope_95 = {r.slope - slope_95, r.slope + slope_95};
            r.offset_95 = {r.offset - offset_95, r.offset + offset_95};
            return r;
        }
    }
}

} // namespace quadrant_gap::trial
