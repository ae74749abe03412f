// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "values.hpp"

/// Lost motion reversal by reversal, and how it differs along the travel.
namespace quadrant::inline v0::diagnosis::chain {

/// What one reversal lost, and where.
struct one_reversal {
    double at = 0, lost = 0; ///< [m]
};

/// Each change of the side in contact: the step of the difference over it, from the rows nearest to it, half of
/// a stroke at most.
inline std::vector<one_reversal> lost_by_reversal(const readings& r, const fitted& f) {
    struct stroke {
        std::size_t from, to; // of the rows that count
        double side;
    };
    const auto driven = f.model.follows(r.first(), r.of().period);
    const auto offset = r.offset(f.model, driven, f.model.play);
    const double half = f.model.play / 2;
    std::vector<stroke> strokes;
    for (std::size_t i = 0; i < r.rows().size(); ++i) {
        const double o = offset[r.rows()[i]];
        if (std::abs(o) < 0.98 * half) continue;
        const double side = o > 0 ? 1 : -1;
        if (strokes.empty() || strokes.back().side != side) strokes.push_back({i, i, side});
        strokes.back().to = i;
    }
    const auto mean = [&](std::size_t from, std::size_t to) {
        double sum = 0;
        for (std::size_t i = from; i <= to; ++i)
            sum += f.left[static_cast<Eigen::Index>(i)] + offset[r.rows()[i]];
        return sum / static_cast<double>(to - from + 1);
    };
    std::vector<one_reversal> out;
    for (std::size_t s = 0; s + 1 < strokes.size(); ++s) {
        const stroke &a = strokes[s], &b = strokes[s + 1];
        if (a.to - a.from < 6 || b.to - b.from < 6) continue;
        const double before = mean((a.from + a.to) / 2, a.to), behind = mean(b.from, (b.from + b.to) / 2);
        out.push_back({driven[r.rows()[b.from]], (behind - before) * b.side});
    }
    return out;
}

/// Places of the report: the sizes over all reversals, and the ends of the travel where they differ.
inline std::vector<place> places_of_reversals(const readings& r, const fitted& f, double share) {
    const auto each = lost_by_reversal(r, f);
    if (each.size() < 2) return {};
    double low = each[0].lost, high = low, first = each[0].at, last = first;
    std::vector<double> at, lost;
    for (const one_reversal& x : each) {
        low = std::min(low, x.lost);
        high = std::max(high, x.lost);
        first = std::min(first, x.at);
        last = std::max(last, x.at);
        at.push_back(x.at);
        lost.push_back(x.lost);
    }
    std::vector<place> out{
        {"reversal",
         "",
         fmt::format("lost motion of {} reversals: {:.3g} to {:.3g} um, {:.3g} um in the middle", each.size(),
                     1e6 * low, 1e6 * high, 1e6 * quantile(lost, 0.5)),
         {share, share, share},
         ""}};
    if (each.size() < 6 || !(last - first > 0.2 * r.travel())) return out;
    const double by = slope(at, lost), n = static_cast<double>(each.size());
    double mean_at = 0, mean_lost = 0, xx = 0, rest = 0;
    for (std::size_t i = 0; i < each.size(); ++i) mean_at += at[i] / n, mean_lost += lost[i] / n;
    for (std::size_t i = 0; i < each.size(); ++i) {
        const double e = lost[i] - mean_lost - by * (at[i] - mean_at);
        xx += (at[i] - mean_at) * (at[i] - mean_at);
        rest += e * e;
    }
    const double error = std::sqrt(rest / (n - 2) / xx), ends = std::abs(by) * (last - first);
    if (std::abs(by) > 4 * error && ends > std::max(r.of().count(), 0.1 * std::abs(mean_lost)))
        out.push_back(
            {"position",
             "",
             fmt::format("lost motion differs along the travel: {:.3g} um at {:.4g} m, {:.3g} um at {:.4g} m",
                         1e6 * (mean_lost + by * (first - mean_at)), first,
                         1e6 * (mean_lost + by * (last - mean_at)), last),
             {share, share, share},
             ""});
    return out;
}

} // namespace quadrant::inline v0::diagnosis::chain
