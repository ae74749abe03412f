// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../which/chance.hpp"
#include "values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace quadrant::inline v0::diagnosis::detail::beside {

inline difference difference_of(const direction& d, const cause& c) {
    difference out;
    out.axis = c.axis;
    out.effect = c.effect;
    out.probability = std::max(c.probability, c.group_probability);
    out.confusable_with = c.confusable_with;
    out.found_in_second = d.found_in_second;
    const cause* there = cause_in(*d.reference, c.axis, c.effect);
    auto reference = there                  ? there->parameters
                     : is_process(c.effect) ? std::vector<parameter_estimate>{}
                                            : described(d.for_own, c);
    out.first = c.parameters;
    out.second = std::move(reference);
    if (d.found_in_second) std::swap(out.first, out.second);
    // What the log that has it cannot separate, the other log, which lacks it, cannot either.
    if (auto& names = out.confusable_with; there)
        for (const std::string& name : there->confusable_with)
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    out.gap_before_force_rms_N = c.gap_before_force_rms_N;
    out.gap_after_force_rms_N = c.gap_after_force_rms_N;
    out.gap_before_position_rms_m = c.gap_before_position_rms_m;
    out.gap_after_position_rms_m = c.gap_after_position_rms_m;
    return out;
}

/// Whether `more` leaves clearly less than `less`, above the noise.
inline bool shrinks(const fit_of_log& more, const fit_of_log& less, const rules& r) {
    return more.above_floor() < (1 - r.least_shrink) * less.above_floor();
}

/// How probable a name can be with which `all` leaves less than `without`: what no name explains in the other
/// log may be what this name stands for here; and no law that both have is right to more than a few per cent.
inline double at_most_probable(const direction& d, const fit_of_log& reference, const fit_of_log& without,
                               const fit_of_log& all) {
    const double explained = taken_off(without, all);
    const bool open = d.reference->verdict > verdict::explained;
    const double rest = open ? reference.above_floor() : 0;
    return 1 - by_chance(all.names, rest / explained);
}

QUADRANT_DIAGNOSIS_DECL void find_process(finding& out, const direction& d, const std::string& axis,
                                          const std::function<fit_of_log(const machine_description&)>& asked,
                                          const rules& r) {
    for (const cause& c : d.own->causes) {
        if (c.axis != axis || !is_process(c.effect) || !is_claimed(c) || cause_in(*d.reference, axis, c.effect))
            continue;
        difference found = difference_of(d, c);
        const auto with = with_some(d.of_reference, *d.own,
                                    [&](const cause& x) { return x.axis == axis && is_process(x.effect); });
        bool would_show = true;
        if (asked && with) {
            const fit_of_log joined = asked(*with);
            found.loss = out.reference.total - joined.total;
            would_show = found.loss >= r.margin && shrinks(out.reference, joined, r);
        }
        (would_show ? out.process : out.process_undecided).push_back(std::move(found));
    }
}

