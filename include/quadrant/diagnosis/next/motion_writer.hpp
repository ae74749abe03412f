// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Writes a reference piece by piece; every piece begins and ends at rest. `unit`: record_scales::unit() [s].
class motion_writer {
public:
    motion_writer(double start, double period, double unit) : x_(start), period_(period), unit_(unit) {
        rest(0.2);
    }

    void rest(double units) {
        append(units * unit_, [](double) { return 0.0; });
    }
    /// Constant speed between ramps of the shape (1 - cos)/2; a stroke too short for the speed takes a lower
    /// one.
    void stroke(double length, double speed, double acceleration) {
        stroke(length, speed, acceleration, [](double, double) { return 0.0; });
    }
    /// The same with something on top: over the time and the duration of the constant speed, from its begin.
    template <class Ripple>
    void stroke(double length, double speed, double acceleration, const Ripple& ripple) {
        const double size = std::abs(length), side = length < 0 ? -1 : 1;
        if (!(size > 0)) return;
        const double v =
            std::min(speed, std::sqrt(2 * std::numbers::inv_pi * acceleration * size)); // ramps take it all
        const double ramp = std::numbers::pi * v / (2 * acceleration), even = size / v - ramp;
        const auto ramped = [&](double t) { // distance after t of a ramp
            return v * (t / 2 - ramp / (2 * std::numbers::pi) * std::sin(std::numbers::pi * t / ramp));
        };
        append(even + 2 * ramp, [&](double t) {
            if (t < ramp) return side * ramped(t);
            if (t < ramp + even) return side * (v * (t - ramp / 2)) + ripple(t - ramp, even);
            return side * (size - ramped(std::max(0.0, 2 * ramp + even - t)));
        });
        x_ = at_;
    }
    /// Full cycles of (1 - cos)/2, `height` from end to end.
    void swing(double height, double frequency, int cycles) {
        append(cycles / frequency,
               [&](double t) { return height * (1 - std::cos(2 * std::numbers::pi * frequency * t)) / 2; });
    }
    template <class Shape> void append(double seconds, const Shape& shape) {
        const auto rows = static_cast<std::size_t>(std::lround(seconds / period_));
        for (std::size_t k = 1; k <= rows; ++k)
            out_.push_back(at_ = x_ + shape(std::min(seconds, static_cast<double>(k) * period_)));
    }
    const std::vector<double>& written() const { return out_; }

private:
    double x_, at_ = x_, period_, unit_;
    std::vector<double> out_{x_};
};

/// Tones at equal ratios up to a tenth of the sample rate or 200 cycles in a unit of time, of equal
/// acceleration, with Schroeder's phases.
class multi_sine {
public:
    multi_sine(double period, double unit)
        : top_Hz(std::min(200 / unit, 0.1 / period)), bottom_Hz(0.1 * top_Hz), unit_(unit) {}

    double top_Hz, bottom_Hz;

    /// Largest velocity and acceleration at scale 1, of some seconds.
    std::pair<double, double> peaks(double seconds, double period) const {
        double velocity = 0, acceleration = 0;
        for (double t = 0; t < seconds; t += period) {
            velocity = std::max(velocity, std::abs(sum(t, 1)));
            acceleration = std::max(acceleration, std::abs(sum(t, 0)));
        }
        return {velocity, acceleration};
    }
    /// No position at scale 1 is further from the middle.
    double reach() const {
        double total = 0;
        for (int i = 0; i < tones; ++i) total += 1 / (angular(i) * angular(i));
        return total;
    }
    /// Position at scale 1, faded in and out at the ends of `length`.
    double at(double t, double length) const {
        const double edge = std::min(0.2 * unit_, length / 4);
        const double fade = std::clamp(std::min(t, length - t) / edge, 0.0, 1.0);
        return fade * fade * (3 - 2 * fade) * sum(t, 2);
    }

private:
    static constexpr int tones = 12;
    double unit_;
    double angular(int i) const {
        return 2 * std::numbers::pi * bottom_Hz * std::pow(top_Hz / bottom_Hz, i / (tones - 1.0));
    }
    double sum(double t, int integrals) const {
        double total = 0;
        for (int i = 0; i < tones; ++i) {
            const double w = angular(i);
            total +=
                std::sin(w * t - std::numbers::pi * i * (i + 1) / tones - 0.5 * std::numbers::pi * integrals) /
                std::pow(w, integrals);
        }
        return total;
    }
};

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
