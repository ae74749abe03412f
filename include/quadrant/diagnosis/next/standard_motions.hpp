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

namespace detail {

/// One function a motion. All lie inside what the log showed; lengths and times are in units of
/// record_scales::unit() and of the travel there is.
class motion_planner {
public:
    motion_planner(const shown_motion& shown, double period, const record_scales& scale)
        : shown_(shown), period_(period), scale_(scale), unit_(scale.unit()), a_(shown.acceleration),
          v_(std::min(shown.velocity, 0.25 * unit_ * a_)), travel_(shown.high - shown.low),
          up_(shown.high - shown.start), down_(shown.start - shown.low), side_(up_ >= down_ ? 1 : -1),
          room_(std::max(up_, down_)), tones_(period, unit_), tone_peaks_(tones_.peaks(2 * unit_, period)) {}

    /// The log shows a motion to plan from.
    static bool moves(const shown_motion& shown, double unit) {
        return shown.high - shown.low > 0 && std::min(shown.velocity, 0.25 * unit * shown.acceleration) > 0 &&
               shown.acceleration > 0;
    }

    planned_motion slow_strokes() const {
        motion_writer m = begin();
        const double slow = v_ / 30, fast = v_ / 6, l1 = reach(slow, 1.2), l2 = reach(fast, 0.9);
        both_ways(m, l1, slow, a_ / 4);
        both_ways(m, l2, fast, a_ / 4);
        return {worded("slow strokes in both directions: %.3g mm at %.3g mm/s and %.3g mm at %.3g mm/s", mm(l1),
                       mm(slow), mm(l2), mm(fast)),
                m.written()};
    }
    planned_motion creep_and_slow_reversals() const {
        motion_writer m = begin();
        const double creep = v_ / 200, length = reach(creep, 0.8);
        const double wide = std::min(room_ / 2, 1800 * scale_.give()),
                     narrow = std::min(room_ / 4, 60 * scale_.give());
        const auto frequency = [&](double height) {
            return std::max(0.5 / unit_, std::min({2 / unit_, v_ / (std::numbers::pi * height),
                                                   std::sqrt(2 * a_ / height) / (2 * std::numbers::pi)}));
        };
        both_ways(m, length, creep, a_ / 4);
        m.swing(side_ * wide, frequency(wide), 2);
        m.rest(0.3);
        m.swing(side_ * narrow, frequency(narrow), 2);
        return {
            worded("creep of %.3g mm in both directions at %.3g mm/s, then slow reversals: swings of %.3g and "
                   "%.3g "
                   "um at %.2g Hz",
                   mm(length), mm(creep), 1e6 * wide, 1e6 * narrow, frequency(wide)),
            m.written(), false};
    }
    planned_motion strong_accelerations() const {
        motion_writer m = begin();
        const double slow = v_ / 15,
                     l1 = std::min({room_, 1.2 * v_ * v_ / a_ * std::numbers::pi / 2, 0.4 * unit_ * v_}),
                     l2 = reach(slow, 0.8);
        for (int i = 0; i < 2; ++i) both_ways(m, l1, v_, a_);
        both_ways(m, l2, slow, a_ / 4);
        return {worded("strong accelerations beside slow strokes: %.3g mm to and fro twice at %.3g m/s2, then "
                       "%.3g mm in both directions at %.3g mm/s",
                       mm(l1), a_, mm(l2), mm(slow)),
                m.written()};
    }
    planned_motion tones_about_one_place() const {
        motion_writer m = begin();
        const auto [tone_velocity, tone_acceleration] = tone_peaks_;
        const double size = std::min(0.8 * a_ / tone_acceleration, 0.8 * v_ / tone_velocity);
        m.stroke(side_ * size * tones_.reach(), v_ / 10, a_ / 4); // away from the end of the travel
        m.append(5 * unit_, [&](double t) { return size * tones_.at(t, 5 * unit_); });
        return {worded("multi-sine of %.3g to %.3g Hz about one place, peak %.3g m/s2, %.3g s",
                       tones_.bottom_Hz, tones_.top_Hz, size * tone_acceleration, 5 * unit_),
                m.written(), false};
    }
    planned_motion tones_on_strokes() const {
        motion_writer m = begin();
        const auto [tone_velocity, tone_acceleration] = tone_peaks_;
        const double speed = std::min(v_ / 3, room_ / (2 * unit_)), length = reach(speed, 2.2);
        const double size = std::min(0.8 * a_ / tone_acceleration, 0.7 * speed / tone_velocity);
        const auto on_top = [&](double t, double even) {
            return even > 0.4 * unit_ ? size * tones_.at(t, even) : 0;
        };
        m.stroke(side_ * length, speed, a_ / 4, on_top);
        m.rest(0.1);
        m.stroke(-side_ * length, speed, a_ / 4, on_top);
        return {
            worded("multi-sine of %.3g to %.3g Hz, peak %.3g m/s2, on strokes of %.3g mm in both directions at "
                   "%.3g mm/s, slow enough for the tones and fast enough not to reverse",
                   tones_.bottom_Hz, tones_.top_Hz, size * tone_acceleration, mm(length), mm(speed)),
            m.written()};
    }
    planned_motion rest_at_two_places() const {
        motion_writer m = begin();
        const double length = reach(v_, 0.3);
        m.rest(2.5);
        m.stroke(side_ * length, v_ / 2, a_ / 2);
        m.rest(2.3);
        return {worded("rest at two places %.3g mm apart, %.2g s each, with the process as in this log",
                       mm(length), 2.5 * unit_),
                m.written(), false};
    }
    planned_motion whole_travel() const {
        motion_writer m = begin();
        const double speed = std::min(v_, travel_ / (1.4 * unit_)),
                     length = std::min(travel_, 1.4 * unit_ * speed);
        m.stroke(-side_ * std::min(up_, down_), v_, a_);
        m.rest(0.2);
        m.stroke(side_ * length, speed, a_ / 2);
        m.rest(0.3);
        m.stroke(-side_ * length, speed, a_ / 2);
        m.rest(0.3);
        return {worded("slow strokes of %.3g mm, the whole travel as far as time allows, in both directions at "
                       "%.3g mm/s, with rest "
                       "at both ends",
                       mm(length), mm(speed)),
                m.written()};
    }
    planned_motion three_speeds() const {
        motion_writer m = begin();
        const double length = reach(v_, 0.45);
        for (double share : {1.0, 0.5, 0.25})
            both_ways(m, std::min(length, 0.7 * unit_ * share * v_), share * v_, a_);
        return {worded("strokes of up to %.3g mm in both directions at %.3g, %.3g and %.3g mm/s", mm(length),
                       mm(v_), mm(v_ / 2), mm(v_ / 4)),
                m.written()};
    }
    planned_motion the_same_stroke() const {
        motion_writer m = begin();
        const double length = reach(v_ / 4, 0.4);
        for (int i = 0; i < 5; ++i) {
            m.stroke(side_ * length, v_ / 4, a_ / 2);
            m.stroke(-side_ * length, v_ / 4, a_ / 2);
        }
        return {
            worded("the same stroke of %.3g mm at %.3g mm/s, five times to and fro", mm(length), mm(v_ / 4)),
            m.written()};
    }
    planned_motion strongest_swings() const {
        motion_writer m = begin();
        const double frequency = std::clamp(a_ / (2 * std::numbers::pi * v_), 1.5 / unit_, 10 / unit_),
                     w = 2 * std::numbers::pi * frequency;
        const double height = std::min({room_, 2 * v_ / w, 2 * a_ / (w * w)});
        const int cycles = static_cast<int>(std::max(1.0, std::floor(2.4 * unit_ * frequency)));
        m.swing(side_ * height, frequency, cycles);
        m.rest(0.2);
        m.swing(side_ * height / 2, frequency, cycles);
        return {
            worded(
                "swings of %.3g and %.3g mm at %.2g Hz: the strongest acceleration (%.3g m/s2) and half of it",
                mm(height), mm(height / 2), frequency, height * w * w / 2),
            m.written()};
    }

private:
    static double mm(double x) { return 1e3 * x; }
    motion_writer begin() const { return {shown_.start, period_, unit_}; }
    /// How far the axis gets at this speed in so many units of time, with the room there is.
    double reach(double speed, double units) const { return std::min(room_, speed * units * unit_); }
    void both_ways(motion_writer& m, double length, double speed, double acceleration) const {
        m.stroke(side_ * length, speed, acceleration);
        m.rest(0.1);
        m.stroke(-side_ * length, speed, acceleration);
        m.rest(0.1);
    }

