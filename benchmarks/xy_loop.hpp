// SPDX-License-Identifier: BSL-1.0
#pragma once
#ifdef __AVX2__
#    include "expert_xy.hpp"
#endif
#include "hand_written_xy.h"
#include "quadrant_latency/loop.hpp"
#include "virtual_graph.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <limits>

/// The controller of both axes of the milling table: typed, alone and in lanes
/// (examples/programs/quadrant_latency/loop.hpp), by hand, as an expert writes it, and as a run-time graph of
/// the same blocks. `Learning` and `Smoothing` are the taps of the memory's FIR filters, 1 and 1 for none.
namespace xy_loop {

using namespace quadrant;
using quadrant_latency::commands;
using quadrant_latency::sample;
template <std::size_t Learning, std::size_t Smoothing>
using typed = quadrant_latency::typed_loop<quadrant_latency::memory_of<Learning, Smoothing>>;
template <std::size_t Learning, std::size_t Smoothing>
using typed_lanes = quadrant_latency::typed_lanes<quadrant_latency::memory_of<Learning, Smoothing>>;

/// The typed parameters as bare numbers.
template <std::size_t Learning, std::size_t Smoothing>
xy_parameters<int(Learning), int(Smoothing)> in_doubles(const thesis::axis& axis) {
    const auto p = quadrant_latency::parameters_of<quadrant_latency::memory_of<Learning, Smoothing>>(axis);
    xy_parameters<int(Learning), int(Smoothing)> d{};
    d.period = thesis::period.value();
    d.position_gain = p.position_gain.value();
    d.velocity_gain = p.velocity_gain.value();
    d.velocity_integral = p.velocity_integral.value();
    d.estimator_corner = p.estimator_corner.value();
    d.notch_centre = p.notch.centre.value();
    d.notch_damping = p.notch.width;
    d.plant_gain = p.plant_gain.value();
    d.plant_pole = p.plant_pole.value();
    d.limit = p.limit.value();
    d.dac_step = p.dac_step.value();
    d.coulomb = p.friction.curve.coulomb.value();
    d.static_level = p.friction.curve.static_level.value();
    d.stribeck_velocity = p.friction.curve.stribeck_velocity.value();
    d.viscous = p.friction.curve.viscous.value();
    d.attraction = p.friction.attraction.value();
    for (std::size_t i = 0; i < xy_springs; ++i) {
        d.forces[i] = p.friction.forces[i].value();
        d.stiffness[i] = p.friction.stiffness[i].value();
    }
    d.corner = p.disturbance.corner.value();
    d.cycle = p.memory.cycle.value();
    for (std::size_t i = 0; i < 2; ++i) d.weights[i] = p.memory.weights[i];
    for (std::size_t i = 0; i < Learning; ++i) d.learning[i] = p.memory.learning[i];
    for (std::size_t i = 0; i < Smoothing; ++i) d.smoothing[i] = p.memory.smoothing[i];
    d.ahead = int(p.memory.ahead);
    return d;
}

template <std::size_t Learning, std::size_t Smoothing> struct by_hand {
    xy_axis<int(Learning), int(Smoothing)> x, y;
    bool fault = false;

    by_hand() {
        const auto px = in_doubles<Learning, Smoothing>(thesis::x),
                   py = in_doubles<Learning, Smoothing>(thesis::y);
        xy_design(&px, &x);
        xy_design(&py, &y);
    }
    [[gnu::noinline, gnu::flatten]] commands step(const sample& s) noexcept {
        const xy_motion mx = {s.x.position, s.x.velocity, s.x.acceleration, s.x.measured};
        const xy_motion my = {s.y.position, s.y.velocity, s.y.acceleration, s.y.measured};
        if (!xy_sensible(&mx, &my)) {
            fault = true;
            return {x.command, y.command};
        }
        return {xy_step(&x, &mx), xy_step(&y, &my)};
    }
    int flags() const noexcept {
        return (x.limited != x.wanted) | (y.limited != y.wanted) << 1 |
               (fault || xy_faulted(&x) || xy_faulted(&y)) << 2;
    }
};

/// Every box behind a virtual call, the wires in an array: what a graph does that is put together while the
/// program runs.
template <std::size_t Learning, std::size_t Smoothing> struct as_graph {
    using boxes = quadrant_latency::boxes<quadrant_latency::memory_of<Learning, Smoothing>>;
    virtual_graph::axis x{
        boxes(quadrant_latency::parameters_of<quadrant_latency::memory_of<Learning, Smoothing>>(thesis::x),
              thesis::period)},
        y{boxes(quadrant_latency::parameters_of<quadrant_latency::memory_of<Learning, Smoothing>>(thesis::y),
                thesis::period)};

    bool fault = false;

    [[gnu::noinline]] commands step(const sample& s) noexcept {
        const xy_motion mx = {s.x.position, s.x.velocity, s.x.acceleration, s.x.measured};
        const xy_motion my = {s.y.position, s.y.velocity, s.y.acceleration, s.y.measured};
        if (!xy_sensible(&mx, &my)) {
            fault = true;
            return {x.last(), y.last()};
        }
        return {x.step(s.x.position, s.x.velocity, s.x.acceleration, s.x.measured),
                y.step(s.y.position, s.y.velocity, s.y.acceleration, s.y.measured)};
    }
    int flags() const noexcept {
        return x.limited() | y.limited() << 1 | (fault || x.faulted() || y.faulted()) << 2;
    }
};

/// One pass; the sum stands for a consumer of the commands.
template <class Loop> [[gnu::noinline]] double run(Loop& loop, const std::vector<sample>& in, std::size_t n) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const commands u = loop.step(in[k]);
        sum += u.x + u.y;
    }
    return sum;
}

