// SPDX-License-Identifier: BSL-1.0
// Long: circular_test() is one pass over the turns, figure by figure of ISO 230-4.
#pragma once
#include "circle_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrant::inline v0::analysis {

/// What the axis that reverses leaves in the circle.
struct reversal_spike {
    double angle; ///< of the reversal, 0, 90, 180 or 270 degrees; x reverses at 0 and 180, y at 90 and 270
    displacement height; ///< at the peak, above the smooth part of the circle; outward positive
    duration width;      ///< between the two half heights
    duration offset;     ///< of the peak from the reversal; above 0: after it
    bool visible;        ///< height above four times the rms of what is left elsewhere
};

/// What ISO 230-4 asks of one run along a circle, and the spikes at the reversals beside it.
struct circular_result {
    bool counterclockwise;
    circle fitted;                       ///< least squares
    displacement circular_error;         ///< G: range of the radius about the centre of least range
    displacement circular_error_fitted;  ///< the same about the least-squares centre; never less
    displacement radial_max, radial_min; ///< F: deviation from the nominal radius, about the centre asked for
    displacement radial_rms;             ///< about the same centre
    std::vector<reversal_spike> spikes;  ///< one for each reversal inside the turn, in the order of travel
    displacement noise;                  ///< rms of what is neither smooth nor a spike
    std::vector<double> angle;           ///< [deg], 0 ... 360, and
    std::vector<displacement>
        deviation; ///< from the nominal radius, of every sample of the turn: the polar picture
};

/// The circle that was asked for, and how a run is compared with it.
struct circular_options {
    circle nominal;             ///< as commanded; radius > 0
    bool fitted_centre = false; ///< radial deviation about the least-squares centre instead of the nominal one
    double search = 25; ///< degrees on either side of a reversal in which its spike is looked for; 1 ... 40
};

