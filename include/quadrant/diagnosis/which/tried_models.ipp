// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/unlisted.hpp"
#include "lowest_terms.hpp"

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL void tried_models::begins(const progress& part, std::optional<double> rounds) const {
    tell_ = part;
    looks_ = 0;
    looks_of_a_round_ =
        static_cast<double>(suspects().size()) + looks_of_a_fit * static_cast<double>(most_fitted());
    rounds_ = rounds;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
tried_models::with_each(const candidate& from, const std::vector<const effect*>& among) const {
    std::vector<candidate> out;
    std::vector<std::size_t> rank; // of those that were not met before
    for (const effect* e : among) {
        if (has(from, e)) continue;
        const candidate* known = tried(from, e);
        if (!known) rank.push_back(out.size());
        out.push_back(known ? *known : joined(from, e));
    }
    sketch_each(from, rank, out, when_late::leave_out);
    finish_best(rank, most_fitted(), out, when_late::leave_out);
    finish_near(rank, most_fitted(), from, out);
    mend_from_parts(out, rank, from);
    mend_from_alone(out, rank, from);
    mend_in_lowest_terms(out, rank);
    for (std::size_t i : rank) {
        if (out[i].missed) {
            missed_.insert(out[i].effects.back());
            continue;
        }
        says(describe(out[i]));
        tried_.push_back(out[i]);
    }
    std::erase_if(out, [](const candidate& c) { return !std::isfinite(c.total); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL void tried_models::mend_in_lowest_terms(std::vector<candidate>& models,
                                                                const std::vector<std::size_t>& which) const {
    std::vector<std::pair<std::size_t, candidate>> again; // of which model
    for (const std::size_t i : which) {
        if (!std::isfinite(models[i].total) || models[i].missed || over()) continue;
        candidate c = models[i];
        const auto by_own_period = detail::by_shortest_periods(c);
        if (!by_own_period) continue;
        begin_at(c, *by_own_period);
        again.emplace_back(i, std::move(c));
    }
    std::vector<candidate*> sketches;
    for (auto& [i, c] : again) sketches.push_back(&c);
    finish(record_, sketches);
    for (auto& [i, c] : again)
        if (c.total > models[i].total) models[i] = std::move(c);
}

QUADRANT_DIAGNOSIS_DECL candidate tried_models::with(const candidate& from, const effect* added) const {
    return with_these(from, {added}).front();
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> tried_models::with_these(const candidate& from,
                                                                        const std::vector<const effect*>& added,
                                                                        std::size_t most) const {
    std::vector<candidate> out;
    std::vector<std::size_t> fresh;
    for (const effect* e : added) {
        const candidate* known = tried(from, e);
        if (!known) fresh.push_back(out.size());
        out.push_back(known ? *known : joined(from, e));
    }
    sketch_each(from, fresh, out, when_late::go_on);
    finish_best(fresh, most, out, when_late::go_on);
    mend_from_parts(out, fresh, from);
    mend_from_alone(out, fresh, from);
    mend_in_lowest_terms(out, fresh);
    for (std::size_t i : fresh) {
        says(describe(out[i]));
        tried_.push_back(out[i]);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL candidate tried_models::with(const std::vector<const effect*>& effects) const {
    candidate whole{.effects = effects};
    for (const candidate& known : tried_)
        if (same(known, whole) && std::isfinite(known.total)) return known;
    candidate c = calibrated_;
    std::vector<const effect*> waiting = effects;
    for (bool found = true; found;) {
        found = false;
        for (const effect* e : std::exchange(waiting, {}))
            if (candidate next = with(c, e); std::isfinite(next.total)) {
                c = std::move(next);
                found = true;
            } else {
                waiting.push_back(e);
            }
    }
    c.effects.insert(c.effects.end(), waiting.begin(), waiting.end());
    return c;
}

QUADRANT_DIAGNOSIS_DECL candidate tried_models::taken_off(const candidate& whole, const effect* own) const {
    candidate out = whole;
    std::erase(out.effects, own);
    out.fit.plant = plant_without(whole, *own);
    plant_model there = whole.fit.plant;
    const auto values = own->read(there);
    std::erase_if(out.fit.parameters, [&](const parameter& p) {
        return !is_calibrated(p) &&
               std::any_of(values.begin(), values.end(), [&](const key_value& v) { return v.key == p.key; });
    });
    for (const parameter& p : calibrated_.fit.parameters) // what the effect's own numbers had replaced
        if (std::none_of(out.fit.parameters.begin(), out.fit.parameters.end(),
                         [&](const parameter& q) { return &q.of(there) == &p.of(there); }))
            out.fit.parameters.push_back(p);
    out.fit.x.resize(static_cast<Eigen::Index>(out.fit.parameters.size()));
    begin_at(out, out.fit.plant);
    return out;
}

QUADRANT_DIAGNOSIS_DECL candidate tried_models::without(const candidate& whole, const effect* own) const {
    return without_each(whole, {own}).front();
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
tried_models::without_each(const candidate& whole, const std::vector<const effect*>& each) const {
    std::vector<candidate> out;
    std::vector<shorter> fresh;
    const auto others = [&](const effect* own) {
        candidate c{.effects = whole.effects};
        std::erase(c.effects, own);
        return c;
    };
    const auto known = [&](const effect* own) {
        return std::find_if(shorter_.begin(), shorter_.end(), [&](const shorter& s) {
            return s.of == whole.held_out_force && s.own == own && same(s.model, others(own));
        });
    };
    for (const effect* own : each) {
        const std::vector<const effect*> left = others(own).effects;
        out.push_back(with(left));
        if (!left.empty() && !over() && known(own) == shorter_.end())
            fresh.push_back({whole.held_out_force, own, taken_off(whole, own)});
    }
    std::vector<candidate*> models;
    for (shorter& s : fresh) models.push_back(&s.model);
    finish(record_, models);
    std::move(fresh.begin(), fresh.end(), std::back_inserter(shorter_));
    for (std::size_t i = 0; i < each.size(); ++i) {
        const auto again = known(each[i]);
        if (again == shorter_.end() || !(again->model.total > out[i].total)) continue;
        out[i] = again->model;
        out[i].effects = others(each[i]).effects; // in the order of these
        for (candidate& c : tried_)
            if (same(c, out[i])) c = out[i];
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
tried_models::exchanged(const candidate& whole, const effect* own,
                        const std::vector<const effect*>& added) const {
    candidate from = taken_off(whole, own);
    fitter(record_.observer, record_.score).evaluate(from.fit); // what it is worth as it stands
    std::vector<candidate> out;
    std::vector<std::size_t> all;
    for (const effect* e : added) {
        all.push_back(out.size());
        out.push_back(joined(from, e));
    }
    sketch_each(from, all, out, when_late::go_on);
    finish_best(all, all.size(), out, when_late::go_on);
    for (candidate& known : tried_)
        for (const candidate& again : out)
            if (same(known, again) && again.total > known.total) known = again;
    return out;
}

QUADRANT_DIAGNOSIS_DECL void tried_models::take_over(const tried_models& other) {
    for (const candidate& c : other.tried_)
        if (std::none_of(c.effects.begin(), c.effects.end(),
                         [this](const effect* e) { return excluded_.contains(e->name); }))
            tried_.push_back(c);
}

QUADRANT_DIAGNOSIS_DECL bool tried_models::possible(const effect& e) const {
    // What is logged behind the amplifier has passed everything that acts on the command.
    if (axis_.actuator.command_is == command_origin::measured && e.joins == joint::command) return false;
    if (e.rotary_only && axis_.kind == axis_kind::linear) return false;
    if (e.of_described_friction && !axis_.plant.describes_friction()) return false;
    return axis_.drive.closes() ? beside_drive(e) : e.box != "drive";
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> tried_models::suspects() const {
    std::vector<const effect*> out;
    const auto allowed = [&](const effect* e) { return !excluded_.contains(e->name) && possible(*e); };
    for (const effect* e : every_effect())
        if (e->starts && allowed(e)) out.push_back(e);
    std::copy_if(axis_.own_effects.begin(), axis_.own_effects.end(), std::back_inserter(out), allowed);
    return out;
}

QUADRANT_DIAGNOSIS_DECL const std::vector<candidate>& tried_models::with_excluded(const candidate& from) const {
    for (const beside_excluded& known : excluded_models_)
        if (same(known.from, from)) return known.models;
    std::vector<candidate> out;
    std::vector<std::size_t> which;
    for (const effect* e : every_effect())
        if (e->starts && excluded_.by_owner_alone(e->name) && possible(*e) && !has(from, e)) {
            which.push_back(out.size());
            out.push_back(joined(from, e));
        }
    sketch_each(from, which, out, when_late::leave_out);
    finish_best(which, rules_.finalists, out, when_late::leave_out);
    std::erase_if(out, [](const candidate& c) { return c.missed || !std::isfinite(c.total); });
    excluded_models_.push_back({{.effects = from.effects}, std::move(out)});
    return excluded_models_.back().models;
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> tried_models::forms() const {
    std::vector<const effect*> out(unlisted::curves.begin(), unlisted::curves.end());
    if (record_.observer.led) std::erase(out, &unlisted::by_command);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> tried_models::relatives(const candidate& before) const {
    std::vector<const effect*> out = suspects();
    if (rules_.near_rivals)
        std::erase_if(out, [&](const effect* e) {
            const candidate* there = tried(before, e);
            return there && !(there->total > before.total + rules_.margin);
        });
    return out;
}

QUADRANT_DIAGNOSIS_DECL bool tried_models::beside_drive(const effect& e) const {
    if (e.name == "force_constant" && is_force(axis_.command_unit)) return false; // the drive's gain
    if (e.joins != joint::command || e.box == "drive" || e.name == "actuator_lag") return true;
    return e.name == "actuator_saturation" && record_.observer.drive && record_.observer.drive->tapped();
}

} // namespace quadrant::inline v0::diagnosis
