// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../controller/json.hpp"
#include "../effect_names.hpp"
#include "../plant_model.hpp"
#include "../read/key_place.hpp"
#include "../read/machine_keys.hpp"
#include "../read_machine.hpp"

namespace quadrant::diagnosis {

namespace detail {

/// One reading of a machine file, box by box. An unknown key is told before a missing one: it is often the same slip.
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
        constexpr auto known = names_of(effect_names);
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
        refuse_unknown_keys(node, axis_keys);
        axis_description axis;
        axis.kind = node.kind = kind_of(node.need("plant").object());
        refuse_the_other_kind(node);
        axis.name = name;
        read_plant(node.need("plant"), axis);
        if (const auto tolerance = node.find("tolerance")) read_tolerance(*tolerance, axis.tolerance);
        if (const auto encoder = node.find("encoder")) read_encoder(*encoder, axis.encoder);
        if (const auto process = node.find("process")) read_process(*process, axis.process);
        if (const auto actuator = node.find("actuator")) read_actuator(*actuator, axis.actuator);
        if (const auto controller = node.find("controller"))
            read_controller(*controller, axis);
        else
            note(axis, "no controller is described: diagnosed from the command onwards");
        note_what_is_assumed(axis);
        return axis;
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
            const auto known = box == "controller" ? keys_of_controller(content) : keys_of_box(box);
            for (const auto& [key, value] : content.items())
                for (const std::string_view linear : known) {
                    if (key_of(linear, other) != key || key_of(linear, axis.kind) == key) continue;
                    const json_node fault = axis.at(box, content).at(key, value);
                    const auto [line, column] = key_place(text_, fault.path);
                    const std::string message = fmt::format(
                        "{}: is of a {} axis; this one is {}{}: {} (an axis has m, N and kg, or rad, Nm and "
                        "kg_m2, throughout)",
                        fault.path, name_of(other), name_of(axis.kind),
                        axis.kind == axis_kind::rotary ? "" : ", without inertia_kg_m2",
                        key_of(linear, axis.kind));
                    if (line > 0) throw bad_input(top_.file, line, column, message);
                    throw bad_input(top_.file, message);
                }
        }
    }

    /// The keys of a controller outside its boxes, by their linear names.
    static std::vector<std::string_view> keys_of_controller(const nlohmann::json& content) {
        std::vector<std::string_view> out;
        const auto kind = content.find("kind");
        if (kind == content.end() || !kind->is_string()) return out;
        if (const controller_kind* known = find_controller_kind(kind->get_ref<const std::string&>()))
            for (const controller_key& key : known->keys)
                if (!key.in_box()) out.push_back(key.name);
        return out;
    }

    static void read_plant(const json_node& node, axis_description& axis) {
        auto& plant = axis.plant;
        read_numbers(node, plant_keys, plant_other_keys, plant);
        const auto per_volt = node.find("force_constant_N_per_V"),
                   per_ampere = node.find("force_constant_N_per_A");
        if (per_volt && per_ampere)
            per_ampere->refuse("contradicts " + node.name("force_constant_N_per_V") + ": give one of them");
        axis.command_unit = per_volt ? "V" : per_ampere ? "A" : key_of("N", axis.kind);
        plant.force_constant_N_per_V = per_volt     ? per_volt->number(rule::positive)
                                       : per_ampere ? per_ampere->number(rule::positive)
                                                    : 1;
        if (is_force(axis.command_unit)) axis.tolerance.given["force_constant"] = 0; // by definition

        if (plant.static_N && !plant.stribeck_velocity_m_per_s)
            node.find("static_N")->refuse("needs " + node.name("stribeck_velocity_m_per_s"));
        if (plant.stribeck_velocity_m_per_s && !plant.static_N)
            node.find("stribeck_velocity_m_per_s")->refuse("needs " + node.name("static_N"));
        if (plant.static_N && *plant.static_N < plant.coulomb_N.value_or(0))
            node.find("static_N")->refuse("must not lie below " + node.name("coulomb_N"));

        read_harmonics(node, "cogging_N", "cogging_phase_rad", plant.cogging_N, plant.cogging_phase_rad);
        need_each_other(node, "cogging_period_m", "cogging_N");
        need_each_other(node, "friction_position_amplitude", "friction_position_period_m");
        need_each_other(node, "friction_drift", "friction_drift_time_s");
        need_each_other(node, "mode_mass_kg", "mode_frequency_Hz");
        need_each_other(node, "ripple", "ripple_period_m");
        if (plant.mode_mass_kg.value_or(0) >= plant.mass_kg)
            node.find("mode_mass_kg")
                ->refuse(fmt::format("must lie below {}, of which it is a part", node.name("mass_kg")));
        read_contact(node, plant);
    }

    static void read_contact(const json_node& node, plant_description& plant) {
        need_each_other(node, "gms_weights", "gms_stiffness_N_per_m");
        const auto weights = node.find("gms_weights"), length = node.find("presliding_length_m");
        for (const auto& described : {length, weights})
            if (described && !plant.coulomb_N && !plant.static_N)
                described->refuse(fmt::format("needs {}: the friction that gives way", node.name("coulomb_N")));
        if (!weights) return;
        plant.gms_weights = weights->numbers(rule::positive);
        plant.gms_stiffness_N_per_m = node.need("gms_stiffness_N_per_m").numbers(rule::positive);
        if (plant.gms_weights.empty() || plant.gms_weights.size() > friction_contact::most)
            weights->refuse(fmt::format("must have one to {} entries", friction_contact::most));
        if (plant.gms_stiffness_N_per_m.size() != plant.gms_weights.size())
            node.find("gms_stiffness_N_per_m")->refuse("must have one entry for each of gms_weights");
        const double sum = std::accumulate(plant.gms_weights.begin(), plant.gms_weights.end(), 0.0);
        if (std::abs(sum - 1) > 1e-3) weights->refuse("must add up to 1: shares of the friction level");
        plant.presliding_length_m.reset(); // the elements say it more exactly
    }

    static void need_each_other(const json_node& node, const char* one, const char* other) {
        for (const auto& [here, missing] : {std::pair{one, other}, std::pair{other, one}})
            if (const auto given = node.find(here); given && !node.find(missing))
                given->refuse(fmt::format("needs {}", node.name(missing)));
    }
    static void read_harmonics(const json_node& node, const char* sizes_key, const char* phases_key,
                               std::vector<double>& sizes, std::vector<double>& phases) {
        const auto size = node.find(sizes_key), phase = node.find(phases_key);
        if (size) sizes = size->numbers(rule::any_number);
        if (sizes.size() > harmonics::most)
            size->refuse(fmt::format("this version simulates {} harmonics at most", harmonics::most));
        if (phase) phases = phase->numbers(rule::any_number);
        if (phase && phases.size() != sizes.size())
            phase->refuse(fmt::format("must have one entry for each of {}", node.name(sizes_key)));
    }

    static void read_encoder(const json_node& node, encoder_description& encoder) {
        read_numbers(node, encoder_keys, {}, encoder);
        need_each_other(node, "cyclic_m", "cyclic_period_m");
    }
    static void read_process(const json_node& node, process_description& process) {
        read_numbers(node, process_keys, process_other_keys, process);
        read_harmonics(node, "force_N", "phase_rad", process.force_N, process.phase_rad);
        need_each_other(node, "fundamental_Hz", "force_N");
    }

    static void read_tolerance(const json_node& node, tolerance_description& tolerance) {
        refuse_unknown_keys(node.object(), names_of(tolerance_keys));
        for (const auto& key : tolerance_keys)
            if (const auto given = node.find(std::string(key.name)))
                tolerance.given[std::string(key.name)] = given->number(rule::relative);
    }

    static void read_actuator(const json_node& node, actuator_description& actuator) {
        read_numbers(node, actuator_keys, actuator_other_keys, actuator);
        const auto dac = node.find("dac_bits");
        if (dac) actuator.dac_bits = static_cast<int>(dac->number(rule::bits));
        if (dac && !actuator.dac_range_V) dac->refuse("needs dac_range_V");
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
        for (const auto& key : tolerance_keys)
            if (key.of(axis.plant) != 0 && !axis.tolerance.given.contains(std::string(key.name)))
                missing += (missing.empty() ? "" : ", ") + key_of(key.name, axis.kind);
        if (!missing.empty())
            note(axis, fmt::format("no tolerance is given for {}: {} is assumed", missing,
                                   tolerance_description::unstated));
        if (is_force(axis.command_unit))
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

} // namespace quadrant::diagnosis
