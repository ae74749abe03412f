// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/controller/json.hpp>

/// docs/controllers.md from the records of the controller kinds.
namespace controller_docs {

using namespace quadrant::diagnosis;

/// What an absent key stands for, for the table.
inline std::string absent_means(const controller_key& key) {
    if (key.needed) return key.in_box() ? fmt::format("needed in `{}`", key.box()) : "needed";
    if (!key.needed_with.empty()) return fmt::format("needed with the first `{}`", key.needed_with);
    if (key.form == key_form::list || !std::isfinite(key.otherwise)) return "none";
    if (key.form == key_form::word) return fmt::format("`{}`", key.words[0]);
    if (key.form == key_form::yes_no) return key.otherwise != 0 ? "true" : "false";
    return fmt::format("{:g}", key.otherwise);
}

inline std::string values_of(const controller_key& key) {
    if (key.form == key_form::word) {
        std::string all;
        for (const auto& word : key.words)
            if (!word.empty()) all += fmt::format("{}`{}`", all.empty() ? "" : ", ", word);
        return all;
    }
    if (key.form == key_form::yes_no) return "true, false";
    std::string rule = key.rule.text;
    if (const std::string must = "must be "; rule.starts_with(must)) rule = rule.substr(must.size());
    if (key.form == key_form::list)
        return key.least == key.most ? fmt::format("{} of: {}", key.most, rule)
                                     : fmt::format("{} to {} of: {}", key.least, key.most, rule);
    return rule;
}

inline std::string fed_forward(const controller_kind& kind) {
    std::string out;
    for (const auto& f : {kind.coulomb, kind.viscous, kind.acceleration, kind.constant, kind.position})
        if (!f.key.empty()) out += fmt::format("{}`{}`", out.empty() ? "" : ", ", f.key);
    if (!kind.dead_band.empty()) out += fmt::format(", `{}`", kind.dead_band);
    return out.empty() ? "none" : out;
}

inline std::string section(const controller_kind& kind) {
    std::string out = fmt::format("## `{}`: {}\n\n{}. ", kind.name, kind.label, kind.law);
    out += kind.motions
               ? "It reads velocities: the log's columns `_ref_m_per_s`, `_ref_m_per_s2`, `_vel_m_per_s` where "
                 "they are there, else differences of the positions.\n"
               : "It reads positions only.\n";
    out += fmt::format("What `compensate` may set: {}.\n\n", fed_forward(kind));
    out += "| key | meaning | value | absent | searched |\n|---|---|---|---|---|\n";
    for (const controller_key& key : kind.keys) {
        const bool one = key.form == key_form::number || key.form == key_form::yes_no;
        std::string name = fmt::format("`{}`", key.name);
        if (!key.old_name.empty()) name += fmt::format(" (old: `{}`)", key.old_name);
        out += fmt::format("| {} | {} | {} | {} | {} |\n", name, key.says, values_of(key), absent_means(key),
                           !(one && key.searched) ? "no"
                           : key.scale == 0       ? "unless 0"
                                                  : "yes");
    }
    return out;
}

/// The part of the page behind `intro`, which is written by hand.
inline std::string page(const std::string& intro) {
    std::string out = intro;
    for (const controller_kind* kind : controller_kinds()) out += fmt::format("\n{}", section(*kind));
    return out;
}

/// What stands before the first kind.
inline std::string intro_of(const std::string& page) { return page.substr(0, page.find("\n## `")); }

} // namespace controller_docs
