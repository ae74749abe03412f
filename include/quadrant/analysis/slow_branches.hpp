// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "friction_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::analysis::detail {

/// Friction over the displacement from reversal to reversal: what `find_virgin_curve` is made of.
struct slow_branches {
    double amplitude;                            ///< half the travel [m]
    std::vector<std::vector<double>> way, force; ///< [branch][sample] from the reversal on, halved
    std::vector<std::vector<double>> speed;
};
/// Where x turns by more than `play`.
inline std::vector<std::size_t> turning_points(const std::vector<double>& x, double play) {
    std::vector<std::size_t> out;
    std::size_t top = 0, bottom = 0;
    int way = 0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        if (x[i] > x[top]) top = i;
        if (x[i] < x[bottom]) bottom = i;
        if (way >= 0 && x[i] < x[top] - play) {
            if (way > 0) out.push_back(top);
            way = -1, bottom = i;
        } else if (way <= 0 && x[i] > x[bottom] + play) {
            if (way < 0) out.push_back(bottom);
            way = 1, top = i;
        }
    }
    return out;
}
/// Means over `reach` samples to either side; at the ends over those that are there.
inline std::vector<double> smoothed(const std::vector<double>& raw, std::size_t reach) {
    const std::size_t n = raw.size();
    std::vector<double> sum(n + 1), mean(n);
    for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + raw[i];
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t from = i < reach ? 0 : i - reach, to = std::min(n, i + reach + 1);
        mean[i] = (sum[to] - sum[from]) / double(to - from);
    }
    return mean;
}
/// A run cut at its reversals; smoothed over a 400th of a cycle.
template <signal_tag Command>
slow_branches cut_at_reversals(const test_run<Command>& run, double period, double kf, double mass,
                               double viscous, double count) {
    const std::size_t n = run.position.size();
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = run.position[i].value();
        require(std::isfinite(x) && std::isfinite(run.command[i].value()), "test_run.sample", double(i),
                "must be finite");
        low = std::min(low, x), high = std::max(high, x);
    }
    std::vector<double> x(n), u(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = run.position[i].value(), u[i] = run.command[i].value();
    const double play = 0.5 * (high - low);
    const auto coarse = turning_points(x, play);
    slow_branches out{0.5 * (high - low), {}, {}, {}};
    if (coarse.size() < 2) return out;
    const std::size_t cycle = 2 * (coarse.back() - coarse.front()) / (coarse.size() - 1);
    // At a reversal so long that the axis moves a twentieth of a count in it; on the branches short, for the
    // knots.
    const double share = std::sqrt(0.1 * std::max(count, 1e-4 * play) / play) / (2 * std::numbers::pi);
    const auto half = std::max<std::size_t>(1, std::size_t(std::min(share, 1 / 60.0) * double(cycle)));
    const auto brief = std::max<std::size_t>(1, std::min(half, cycle / 800));
    const std::vector<double> slow = smoothed(x, half);
    const std::size_t edge = 4 * half; // of the record: nothing there
    std::vector<double> resisting(n), speed(n);
    for (std::size_t i = edge; i + edge < n; ++i) {
        const double time = double(2 * half) * period;
        speed[i] = (slow[i + 2 * half] - slow[i - 2 * half]) / (2 * time);
        const double acceleration = (slow[i + 2 * half] - 2 * slow[i] + slow[i - 2 * half]) / (time * time);
        resisting[i] = kf * u[i] - mass * acceleration - viscous * speed[i];
    }
    const std::vector<double> steady = smoothed(resisting, half), force = smoothed(resisting, brief);
    x = smoothed(x, brief);
    auto turns = turning_points(slow, play);
    // At the extreme the encoder stands; there the axis reverses where the friction is largest.
    for (auto& each : turns) {
        const double way = slow[each] > 0.5 * (low + high) ? 1 : -1;
        std::size_t from = each, to = each;
        while (from > edge && std::abs(slow[from - 1] - slow[each]) <= 0.1 * count) --from;
        while (to + 1 + edge < n && std::abs(slow[to + 1] - slow[each]) <= 0.1 * count) ++to;
        for (std::size_t i = from; i <= to; ++i)
            if (way * steady[i] > way * steady[each]) each = i;
    }
    for (std::size_t b = 1; b + 1 < turns.size(); ++b) { // the first closes the loop
        const std::size_t start = turns[b];
        const double way = slow[turns[b + 1]] > slow[start] ? 1 : -1;
        std::vector<double> d, f, v;
        double furthest = -1;
        for (std::size_t i = start; i <= turns[b + 1]; ++i) {
            const double gone = 0.5 * way * (x[i] - slow[start]);
            if (gone <= furthest) continue;
            furthest = gone;
            d.push_back(gone), f.push_back(0.5 * way * (force[i] - steady[start]));
            v.push_back(std::abs(speed[i]));
        }
        out.way.push_back(d), out.force.push_back(f), out.speed.push_back(v);
    }
    return out;
}

} // namespace quadrant::inline v0::analysis::detail
