// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compare/finding.hpp"
#include "compare/values.hpp"
#include "diagnose.hpp"
#include "log/at_period.hpp"
#include "match.hpp"

#include <array>
#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline void take_figures(compared_axis& a, const beside::finding& f, bool found_in_second) {
    a.found_in_second = found_in_second;
    a.force_before_N = f.before.force;
    a.force_after_N = f.after.force;
    a.force_own_N = f.own.force;
    a.force_common_N = f.reference.force;
    a.floor_N = f.before.floor;
}

/// f: what the direction d finds on an axis, g: what the other one does.
inline likeness likeness_of(const beside::finding& f, const beside::direction& d, const beside::finding& g,
                            const beside::direction& back, const std::string& axis, const rules& r) {
    const bool unnamed =
        beside::holds_more(f, d, axis, r) || beside::holds_more(g, back, axis, r) ||
        (beside::differ_without_a_name(f, d, axis, r) && beside::differ_without_a_name(g, back, axis, r));
    return !f.named.empty()       ? likeness::differ
           : !f.undecided.empty() ? likeness::undecided
           : unnamed              ? likeness::unnamed
                                  : likeness::alike;
}

/// What each axis of both logs differs in, by both directions.
using findings_of_axes = std::vector<std::array<beside::finding, 2>>;

/// The names and the likeness of each axis, by the direction that explains more.
inline void name_differences(comparison_result& out, const std::array<beside::direction, 2>& ways,
                             std::size_t way, findings_of_axes& found, const rules& r) {
    const beside::direction &d = ways[way], &back = ways[1 - way];
    out.found_in_second = d.found_in_second;
    for (std::size_t k = 0; k < out.axes.size(); ++k) {
        compared_axis& a = out.axes[k];
        beside::finding& f = found[k][way];
        beside::add_replayed(f.named, d, back, a.name);
        beside::add_replayed(f.named, back, d, a.name);
        for (const beside::finding* one : {&std::as_const(f), &std::as_const(found[k][1 - way])}) {
            f.named.insert(f.named.end(), one->process.begin(), one->process.end());
            f.undecided.insert(f.undecided.end(), one->process_undecided.begin(), one->process_undecided.end());
        }
        take_figures(a, f, d.found_in_second);
        a.likeness = likeness_of(f, d, found[k][1 - way], back, a.name, r);
        out.likeness = std::max(out.likeness, a.likeness);
        std::move(f.named.begin(), f.named.end(), std::back_inserter(out.differences));
        std::move(f.undecided.begin(), f.undecided.end(), std::back_inserter(out.undecided));
    }
}

/// Each log by the machine that the other one shows. in(what): tells how far a diagnosis is.
template <class In>
std::array<beside::direction, 2> both_ways(const comparison_result& out, const machine_description& machine,
                                           const machine_log& first, const machine_log& second, const In& in,
                                           const rules& r) {
    std::array<beside::direction, 2> ways;
    for (const bool to_second : {true, false}) {
        beside::direction& d = ways[to_second ? 0 : 1];
        d.found_in_second = to_second;
        d.reference = to_second ? &out.first : &out.second;
        d.own = to_second ? &out.second : &out.first;
        d.of_reference = beside::with_causes(machine, *d.reference);
        d.of_own = beside::with_causes(machine, *d.own);
        d.for_own = beside::with_causes(machine, beside::lent(*d.reference, *d.own));
        d.for_reference = beside::with_causes(machine, beside::lent(*d.own, *d.reference));
        d.across = diagnose(
            d.for_own, to_second ? second : first, nullptr,
            in(to_second ? "second log by the machine of the first" : "first log by the machine of the second"),
            r);
    }
    return ways;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL comparison_result compare(const machine_description& machine, const machine_log& first,
                                                  const machine_log& second_as_read, const progress& tell,
                                                  const rules& r) {
    namespace beside = detail::beside;
    const machine_log second = has_period_of(machine, second_as_read)
                                   ? second_as_read
                                   : at_period(second_as_read, machine.sample_period_s);
    double begun = 0; // of four diagnoses, and the comparison of what they found
    const auto in = [&](const char* what) {
        constexpr double each = 0.24;
        begun += each;
        return tell.part(begun - each, begun, std::string(what) + ": ");
    };
    comparison_result out;
    out.machine_file = machine.file;
    out.first_file = first.file;
    out.second_file = second.file;
    out.first = diagnose(machine, first, nullptr, in("first log"), r);
    out.second = diagnose(machine, second, nullptr, in("second log"), r);
    std::array<beside::direction, 2> ways = detail::both_ways(out, machine, first, second, in, r);
    out.notes = out.first.notes;
    for (const std::string& note : out.second.notes)
        if (std::find(out.notes.begin(), out.notes.end(), note) == out.notes.end()) out.notes.push_back(note);
    double explained[2] = {0, 0};
    detail::findings_of_axes found;
    for (const axis_result& a : out.first.axes) {
        const axis_description& axis = *detail::named(machine.axes, a.name);
        if (!detail::named(out.second.axes, a.name)) continue; // it stands still there
        compared_axis c;
        c.name = a.name;
        c.kind = a.kind;
        c.command_unit = a.command_unit;
        c.first = a.calibrated;
        c.second = detail::named(out.second.axes, a.name)->calibrated;
        auto& f = found.emplace_back();
        if (axis.positions_only || axis.drive.closes()) {
            for (std::size_t i = 0; i < 2; ++i) f[i] = beside::by_names(ways[i], a.name, r);
        } else {
            tell("axis " + a.name + ": both ways", begun);
            beside::log_of_axis one(machine, axis, first, r), other(machine, axis, second, r);
            f[0] = beside::by_scores(ways[0], a.name, one, other, r);
            f[1] = beside::by_scores(ways[1], a.name, other, one, r);
        }
        for (std::size_t i = 0; i < 2; ++i) explained[i] += f[i].score;
        out.axes.push_back(std::move(c));
    }
    // Where neither way explains more by the margin the difference is told of the second log.
    const std::size_t way = explained[1] > explained[0] + r.margin ? 1 : 0;
    detail::name_differences(out, ways, way, found, r);
    out.across = std::move(ways[way].across);
    tell("done", 1);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
