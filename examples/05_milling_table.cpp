// SPDX-License-Identifier: BSL-1.0
// The milling table, whole: both axes along a circle while the cutter shakes them with 15 harmonics of its 23.3
// Hz.
//
//   r -+-> Vest -> notch ------------------+     +------- (r'' + A' r')/B, inverse of the axis
//      |            +-> memory -+          |     |         +- GMS friction of r'
//      +-> (+) -----+-------- (+)-> kv -> (+)-> PI -> (+) -> (+)-> 10 V -> motor ---> y
//      y ---^-  position_error             ^-          ^- observer(y, u)     ^ friction, cutting force
//      y -> Vest -> notch -----------------+
//
// Source: [Jamaludin2008] ch. 2 to 5; Table 5.4 for (i) to (iii), measured 7.68, 4.43, 1.09 um. A memory of 85
// whole periods is 1 % off the cutter's cycle: weights 2, -1 forgive that, for 12 dB between the harmonics
// instead of 6 with weights 1.
// You should see: (i) > (ii) > (iii); a memory that learns too much is stopped and gives no figure.
#include "programs/quadrant_reproduce/divergence_guard.hpp"
#include "programs/quadrant_reproduce/thesis.hpp"

#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/quadrant.hpp>

#include <cstdio>

using namespace thesis; // brings quadrant and its literals

namespace {
using thesis::axis; // not the namespace quadrant::axis
using friction = maxwell_slip<4, signal::velocity, signal::voltage>;
using observer = disturbance_observer<signal::voltage>;
using memory = repetitive<signal::position, 100, 2>; // up to 100 periods, order 2
using cascade_alone = milling_axis_boxes<>;          // and the inverse of the axis
using compensated = milling_axis_boxes<friction, observer>;
using learning = milling_axis_boxes<friction, observer, memory>;

struct choice { // of the memory
    double cycle = 85, gain = 1;
    std::array<double, 2> weights{2, -1};
};

/// L inverts the closed loop of the model, observer and all; Q keeps it from frequencies that the model does
/// not know.
memory::parameters learned(const axis& a, const choice& c) {
    const analysis::rigid_axis_model<> g{a.A_gms, a.B, a.delay}, nominal{a.A_gms, a.B, 0_s};
    const analysis::q_model<> d{a.corner};
    const analysis::p_pi_dob_loop loop{loop_around(g, a), d, analysis::q_inverse_model{d, nominal}};
    const auto closed = [&](frequency f) { return loop.tracking(f); };
    const auto whole = analysis::up_to_nyquist(period);
    const auto q = analysis::smoothing_filter<61>(200_Hz, period);
    const auto l = analysis::learning_filter<90>(closed, q, 30, period, whole);
    auto p = analysis::repetitive_parameters<memory>(closed, c.weights, l, q, c.cycle * period, whole);
    for (double& tap : p.learning) tap *= c.gain;
    return p;
}
template <class Boxes> typename Boxes::parameters controller(const axis& a, const choice& c) {
    typename Boxes::parameters p{.position_gain = position_gain,
                                 .velocity_gain = a.kp,
                                 .velocity_integral = a.ki,
                                 .estimator_corner = estimator_corner,
                                 .notch = notch_of(a),
                                 .plant_gain = a.B,
                                 .plant_pole = a.A_gms,
                                 .limit = 10_V};
    if constexpr (!std::same_as<Boxes, cascade_alone>) {
        p.friction = gms<signal::voltage>(a, 1.0 / a.kf);
        p.disturbance = {a.corner, axis_model<signal::voltage>{a.B, a.A_gms}};
    }
    if constexpr (std::same_as<Boxes, learning>) p.memory = learned(a, c);
    return p;
}
using motor = linear_motor<maxwell_slip<4>>;
using slide = table_axis_boxes<motor>;
using table = xy_table<slide, slide>;

slide::parameters machine(const axis& a) {
    auto f = gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0));
    f.curve.viscous += a.A_gms * a.kf / a.B;
    const motor::parameters p{.mass = a.kf / a.B, .force_constant = a.kf, .friction = f, .delay = 0.4_ms};
    return {.motor = p, .encoder_step = 250_nm};
}

template <class Boxes> void mill(const char* name, const choice& chosen = {}) {
    namespace measured = milling_harmonics;
    const auto cutter = [](const harmonic_table<15>& harmonics) {
        return cutting_force<15>::parameters{measured::fundamental, 1.38 * measured::scale, harmonics};
    };
    xy_loop<Boxes, Boxes, table, cutting_force<15>> loop(
        {.control = {controller<Boxes>(x, chosen), controller<Boxes>(y, chosen)},
         .table = {.x = machine(x), .y = machine(y)},
         .process_x = cutter(measured::x),
         .process_y = cutter(measured::y)},
        period);
    const double R = 0.03, w = 0.1 / R, T = period.value(), start = 0.05; // m, rad/s, s, s: from rest
    const int turn = int(2 * pi_ / (w * T));
    divergence_guard runs_away(100, std::size_t(turn)); // um
    double squares = 0;
    for (int k = 0; k < 4 * turn; ++k) {
        const double late = std::exp(-k * T / start), angle = w * (k * T - start * (1 - late));
        const double v = w * (1 - late), a = w / start * late, s = R * std::sin(angle), c = R * std::cos(angle);
        const auto &at_x = loop.table().x().wire.place, &at_y = loop.table().y().wire.place;
        const double error = 1e6 * (std::hypot(R + at_x.value(), at_y.value()) - R);
        if (runs_away(error) || loop.faulted() || loop.limited())
            return void(std::printf("%-46s unstable: stopped after %.1f s, no result\n", name, k * T));
        if (k >= turn) squares += error * error;
        loop({.x = {(c - R) * 1_m, -s * v * 1_mps, (-s * a - c * v * v) * 1_mps2},
              .y = {s * 1_m, c * v * 1_mps, (c * a - s * v * v) * 1_mps2}});
    }
    std::printf("%-46s %5.1f um\n", name, std::sqrt(squares / (3 * turn)));
}
} // namespace

int main() {
    std::printf("radial error, rms of three turns\n");
    mill<cascade_alone>("(i)   cascade and inverse of the axis");
    mill<compensated>("(ii)  and GMS friction, observer");
    mill<learning>("(iii) and memory, 85 periods, weights 2, -1");
    mill<learning>("      85 periods, weights 1", {.weights = {1, 0}});
    mill<learning>("      85.86 periods, weights 2, -1", {.cycle = 85.859});
    mill<learning>("      85.86 periods, weights 1", {.cycle = 85.859, .weights = {1, 0}});
    mill<learning>("      L 1.5 times too strong, weights 2, -1", {.gain = 1.5});
}
