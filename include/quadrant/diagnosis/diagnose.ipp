// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "chain/diagnose_chain.hpp"
#include "effect/effect_list.hpp"
#include "fit/both_motions.hpp"
#include "fit/neighbour.hpp"
#include "fit/turned_beam.hpp"
#include "fit/with_drives.hpp"
#include "how_far/how_far.hpp"
#include "log/thinned.hpp"
#include "next/blind_spots.hpp"
#include "next/next_experiment.hpp"
#include "text/bad_input.hpp"
#include "which/as_applied.hpp"
#include "which/block_places.hpp"
#include "which/calibrated.hpp"
#include "which/causes.hpp"
#include "which/turning_inertia.hpp"

#include <memory>

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline verdict judge(const axis_case& c, const std::vector<cause>& causes) {
    if ((c.at_floor() || c.within_its_laws()) && !c.count_unnamed && !c.controller_open()) {
        // Suspects for what calibration leaves are no finding where machines inside the tolerances differ more.
        const bool silent =
            causes.empty() || (std::none_of(causes.begin(), causes.end(), claimed) &&
                               (c.models.immaterial(c.path.front()) || c.calibrated_within_its_laws() ||
                                c.calibrated_within_tolerances()));
        if (!silent)
            return std::all_of(causes.begin(), causes.end(), claimed) || c.claims_suffice()
                       ? verdict::explained
                       : verdict::partly_explained;
        const auto& given = c.models.given();
        // What a law of friction may be wrong by is no gap where calibration does no better.
        const bool as_given =
            !c.models.pays(c.models.calibrated(), given) &&
            (c.models.structure(given, c.noise) < c.limits.structure || c.calibrated_within_its_laws());
        return as_given ? verdict::no_gap : verdict::within_tolerance;
    }
    const bool blamed = std::any_of(causes.begin(), causes.end(), claimed);
    if (!blamed && !c.count_unnamed && !c.controller_open() && c.calibrated_within_tolerances())
        return verdict::within_tolerance;
    const bool helps =
        std::any_of(causes.begin(), causes.end(), [](const cause& x) { return x.shrink.value > 0.2; });
    return helps ? verdict::partly_explained : verdict::unexplained;
}

/// What is left when every cause is added: how large, and in which regimes.
inline void describe_rest(diagnosis_result& out, const axis_case& c, const axis_result& result,
                          const std::vector<cause>& causes) {
    const double floor = square(c.floor_force());
    double before = std::max(0.0, square(result.gap.force_rms_N) - floor);
    double after = c.at_floor() ? 0 : std::max(0.0, square(result.gap_after.force_rms_N) - floor);
    if (c.count_unnamed)
        before = after = std::max(before, floor); // finer steps are missing, and no suspect gives them
    std::string text = "axis " + c.axis.name + ": ";
    if (c.controller_differs()) {
        before += square(rms(c.command_difference(c.log, *c.axis.controller)));
        after += square(rms(c.command_left()));
        if (c.controller_open())
            text += std::string("the controller that ran is not the one described") +
                    (c.controller_unnamed ? ", which the machine file excludes; "
                                          : " and no single key of it mends the replay; ");
    }
    if (c.count_unnamed)
        text += worded("the position moves in steps of %.4g m where %.4g m are described; ", c.count,
                       c.axis.encoder.resolution_m);
    if (c.at_floor()) {
        text += worded("%.3g N rms behind the command (floor %.3g N), which does not matter",
                       result.gap_after.force_rms_N, c.floor_force());
    } else {
        text += worded("%.3g N rms behind the command (floor %.3g N)", result.gap_after.force_rms_N,
                       c.floor_force());
        if (c.within_its_laws()) text += ", no more than the laws of friction and of the causes are wrong by";
        auto views = regimes(c.models.held_out_residual(c.best()), c.record);
        std::erase_if(views, [](const place& v) { // an even spread over time says nothing
            return v.view == "time" && v.share.value > 0.35 && v.share.value < 0.65;
        });
        std::stable_sort(views.begin(), views.end(),
                         [](const auto& a, const auto& b) { return a.share.value > b.share.value; });
        for (std::size_t i = 0; i < std::min<std::size_t>(3, views.size()); ++i)
            text += worded("; %.0f %% ", 100 * views[i].share.value) + views[i].finding;
        const auto forms = c.models.forms();
        std::vector<candidate> with_form;
        if (!c.models.over()) with_form = c.models.with_these(c.best(), forms, c.limits.forms);
        for (std::size_t i = 0; i < with_form.size(); ++i)
            if (const double share = c.takes_off(with_form[i], c.best());
                share > 0.5 && c.models.pays(with_form[i], c.best()))
                text += worded("; a force that follows %s and is in no list takes %.0f %% off",
                               std::string(forms[i]->name).c_str(), 100 * share);
        for (const cause& x : causes)
            if (!x.better_form.empty())
                text += worded("; a force that follows %s and is in no list predicts better than %s",
                               x.better_form.c_str(), x.effect.c_str());
    }
    out.share_unexplained =
        std::max(out.share_unexplained, before > 0 ? std::clamp(after / before, 0.0, 1.0) : 0);
    out.remaining_structure += (out.remaining_structure.empty() ? "" : "; ") + text_of(text, c.axis.kind);
}

