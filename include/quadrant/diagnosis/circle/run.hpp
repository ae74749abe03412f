// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

/// Runs along a circle at constant feed: what the ball-bar diagnosis is made from. All values SI, angles in
/// radians.
namespace quadrant::inline v0::diagnosis {

/// What measured the radius. An encoder sees no error that lies behind it.
enum class circle_source { encoder, instrument };

/// Whole turns one way round. Sample k was taken at start_s + k period_s of its file.
struct circle_run {
    std::string file;
    std::size_t log = 0; ///< runs of one file share its number: one set-up, one centre
    circle_source source = circle_source::encoder;
    double start_s = 0, period_s = 0;
    double radius = 0, feed = 0; ///< nominal; the feed along the circle [m/s]
    bool counterclockwise = true;
    std::size_t turns = 0;
    double resolution = 0; ///< step in which the radius was written or counted; 0: not known
    std::vector<double>
        angle; ///< of the point where the machine was, from x towards y, about the nominal centre; unwrapped
    std::vector<double> deviation; ///< its distance from the nominal centre minus the nominal radius
    int turning() const { return counterclockwise ? 1 : -1; }
};

namespace detail {

inline constexpr double two_pi = 2 * std::numbers::pi;

/// The angle that is nearest to `last` among those that look like `angle`.
inline double unwrapped(double angle, double last) { return last + std::remainder(angle - last, two_pi); }

/// Samples [first, last) of a path, and the circle that it follows there.
struct followed_circle {
    std::size_t first = 0, last = 0;
    double x = 0, y = 0, radius = 0;
    double turned = 0; ///< signed
};

/// Least squares of |p - c|^2 = r^2, linear in c and r^2 - |c|^2; about the mean, so nothing cancels.
inline followed_circle circle_through(const std::vector<double>& x, const std::vector<double>& y,
                                      std::size_t first, std::size_t last) {
    const auto n = double(last - first);
    double mx = 0, my = 0;
    for (std::size_t k = first; k < last; ++k) mx += x[k] / n, my += y[k] / n;
    double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0, rr = 0;
    for (std::size_t k = first; k < last; ++k) {
        const double u = x[k] - mx, v = y[k] - my, w = u * u + v * v;
        xx += u * u, xy += u * v, yy += v * v, xr += u * w, yr += v * w, rr += w;
    }
    const double det = 2 * (xx * yy - xy * xy), a = (xr * yy - yr * xy) / det, b = (yr * xx - xr * xy) / det;
    return {first, last, mx + a, my + b, std::sqrt(rr / n + a * a + b * b), 0};
}

/// How far the path turns about the circle's centre from its first to its last sample.
inline double turned(const std::vector<double>& x, const std::vector<double>& y, const followed_circle& c) {
    double angle = std::atan2(y[c.first] - c.y, x[c.first] - c.x);
    const double begin = angle;
    for (std::size_t k = c.first; k < c.last; ++k) angle = unwrapped(std::atan2(y[k] - c.y, x[k] - c.x), angle);
    return angle - begin;
}

/// The first sample from which on what was turned is whole turns, so that a run in is left out; 0 turns when
/// there is not one.
inline std::size_t cut_to_whole_turns(std::vector<double>& angle, std::size_t& turns) {
    const double step =
        angle.size() < 2 ? 0 : std::abs(angle.back() - angle.front()) / double(angle.size() - 1);
    const double whole = std::abs(angle.back() - angle.front()) + step;
    turns = static_cast<std::size_t>(std::floor(whole / two_pi + 0.003)); // a degree short is a turn
    if (turns == 0) return 0;
    std::size_t first = 0;
    while (std::abs(angle.back() - angle[first]) + step > double(turns) * two_pi) ++first;
    return first;
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
