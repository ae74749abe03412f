// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/circle/run.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

/// A two-axis machine on circles, made for the tests of the ball-bar diagnosis: it shares nothing with what it tests. Each axis is
/// simulated in time, the errors are laid on positions, the radius is measured from the result.
namespace circle_machine {

using quadrant::diagnosis::circle_run, quadrant::diagnosis::circle_source;

/// Where an axis is when its reference is there, sample by sample; a state of its own.
using axis = std::function<double(double reference, double dt)>;
inline axis rigid() {
    return [](double r, double) { return r; };
}
/// Position loop of gain kv without feedforward, exactly integrated over the held reference.
inline axis lag(double kv) {
    return [kv, x = HUGE_VAL, last = 0.0](double r, double dt) mutable {
        if (x == HUGE_VAL) x = last = r; // linear reference over the step
        const double slope = (r - last) / dt, decay = std::exp(-kv * dt), steady = last - slope / kv;
        x = steady + slope * dt + (x - steady) * decay;
        last = r;
        return x;
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
/// Mass under a P/PI cascade with velocity feedforward, and friction of its own, a function of velocity and time step.
inline axis mass_with(std::function<double(double v, double dt)> friction, double kp, double kv, double ki) {
    return [=, f = std::move(friction), x = HUGE_VAL, v = 0.0, sum = 0.0, last = 0.0](double r, double dt) mutable {
        if (x == HUGE_VAL) x = last = r;
        const double speed = (r - last) / dt;
        last = r;
        constexpr int fine = 10;
        for (int k = 0; k < fine; ++k) {
            const double h = dt / fine, e = kp * (r - x) + speed - v;
            sum += ki * e * h;
            v += h * (kv * e + sum - f(v, h)); // of unit mass
            x += h * v;
        }
        return x;
    };
}
/// Dahl's friction: force per mass `level`, contact stiffness per mass.
inline std::function<double(double, double)> dahl(double level, double stiffness) {
    return [=, z = 0.0](double v, double h) mutable {
        z += h * v * stiffness / level * (1 - z * (v > 0 ? 1 : -1)); // in parts of the level
        z = std::clamp(z, -1.0, 1.0);
        return level * z;
    };
}

struct machine {
    axis x = rigid(), y = rigid();
    /// Laid on what the axes do: gets and changes the place, knows the speed and time.
    std::function<void(double& x, double& y, double vx, double vy, double t)> geometry =
        [](double&, double&, double, double, double) {};
    double noise = 1e-7, resolution = 1e-7, period = 1e-3;
    circle_source source = circle_source::instrument;
};

/// One run; `log` numbers the set-up.
inline circle_run drive(const machine& given, double radius, double feed, bool counterclockwise, std::size_t log = 0,
                        unsigned seed = 1, double turns = 1) {
    machine m = given; // fresh states
    std::mt19937 dice(seed * 7919 + unsigned(1e6 * radius * feed) + counterclockwise);
    std::normal_distribution<double> noise(0, m.noise);
    circle_run out;
    out.file = "simulated", out.log = log, out.source = m.source, out.period_s = m.period;
    out.radius = radius, out.feed = feed, out.counterclockwise = counterclockwise, out.turns = std::size_t(turns);
    out.resolution = m.resolution;
    const double rate = feed / radius * (counterclockwise ? 1 : -1), start = 0.7;
    const double run_in = std::max(0.6, 0.5 * radius / feed);
    for (double t = -run_in; std::abs(rate) * t < turns * 2 * std::acos(-1.0); t += m.period) {
        const double a = start + rate * t;
        double x = m.x(radius * std::cos(a), m.period), y = m.y(radius * std::sin(a), m.period);
        m.geometry(x, y, -radius * rate * std::sin(a), radius * rate * std::cos(a), t);
        if (t < 0) continue;
        double r = std::hypot(x, y) + noise(dice);
        if (m.resolution > 0) r = m.resolution * std::round(r / m.resolution);
        const double angle = std::atan2(y, x);
        out.angle.push_back(out.angle.empty() ? angle
                                              : out.angle.back() + std::remainder(angle - out.angle.back(), 2 * std::acos(-1.0)));
        out.deviation.push_back(r - radius);
    }
    return out;
}

/// Two radii, two feeds each, both ways round.
inline std::vector<circle_run> all_runs(const machine& m, std::initializer_list<double> feeds = {0.03, 0.1},
                                        std::initializer_list<double> radii = {0.03, 0.06}, unsigned seed = 1) {
    std::vector<circle_run> runs;
    for (const double radius : radii)
        for (const double feed : feeds)
            for (const bool way : {true, false}) runs.push_back(drive(m, radius, feed, way, 0, seed));
    return runs;
}

} // namespace circle_machine