/// Keys and sentences as the axis' own kind has them.
inline void put_in_words(axis_kind kind, std::vector<parameter_estimate>& parameters) {
    for (auto& p : parameters) {
        const machine_key* key = key_named(p.key);
        p.key = key ? key->name_for(kind) : key_of(p.key, kind);
    }
}
inline void put_in_words(axis_kind kind, std::vector<place>& places) {
    for (place& p : places) p.finding = text_of(p.finding, kind);
}
inline void put_in_words(axis_kind kind, std::vector<cause>& causes) {
    for (cause& x : causes) {
        put_in_words(kind, x.parameters);
        put_in_words(kind, x.with_suspects);
        for (reading& r : x.readings) put_in_words(kind, r.parameters);
        x.exciting_motion = text_of(x.exciting_motion, kind);
    }
}

/// One block and no hold-out log: nothing is left to test a cause on that was not fitted.
inline bool untested(const axis_case& c) { return !c.second && c.record.segments < 2; }

/// A value that the tolerance stopped: either the tolerance is too narrow, or something else acts.
inline void note_bounds(diagnosis_result& out, const axis_result& result) {
    for (const parameter_estimate& p : result.calibrated) {
        if (!p.on_bound) continue;
        std::string name(parts_of(p.key.substr(p.key.rfind('.') + 1)).stem);
        std::replace(name.begin(), name.end(), '_', ' ');
        out.notes.push_back(
            worded("axis %s: the calibrated %s stops at the end of its tolerance: the tolerance "
                   "is too narrow, or an effect acts that is not named.",
                   result.name.c_str(), name.c_str()));
    }
}

/// What the owner excludes although it explains the record better than what is named.
inline void note_excluded(diagnosis_result& out, const std::vector<cause>& causes) {
    for (const cause& x : causes)
        if (!x.better_excluded.empty())
            out.notes.push_back(fmt::format("axis {}: {}, which the machine file excludes, explains the record "
                                            "better than {} does: check excluded_effects.",
                                            x.axis, label_of_effect(x.better_excluded),
                                            label_of_effect(x.effect)));
}

/// What the search did not come to before its time was up.
inline void note_missed(diagnosis_result& out, const axis_case& c) {
    if (!c.models.over()) return;
    std::string names;
    for (const effect* e : c.models.suspects())
        if (c.models.missed().contains(e)) names += (names.empty() ? "" : ", ") + std::string(e->label);
    const std::string what = !names.empty()   ? "not tried beside what was found: " + names
                             : c.models.cut() ? "a further cause may be missing"
                                              : "no motion was searched for that would tell more";
    out.notes.push_back(worded("axis %s: the time was up: %s.", c.axis.name.c_str(), what.c_str()));
}

