// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "estimated.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrant::inline v0::analysis {

/// One test run of an axis: encoder and command of the same samples.
template <signal_tag Command = signal::voltage> struct test_run {
    std::vector<displacement> position;
    std::vector<quantity_of<Command>> command;
};

/// Friction over speed.
struct friction_map {
    /// Friction at one speed: what changes its sign with the direction, and what does not.
    struct point {
        quantity_of<signal::velocity> speed;         ///< > 0
        quantity_of<signal::force> friction;         ///< half the difference of the two directions
        quantity_of<signal::force> standard_error{}; ///< of that
        quantity_of<signal::force> offset;           ///< half their sum: what pushes whichever way it goes
    };
    /// A run that the map does not use, and what is wrong with it.
    struct left_out {
        std::size_t run; ///< index
        std::string why;
    };
    std::vector<point> points; ///< speed rising
    double freedom;            ///< of each standard error
    std::vector<left_out> unused;
};

/// When a run counts as steady, and which runs are of one speed.
struct friction_map_options {
    double uneven = 0.2; ///< share of the speed by which a steady run may be off; 0.01 ... 0.5
    double same = 0.05;  ///< runs whose speeds differ by this share belong together; 0.001 ... 0.3
};

namespace detail {
/// One count of the encoder [m]: the least that it ever moved; 0 when it never did.
inline double count_of(const std::vector<displacement>& position) {
    double count = HUGE_VAL;
    for (std::size_t i = 1; i < position.size(); ++i)
        if (position[i] != position[i - 1])
            count = std::min(count, std::abs((position[i] - position[i - 1]).value()));
    return std::isfinite(count) ? count : 0;
}
struct steady_run {
    double velocity;
    steady_mean force; ///< of the command
    std::string why;   ///< not steady; empty: it is
};
/// A run in 320 slices: the longest stretch at its median speed, then what the command settles to there.
template <signal_tag Command>
steady_run read_run(const test_run<Command>& run, duration period, double uneven) {
    constexpr std::size_t slices = 320;
    const std::size_t width = run.position.size() / slices;
    std::vector<double> x(slices), u(slices), v;
    const double count = count_of(run.position);
    for (std::size_t i = 0; i < run.position.size(); ++i) {
        const double at = run.position[i].value(), command = run.command[i].value();
        require(std::isfinite(at) && std::isfinite(command), "test_run.sample", double(i), "must be finite");
        if (i < slices * width) x[i / width] += at / double(width), u[i / width] += command / double(width);
    }
    std::size_t reach = 1; // slices either way over which a speed is taken: 8 counts or more
    double usual = 0;
    for (;; reach *= 2) {
        v.clear();
        const double time = 2 * double(reach * width) * period.value();
        for (std::size_t s = reach; s + reach < slices; ++s) v.push_back((x[s + reach] - x[s - reach]) / time);
        auto sorted = v;
        const auto middle = sorted.begin() + long(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end());
        usual = *middle;
        if (std::abs(usual) * time >= 8 * count || reach == 16) break;
    }
    std::size_t from = 0, length = 0;
    for (std::size_t s = 0, start = 0; s < v.size(); ++s) {
        if (!(std::abs(v[s] - usual) <= uneven * std::abs(usual))) start = s + 1;
        if (s + 1 - start > length) length = s + 1 - start, from = start;
    }
    from += reach; // as a slice
    steady_run out{usual, {}, {}};
    if (usual == 0)
        out.why = "it does not move";
    else if (length < slices / 4)
        out.why = "its speed is steady in less than a quarter of it: it jerks, or is too short for the encoder";
    if (!out.why.empty()) return out;
    out.force = settle_mean({u.begin() + long(from), u.begin() + long(from + length)});
    const std::size_t first = from + out.force.first, last = from + length - 1;
    out.velocity = (x[last] - x[first]) / (double(last - first) * double(width) * period.value());
    if (!out.force.settled) out.why = "its command does not settle: record for longer";
    return out;
}
} // namespace detail

