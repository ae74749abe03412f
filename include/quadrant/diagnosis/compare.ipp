// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "apply.hpp"
#include "diagnose.hpp"
#include "fit/neighbour.hpp"
#include "log/at_period.hpp"
#include "log/sensor_box.hpp"
#include "match.hpp"
#include "which/chance.hpp"
#include "which/pieces.hpp"
#include "which/search.hpp"
#include "write_machine.hpp"

#include <list>

namespace quadrant::diagnosis {

namespace detail::beside {

/// How a description, calibrated inside its tolerances, explains a log.
struct fit_of_log {
    double total = 0;      ///< log-score of held-out motion, without anything that was searched for
    double force = 0;      ///< residual, rms [N]
    double floor = 0;      ///< the same of noise and rounding alone [N]
    std::size_t names = 0; ///< suspects of the axis

    double above_floor() const { return std::sqrt(std::max(0.0, force * force - floor * floor)); }
};
/// The force that takes what `less` leaves to what `more` leaves, both above the noise; 0: it grows.
inline double taken_off(const fit_of_log& less, const fit_of_log& more) {
    const double before = less.above_floor(), after = more.above_floor();
    return std::sqrt(std::max(0.0, (before - after) * (before + after)));
}

/// One axis of one log, cut and scaled once, so that every description is scored alike on it.
class log_of_axis {
public:
    log_of_axis(const machine_description& machine, const axis_description& axis, const machine_log& log,
                rules r)
        : limits_(r), excluded_(machine.excluded_effects),
          log_(with_neighbour(log, *named(log.axes, axis.name), machine.sample_period_s,
                              bandwidth_of(axis, *named(log.axes, axis.name), machine.sample_period_s))),
          record_(prepared(axis, machine.sample_period_s)) {}
    log_of_axis(const log_of_axis&) = delete; // the record refers to the log
    log_of_axis& operator=(const log_of_axis&) = delete;

