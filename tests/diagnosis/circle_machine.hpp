// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/circle/run.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

/// A two-axis machine on circles, made for the tests of the ball-bar diagnosis and sharing nothing with it:
/// each axis is simulated in time, the errors of geometry are laid on where the axes are, and the radius is
/// measured from the result.
namespace circle_machine {

using quadrant::diagnosis::circle_run, quadrant::diagnosis::circle_source;
inline const double pi = std::acos(-1.0);

/// Where an axis is when its reference is there, sample by sample; a copy has a state of its own.
using axis = std::function<double(double reference, double dt)>;
inline axis rigid() {
    return [](double r, double) { return r; };
}
/// Position loop of gain kv without feedforward, integrated exactly along a straight piece of the reference.
/// `encoder(x)` is what the encoder reads too much at x; the reading is what comes out.
inline axis lag(
    double kv, std::function<double(double)> encoder = [](double) { return 0.0; }) {
    return [kv, encoder, x = HUGE_VAL, last = 0.0](double r, double dt) mutable {
        if (x == HUGE_VAL) x = last = r;
        const double slope = (r - last) / dt, decay = std::exp(-kv * dt), from = last - slope / kv - encoder(x);
        x = from + slope * dt + (x - from) * decay;
        last = r;
        return x + encoder(x);
    };
}
/// A loop around a motor that drives its table with play; what is seen is the table.
inline axis with_play(axis motor, double play) {
    return [motor = std::move(motor), play, table = HUGE_VAL](double r, double dt) mutable {
        const double m = motor(r, dt);
        if (table == HUGE_VAL) table = m;
        return table = std::clamp(table, m - play / 2, m + play / 2);
    };
}
/// A unit mass under a P/PI cascade with velocity feedforward, and friction that remembers (bristle of
/// stiffness s, level coulomb + more e^(-(v/stribeck)^2); exact for a constant velocity). Ten steps a sample.
struct friction {
    double coulomb = 0, more = 0, stribeck = 1e-3, stiffness = 1e4;
};
inline axis mass_with(friction f, double kp, double kv, double ki) {
    return [=, x = HUGE_VAL, v = 0.0, sum = 0.0, last = 0.0, z = 0.0](double r, double dt) mutable {
        if (x == HUGE_VAL) x = last = r;
        const double speed = (r - last) / dt, h = dt / 10;
        last = r;
        for (int k = 0; k < 10; ++k) {
            const double level = f.coulomb + f.more * std::exp(-std::pow(v / f.stribeck, 2));
            if (level > 0) {
                const double slip = (v > 0 ? level : -level) / f.stiffness;
                z = slip + (z - slip) * std::exp(-std::abs(v) * f.stiffness / level * h);
            }
            const double e = kp * (r - x) + speed - v;
            sum += ki * e * h;
            v += h * (kv * e + sum - f.stiffness * z);
            x += h * v;
        }
        return x;
    };
}

struct machine {
    axis x = rigid(), y = rigid();
    /// Moves the place of the table; knows the axes' speeds and the time.
    std::function<void(double& x, double& y, double vx, double vy, double t)> geometry =
        [](double&, double&, double, double, double) {};
    double noise = 1e-7, resolution = 1e-7, period = 2e-3;
    circle_source source = circle_source::instrument;
};

/// One turn after a run in; `log` numbers the set-up.
inline circle_run drive(const machine& given, double radius, double feed, bool counterclockwise,
                        std::size_t log = 0, unsigned seed = 1) {
    machine m = given; // fresh states
    std::mt19937 dice(seed * 7919 + unsigned(1e6 * radius * feed) + counterclockwise);
    std::normal_distribution<double> noise(0, m.noise);
    circle_run out;
    out.file = "simulated", out.log = log, out.source = m.source, out.period_s = m.period;
    out.radius = radius, out.feed = feed, out.counterclockwise = counterclockwise, out.turns = 1;
    out.resolution = m.resolution;
    const double rate = feed / radius * (counterclockwise ? 1 : -1),
                 run_in = std::max(0.6, 0.5 * radius / feed);
    for (int k = -int(run_in / m.period); std::abs(rate) * k * m.period < 2 * pi; ++k) {
        const double t = k * m.period, a = 0.7 + rate * t;
        double x = m.x(radius * std::cos(a), m.period), y = m.y(radius * std::sin(a), m.period);
        m.geometry(x, y, -radius * rate * std::sin(a), radius * rate * std::cos(a), t);
        if (k < 0) continue;
        double r = std::hypot(x, y) + noise(dice);
        if (m.resolution > 0) r = m.resolution * std::round(r / m.resolution);
        const double angle = std::atan2(y, x), last = out.angle.empty() ? angle : out.angle.back();
        out.angle.push_back(last + std::remainder(angle - last, 2 * pi));
        out.deviation.push_back(r - radius);
    }
    return out;
}

/// Two radii, two feeds, both ways round.
inline std::vector<circle_run> all_runs(const machine& m, std::vector<double> feeds = {0.05, 0.1},
                                        std::vector<double> radii = {0.03, 0.06}, unsigned seed = 1) {
    std::vector<circle_run> runs;
    for (const double radius : radii)
        for (const double feed : feeds)
            for (const bool way : {true, false}) runs.push_back(drive(m, radius, feed, way, 0, seed));
    return runs;
}

/// Mean of the deviation times a wave of the angle, over the turn.
template <class Wave> double part(const circle_run& r, Wave wave) {
    double sum = 0, whole = 0;
    for (std::size_t k = 1; k < r.angle.size(); ++k) {
        const double step = std::abs(r.angle[k] - r.angle[k - 1]);
        sum += r.deviation[k] * wave(r.angle[k]) * step, whole += step;
    }
    return sum / whole;
}
/// Deviation near an angle (in degrees), mean over two degrees.
inline double at(const circle_run& r, double degrees) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < r.angle.size(); ++k)
        if (std::abs(std::remainder(r.angle[k] - degrees * pi / 180, 2 * pi)) < pi / 180)
            sum += r.deviation[k], ++count;
    return sum / count;
}

} // namespace circle_machine
