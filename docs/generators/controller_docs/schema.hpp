// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/controller/json.hpp>

/// docs/schema/controllers.schema.json from the records of the controller kinds.
namespace controller_docs {

using namespace quadrant::diagnosis;
using json = nlohmann::ordered_json;

/// The rule of a number as JSON Schema has it; one that none of the common rules is must be of whole numbers.
inline json schema_of(const detail::number_rule& rule) {
    constexpr double largest = 1e12;
    if (rule.holds == detail::rule::positive.holds)
        return {{"type", "number"}, {"minimum", 1 / largest}, {"maximum", largest}};
    if (rule.holds == detail::rule::not_negative.holds)
        return {{"type", "number"}, {"minimum", 0}, {"maximum", largest}};
    if (rule.holds == detail::rule::any_number.holds)
        return {{"type", "number"}, {"minimum", -largest}, {"maximum", largest}};
    int low = -1000, high = 1000;
    while (low < high && !rule.holds(low)) ++low;
    while (high > low && !rule.holds(high)) --high;
    return {{"type", "integer"}, {"minimum", low}, {"maximum", high}};
}

inline json schema_of(const controller_key& key) {
    json out;
    switch (key.form) {
    case key_form::number:
        out = schema_of(key.rule);
        break;
    case key_form::list:
        out = {
            {"type", "array"}, {"items", schema_of(key.rule)}, {"minItems", key.least}, {"maxItems", key.most}};
        break;
    case key_form::word:
        out["enum"] = json::array();
        for (const auto& word : key.words)
            if (!word.empty()) out["enum"].push_back(word);
        break;
    case key_form::yes_no:
        out["enum"] = {true, false, 1, 0};
        break;
    }
    out["description"] = key.says;
    return out;
}

/// Where a kind is described: in a machine file of either sort of axis, or in a file of quadrant-cnc, where the
/// drive says what the law believes of the plant.
struct place {
    const char* prefix;
    const char* named_by;
    axis_kind axis;
    bool drive_is_known;
};
inline constexpr std::array places{place{"", "kind", axis_kind::linear, false},
                                   place{"rotary_", "kind", axis_kind::rotary, false},
                                   place{"law_", "law", axis_kind::linear, true}};

inline json object(json first) {
    return {{"type", "object"},
            {"required", json::array()},
            {"additionalProperties", false},
            {"properties", std::move(first)}};
}

inline json schema_of(const controller_kind& kind, const place& at) {
    json out = object({{at.named_by, {{"const", kind.name}}}});
    out["required"].push_back(at.named_by);
    for (const controller_key& key : kind.keys) {
        json* box = &out;
        if (key.in_box()) {
            json& boxes = out["properties"][std::string(key.box())];
            if (boxes.is_null()) boxes = object(json::object());
            box = &boxes;
        }
        const std::string name = key_of(key.last(), at.axis), old(key.old_name);
        (*box)["properties"][name] = schema_of(key);
        const bool told = at.drive_is_known && key.name.starts_with("plant_");
        if (!key.needed_with.empty())
            out["anyOf"] = {
                {{"required", {name}}},
                {{"required", {key.needed_with}},
                 {"not",
                  {{"properties",
                    {{std::string(key.needed_with), {{"const", kind.key(key.needed_with).words[0]}}}}}}}}};
        if (!key.needed || told) continue;
        if (old.empty()) {
            (*box)["required"].push_back(name);
        } else {
            (*box)["properties"][old] = schema_of(key);
            (*box)["properties"][old]["deprecated"] = true;
            (*box)["oneOf"] = {{{"required", {name}}}, {{"required", {old}}}};
        }
    }
    return out;
}

/// The whole schema.
inline json schema() {
    json defs = json::object();
    for (const place& at : places) {
        const bool open = std::string_view(at.named_by) == "kind";
        json kinds = json::array(), names = json::array();
        for (const controller_kind* kind : controller_kinds()) {
            const std::string ref = fmt::format("#/$defs/{}{}", at.prefix, kind->name);
            kinds.push_back({{"if", {{"properties", {{at.named_by, {{"const", kind->name}}}}}}},
                             {"then", {{"$ref", ref}}}});
            names.push_back(kind->name);
        }
        json name{{"type", "string"}};
        if (!open) name["enum"] = names;
        json any{{"type", "object"}, {"required", {at.named_by}}, {"properties", {{at.named_by, name}}}};
        if (open)
            any["description"] =
                "Of a kind that is not known nothing is checked: the axis is diagnosed from the "
                "command onwards.";
        any["allOf"] = kinds;
        defs[open ? fmt::format("{}controller", at.prefix) : std::string("law")] = any;
        for (const controller_kind* kind : controller_kinds())
            defs[fmt::format("{}{}", at.prefix, kind->name)] = schema_of(*kind, at);
    }
    return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
            {"title", "Controllers in machine files of quadrant, and laws in files of quadrant-cnc"},
            {"description",
             "Written by controller_docs from the records of the kinds. SI units, named in every key."},
            {"$defs", defs}};
}

} // namespace controller_docs
