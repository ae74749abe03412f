// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/literals.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/loop/feed_control.hpp>
#include <quadrant/loop/feed_drive.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

/// The machine of [Yeung2006]: Tables of section 4, X and Y, their control laws, and the paths of section 4.2.
namespace vcnc {

using namespace quadrant;
using namespace quadrant::literals;

inline constexpr duration period = duration::from_value(1e-3);
inline const quantity<si::electric_potential> command_limit = 5_V, dac_step = 20.0 / 65536 * 1_V;

/// One axis as printed.
struct axis {
    const char* name;
    double amplifier, inertia, viscous; ///< Ka [A/V], J [kg m^2], B [N m s/rad]
    struct direction {
        double static_level, coulomb, fall, rise; ///< [N m], [N m], [rad/s], [rad/s]
    } forward, backward;
};
inline constexpr axis x_axis{
    "x", 6.4898, 0.0077736, 0.019811, {2.6256, 2.1529, 3.88, 4.20}, {1.8672, 1.4730, 3.51, 3.52}},
    y_axis{"y", 7.5768, 0.0098109, 0.028438, {2.7658, 2.5228, 2.37, 3.01}, {2.4520, 2.3887, 4.41, 4.20}};

using machine_boxes = feed_drive_boxes<>;
/// `play` is the table's backlash; the figures of the reference computation are without.
inline machine_boxes::parameters drive(const axis& a, quantity<si::length> play = 0_m, std::uint64_t seed = 1) {
    const auto side = [](const axis::direction& d) {
        return asymmetric_stribeck<>::side{d.static_level * 1_Nm, d.coulomb * 1_Nm, d.fall * 1_radps,
                                           d.rise * 1_radps};
    };
    machine_boxes::parameters p{.amplifier = a.amplifier * 1_A / 1_V,
                                .drive = {.inertia = a.inertia * 1_kgm2,
                                          .viscous = a.viscous * 1_Nm / 1_radps,
                                          .torque_constant = 0.4769 * 1_Nm / 1_A,
                                          .pitch = 10_mm,
                                          .friction = {side(a.forward), side(a.backward)}}};
    p.backlash = play;
    p.encoder_step = 1.22_um;
    p.tachometer_noise = std::sqrt(0.050) * 10.0 / (2 * std::numbers::pi) * 1_mmps;
    p.seed = seed;
    return p;
}
inline axis_model<signal::voltage> model(const axis& a) { return model_of(machine_boxes(drive(a), period)); }

/// Table 10. One set of gains for both axes; the sliding mode law knows each axis' inertia and viscous
/// friction.
inline pid<>::parameters pid_of(const axis&) {
    return {
        .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};
}
inline sliding_mode<>::parameters sliding_mode_of(const axis& a) {
    return {.plant = model(a), .sliding = 200.0 / 1_s, .gain = 300_V / 1_mps, .adaptation = 30e3 * 1_V / 1_m};
}

/// Feed along a path of one piece, from rest to rest: trapezoidal acceleration, the same at both ends.
struct feed_profile {
    double length;                                         ///< [m], long enough to reach the feed
    double feed = 0.2, acceleration = 2, jerk = 50;        ///< [m/s], [m/s^2], [m/s^3]
    double rise = acceleration / jerk;                     ///< [s], of the acceleration
    double start = feed / acceleration + rise;             ///< [s], until the feed is reached
    double cruise = (length - feed * start) / feed;        ///< [s]
    double duration() const { return 2 * start + cruise; } ///< [s]

