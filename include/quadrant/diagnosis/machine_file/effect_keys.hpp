// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/described_numbers.hpp"
#include "../model/friction_contact.hpp"
#include "../model/harmonics.hpp"
#include "../text/json_keys.hpp"

/// What a machine file may say of effects: everything here follows from the records of the list
/// (effect_list.hpp).
namespace quadrant::inline v0::diagnosis::detail {

/// The last letter of a key that names the unit of the command.
inline constexpr std::string_view command_units = "VA";

/// The boxes of an axis that hold keys of effects, in the order of the list.
inline std::vector<std::string_view> boxes_of_effects() {
    std::vector<std::string_view> out;
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (std::find(out.begin(), out.end(), k.box()) == out.end()) out.push_back(k.box());
    return out;
}

/// Names under `tolerance` of an axis of this kind, each with the key that it is the tolerance of and that
/// key's effect.
struct tolerance_name {
    std::string_view name;
    const machine_key* key;
    const effect* of;
};
inline std::vector<tolerance_name> tolerance_names(axis_kind kind) {
    std::vector<tolerance_name> out;
    for (const effect* e : every_effect())
        for (const machine_key& k : e->keys)
            if (k.tolerance && !(e->rotary_only && kind == axis_kind::linear))
                out.push_back({k.tolerance_name(), &k, e});
    return out;
}

/// The keys of effects in one box of an axis, as a file of this kind of axis has them. `all`: also those that
/// only a rotary axis has, so that the lists of both kinds are of one order.
inline std::vector<std::string> effect_keys(std::string_view box, axis_kind kind, bool all = false) {
    std::vector<std::string> out;
    for_each_key(box, [&](const machine_key& k, const effect& e) {
        if (e.rotary_only && kind == axis_kind::linear && !all) return;
        const std::string key = k.key_for(kind);
        if (k.unit_of_command)
            for (char unit : command_units) out.push_back(key.substr(0, key.size() - 1) + unit);
        else
            out.push_back(key);
    });
    return out;
}

/// Puts a key of a box that has its former name under its name of today, and reports that to `note`.
template <class Note>
void rename_former(const machine_key& k, const json_node& box, nlohmann::json& content, Note&& note) {
    const std::string name = k.key_for(box.kind);
    for (const std::string_view former : k.former) {
        const auto given = former.empty() ? std::nullopt : box.find(std::string(former));
        if (!given) continue;
        if (content.contains(name))
            given->refuse(fmt::format("is the former name of {}: give one of them", name));
        content[name] = *given->value;
        content.erase(box.name(former));
        note(fmt::format("{} is now called {}", given->path, name));
    }
}

/// One box of an axis and what it says of effects, into a description. Notes are reported to `note`.
template <class Note> class effect_keys_reader {
public:
    effect_keys_reader(const json_node& node, std::string_view box, axis_description& axis, Note note)
        : node_(node.object()), content_(*node.value), box_(box), axis_(axis), note_(note) {}

    /// `others`: keys of this box that belong to no effect.
    void read(key_names others) {
        each([&](const machine_key& k, const effect&) { rename_former(k, node_, content_, note_); });
        each([&](const machine_key& k, const effect& e) { refuse_rotary(k, e); });
        refuse_unknown(others);
        each([&](const machine_key& k, const effect& e) { read_one(k, e); });
        each([&](const machine_key& k, const effect& e) { check_company(k, e); });
        for (const effect* e : every_effect())
            if (e->fault) check(e->fault(axis_));
    }

private:
    template <class Use> void each(Use use) const { for_each_key(box_, use); }

    std::optional<json_node> at(std::string_view name) const {
        const auto found = content_.find(std::string(name));
        if (found == content_.end()) return {};
        return node_.at(found.key(), *found);
    }
    std::optional<json_node> find(const machine_key& k) const { return at(k.key_for(node_.kind)); }

    void refuse_rotary(const machine_key& k, const effect& e) const {
        if (!e.rotary_only || node_.kind == axis_kind::rotary) return;
        if (const auto given = find(k))
            given->refuse(fmt::format("only a rotary axis has {}; this one is linear, without {}",
                                      std::string(e.label), key_of("mass_kg", axis_kind::rotary)));
    }
    void refuse_unknown(key_names others) const {
        std::vector<std::string> known = effect_keys(box_, node_.kind);
        for (const std::string_view key : others) known.push_back(node_.name(key));
        for (const auto& [key, value] : content_.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                node_.at(key, value).refuse("unknown key" + suggestion(key, known));
    }
    void read_one(const machine_key& k, const effect& e) {
        if (k.unit_of_command) return;
        const auto given = find(k);
        if (!given && k.required) node_.at(k.key_for(node_.kind), content_).refuse("is missing");
        if (!given) return;
        if (k.shape == key_shape::number) return put_numbers(axis_, k, e, {given->number(k.rule)});
        const auto values = given->numbers(k.rule);
        if (k.shape == key_shape::harmonics && values.size() > harmonics::most)
            given->refuse(fmt::format("this version simulates {} harmonics at most", harmonics::most));
        if (k.shape == key_shape::elements && (values.empty() || values.size() > friction_contact::most))
            given->refuse(fmt::format("must have one to {} entries", friction_contact::most));
        put_numbers(axis_, k, e, values);
    }
    void check_company(const machine_key& k, const effect& e) const {
        const auto given = find(k);
        if (!given) return;
        for (const std::string_view other : k.needs)
            if (const auto name = key_in_box(box_, other, node_.kind); !other.empty() && !at(name))
                given->refuse("needs " + name);
        if (k.entries_of.empty()) return;
        const auto sizes = at(node_.name(k.entries_of));
        if ((sizes ? sizes->value->size() : 0) != numbers_of(axis_, k, e).size())
            given->refuse("must have one entry for each of " + node_.name(k.entries_of));
    }
    void check(const key_fault& fault) const {
        const machine_key* key = fault.key.empty() ? nullptr : key_named(fault.key);
        if (!key || key->box() != box_) return;
        std::string rule(fault.rule);
        if (const auto hole = rule.find("{}"); hole != rule.npos)
            rule.replace(hole, 2, node_.name(fault.other));
        find(*key)->refuse(rule);
    }

    json_node node_;
    nlohmann::json content_; ///< of the node, under the names of today
    std::string_view box_;
    axis_description& axis_;
    Note note_;
};

} // namespace quadrant::inline v0::diagnosis::detail
