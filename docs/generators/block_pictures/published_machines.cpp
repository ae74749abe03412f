// SPDX-License-Identifier: BSL-1.0
// The loops of the milling table and of the virtual CNC, with their published numbers.
#include "families.hpp"
#include "quadrant_reproduce/thesis.hpp"
#include "quadrant_reproduce/virtual_cnc.hpp"

#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/quadrant.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

template <class Friction> line reversal(const char* name, const typename Friction::parameters& friction) {
    using boxes = milling_axis_boxes<Friction>;
    auto p = thesis::controller_of<boxes>(thesis::x);
    p.friction = friction;
    milling_axis<boxes> loop{.box = {p, T}};
    auto f = thesis::gms<s::force>(thesis::x, gain_of<s::force, s::force>(1.0));
    const auto mass = thesis::x.kf / thesis::x.B;
    f.curve.viscous += thesis::x.A_gms * mass;
    linear_motor<maxwell_slip<4>> motor{
        {.mass = mass, .force_constant = thesis::x.kf, .friction = f, .delay = 0.4_ms, .encoder_step = 250_nm},
        T};
    curve c(name);
    auto y = 0_m;
    for (int k = 0; k < 4000; ++k) {
        const double t = 5e-4 * k, w = 3.3333, r = 0.03;
        y = motor(loop({r * (1 - std::cos(w * t)) * 1_m, r * w * std::sin(w * t) * 1_mps,
                        r * w * w * std::cos(w * t) * 1_mps2},
                       y));
        if (t > 0.85 && t < 1.1) c.add(1e3 * t, 1e6 * loop.wire.position_error.value());
    }
    return c;
}
picture draw_milling_axis() {
    const auto per_newton = 1.0 / thesis::x.kf;
    const auto& c = thesis::x.curve;
    return of("Position error of the milling table's x axis where it reverses, at 942 ms, by what is known of "
              "friction",
              {over("time [ms]", "error [um]",
                    {reversal<absent<s::velocity, s::voltage>>("no friction feedforward", {}),
                     reversal<stribeck<s::velocity, s::voltage>>(
                         "static curve", {per_newton * c.coulomb, per_newton * c.static_level,
                                          c.stribeck_velocity, per_newton * c.viscous}),
                     reversal<maxwell_slip<4, s::velocity, s::voltage>>(
                         "GMS", thesis::gms<s::voltage>(thesis::x, per_newton))})});
}

/// The thesis' x axis at rest under a cutter, with a memory of its 85.86 periods or without.
template <class Memory> line milled(const char* name, const typename Memory::parameters& memory) {
    using boxes = milling_axis_boxes<absent<s::velocity, s::voltage>, disturbance_observer<s::voltage>, Memory>;
    const auto& a = thesis::x;
    auto p = thesis::controller_of<boxes>(a);
    p.disturbance = {a.corner, axis_model<s::voltage>{a.B, a.A_gms}};
    p.memory = memory;
    milling_axis<boxes> loop{.box = {p, T}};
    const auto mass = a.kf / a.B;
    linear_motor<> motor{{.mass = mass,
                          .force_constant = a.kf,
                          .friction = {.coulomb = 0_N, .viscous = a.A_gms * mass},
                          .delay = 0.4_ms,
                          .encoder_step = 250_nm},
                         T};
    cutting_force<15> cutter{{milling_harmonics::fundamental, milling_harmonics::scale, milling_harmonics::x},
                             T};
    curve c(name);
    auto y = 0_m;
    for (int k = 0; k < 1000; ++k) {
        c.add(0.5 * k, 1e6 * y.value());
        y = motor(loop({}, y), cutter());
    }
    return c;
}
picture draw_repetitive() {
    using memory = repetitive<s::position, 100>;
    const auto& a = thesis::x;
    const analysis::rigid_axis_model<> g{a.A_gms, a.B, a.delay}, nominal{a.A_gms, a.B, 0_s};
    const analysis::q_model<> d{a.corner};
    const analysis::p_pi_dob_loop loop{thesis::loop_around(g, a), d, analysis::q_inverse_model{d, nominal}};
    const auto closed = [&](frequency f) { return loop.tracking(f); };
    const auto whole = analysis::up_to_nyquist(T);
    const auto q = analysis::smoothing_filter<61>(200_Hz, T);
    const auto l = analysis::learning_filter<90>(closed, q, 30, T, whole);
    const auto learns =
        analysis::repetitive_parameters<memory>(closed, std::array<double, 1>{1}, l, q, 85.859 * T, whole);
    return of("Position of an axis at rest under a cutter that turns with 23.3 Hz, with a memory of one turn "
              "and without",
              {over("time [ms]", "position [um]",
                    {milled<memory>("with memory", learns),
                     milled<absent<s::position, s::position>>("without", {})})});
}

template <class Law> line on_circle(const char* name, const typename Law::parameters& law) {
    vcnc::servo<Law> x(vcnc::x_axis, law, 0_m, 1);
    x.settle(vcnc::circle::at(0).x.position);
    curve c(name);
    for (int k = 0; k < vcnc::circle::samples(); ++k) {
        const auto r = vcnc::circle::at(k).x;
        c.add(1e-3 * k, 1e6 * (r.position.value() - x.place()));
        x.step(r);
    }
    return c;
}
picture draw_feed_control() {
    return of("Position error of the x axis of a virtual CNC along a circle of 50 mm at 200 mm/s, by the law "
              "in the box",
              {over("time [s]", "error [um]",
                    {on_circle<pid<>>("pid", vcnc::pid_of(vcnc::x_axis)),
                     on_circle<sliding_mode<>>("sliding_mode", vcnc::sliding_mode_of(vcnc::x_axis))})});
}
picture draw_feed_drive() {
    auto p = vcnc::drive(vcnc::x_axis, 10_um);
    p.encoder_step = {}, p.tachometer_noise = {};
    feed_drive<vcnc::machine_boxes> machine_{.box = {p, 1_ms}};
    feed_control<feed_control_boxes<pid<>>> control{
        .box = {{.law = vcnc::pid_of(vcnc::x_axis), .limit = 5_V, .dac_step = {}}, 1_ms}};
    p.scale_on_table = false;
    feed_drive<vcnc::machine_boxes> blind{.box = {p, 1_ms}};
    auto control_of_blind = control;
    curve r("reference", dashed), seen("table, encoder on the table"), unseen("table, encoder on the motor");
    for (int k = 0; k < 1000; ++k) {
        const double t = 1e-3 * k, w = 2 * pi * 2, a = 100e-6;
        const axis_motion<> m{a * std::sin(w * t) * 1_m, a * w * std::cos(w * t) * 1_mps,
                              -a * w * w * std::sin(w * t) * 1_mps2};
        machine_(control(m, machine_.measured())), blind(control_of_blind(m, blind.measured()));
        if (k < 500) continue;
        r.add(k, 1e6 * m.position.value());
        seen.add(k, 1e6 * machine_.wire.place.value());
        unseen.add(k, 1e6 * blind.wire.place.value());
    }
    return of(
        "Table of a feed drive with 10 um of play under a PID, with the encoder on the table and on the motor",
        {over("time [ms]", "position [um]", {seen, unseen, r})});
}
} // namespace

family published_machines() {
    return {{"milling_axis", draw_milling_axis},
            {"repetitive", draw_repetitive},
            {"feed_control", draw_feed_control},
            {"feed_drive", draw_feed_drive}};
}
} // namespace block_pictures