QUADRANT_DIAGNOSIS_DECL finding by_scores(const direction& d, const std::string& axis, log_of_axis& reference,
                                          log_of_axis& own, const rules& r) {
    const auto of = [&](const machine_description& m) -> const axis_description& {
        return *named(m.axes, axis);
    };
    finding out;
    out.reference = reference.explained_by(of(d.of_reference));
    out.before = own.explained_by(of(d.for_own));
    out.own = own.explained_by(of(d.of_own));
    const fit_of_log reference_by_own = reference.explained_by(of(d.for_reference));
    const double common =
        std::max(out.reference.total + out.before.total, reference_by_own.total + out.own.total);
    const auto of_axis = [&](const cause& c) {
        return c.axis == axis && !is_replayed(c.effect) && !is_process(c.effect);
    };
    out.after = out.before;
    const auto whole = with_some(d.for_own, d.across, of_axis);
    const fit_of_log all = whole ? own.explained_by(of(*whole)) : out.before;
    for (const cause& c : d.across.causes) {
        if (!of_axis(c) || !is_claimed(c)) continue;
        if (is_in(*d.reference, c)) continue;
        difference found = difference_of(d, c);
        if (!found.first.empty() && !found.second.empty() && same_size(found.first, found.second)) continue;
        if (is_of_record(c.effect)) { // the record of the one shows it, or not
            (cause_in(*d.reference, axis, c.effect) ? out.undecided : out.named).push_back(std::move(found));
            continue;
        }
        const auto is_this = [&](const cause& x) { return of_axis(x) && x.effect == c.effect; };
        const auto is_other = [&](const cause& x) { return of_axis(x) && x.effect != c.effect; };
        // What makes no machine alone is asked together with the others.
        const auto others = with_some(d.for_own, d.across, is_other),
                   alone = with_some(d.of_reference, d.across, is_this),
                   with_others = alone ? alone : with_some(d.of_reference, d.across, of_axis);
        const fit_of_log without = others ? own.explained_by(of(*others)) : out.before,
                         joined = with_others ? reference.explained_by(of(*with_others)) : out.reference;
        found.gain = all.total - without.total;
        found.loss = out.reference.total - joined.total;
        if (found.gain < r.margin || !shrinks(all, without, r)) continue;
        found.probability = std::min(found.probability, at_most_probable(d, out.reference, without, all));
        const bool asked_of_both = found.loss >= r.margin && shrinks(out.reference, joined, r);
        if (found.probability >= 0.5) (asked_of_both ? out.named : out.undecided).push_back(std::move(found));
    }
    const auto score_with = [&](const std::vector<difference>& some) {
        const auto machine = with_some(d.for_own, d.across, [&](const cause& c) {
            return of_axis(c) && std::any_of(some.begin(), some.end(),
                                             [&](const difference& x) { return x.effect == c.effect; });
        });
        out.after = some.empty() ? out.before : machine ? own.explained_by(of(*machine)) : all;
        return out.reference.total + out.after.total - r.margin * static_cast<double>(some.size());
    };
    out.score = score_with(out.named);
    // One machine explains both as well: the motion of the one shows what that of the other does not.
    if (!out.named.empty() && out.score < common) {
        std::move(out.named.begin(), out.named.end(), std::back_inserter(out.undecided));
        out.named.clear();
        out.score = score_with({});
    }
    find_process(
        out, d, axis, [&](const machine_description& m) { return reference.explained_by(of(m)); }, r);
    return out;
}

QUADRANT_DIAGNOSIS_DECL finding by_names(const direction& d, const std::string& axis, const rules& r) {
    finding out;
    for (const cause& c : d.across.causes) {
        if (c.axis != axis || is_replayed(c.effect) || !is_claimed(c)) continue;
        const cause* here = cause_in(*d.own, axis, c.effect);
        if (!here || !is_claimed(*here) || is_in(*d.reference, c)) continue;
        out.named.push_back(difference_of(d, c));
        out.score += out.named.back().probability;
    }
    find_process(out, d, axis, {}, r);
    return out;
}

QUADRANT_DIAGNOSIS_DECL void add_replayed(std::vector<difference>& to, const direction& d,
                                          const direction& back, const std::string& axis) {
    for (const cause& c : d.across.causes) {
        if (c.axis != axis || !is_replayed(c.effect) || !is_claimed(c)) continue;
        const cause* there = cause_in(*d.reference, axis, c.effect);
        if (there && !is_claimed(*there))
            continue; // a controller that no key corrects there may be the same here
        if (c.effect == "controller_mismatch") {
            const cause* other_way = cause_in(back.across, axis, c.effect);
            if (!other_way || !is_claimed(*other_way)) continue;
        }
        if (c.effect == "added_command" && there) continue;
        const auto has = [&](const difference& x) { return x.effect == c.effect; };
        if (std::none_of(to.begin(), to.end(), has)) to.push_back(difference_of(d, c));
    }
}

inline verdict verdict_of(const diagnosis_result& d, const std::string& axis) {
    return named(d.axes, axis)->verdict;
}

QUADRANT_DIAGNOSIS_DECL bool differ_without_a_name(const finding& f, const direction& d,
                                                   const std::string& axis, const rules& r) {
    const double rest = std::hypot(f.reference.above_floor(), f.own.above_floor());
    const bool settled =
        verdict_of(*d.reference, axis) <= verdict::explained && verdict_of(*d.own, axis) <= verdict::explained;
    return f.own.total > f.after.total + r.margin && shrinks(f.own, f.after, r) &&
           taken_off(f.after, f.own) > (settled ? r.near_floor * f.own.floor : rest) &&
           verdict_of(d.across, axis) > verdict::within_tolerance;
}

QUADRANT_DIAGNOSIS_DECL bool holds_more(const finding& f, const direction& d, const std::string& axis,
                                        const rules& r) {
    return verdict_of(*d.reference, axis) <= verdict::explained &&
           verdict_of(d.across, axis) > verdict::explained &&
           f.after.above_floor() > r.near_floor * f.reference.above_floor();
}

} // namespace quadrant::inline v0::diagnosis::detail::beside
