// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// What the stamps of a log say: the period of its rows, how far the stamps depart from an even clock, and
/// where rows are missing.
struct row_clock {
    double period = 0; ///< [s]
    double jitter = 0; ///< half the range of the stamps about an even clock, in periods; gaps are counted out
    double spread = 0; ///< largest departure of one step from the period, in periods, outside the gaps
    std::size_t gaps = 0;                   ///< places where rows are missing
    std::size_t missing = 0;                ///< rows that are missing there
    double longest_gap = 0;                 ///< [s]
    std::size_t worst_step = 0;             ///< row whose step departs most
    bool even = false;                      ///< each row can stand for its sample as it is
    std::vector<std::size_t> slot{};        ///< of every row on the even clock, the missing ones counted
    std::vector<unsigned char> after_gap{}; ///< of every row: 1 where rows are missing before it
};

/// Stamps within this share of the period of their instants need no resampling.
inline constexpr double even_enough = 0.2 + 0.01; // the line through the stamps is itself an estimate

/// The mean of the middle half.
inline double middle_half(std::vector<double> x) {
    std::sort(x.begin(), x.end());
    const std::size_t from = x.size() / 4, to = x.size() - from;
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += x[i];
    return sum / static_cast<double>(to - from);
}

/// The step that a quarter of them do not reach.
inline double lower_quarter(std::vector<double> steps) {
    const auto at = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
    std::nth_element(steps.begin(), at, steps.end());
    return *at;
}

/// Whether all steps are whole multiples of the lower quarter's: rows of an even clock of which many may be
/// missing.
inline bool on_a_grid(const std::vector<double>& steps) {
    const double base = lower_quarter(steps);
    return base > 0 && std::all_of(steps.begin(), steps.end(), [&](double step) {
               const double rows = std::round(step / base);
               return rows >= 1 && std::abs(step / base - rows) <= even_enough;
           });
}

/// What a usual step is around each step: the mean of the middle half of the steps there, which neither gaps
/// nor stamps that are early and late in turns disturb. A log may change its rate.
inline std::vector<double> usual_steps(std::span<const double> steps) {
    constexpr std::size_t each_way = 12;
    std::vector<double> out(steps.size()), near;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const std::size_t first = k > each_way ? k - each_way : 0,
                          last = std::min(steps.size(), k + each_way + 1);
        near.assign(steps.begin() + static_cast<std::ptrdiff_t>(first),
                    steps.begin() + static_cast<std::ptrdiff_t>(last));
        out[k] = middle_half(near);
    }
    return out;
}

/// Fits the even clock t = offset + period slot to the stamps, with one offset for each stretch between gaps (a
/// recorder that paused begins anew), and measures what departs from it. Least squares, because the jitter of
/// the two ends would weigh on the plain mean.
inline void fit_clock(std::span<const double> t, row_clock& out) {
    const std::size_t n = t.size();
    const auto each_stretch = [&](auto use) {
        for (std::size_t first = 0; first < n;) {
            std::size_t last = first + 1;
            while (last < n && !out.after_gap[last]) ++last;
            use(first, last);
            first = last;
        }
    };
    double product = 0, square = 0;
    std::vector<double> mean_of_t(n), mean_of_slot(n);
    each_stretch([&](std::size_t first, std::size_t last) {
        double time = 0, slot = 0;
        const auto rows = static_cast<double>(last - first);
        for (std::size_t k = first; k < last; ++k) {
            time += (t[k] - t[first]) / rows;
            slot += static_cast<double>(out.slot[k] - out.slot[first]) / rows;
        }
        for (std::size_t k = first; k < last; ++k) {
            mean_of_t[k] = t[first] + time;
            mean_of_slot[k] = static_cast<double>(out.slot[first]) + slot;
            const double along = static_cast<double>(out.slot[k]) - mean_of_slot[k];
            product += along * (t[k] - mean_of_t[k]);
            square += along * along;
        }
    });
    if (square > 0) out.period = product / square;
    out.jitter = 0;
    each_stretch([&](std::size_t first, std::size_t last) {
        double low = 0, high = 0;
        for (std::size_t k = first; k < last; ++k) {
            const double off =
                (t[k] - mean_of_t[k]) / out.period - (static_cast<double>(out.slot[k]) - mean_of_slot[k]);
            low = std::min(low, off);
            high = std::max(high, off);
        }
        out.jitter = std::max(out.jitter, 0.5 * (high - low));
    });
}

