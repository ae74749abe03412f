// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant/diagnosis/machine_file/machine_keys.hpp"

/// What the JSON schemas say of effects: definitions that follow from the records of the list.
namespace effect_tables {
using namespace quadrant::diagnosis;
using nlohmann::ordered_json;

inline ordered_json reference(std::string_view definition) {
    return {{"$ref", fmt::format("#/$defs/{}", definition)}};
}

/// Names of the file as definitions: boxes of a rotary axis are apart.
inline std::string definition_of(std::string_view box, axis_kind kind) {
    return kind == axis_kind::rotary ? fmt::format("rotary_{}", box) : std::string(box);
}

inline ordered_json effect_names() { return {{"enum", names_of_effects()}}; }

inline ordered_json one_key(const machine_key& k) {
    ordered_json out{{"description", k.meaning}};
    const char* shape = k.shape == key_shape::number     ? k.rule.schema
                        : k.shape == key_shape::elements ? "elements"
                                                         : "harmonics";
    out.update(reference(shape));
    return out;
}

/// Keys of a drive that belong to no effect. Which kind has which of all keys is the reader's to say.
inline void add_drive(axis_kind kind, ordered_json& properties) {
    const auto number = [&](std::string_view key, const char* shape, const char* meaning) {
        auto& out = properties[key_of(key, kind)] = {{"description", meaning}};
        out.update(reference(shape));
    };
    properties["kind"] = {{"description", "what the drive takes: its command column"}, {"enum", drive_kinds}};
    properties["interpolation"] = {
        {"description", "how the drive goes from one set-point to the next; absent: hold"},
        {"enum", interpolations}};
    number("velocity_filter_Hz", "positive", "corner of the first-order filter of the velocity; absent: none");
    number("velocity_feedforward", "number", "share of the set-points' velocity; absent: 0");
    number("set_point_period_s", "positive", "from one set-point to the next; absent: sample_period_s");
}

/// Keys of a transmission that belong to no effect.
inline void add_transmission(axis_kind kind, ordered_json& properties) {
    const auto number = [&](const char* key, const char* rule, const char* meaning) {
        properties[key_of(key, kind)] = {{"description", meaning}};
        properties[key_of(key, kind)].update(reference(rule));
    };
    properties["kind"] = {{"description", "what carries the motion"}, {"enum", transmission_kinds}};
    number("damping_N_s_per_m", "not_negative", "beside the stiffness; absent: none");
    number("motor_mass_kg", "positive",
           "the part of the plant's mass on the motor's side, in units of the load");
}

/// The encoder on the motor.
inline ordered_json motor_encoder(axis_kind kind) {
    ordered_json properties = {{"resolution_rad", reference("positive")}};
    if (kind == axis_kind::linear) properties["resolution_m"] = reference("positive");
    return {
        {"description", "beside the scale: one count, in radians of the motor's turn or in units of the load"},
        {"type", "object"},
        {"additionalProperties", false},
        {"properties", properties}};
}

/// Two axes of the log in one; the same for either kind.
inline ordered_json gantry_pair() {
    return {{"description", "Two motors on one beam, each an axis of the log."},
            {"type", "object"},
            {"additionalProperties", false},
            {"required", {"ends"}},
            {"properties",
             {{"ends",
               {{"type", "array"},
                {"items", {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}}},
                {"minItems", 2},
                {"maxItems", 2}}},
              {"share",
               {{"description", "of the mass at the first end"},
                {"type", "number"},
                {"exclusiveMinimum", 0},
                {"exclusiveMaximum", 1}}}}}};
}

/// Keys of the box that belong to no effect.
inline void add_others(std::string_view box, axis_kind kind, ordered_json& properties, ordered_json& together) {
    if (box == "drive") return add_drive(kind, properties);
    if (box == "transmission") return add_transmission(kind, properties);
    if (box != "actuator") return;
    properties["limit_V"] = {{"description", "the controller's own limit"}};
    properties["limit_V"].update(reference("positive"));
    properties["dac_bits"] = {{"type", "integer"}, {"minimum", 1}, {"maximum", 32}};
    properties["command_is"] = {
        {"description",
         "where the log's command column was taken; measured: behind the amplifier, so that limit, "
         "dead zone, lag, delay and lost samples before it cannot be causes"},
        {"enum", {"asked", "measured"}}};
    properties["dac_range_V"] = {{"description", "whole range of the DAC: 20 for +-10 V"}};
    properties["dac_range_V"].update(reference("positive"));
    together["dac_bits"] = {"dac_range_V"};
}

