// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/described_numbers.hpp"
#include "effect/effect_list.hpp"
#include "model/plant_model.hpp"
#include "text/bad_input.hpp"
#include "write_machine.hpp"

#include <algorithm>
#include <numbers>
#include <set>

namespace quadrant::inline v0::diagnosis {

/// A machine as MuJoCo reads it, and what of it MuJoCo cannot hold.
struct mjcf_model {
    std::string xml;
    std::vector<std::string> notes;
};

namespace detail {

/// One axis as a body with a joint, a motor and its sensors.
class mjcf_axis {
public:
    explicit mjcf_axis(const axis_description& a) : a_(a), p_(a, 0) {}

    std::string body(double height) const {
        const bool turns = a_.kind == axis_kind::rotary;
        const double mass = p_.moving_mass() - p_.mode.mass;
        std::string out = fmt::format("    <body name=\"{}\" pos=\"0 0 {:g}\">\n", a_.name, height);
        const auto& f = p_.friction;
        std::string joint = fmt::format("type=\"{}\" axis=\"{}\" damping=\"{:.12g}\"",
                                        turns ? "hinge" : "slide", turns ? "0 1 0" : "1 0 0", f.viscous_slope);
        // Dry friction is a constraint: so stiff that it holds within a step or two.
        if (f.coulomb > 0)
            joint += fmt::format(
                " frictionloss=\"{:.12g}\" solreffriction=\"0.0005 1\" solimpfriction=\"0.99 0.9999 "
                "0.0001\"",
                f.coulomb);
        if (p_.spring != 0) joint += fmt::format(" stiffness=\"{:.12g}\"", p_.spring);
        const double weight = p_.weight();
        if (weight > 0) {
            // Half of the inertia hangs where it makes this weight, the rest turns with the motor.
            const double hanging = 0.5 * mass, arm = hanging * gravity / weight,
                         load = weight / (gravity * arm);
            out += fmt::format("      <joint name=\"{}\" {} armature=\"{:.12g}\"/>\n", a_.name, joint,
                               mass - hanging);
            out += fmt::format(
                "      <inertial pos=\"{:.12g} 0 {:.12g}\" mass=\"{:.12g}\" diaginertia=\"{tiny:g} {tiny:g} "
                "{tiny:g}\"/>\n",
                arm * std::sin(p_.gravity.phase), -arm * std::cos(p_.gravity.phase), load,
                fmt::arg("tiny", 1e-9 * mass));
        } else {
            out += fmt::format("      <joint name=\"{}\" {}/>\n", a_.name, joint);
            out += fmt::format(
                "      <inertial pos=\"0 0 0\" mass=\"{:.12g}\" diaginertia=\"{inertia:.12g} {inertia:.12g} "
                "{inertia:.12g}\"/>\n",
                turns ? 1 : mass, fmt::arg("inertia", turns ? mass : 1));
        }
        if (p_.mode.mass > 0) {
            const double rate = 2 * std::numbers::pi * p_.mode.frequency_Hz;
            out += fmt::format(
                "      <body name=\"{0}_mode\"><joint name=\"{0}_mode\" type=\"{1}\" axis=\"{2}\" "
                "stiffness=\"{3:.12g}\" damping=\"{4:.12g}\"/>\n"
                "        <inertial pos=\"0 0 0\" mass=\"{5:.12g}\" diaginertia=\"{6:.12g} {6:.12g} "
                "{6:.12g}\"/></body>\n",
                a_.name, turns ? "hinge" : "slide", turns ? "0 1 0" : "1 0 0", p_.mode.mass * rate * rate,
                2 * p_.mode.damping * rate * p_.mode.mass, turns ? 1 : p_.mode.mass, turns ? p_.mode.mass : 1);
        }
        return out + "    </body>\n";
    }
    std::string actuators() const {
        const double limit = std::min(a_.actuator.limit_V.value_or(drive_model::none), p_.drive_limit);
        std::string out =
            fmt::format("    <motor name=\"{0}\" joint=\"{0}\" gear=\"{1:.12g}\"", a_.name, p_.force_constant);
        if (std::isfinite(limit))
            out += fmt::format(" ctrllimited=\"true\" ctrlrange=\"{:.12g} {:.12g}\"", -limit, limit);
        out += "/>\n";
        if (p_.constant_force != 0)
            out += fmt::format(
                "    <general name=\"{0}_constant\" joint=\"{0}\" gainprm=\"0\" biastype=\"affine\" "
                "biasprm=\"{1:.12g} 0 0\"/>\n",
                a_.name, p_.constant_force);
        return out;
    }
    std::string sensors() const {
        return fmt::format(
            "    <jointpos joint=\"{0}\"/><jointvel joint=\"{0}\"/><actuatorfrc actuator=\"{0}\"/>\n", a_.name);
    }
    /// Keys with a value that is not neutral, and for which MuJoCo has nothing.
    std::vector<std::string> left_out() const {
        static const std::set<std::string_view> held{"mass_kg",
                                                     "force_constant_N_per_V",
                                                     "viscous_N_s_per_m",
                                                     "coulomb_N",
                                                     "constant_force_N",
                                                     "spring_N_per_m",
                                                     "gravity_torque_Nm",
                                                     "gravity_phase_rad",
                                                     "mode_mass_kg",
                                                     "mode_frequency_Hz",
                                                     "mode_damping",
                                                     "actuator.drive_limit_V",
                                                     "payload.mass_kg",
                                                     "payload.arm_m",
                                                     "payload.link_mass_kg",
                                                     "encoder.resolution_m"}; // what reads the joint rounds it
        std::vector<std::string> out;
        for (const char* box :
             {"plant", "actuator", "encoder", "process", "payload", "drive", "transmission", "motor_encoder"})
            for_each_key(box, [&](const machine_key& k, const effect& e) {
                const auto values = numbers_of(a_, k, e);
                if (held.contains(k.name) ||
                    std::all_of(values.begin(), values.end(), [&](double v) { return v == k.neutral; }))
                    return;
                const std::string name = k.name_for(a_.kind);
                if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
            });
        if (a_.drive.closes()) out.emplace_back("drive (its loops)");
        if (a_.controller) out.emplace_back("controller");
        return out;
    }

private:
    static constexpr double gravity = 9.80665;
    const axis_description& a_;
    plant_model p_;
};

} // namespace detail

/// The plant of a machine as a MuJoCo model: mass or inertia, viscous and Coulomb friction (damping,
/// frictionloss), spring, gravity on a rotary axis, a second mass, a constant force, the motor with its limit
/// (control in the unit of the command). An axis is a joint of its name; axes do not move each other.
/// stay outside, as MuJoCo has them. Notes name every key that MuJoCo cannot hold; the delay is one of them.
/// `substeps`: of the sample period.
inline mjcf_model to_mjcf(const machine_description& machine, int substeps = 10) {
    mjcf_model out;
    std::string bodies, actuators, sensors;
    double height = 0;
    for (const axis_description& a : machine.axes) {
        if (a.positions_only)
            throw bad_input(machine.file, fmt::format("axes.{}: no plant is described", a.name));
        const detail::mjcf_axis axis(a);
        bodies += axis.body(height);
        actuators += axis.actuators();
        sensors += axis.sensors();
        height += 1;
        if (const auto left = axis.left_out(); !left.empty())
            out.notes.push_back(fmt::format("axis {}: not in the model: {}", a.name, fmt::join(left, ", ")));
    }
    out.xml = fmt::format(
        "<!-- Control in the unit of the machine file's command. -->\n"
        "<mujoco>\n"
        "  <compiler angle=\"radian\"/>\n"
        "  <option timestep=\"{:.12g}\" gravity=\"0 0 -9.80665\" integrator=\"implicit\" cone=\"elliptic\"/>\n"
        "  <worldbody>\n{}  </worldbody>\n  <actuator>\n{}  </actuator>\n  <sensor>\n{}  "
        "</sensor>\n</mujoco>\n",
        machine.sample_period_s / substeps, bodies, actuators, sensors);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
