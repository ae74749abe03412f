// SPDX-License-Identifier: BSL-1.0
// Long: one machine of the thesis, each of its boxes a type.
#pragma once
#include "divergence_guard.hpp"
#include "friction_run.hpp"
#include "white_noise.hpp"

#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_loop.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/process/cutting_force.hpp>
#include <quadrant/process/milling_force.hpp>
#include <quadrant/process/milling_harmonics.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

/// Both axes along a circle while the cutter turns: [Jamaludin2008] ch. 5, Tables 5.4 and 5.6, configurations
/// (i) to (iii). The experiments cutting and robustness share it; as a loop to read, see
/// examples/05_milling_table.cpp.
namespace thesis {

using order_2 = std::array<double, 2>;
inline constexpr order_2 flattest{2, -1}, first_order{1, 0};
inline const double exact_cycle =
    quadrant::period_of(milling_harmonics::fundamental) / period; ///< in periods, 85.859

/// A cut: the thesis' own unless said otherwise. Controllers are always those of the tables.
struct cut {
    double radius = 0.03, feed = 0.1;    ///< m, m/s: the circle of Table 5.4, by our reading
    double force = 1.38;                 ///< times milling_harmonics::scale
    axis friction_x = x, friction_y = y; ///< of the machine
    double mass = 1;                     ///< of the machine, over the one that the controller believes
    double spindle = 1;                  ///< over 23.294 Hz
    double cycle = 85;                   ///< of the memory, in periods; the thesis has whole ones
    order_2 weights = flattest;
    double smoothing = 200; ///< corner of Q, Hz
    double learning = 1;    ///< factor on L
    double noise = 0;       ///< of each encoder, um rms, white
    std::size_t substeps = 10;
    double turns = 4; ///< the first one is not counted
};

/// The complementary sensitivity that L has to invert: the cascade around a plant that its observer makes
/// nominal.
inline auto tracking_of(const axis& machine, const axis& believed) {
    const analysis::rigid_axis_model<> g{machine.A_gms, machine.B, machine.delay},
        nominal{believed.A_gms, believed.B, 0_s};
    const analysis::q_model<> q{believed.corner};
    return [loop = analysis::p_pi_dob_loop{loop_around(g, believed), q, analysis::q_inverse_model{q, nominal}}](
               frequency f) { return loop.tracking(f); };
}
/// Q of 61 taps; L of 90 taps, 30 ahead, made with 200 Hz: that takes longer than a run.
inline auto smoothing_of(const cut& c) { return analysis::smoothing_filter<61>(c.smoothing * 1_Hz, period); }
inline const analysis::fir<90>& learning_of(const axis& a) {
    const auto make = [](const axis& each) {
        return analysis::learning_filter<90>(tracking_of(each, each), smoothing_of({}), 30, period,
                                             analysis::up_to_nyquist(period));
    };
    static const auto of_x = make(x), of_y = make(y);
    return a.name == std::string_view(x.name) ? of_x : of_y;
}

struct no_memory {
    using box = absent<signal::position, signal::position>;
    static box::parameters of(const axis&, const cut&) { return {}; }
};
struct memory {
    using box = repetitive<signal::position, 100, 2>;
    static box::parameters of(const axis& a, const cut& c) {
        const auto& l = learning_of(a);
        box::parameters p{c.cycle * period, c.weights, l.taps, l.ahead, smoothing_of(c).taps};
        for (double& tap : p.learning) tap *= c.learning;
        return p;
    }
};

/// The machine's friction: Generalized Maxwell-slip, from the table that the cut names.
struct gms_plant {
    using box = maxwell_slip<4>;
    static box::parameters of(const axis& a) {
        return gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0));
    }
};
/// Another law, and another machine: one bristle that breaks away over some 4 um, levels 10 % higher.
struct lugre_plant {
    using box = lugre<>;
    static box::parameters of(const axis& a) {
        return {{1.1 * a.curve.coulomb, 1.1 * a.curve.static_level, a.curve.stribeck_velocity, 950_N / 1_mps},
                newtons_per_um(50),
                2000_N / 1_mps,
                5_mmps};
    }
};

template <class Friction, class Observer, class Memory> struct configuration {
    using boxes = milling_axis_boxes<typename Friction::box, typename Observer::box, typename Memory::box>;
    static typename boxes::parameters controller(const axis& a, const cut& c) {
        auto p = controller_of<boxes>(a);
        p.friction = Friction::of(a);
        p.disturbance = Observer::of(a);
        p.memory = Memory::of(a, c);
        return p;
    }
};
using uncompensated = configuration<no_friction_model, no_observer, no_memory>; ///< (i)
using compensated = configuration<gms_model, observer, no_memory>;              ///< (ii)
using learning = configuration<gms_model, observer, memory>;                    ///< (iii)

/// A scale that adds white noise to what it reads; without noise a piece of wire.
class noisy_scale {
public:
    using input = signal::position;
    using output = signal::position;
    using value = quantity<si::length>;
    struct parameters {
        double noise = 0; ///< m rms
        std::uint64_t seed = 0;
    };
    noisy_scale(const parameters& p, duration) : given_(p), gauss_(p.seed) {}
    value operator()(value at) noexcept { return given_.noise > 0 ? at + given_.noise * gauss_() * 1_m : at; }
    void reset() noexcept { gauss_ = white_noise(given_.seed); }
    void settle(value) noexcept {}

private:
    parameters given_;
    white_noise gauss_;
};