/// What the loops are measured in: on the circle, parked, and turning round every ten periods.
enum class motion { moving, standing, reversing };
constexpr std::size_t rest = 32'000; ///< after so many periods on one place what dies out has died out
inline std::vector<sample> inputs(motion m) {
    return m == motion::moving     ? quadrant_latency::circle()
           : m == motion::standing ? quadrant_latency::standing(rest + quadrant_latency::five_turns)
                                   : quadrant_latency::reversing();
}

/// The circle with a lost encoder line (NaN), an infinite reference, and values that overflow in the gains.
inline std::vector<sample> rough(std::size_t n) {
    std::vector<sample> all = quadrant_latency::circle(n);
    for (std::size_t k = 6000; k < 6003 && k < n; ++k)
        all[k].x.measured = std::numeric_limits<double>::quiet_NaN();
    if (n > 9000) all[9000].y.position = std::numeric_limits<double>::infinity();
    if (n > 12'000) all[12'000].x.measured = 1e306;
    if (n > 15'000) all[15'000].y.acceleration = 1e308;
    return all;
}

/// True when both loops give the same bits and the same flags at every sample.
template <class A, class B> bool same(const std::vector<sample>& in, const char* name) {
    A a;
    B b;
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    for (std::size_t k = 0; k < in.size(); ++k) {
        const commands ua = a.step(in[k]), ub = b.step(in[k]);
        if (bits(ua.x) == bits(ub.x) && bits(ua.y) == bits(ub.y) && a.flags() == b.flags()) continue;
        std::fprintf(stderr, "%s: sample %zu: x %.17g and %.17g, y %.17g and %.17g, flags %d and %d\n", name, k,
                     ua.x, ub.x, ua.y, ub.y, a.flags(), b.flags());
        return false;
    }
    return true;
}

#ifdef __AVX2__
/// The expert's: for x86-64-v3.
template <std::size_t Learning, std::size_t Smoothing> struct by_expert {
    expert::loop<int(Learning), int(Smoothing)> both{in_doubles<Learning, Smoothing>(thesis::x),
                                                     in_doubles<Learning, Smoothing>(thesis::y)};

    commands step(const sample& s) noexcept {
        const auto u = both.step({s.x.position, s.x.velocity, s.x.acceleration, s.x.measured},
                                 {s.y.position, s.y.velocity, s.y.acceleration, s.y.measured});
        return {u[0], u[1]};
    }
};
#endif

/// True when both loops give the same commands behind the DAC.
template <class A, class B> bool same_commands(const std::vector<sample>& in, const char* name) {
    A a;
    B b;
    for (std::size_t k = 0; k < in.size(); ++k) {
        const commands ua = a.step(in[k]), ub = b.step(in[k]);
        if (ua.x == ub.x && ua.y == ub.y) continue;
        std::fprintf(stderr, "%s: sample %zu: x %.17g and %.17g, y %.17g and %.17g\n", name, k, ua.x, ub.x,
                     ua.y, ub.y);
        return false;
    }
    return true;
}
/// Of the loops that round otherwise on the way: the circle, at rest, turning round.
template <std::size_t Learning, std::size_t Smoothing> bool same_behind_the_dac() {
    bool good = true;
    for (const auto& in :
         {quadrant_latency::circle(20'000), quadrant_latency::standing(), quadrant_latency::reversing()}) {
        good = good && same_commands<typed<Learning, Smoothing>, typed_lanes<Learning, Smoothing>>(
                           in, "typed, in lanes");
#ifdef __AVX2__
        good = good &&
               same_commands<typed<Learning, Smoothing>, by_expert<Learning, Smoothing>>(in, "typed, expert");
#endif
    }
    return good;
}

/// The three loops are one loop: checked over 20 000 samples before anything is measured.
template <std::size_t Learning, std::size_t Smoothing> bool comparable() {
    bool good = true;
    for (const auto& in : {quadrant_latency::circle(20'000), rough(20'000)})
        good = good && same<typed<Learning, Smoothing>, by_hand<Learning, Smoothing>>(in, "typed, by hand") &&
               same<typed<Learning, Smoothing>, as_graph<Learning, Smoothing>>(in, "typed, virtual graph");
    return good && same_behind_the_dac<Learning, Smoothing>();
}

} // namespace xy_loop
