// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller/json.hpp"
#include "effect/effect_list.hpp"
#include "read_diagnosis.hpp"
#include "read_machine.hpp"
#include "text/bad_input.hpp"
#include "text/text.hpp"
#include "write_machine.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// One diagnosis on one machine file.
class corrector {
public:
    corrector(const nlohmann::ordered_json& machine, std::string_view file, double at_least)
        : file_(file), at_least_(at_least), read_(read_machine(machine.dump(), file)) {
        out_.machine = machine;
    }

    applied_diagnosis take(const diagnosis_result& d) {
        const json before = out_.machine;
        for (const axis_result& a : d.axes) {
            if (!before["axes"].contains(a.name))
                throw bad_input(file_, fmt::format("axes.{}: is missing; {}", a.name, of_another));
            if (a.kind != kind_of(a.name))
                throw bad_input(file_, fmt::format("axes.{}: is a {} axis; {}", a.name,
                                                   name_of(kind_of(a.name)), of_another));
        }
        const bool with_suspects = std::any_of(d.causes.begin(), d.causes.end(),
                                               [&](const cause& c) { return taken(c) && !claimed(c); });
        for (cause c : d.causes) {
            if (with_suspects && !c.with_suspects.empty()) c.parameters = c.with_suspects;
            if (const std::string why = left_out(c, d); why.empty())
                join(c, before["axes"][c.axis]);
            else
                out_.notes.push_back(fmt::format("{} of axis {} is left out: {}", c.effect, c.axis, why));
        }
        for (const axis_result& a : d.axes) join(calibration(a, d, with_suspects), before["axes"][a.name]);
        for (const axis_result& a : d.axes)
            if (before["axes"][a.name].contains("plant")) follow(a.name, before["axes"][a.name]["plant"]);
        read_machine(out_.machine.dump(), fmt::format("{} with the diagnosis applied", file_)); // or it throws
        return std::move(out_);
    }

private:
    using json = nlohmann::ordered_json;
    static constexpr std::string_view of_another = "the diagnosis is of another machine";

    /// A group is sure where its names are not: any reading of it predicts the record.
    bool taken(const cause& c) const { return std::max(c.probability, c.group_probability) >= at_least_; }

    /// Why a cause does not go into the machine file; empty: it does.
    std::string left_out(const cause& c, const diagnosis_result& d) const {
        if (!taken(c)) {
            const bool of_force =
                c.gap_before_force_rms_N.value > 0 || !(c.gap_before_position_rms_m.value > 0);
            const std::string shrinks =
                of_force ? fmt::format("force from {:.3g} N to {:.3g} N", c.gap_before_force_rms_N.value,
                                       c.gap_after_force_rms_N.value)
                         : fmt::format("position from {:.3g} m to {:.3g} m", c.gap_before_position_rms_m.value,
                                       c.gap_after_position_rms_m.value);
            return fmt::format("probability {:.2f}, below {:g}; in the diagnosis it took the {}",
                               std::max(c.probability, c.group_probability), at_least_,
                               text_of(shrinks, kind_of(c.axis)));
        }
        if (std::find(d.own_effects.begin(), d.own_effects.end(), c.effect) != d.own_effects.end())
            return "it is an effect of your own, and a machine file has no key for it";
        const effect* known = effect_named(c.effect);
        const bool happened = known && known->keys.empty() && (known->starts || !c.parameters.empty());
        if (happened && c.effect != "controller_mismatch")
            return "it happened in this record, and a machine file has no key for it";
        return c.parameters.empty() ? "the diagnosis gives no value for it" : "";
    }

    /// What calibration moved, as a cause that the file has. A number that a cause gave stands as given.
    cause calibration(const axis_result& a, const diagnosis_result& d, bool with_suspects) const {
        cause moved;
        moved.axis = a.name, moved.effect = "calibration", moved.described = true;
        moved.parameters =
            with_suspects && !a.calibrated_with_suspects.empty() ? a.calibrated_with_suspects : a.calibrated;
        std::erase_if(moved.parameters, [&](const parameter_estimate& p) {
            return std::any_of(d.causes.begin(), d.causes.end(), [&](const cause& c) {
                return c.axis == a.name && gives(c, p.key) && left_out(c, d).empty();
            });
        });
        return moved;
    }

