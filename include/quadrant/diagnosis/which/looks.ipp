// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"
#include "../where/places.hpp"
#include "causes.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// A record without a single block of samples to score says nothing of a model. One in pieces, of which a few
/// blocks alone are judged, says nothing of the rest. Nothing else is too short.
inline void need_blocks(const axis_case& c, const std::string& file) {
    const channel& blocks = c.record.score.channels.front();
    const auto scored = blocks.segment_of_block.size() * blocks.block;
    const auto out = static_cast<std::size_t>(std::count(c.log.left_out.begin(), c.log.left_out.end(), 1));
    constexpr std::size_t few = 5; // blocks: as many as a channel needs
    if (scored > 0 && (blocks.segment_of_block.size() >= few || 20 * scored >= c.log.position.size() - out))
        return;
    std::size_t longest = 0, pieces = 0, row = 0;
    for (const unsigned char left_out : c.log.left_out) {
        row = left_out ? 0 : row + 1;
        pieces += row == 1;
        longest = std::max(longest, row);
    }
    const std::string in_pieces =
        pieces < 2 ? ""
                   : worded(" in %zu pieces, the longest of %zu (import with a longer --sample-period bridges "
                            "short gaps)",
                            pieces, longest);
    if (scored > 0)
        throw bad_input(file,
                        worded("%zu samples of axis %s%s: only %zu of them lie in pieces that are long "
                               "enough to be judged",
                               c.log.position.size() - out, c.axis.name.c_str(), in_pieces.c_str(), scored));
    // Behind a gap the observer starts anew.
    const std::size_t needed = (pieces < 2 ? c.record.score.skip : c.record.score.block) + blocks.block;
    throw bad_input(file, worded("%zu samples of axis %s%s: a diagnosis needs %zu in a row, some to start the "
                                 "observer and a block to score",
                                 c.log.position.size() - out, c.axis.name.c_str(), in_pieces.c_str(), needed));
}

/// Whether an axis is looked at again with models led along its motion: structure is left, and what was found
/// leaves more of the forces along that motion than was there before, and than the same machine without the
/// names leaves, whatever it does to the predictions. Beside forces without a name a corrected model predicts
/// best by standing still; numbers inside their tolerances that moved with a right name are no such case. A
/// drive's loops are replayed with the readings.
inline bool contradicts_motion(const axis_case& c) {
    if (c.best().effects.empty() || c.models.over() || c.axis.drive.closes() || !shows_along_motion(c.best()))
        return false;
    candidate unnamed = c.best();
    for (const effect* e : c.best().effects) unnamed.fit.plant = c.models.plant_without(unnamed, *e);
    const auto left =
        c.left_along_motion(std::array{c.best().fit.plant, c.path.front().fit.plant, unnamed.fit.plant});
    return left[0] * (1 - c.limits.least_shrink) > std::max(left[1], left[2]);
}

/// The same where the command was measured, and what was found makes the axis answer it less than described. A
/// stiff loop makes a measured command answer every force that the model does not have, and neither that nor
/// the noise of its sensor moves the axis: a heavy model of a weak motor follows no command, predicts the
/// readings best, and the forces along the motion do not ask for it.
inline bool answers_too_little(const axis_case& c) {
    if (c.axis.actuator.command_is != command_origin::measured || c.axis.drive.closes() ||
        c.best().effects.empty() || c.models.over() || c.best().fit.plant.has_play())
        return false;
    return answers_less(c.best(), c.path.front(), c.limits.least_shrink);
}

/// Whether the damping of the best model turns every force that it does not have into a small step, so that
/// little of it shows in the predictions.
inline bool damps_what_it_lacks(const axis_case& c) {
    return !c.axis.drive.closes() && !c.models.over() && shows_along_motion(c.best()) &&
           forgets_within_the_response(c.best().fit.plant, c.record);
}

/// Whether a measured command leaves a gap open. The command of a real loop answers every force that the model
/// does not have; where these are many, the score of the predictions rests on what the corrections carry.
inline bool open_by_measured_command(const axis_case& c) {
    return c.axis.actuator.command_is == command_origin::measured && !c.axis.drive.closes() &&
           !c.models.over() && !c.at_floor() && !c.within_its_laws() && !c.best().effects.empty() &&
           !c.best().fit.plant.has_play();
}

/// Why an axis is looked at again with models led along its motion, and what that look leaves along it at most,
/// over what the calibrated machine leaves. No why: it is not.
struct second_look {
    const char* why = "";
    double leaves_at_most = 0;
};
inline second_look along_its_motion(const axis_case& c) {
    const bool stands = contradicts_motion(c), little = answers_too_little(c),
               open = open_by_measured_command(c), damps = damps_what_it_lacks(c);
    if (!stands && !little && !open && !damps) return {};
    return {stands   ? "standing where the axis moves"
            : little ? "answering the measured command too little"
            : damps  ? "a damping so stiff that no force shows in them"
                     : "leaving to the corrections what no name explains",
            (open || damps ? 1 + c.limits.least_shrink : 1 - c.limits.least_shrink) *
                (stands ? 1 : c.left_along_motion())};
}

