// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "result/result.hpp"
#include "result/words.hpp"
#include "text/bad_input.hpp"
#include "text/output_file.hpp"

#include <nlohmann/json.hpp>

namespace quadrant::inline v0::diagnosis {

namespace detail {

using ordered_json = nlohmann::ordered_json;

inline ordered_json interval_json(const estimate& e) { return {e.low, e.high}; }

/// A value of one number stands alone, one of several harmonics as arrays.
inline ordered_json parameters_json(const std::vector<parameter_estimate>& parameters) {
    ordered_json out = ordered_json::object();
    for (const auto& p : parameters) {
        ordered_json value = ordered_json::array(), ci95 = ordered_json::array();
        for (const auto& e : p.values) {
            value.push_back(e.value);
            ci95.push_back(interval_json(e));
        }
        const bool alone = p.values.size() == 1;
        out[p.key] = {{"value", alone ? value[0] : value}, {"ci95", alone ? ci95[0] : ci95}};
        if (p.on_bound) out[p.key]["on_bound"] = true;
    }
    return out;
}

inline ordered_json gap_json(const gap_numbers& g, axis_kind kind) {
    ordered_json out = {{key_of("position_rms_m", kind), g.position_rms_m},
                        {key_of("position_peak_m", kind), g.position_peak_m},
                        {"command_rms_V", g.command_rms_V},
                        {key_of("force_rms_N", kind), g.force_rms_N},
                        {key_of("noise_floor_force_rms_N", kind), g.noise_floor_force_rms_N},
                        {"bandwidth_Hz", g.bandwidth_Hz}};
    if (g.noise_floor_position_rms_m > 0)
        out[key_of("noise_floor_position_rms_m", kind)] = g.noise_floor_position_rms_m;
    return out;
}

/// One file that went in: what it is, its name, the SHA-256 of its bytes.
struct read_file {
    const char* role;
    const std::string &name, &sha256;
};
inline ordered_json files_json(std::initializer_list<read_file> files) {
    ordered_json out = ordered_json::object();
    for (const read_file& f : files)
        if (!f.sha256.empty())
            out[f.role] = {{"name", f.name.substr(f.name.find_last_of('/') + 1)}, {"sha256", f.sha256}};
    return out;
}

inline ordered_json place_json(const place& p) {
    ordered_json out = ordered_json::object();
    out["view"] = p.view;
    if (!p.block.empty()) out["block"] = p.block; // what no cause explains has none
    out["finding"] = p.finding;
    out["share"] = p.share.value;
    out["share_ci95"] = interval_json(p.share);
    if (!p.basis.empty()) out["basis"] = p.basis;
    return out;
}

inline ordered_json axis_json(const axis_result& a) {
    ordered_json where = ordered_json::array();
    for (const auto& p : a.where) where.push_back(place_json(p));
    ordered_json out = {{"verdict", name_of(a.verdict)},
                        {"kind", name_of(a.kind)},
                        {"command_unit", a.command_unit},
                        {"gap", gap_json(a.gap, a.kind)},
                        {"gap_after", gap_json(a.gap_after, a.kind)},
                        {"where", where},
                        {"calibrated", parameters_json(a.calibrated)},
                        {"calibrated_with_suspects", parameters_json(a.calibrated_with_suspects)},
                        {"evaluated_on", a.evaluated_on}};
    if (a.positions_only) out["positions_only"] = true;
    return out;
}

/// What is added to a command. Numbers that the form does not have are left out; the signal itself is in means
/// over as many rows as leave a thousand of them at most.
inline ordered_json waveform_json(const added_waveform& w, const std::string& unit) {
    ordered_json out = {{"form", name_of(w.form)},
                        {"text", in_words(w, unit)},
                        {"unit", unit},
                        {"from_s", w.from_s},
                        {"to_s", w.to_s},
                        {"rms", w.rms}};
    if (w.period_s > 0) out["period_s"] = w.period_s;
    if (!w.levels.empty()) {
        out["levels"] = ordered_json::array();
        for (const auto& l : w.levels)
            out["levels"].push_back({{"value", l.value}, {"from_s", l.from_s}, {"duration_s", l.duration_s}});
    }
    if (w.frequency_Hz > 0) {
        out["amplitude"] = w.amplitude;
        out["frequency_Hz"] = w.frequency_Hz;
        out["phase_rad"] = w.phase_rad;
        if (w.form == waveform_form::chirp) out["sweep_Hz_per_s"] = w.sweep_Hz_per_s;
    }
    const std::size_t rows = (w.values.size() + 999) / 1000;
    ordered_json values = ordered_json::array();
    for (std::size_t k = 0; k < w.values.size(); k += rows) {
        const std::size_t end = std::min(k + rows, w.values.size());
        double sum = 0;
        for (std::size_t i = k; i < end; ++i) sum += w.values[i];
        values.push_back(sum / static_cast<double>(end - k));
    }
    out["samples"] = {{"period_s", w.sample_period_s * static_cast<double>(rows)}, {"values", values}};
    return out;
}

inline ordered_json cause_json(const cause& c, axis_kind kind, const std::string& unit) {
    ordered_json readings = ordered_json::array();
    for (const auto& r : c.readings)
        readings.push_back({{"effect", r.effect}, {"parameters", parameters_json(r.parameters)}});
    ordered_json out = {{"axis", c.axis},
                        {"effect", c.effect},
                        {"described", c.described},
                        {"probability", c.probability},
                        {"group_probability", c.group_probability},
                        {"confusable_with", c.confusable_with},
                        {"parameters", parameters_json(c.parameters)},
                        {"with_suspects", parameters_json(c.with_suspects)},
                        {"readings", readings},
                        {key_of("gap_before_force_rms_N", kind), c.gap_before_force_rms_N.value},
                        {key_of("gap_after_force_rms_N", kind), c.gap_after_force_rms_N.value},
                        {key_of("gap_before_position_rms_m", kind), c.gap_before_position_rms_m.value},
                        {key_of("gap_after_position_rms_m", kind), c.gap_after_position_rms_m.value},
                        {"gap_before_command_rms_V", c.gap_before_command_rms_V.value},
                        {"gap_after_command_rms_V", c.gap_after_command_rms_V.value},
                        {"shrink", c.shrink.value},
                        {"shrink_ci95", interval_json(c.shrink)},
                        {"exciting_motion", c.exciting_motion}};
    if (c.waveform) out["waveform"] = waveform_json(*c.waveform, unit);
    return out;
}

} // namespace detail

/// The diagnosis file (docs/formats.md, docs/schema/diagnosis.schema.json). A number that is not finite becomes
/// null, which the schema refuses.
inline nlohmann::ordered_json to_json(const diagnosis_result& d) {
    using detail::ordered_json;
    ordered_json unseen = ordered_json::array();
    for (const auto& u : d.not_seen)
        unseen.push_back({{"axis", u.axis}, {"what", u.what}, {"instrument", u.instrument}});
    ordered_json axes = ordered_json::object(), causes = ordered_json::array();
    for (const auto& a : d.axes) axes[a.name] = detail::axis_json(a);
    for (const auto& c : d.causes) {
        const axis_result* axis = detail::named(d.axes, c.axis);
        causes.push_back(detail::cause_json(c, d.kind_of(c.axis), axis ? axis->command_unit : "V"));
    }
    ordered_json out = {
        {"schema", "quadrant.diagnosis/1"},
        {"verdict", name_of(d.verdict)},
        {"axes", axes},
        {"causes", causes},
        {"remaining",
         {{"share_of_gap_unexplained", d.share_unexplained}, {"structure", d.remaining_structure}}},
        {"next_experiment",
         {{"motion", d.next.motion},
          {"separates", d.next.separates},
          {"expected_gain", d.next.expected_gain},
          {"gain_of_log", d.next.gain_of_log},
          {"finding", d.next.finding},
          {"axis", d.next.axis}}},
        {"not_seen", unseen},
        {"notes", d.notes}};
    if (!d.own_effects.empty()) out["own_effects"] = d.own_effects;
    auto files = detail::files_json({{"machine", d.machine_file, d.machine_sha256},
                                     {"log", d.log_file, d.log_sha256},
                                     {"holdout", d.holdout_file, d.holdout_sha256}});
    if (!files.empty()) out["files"] = std::move(files);
    return out;
}

/// The reference of the next experiment as a log's first columns (CSV), for the machine to drive.
inline std::string reference_csv(const experiment& e, axis_kind kind) {
    std::string out = fmt::format("t_s,{}_ref_{}\n", e.axis, key_of("m", kind));
    for (std::size_t k = 0; k < e.reference.size(); ++k)
        out += fmt::format("{:.9g},{:.12f}\n", static_cast<double>(k) * e.period_s, e.reference[k]);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