    axis_kind kind_of(const std::string& axis) const {
        const auto found = std::find_if(read_.axes.begin(), read_.axes.end(),
                                        [&](const axis_description& a) { return a.name == axis; });
        return found == read_.axes.end() ? axis_kind::linear : found->kind;
    }
    std::string own_key(const std::string& axis, std::string_view linear) const {
        return key_of(linear, kind_of(axis));
    }

    void join(const cause& c, const json& before) {
        refuse_if_there(c, before);
        for (const parameter_estimate& p : c.parameters) {
            const auto [box, key] = place_of(c, p.key);
            if (box == "controller" && !before.contains("controller"))
                throw bad_input(file_, fmt::format("axes.{}.controller: is missing; {}", c.axis, of_another));
            if (box == "controller") rename_old_keys(out_.machine["axes"][c.axis][box]);
            set(c.axis, box, key, value_of(p), c.effect);
        }
    }

    /// A cause that the simulation lacked, in a file that has it: the diagnosis is of another file, or applied
    /// already.
    void refuse_if_there(const cause& c, const json& axis) const {
        const std::string coulomb = own_key(c.axis, "coulomb_N"), at_rest = own_key(c.axis, "static_N");
        const auto says_something = [&](const parameter_estimate& p) {
            const auto [box, key] = place_of(c, p.key);
            if (!axis.contains(box) || !axis[box].contains(key)) return false;
            const json& value = axis[box][key];
            const machine_key* known = key_named(p.key);
            return value != (known ? known->neutral : 0.0) &&
                   !(key == at_rest && value == axis[box].value(coulomb, 0.0));
        };
        if (!c.described && std::all_of(c.parameters.begin(), c.parameters.end(), says_something))
            throw bad_input(file_,
                            fmt::format("axes.{}: has {} already, and the diagnosis found it missing: it is of "
                                        "another machine file, or applied before",
                                        c.axis, c.effect));
    }

    /// Where a parameter of a diagnosis stands in the machine file: box and key, dotted where the key is
    /// nested.
    std::pair<std::string, std::string> place_of(const cause& c, const std::string& name) const {
        if (c.effect == "controller_mismatch") return {"controller", name};
        if (const auto dot = name.find('.'); dot != name.npos)
            return {name.substr(0, dot), name.substr(dot + 1)};
        const std::string per_volt = own_key(c.axis, "force_constant_N_per_V");
        if (name != per_volt) return {"plant", name};
        const json& plant = out_.machine["axes"][c.axis]["plant"];
        for (const std::string& given : {per_volt, own_key(c.axis, "force_constant_N_per_A")})
            if (plant.contains(given)) return {"plant", given};
        throw bad_input(file_, fmt::format("axes.{}.plant.{}: is missing; {}", c.axis, per_volt, of_another));
    }

    /// A number, or an array of harmonics or elements where the machine file has one.
    static json value_of(const parameter_estimate& p) {
        const machine_key* known = key_named(p.key);
        const bool array = known && known->shape != key_shape::number;
        if (!array && p.values.size() == 1) return p.values[0].value;
        json values = json::array();
        for (const estimate& e : p.values) values.push_back(e.value);
        return values;
    }

    void set(const std::string& axis, const std::string& box, const std::string& key, const json& value,
             const std::string& reason) {
        json& old = place_in(out_.machine["axes"][axis][box], key);
        if (old == value) return;
        out_.changes.push_back({fmt::format("axes.{}.{}.{}", axis, box, key), old.is_null() ? "" : old.dump(),
                                value.dump(), reason});
        old = value;
    }