    const shown_motion& shown_;
    double period_;
    const record_scales& scale_;
    double unit_, a_;
    double v_; ///< ramps of 0.4 units at most
    double travel_, up_, down_;
    double side_, room_; ///< strokes go where there is room
    multi_sine tones_;
    decltype(tones_.peaks(1.0, 1.0)) tone_peaks_; ///< velocity and acceleration
};

} // namespace detail

/// Motions that have distinguished effects on servo axes, each 3 to 7 units of time long
/// (record_scales::unit()), inside the travel, velocity and acceleration that the log showed. No reversal is
/// smaller than sixty counts. None when the log stands still. The multi-sines ask for frequencies that the log
/// may not have had, and say which.
inline std::vector<planned_motion> standard_motions(const shown_motion& shown, double period,
                                                    const record_scales& scale) {
    if (!detail::motion_planner::moves(shown, scale.unit())) return {};
    const detail::motion_planner plan(shown, period, scale);
    std::vector<planned_motion> out{plan.slow_strokes(),         plan.creep_and_slow_reversals(),
                                    plan.strong_accelerations(), plan.tones_about_one_place(),
                                    plan.tones_on_strokes(),     plan.rest_at_two_places(),
                                    plan.whole_travel(),         plan.three_speeds(),
                                    plan.the_same_stroke(),      plan.strongest_swings()};
    const double longest = 7 * scale.unit();
    std::erase_if(out, [&](const planned_motion& m) {
        return static_cast<double>(m.reference.size()) * period > longest;
    });
    return out;
}

} // namespace quadrant::inline v0::diagnosis