    fit_of_log explained_by(const axis_description& axis) {
        record_.observer.substeps = std::max(
            record_.observer.substeps, substeps_of(plant_model(axis, record_.scale.give()), record_.period));
        const search models(record_, axis, excluded_, limits_, [](const std::string&) {});
        const candidate& c = models.calibrated();
        return {c.total, models.held_out_force(c), models.floor_force(c), models.suspects().size()};
    }

private:
    axis_record prepared(const axis_description& axis, double period) const {
        const double count = observed_count(log_.position, log_.position_step);
        const bool coarse = axis.encoder.resolution_m > 0 && count > 1.5 * axis.encoder.resolution_m;
        const double resolution =
            std::max({axis.encoder.resolution_m, coarse ? count : 0.0, log_.position_step});
        std::size_t motions = 0;
        return for_machine(
            in_pieces(prepare(log_, period, resolution, scales_of(axis.plant, log_, period, resolution)),
                      motions),
            axis);
    }
    rules limits_;
    std::vector<std::string> excluded_;
    axis_log log_;
    axis_record record_;
};

/// What no machine file has a key for: it happened in one record.
inline bool is_of_record(const std::string& effect) {
    const quadrant::diagnosis::effect* known = effect_named(effect);
    return known && known->keys.empty() && effect != "controller_mismatch";
}
/// A process runs when its log is recorded; where in its cycle it begins is that log's own.
inline bool is_process(const std::string& effect) { return effect == "cutting_force"; }
/// What a replay of the controller or the steps of the reading show, whatever the model of the plant.
inline bool is_replayed(const std::string& effect) {
    return effect == "controller_mismatch" || effect == "added_command" || effect == "encoder_quantization";
}
inline bool is_claimed(const cause& c) { return std::max(c.probability, c.group_probability) >= 0.5; }

inline const cause* cause_in(const diagnosis_result& d, const std::string& axis, const std::string& effect) {
    for (const cause& c : d.causes)
        if (c.axis == axis && c.effect == effect) return &c;
    return nullptr;
}

/// The machine with what a diagnosis found: every cause that `keep` picks, claims and suspects. Values that
/// moved inside the owner's tolerance stay as described: either log may move them anew. Nothing where these
/// causes alone make no machine, as a static friction whose Coulomb level is another cause.
template <class Keep>
std::optional<machine_description> with_some(const machine_description& machine, diagnosis_result d,
                                             const Keep& keep) {
    std::erase_if(d.causes, [&](const cause& c) {
        return is_of_record(c.effect) || (c.effect == "controller_mismatch" && !is_claimed(c)) || !keep(c);
    });
    for (axis_result& a : d.axes) {
        a.calibrated.clear();
        a.calibrated_with_suspects.clear();
    }
    try {
        return apply(machine, std::move(d), 0);
    } catch (const bad_input&) {
        return {};
    }
}
/// With all of them, or with the claims where the suspects make no machine, or as described.
inline machine_description with_causes(const machine_description& machine, const diagnosis_result& d) {
    auto all = with_some(machine, d, [](const cause&) { return true; });
    if (!all) all = with_some(machine, d, is_claimed);
    return all ? std::move(*all) : machine;
}

/// What a description says under the keys of these values, as numbers without an interval; empty: nothing.
inline std::vector<parameter_estimate> described(const machine_description& machine, const cause& c) {
    const nlohmann::ordered_json all = to_json(machine), &axis = all["axes"][c.axis];
    std::vector<parameter_estimate> out;
    for (const parameter_estimate& p : c.parameters) {
        const auto dot = p.key.find('.');
        const std::string box = c.effect == "controller_mismatch" ? "controller"
                                : dot == p.key.npos               ? "plant"
                                                                  : p.key.substr(0, dot);
        const nlohmann::ordered_json* at = axis.contains(box) ? &axis[box] : nullptr;
        std::string rest =
            c.effect == "controller_mismatch" || dot == p.key.npos ? p.key : p.key.substr(dot + 1);
        for (std::size_t end; at && (end = rest.find('.')) != rest.npos; rest.erase(0, end + 1))
            at = at->contains(rest.substr(0, end)) ? &(*at)[rest.substr(0, end)] : nullptr;
        if (at && !at->contains(rest) && rest.ends_with("_per_V")) rest.back() = 'A';
        if (!at || !at->contains(rest)) continue;
        parameter_estimate found{.key = p.key, .values = {}};
        const auto add = [&](const nlohmann::ordered_json& v) {
            if (v.is_number()) found.values.push_back({v.get<double>(), v.get<double>(), v.get<double>()});
        };
        const nlohmann::ordered_json& value = (*at)[rest];
        if (value.is_array())
            for (const auto& v : value) add(v);
        else
            add(value);
        if (!found.values.empty()) out.push_back(std::move(found));
    }
    return out;
}

/// Size of a value, or of all its harmonics together, with its interval.
inline estimate size_of(const parameter_estimate& p) {
    if (p.values.size() == 1) return p.values.front();
    double size = 0, half = 0;
    for (const estimate& e : p.values) {
        size = std::hypot(size, e.value);
        half = std::hypot(half, (e.high - e.low) / 2);
    }
    return {size, size - half, size + half};
}
/// Whether an effect has the same size in both logs, as far as their intervals tell. Where something repeats
/// depends on where a log begins to count; a phase is no size.
inline bool same_size(const std::vector<parameter_estimate>& a, const std::vector<parameter_estimate>& b) {
    for (const parameter_estimate& p : a)
        for (const parameter_estimate& q : b) {
            if (p.key != q.key || p.key.ends_with("phase_rad")) continue;
            const estimate x = size_of(p), y = size_of(q);
            if (x.low > y.high || y.low > x.high) return false;
        }
    return true;
}

/// The values of an effect in a diagnosis, as a cause or as the other reading of one; empty: it is in none.
inline std::vector<parameter_estimate> values_in(const diagnosis_result& d, const std::string& axis,
                                                 const std::string& effect) {
    if (const cause* c = cause_in(d, axis, effect)) return c->parameters;
    for (const cause& c : d.causes)
        for (const reading& r : c.readings)
            if (c.axis == axis && r.effect == effect) return r.parameters;
    return {};
}
/// Whether a cause, or the other reading of it, is in another diagnosis with the same size.
inline bool is_in(const diagnosis_result& d, const cause& c) {
    const auto same = [&](const std::string& effect, const std::vector<parameter_estimate>& values) {
        const auto there = values_in(d, c.axis, effect);
        return !there.empty() && same_size(there, values);
    };
    return same(c.effect, c.parameters) ||
           std::any_of(c.readings.begin(), c.readings.end(),
                       [&](const auto& r) { return same(r.effect, r.parameters); });
}
/// What one log shows, with the values of the other log where both show an effect in the same size: as good a
/// description of the first, within its intervals, and no difference for the other. The process is that of the
/// other log.
inline diagnosis_result lent(diagnosis_result d, const diagnosis_result& to) {
    std::erase_if(d.causes, [](const cause& c) { return is_process(c.effect); });
    std::copy_if(to.causes.begin(), to.causes.end(), std::back_inserter(d.causes),
                 [](const cause& c) { return is_process(c.effect); });
    for (cause& c : d.causes) {
        const cause* there = cause_in(to, c.axis, c.effect);
        const auto values = values_in(to, c.axis, c.effect);
        if (values.empty() || !same_size(c.parameters, values)) continue;
        c.parameters = values;
        c.with_suspects = there ? there->with_suspects : std::vector<parameter_estimate>{};
    }
    return d;
}

/// One log explained by the machine that the other shows.
struct direction {
    bool found_in_second = true;
    const diagnosis_result* reference = nullptr; ///< the log whose machine is the description
    const diagnosis_result* own = nullptr;       ///< the log that is explained
    machine_description of_reference{}, of_own{};
    machine_description for_own{}, for_reference{}; ///< what the one shows, as it is lent to the other
    diagnosis_result across{};                      ///< the log that is explained against for_own
};

/// What a direction says of one axis.
struct finding {
    std::vector<difference> named, undecided;
    fit_of_log reference{}, before{}, after{}, own{};
    double score = 0; ///< log-score of both logs with the differences, less what these must bring
};

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
    out.first = d.found_in_second ? std::move(reference) : c.parameters;
    out.second = d.found_in_second ? c.parameters : std::move(reference);
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

/// An axis whose forces the log shows: each difference is asked of both logs.
inline finding by_scores(const direction& d, const std::string& axis, log_of_axis& reference, log_of_axis& own,
                         const rules& r) {
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
        // What no name explains in the other log may be what this name stands for here; and no law of what both
        // have is right to more than a few per cent.
        const double explained = taken_off(without, all);
        const bool open = d.reference->verdict > verdict::explained;
        const double rest = open ? out.reference.above_floor() : 0;
        found.probability = std::min(found.probability, 1 - by_chance(all.names, rest / explained));
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
    return out;
}

/// An axis behind a drive with loops of its own, or of which positions alone are known: what one log claims
/// against the machine file and against the other's machine, and the other does not have.
inline finding by_names(const direction& d, const std::string& axis) {
    finding out;
    for (const cause& c : d.across.causes) {
        if (c.axis != axis || is_replayed(c.effect) || !is_claimed(c)) continue;
        const cause* here = cause_in(*d.own, axis, c.effect);
        if (!here || !is_claimed(*here) || is_in(*d.reference, c)) continue;
        out.named.push_back(difference_of(d, c));
        out.score += out.named.back().probability;
    }
    return out;
}

/// What a replay shows: another key of the controller in one log than in the other, a signal that is added in
/// one, a coarser count.
inline void add_replayed(std::vector<difference>& to, const direction& d, const direction& back,
                         const std::string& axis) {
    for (const cause& c : d.across.causes) {
        if (c.axis != axis || !is_replayed(c.effect) || !is_claimed(c)) continue;
        const cause* there = cause_in(*d.reference, axis, c.effect);
        if (there && !is_claimed(*there))
            continue; // a controller that nothing mends there may be the same here
        if (c.effect == "controller_mismatch") {
            const cause* other_way = cause_in(back.across, axis, c.effect);
            if (!other_way || !is_claimed(*other_way)) continue;
        }
        if (c.effect == "added_command" && there) continue;
        const auto has = [&](const difference& x) { return x.effect == c.effect; };
        if (std::none_of(to.begin(), to.end(), has)) to.push_back(difference_of(d, c));
    }
}

/// A process that runs in one log, and not in the other.
inline void add_process(std::vector<difference>& to, const direction& d, const std::string& axis) {
    for (const cause& c : d.own->causes)
        if (c.axis == axis && is_process(c.effect) && is_claimed(c) && !cause_in(*d.reference, axis, c.effect))
            to.push_back(difference_of(d, c));
}

inline verdict verdict_of(const diagnosis_result& d, const std::string& axis) {
    return named(d.axes, axis)->verdict;
}
/// Whether the two logs differ by more than what neither machine explains in its own log, and than laws are
/// right to, whatever the name.
inline bool differ_without_a_name(const finding& f, const direction& d, const std::string& axis,
                                  const rules& r) {
    const double rest = std::hypot(f.reference.above_floor(), f.own.above_floor());
    const bool settled =
        verdict_of(*d.reference, axis) <= verdict::explained && verdict_of(*d.own, axis) <= verdict::explained;
    return f.own.total > f.after.total + r.margin && shrinks(f.own, f.after, r) &&
           taken_off(f.after, f.own) > (settled ? r.near_floor * f.own.floor : rest) &&
           verdict_of(d.across, axis) > verdict::within_tolerance;
}
/// Whether the log that is explained holds a force that no name explains, and the other nothing like it.
inline bool holds_more(const finding& f, const direction& d, const std::string& axis, const rules& r) {
    return verdict_of(*d.reference, axis) <= verdict::explained &&
           verdict_of(d.across, axis) > verdict::explained &&
           f.after.above_floor() > r.near_floor * f.reference.above_floor();
}

} // namespace detail::beside

QUADRANT_DIAGNOSIS_DECL comparison_result compare(const machine_description& machine, const machine_log& first,
                                                  const machine_log& second_as_read, const progress& tell,
                                                  const rules& r) {
    namespace beside = detail::beside;
    const machine_log second = has_period_of(machine, second_as_read)
                                   ? second_as_read
                                   : at_period(second_as_read, machine.sample_period_s);
    const auto in = [&](const char* what) {
        return [&tell, what](const std::string& line) { tell(std::string(what) + ": " + line); };
    };
    comparison_result out;
    out.machine_file = machine.file;
    out.first_file = first.file;
    out.second_file = second.file;
    out.first = diagnose(machine, first, nullptr, in("first log"), r);
    out.second = diagnose(machine, second, nullptr, in("second log"), r);
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
    out.notes = out.first.notes;
    for (const std::string& note : out.second.notes)
        if (std::find(out.notes.begin(), out.notes.end(), note) == out.notes.end()) out.notes.push_back(note);
    double explained[2] = {0, 0};
    std::vector<std::array<beside::finding, 2>> found;
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
            for (std::size_t i = 0; i < 2; ++i) f[i] = beside::by_names(ways[i], a.name);
        } else {
            tell("axis " + a.name + ": both ways");
            beside::log_of_axis one(machine, axis, first, r), other(machine, axis, second, r);
            f[0] = beside::by_scores(ways[0], a.name, one, other, r);
            f[1] = beside::by_scores(ways[1], a.name, other, one, r);
        }
        for (std::size_t i = 0; i < 2; ++i) explained[i] += f[i].score;
        out.axes.push_back(std::move(c));
    }
    const std::size_t way = explained[1] > explained[0] ? 1 : 0;
    const beside::direction &d = ways[way], &back = ways[1 - way];
    out.found_in_second = d.found_in_second;
    for (std::size_t k = 0; k < out.axes.size(); ++k) {
        compared_axis& a = out.axes[k];
        beside::finding& f = found[k][way];
        beside::add_replayed(f.named, d, back, a.name);
        beside::add_replayed(f.named, back, d, a.name);
        for (const beside::direction* one : {&d, &back}) beside::add_process(f.named, *one, a.name);
        a.found_in_second = d.found_in_second;
        a.force_before_N = f.before.force;
        a.force_after_N = f.after.force;
        a.force_own_N = f.own.force;
        a.force_common_N = f.reference.force;
        a.floor_N = f.before.floor;
        const beside::finding& g = found[k][1 - way];
        const bool unnamed = beside::holds_more(f, d, a.name, r) || beside::holds_more(g, back, a.name, r) ||
                             (beside::differ_without_a_name(f, d, a.name, r) &&
                              beside::differ_without_a_name(g, back, a.name, r));
        a.likeness = !f.named.empty()       ? likeness::differ
                     : !f.undecided.empty() ? likeness::undecided
                     : unnamed              ? likeness::unnamed
                                            : likeness::alike;
        out.likeness = std::max(out.likeness, a.likeness);
        std::move(f.named.begin(), f.named.end(), std::back_inserter(out.differences));
        std::move(f.undecided.begin(), f.undecided.end(), std::back_inserter(out.undecided));
    }
    out.across = std::move(ways[way].across);
    return out;
}

} // namespace quadrant::diagnosis