/// Whether stamps whose last digit is the period itself leave rows out: a clock that is off by a row in a
/// thousand would be none, so that a few double steps are rows that are missing.
inline bool leaves_rows_out(std::span<const double> steps, double period, double written) {
    if (!(written > 0) || std::abs(period / written - 1) > 0.01) return false;
    const auto longer = std::count_if(steps.begin(), steps.end(), [&](double s) { return s > 1.5 * period; });
    return longer > 0 && static_cast<std::size_t>(longer) <= 1 + steps.size() / 1000;
}

/// Reads the clock of stamps that never go back. `written`: last digit of the stamps [s]; coarsely written
/// stamps jitter by half of it and are none the worse.
inline row_clock clock_of_rows(std::span<const double> t, double written = 0) {
    const std::size_t n = t.size();
    row_clock out;
    out.after_gap.assign(n, 0);
    out.slot.resize(n);
    for (std::size_t k = 0; k < n; ++k) out.slot[k] = k;
    std::vector<double> steps(n - 1);
    for (std::size_t k = 1; k < n; ++k) steps[k - 1] = t[k] - t[k - 1];
    auto sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    out.period = *middle > 0 ? *middle : (t[n - 1] - t[0]) / static_cast<double>(n - 1);
    const auto measure_spread = [&] {
        for (std::size_t k = 1; k < n; ++k)
            if (const double off = std::abs(steps[k - 1] / out.period - 1);
                !out.after_gap[k] && off > out.spread)
                out.spread = off, out.worst_step = k;
    };
    const bool out_of_step = leaves_rows_out(steps, out.period, written);
    fit_clock(t, out);
    const double coarse = 0.5 * written / out.period;
    if (out.jitter <= even_enough || (out.jitter <= coarse + 0.01 && !out_of_step)) {
        measure_spread();
        out.even = true;
        return out;
    }
    const auto usual =
        on_a_grid(steps) ? std::vector<double>(steps.size(), lower_quarter(steps)) : usual_steps(steps);
    const double usual_everywhere = middle_half(usual);
    for (std::size_t k = 1; k < n; ++k) // jitter makes steps of 0.6 T to 1.4 T, a lost row at least 1.6 T
        if (steps[k - 1] > 1.5 * usual[k - 1]) {
            out.after_gap[k] = 1;
            ++out.gaps;
            out.longest_gap = std::max(out.longest_gap, steps[k - 1]);
        }
    std::size_t added = 0;
    for (std::size_t k = 1; k < n; ++k) {
        if (out.after_gap[k]) { // a pause longer than the record itself is shortened: it holds nothing
            const double rows = std::round(steps[k - 1] / usual_everywhere) - 1;
            const auto lost = static_cast<std::size_t>(std::max(1.0, std::min(rows, 1e15)));
            out.missing += lost;
            added += std::min(lost, 1 + n / out.gaps);
        }
        out.slot[k] = k + added;
    }
    fit_clock(t, out);
    out.even = out.jitter <= std::max(even_enough, coarse + 0.01);
    if (!out.even)
        out.period = middle_half(steps); // the clock wanders: what a usual step is, not how far it came
    measure_spread();
    return out;
}

/// Why stamps have no clock of a period above zero.
inline constexpr const char* stamps_too_coarse = "t_s: several rows have each stamp, and rows are missing: "
                                                 "such stamps do not say where; record them with more "
                                                 "digits";

/// The rows of stamps that never go back without those that stand twice: a row whose stamp is that of the row
/// before. Stamps that are written too coarsely to differ are equal where none stands twice: then all rows are
/// on an even clock, or many stamps are equal.
inline std::vector<std::size_t> rows_once(std::span<const double> t, double written) {
    constexpr double few = 0.05; // share of the rows that stand twice
    std::vector<std::size_t> all, once;
    std::vector<double> stamps;
    for (std::size_t k = 0; k < t.size(); ++k) {
        all.push_back(k);
        if (!once.empty() && !(t[k] > t[once.back()])) continue;
        once.push_back(k);
        stamps.push_back(t[k]);
    }
    const bool coarse = t.size() > 1 && written * static_cast<double>(t.size() - 1) > t.back() - t.front();
    if (!coarse || once.size() == all.size()) return once;
    const bool rarely = static_cast<double>(all.size() - once.size()) < few * static_cast<double>(all.size());
    const bool twice =
        rarely && stamps.size() > 2 && !clock_of_rows(t, written).even && clock_of_rows(stamps, written).even;
    return twice ? once : all;
}

} // namespace quadrant::inline v0::diagnosis::detail