/// A process whose force of the coming period is given from outside: a cutter whose force depends on the path
/// of both axes.
struct told_force {
    struct parameters {};
    told_force(const parameters&, duration) {}
    quantity_of<signal::force> operator()() noexcept { return now; }
    void reset() noexcept { now = {}; }
    quantity_of<signal::force> now{};
};

/// Both controllers, the table, the cutter in it.
template <class Configuration, class PlantFriction> class table_in_cut {
    using boxes = typename Configuration::boxes;
    using motor = linear_motor<typename PlantFriction::box>;
    using slide = table_axis_boxes<motor, noisy_scale>;

public:
    using loop = xy_loop<boxes, boxes, xy_table<slide, slide>, told_force>;

    explicit table_in_cut(const cut& c)
        : loop_({.control = {Configuration::controller(x, c), Configuration::controller(y, c)},
                 .table = {.x = machine(x, c.friction_x, c), .y = machine(y, c.friction_y, c)}},
                period) {}

    void settle(quantity<si::length> at_x) {
        loop_.settle({.x = on_x(at_x), .y = on_y(quantity<si::length>())});
    }
    void step(const typename loop::motions& r, quantity_of<signal::force> push_x,
              quantity_of<signal::force> push_y) {
        loop_.process_x().now = push_x;
        loop_.process_y().now = push_y;
        loop_(r);
    }
    /// How far the axes, not their encoders, are from the middle [m].
    double from_middle() const {
        return std::hypot(loop_.table().x().wire.place.value(), loop_.table().y().wire.place.value());
    }
    /// Where one axis, not its encoder, is [m].
    double place(bool of_y) const {
        return (of_y ? loop_.table().y().wire.place : loop_.table().x().wire.place).value();
    }
    bool stopped() const { return loop_.faulted() || loop_.limited(); }
    loop& whole() { return loop_; }

private:
    static typename slide::parameters machine(const axis& a, const axis& friction, const cut& c) {
        const quantity<si::mass> believed = a.kf / a.B;
        typename motor::parameters p{.mass = c.mass * believed,
                                     .force_constant = a.kf,
                                     .friction = PlantFriction::of(friction),
                                     .delay = 0.4_ms,
                                     .substeps = c.substeps};
        p.friction.curve.viscous += a.A_gms * believed; // A' beside sigma
        return {.motor = p, .scale = {1e-6 * c.noise, std::uint64_t(a.name[0])}, .encoder_step = 250_nm};
    }

    loop loop_;
};

/// The cutter by its measured harmonics, the first `harmonics` of them.
class synthesized {
public:
    explicit synthesized(const cut& c, std::size_t harmonics = 15)
        : x_(of(c, milling_harmonics::x, harmonics)), y_(of(c, milling_harmonics::y, harmonics)) {}
    milling_force<1>::value operator()(double) { return {x_(), y_()}; }

private:
    static cutting_force<15> of(const cut& c, harmonic_table<15> table, std::size_t harmonics) {
        for (std::size_t i = harmonics; i < 15; ++i) table.real[i] = table.imaginary[i] = 0;
        return {{c.spindle * milling_harmonics::fundamental, c.force * milling_harmonics::scale, table},
                period};
    }
    cutting_force<15> x_, y_;
};

struct circle_result {
    double rms = 0, largest = 0; ///< of the radial error, um; nothing when it diverged
    bool diverged = false; ///< beyond 0.1 mm, growing from turn to turn, clipped, or a box at fault: no result
    double stopped = 0;    ///< s; when that was seen
    std::vector<double> angle{}, radial{}; ///< deg, um; of every sample that counts
};

/// Drives the circle, counter-clockwise from (radius, 0) and from rest. The error is that of the axes, not of
/// the encoders. `cutter(direction)` gives the force of the coming period.
template <class Configuration, class PlantFriction, class Cutter>
circle_result mill(const cut& c, Cutter cutter) {
    table_in_cut<Configuration, PlantFriction> table(c);
    using motion = typename decltype(table)::loop::motion;
    const double w = c.feed / c.radius, T = period.value(), start = 0.05; // s, of the run-in
    const auto turn = static_cast<std::size_t>(2 * pi_ / w / T);
    divergence_guard runs_away(100, turn);
    circle_result found;
    table.settle(c.radius * 1_m);
    const auto samples = static_cast<std::size_t>(c.turns * static_cast<double>(turn));
    for (std::size_t k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) * T, fade = std::exp(-t / start);
        const double angle = w * (t - start * (1 - fade)), speed = w * (1 - fade), gain = w / start * fade;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const auto along = [&](double p, double v, double a) {
            return motion{c.radius * p * 1_m, c.radius * v * 1_mps, c.radius * a * 1_mps2};
        };
        const double error = 1e6 * (table.from_middle() - c.radius);
        if (runs_away(error) || table.stopped()) return {.diverged = true, .stopped = t};
        if (k >= turn) {
            found.rms += error * error;
            found.largest = std::max(found.largest, std::abs(error));
            found.angle.push_back(std::fmod(angle * 180 / pi_, 360));
            found.radial.push_back(error);
        }
        const auto push = cutter(std::remainder(angle + pi_ / 2, 2 * pi_)); // the way of the table
        table.step({.x = along(cosine, -sine * speed, -sine * gain - cosine * speed * speed),
                    .y = along(sine, cosine * speed, cosine * gain - sine * speed * speed)},
                   push.x, push.y);
    }
    found.rms = std::sqrt(found.rms / static_cast<double>(found.radial.size()));
    return found;
}
template <class Configuration, class PlantFriction = gms_plant> circle_result mill(const cut& c = {}) {
    return mill<Configuration, PlantFriction>(c, synthesized(c));
}

} // namespace thesis
