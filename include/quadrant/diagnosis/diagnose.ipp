// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/effect_list.hpp"
#include "next/blind_spots.hpp"
#include "text/bad_input.hpp"
#include "verdict/looked_axis.hpp"
#include "verdict/own_words.hpp"
#include "verdict/set_points_between_rows.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// An axis of which nothing but positions is known.
inline void diagnose_positions(diagnosis_result& out, const axis_description& axis, const axis_log& log,
                               const machine_description& machine, const std::string& file, const rules& r) {
    std::vector<cause> causes;
    axis_result result = chain::diagnose_positions(out, causes, axis, log, machine.sample_period_s, file,
                                                   machine.excluded_effects, r);
    put_in_words(result.kind, result.where);
    put_in_words(result.kind, result.calibrated);
    put_in_words(result.kind, causes);
    out.verdict = std::max(out.verdict, result.verdict);
    if (result.verdict > verdict::within_tolerance)
        out.causes.insert(out.causes.end(), causes.begin(), causes.end());
    const auto unseen = unseen_by(result, causes);
    out.not_seen.insert(out.not_seen.end(), unseen.begin(), unseen.end());
    out.axes.push_back(std::move(result));
}

/// The rules with this axis' share of the time that is left for `axes`.
inline rules for_one_of(rules r, std::ptrdiff_t axes) {
    if (r.until != rules::clock::time_point::max()) {
        const auto now = r.now();
        r.until = now + (r.until - now) / axes;
    }
    return r;
}

/// Effects of the caller's own have names of their own.
inline void add_own_effects(std::vector<std::string>& names, const axis_description& axis) {
    const auto& own = axis.own_effects;
    for (auto e = own.begin(); e != own.end(); ++e) {
        const auto refuse = [&](const std::string& why) {
            throw std::invalid_argument(fmt::format("own_effects of axis {}: {}", axis.name, why));
        };
        if (!*e || !(*e)->starts || !(*e)->read) refuse("one is null, or has no starts or no reading");
        const std::string_view name = (*e)->name;
        if (effect_named(name)) refuse(fmt::format("{} is a name of the list", name));
        if (std::any_of(own.begin(), e, [&](const effect* before) { return before->name == name; }))
            refuse(fmt::format("{} is there twice", name));
        if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
    }
}

/// An axis whose forces are known. A force constant that is not the described one makes wind-up and the motor's
/// friction of what is none: where it is found beside them, the two encoders are compared once more with the
/// force that it gives.
inline void diagnose_forces(diagnosis_result& out, const axis_description& a, const axis_log& logged,
                            const read_logs& logs, const progress& tell, const rules& all,
                            const rules& limits) {
    looked_axis looked(a, logged, logs, all);
    add_own_effects(out.own_effects, looked.ready->axis);
    if (const auto& controller = looked.ready->axis.controller;
        controller && controller->own) // its file's kind is known after all
        std::erase_if(out.notes, [&](const std::string& note) {
            return note.starts_with(fmt::format("axis {}: controller kind ", a.name));
        });
    looked.look(logs, tell, limits);
    look_between_rows(looked, a, logged, logs, tell, all, limits);
    if (const auto constant = looked.found_by_force() > 0 ? looked.force_constant() : std::nullopt) {
        axis_description by = looked.ready->axis;
        by.plant.force_constant_N_per_V = *constant;
        looked_axis again(a, logged, logs, all, &by);
        if (again.found_by_force() < looked.found_by_force()) {
            tell("axis " + a.name + ": again, with the force constant that was found");
            again.look(logs, tell, limits);
            looked = std::move(again);
        }
    }
    ready_axis& ready = *looked.ready;
    out.notes.insert(out.notes.end(), looked.notes.begin(), looked.notes.end());
    if (looked.found->exchanged) ready.others.logs.clear(); // they are of the other log
    diagnose_axis(out, *looked.found, tell, ready.stage, ready.transmission ? &*ready.transmission : nullptr,
                  ready.others);
    tell("axis " + a.name + ": done", 1);
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL diagnosis_result diagnose(const machine_description& machine,
                                                  const machine_log& as_read, const machine_log* as_read_too,
                                                  const progress& tell, const rules& r) {
    diagnosis_result out;
    const detail::read_logs logs(machine, as_read, as_read_too);
    const machine_log* const holdout = logs.holdout();
    out.machine_file = machine.file;
    out.log_file = logs.log.file;
    if (holdout) out.holdout_file = holdout->file;
    out.notes = machine.notes;
    out.notes.insert(out.notes.end(), logs.log.notes.begin(), logs.log.notes.end());
    if (holdout) out.notes.insert(out.notes.end(), holdout->notes.begin(), holdout->notes.end());
    const auto moved = [&](const axis_description& axis) {
        const axis_log* const logged = detail::named(logs.log.axes, axis.name);
        return logged && !logged->still ? logged : nullptr;
    };
    auto axes_left = std::count_if(machine.axes.begin(), machine.axes.end(), moved);
    const auto all_axes = static_cast<double>(axes_left);
    for (const axis_description& axis : machine.axes) {
        const axis_log* const logged = moved(axis);
        if (!logged) continue;
        const auto behind = all_axes - static_cast<double>(axes_left);
        const progress of_axis = tell.part(behind / all_axes, (behind + 1) / all_axes);
        of_axis("axis " + axis.name + ": " + std::to_string(logs.log.samples) + " samples");
        if (!axis.positions_only) {
            detail::diagnose_forces(out, axis, *logged, logs, of_axis, r, detail::for_one_of(r, axes_left--));
            continue;
        }
        detail::diagnose_positions(out, axis, *logged, machine, logs.log.file,
                                   detail::for_one_of(r, axes_left--));
        if (holdout)
            out.notes.push_back(fmt::format(
                "axis {}: the hold-out log is not used where only positions are known.", axis.name));
    }
    tell("done", 1);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
