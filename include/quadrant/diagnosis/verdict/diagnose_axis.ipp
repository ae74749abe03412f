// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../how_far/how_far.hpp"
#include "../next/blind_spots.hpp"
#include "../next/next_experiment.hpp"
#include "../which/as_applied.hpp"
#include "../which/block_places.hpp"
#include "../which/calibrated.hpp"
#include "../which/causes.hpp"
#include "../which/read_off.hpp"
#include "describe_rest.hpp"
#include "judge.hpp"
#include "notes.hpp"
#include "own_words.hpp"

namespace quadrant::inline v0::diagnosis::detail {

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

/// What was tested on too little of a record.
inline void note_few_motions(diagnosis_result& out, const axis_case& c) {
    if (untested(c)) {
        out.notes.push_back(
            worded("axis %s: the record holds one block of samples, so that no cause can be tested on "
                   "samples that it was not fitted to; record more, or give a hold-out log.",
                   c.axis.name.c_str()));
    } else if (!c.second && c.motions < 2)
        out.notes.push_back(
            worded("axis %s: the record holds one motion, which is cut into %zu pieces to test what was "
                   "fitted to the others: an effect that shows in another motion only is not seen.",
                   c.axis.name.c_str(), c.record.segments));
}

/// Causes that are read off the record stand beside those of the plant; what explains most comes first.
inline void add_read_off(std::vector<cause>& causes, const axis_case& c) {
    const auto found = [&] { return rms(c.models.residual(c.models.given())); };
    if (auto of_controller = controller_cause(c)) {
        const bool first = rms(c.command_difference(c.log, *c.axis.controller)) > found();
        causes.insert(first ? causes.begin() : causes.end(), *of_controller);
    }
    if (auto of_count = count_cause(c)) {
        const bool first = 2 * square(rounding_force(c, c.count)) > square(found());
        causes.insert(first ? causes.begin() : causes.end(), *of_count);
    }
}

/// Where the gap lies, and which values stop at the end of a tolerance.
inline void add_places(axis_result& result, std::vector<cause>& causes, const axis_case& c) {
    result.where = block_places(c);
    const auto views = regimes(c.models.residual(c.models.given()), c.record);
    result.where.insert(result.where.end(), views.begin(), views.end());
    for (cause& x : causes)
        if (x.effect != "controller_mismatch") mark_bounds(claimed(x) ? c.applied() : c.best(), x.parameters);
    mark_bounds(c.applied(), result.calibrated);
    mark_bounds(c.best(), result.calibrated_with_suspects);
}

inline void put_in_words(axis_result& result, std::vector<cause>& causes) {
    put_in_words(result.kind, result.where);
    put_in_words(result.kind, result.calibrated);
    put_in_words(result.kind, result.calibrated_with_suspects);
    put_in_words(result.kind, causes);
}

/// What the causes leave, and the motion that would tell more.
inline void add_rest(diagnosis_result& out, const axis_case& c, const axis_result& result,
                     const std::vector<cause>& causes, const std::vector<std::vector<rival>>& rivals) {
    describe_rest(out, c, result, causes);
    const std::string of_an_earlier_axis = out.next.motion;
    // Where the path alone is compared, there is no residual force that a motion could show.
    const bool by_force = c.axis.drive.kind != drive_kind::position_servo && !c.record.observer.closed;
    if (by_force && !c.models.over()) propose(out, c, causes, rivals);
    if (out.next.motion == of_an_earlier_axis) return;
    out.next.motion = text_of(out.next.motion, c.axis.kind);
    out.next.finding = text_of(out.next.finding, c.axis.kind);
}

/// Claims that only some of the motions hold up are suspects: all of them where they do not surely shrink the
/// gap together, and the one that takes least where it does not surely shrink what the others leave. What
/// happened once no other motion can hold up.
inline void suspect_by_chance(const how_far& shrinks, axis_case& c, std::vector<cause>& causes,
                              std::vector<std::vector<rival>>& rivals) {
    const auto once = [](const effect* e) { return e->once; };
    while (c.claims > 0) {
        const auto claims = std::span(c.best().effects).first(c.claims);
        std::size_t n = c.claims; // up to the last one that other motions can hold up
        while (n > 0 && once(claims[n - 1])) --n;
        if (n == 0) return;
        const bool together = std::any_of(claims.begin(), claims.end(), once) ||
                              shrinks.surely_shrinks(c.models.given(), c.applied());
        if (together && (c.claims == 1 || shrinks.surely_shrinks(c.path[n - 1], c.path[n]))) return;
        to_suspects(together ? std::span(&causes[n - 1], 1) : std::span(causes));
        put_as_applied(c, causes, rivals);
    }
}

/// How far the gap shrinks, and what that says of the axis. Suspects that nobody is told of take nothing off.
inline void measure_and_judge(axis_result& result, const axis_case& c, const how_far& shrinks,
                              std::vector<cause>& causes) {
    shrinks.measure(result, causes);
    result.verdict = judge(c, causes);
    if (result.verdict > verdict::within_tolerance || causes.empty()) return;
    std::vector<cause> none;
    shrinks.measure(result, none);
}

/// What a reader of the result has to know.
inline void add_notes(diagnosis_result& out, const axis_case& c, const axis_result& result,
                      const std::vector<cause>& causes) {
    note_bounds(out, result);
    note_above_band(out, c);
    note_digits(out, c);
    note_limit(out, c);
    note_denied(out, c);
    note_cancelled(out, c);
    note_shadow(out, c);
    note_chatter(out, c, result);
    note_rows_of_delay(out, c, causes);
    note_late_velocity(out, c, causes);
    note_excluded(out, causes);
    note_missed(out, c);
}

QUADRANT_DIAGNOSIS_DECL void diagnose_axis(diagnosis_result& out, axis_case& c, const progress& tell,
                                           const stages& stage, chain::two_encoders* of_transmission,
                                           const other_axes& others) {
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
    if (untested(c)) to_suspects(causes);
    const how_far shrinks(c);
    if (std::any_of(causes.begin(), causes.end(), claimed)) doubt_by_loop(causes, shrinks.loop_errors());
    put_as_applied(c, causes, rivals);
    suspect_by_chance(shrinks, c, causes, rivals);
    if (tell_turning_inertia(out, c, causes, others)) put_as_applied(c, causes, rivals);
    tell_linked_arm(out, c, others);
    note_few_motions(out, c);
    add_read_off(causes, c);
    measure_and_judge(result, c, shrinks, causes);
    result.calibrated = calibrated(c, c.applied(), causes);
    if (c.claims + 1 < c.path.size()) result.calibrated_with_suspects = calibrated(c, c.best(), causes);
    const verdict behind = result.verdict;
    result.cut = c.models.cut() || !c.models.missed().empty();
    if (behind == verdict::within_tolerance && !c.at_floor())
        out.notes.push_back(
            worded("axis %s: what is left has structure that no cause explains; it is smaller than "
                   "what machines inside the tolerances differ by.",
                   c.axis.name.c_str()));
    add_places(result, causes, c);
    if (of_transmission) join_transmission(out, result, causes, *of_transmission);
    put_in_words(result, causes);
    add_notes(out, c, result, causes);
    out.verdict = std::max(out.verdict, result.verdict);
    if (result.verdict > verdict::within_tolerance) {
        out.causes.insert(out.causes.end(), causes.begin(), causes.end());
        begins(stage.gap, 1, "what is left, and the next experiment");
        if (behind > verdict::within_tolerance) add_rest(out, c, result, causes, rivals);
    }
    const auto unseen = unseen_by(result, causes);
    out.not_seen.insert(out.not_seen.end(), unseen.begin(), unseen.end());
    out.axes.push_back(std::move(result));
}

} // namespace quadrant::inline v0::diagnosis::detail
