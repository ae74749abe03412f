// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "case.hpp"
#include "motions.hpp"

#include "quadrant_cnc/gap_machine.hpp"

/// The Virtual CNC of [Yeung2006]: ball screws under the PID of its Table 10, on encoder and tachometer.
namespace sources::virtual_cnc {

using namespace quadrant;
using namespace quadrant::literals;

/// The friction as the machine file can say it: levels by direction, and the nearest single Stribeck velocity.
inline diagnosis::axis_description described(const vcnc::axis& a, quantity<si::length> play) {
    const auto p = vcnc::drive(a, play);
    const auto side = [](const vcnc::axis::direction& d) {
        return quadrant_cnc::friction_side{d.static_level, d.coulomb, d.fall, d.rise};
    };
    quadrant_cnc::ball_screw_description screw;
    screw.forward = side(a.forward);
    screw.backward = side(a.backward);
    const double way = p.drive.pitch.value() / (2 * std::numbers::pi);
    diagnosis::axis_description d;
    d.name = a.name;
    d.plant.mass_kg = a.inertia / (way * way);
    d.plant.force_constant_N_per_V = a.amplifier * p.drive.torque_constant.value() / way;
    d.plant.viscous_N_s_per_m = a.viscous / (way * way);
    quadrant_cnc::gap::add_friction(d.plant, screw, way);
    if (play > quantity<si::length>()) d.plant.backlash_m = play.value();
    d.encoder.resolution_m = p.encoder_step.value();
    d.actuator.limit_V = vcnc::command_limit.value();
    d.actuator.dac_bits = 16;
    d.actuator.dac_range_V = 20;
    d.tolerance.given = {
        {"mass", 0.05},   {"force_constant", 0.05},    {"viscous", 0.05},          {"coulomb", 0.05},
        {"static", 0.05}, {"stribeck_velocity", 0.05}, {"coulomb_asymmetry", 0.05}};
    return d;
}

inline written_case make(const motion& m, quantity<si::length> play) {
    written_case out;
    out.log.period = vcnc::period.value();
    diagnosis::machine_description file;
    file.sample_period_s = vcnc::period.value();
    std::uint64_t seed = 1;
    for (const vcnc::axis* a : {&vcnc::x_axis, &vcnc::y_axis}) {
        file.axes.push_back(described(*a, play));
        feed_drive<vcnc::machine_boxes> drive{.box = {vcnc::drive(*a, play, seed++), vcnc::period}};
        feed_control<feed_control_boxes<pid<>>> control{
            .box = {{.law = vcnc::pid_of(*a), .limit = vcnc::command_limit, .dac_step = vcnc::dac_step},
                    vcnc::period}};
        const auto asked = [&](std::size_t k) {
            const auto both = m.at(static_cast<double>(k) * vcnc::period.value());
            return a->name[0] == 'x' ? both.x : both.y;
        };
        drive.settle(asked(0).position);
        control.settle(asked(0).position);
        recording::axis logged{a->name, "V", {}};
        for (std::size_t k = 0; static_cast<double>(k) * vcnc::period.value() <= m.lasts; ++k) {
            const auto now = drive.measured();
            const auto command = control(asked(k), now);
            logged.rows.push_back({asked(k).position.value(), now.position.value(), command.value()});
            drive(command);
        }
        out.log.axes.push_back(std::move(logged));
    }
    out.machine = to_json(file);
    return out;
}

inline void add(std::vector<log_case>& to) {
    for (const motion& m : motions(cnc_circle())) {
        to.push_back({"cnc." + m.name, [=] { return make(m, 0_m); }});
        to.push_back({"cnc.play." + m.name, [=] { return make(m, 3_um); }});
    }
}

} // namespace sources::virtual_cnc