/// Circular test from feedback signals after ISO 230-4 (its annex on feedback): one run, one turn, no
/// compensation of set-up or temperature; the encoders see neither squareness nor anything behind them.
///   G  circular error: least distance of two concentric circles that hold the path
///   F  radial deviation: path minus nominal radius, positive outwards
///   spike: deviation at a reversal minus its smooth part, harmonics 0 to 2 of the turn fitted away from reversals
/// Throws when the run is no full turn, leaves the circle by a fifth of the radius, or turns back.
inline circular_result circular_test(const circular_path& path, const circular_options& options) {
    require(options.search >= 1 && options.search <= 40, "circular_options.search",
            quadrant::detail::in_unit(options.search, " degrees"), "must lie between 1 and 40 degrees");
    const auto turn = detail::one_turn(path, options.nominal);
    const std::size_t n = turn.x.size();
    const circle& nominal = options.nominal;
    const auto best =
        detail::fit_circle(turn.x, turn.y, {nominal.x.value(), nominal.y.value(), nominal.radius.value()});
    const auto metres = [](double v) { return displacement::from_value(v); };
    circular_result out{};
    out.counterclockwise = turn.counterclockwise;
    out.fitted = {metres(best[0]), metres(best[1]), metres(best[2])};
    out.circular_error_fitted = metres(detail::range_about(turn.x, turn.y, best[0], best[1]));
    out.circular_error = metres(detail::least_range(turn.x, turn.y, best[0], best[1]));

    const double cx = options.fitted_centre ? best[0] : nominal.x.value(),
                 cy = options.fitted_centre ? best[1] : nominal.y.value();
    std::vector<double> deviation(n);
    double low = HUGE_VAL, high = -HUGE_VAL, squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
        deviation[i] = std::hypot(turn.x[i] - cx, turn.y[i] - cy) - nominal.radius.value();
        low = std::min(low, deviation[i]), high = std::max(high, deviation[i]);
        squares += deviation[i] * deviation[i] / double(n);
        out.angle.push_back(detail::turn_degrees(turn.y[i] - cy, turn.x[i] - cx));
        out.deviation.push_back(metres(deviation[i]));
    }
    out.radial_max = metres(high), out.radial_min = metres(low), out.radial_rms = metres(std::sqrt(squares));

    // The smooth part, and what stands out of it.
    const auto to_reversal = [](double angle) { return angle - 90 * std::round(angle / 90); };
    const auto harmonics = [](double angle) {
        const double a = angle * std::numbers::pi / 180;
        return std::vector<double>{1, std::cos(a), std::sin(a), std::cos(2 * a), std::sin(2 * a)};
    };
    least_squares equations(5);
    for (std::size_t i = 0; i < n; ++i)
        if (std::abs(to_reversal(turn.angle[i])) > options.search)
            equations.add(harmonics(turn.angle[i]), deviation[i]);
    const auto smooth = equations.solve().x;
    double noise = 0, counted = 0;
    std::vector<double> left(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto h = harmonics(turn.angle[i]);
        left[i] = deviation[i];
        for (std::size_t j = 0; j < h.size(); ++j) left[i] -= smooth[j] * h[j];
        if (std::abs(to_reversal(turn.angle[i])) > options.search) noise += left[i] * left[i], ++counted;
    }
    noise = std::sqrt(noise / counted);
    out.noise = metres(noise);
    double known = HUGE_VAL;
    for (std::size_t i = 1; i < n; ++i) { // where the angle passes a multiple of 90 degrees
        const double before = to_reversal(turn.angle[i - 1]), after = to_reversal(turn.angle[i]);
        const double reversal = 90 * std::round(turn.angle[i] / 90);
        if (before == 0 || before * after > 0 || std::abs(before - after) > 45 || reversal == known) continue;
        known = reversal; // once, though the angle may jitter around it
        const double crossing = double(i - 1) + before / (before - after); // in samples
        std::size_t first = i, last = i - 1;
        while (first > 0 && std::abs(to_reversal(turn.angle[first - 1])) <= options.search && i - first < n / 4)
            --first;
        while (last + 1 < n && std::abs(to_reversal(turn.angle[last + 1])) <= options.search &&
               last - i + 1 < n / 4)
            ++last;
        std::size_t peak = first;
        for (std::size_t k = first; k <= last; ++k)
            if (std::abs(left[k]) > std::abs(left[peak])) peak = k;
        const double half = 0.5 * left[peak];
        const auto above = [&](std::size_t k) { return left[k] / half >= 1; };
        const auto edge = [&](std::size_t inside, std::size_t outside) { // in samples, interpolated
            return double(inside) +
                   (double(outside) - double(inside)) * (left[inside] - half) / (left[inside] - left[outside]);
        };
        std::size_t rise = peak, fall = peak;
        while (rise > first && above(rise)) --rise;
        while (fall < last && above(fall)) ++fall;
        const double width = (above(fall) ? double(fall) : edge(fall - 1, fall)) -
                             (above(rise) ? double(rise) : edge(rise + 1, rise));
        out.spikes.push_back({reversal - 360 * std::floor(reversal / 360), metres(left[peak]),
                              half == 0 ? duration() : width * path.period,
                              (double(peak) - crossing) * path.period, std::abs(left[peak]) > 4 * noise});
    }
    return out;
}

/// G(b), bidirectional circular error: least distance of two concentric circles that hold both runs, one each
/// way round.
inline displacement bidirectional_error(const circular_path& one, const circular_path& other,
                                        const circle& nominal) {
    auto both = detail::one_turn(one, nominal);
    const auto back = detail::one_turn(other, nominal);
    require(both.counterclockwise != back.counterclockwise, "bidirectional_error, runs counterclockwise",
            both.counterclockwise ? 2.0 : 0.0, "must be one: the two runs go opposite ways round");
    both.x.insert(both.x.end(), back.x.begin(), back.x.end());
    both.y.insert(both.y.end(), back.y.begin(), back.y.end());
    const auto best =
        detail::fit_circle(both.x, both.y, {nominal.x.value(), nominal.y.value(), nominal.radius.value()});
    return displacement::from_value(detail::least_range(both.x, both.y, best[0], best[1]));
}

} // namespace quadrant::inline v0::analysis
