// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant/diagnosis/machine_file/effect_keys.hpp"

#include <filesystem>

/// The tables of effects in the docs, in Markdown. Every word of them stands in a record of the list.
namespace effect_tables {
using namespace quadrant::diagnosis;

/// A text in a cell of a table.
inline std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
    return out;
}

inline std::string code(std::string_view text) { return fmt::format("`{}`", text); }

/// A word, with a link where the effect has a page of its own; `here`: the folder of the page that links.
inline std::string linked(const effect& e, const std::filesystem::path& docs, std::string_view here) {
    const bool has_page = std::filesystem::exists(docs / "effects" / fmt::format("{}.md", e.name));
    return has_page ? fmt::format("[`{}`]({}effects/{}.md)", e.name, here, e.name) : code(e.name);
}

inline std::string keys_of(const effect& e) {
    std::string out;
    for (const machine_key& k : e.keys)
        out += fmt::format("{}`{}`{}", out.empty() ? "" : ", ", k.name,
                           k.shape == key_shape::number ? "" : " [..]");
    if (!out.empty()) return out;
    return e.name == "controller_mismatch" ? "those of the controller's kind" : "none";
}

/// docs/diagnosis.md: what each effect shows and the motion to record for it.
inline std::string what_it_can_name() {
    std::string out =
        "| effect | in words | shows in the residual force as | record this |\n|---|---|---|---|\n";
    for (const effect* e : every_effect())
        out += fmt::format("| `{}` | {} | {} | {} |\n", e->name, cell(e->label), cell(e->shows),
                           cell(e->exciting_motion));
    return out;
}

/// docs/diagnosis.md: the feedforward that pays each effect.
inline std::string what_pays() {
    std::string out = "| cause | feedforward |\n|---|---|\n";
    for (const effect* e : every_effect())
        if (!e->compensation.empty())
            out += fmt::format("| {} | {} |\n", cell(e->label), cell(e->compensation));
    return out + "| all others | none: the report says what would help and claims nothing |\n";
}

/// docs/formats.md: every key of every effect.
inline std::string machine_keys() {
    std::string out =
        "| key | on a rotary axis | must be | name under `tolerance` | meaning |\n|---|---|---|---|---|\n";
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys) {
            std::string_view rule = k.rule.text;
            rule.remove_prefix(std::string_view("must be ").size());
            const std::string rotary = k.name_for(axis_kind::rotary);
            out += fmt::format("| `{}` | {} | {}{} | {} | {} |\n", k.name,
                               rotary == k.name ? "the same" : code(rotary),
                               k.shape == key_shape::number ? "" : "[..], each ", rule,
                               k.tolerance ? code(k.tolerance_name()) : "", cell(k.meaning));
        }
    return out;
}

/// docs/effects.md: where each effect acts.
inline std::string where(const std::filesystem::path& docs) {
    std::string out = "| effect | in words | box | joins | keys |\n|---|---|---|---|---|\n";
    for (const effect* e : every_effect())
        out += fmt::format("| {} | {} | {} | {} | {} |\n", linked(*e, docs, ""), e->label, e->box,
                           name_of(e->joins), keys_of(*e));
    return out;
}

/// docs/effects.md: how common each effect is, and what to do about it.
inline std::string odds_and_remedies() {
    std::string out = "| effect | odds | because | what to do |\n|---|---|---|---|\n";
    for (const effect* e : every_effect())
        out += fmt::format("| `{}` | {} | {} | {} |\n", e->name, e->prior.odds, cell(e->prior.reason),
                           cell(e->remedy));
    return out;
}

/// docs/README.md: the effects that have a page of their own.
inline std::string pages(const std::filesystem::path& docs) {
    std::string out;
    for (const effect* e : every_effect())
        if (const std::string link = linked(*e, docs, ""); link.front() == '[')
            out += fmt::format("{}{}", out.empty() ? "" : ", ", link);
    return fmt::format("- Effects with a page of their own: {}\n", out.empty() ? "none yet" : out);
}

} // namespace effect_tables
