// SPDX-License-Identifier: BSL-1.0
// Long: one reader, box after box of a machine file, and what each needs of the others.
#pragma once
#include "controller/json.hpp"
#include "machine_file/machine_keys.hpp"
#include "text/key_place.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// One reading of a machine file, box by box. An unknown key is reported before a missing one: it is often the
/// same slip.
class machine_reader {
public:
    machine_reader(std::string_view text, std::string_view file)
        : text_(without_byte_order_mark(text)), root_(parse_json(text, file)), top_{&root_, "", file} {}

    machine_description read() {
        need_schema(top_, "quadrant.machine/1");
        refuse_unknown_keys(top_, machine_file_keys);
        out_.file = one_line(top_.file);
        out_.sample_period_s = top_.need("sample_period_s").number(rule::positive);
        if (const auto excluded = top_.find("excluded_effects")) read_excluded(*excluded);
        each_axis(top_, [&](const std::string& name, const json_node& axis) {
            out_.axes.push_back(read_axis(name, axis));
        });
        return std::move(out_);
    }

private:
    void read_excluded(const json_node& node) {
        if (!node.value->is_array()) node.refuse("must be an array of effect names");
        const auto known = names_of_effects();
        for (const auto& entry : *node.value) {
            const json_node one{&entry, fmt::format("{}[{}]", node.path, out_.excluded_effects.size()),
                                node.file};
            const std::string& name = one.text();
            if (std::find(known.begin(), known.end(), name) == known.end())
                one.refuse(fmt::format("{} is not an effect{}", in_quotes(name), suggestion(name, known)));
            out_.excluded_effects.push_back(name);
        }
    }

    axis_description read_axis(const std::string& name, json_node node) {
        refuse_unknown_keys(node, boxes_of_effects(), axis_other_keys);
        axis_description axis;
        axis.positions_only = !node.value->contains("plant") && is_chain(node);
        axis.kind = node.kind =
            axis.positions_only ? kind_of_chain(node) : kind_of(node.need("plant").object());
        refuse_the_other_kind(node);
        axis.name = name;
        for (const std::string_view box : boxes_of_effects()) {
            const bool needed = box == "plant" && !axis.positions_only;
            const auto content = needed ? node.need("plant") : node.find(std::string(box));
            if (content) read_box(*content, box, axis);
        }
        if (const auto motor = node.find("motor_encoder")) read_motor_encoder(*motor, axis.motor_encoder);
        if (const auto pair = node.find("gantry_pair")) axis.gantry_pair = read_gantry_pair(*pair);
        if (axis.drive.closes()) settle_drive(node, axis);
        if (const auto tolerance = node.find("tolerance")) read_tolerance(*tolerance, axis.tolerance);
        if (const auto controller = node.find("controller"))
            read_controller(*controller, axis);
        else if (axis.positions_only && axis.gantry_pair)
            note(axis,
                 fmt::format("no plant is described: the difference of {} and {} is compared, and nothing is "
                             "said of forces",
                             axis.gantry_pair->first, axis.gantry_pair->second) +
                     keys_without_use(node));
        else if (axis.positions_only)
            note(axis,
                 "no plant is described: the axis is a chain of positions, and nothing is said of forces" +
                     keys_without_use(node));
        else
            note(axis, axis.drive.takes_position()
                           ? "no controller is described: diagnosed from the drive's set-points onwards"
                           : "no controller is described: diagnosed from the command onwards");
        note_what_is_assumed(axis);
        return axis;
    }

    /// Whether an axis without a plant is a chain of positions: it says something of a transmission or an
    /// encoder, and nothing that needs forces.
    static bool is_chain(const json_node& axis) {
        const auto has = [&](const char* box) { return axis.value->contains(box); };
        return (has("transmission") || has("encoder") || has("motor_encoder") || has("gantry_pair")) &&
               !has("controller") && !has("actuator") && !has("process") && !has("payload");
    }
    /// The keys of the drive of such an axis that say nothing of it, for its note.
    static std::string keys_without_use(const json_node& axis) {
        std::string out;
        if (const auto drive = axis.value->find("drive"); drive != axis.value->end() && drive->is_object())
            for (const auto& [key, value] : drive->items())
                if (key != "kind" && key != "command_delay_s" && key != "position_gain_per_s" &&
                    !key.starts_with("setpoint_rate_limit"))
                    out += (out.empty() ? "" : ", ") + key;
        return out.empty() ? out : "; not used of drive: " + out;
    }
    /// Without a plant: rotary where a key of another box is in radians (but for the motor's).
    static axis_kind kind_of_chain(const json_node& axis) {
        for (const char* box : {"transmission", "encoder", "drive"})
            if (const auto content = axis.value->find(box);
                content != axis.value->end() && content->is_object())
                for (const auto& [key, value] : content->items())
                    if (key.ends_with("_rad") && !key.ends_with("phase_rad")) return axis_kind::rotary;
        return axis_kind::linear;
    }

