// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "random.hpp"

#include <algorithm>
#include <functional>

/// Motions as people record them on a machine: strokes, reversals, sinusoids, a multi-sine, rest; or one slow
/// stroke only.
namespace quadrant_gap::trial {

struct motion_limits {
    double seconds = 10, half_travel = 0.15, velocity = 0.4, acceleration = 4, top_Hz = 150;
    double unit = 1; ///< of what is small: reversals and creeping
};

class motion {
public:
    void rest(double seconds) {
        add(seconds, [](double) { return 0.0; });
    }
    /// Constant speed between cosine ramps.
    void stroke(double length, double speed, double acceleration) {
        const double highest = std::sqrt(std::abs(length) * acceleration * 2 / std::numbers::pi);
        const double v = std::min(speed, highest), ramp = std::numbers::pi / 2 * v / acceleration;
        const double seconds = std::abs(length) / v + ramp;
        add(seconds, [=](double s) {
            const double sign = length > 0 ? 1 : -1;
            const auto ramped = [&](double t) {
                return v * (t / 2 - ramp / (2 * std::numbers::pi) * std::sin(std::numbers::pi * t / ramp));
            };
            if (s < ramp) return sign * ramped(s);
            if (s > seconds - ramp) return sign * (std::abs(length) - ramped(seconds - s));
            return sign * v * (s - ramp / 2);
        });
    }
    /// Whole cycles of a sinusoid, faded in and out over one cycle.
    void sinusoid(double amplitude, double frequency, int cycles) {
        const double seconds = cycles / frequency;
        add(seconds, [=](double s) {
            const double fade = std::min({1.0, s * frequency, (seconds - s) * frequency});
            return amplitude * fade * fade * (3 - 2 * fade) * std::sin(2 * std::numbers::pi * frequency * s);
        });
    }
    /// Tones from low to high, each with the same acceleration.
    void tones(double low, double high, double acceleration, double seconds, dice& random) {
        std::vector<double> hertz, phase;
        for (double f = low; f < high; f *= random.uniform(1.15, 1.45)) {
            hertz.push_back(f);
            phase.push_back(random.phase());
        }
        add(seconds, [=](double s) {
            const double fade = std::min({1.0, s / 0.15, (seconds - s) / 0.15});
            double sum = 0;
            for (std::size_t i = 0; i < hertz.size(); ++i) {
                const double w = 2 * std::numbers::pi * hertz[i];
                sum += acceleration / (w * w) * std::sin(w * s + phase[i]);
            }
            return sum * fade * fade * (3 - 2 * fade) / std::sqrt(static_cast<double>(hertz.size()));
        });
    }
    double seconds() const { return pieces_.empty() ? 0 : pieces_.back().end; }
    double operator()(double t) const {
        double x = 0;
        for (const piece& p : pieces_) {
            if (t <= p.begin) break;
            x += p.at(std::min(t, p.end) - p.begin);
        }
        return x;
    }
    std::vector<double> sampled(double period, std::size_t samples) const {
        std::vector<double> out(samples);
        double done = 0; // where the pieces before the current one have led
        std::size_t p = 0;
        for (std::size_t k = 0; k < samples; ++k) {
            const double t = static_cast<double>(k) * period;
            while (p < pieces_.size() && t > pieces_[p].end) {
                done += pieces_[p].at(pieces_[p].end - pieces_[p].begin);
                ++p;
            }
            out[k] = done + (p < pieces_.size() ? pieces_[p].at(t - pieces_[p].begin) : 0);
        }
        return out;
    }

private:
    struct piece {
        double begin, end;
        std::function<double(double)> at;
    };
    void add(double length, std::function<double(double)> at) {
        const double begin = seconds();
        pieces_.push_back({begin, begin + length, std::move(at)});
    }
    std::vector<piece> pieces_;
};

/// Two speeds or more over the travel, reversals of 0.05 to 20 mm (of joints ten times as many mrad), mostly a
/// multi-sine, rest; in any order.
inline motion rich_motion(const motion_limits& l, dice& random) {
    motion out;
    out.rest(random.uniform(0.1, 0.3));
    const auto left = [&] { return l.seconds - out.seconds() - 0.1; };
    const auto strokes = [&](double share_of_time) {
        const double length = l.half_travel * random.uniform(0.3, 1) * random.sign();
        const double slowest = std::abs(length) / (0.5 * share_of_time * l.seconds);
        const double speed = std::max(slowest, random.log_uniform(0.05, 1) * l.velocity);
        const double a = l.acceleration * random.uniform(0.4, 1);
        if (2 * (std::abs(length) / speed + speed / a * 1.6) > left()) return;
        out.stroke(length, speed, a);
        if (random.chance(0.5)) out.rest(random.uniform(0.05, 0.2));
        out.stroke(-length, speed, a);
    };
    const auto reversals = [&] {
        const double amplitude = l.unit * random.log_uniform(5e-5, 0.02);
        const double fastest = std::sqrt(0.7 * l.acceleration / amplitude) / (2 * std::numbers::pi);
        const double quickest = 0.7 * l.velocity / (2 * std::numbers::pi * amplitude);
        const double f = std::min({fastest, quickest, random.log_uniform(1, 6)});
        const int cycles = random.whole(3, 5);
        if (f > 0.3 && cycles / f < std::min(left(), 0.2 * l.seconds)) out.sinusoid(amplitude, f, cycles);
    };
    const auto creep = [&] { // a slow short stroke there and back
        const double speed = l.unit * random.log_uniform(5e-4, 8e-3);
        const double length = speed * std::min(0.06 * l.seconds, left() / 2.5);
        if (length <= 0) return;
        out.stroke(length, speed, 0.3 * l.unit);
        out.stroke(-length, speed, 0.3 * l.unit);
    };
    const auto tones = [&] {
        const double seconds = std::min(left(), l.seconds * random.uniform(0.1, 0.18));
        if (seconds <= 0.5) return;
        const double acceleration = l.acceleration * random.uniform(0.1, 0.4);
        const double lowest = random.uniform(4, 12); // not in the call, whose order is the compiler's choice
        out.tones(lowest, l.top_Hz, acceleration, seconds, random);
    };
    std::vector<int> order{0, 0, 1, 1, 2};
    if (random.chance(0.7)) order.push_back(3);
    random.shuffle(order);
    const auto play = [&](int what) {
        what == 0 ? strokes(0.25) : what == 1 ? reversals() : what == 2 ? creep() : tones();
        if (random.chance(0.4) && left() > 0.3) out.rest(random.uniform(0.05, 0.25));
    };
    for (const int what : order) play(what);
    for (int tries = 0; left() > 0.5 && tries < 12; ++tries) play(random.whole(0, 2));
    out.rest(std::clamp(l.seconds - out.seconds(), 0.1, 0.4));
    return out;
}

/// One slow stroke there and back, and nothing else.
inline motion poor_motion(const motion_limits& l, dice& random) {
    motion out;
    out.rest(0.2);
    const double seconds = std::min(l.seconds, 7.0),
                 length = l.half_travel * random.uniform(0.3, 0.7) * random.sign();
    const double speed = std::abs(length) / (0.42 * seconds);
    out.stroke(length, speed, 0.5 * l.unit);
    out.rest(0.1);
    out.stroke(-length, speed, 0.5 * l.unit);
    out.rest(0.2);
    return out;
}

} // namespace quadrant_gap::trial
