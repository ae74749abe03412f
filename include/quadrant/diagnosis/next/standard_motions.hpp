// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../where/places.hpp"
#include "motion_writer.hpp"

namespace quadrant::inline v0::diagnosis {

/// What a machine has shown of itself in a log: the next motion asks for no more.
struct shown_motion {
    double start = 0;                      ///< where the log begins [m]
    double low = 0, high = 0;              ///< ends of the travel [m]
    double velocity = 0, acceleration = 0; ///< largest of the reference, smoothed to the corner [m/s], [m/s^2]
};

inline shown_motion shown_by(std::span<const double> reference, double period, double corner_Hz) {
    const auto largest = [](std::vector<double> x) { // a single sample's rounding is no motion
        for (double& v : x) v = std::abs(v);
        return quantile(std::move(x), 0.995);
    };
    const auto velocity = derivative(zero_phase(reference, corner_Hz, period), period);
    const auto [low, high] = std::minmax_element(reference.begin(), reference.end());
    return {reference[0], *low, *high, largest(velocity), largest(derivative(velocity, period))};
}

/// A reference that may be proposed: what it is in words with its numbers, and a position for every sample.
struct planned_motion {
    std::string words;
    std::vector<double> reference; ///< [m]
    bool slips = true; ///< friction slips for most of the time; false: the contact gives way and holds
};

/// Motions that have told effects apart on servo axes, each 3 to 7 units of time long (record_scales::unit()),
/// inside the travel, velocity and acceleration that the log showed. No reversal is smaller than sixty counts.
/// None when the log stands still. The multi-sines ask for frequencies that the log may not have had, and say
/// which.
inline std::vector<planned_motion> standard_motions(const shown_motion& shown, double period,
                                                    const record_scales& scale) {
    using detail::worded;
    const double a = shown.acceleration, travel = shown.high - shown.low, unit = scale.unit();
    const double v = std::min(shown.velocity, 0.25 * unit * a); // ramps of 0.4 units at most
    if (!(travel > 0) || !(v > 0) || !(a > 0)) return {};
    const double up = shown.high - shown.start, down = shown.start - shown.low;
    const double side = up >= down ? 1 : -1, room = std::max(up, down); // strokes go where there is room
    const auto mm = [](double x) { return 1e3 * x; };
    std::vector<planned_motion> out;
    const auto add = [&](std::string words, const detail::motion_writer& m, bool slips = true) {
        out.push_back({std::move(words), m.written(), slips});
    };
    const auto both_ways = [&](detail::motion_writer& m, double length, double speed, double acceleration) {
        m.stroke(side * length, speed, acceleration);
        m.rest(0.1);
        m.stroke(-side * length, speed, acceleration);
        m.rest(0.1);
    };
    const auto reach = [&](double speed, double units) { return std::min(room, speed * units * unit); };
    {
        detail::motion_writer m(shown.start, period, unit);
        const double slow = v / 30, fast = v / 6, l1 = reach(slow, 1.2), l2 = reach(fast, 0.9);
        both_ways(m, l1, slow, a / 4);
        both_ways(m, l2, fast, a / 4);
        add(worded("slow strokes in both directions: %.3g mm at %.3g mm/s and %.3g mm at %.3g mm/s", mm(l1),
                   mm(slow), mm(l2), mm(fast)),
            m);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double creep = v / 200, length = reach(creep, 0.8);
        const double wide = std::min(room / 2, 1800 * scale.give()),
                     narrow = std::min(room / 4, 60 * scale.give());
        const auto frequency = [&](double height) {
            return std::max(0.5 / unit, std::min({2 / unit, v / (std::numbers::pi * height),
                                                  std::sqrt(2 * a / height) / (2 * std::numbers::pi)}));
        };
        both_ways(m, length, creep, a / 4);
        m.swing(side * wide, frequency(wide), 2);
        m.rest(0.3);
        m.swing(side * narrow, frequency(narrow), 2);
        add(worded("creep of %.3g mm in both directions at %.3g mm/s, then slow reversals: swings of %.3g and "
                   "%.3g "
                   "um at %.2g Hz",
                   mm(length), mm(creep), 1e6 * wide, 1e6 * narrow, frequency(wide)),
            m, false);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double slow = v / 15,
                     l1 = std::min({room, 1.2 * v * v / a * std::numbers::pi / 2, 0.4 * unit * v}),
                     l2 = reach(slow, 0.8);
        for (int i = 0; i < 2; ++i) both_ways(m, l1, v, a);
        both_ways(m, l2, slow, a / 4);
        add(worded("strong accelerations beside slow strokes: %.3g mm to and fro twice at %.3g m/s2, then "
                   "%.3g mm in both directions at %.3g mm/s",
                   mm(l1), a, mm(l2), mm(slow)),
            m);
    }
    const detail::multi_sine tones(period, unit);
    const auto [tone_velocity, tone_acceleration] = tones.peaks(2 * unit, period);
    {
        detail::motion_writer m(shown.start, period, unit);
        const double size = std::min(0.8 * a / tone_acceleration, 0.8 * v / tone_velocity);
        m.stroke(side * size * tones.reach(), v / 10, a / 4); // away from the end of the travel
        m.append(5 * unit, [&](double t) { return size * tones.at(t, 5 * unit); });
        add(worded("multi-sine of %.3g to %.3g Hz about one place, peak %.3g m/s2, %.3g s", tones.bottom_Hz,
                   tones.top_Hz, size * tone_acceleration, 5 * unit),
            m, false);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double speed = std::min(v / 3, room / (2 * unit)), length = reach(speed, 2.2);
        const double size = std::min(0.8 * a / tone_acceleration, 0.7 * speed / tone_velocity);
        const auto on_top = [&](double t, double even) {
            return even > 0.4 * unit ? size * tones.at(t, even) : 0;
        };
        m.stroke(side * length, speed, a / 4, on_top);
        m.rest(0.1);
        m.stroke(-side * length, speed, a / 4, on_top);
        add(worded("multi-sine of %.3g to %.3g Hz, peak %.3g m/s2, on strokes of %.3g mm in both directions at "
                   "%.3g mm/s, slow enough for the tones and fast enough not to reverse",
                   tones.bottom_Hz, tones.top_Hz, size * tone_acceleration, mm(length), mm(speed)),
            m);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double length = reach(v, 0.3);
        m.rest(2.5);
        m.stroke(side * length, v / 2, a / 2);
        m.rest(2.3);
        add(worded("rest at two places %.3g mm apart, %.2g s each, with the process as in this log", mm(length),
                   2.5 * unit),
            m, false);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double speed = std::min(v, travel / (1.4 * unit)), length = std::min(travel, 1.4 * unit * speed);
        m.stroke(-side * std::min(up, down), v, a);
        m.rest(0.2);
        m.stroke(side * length, speed, a / 2);
        m.rest(0.3);
        m.stroke(-side * length, speed, a / 2);
        m.rest(0.3);
        add(worded("slow strokes of %.3g mm, the whole travel as far as time allows, in both directions at "
                   "%.3g mm/s, with rest "
                   "at both ends",
                   mm(length), mm(speed)),
            m);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double length = reach(v, 0.45);
        for (double share : {1.0, 0.5, 0.25})
            both_ways(m, std::min(length, 0.7 * unit * share * v), share * v, a);
        add(worded("strokes of up to %.3g mm in both directions at %.3g, %.3g and %.3g mm/s", mm(length), mm(v),
                   mm(v / 2), mm(v / 4)),
            m);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double length = reach(v / 4, 0.4);
        for (int i = 0; i < 5; ++i) {
            m.stroke(side * length, v / 4, a / 2);
            m.stroke(-side * length, v / 4, a / 2);
        }
        add(worded("the same stroke of %.3g mm at %.3g mm/s, five times to and fro", mm(length), mm(v / 4)), m);
    }
    {
        detail::motion_writer m(shown.start, period, unit);
        const double frequency = std::clamp(a / (2 * std::numbers::pi * v), 1.5 / unit, 10 / unit),
                     w = 2 * std::numbers::pi * frequency;
        const double height = std::min({room, 2 * v / w, 2 * a / (w * w)});
        const int cycles = static_cast<int>(std::max(1.0, std::floor(2.4 * unit * frequency)));
        m.swing(side * height, frequency, cycles);
        m.rest(0.2);
        m.swing(side * height / 2, frequency, cycles);
        add(worded(
                "swings of %.3g and %.3g mm at %.2g Hz: the strongest acceleration (%.3g m/s2) and half of it",
                mm(height), mm(height / 2), frequency, height * w * w / 2),
            m);
    }
    const double longest = 7 * unit;
    std::erase_if(out, [&](const planned_motion& m) {
        return static_cast<double>(m.reference.size()) * period > longest;
    });
    return out;
}

} // namespace quadrant::inline v0::diagnosis