/// What two encoders say joins what the force says: their causes come first, being read off, not inferred.
inline void join_transmission(diagnosis_result& out, axis_result& result, std::vector<cause>& causes,
                              chain::two_encoders& t) {
    std::vector<cause> first;
    t.of_the_guide(result.calibrated);
    t.of_the_guide(result.calibrated_with_suspects);
    for (cause& c : causes) {
        t.of_the_guide(c.parameters);
        t.of_the_guide(c.with_suspects);
    }
    if (result.verdict <= verdict::within_tolerance) causes.clear(); // as where there is one encoder
    chain::join(result, first, out, std::move(t.found), "readings");
    causes.insert(causes.begin(), first.begin(), first.end());
    out.notes.insert(out.notes.end(), t.notes.begin(), t.notes.end());
}

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

/// Whether two encoders are recorded whose difference shows the transmission.
inline bool shows_transmission(const axis_description& axis, const axis_log& log) {
    return !log.motor.empty() && (axis.transmission != transmission_description{} || log.motor_unit == "rad");
}

/// Up to which share of an axis' work each of its stages goes: CPU, measured on the practice logs, between
/// those of one cause (the search ends at 0.9) and those of several (0.55 to 0.65). A look along the motion is
/// part of the search where the record may ask for one.
struct stages {
    double first_look, search, rivals = 0.94, causes = 0.95, gap = 0.97;
};
inline stages stages_of(bool may_look_again) {
    return may_look_again ? stages{.first_look = 0.4, .search = 0.7} : stages{.first_look = 0.7, .search = 0.7};
}

/// Other axes of the log that one is read from.
struct other_axes {
    std::vector<const axis_log*> logs{};
    std::size_t rows_in_one = 1; ///< of theirs, to a sample of the axis
};

/// Of causes beside an inertia that turns with another axis' angle, those are suspects without which as little
/// stays: less than twice the energy that stays with all of them. They stood in for it.
inline void doubt_stand_ins(std::span<cause> causes, const axis_case& c, const other_axes& others,
                            const std::string& form) {
    const auto left = [&](const candidate& m) {
        const auto turning = inertia_by_angle(c, m, others.logs, others.rows_in_one);
        return square(turning ? turning->left : c.models.held_out_force(m));
    };
    const double of_all = left(c.best());
    for (cause& x : causes)
        for (const effect* e : c.best().effects)
            if (e->name == x.effect && left(c.models.without(c.best(), e)) < 2 * of_all) {
                to_suspects({&x, 1});
                x.better_form = form;
            }
}

/// Whether an inertia that turns with another axis' angle is what is left, told in a note. Where it alone
/// leaves less than the names that were found, some of these stand in for it.
inline void tell_turning_inertia(diagnosis_result& out, const axis_case& c, std::vector<cause>& causes,
                                 const other_axes& others) {
    if (c.at_floor() || c.within_its_laws()) return;
    auto found = inertia_by_angle(c, c.path.front(), others.logs, others.rows_in_one);
    const bool instead = found && found->left < c.models.held_out_force(c.best());
    if (!instead) found = inertia_by_angle(c, c.best(), others.logs, others.rows_in_one);
    if (!found) return;
    const std::string form = fmt::format("the angle of axis {} as an inertia does", found->other);
    if (instead) doubt_stand_ins(causes, c, others, form);
    out.notes.push_back(fmt::format(
        "axis {}: its inertia depends on the angle of axis {}: {:.3g} kg m^2 more or less, most at {:.2g} rad. "
        "That takes {:.0f} % off what {}, and a machine file cannot describe it: the inertia in it is a mean. "
        "Move axis {} alone, with {} held, for its other numbers.",
        c.axis.name, found->other, found->swing(), std::atan2(found->sine, found->cosine), 100 * found->share,
        instead ? "the machine as calibrated leaves" : "the causes leave", c.axis.name, found->other));
}

