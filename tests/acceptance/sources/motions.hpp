// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant_reproduce/virtual_cnc.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

/// The motions of the sources, from rest, as functions of time.
namespace sources {

/// What both axes are asked to do, and for how long.
struct motion {
    std::string name;
    double lasts; ///< [s]
    std::function<vcnc::asked(double)> at;
};

inline quadrant::axis_motion<> moving(double x, double v, double a) {
    using namespace quadrant::literals;
    return {x * 1_m, v * 1_mps, a * 1_mps2};
}

/// 30 mm to either side of the middle [Jamaludin2008] section 4.2; both axes at once.
inline motion sinusoid(std::string name, double peak_speed, double cycles) {
    constexpr double amplitude = 0.03;
    const double w = peak_speed / amplitude;
    return {std::move(name), cycles * 2 * std::numbers::pi / w, [=](double t) {
                const auto one = moving(amplitude * (1 - std::cos(w * t)), amplitude * w * std::sin(w * t),
                                        amplitude * w * w * std::cos(w * t));
                return vcnc::asked{one, one};
            }};
}

/// Circles of 30 mm at 100 mm/s with the run-in of examples/programs/quadrant_reproduce/milling_table.hpp.
inline motion table_circle(double turns) {
    constexpr double radius = 0.03, w = 0.1 / radius, start = 0.05;
    return {"circle", turns * 2 * std::numbers::pi / w, [=](double t) {
                const double fade = std::exp(-t / start), angle = w * (t - start * (1 - fade));
                const double speed = w * (1 - fade), gain = w / start * fade;
                const double c = radius * std::cos(angle), s = radius * std::sin(angle);
                return vcnc::asked{moving(c, -s * speed, -s * gain - c * speed * speed),
                                   moving(s, c * speed, c * gain - s * speed * speed)};
            }};
}

/// One turn of 50 mm [Yeung2006] section 4.2.
inline motion cnc_circle() {
    return {"circle", vcnc::circle::feed.duration(), [](double t) {
                constexpr double radius = vcnc::circle::radius;
                const auto m = vcnc::circle::feed.at(t);
                const double angle = vcnc::circle::first + m.s / radius, w = m.v / radius, gain = m.a / radius;
                const double c = radius * std::cos(angle), s = radius * std::sin(angle);
                return vcnc::asked{moving(c, -s * w, -c * w * w - s * gain),
                                   moving(s, c * w, -s * w * w + c * gain)};
            }};
}

/// A square of 50 mm on its corner, each side from rest to rest [Yeung2006] section 4.2.
inline motion diamond() {
    const vcnc::feed_profile side{vcnc::diamond::side};
    return {"diamond", 4 * side.duration(), [side](double t) {
                const int i = std::min(static_cast<int>(t / side.duration()), 3);
                const auto m = side.at(t - i * side.duration());
                const auto [x0, y0] = vcnc::diamond::corner(i);
                const auto [x1, y1] = vcnc::diamond::corner(i + 1);
                const double ux = (x1 - x0) / side.length, uy = (y1 - y0) / side.length;
                return vcnc::asked{moving(x0 + ux * m.s, ux * m.v, ux * m.a),
                                   moving(y0 + uy * m.s, uy * m.v, uy * m.a)};
            }};
}

inline std::vector<motion> motions(const motion& circle) {
    return {sinusoid("sine100", 0.1, 3), sinusoid("sine10", 0.01, 1.5), circle, diamond()};
}

} // namespace sources
