// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "population.hpp"
#include "quadrant/diagnosis/write_machine.hpp"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <stdexcept>

/// The files of a drawn machine: what it is described as, and what it did. Neither knows of an effect.
namespace quadrant_gap::trial {

using nlohmann::ordered_json;

/// An axis whose drive closes loops of its own. Its controller, if there is one, is not described: the
/// set-points are logged.
inline ordered_json driven_axis(const drawn_machine& m, const axis_truth& a, ordered_json plant) {
    const drive_truth& d = a.drive;
    const tolerances& t = m.tolerance;
    ordered_json drive{{"kind", quadrant::diagnosis::name_of(d.kind)}, {"command_delay_s", d.delay}},
        tolerance{{"mass", t.mass},
                  {"viscous", t.viscous},
                  {"coulomb", t.coulomb},
                  {"static", t.at_rest},
                  {"command_delay", tolerance_of_delay}};
    const auto gain = [&](const char* key, double value, const char* known) {
        if (value <= 0) return;
        drive[key] = value;
        tolerance[known] = tolerance_of_gains;
    };
    gain("velocity_per_V", d.velocity_per_V, "velocity");
    gain("velocity_gain_N_s_per_m", d.velocity_gain, "velocity_gain");
    gain("velocity_integral_N_per_m", d.velocity_integral, "velocity_integral");
    gain("position_gain_per_s", d.position_gain, "position_gain");
    gain("position_gain_per_m", d.duty_gain, "position_gain");
    if (d.force_limit > 0) drive["force_limit_N"] = d.force_limit;
    if (d.linear) drive["interpolation"] = "linear";
    plant.erase("delay_s");
    if (d.supply > 0) {
        drive["supply_V"] = d.supply;
        tolerance["supply"] = tolerance_of_supply;
        tolerance["force_constant"] = t.force_constant;
    } else {
        plant.erase("force_constant_N_per_V");
    }
    if (d.shows_current()) {
        plant["force_constant_N_per_A"] = a.actuator.force_constant;
        tolerance["force_constant"] = t.force_constant;
    }
    return {{"plant", plant},
            {"tolerance", tolerance},
            {"encoder", {{"resolution_m", a.encoder.resolution}}},
            {"drive", drive}};
}

/// The cascade of an axis as a machine file has it.
inline ordered_json cascade_of(const controller_truth& c) {
    ordered_json control{{"kind", "cascade_p_pi"},
                         {"position_gain_per_s", c.position_gain},
                         {"velocity_gain_V_s_per_m", c.velocity_gain},
                         {"velocity_integral_V_per_m", c.integral}};
    if (c.two_sample_mean)
        control["velocity_estimator"] = "two_sample_mean";
    else
        control["velocity_filter_Hz"] = c.filter_Hz;
    control["velocity_feedforward"] = c.velocity_feedforward;
    control["acceleration_feedforward_V_s2_per_m"] = c.acceleration_feedforward;
    control["viscous_feedforward_V_s_per_m"] = c.viscous_feedforward;
    control["coulomb_feedforward_V"] = c.coulomb_feedforward;
    if (c.notch_Hz > 0) control["notch"] = {{"frequency_Hz", c.notch_Hz}, {"width", c.notch_damping}};
    return control;
}

inline ordered_json machine_file(const drawn_machine& m) {
    ordered_json axes = ordered_json::object();
    for (const axis_truth& a : m.described) {
        ordered_json plant{{"mass_kg", a.mechanics.mass},
                           {"force_constant_N_per_V", a.actuator.force_constant},
                           {"viscous_N_s_per_m", a.friction.viscous},
                           {"delay_s", m.how == logs::measured ? 0 : a.actuator.delay}};
        if (a.friction.coulomb > 0) plant["coulomb_N"] = a.friction.coulomb;
        if (a.friction.level_at_rest > 0) {
            plant["static_N"] = a.friction.level_at_rest;
            plant["stribeck_velocity_m_per_s"] = a.friction.stribeck_velocity;
        }
        if (a.drive.closes()) {
            axes[a.name] = driven_axis(m, a, plant);
            continue;
        }
        const tolerances& t = m.tolerance;
        ordered_json drive{{"limit_V", a.controller.limit}};
        if (a.controller.dac_bits > 0) {
            drive["dac_bits"] = a.controller.dac_bits;
            drive["dac_range_V"] = a.controller.dac_range;
        }
        if (m.how == logs::measured) drive["command_is"] = "measured";
        ordered_json tolerance{{"mass", t.mass},
                               {"force_constant", t.force_constant},
                               {"viscous", t.viscous},
                               {"coulomb", t.coulomb},
                               {"static", t.at_rest}};
        ordered_json axis{{"plant", plant},
                          {"encoder", {{"resolution_m", a.encoder.resolution}}},
                          {"actuator", drive},
                          {"controller", cascade_of(a.controller)}};
        if (a.turns) {
            axis["plant"]["gravity_torque_Nm"] = a.mechanics.gravity;
            axis["plant"]["gravity_phase_rad"] = a.mechanics.gravity_phase;
            if (a.friction.load > 0) axis["plant"]["load_friction"] = a.friction.load;
            for (auto& [box, content] : axis.items())
                content = quadrant::diagnosis::detail::in_words_of(quadrant::diagnosis::axis_kind::rotary, box,
                                                                   content);
            axis["payload"] = {{"mass_kg", a.mechanics.payload.mass}, {"arm_m", a.mechanics.payload.arm}};
            tolerance["gravity_torque"] = tolerance_of_gravity;
            tolerance["load_friction"] = tolerance_of_load;
            tolerance = quadrant::diagnosis::detail::in_words_of(quadrant::diagnosis::axis_kind::rotary,
                                                                 "tolerance", tolerance);
        }
        axis["tolerance"] = tolerance;
        axes[a.name] = axis;
    }
    ordered_json out{{"schema", "quadrant.machine/1"}, {"sample_period_s", m.period}};
    if (!m.excluded.empty()) out["excluded_effects"] = m.excluded;
    out["axes"] = axes;
    return out;
}

/// Columns of all axes, rounded as servo loggers round.
inline std::string log_file(const drawn_machine& m, const std::vector<axis_record>& axes, std::uint64_t seed) {
    const int time_digits = m.period < 2e-4 ? 6 : 5;
    dice random(seed, 11);
    const auto kept = rows_kept(m.how, axes[0].position.size(), m.period, dice(seed, 12));
    const bool with_reference = m.how != logs::no_reference;
    std::string out = "t_s";
    const auto in_volts = [](const drive_truth& d) {
        return !d.closes() || d.kind == drive_truth::drive_kind::velocity;
    };
    for (const axis_truth& a : m.described)
        out += fmt::format(
            "{3}{0}_pos_{4}{1}{2}", a.name, in_volts(a.drive) ? fmt::format(",{}_cmd_V", a.name) : "",
            a.drive.tapped ? fmt::format(",{}_{}", a.name, a.drive.shows_current() ? "current_A" : "duty") : "",
            with_reference ? fmt::format(",{}_ref_{},", a.name, a.turns ? "rad" : "m") : ",",
            a.turns ? "rad" : "m");
    out += '\n';
    char text[128];
    for (std::size_t k = 0; k < axes[0].position.size(); ++k) {
        if (!kept[k]) continue;
        const double off = m.how == logs::jitter && k > 0 ? m.period * random.uniform(-0.2, 0.2) : 0;
        std::snprintf(text, sizeof text, "%.*f", off == 0 ? time_digits : 7,
                      static_cast<double>(k) * m.period + off);
        out += text;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const axis_record& a = axes[i];
            const drive_truth& d = m.described[i].drive;
            if (with_reference) out += fmt::format(",{:.12f}", a.reference[k]);
            const bool measured = m.how == logs::measured && !d.closes();
            const double noise = noise_of_measured * m.described[i].controller.limit;
            out += fmt::format(",{:.9f}", a.position[k]);
            if (in_volts(d))
                out += fmt::format(",{:.6f}", measured ? a.acting[k] + noise * random.normal() : a.command[k]);
            if (d.shows_current())
                out += fmt::format(",{:.6f}", a.current[k] + noise / m.described[i].actuator.force_constant *
                                                                 random.normal());
            else if (d.tapped)
                out += fmt::format(",{:.5f}", a.duty[k]);
        }
        out += '\n';
    }
    return out;
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// The references alone, as somebody would plan them.
inline std::string motion_file(const drawn_machine& m, const std::vector<std::vector<double>>& references) {
    std::string out = "t_s";
    for (const axis_truth& a : m.described) out += fmt::format(",{}_ref_{}", a.name, a.turns ? "rad" : "m");
    out += '\n';
    for (std::size_t k = 0; k < references[0].size(); ++k) {
        out += fmt::format("{:.6f}", static_cast<double>(k) * m.period);
        for (const auto& r : references) out += fmt::format(",{:.12f}", r[k]);
        out += '\n';
    }
    return out;
}

/// machine.json, log.csv, holdout.csv and the motion of the latter, planned.csv, into a folder.
inline void write_files(const drawn_machine& m, const std::filesystem::path& folder) {
    write_file(folder / "machine.json", machine_file(m).dump(2) + "\n");
    write_file(folder / "log.csv",
               log_file(m, run(m.truth, m.log_reference, m.period, m.noise_seed), m.noise_seed));
    write_file(folder / "holdout.csv",
               log_file(m, run(m.truth, m.holdout_reference, m.period, m.noise_seed + 1), m.noise_seed + 1));
    write_file(folder / "planned.csv", motion_file(m, m.holdout_reference));
}

/// What the parent keeps to itself.
inline ordered_json truth_of(const drawn_machine& m) {
    ordered_json inside = ordered_json::array();
    for (const drawn_effect& e : m.effects) {
        ordered_json parameters = ordered_json::object();
        for (const auto& [key, value] : e.parameters.items()) {
            const auto kind = m.described[0].turns ? quadrant::diagnosis::axis_kind::rotary
                                                   : quadrant::diagnosis::axis_kind::linear;
            const auto* known = quadrant::diagnosis::key_named(key);
            parameters[known ? known->name_for(kind) : quadrant::diagnosis::key_of(key, kind)] = value;
        }
        inside.push_back({{"effect", e.name}, {"axis", "x"}, {"size", e.size}, {"parameters", parameters}});
    }
    return {{"index", m.index},
            {"kind", name_of(m.what)},
            {"effects", inside},
            {"cloud_N", m.cloud},
            {"sample_period_s", m.period},
            {"rows", m.log_reference[0].size()},
            {"logs", names_of_logs[static_cast<std::size_t>(m.how)]},
            {"axes", m.described.size()},
            {"law", static_cast<int>(m.truth[0].friction.law)}};
}

} // namespace quadrant_gap::trial