    static axis_kind kind_of(const json_node& plant) {
        return plant.value->contains(key_of("mass_kg", axis_kind::rotary)) ? axis_kind::rotary
                                                                           : axis_kind::linear;
    }

    /// An axis is linear or rotary throughout: a key that only the other kind has is refused where it stands.
    void refuse_the_other_kind(const json_node& axis) const {
        const axis_kind other = axis.kind == axis_kind::rotary ? axis_kind::linear : axis_kind::rotary;
        for (const auto& [box, content] : axis.value->items()) {
            if (!content.is_object()) continue;
            const auto keys_of = [box = std::string_view(box), &content = content](axis_kind kind) {
                return box == "controller" ? keys_of_controller(content, kind) : keys_of_box(box, kind, true);
            };
            const auto mine = keys_of(axis.kind), others = keys_of(other);
            for (const auto& [key, value] : content.items())
                for (std::size_t i = 0; i < others.size(); ++i) {
                    if (others[i] != key || mine[i] == key) continue;
                    const json_node fault = axis.at(box, content).at(key, value);
                    const auto [line, column] = key_place(text_, fault.path);
                    const std::string message = fmt::format(
                        "{}: belongs to a {} axis; this one is {}{}: {} (an axis has m, N and kg, or rad, Nm and "
                        "kg_m2, throughout)",
                        fault.path, name_of(other), name_of(axis.kind),
                        axis.kind == axis_kind::rotary ? "" : ", without inertia_kg_m2", mine[i]);
                    if (line > 0) throw bad_input(top_.file, line, column, message);
                    throw bad_input(top_.file, message);
                }
        }
    }

    /// The keys of a controller outside its boxes, as an axis of this kind has them.
    static std::vector<std::string> keys_of_controller(const nlohmann::json& content, axis_kind of) {
        std::vector<std::string> out;
        const auto kind = content.find("kind");
        if (kind == content.end() || !kind->is_string()) return out;
        if (const controller_kind* known = find_controller_kind(kind->get_ref<const std::string&>()))
            for (const controller_key& key : known->keys)
                if (!key.in_box()) out.push_back(key_of(key.name, of));
        return out;
    }

    void read_box(const json_node& node, std::string_view box, axis_description& axis) {
        effect_keys_reader reader(node, box, axis, [&](const std::string& text) { note(axis, text); });
        reader.read(box == "actuator"       ? key_names(actuator_other_keys)
                    : box == "drive"        ? key_names(drive_other_keys)
                    : box == "transmission" ? key_names(transmission_other_keys)
                                            : key_names());
        if (box == "transmission") read_transmission_others(node, axis.transmission);
        if (box == "drive" && !(axis.positions_only && !node.find("kind"))) {
            read_drive_kind(node, axis.drive);
            read_drive_others(node, out_.sample_period_s, axis.drive);
        }
        if (box == "plant") read_force_constant(node, axis);
        if (box == "actuator") read_own_limits(node, axis.actuator);
    }

    /// Such a drive makes the force itself: what a file says of the command's way to the force must be its own.
    static void settle_drive(const json_node& node, const axis_description& axis) {
        const auto plant = node.need("plant");
        if (axis.plant.delay_s > 0)
            plant.find("delay_s")->refuse("must be 0 beside a drive with loops of its own: its delay is "
                                          "drive.command_delay_s");
        if (axis.actuator.loss_probability)
            node.find("actuator")
                ->find("loss_probability")
                ->refuse("is of a command that is a force; a drive loses set-points: drive.set_point_loss");
        const bool servo = axis.drive.kind == drive_kind::position_servo;
        if (servo && axis.command_unit != "V")
            plant.at(plant.name("force_constant_N_per_V"), *plant.value)
                .refuse("is missing: the torque of a position_servo is duty times supply_V times it");
        if (!servo && axis.command_unit == "V")
            plant.find("force_constant_N_per_V")
                ->refuse(
                    fmt::format("a drive of kind {} makes a force by itself: leave the constant out, or give "
                                "it per ampere where a current was recorded",
                                name_of(axis.drive.kind)));
    }