/// What is left in both logs, in energy [N^2].
inline double left_in_both(const axis_case& c) {
    return square(c.models.held_out_force(c.best())) + square(c.second_log(c.best()).force);
}
/// Whether the hold-out log shows a gap that the log holds little of: only the other way round is there
/// something to fit.
inline bool hides_what_the_other_shows(const axis_case& c) {
    if (!c.tested_apart() || c.settled_on_second || c.controller_differs() || c.models.over()) return false;
    // A replay leaves more of a hold-out log beside names that are right: where its integral began there is
    // free.
    if (c.record.replayed() && !c.best().effects.empty()) return false;
    return c.settled || c.second_log(c.best()).force > 2 * c.models.held_out_force(c.best());
}

/// How the tap is read by what fits beside the causes that were found; none: nothing is tapped, or that is the
/// way that was taken. Where a cause bends the calibration, the choice beside the described machine may be
/// wrong; and a lag or a delay of the actuator is what a mean over the row looks like beside a moment of it.
inline std::optional<tap_reading> other_tap(const axis_case& c) {
    const auto& effects = c.best().effects;
    const plant_model& plant = c.best().fit.plant;
    if (!c.record.taps_force(plant.drive) || c.record.tap || effects.empty() || c.models.over()) return {};
    const fitter fit(c.record.observer, c.record.score);
    const tap_reading way =
        best_tap(fit, *c.record.observer.drive, plant, resumed(c.best().fit), c.record.bandwidth_Hz);
    if (way != plant.drive.read.tap) return way;
    const bool late =
        std::any_of(effects.begin(), effects.end(), [](const effect* e) { return e->box == "actuator"; });
    if (!late || way == tap_reading::row_mean) return {};
    return tap_reading::row_mean;
}

inline const char* in_words(tap_reading way) {
    switch (way) {
    case tap_reading::before_set_point:
        return "read before the row's set-point acts";
    case tap_reading::after_set_point:
        return "read behind the row's set-point";
    case tap_reading::row_mean:
        break;
    }
    return "the mean over a row";
}

/// Takes what was found with another way of reading the tap where it is better, or as good with fewer names,
/// and says so.
inline void take_other_tap(std::unique_ptr<axis_case>& found, std::unique_ptr<axis_case> other, double margin,
                           std::vector<std::string>& notes) {
    const bool fewer = other->best().effects.size() < found->best().effects.size();
    if (other->models.cut() || !(other->best().total > found->best().total + (fewer ? 0 : margin))) return;
    found = std::move(other);
    notes.push_back(fmt::format("axis {}: what was measured in the drive is taken as {}: that fits better "
                                "beside what was found, or as well without a cause.",
                                found->axis.name, in_words(found->best().fit.plant.drive.read.tap)));
}

QUADRANT_DIAGNOSIS_DECL std::unique_ptr<axis_case>
look_at(const looked_at& of, const std::string& file, const progress& tell, std::vector<std::string>& notes) {
    const double least_shrink = of.limits.least_shrink;
    const auto look = [&](held_by how, const axis_case* before, bool exchanged,
                          std::optional<tap_reading> tap = {}) {
        const bool again = before || exchanged || tap;
        const progress part =
            tell.part(again ? of.stage.first_look : 0, again ? of.stage.search : of.stage.first_look);
        const axis_log& fitted = exchanged ? *of.holdout : of.log;
        return std::make_unique<axis_case>(of.axis, fitted, exchanged ? &of.apart : of.holdout, of.period,
                                           of.excluded, of.limits, part, how, before, tap);
    };
    // Looks at the forces along the measured motion where the predictions mislead. Returns why it is
    // evaluated on them, or nothing.
    const auto along_motion = [&](std::unique_ptr<axis_case>& found, bool exchanged) {
        const second_look again = along_its_motion(*found);
        if (!*again.why) return "";
        tell("axis " + of.axis.name + ": again, along the measured motion");
        auto led = look(held_by::motion, found.get(), exchanged);
        if (led->models.cut() || !(led->left_along_motion() < again.leaves_at_most)) return "";
        found = std::move(led);
        return again.why;
    };
    auto found = look(of.soft ? held_by::loop : held_by::readings, of.found, false);
    need_blocks(*found, file);
    if (of.both)
        notes.push_back(
            fmt::format("axis {}: log and hold-out log are fitted together: a soft servo that its friction "
                        "holds says too little in one of them.",
                        of.axis.name));
    if (const auto tap = of.both ? std::nullopt : other_tap(*found)) {
        tell("axis " + of.axis.name + ": again, with what was measured in the drive read in another way");
        take_other_tap(found, look(held_by::readings, nullptr, false, tap), of.limits.margin, notes);
    }
    const char* why_along = along_motion(found, false);
    if (!of.both && hides_what_the_other_shows(*found)) {
        tell("axis " + of.axis.name + ": again, fitted to the hold-out log");
        auto exchanged = look(held_by::readings, nullptr, true);
        if (!exchanged->models.cut() &&
            (exchanged->at_floor() || left_in_both(*exchanged) < (1 - least_shrink) * left_in_both(*found))) {
            notes.push_back(fmt::format("axis {}: fitted to the hold-out log and judged on the log: "
                                        "what is wrong shows in the motion of "
                                        "the hold-out log only.",
                                        of.axis.name));
            why_along = along_motion(exchanged, true);
            exchanged->controller = found->controller; // replayed from the log, as ever
            exchanged->exchanged = true;
            found = std::move(exchanged);
        }
    }
    if (*why_along)
        notes.push_back(
            fmt::format("axis {}: evaluated on the forces along the measured motion: models corrected by the "
                        "readings predicted best by {}.",
                        of.axis.name, why_along));
    return found;
}

} // namespace quadrant::inline v0::diagnosis::detail