    struct motion {
        double s, v, a;
    };
    motion at(double t) const {
        if (t > duration() / 2) { // the same backwards
            const motion m = at(std::max(duration() - t, 0.0));
            return {length - m.s, m.v, -m.a};
        }
        if (t <= rise) return {jerk * t * t * t / 6, jerk * t * t / 2, jerk * t};
        const double v1 = jerk * rise * rise / 2, s1 = v1 * rise / 3, left = start - t;
        if (left >= rise) {
            const double since = t - rise;
            return {s1 + v1 * since + acceleration * since * since / 2, v1 + acceleration * since,
                    acceleration};
        }
        const double to_go = std::max(left, 0.0);
        return {feed * start / 2 + feed * (t - start) + jerk * to_go * to_go * to_go / 6,
                feed - jerk * to_go * to_go / 2, jerk * to_go};
    }
};

/// What both axes are asked at one sample.
struct asked {
    axis_motion<> x, y;
};

/// A square of 50 mm on its corner, counterclockwise from its lowest corner, each side from rest to rest, no
/// dwell.
struct diamond {
    static constexpr double side = 0.05;
    static constexpr int samples_of_side = 390;
    static constexpr int samples() { return 4 * samples_of_side + 1; }
    static std::array<double, 2> corner(int i) {
        const double angle = std::numbers::pi / 2 * (i - 1), r = side * std::numbers::sqrt2 / 2;
        return {r * std::cos(angle), r * std::sin(angle)};
    }
    static int side_at(int k) { return std::min(k / samples_of_side, 3); }
    static asked at(int k) {
        const int i = side_at(k);
        const auto m = feed_profile{side}.at((k - i * samples_of_side) * period.value());
        const auto [x0, y0] = corner(i);
        const auto [x1, y1] = corner(i + 1);
        const double ux = (x1 - x0) / side, uy = (y1 - y0) / side;
        return {{(x0 + ux * m.s) * 1_m, ux * m.v * 1_mps, ux * m.a * 1_mps2},
                {(y0 + uy * m.s) * 1_m, uy * m.v * 1_mps, uy * m.a * 1_mps2}};
    }
    /// To the line through the side that is under way.
    static double off_the_side(int k, double x, double y) {
        const auto [x0, y0] = corner(side_at(k));
        const auto [x1, y1] = corner(side_at(k) + 1);
        return std::abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / side;
    }
    /// To the nearest place of the path.
    static double off_the_path(double x, double y) {
        double least = HUGE_VAL;
        for (int i = 0; i < 4; ++i) {
            const auto [x0, y0] = corner(i);
            const auto [x1, y1] = corner(i + 1);
            const double share =
                std::clamp(((x1 - x0) * (x - x0) + (y1 - y0) * (y - y0)) / (side * side), 0.0, 1.0);
            least = std::min(least, std::hypot(x - x0 - share * (x1 - x0), y - y0 - share * (y1 - y0)));
        }
        return least;
    }
};

/// Radius 50 mm, counterclockwise from 90 degrees, one turn from rest to rest.
struct circle {
    static constexpr double radius = 0.05, first = std::numbers::pi / 2;
    static constexpr feed_profile feed{2 * std::numbers::pi * radius};
    static int samples() { return static_cast<int>(std::ceil(feed.duration() / period.value())) + 1; }
    static asked at(int k) {
        const auto m = feed.at(std::min(k * period.value(), feed.duration()));
        const double angle = first + m.s / radius, w = m.v / radius, gain = m.a / radius;
        const double cs = radius * std::cos(angle), sn = radius * std::sin(angle);
        return {{cs * 1_m, -sn * w * 1_mps, (-cs * w * w - sn * gain) * 1_mps2},
                {sn * 1_m, cs * w * 1_mps, (-sn * w * w + cs * gain) * 1_mps2}};
    }
    static double off_the_path(double x, double y) { return std::abs(std::hypot(x, y) - radius); }
};

/// One axis of the machine under any control law.
template <class Law, class Boxes = machine_boxes> class servo {
public:
    servo(const typename Boxes::parameters& machine, const typename Law::parameters& law)
        : drive_{.box = {machine, period}},
          control_{.box = {{.law = law, .limit = command_limit, .dac_step = dac_step}, period}} {}
    servo(const axis& a, const typename Law::parameters& law, quantity<si::length> play, std::uint64_t seed)
        : servo(drive(a, play, seed), law) {}
    void settle(quantity<si::length> at) {
        drive_.settle(at);
        control_.settle(at);
    }
    void step(const axis_motion<>& reference) { drive_(control_(reference, drive_.measured())); }
    double place() const { return drive_.wire.place.value(); } ///< of the table [m]
    const auto& control() const { return control_; }

private:
    feed_drive<Boxes> drive_;
    feed_control<feed_control_boxes<Law>> control_;
};

} // namespace vcnc