    /// Its key names the unit of the command column; without one the command is the force itself.
    static void read_force_constant(const json_node& node, axis_description& axis) {
        const auto per_volt = node.find("force_constant_N_per_V"),
                   per_ampere = node.find("force_constant_N_per_A");
        if (per_volt && per_ampere)
            per_ampere->refuse("contradicts " + node.name("force_constant_N_per_V") + ": give one of them");
        axis.command_unit = per_volt ? "V" : per_ampere ? "A" : key_of("N", axis.kind);
        axis.plant.force_constant_N_per_V = per_volt     ? per_volt->number(rule::positive)
                                            : per_ampere ? per_ampere->number(rule::positive)
                                                         : 1;
        if (is_force(axis.command_unit)) axis.tolerance.given["force_constant"] = 0; // by definition
    }

    /// What the controller itself does to its command, and where the log took it.
    static void read_own_limits(const json_node& node, actuator_description& actuator) {
        for (const auto& key : actuator_keys)
            if (const auto given = node.find(key.name)) key.set(actuator, given->number(key.rule));
        const auto dac = node.find("dac_bits");
        if (dac) actuator.dac_bits = static_cast<int>(dac->number(rule::bits));
        if (dac && !actuator.dac_range_V) dac->refuse("needs dac_range_V");
        if (const auto origin = node.find("command_is")) {
            actuator.command_is = origin->text() == name_of(command_origin::measured) ? command_origin::measured
                                                                                      : command_origin::asked;
            if (origin->text() != name_of(actuator.command_is))
                origin->refuse(R"(must be "asked" or "measured")");
        }
    }

    static void read_tolerance(const json_node& node, tolerance_description& tolerance) {
        const auto names = tolerance_names(node.kind);
        std::vector<std::string_view> known(names.size());
        for (std::size_t k = 0; k < names.size(); ++k) known[k] = names[k].name;
        refuse_unknown_keys(node.object(), known);
        for (const std::string_view name : known)
            if (const auto given = node.find(std::string(name)))
                tolerance.given[std::string(name)] = given->number(rule::relative);
    }

    void read_controller(const json_node& node, axis_description& axis) {
        const std::string& name = node.object().need("kind").text();
        const controller_kind* kind = find_controller_kind(name);
        if (!kind)
            return note(axis, fmt::format("controller kind {} is not known (known: {}): diagnosed from the "
                                          "command onwards",
                                          in_quotes(name), names_of_kinds()));
        axis.controller = detail::read_controller(*kind, node, out_.sample_period_s, "kind",
                                                  [&](const std::string& text) { note(axis, text); });
    }

    void note_what_is_assumed(const axis_description& axis) {
        std::string missing;
        for (const tolerance_name& t : tolerance_names(axis.kind)) {
            const auto described = numbers_of(axis, *t.key, *t.of);
            if (t.key->unstated > 0 && !described.empty() && described[0] != 0 &&
                !axis.tolerance.given.contains(std::string(t.name)))
                missing += (missing.empty() ? "" : ", ") + key_of(t.name, axis.kind);
        }
        if (!missing.empty())
            note(axis, fmt::format("no tolerance is given for {}: {} is assumed", missing,
                                   tolerance_description::unstated));
        if (is_force(axis.command_unit) && !axis.drive.closes() && !axis.positions_only)
            note(axis, text_of("no force constant is given: the command is taken for newtons", axis.kind));
    }

    void note(const axis_description& axis, std::string_view text) {
        out_.notes.push_back(fmt::format("axis {}: {}.", axis.name, text));
    }

    std::string_view text_;
    nlohmann::json root_;
    json_node top_;
    machine_description out_{};
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL machine_description read_machine(std::string_view text, std::string_view name) {
    return detail::machine_reader(text, name).read();
}
QUADRANT_DIAGNOSIS_DECL machine_description read_machine(const std::filesystem::path& path) {
    return read_machine(detail::read_whole(path), path.string());
}

} // namespace quadrant::inline v0::diagnosis