    double level(const std::string& axis, const json& plant) const { // of friction at rest
        return std::max(plant.value(own_key(axis, "coulomb_N"), 0.0),
                        plant.value(own_key(axis, "static_N"), 0.0));
    }

    bool changed(const std::string& axis, const std::string& key) const {
        const std::string path = fmt::format("axes.{}.plant.{}", axis, key);
        return std::any_of(out_.changes.begin(), out_.changes.end(),
                           [&](const auto& c) { return c.path == path; });
    }

    /// The diagnosis holds what the machine file describes otherwise: the excess of static over Coulomb
    /// friction, and the way in which friction gives way.
    void follow(const std::string& axis, const json& before) {
        const json& plant = out_.machine["axes"][axis]["plant"];
        constexpr const char* why = "moves with the friction";
        const std::string coulomb = own_key(axis, "coulomb_N"), at_rest = own_key(axis, "static_N"),
                          stiffness_key = own_key(axis, "gms_stiffness_N_per_m");
        if (changed(axis, coulomb) && before.contains(at_rest) && !changed(axis, at_rest))
            set(axis, "plant", at_rest,
                before[at_rest].get<double>() + plant[coulomb].get<double>() - before.value(coulomb, 0.0), why);
        const double was = level(axis, before), is = level(axis, plant);
        if (!before.contains(stiffness_key) || changed(axis, stiffness_key) || was == 0) return;
        json stiffness = before[stiffness_key];
        for (json& k : stiffness) k = k.get<double>() * (is / was);
        if (is != was) set(axis, "plant", stiffness_key, stiffness, why);
    }

    std::string_view file_;
    double at_least_;
    machine_description read_; ///< as it was
    applied_diagnosis out_;
};

/// Takes the causes that are code in a machine out of a diagnosis, and into the axis: the numbers of its own
/// controller, a law of its own.
inline void take_own(axis_description& axis, diagnosis_result& d, double at_least) {
    std::erase_if(d.causes, [&](const cause& c) {
        if (c.axis != axis.name || c.probability < at_least) return false;
        if (c.effect == "controller_mismatch" && axis.controller && axis.controller->own) {
            for (own_key& k : axis.controller->own->keys)
                for (const parameter_estimate& p : c.parameters)
                    if (p.key == k.key) k.value = p.values.at(0).value;
            return true;
        }
        for (const effect* own : axis.own_effects)
            if (own->name == c.effect && own->law) {
                axis_description::valued_law found{own->law, {}};
                for (std::size_t i = 0; i < own->law->count(); ++i)
                    for (const parameter_estimate& p : c.parameters)
                        if (p.key == own->law->numbers[i].key) found.values[i] = p.values.at(0).value;
                std::erase_if(axis.laws, [&](const auto& l) { return l.law == own->law; });
                axis.laws.push_back(found);
                return true;
            }
        return false;
    });
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL applied_diagnosis apply(std::string_view machine_text, std::string_view machine_file,
                                                const diagnosis_result& d, double at_least) {
    read_machine(machine_text, machine_file);
    const std::string_view text = detail::without_byte_order_mark(machine_text);
    return detail::corrector(nlohmann::ordered_json::parse(text), machine_file, at_least).take(d);
}

QUADRANT_DIAGNOSIS_DECL machine_description apply(const machine_description& machine, diagnosis_result d,
                                                  double at_least) {
    std::vector<axis_description> code = machine.axes;
    for (axis_description& axis : code) detail::take_own(axis, d, at_least);
    const std::string file = machine.file.empty() ? "the machine" : machine.file;
    auto out = read_machine(apply(to_json(machine).dump(), file, d, at_least).machine.dump(), file);
    for (axis_description& axis : out.axes)
        for (axis_description& own : code)
            if (axis.name == own.name) {
                if (own.controller && own.controller->own) axis.controller = std::move(own.controller);
                axis.own_effects = std::move(own.own_effects);
                std::copy_if(own.laws.begin(), own.laws.end(), std::back_inserter(axis.laws),
                             [](const auto& l) { return !is_listed(l.law); });
            }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
