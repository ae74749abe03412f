// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chain_population.hpp"
#include "files.hpp"

/// The files of a machine with two positions an axis.
namespace quadrant_gap::trial {

inline ordered_json machine_file(const drawn_chain& m) {
    const chain_truth& a = m.described;
    const bool rotary = a.kind == quadrant::diagnosis::axis_kind::rotary;
    ordered_json gears{{"kind", rotary ? "gear" : "screw"}, {m.key("travel_per_turn_m"), a.gears.turn}};
    if (a.gears.play > 0) gears[m.key("backlash_m")] = a.gears.play;
    ordered_json tolerance{{"backlash", m.tolerance.backlash}};
    ordered_json axis = ordered_json::object();
    if (m.has_forces()) {
        gears[m.key("motor_mass_kg")] = a.motor_mass;
        gears[m.key("stiffness_N_per_m")] = a.gears.stiffness;
        ordered_json plant{{m.key("mass_kg"), a.mass},
                           {m.key("force_constant_N_per_V"), a.force_constant},
                           {m.key("viscous_N_s_per_m"), a.guide.viscous},
                           {"delay_s", a.delay}};
        if (a.guide.coulomb > 0) plant[m.key("coulomb_N")] = a.guide.coulomb;
        axis["plant"] = plant;
        tolerance.update({{m.key("mass"), m.tolerance.mass},
                          {m.key("force_constant"), m.tolerance.force_constant},
                          {"viscous", m.tolerance.viscous},
                          {"coulomb", m.tolerance.coulomb},
                          {"stiffness", m.tolerance.stiffness}});
        axis["actuator"] = {{"limit_V", a.limit}, {"dac_bits", 16}, {"dac_range_V", 2 * a.limit}};
        axis["motor_encoder"] = {
            {"resolution_rad", a.motor_encoder.resolution / a.gears.turn * 2 * std::numbers::pi}};
    }
    if (a.follows.late > 0) {
        axis["drive"] = {{"command_delay_s", a.follows.late}};
        tolerance["command_delay"] = m.tolerance.follows;
    } else if (a.follows.lag > 0) {
        axis["drive"] = {{"position_gain_per_s", 1 / a.follows.lag}};
        tolerance["position_gain"] = m.tolerance.follows;
    }
    axis["transmission"] = gears;
    axis["encoder"] = {{m.key("resolution_m"), a.scale.resolution}};
    axis["tolerance"] = tolerance;
    ordered_json out{{"schema", "quadrant.machine/1"}, {"sample_period_s", m.period}};
    if (!m.excluded.empty()) out["excluded_effects"] = m.excluded;
    out["axes"] = {{"x", axis}};
    return out;
}

inline std::string log_file(const drawn_chain& m, const chain_record& r) {
    const chain_truth& a = m.described;
    const bool asked = m.has_forces() || a.recorded != positions_recorded::counter_and_scale;
    const bool counted = a.recorded != positions_recorded::asked_and_scale;
    std::string out = "t_s";
    if (asked) out += ",x_" + m.key("ref_m");
    const bool in_turns = m.has_forces() || a.kind == quadrant::diagnosis::axis_kind::rotary;
    if (counted) out += in_turns ? ",x_motor_pos_rad" : ",x_motor_pos_m";
    out += ",x_" + m.key("pos_m") + (m.has_forces() ? ",x_cmd_V\n" : "\n");
    const double turns = in_turns ? 2 * std::numbers::pi / a.gears.turn : 1;
    for (std::size_t k = 0; k < r.scale.size(); ++k) {
        out += fmt::format("{:.6f}", static_cast<double>(k) * m.period);
        if (asked) out += fmt::format(",{:.9f}", r.reference[k]);
        if (counted) out += fmt::format(",{:.9f}", turns * r.motor[k]);
        out += fmt::format(",{:.9f}", r.scale[k]);
        if (m.has_forces()) out += fmt::format(",{:.9f}", r.command[k]);
        out += '\n';
    }
    return out;
}

inline void write_files(const drawn_chain& m, const std::filesystem::path& folder) {
    write_file(folder / "machine.json", machine_file(m).dump(2) + "\n");
    write_file(folder / "log.csv", log_file(m, detail::recorded(m, m.truth)));
    write_file(folder / "holdout.csv", log_file(m, detail::recorded(m, m.truth, true)));
}

inline ordered_json truth_of(const drawn_chain& m) {
    ordered_json inside = ordered_json::array();
    for (const drawn_effect& e : m.effects)
        inside.push_back({{"effect", e.name}, {"axis", "x"}, {"size", e.size}, {"parameters", e.parameters}});
    return {{"index", m.index},
            {"kind", name_of(m.plan.what)},
            {"effects", inside},
            {"cloud_m", m.cloud},
            {"sample_period_s", m.period},
            {"rows", m.log_rows},
            {"logs", names_of_logs[0]},
            {"axes", 1},
            {"law", static_cast<int>(m.truth.guide.law)}};
}

} // namespace quadrant_gap::trial
