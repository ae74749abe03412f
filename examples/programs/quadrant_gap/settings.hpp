// SPDX-License-Identifier: BSL-1.0
// Long: the settings of LinuxCNC, of a drive, and of a compensation table, one after the other.
#pragma once
#include "report/html.hpp"

#include <quadrant/diagnosis/log/log.hpp>
#include <quadrant/diagnosis/model/plant_model.hpp>
#include <quadrant/diagnosis/result/result.hpp>

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <string>
#include <vector>

/// The numbers of a machine file as other programs take them: lines for LinuxCNC, values for a drive, a table
/// of corrections over the position.
namespace quadrant_gap {
using namespace quadrant::diagnosis;

/// A text and what it could not hold.
struct settings_text {
    std::string text;
    std::vector<std::string> notes;
};

namespace settings_detail {

inline std::string in_six(double x) { return fmt::format("{:.6g}", x == 0 ? 0.0 : x); } // no -0

/// Joints in the order in which LinuxCNC lists coordinates; axes with other names come behind, as in the
/// file.
inline std::vector<const axis_description*> joints(const machine_description& m) {
    constexpr std::string_view coordinates = "xyzabcuvw";
    const auto place = [&](const axis_description* a) {
        return a->name.size() == 1 ? coordinates.find(static_cast<char>(a->name[0] | 0x20))
                                   : std::string_view::npos;
    };
    std::vector<const axis_description*> out;
    for (const axis_description& a : m.axes) out.push_back(&a);
    std::stable_sort(out.begin(), out.end(), [&](auto a, auto b) { return place(a) < place(b); });
    return out;
}

/// Of a linear axis millimetres, of a rotary one degrees.
inline double units_of(const axis_description& a) {
    return a.kind == axis_kind::rotary ? 180 / std::numbers::pi : 1000;
}
inline const char* unit_of(const axis_description& a) { return a.kind == axis_kind::rotary ? "degree" : "mm"; }

using line = std::pair<std::string, double>;

/// The cascade multiplied out for LinuxCNC's pid; its feedforwards from the plant.
inline std::vector<line> of_pid(const axis_description& a, const plant_model& p, double units) {
    const auto& c = *a.controller;
    const double kp = c.number("position_gain_per_s"), kv = c.number("velocity_gain_V_s_per_m"),
                 ki = c.number("velocity_integral_V_per_m"), share = c.number("velocity_feedforward") - 1;
    return {{"Pgain", (kp * kv + ki) / units},
            {"Igain", ki * kp / units},
            {"Dgain", kv / units},
            {"FF0", ki * share / units},
            {"FF1", (kv * share + p.friction.viscous_slope / p.force_constant) / units},
            {"FF2", p.moving_mass() / p.force_constant / units},
            {"bias", -p.constant_force / p.force_constant}};
}

inline bool is_cascade(const axis_description& a) {
    return a.controller && !a.controller->own && a.controller->kind == "cascade_p_pi";
}

/// The pins of quadrant_axis, in SI: gains where a cascade is described, and what its feedforwards and its
/// observer know of the plant.
inline std::vector<line> of_quadrant_axis(const axis_description& a, const plant_model& p) {
    std::vector<line> out;
    if (is_cascade(a)) {
        const auto& c = *a.controller;
        out = {{"position-gain", c.number("position_gain_per_s")},
               {"velocity-gain", c.number("velocity_gain_V_s_per_m")},
               {"velocity-integral", c.number("velocity_integral_V_per_m")}};
        if (c.has("notch.frequency_Hz")) {
            out.emplace_back("notch-centre", c.number("notch.frequency_Hz"));
            out.emplace_back("notch-width", c.number("notch.width"));
        }
    }
    out.emplace_back("plant-gain", p.force_constant / p.moving_mass());
    out.emplace_back("plant-pole", p.friction.viscous_slope / p.moving_mass());
    out.emplace_back("friction-coulomb", p.friction.coulomb / p.force_constant);
    out.emplace_back("friction-static", (p.friction.coulomb + p.friction.excess) / p.force_constant);
    if (a.plant.stribeck_velocity_m_per_s)
        out.emplace_back("friction-velocity", *a.plant.stribeck_velocity_m_per_s);
    out.emplace_back("delay", p.delay);
    return out;
}

/// "position-gain" as the INI file of examples/linuxcnc names it.
inline std::string ini_name(std::string name) {
    for (char& ch : name) ch = ch == '-' ? '_' : static_cast<char>(ch >= 'a' && ch <= 'z' ? ch - 32 : ch);
    return name;
}

/// Force that an axis meets at a place whatever it does [N].
inline double force_at(const plant_model& p, double x) { return p.static_force(x) + p.cogging.at(x); }

} // namespace settings_detail

/// Lines for LinuxCNC, axis by axis: what belongs into the INI file, and the pins of `quadrant_axis` (SI) and
/// of `pid` (machine units: mm, degrees) for the HAL file. Gains are those of the described controller, what
/// is fed forward is what the plant asks for.
inline settings_text linuxcnc_lines(const machine_description& m) {
    using namespace settings_detail;
    settings_text out;
    out.text = fmt::format("# {}: values for LinuxCNC. Joints in the order of their coordinates; check them.\n",
                           file_name(m.file));
    std::string hal;
    std::size_t joint = 0;
    for (const axis_description* a : joints(m)) {
        const plant_model p(*a, 0);
        const double units = units_of(*a);
        out.text += fmt::format("\n[JOINT_{}]\n# axis {}, machine unit {}\n", joint, a->name, unit_of(*a));
        const double lost = a->transmission.backlash_m.value_or(p.backlash_behind);
        if (p.cyclic.count > 0)
            out.text +=
                fmt::format("# COMP_FILE, COMP_FILE_TYPE = 1: position, forward and reverse of the table "
                            "of corrections, in {}\n",
                            unit_of(*a));
        else if (lost > 0)
            out.text += fmt::format("BACKLASH = {}\n", in_six(lost * units));
        if (p.backlash > 0)
            out.notes.push_back(
                fmt::format("axis {}: the encoder reads behind the play of {} {}, so that the loop corrects "
                            "it; BACKLASH would "
                            "move the load by it. A deadband of half of it keeps an integral from hunting",
                            a->name, in_six(p.backlash * units), unit_of(*a)));
        if (a->kind == axis_kind::linear && a->command_unit == "V" && !a->positions_only)
            for (const auto& [name, value] : of_quadrant_axis(*a, p)) {
                out.text += fmt::format("{} = {}\n", ini_name(name), in_six(value));
                hal += fmt::format("setp quadrant-axis.{}.{:<18} {}\n", joint, name, in_six(value));
            }
        if (is_cascade(*a)) {
            hal += fmt::format("# instead of quadrant_axis, LinuxCNC's pid (error in {}):\n", unit_of(*a));
            for (const auto& [name, value] : of_pid(*a, p, units))
                hal += fmt::format("# setp pid.{}.{:<6} {}\n", joint, name, in_six(value));
            if (p.friction.coulomb > 0)
                out.notes.push_back(fmt::format(
                    "axis {}: pid has no feedforward against Coulomb friction ({} {}); quadrant_axis has",
                    a->name, in_six(p.friction.coulomb / p.force_constant), a->command_unit));
        } else if (a->controller && a->controller->kind == "linuxcnc_pid") {
            for (const auto& [key, values] : a->controller->values)
                if (key != "units_per_m")
                    hal += fmt::format("setp pid.{}.{:<22} {}\n", joint, key,
                                       key != "error-previous-target" ? in_six(values[0])
                                       : values[0] != 0               ? "TRUE"
                                                                      : "FALSE");
        } else {
            out.notes.push_back(
                a->controller
                    ? fmt::format("axis {}: LinuxCNC has no component like {}", a->name, a->controller->kind)
                    : fmt::format("axis {}: no controller is described, so there are no gains", a->name));
        }
        ++joint;
    }
    if (!hal.empty()) out.text += "\n# --- HAL file ---\n" + hal;
    return out;
}

/// Values for the parameters of a drive, one a row: axis, quantity, value, unit, name in ODrive's firmware
/// (0.6) where it has one. What is neutral is left out.
inline settings_text drive_values(const machine_description& m) {
    settings_text out;
    out.text = "axis,quantity,value,unit,odrive\n";
    for (const axis_description& a : m.axes) {
        const plant_model p(a, 0);
        const bool turns = a.kind == axis_kind::rotary;
        const std::string u = a.command_unit == "N m" ? "Nm" : a.command_unit, length = turns ? "rad" : "m",
                          force = turns ? "Nm" : "N";
        const auto row = [&](std::string_view quantity, double value, const std::string& unit,
                             std::string_view odrive = "") {
            if (value != 0)
                out.text += fmt::format("{},{},{:.6g},{},{}\n", a.name, quantity, value, unit, odrive);
        };
        if (a.positions_only) {
            out.notes.push_back(fmt::format("axis {}: no plant is described", a.name));
            continue;
        }
        const double kf = p.force_constant, in_turns = 2 * std::numbers::pi;
        row(turns ? "moving inertia" : "moving mass", p.moving_mass(), turns ? "kg m2" : "kg");
        if (turns)
            row("inertia for a feedforward", p.moving_mass() * in_turns, "Nm/(turn/s2)",
                "controller.config.inertia");
        row(turns ? "torque constant" : "force constant", kf, force + "/" + u,
            turns && u == "A" ? "config.motor.torque_constant" : "");
        row("acceleration feedforward", p.moving_mass() / kf, fmt::format("{} s2/{}", u, length));
        row("viscous feedforward", p.friction.viscous_slope / kf, fmt::format("{} s/{}", u, length));
        row("Coulomb friction", p.friction.coulomb, force);
        row("Coulomb feedforward", p.friction.coulomb / kf, u);
        if (p.friction.excess > 0) row("friction at rest", p.friction.coulomb + p.friction.excess, force);
        row("offset against the constant force", -p.constant_force / kf, u);
        row("backlash", p.backlash + p.backlash_behind, length);
        if (p.mode.mass > 0) {
            const double first = p.moving_mass() - p.mode.mass,
                         pole = first > 0 ? p.mode.frequency_Hz * std::sqrt(1 + p.mode.mass / first) : 0;
            row("resonance (for a notch)", pole, "Hz");
            row("antiresonance", p.mode.frequency_Hz, "Hz");
        }
        row("dead zone of the amplifier", p.dead_zone, u);
        row("time constant of the current loop", p.lag, "s");
        row("delay of the command", p.delay, "s");
        if (std::isfinite(p.drive_limit)) row("limit of the drive", p.drive_limit, u);
        const drive_description& d = a.drive;
        const std::string gain = turns ? "Nm s/rad" : "N s/m";
        if (turns && d.velocity_gain_N_s_per_m)
            row("velocity gain", *d.velocity_gain_N_s_per_m * in_turns, "Nm/(turn/s)",
                "controller.config.vel_gain");
        else
            row("velocity gain", d.velocity_gain_N_s_per_m.value_or(0), gain);
        if (turns && d.velocity_integral_N_per_m)
            row("velocity integral", *d.velocity_integral_N_per_m * in_turns, "Nm/turn",
                "controller.config.vel_integrator_gain");
        else
            row("velocity integral", d.velocity_integral_N_per_m.value_or(0), force + "/" + length);
        row("position gain", d.position_gain_per_s.value_or(0), "1/s",
            turns ? "controller.config.pos_gain" : "");
        row("position gain", d.position_gain_per_m.value_or(0), "1/" + length);
    }
    return out;
}

/// Where each axis of a log went: what a table of corrections has to cover.
using spans = std::map<std::string, std::pair<double, double>>;
inline spans travel_of(const machine_log& log) {
    spans out;
    for (const axis_log& a : log.axes) {
        const auto [low, high] = std::minmax_element(a.position.begin(), a.position.end());
        if (low != a.position.end()) out[a.name] = {*low, *high};
    }
    return out;
}

/// Corrections over the position (CSV): what to add to the command against forces that depend on the place
/// (cogging, spring, gravity, a constant force), and what to add to the asked position on the way forth and
/// back, as LinuxCNC's COMP_FILE of type 1 has it: errors of the encoder, and play behind it (its loop corrects
/// the play in front of it). An axis that is in no span gets one period from 0 on. An axis without such an
/// effect has no rows.
inline settings_text compensation_table(const machine_description& m, const spans& travel = {}) {
    settings_text out;
    out.text = "axis,position,command,forward,reverse\n";
    constexpr std::size_t most = 4000;
    for (const axis_description& a : m.axes) {
        const plant_model p(a, 0);
        const double lost = a.transmission.backlash_m.value_or(p.backlash_behind);
        const bool pushes = p.cogging.count > 0 || p.spring != 0 || p.weight() != 0 || p.constant_force != 0,
                   shifts = p.cyclic.count > 0 || lost > 0;
        if (!(pushes || shifts)) continue;
        double finest = 0;
        const auto resolve = [&](double period) {
            if (period > 0) finest = finest > 0 ? std::min(finest, period) : period;
        };
        if (p.cogging.count > 0) resolve(p.cogging.period / static_cast<double>(p.cogging.count));
        if (p.cyclic.count > 0) resolve(p.cyclic.period);
        const auto found = travel.find(a.name);
        const double whole = p.cogging.count > 0 ? p.cogging.period : p.cyclic.count > 0 ? p.cyclic.period : 1;
        const auto [low, high] = found != travel.end() ? found->second : std::pair{0.0, whole};
        const double wanted = finest > 0 ? (high - low) / (finest / 16) : 100;
        const auto steps =
            static_cast<std::size_t>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(most)));
        if (wanted > static_cast<double>(most))
            out.notes.push_back(fmt::format("axis {}: rows are {:.3g} of the finest period apart", a.name,
                                            wanted / static_cast<double>(most) / 16));
        for (std::size_t k = 0; k <= steps; ++k) {
            const double x = low + (high - low) * static_cast<double>(k) / static_cast<double>(steps),
                         shift = p.cyclic.at(x),
                         force = a.positions_only ? 0 : settings_detail::force_at(p, x) / p.force_constant;
            out.text += fmt::format("{},{:.9g},{:.6g},{:.6g},{:.6g}\n", a.name, x, 0.0 - force,
                                    shift + lost / 2, shift - lost / 2);
        }
    }
    if (out.text.find('\n') + 1 == out.text.size())
        out.notes.emplace_back(
            "no axis has a force or an error that depends on the position: the table is empty");
    else
        out.notes.emplace_back(
            "positions in m (rad), commands in the unit of the command, corrections in m (rad)");
    return out;
}

} // namespace quadrant_gap