/// Friction map from runs at constant speed, one way each, in a closed loop (open loop a slow axis jerks): mean
/// force at each speed, the mean of both directions, so that what pushes one way (weight, an offset of the
/// amplifier) drops out, and a force that belongs to the place too where both runs go over the same stretch.
///   F(v) = kf (mean u(+v) - mean u(-v))/2
/// Steady part: the longest stretch in which the speed is within `uneven` of the run's median speed; of that
/// what is left after the run in, where the mean has the least spread (`settle_mean`). Its standard error
/// counts correlation.
/// It measures the friction after a path of that length at one speed: with elements that slip slowly
/// (`maxwell_slip`) the force nears s(v) + viscous v with s(v)/attraction, 0.1 to 0.4 s on the milling table,
/// after a run in of some ten micrometres.
/// At less than one encoder count per response time of the loop the axis creeps from count to count and the
/// mean falls short (1 % at 0.01 mm/s and 0.25 um on the milling table): the fit's `surprise` shows it.
/// Source: [Jamaludin2008] eq. (3.5).
/// A run that is not steady, or has no counterpart, is left out, and `unused` says why. Throws for runs shorter
/// than 640 samples, of unequal wires or with samples that are not finite.
template <signal_tag Command = signal::voltage>
friction_map map_friction(const std::vector<test_run<Command>>& runs, duration period,
                          gain_of<signal::force, Command> force_constant,
                          const friction_map_options& options = {}) {
    require_positive("map_friction.period", period);
    require_positive("map_friction.force_constant", force_constant);
    require(options.uneven >= 0.01 && options.uneven <= 0.5, "friction_map_options.uneven", options.uneven,
            "must lie between 0.01 and 0.5");
    require(options.same >= 0.001 && options.same <= 0.3, "friction_map_options.same", options.same,
            "must lie between 0.001 and 0.3");
    struct side {
        double force = 0, variance = 0, count = 0;
    };
    struct group {
        double speed;
        side plus, minus;
        std::vector<std::size_t> runs;
    };
    friction_map out{{}, 15, {}};
    std::vector<group> groups;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        require(runs[r].position.size() == runs[r].command.size(), "test_run.position",
                double(runs[r].position.size()),
                "must hold as many samples as command (" +
                    quadrant::detail::shortest(double(runs[r].command.size())) + ")");
        require(runs[r].position.size() >= 640, "test_run.position", double(runs[r].position.size()),
                "must hold 640 samples or more");
        const auto found = detail::read_run(runs[r], period, options.uneven);
        if (!found.why.empty()) {
            out.unused.push_back({r, found.why});
            continue;
        }
        const double speed = std::abs(found.velocity);
        auto at = std::find_if(groups.begin(), groups.end(), [&](const group& g) {
            return std::abs(g.speed - speed) <= options.same * speed;
        });
        if (at == groups.end()) at = groups.insert(at, {speed, {}, {}, {}});
        side& to = found.velocity > 0 ? at->plus : at->minus;
        to.force += force_constant.value() * found.force.mean;
        const double error = force_constant.value() * found.force.standard_error;
        to.variance += error * error, ++to.count;
        at->runs.push_back(r);
    }
    std::sort(groups.begin(), groups.end(), [](const group& a, const group& b) { return a.speed < b.speed; });
    for (const group& g : groups) {
        if (g.plus.count == 0 || g.minus.count == 0) {
            for (const std::size_t r : g.runs)
                out.unused.push_back({r, "no run at this speed goes the other way"});
            continue;
        }
        const double plus = g.plus.force / g.plus.count, minus = g.minus.force / g.minus.count;
        const double error = 0.5 * std::sqrt(g.plus.variance / (g.plus.count * g.plus.count) +
                                             g.minus.variance / (g.minus.count * g.minus.count));
        const auto newton = [](double f) { return quantity_of<signal::force>::from_value(f); };
        out.points.push_back({quantity_of<signal::velocity>::from_value(g.speed), newton(0.5 * (plus - minus)),
                              newton(error), newton(0.5 * (plus + minus))});
    }
    return out;
}

} // namespace quadrant::inline v0::analysis
