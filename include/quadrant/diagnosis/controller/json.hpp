// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/json_keys.hpp"
#include "kinds.hpp"

#include <set>

/// Controllers in JSON: in a machine file under `kind`, in a file of quadrant-cnc under `law`.
namespace quadrant::inline v0::diagnosis::detail {

/// The place of a key in a box of a machine file; a dotted one is that of a box inside, which is made where it
/// is missing.
inline nlohmann::ordered_json& place_in(nlohmann::ordered_json& box, std::string_view key) {
    nlohmann::ordered_json* place = &box;
    for (std::size_t dot = 0; (dot = key.find('.')) != key.npos; key.remove_prefix(dot + 1))
        place = &(*place)[std::string(key.substr(0, dot))];
    return (*place)[std::string(key)];
}

/// One value as the file has it.
inline nlohmann::ordered_json value_json(const controller_key& key, const std::vector<double>& values) {
    switch (key.form) {
    case key_form::list:
        return values;
    case key_form::word:
        return key.words.at(static_cast<std::size_t>(values.at(0)));
    case key_form::yes_no:
        return values.at(0) != 0;
    case key_form::number:
        break;
    }
    return values.at(0);
}

/// A controller under the linear keys of its kind, in their order; `named_by` is "kind" or "law".
inline nlohmann::ordered_json controller_json(const controller_description& c, const char* named_by = "kind") {
    nlohmann::ordered_json out = {{named_by, c.kind}};
    for (const controller_key& key : kind_of(c).keys)
        if (const auto given = c.values.find(key.name); given != c.values.end())
            place_in(out, key.name) = value_json(key, given->second);
    return out;
}

/// Gives what stands under an old name of a key the name that it has now.
inline void rename_old_keys(nlohmann::ordered_json& controller) {
    const controller_kind* kind = find_controller_kind(controller.value("kind", ""));
    for (const controller_key& key : kind ? kind->keys : std::span<const controller_key>()) {
        if (key.old_name.empty()) continue;
        const std::string box(key.box()), old(key.old_name);
        if (!box.empty() && !controller.contains(box)) continue;
        auto& at = box.empty() ? controller : controller[box];
        if (!at.contains(old)) continue;
        at[std::string(key.last())] = at[old];
        at.erase(old);
    }
}

/// One reading of a controller of a known kind.
class controller_reader {
public:
    /// Messages name the node; notes go to `note`. Frequencies lie below half the sampling rate.
    controller_reader(const controller_kind& kind, const json_node& node, double period,
                      const std::function<void(std::string)>& note)
        : kind_(kind), node_(node), nyquist_(0.5 / period), note_(note) {}

    controller_description read(std::string_view named_by) {
        out_.kind = kind_.name;
        refuse_unknown(node_.object(), {}, named_by);
        for (const controller_key& key : kind_.keys) {
            if (key.in_box()) {
                const auto box = node_.find(std::string(key.box()));
                if (!box) continue;
                if (boxes_.insert(key.box()).second) refuse_unknown(box->object(), key.box(), {});
                take(*box, key);
            } else {
                take(node_, key);
            }
        }
        for (const controller_key& key : kind_.keys) meet(key);
        if (kind_.examine)
            kind_.examine(
                given_values(kind_, out_),
                [this](std::string_view key, const std::string& message) {
                    const controller_key& record = kind_.key(key);
                    json_node at = node_;
                    if (record.in_box()) at = node_.need(std::string(record.box()));
                    const std::string last(record.last());
                    (at.find(last) ? *at.find(last) : at.at(at.name(last), *at.value)).refuse(message);
                },
                note_);
        return std::move(out_);
    }

private:
    void refuse_unknown(const json_node& node, std::string_view box, std::string_view named_by) const {
        std::vector<std::string_view> known;
        if (!named_by.empty()) known.push_back(named_by);
        for (const controller_key& key : kind_.keys) {
            if (key.box() == box) known.push_back(key.last());
            if (box.empty() && key.in_box()) known.push_back(key.box());
            if (key.box() == box && !key.old_name.empty()) known.push_back(key.old_name);
        }
        refuse_unknown_keys(node, known);
    }
    /// A key that a word asks for, or makes useless.
    void meet(const controller_key& key) const {
        if (key.needed_with.empty()) return;
        const controller_key& word = kind_.key(key.needed_with);
        const auto chosen = static_cast<std::size_t>(out_.number(word.name));
        if (chosen == 0) node_.need(std::string(key.name));
        if (chosen == 0 || !out_.has(key.name)) return;
        std::string of(word.name);
        std::replace(of.begin(), of.end(), '_', ' ');
        note_(fmt::format("{} is not used by the {} {}", key.name, of, word.words.at(chosen)));
    }
    void take(const json_node& node, const controller_key& key) {
        const std::string name(key.last()), old(key.old_name);
        auto given = node.find(name);
        if (const auto before = old.empty() ? std::optional<json_node>() : node.find(old)) {
            if (given) before->refuse(fmt::format("is the old name of {}, which is there too", name));
            note_(fmt::format("{} is the old name of {}", before->path, name));
            given = before;
        }
        if (!given) {
            if (key.needed) node.need(name);
            return;
        }
        out_.values[std::string(key.name)] = values_of(*given, key);
    }
    std::vector<double> values_of(const json_node& given, const controller_key& key) const {
        switch (key.form) {
        case key_form::list: {
            auto out = given.numbers(key.rule);
            if (out.size() < key.least || out.size() > key.most)
                given.refuse(fmt::format("must have {} to {} entries", key.least, key.most));
            return out;
        }
        case key_form::word: {
            const std::string& text = given.text();
            std::string all;
            for (std::size_t i = 0; i < key.words.size() && !key.words[i].empty(); ++i) {
                if (text == key.words[i]) return {static_cast<double>(i)};
                all += fmt::format("{}\"{}\"", i == 0 ? "" : " or ", key.words[i]);
            }
            given.refuse("must be " + all);
        }
        case key_form::yes_no:
            if (given.value->is_boolean()) return {given.value->get<bool>() ? 1.0 : 0.0};
            if (given.value->is_number() && (*given.value == 0 || *given.value == 1))
                return {given.value->get<double>()};
            given.refuse("must be true or false");
        case key_form::number:
            break;
        }
        const double x = given.number(key.rule);
        if (key.name.ends_with("_Hz") && x >= nyquist_)
            given.refuse(fmt::format("must lie below half the sampling rate ({:.6g} Hz)", nyquist_));
        return {x};
    }

    const controller_kind& kind_;
    const json_node& node_;
    double nyquist_;
    const std::function<void(std::string)>& note_;
    std::set<std::string_view> boxes_;
    controller_description out_{};
};

/// Reads a controller of a known kind or throws bad_input; `named_by` is the key that names the kind.
inline controller_description read_controller(const controller_kind& kind, const json_node& node, double period,
                                              std::string_view named_by,
                                              const std::function<void(std::string)>& note) {
    return controller_reader(kind, node, period, note).read(named_by);
}

/// The names of the known kinds, for messages.
inline std::string names_of_kinds() {
    std::string out;
    for (const controller_kind* kind : controller_kinds())
        out += fmt::format("{}{}", out.empty() ? "" : ", ", kind->name);
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