/// One box of an axis.
inline ordered_json box(std::string_view name, axis_kind kind) {
    ordered_json properties = ordered_json::object(), together = ordered_json::object(),
                 needed = ordered_json::array(), either = ordered_json::array();
    for_each_key(name, [&](const machine_key& k, const effect& e) {
        if (e.rotary_only && kind == axis_kind::linear) return;
        std::string key = k.key_for(kind);
        if (k.unit_of_command)
            for (const char unit : detail::command_units) {
                key.back() = unit;
                properties[key] = one_key(k);
                either.push_back(key);
            }
        else
            properties[key] = one_key(k);
        if (k.required) needed.push_back(key);
        for (const std::string_view other : k.needs)
            if (!other.empty()) together[key].push_back(key_in_box(name, other, kind));
        if (!k.entries_of.empty() && !together.contains(key)) together[key] = {key_of(k.entries_of, kind)};
    });
    add_others(name, kind, properties, together);
    ordered_json out{{"type", "object"}, {"additionalProperties", false}};
    if (!needed.empty()) out["required"] = needed;
    if (!either.empty()) out["not"] = {{"required", either}};
    if (!together.empty()) out["dependentRequired"] = together;
    out["properties"] = properties;
    return out;
}

inline ordered_json tolerance(axis_kind kind) {
    ordered_json properties = ordered_json::object();
    for (const auto& t : detail::tolerance_names(kind))
        properties[key_of(t.name, kind)] = reference("relative");
    return {{"description",
             "Relative uncertainty of a value as the owner knows it: a hard bound, uniform inside; "
             "absent means 0.05."},
            {"type", "object"},
            {"additionalProperties", false},
            {"properties", properties}};
}

/// The axis itself: the boxes with keys of effects and those beside them.
inline ordered_json axis(axis_kind kind) {
    ordered_json properties = ordered_json::object();
    for (const std::string_view name : detail::boxes_of_effects())
        properties[std::string(name)] = reference(definition_of(name, kind));
    for (const std::string_view name : detail::axis_other_keys)
        properties[std::string(name)] = reference(definition_of(name, kind));
    ordered_json chain = ordered_json::array(); // without a plant: a chain of positions
    for (const char* box : {"plant", "transmission", "encoder", "motor_encoder", "gantry_pair"})
        chain.push_back({{"required", {box}}});
    return {{"type", "object"},
            {"anyOf", chain},
            {"if", {{"required", {"plant"}}}},
            {"then", {{"properties", {{"drive", {{"required", {"kind"}}}}}}}},
            {"additionalProperties", false},
            {"properties", properties}};
}

/// The generated definitions of the machine file.
inline ordered_json machine_definitions() {
    ordered_json out{{"effect", effect_names()}};
    for (const axis_kind kind : {axis_kind::linear, axis_kind::rotary}) {
        out[definition_of("axis", kind)] = axis(kind);
        for (const std::string_view name : detail::boxes_of_effects())
            out[definition_of(name, kind)] = box(name, kind);
        out[definition_of("tolerance", kind)] = tolerance(kind);
        out[definition_of("motor_encoder", kind)] = motor_encoder(kind);
        out[definition_of("gantry_pair", kind)] = gantry_pair();
    }
    return out;
}

/// JSON with what is short on one line.
inline std::string laid_out(const ordered_json& value, std::size_t indent, std::size_t before) {
    constexpr std::size_t width = 112;
    std::string line;
    if (!value.is_structured()) return value.dump();
    const auto items = [&](auto&& each) {
        for (const auto& [key, child] : value.items())
            each(value.is_object() ? fmt::format("{}: ", ordered_json(key).dump()) : std::string(), child);
    };
    const char open = value.is_object() ? '{' : '[', close = value.is_object() ? '}' : ']';
    items([&](const std::string& name, const ordered_json& child) {
        line += (line.empty() ? "" : ", ") + name + laid_out(child, 0, 0);
    });
    const bool flat = line.find('\n') == line.npos && indent + before + line.size() + 3 <= width;
    if (flat) return open + line + close;
    std::string out(1, open);
    items([&](const std::string& name, const ordered_json& child) {
        out += (out.size() > 1 ? ",\n" : "\n") + std::string(indent + 2, ' ') + name +
               laid_out(child, indent + 2, name.size());
    });
    return out + "\n" + std::string(indent, ' ') + close;
}

/// Definitions as they stand in a schema, each with its comma.
inline std::string as_definitions(const ordered_json& all) {
    std::string out;
    for (const auto& [name, value] : all.items())
        out += fmt::format("    \"{}\": {},\n", name, laid_out(value, 4, name.size() + 4));
    return out;
}

} // namespace effect_tables