/// `tell` is of the whole axis. `of_transmission`: what the two encoders of the axis say, where it has two.
inline void diagnose_axis(diagnosis_result& out, axis_case& c, const progress& tell, const stages& stage,
                          chain::two_encoders* of_transmission = nullptr, const other_axes& others = {}) {
    const auto names = static_cast<double>(std::max<std::size_t>(1, c.best().effects.size()));
    const auto begins = [&](double from, double to, const std::string& what) {
        const progress part = tell.part(from, to);
        part("axis " + c.axis.name + ": " + what, 0);
        c.models.begins(part, names);
    };
    begins(stage.search, stage.rivals, "what else may cause it");
    axis_result result;
    result.name = c.axis.name;
    result.kind = c.axis.kind;
    result.command_unit = c.axis.command_unit;
    result.driven = c.axis.drive.closes();
    auto rivals = rivals_by_weight(c);
    begins(stage.rivals, stage.causes, "how sure each cause is");
    auto causes = plant_causes(c, rivals);
    begins(stage.causes, stage.gap, "how far the gap shrinks");
    const bool guess = untested(c);
    if (guess) detail::to_suspects(causes);
    const how_far shrinks(c);
    if (std::any_of(causes.begin(), causes.end(), claimed)) doubt_by_loop(causes, shrinks.loop_errors());
    put_as_applied(c, causes, rivals);
    tell_turning_inertia(out, c, causes, others);
    if (guess) {
        out.notes.push_back(
            worded("axis %s: the record holds one block of samples, so that no cause can be tested on "
                   "samples that it was not fitted to; record more, or give a hold-out log.",
                   c.axis.name.c_str()));
    } else if (!c.second && c.motions < 2)
        out.notes.push_back(
            worded("axis %s: the record holds one motion, which is cut into %zu pieces to test what was "
                   "fitted to the others: an effect that shows in another motion only is not seen.",
                   c.axis.name.c_str(), c.record.segments));
    if (auto of_controller = controller_cause(c)) { // the first explains most
        const double command = rms(c.command_difference(c.log, *c.axis.controller));
        const bool first = command > rms(c.models.residual(c.models.given()));
        causes.insert(first ? causes.begin() : causes.end(), *of_controller);
    }
    if (auto of_count = count_cause(c)) {
        const double rounding = rounding_force(c, c.count), found = rms(c.models.residual(c.models.given()));
        causes.insert(2 * square(rounding) > square(found) ? causes.begin() : causes.end(), *of_count);
    }
    shrinks.measure(result, causes);
    result.calibrated = calibrated(c, c.applied(), causes);
    if (c.claims + 1 < c.path.size()) result.calibrated_with_suspects = calibrated(c, c.best(), causes);
    const verdict behind = result.verdict = judge(c, causes);
    result.cut = c.models.cut() || !c.models.missed().empty();
    if (behind == verdict::within_tolerance && !c.at_floor())
        out.notes.push_back(
            worded("axis %s: what is left has structure that no cause explains; it is smaller than "
                   "what machines inside the tolerances differ by.",
                   c.axis.name.c_str()));
    result.where = block_places(c);
    const auto views = regimes(c.models.residual(c.models.given()), c.record);
    result.where.insert(result.where.end(), views.begin(), views.end());
    for (cause& x : causes)
        if (x.effect != "controller_mismatch") mark_bounds(claimed(x) ? c.applied() : c.best(), x.parameters);
    mark_bounds(c.applied(), result.calibrated);
    mark_bounds(c.best(), result.calibrated_with_suspects);
    if (of_transmission) join_transmission(out, result, causes, *of_transmission);
    put_in_words(result.kind, result.where);
    put_in_words(result.kind, result.calibrated);
    put_in_words(result.kind, result.calibrated_with_suspects);
    put_in_words(result.kind, causes);
    note_bounds(out, result);
    note_excluded(out, causes);
    note_missed(out, c);
    out.verdict = std::max(out.verdict, result.verdict);
    if (result.verdict != verdict::no_gap && result.verdict != verdict::within_tolerance) {
        out.causes.insert(out.causes.end(), causes.begin(), causes.end());
        begins(stage.gap, 1, "what is left, and the next experiment");
        if (behind > verdict::within_tolerance) describe_rest(out, c, result, causes);
        const bool proposed = !out.next.motion.empty();
        // Where the path alone is compared, there is no residual force that a motion could show.
        const bool by_force = c.axis.drive.kind != drive_kind::position_servo && !c.record.observer.closed;
        if (by_force && !c.models.over() && behind > verdict::within_tolerance) propose(out, c, causes, rivals);
        if (!proposed) {
            out.next.motion = text_of(out.next.motion, c.axis.kind);
            out.next.finding = text_of(out.next.finding, c.axis.kind);
        }
    }
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

/// A record without a single block of samples to score says nothing of a model. Nothing else is too short.
inline void need_blocks(const axis_case& c, const std::string& file) {
    if (!c.record.score.channels.front().segment_of_block.empty()) return;
    std::size_t longest = 0, pieces = 0, row = 0;
    for (const unsigned char out : c.log.left_out) {
        row = out ? 0 : row + 1;
        pieces += row == 1;
        longest = std::max(longest, row);
    }
    const std::string in_pieces =
        pieces < 2 ? ""
                   : worded(" in %zu pieces, the longest of %zu (import with a longer --sample-period bridges "
                            "short gaps)",
                            pieces, longest);
    throw bad_input(file,
                    worded("%zu samples of axis %s%s: a diagnosis needs at least %zu in a row, one block to "
                           "start the observer and one to score",
                           c.log.position.size(), c.axis.name.c_str(), in_pieces.c_str(),
                           c.record.score.skip + c.record.score.block));
}

/// Whether an axis is looked at again with models led along its motion: structure is left, and what was found
/// leaves more of the forces along that motion than was there before, whatever it does to the predictions.
/// Beside forces without a name a corrected model predicts best by standing still. A drive's loops are replayed
/// with the readings.
inline bool contradicts_motion(const axis_case& c) {
    if (c.best().effects.empty() || c.models.over() || c.axis.drive.closes() || !shows_along_motion(c.best()))
        return false;
    return c.left_along_motion() > 1 / (1 - c.limits.least_shrink);
}

/// The same where the command was measured, and what was found makes the axis answer it less than described. A
/// stiff loop makes a measured command answer every force that the model does not have, and neither that nor
/// the noise of its sensor moves the axis: a heavy model of a weak motor follows no command, predicts the
/// readings best, and the forces along the motion do not ask for it.
inline bool answers_too_little(const axis_case& c) {
    if (c.axis.actuator.command_is != command_origin::measured || c.axis.drive.closes() ||
        c.best().effects.empty() || c.models.over() || c.best().fit.plant.backlash > 0)
        return false;
    const auto answer = [](const candidate& m) {
        return m.fit.plant.force_constant / m.fit.plant.moving_mass();
    };
    return answer(c.best()) < (1 - c.limits.least_shrink) * answer(c.path.front());
}

/// Whether a measured command leaves a gap open. The command of a real loop answers every force that the model
/// does not have; where these are many, the score of the predictions rests on what the corrections carry.
inline bool open_by_measured_command(const axis_case& c) {
    return c.axis.actuator.command_is == command_origin::measured && !c.axis.drive.closes() &&
           !c.models.over() && !c.at_floor() && !c.within_its_laws() && !c.best().effects.empty() &&
           !(c.best().fit.plant.backlash > 0);
}

/// How many rows of a long record are taken as one. A measured command is not replayed, and no cause lies
/// within a row of it: such a record needs no more rows than its time scale does. A described controller needs
/// its own period, in which the corrected loop is simulated.
inline std::size_t rows_in_one(const axis_description& axis, const axis_log& log, double period,
                               const rules& r) {
    if (axis.actuator.command_is != command_origin::measured || axis.controller || axis.drive.closes())
        return 1;
    const double corner = bandwidth_of(axis, log, period) / record_scales{.corner_Hz = 1}.bandwidth_Hz();
    return std::clamp<std::size_t>(log.position.size() / r.rows_of_a_look, 1,
                                   diagnosis::rows_in_one(corner, period));
}

/// What is left in both logs, in energy [N^2].
inline double left_in_both(const axis_case& c) {
    return square(c.models.held_out_force(c.best())) + square(c.second_log(c.best()).force);
}
/// Whether the hold-out log shows a gap that the log holds little of: only the other way round is there
/// something to fit.
inline bool hides_what_the_other_shows(const axis_case& c) {
    if (!c.tested_apart() || c.record.replayed() || c.settled_on_second || c.controller_differs() ||
        c.models.over())
        return false;
    return c.settled || c.second_log(c.best()).force > 2 * c.models.held_out_force(c.best());
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

} // namespace detail

QUADRANT_DIAGNOSIS_DECL diagnosis_result diagnose(const machine_description& machine,
                                                  const machine_log& as_read, const machine_log* as_read_too,
                                                  const progress& tell, const rules& r) {
    diagnosis_result out;
    const machine_log log = with_drives(machine, as_read);
    std::optional<machine_log> second;
    if (as_read_too) second = with_drives(machine, *as_read_too);
    const machine_log* const holdout = second ? &*second : nullptr;
    out.machine_file = machine.file;
    out.log_file = log.file;
    if (holdout) out.holdout_file = holdout->file;
    out.notes = machine.notes;
    out.notes.insert(out.notes.end(), log.notes.begin(), log.notes.end());
    if (holdout) out.notes.insert(out.notes.end(), holdout->notes.begin(), holdout->notes.end());
    auto axes_left = std::count_if(machine.axes.begin(), machine.axes.end(), [&](const axis_description& axis) {
        const axis_log* logged = detail::named(log.axes, axis.name);
        return logged && !logged->still;
    });
    const auto all_axes = static_cast<double>(axes_left);
    for (axis_description axis : machine.axes) {
        const axis_log* logged = detail::named(log.axes, axis.name);
        if (!logged || logged->still) continue;
        const auto behind = all_axes - static_cast<double>(axes_left);
        const progress of_axis = tell.part(behind / all_axes, (behind + 1) / all_axes);
        if (axis.positions_only) {
            of_axis("axis " + axis.name + ": " + std::to_string(log.samples) + " samples");
            detail::diagnose_positions(out, axis, *logged, machine, log.file,
                                       detail::for_one_of(r, axes_left--));
            if (holdout)
                out.notes.push_back(fmt::format(
                    "axis {}: the hold-out log is not used where only positions are known.", axis.name));
            continue;
        }
        if (logged->command_is == command_origin::measured) axis.actuator.command_is = command_origin::measured;
        if (axis.controller && !axis.drive.closes() && axis.actuator.command_is == command_origin::measured)
            out.notes.push_back(
                detail::worded("axis %s: the command was measured behind the amplifier; what the controller "
                               "asked for is not in the log, and nothing is said of the controller.",
                               axis.name.c_str()));
        std::optional<chain::two_encoders> transmission;
        if (detail::shows_transmission(axis, *logged)) {
            transmission = chain::diagnose_transmission(axis, *logged, machine.sample_period_s, log.file,
                                                        machine.excluded_effects, r);
            logged = &transmission->carried;
        }
        for (std::string& note : told_by_turn(axis, *logged, machine.sample_period_s))
            out.notes.push_back(std::move(note));
        const double band = bandwidth_of(axis, *logged, machine.sample_period_s);
        axis_log coupled = detail::with_neighbour(log, *logged, machine.sample_period_s, band);
        std::optional<axis_log> other;
        if (const auto found = holdout ? detail::named(holdout->axes, axis.name) : nullptr) {
            const axis_log carried = transmission ? chain::carried_too(*transmission, axis, *found,
                                                                       machine.sample_period_s, holdout->file)
                                                  : *found;
            other = detail::with_neighbour(*holdout, carried, machine.sample_period_s, band);
        }
        double period = machine.sample_period_s;
        detail::other_axes others;
        for (const auto* axes : {&log.axes, &log.beside})
            for (const axis_log& a : *axes) others.logs.push_back(&a);
        if (const std::size_t n = detail::rows_in_one(axis, coupled, period, r); n > 1) {
            others.rows_in_one = n;
            out.notes.push_back(fmt::format("axis {}: {} samples of {:.4g} s are taken as one: the record is "
                                            "long, its command is measured, "
                                            "and above {:.3g} Hz the noise of the position hides the forces.",
                                            axis.name, n, period, 0.6 * band));
            coupled = thinned(coupled, n);
            if (other) other = thinned(*other, n);
            period *= static_cast<double>(n);
        }
        detail::add_own_effects(out.own_effects, axis);
        if (axis.controller && axis.controller->own) // its file's kind is known after all
            std::erase_if(out.notes, [&](const std::string& note) {
                return note.starts_with(fmt::format("axis {}: controller kind ", axis.name));
            });
        of_axis("axis " + axis.name + ": " + std::to_string(log.samples) + " samples");
        exclusions excluded{machine.excluded_effects};
        if (transmission) excluded.by_readings = {"backlash", "structural_resonance"}; // of the two encoders
        const axis_description rigid = transmission ? transmission->rigid(axis) : axis;
        const rules limits = detail::for_one_of(r, axes_left--);
        // A servo's law on duty is soft, and a force moves it where it shows. A stiff loop hides it from the
        // path.
        const bool soft = axis.drive.kind == drive_kind::position_servo && logged->drive;
        std::optional<axis_log> both; // six seconds of it hold a dozen readings: none to spare for a test
        if (soft && other && !transmission)
            both = both_motions(axis, *detail::named(as_read.axes, axis.name),
                                *detail::named(as_read_too->axes, axis.name), machine.sample_period_s);
        const detail::stages stage =
            detail::stages_of(axis.actuator.command_is == command_origin::measured && !axis.drive.closes());
        const auto look = [&](held_by how, const axis_case* before, bool exchanged) {
            const bool again = before || exchanged;
            const progress part =
                of_axis.part(again ? stage.first_look : 0, again ? stage.search : stage.first_look);
            const axis_log& fitted = exchanged ? *other : both ? *both : coupled;
            const axis_log* const judged = exchanged ? &coupled : other ? &*other : nullptr;
            return std::make_unique<axis_case>(rigid, fitted, judged, period, excluded, limits, part, how,
                                               before);
        };
        // Looks at the forces along the measured motion where the predictions mislead. Returns why it is
        // evaluated on them, or nothing.
        const auto along_motion = [&](std::unique_ptr<axis_case>& found, bool exchanged) {
            const bool stands = detail::contradicts_motion(*found), little = detail::answers_too_little(*found),
                       open = detail::open_by_measured_command(*found);
            if (!stands && !little && !open) return "";
            of_axis("axis " + axis.name + ": again, along the measured motion");
            auto led = look(held_by::motion, found.get(), exchanged);
            const double least =
                (open ? 1 + r.least_shrink : 1 - r.least_shrink) * (stands ? 1 : found->left_along_motion());
            if (!(led->left_along_motion() < least)) return "";
            found = std::move(led);
            return stands   ? "standing where the axis moves"
                   : little ? "answering the measured command too little"
                            : "leaving to the corrections what no name explains";
        };
        auto found = look(soft ? held_by::loop : held_by::readings, nullptr, false);
        detail::need_blocks(*found, log.file);
        if (both)
            out.notes.push_back(
                fmt::format("axis {}: log and hold-out log are fitted together: a soft servo that its friction "
                            "holds says too little in one of them.",
                            axis.name));
        const char* why_along = along_motion(found, false);
        if (!both && detail::hides_what_the_other_shows(*found)) {
            of_axis("axis " + axis.name + ": again, fitted to the hold-out log");
            auto exchanged = look(held_by::readings, nullptr, true);
            if (exchanged->at_floor() ||
                detail::left_in_both(*exchanged) < (1 - r.least_shrink) * detail::left_in_both(*found)) {
                out.notes.push_back(fmt::format("axis {}: fitted to the hold-out log and judged on the log: "
                                                "what is wrong shows in the motion of "
                                                "the hold-out log only.",
                                                axis.name));
                why_along = along_motion(exchanged, true);
                exchanged->controller = found->controller; // replayed from the log, as ever
                exchanged->exchanged = true;
                found = std::move(exchanged);
            }
        }
        if (*why_along)
            out.notes.push_back(fmt::format(
                "axis {}: judged by the forces along the measured motion: models corrected by the readings "
                "predicted best by {}.",
                axis.name, why_along));
        if (found->exchanged) others.logs.clear(); // they are of the other log
        detail::diagnose_axis(out, *found, of_axis, stage, transmission ? &*transmission : nullptr, others);
        of_axis("axis " + axis.name + ": done", 1);
    }
    tell("done", 1);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
