// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "case.hpp"
#include "motions.hpp"

#include "quadrant_reproduce/friction_run.hpp"

#include <quadrant/loop/cascade_p_pi.hpp>

#include <limits>

/// The milling table of [Jamaludin2008]: linear motors on Generalized Maxwell-slip friction.
namespace sources::milling_table {

using namespace quadrant;
using namespace quadrant::literals;
using motor = linear_motor<maxwell_slip<4>>;

/// How the machine differs from its tables, and which controller moves it.
struct variant {
    bool attraction = true;   ///< that of the table; else an element that slips is at its share at once
    double friction_of_y = 1; ///< Coulomb and static level of y, over the table's: of the machine only
    bool own_loop = false;    ///< the thesis' cascade with friction fed forward and an observer
};

/// At this C an element reaches its share of the level within a nanosecond.
inline constexpr double no_bound = 1e13; ///< [N/s]

inline motor::parameters machine(const thesis::axis& a, const variant& v) {
    motor::parameters p{.mass = a.kf / a.B,
                        .force_constant = a.kf,
                        .friction = thesis::gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0)),
                        .delay = 0.4_ms,
                        .limit = 10_V,
                        .encoder_step = 250_nm,
                        .substeps = 50};
    p.friction.curve.viscous += a.A_gms * p.mass; // A' beside sigma
    if (!v.attraction) p.friction.attraction = no_bound * 1_N / 1_s;
    return p;
}

inline diagnosis::controller_description controller(const thesis::axis& a) {
    diagnosis::controller_description c;
    c.set("position_gain_per_s", thesis::position_gain.value());
    c.set("velocity_gain_V_s_per_m", a.kp.value());
    c.set("velocity_integral_V_per_m", a.ki.value());
    c.set("velocity_filter_Hz", thesis::estimator_corner.value());
    c.set("velocity_feedforward", 1);
    c.set("acceleration_feedforward_V_s2_per_m", 1 / a.B.value());
    c.set("viscous_feedforward_V_s_per_m", a.A_gms.value() / a.B.value());
    return c;
}

inline diagnosis::axis_description described(const thesis::axis& a, const variant& v) {
    const auto p = machine(a, v);
    diagnosis::axis_description d;
    d.name = a.name;
    d.plant.mass_kg = p.mass.value();
    d.plant.force_constant_N_per_V = p.force_constant.value();
    d.plant.viscous_N_s_per_m = p.friction.curve.viscous.value();
    d.plant.delay_s = p.delay.value();
    d.plant.coulomb_N = p.friction.curve.coulomb.value();
    d.plant.static_N = p.friction.curve.static_level.value();
    d.plant.stribeck_velocity_m_per_s = p.friction.curve.stribeck_velocity.value();
    const motor as_built(p, thesis::period);
    for (const double w : as_built.friction().weights()) d.plant.gms_weights.push_back(w);
    for (const auto& k : p.friction.stiffness) d.plant.gms_stiffness_N_per_m.push_back(k.value());
    d.encoder.resolution_m = p.encoder_step.value();
    d.actuator.limit_V = p.limit.value();
    if (!v.own_loop) d.controller = controller(a);
    // As a user would state what was measured on the machine.
    d.tolerance.given = {
        {"mass", 0.02},    {"force_constant", 0.01}, {"viscous", 0.1},           {"delay", 0.05},
        {"coulomb", 0.05}, {"static", 0.05},         {"stribeck_velocity", 0.05}};
    return d;
}

/// A loop around a motor; `answer(motion, reading)` is the loop's command [V].
template <class Loop>
std::vector<row> run(const motor::parameters& p, const motion& m, bool of_x, Loop&& answer) {
    motor plant(p, thesis::period);
    const auto asked = [&](std::size_t k) {
        const auto both = m.at(static_cast<double>(k) * thesis::period.value());
        return of_x ? both.x : both.y;
    };
    plant.settle(asked(0).position);
    auto reading = asked(0).position;
    std::vector<row> rows;
    for (std::size_t k = 0; static_cast<double>(k) * thesis::period.value() <= m.lasts; ++k) {
        const auto command = answer(asked(k), reading, k == 0);
        rows.push_back({asked(k).position.value(), reading.value(), command.value()});
        reading = plant(command);
    }
    return rows;
}

inline std::vector<row> run(const thesis::axis& a, const motor::parameters& p, const motion& m,
                            const variant& v) {
    const bool of_x = a.name[0] == 'x';
    if (v.own_loop) {
        using boxes = milling_axis_boxes<thesis::gms_model::box, thesis::observer::box>;
        auto c = thesis::controller_of<boxes>(a);
        c.friction = thesis::gms_model::of(a);
        c.disturbance = thesis::observer::of(a);
        milling_axis<boxes> loop{.box = {c, thesis::period}};
        return run(p, m, of_x, [&](const axis_motion<>& r, auto reading, bool first) {
            if (first) loop.settle(reading);
            return loop({r.position, r.velocity, r.acceleration}, reading);
        });
    }
    const auto c = controller(a);
    cascade_p_pi_boxes<>::parameters given{
        .position_gain = thesis::position_gain,
        .velocity_gain = a.kp,
        .velocity_integral = a.ki,
        .estimator = {thesis::estimator_corner},
        .acceleration_feedforward = c.number("acceleration_feedforward_V_s2_per_m") * 1_V / 1_mps2,
        .viscous_feedforward = c.number("viscous_feedforward_V_s_per_m") * 1_V / 1_mps,
        .limit = 10_V};
    cascade<cascade_p_pi_boxes<>> loop{.box = {given, thesis::period}};
    return run(p, m, of_x, [&](const axis_motion<>& r, auto reading, bool first) {
        if (first) loop.settle({.reference = r.position, .measured = reading});
        return loop(r.position, reading);
    });
}

inline written_case make(const motion& m, const variant& v) {
    written_case out;
    out.log.period = thesis::period.value();
    diagnosis::machine_description file;
    file.sample_period_s = thesis::period.value();
    file.excluded_effects = {"backlash"}; // a direct drive
    for (const thesis::axis* a : {&thesis::x, &thesis::y}) {
        file.axes.push_back(described(*a, v));
        auto p = machine(*a, v);
        if (a == &thesis::y) {
            p.friction.curve.coulomb *= v.friction_of_y;
            p.friction.curve.static_level *= v.friction_of_y;
        }
        out.log.axes.push_back({a->name, "V", run(*a, p, m, v)});
    }
    out.machine = to_json(file);
    if (v.attraction)
        for (const thesis::axis* a : {&thesis::x, &thesis::y})
            out.machine["axes"][a->name]["plant"]["gms_attraction_N_per_s"] = a->C.value();
    return out;
}

inline void add(std::vector<log_case>& to) {
    const auto put = [&](const std::string& name, const motion& m, const variant& v) {
        to.push_back({"table." + name + (v.attraction ? ".attraction." : ".no_bound.") + m.name,
                      [=] { return make(m, v); }});
    };
    for (const bool attraction : {true, false}) {
        for (const motion& m : motions(table_circle(3))) {
            put("cascade", m, {.attraction = attraction});
            put("own_loop", m, {.attraction = attraction, .own_loop = true});
        }
        put("raised", sinusoid("sine100", 0.1, 3), {.attraction = attraction, .friction_of_y = 4.0 / 3});
    }
}

} // namespace sources::milling_table
