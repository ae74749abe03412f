// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL void weigh(std::vector<rival>& rivals, const axis_case& c) {
    auto draws = segment_draws(c.record.segments);
    // The score of a path counts every reading once, and a motion that alone shows an effect is not to be lost.
    if (c.record.closed()) draws.assign(1, std::vector<double>(c.record.segments, 1.0));
    std::vector<double> score(rivals.size()), second(rivals.size());
    if (c.tested_apart()) {
        std::vector<const candidate*> models;
        for (const rival& r : rivals) models.push_back(&r.model);
        second = c.scores_on_second(models);
    }
    for (const auto& draw : draws) {
        for (std::size_t j = 0; j < rivals.size(); ++j) {
            score[j] = second[j] - rivals[j].model.penalty;
            for (std::size_t s = 0; s < draw.size(); ++s) score[j] += draw[s] * rivals[j].model.held_out[s];
        }
        const double top = *std::max_element(score.begin(), score.end());
        double sum = 0;
        for (double& v : score) sum += v = std::exp((v - top) / score_temperature);
        for (std::size_t j = 0; j < rivals.size(); ++j)
            rivals[j].weight += score[j] / sum / static_cast<double>(draws.size());
    }
}

QUADRANT_DIAGNOSIS_DECL bool contains(const candidate& model, const candidate& other, const effect& e) {
    for (const effect* in : model.effects)
        if (in->holds == e.name) return true;
    const auto frees = [](const candidate& m, const std::string& key) {
        return std::any_of(m.fit.parameters.begin(), m.fit.parameters.end(),
                           [&](const parameter& p) { return p.key == key && !(p.spread > 0); });
    };
    bool all = false;
    for (const key_value& k : e.read(other.fit.plant))
        if (frees(other, k.key)) {
            if (!frees(model, k.key)) return false;
            all = true;
        }
    return all;
}

QUADRANT_DIAGNOSIS_DECL double between(double before, double after) {
    return std::sqrt(std::max(std::numeric_limits<double>::min(), square(before) - square(after)));
}

QUADRANT_DIAGNOSIS_DECL double explained_by(const axis_case& c, std::size_t which) {
    const double after = c.models.held_out_force(c.best());
    const double found = between(c.models.held_out_force(c.path[which]), after);
    if (!c.record.replayed() || !c.path[which].stops_at_a_tolerance()) return found;
    return std::max(found, between(c.models.force_without(c.best(), *c.best().effects[which]), after));
}

/// Of a group stay the likeliest names that hold 95 % of its weight, the first, and what is one model with it.
inline void leave_out_the_unlikely(std::vector<rival>& rivals, double all) {
    std::vector<rival*> same;
    for (rival& r : rivals)
        if (r.same && &r != &rivals.front() && !may_be_one(*r.name, *rivals.front().name)) same.push_back(&r);
    std::stable_sort(same.begin(), same.end(),
                     [](const rival* a, const rival* b) { return a->weight < b->weight; });
    double out = 0;
    for (rival* r : same)
        if ((out += r->weight) < 0.05 * all) r->unlikely = true;
}

/// What the best model takes off the residual force beside the model without one of its causes, on this log and
/// on the hold-out log, and off the forces along the measured motion: a model that stands still where the axis
/// moves leaves little to its predictions and all of them.
class taken_gap {
public:
    taken_gap(const axis_case& c, const candidate& without) : case_(c), here_(of_log(without, c.best())) {
        if (c.tested_apart()) there_ = of_holdout(without, c.best());
        if (!c.record.observer.led && !c.axis.drive.closes() && shows_along_motion(c.best()) &&
            shows_along_motion(without)) {
            const auto left = c.left_along_motion(std::array{without.fit.plant, c.best().fit.plant});
            along_ = {square(left[0]), square(left[1])};
        }
    }
    /// Whether a model takes at least half of it off, in energy. Asked only of a log on which it is most of
    /// what is there.
    bool is_taken_by(const candidate& m) const {
        return here_.is_taken(case_.models.held_out_force(m)) &&
               (!there_.asked() || there_.is_taken(case_.second_log(m).force)) &&
               (!along_.asked() || !shows_along_motion(m) ||
                along_.is_taken(case_.left_along_motion(std::span(&m.fit.plant, 1)).front()));
    }

private:
    struct on_a_log {
        double before = 0, after = 0; // in energy
        bool asked() const { return after < before / 2; }
        bool is_taken(double force) const { return !asked() || force * force < (before + after) / 2; }
    };
    on_a_log of_log(const candidate& without, const candidate& best) const {
        return {square(case_.models.held_out_force(without)), square(case_.models.held_out_force(best))};
    }
    on_a_log of_holdout(const candidate& without, const candidate& best) const {
        return {square(case_.second_log(without).force), square(case_.second_log(best).force)};
    }

    const axis_case& case_;
    on_a_log here_, there_{}, along_{};
};

QUADRANT_DIAGNOSIS_DECL std::vector<rival> rivals_of(const axis_case& c, std::size_t which) {
    const effect* own = c.best().effects[which];
    const candidate without = c.models.without(c.best(), own);
    std::vector<rival> out{{.model = c.best(), .name = own}};
    std::vector<std::size_t> same;
    std::vector<const effect*> names;
    for (const auto& model : c.models.with_each(without, c.models.relatives(c.path[which])))
        for (const effect* e : model.effects)
            if (!search::has(without, e) && e != own && !contains(model, c.best(), *own)) {
                // The same model by another name is fitted as well as the first, whenever it was met. So is an
                // everyday force: on one motion many a rarer one does what it does.
                if (may_be_one(*e, *own) || e->everyday) {
                    same.push_back(out.size());
                    names.push_back(e);
                }
                out.push_back({.model = model, .name = e});
            }
    if (!c.models.over()) {
        auto again = c.models.exchanged(c.best(), own, names);
        for (std::size_t i = 0; i < same.size(); ++i)
            if (again[i].total > out[same[i]].model.total) out[same[i]].model = std::move(again[i]);
    }
    // A form without a name is a rival when it takes the name's place: it takes most of what is left off, and
    // beside it the name is no longer needed. A polynomial in the velocity comes close to Coulomb friction, but
    // the jump is missing in it.
    if (!c.settled && !c.models.over()) {
        const auto forms = c.models.forms();
        const auto models = c.models.with_these(without, forms, c.limits.forms);
        for (std::size_t i = 0; i < models.size(); ++i)
            if (c.takes_off(models[i], c.best()) > 0.5 &&
                !c.models.pays(c.models.with(models[i], own), models[i]))
                out.push_back({.model = models[i], .name = forms[i]});
    }
    // What takes most of the gap off is not replaced by a name that leaves it: the score alone is also raised
    // by models that stand still, or that hide the motor's motion behind a play.
    if (!c.settled && !c.record.closed()) {
        const taken_gap gap(c, without);
        std::erase_if(
            out, [&](const rival& r) { return r.name != own && !r.unlisted() && !gap.is_taken_by(r.model); });
    }
    weigh(out, c);

    const double energy = square(c.models.held_out_force(c.best()));
    const double unexplained = c.settled ? 0 : std::max(0.0, energy - square(c.floor_force()));
    const double there = c.tested_apart() ? square(c.second_log(c.best()).force) : 0;
    const double unexplained_there = there - square(c.floor_force());
    const auto excess_on_second = [&](const candidate& m) {
        if (!c.tested_apart() || !c.record.replayed() || !(unexplained_there > 0)) return 0.0;
        return std::max(0.0, square(c.second_log(m).force) - there) / unexplained_there;
    };
    const auto excess_of_own = [&](const candidate& m) {
        const double here = std::max(0.0, energy - square(c.models.held_out_force(m))) / unexplained;
        if (!c.tested_apart() || !(unexplained_there > 0)) return here;
        return here + std::max(0.0, there - square(c.second_log(m).force)) / unexplained_there;
    };
    std::optional<double> of_own;
    const auto force_of_own = [&] {
        if (!of_own) of_own = c.models.force_of(c.best(), *own);
        return *of_own;
    };
    for (auto& r : out) {
        const auto excess = [&] { return std::max(0.0, square(c.models.held_out_force(r.model)) - energy); };
        // A name that corrects nothing is no rival. Two whose difference is smaller than what both leave
        // unexplained are not distinguished by it, nor are two that are one model (docs/formats.md) while their
        // predictions agree.
        const bool pays = r.model.total > without.total + c.limits.margin;
        // A name that does far less than the one that it would stand in for does not stand in for it: in its
        // model something beside it does.
        const auto stands_in = [&] {
            return &r == &out.front() || r.unlisted() || c.record.closed() ||
                   c.models.force_of(r.model, *r.name) > force_of_own() / 3;
        };
        // Not distinguished by either log. A name that is more flexible and no better is no second reading.
        const bool leaner = r.model.penalty <= c.best().penalty || r.model.total >= c.best().total;
        const bool near = pays && leaner && !c.record.closed() && !r.unlisted() && unexplained > 0;
        const double more = near ? excess() / unexplained + excess_on_second(r.model) : 1;
        const bool within = near && more < 1 && stands_in();
        const bool equivalent =
            may_be_one(*r.name, *own) && !c.record.closed() &&
            excess() < std::max(told_apart * energy, square(law_error * explained_by(c, which))) && stands_in();
        const double odds = std::min(1.0, r.name->prior.odds / own->prior.odds);
        if (within) r.weight = std::max(r.weight, odds * std::exp(-more) * out.front().weight);
        if (equivalent) r.weight = std::max(r.weight, odds / (1 + odds) * out.front().weight);
        // Where a gap stays open, a simpler and commoner name that leaves no more is the likelier one, whatever
        // the flexible one gains where the scores feel what neither explains.
        const double commoner = r.name->prior.odds / own->prior.odds;
        if (within && r.model.penalty < c.best().penalty && !(excess() > 0))
            r.weight = std::max(r.weight, commoner * out.front().weight);
        if (pays && unexplained > 0 && !c.record.closed() && !r.unlisted() && commoner < 1 &&
            r.model.penalty > c.best().penalty && square(c.models.held_out_force(r.model)) >= energy)
            r.weight = std::min(r.weight, commoner * out.front().weight);
        // Two names of one model whose difference is small beside what both leave: the commoner one is
        // likelier, whichever was found first.
        if (equivalent && within && c.record.replayed()) {
            const double less = excess_of_own(r.model);
            r.weight = std::max(r.weight, commoner * std::exp(-more) * out.front().weight);
            if (&r != &out.front())
                out.front().weight = std::max(out.front().weight, std::exp(-less) / commoner * r.weight);
        }
        r.same = !r.unlisted() && (within || equivalent || (pays && r.weight > 0.01 && stands_in()));
    }
    double sum = 0;
    for (const auto& r : out) sum += r.weight;
    if (c.record.closed()) leave_out_the_unlikely(out, sum);
    // A name that the search did not come to may be as good as the cause itself, as often as it is as common.
    double all = 0, missed = 0;
    for (const effect* e : c.models.suspects()) {
        all += e->prior.odds;
        if (c.models.missed().contains(e)) missed += e->prior.odds;
    }
    if (missed > 0) sum += out.front().weight * missed / all;
    for (auto& r : out) r.weight /= sum;
    return out;
}

QUADRANT_DIAGNOSIS_DECL double left_beside(const axis_case& c, std::size_t which) {
    return c.excused ? 0 : between(c.models.held_out_force(c.best()), c.floor_force()) / explained_by(c, which);
}

QUADRANT_DIAGNOSIS_DECL double doubtful_beside(const axis_case& c, double explained) {
    const double left = between(c.models.held_out_force(c.best()), c.floor_force());
    if (c.excused && left < explained) return 0;
    const double all = between(c.models.held_out_force(c.path.front()), c.models.held_out_force(c.best()));
    return std::hypot(left, all > explained ? law_error * between(all, explained) : 0) / explained;
}

/// The same, with the segment set apart that holds most of what is left: what happens once speaks against no
/// name that explains the rest of the record.
inline double doubtful_beside_odd_segment(const axis_case& c, std::size_t which) {
    const auto odd = c.models.odd_segment(c.best());
    if (!odd) return std::numeric_limits<double>::infinity();
    const auto force = [&](const candidate& m) { return c.models.held_out_force_beside(m, *odd); };
    const double after = force(c.best()), explained = between(force(c.path[which]), after),
                 all = between(force(c.path.front()), after);
    return std::hypot(between(after, c.floor_force()),
                      all > explained ? law_error * between(all, explained) : 0) /
           explained;
}

QUADRANT_DIAGNOSIS_DECL double beside_path(const axis_record& r, const plant_model& plant) {
    std::vector<double> e;
    predictor on_the_model = r.observer;
    on_the_model.closed = r.velocity[0];
    on_the_model.run(plant, e);
    double sum = 0, rows = 0;
    for (std::size_t k = r.score.skip; k < r.position.size(); ++k)
        if (r.left_out.empty() || !r.left_out[k]) {
            sum += square(e[k]);
            ++rows;
        }
    return rows > 0 ? sum / rows : 0;
}

QUADRANT_DIAGNOSIS_DECL double left_of_paths(const axis_case& c, std::size_t which) {
    std::vector<const effect*> others = c.best().effects;
    std::erase(others, c.best().effects[which]);
    const plant_model with = c.best().fit.plant,
                      without = others.empty() ? c.models.plant_without(c.best(), *c.best().effects[which])
                                               : c.models.with(others).fit.plant;
    double left = beside_path(c.record, with), before = beside_path(c.record, without);
    if (c.tested_apart()) {
        left += beside_path(*c.second, restarted(with, *c.second));
        before += beside_path(*c.second, restarted(without, *c.second));
    }
    return std::sqrt(left) / between(std::sqrt(before), std::sqrt(left));
}

QUADRANT_DIAGNOSIS_DECL std::size_t names_as_likely(const axis_case& c, const effect& e) {
    double all = 0;
    const auto suspects = c.models.suspects();
    for (const effect* s : suspects) all += s->prior.odds;
    return std::min(suspects.size(), static_cast<std::size_t>(std::ceil(all / e.prior.odds)));
}

/// The best model without one of its causes, to be judged on the hold-out log. Fitted again, its other causes
/// may hold the axis fast where it moves: a model that leaves more of the forces along the motion than the
/// others with the numbers that they have only predicts what it corrects.
inline candidate without_standing(const axis_case& c, std::size_t which) {
    const effect* own = c.best().effects[which];
    std::vector<const effect*> others = c.best().effects;
    std::erase(others, own);
    candidate again = c.models.with(others);
    if (others.empty() || c.record.observer.led || c.axis.drive.closes() || !shows_along_motion(c.best()))
        return again;
    candidate kept{.effects = others}; // a model of its own: what is known of the other is not true of it
    kept.fit.plant = c.models.plant_without(c.best(), *own);
    const auto left = c.left_along_motion(std::array{again.fit.plant, kept.fit.plant});
    return left[0] > left[1] ? kept : again;
}

QUADRANT_DIAGNOSIS_DECL double unknown(const axis_case& c, std::size_t which) {
    const std::size_t names = names_as_likely(c, *c.best().effects[which]);
    if (!c.tested_apart()) {
        if (c.record.closed()) return by_chance(names, left_of_paths(c, which));
        const double out = by_chance(names, doubtful_beside(c, explained_by(c, which)));
        // Nothing is below what chance does at the noise.
        return out > by_chance(names, 0)
                   ? std::min(out, by_chance(names, doubtful_beside_odd_segment(c, which)))
                   : out;
    }
    const auto before = c.second_log(without_standing(c, which)), after = c.second_log(c.best());
    const double gain = std::clamp((after.score - before.score) / score_temperature, -50.0, 0.0);
    const auto with_gain = [&](double out) { return 1 / (1 + (1 - out) / out * std::exp(gain)); };
    // What predicts another motion worse than the machine file does is no cause of both.
    constexpr double doubt = 0.6;
    if (c.axis.drive.takes_position() && c.log.drive &&
        beside_path(*c.second, restarted(c.best().fit.plant, *c.second)) >
            beside_path(*c.second, restarted(c.models.given().fit.plant, *c.second)))
        return doubt;
    if (c.record.closed()) return with_gain(by_chance(names, c.excused ? 0 : left_of_paths(c, which)));
    const double machine = c.second_log(c.path.front()).force; // calibrated, without any cause
    const double here = explained_by(c, which), there = between(std::min(before.force, machine), after.force);
    double out = by_chance(names, doubtful_beside(c, std::max(here, there)));
    if (!c.settled_on_second) // the motion there may show it less, but not nothing of it beside an open gap
        out = std::max(out, by_chance(names, between(after.force, c.floor_force()) / std::sqrt(here * there)));
    return with_gain(out);
}

QUADRANT_DIAGNOSIS_DECL double against_others(const axis_case& c, const std::vector<rival>& names) {
    std::vector<const effect*> same;
    for (const rival& r : names)
        if (r.same || &r == &names.front()) same.push_back(r.name);
    std::vector<const effect*> others = c.best().effects;
    std::erase(others, names.front().name);
    std::optional<taken_gap> gap;
    if (!c.settled && !c.record.closed()) gap.emplace(c, c.models.with(others));
    const double own = c.worth(c.best());
    const auto worth = [&](const candidate& m) {
        // Of a path that no further name improves enough, a model with more names says nothing.
        const bool longer = c.record.closed() && m.effects.size() > c.best().effects.size();
        if (longer) return -std::numeric_limits<double>::infinity();
        const double out = c.worth(m);
        const bool matters = gap && out > own - 5 * score_temperature;
        return matters && !gap->is_taken_by(m) ? -std::numeric_limits<double>::infinity() : out;
    };
    return 1 / (1 + std::exp((c.models.best_without(same, c.least_score(), worth) - c.worth(c.best())) /
                             score_temperature));
}

QUADRANT_DIAGNOSIS_DECL excluded_rival excluded_instead_of(const axis_case& c, std::size_t which) {
    constexpr double owner_errs = 0.05;
    const effect* own = c.best().effects[which];
    std::vector<const effect*> others = c.best().effects;
    std::erase(others, own);
    std::vector<candidate> models = c.models.with_excluded(c.path.front());
    if (!others.empty())
        for (candidate& m : c.models.with_excluded(c.models.with(others))) models.push_back(std::move(m));
    std::erase_if(models, [&](const candidate& m) { return contains(m, c.best(), *own); });
    const auto score = [&](const candidate& m) {
        return m.total + (c.tested_apart() ? c.second_log(m).score : 0);
    };
    const double named = score(c.best());
    excluded_rival out;
    for (const candidate& m : models) {
        // That two names are wrong at once is as rare as an owner who errs.
        const double more =
            static_cast<double>(m.effects.size()) - static_cast<double>(c.best().effects.size());
        const double gain = score(m) - named - c.limits.margin * more;
        const double odds = owner_errs * std::exp(std::min(50.0, gain / score_temperature));
        if (odds / (1 + odds) > out.probability) out = {m.effects.back(), odds / (1 + odds)};
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void in_lowest_terms(std::vector<parameter_estimate>& values) {
    parameter_estimate *cycle = nullptr, *phases = nullptr, *sizes = nullptr;
    for (parameter_estimate& p : values) {
        if (p.key.find("period") != p.key.npos || p.key == "process.fundamental_Hz") cycle = &p;
        if (p.key.ends_with("phase_rad")) phases = &p;
    }
    for (parameter_estimate& p : values)
        if (phases && &p != phases && p.values.size() == phases->values.size() && p.values.size() > 1)
            sizes = &p;
    if (!cycle || !sizes) return;
    double odd = 0, all = 0;
    for (std::size_t i = 0; i < sizes->values.size(); ++i) {
        all += square(sizes->values[i].value);
        if (i % 2 == 0) odd += square(sizes->values[i].value);
    }
    if (!(odd < 0.01 * all)) return;
    for (parameter_estimate* p : {sizes, phases}) {
        std::vector<estimate> even;
        for (std::size_t i = 1; i < p->values.size(); i += 2) even.push_back(p->values[i]);
        p->values = even;
    }
    const double factor = cycle->key.ends_with("_Hz") ? 2 : 0.5;
    for (estimate& e : cycle->values) e = {factor * e.value, factor * e.low, factor * e.high};
    in_lowest_terms(values);
}

QUADRANT_DIAGNOSIS_DECL void add_model_error(std::vector<parameter_estimate>& values, const effect& e,
                                             const axis_case& c, double left) {
    in_lowest_terms(values);
    const double relative = std::min(1.0, std::hypot(0.01, left));
    for (auto& p : values)
        for (estimate& v : p.values) {
            const double part = relative * (p.key.ends_with("_rad") ? 1.0 : std::abs(v.value));
            const double error = std::hypot(part, p.key.ends_with("_m") ? 0.5 * c.resolution : 0.0);
            v.low = v.value - std::hypot(v.value - v.low, error);
            v.high = v.value + std::hypot(v.high - v.value, error);
        }
    for (estimate& v : values.front().values) v.high *= e.by_another_law;
}

QUADRANT_DIAGNOSIS_DECL void widen(std::vector<parameter_estimate>& mine,
                                   const std::vector<parameter_estimate>& other) {
    for (auto& p : mine)
        for (const auto& o : other)
            if (o.key == p.key)
                for (std::size_t k = 0; k < std::min(p.values.size(), o.values.size()); ++k) {
                    p.values[k].low = std::min(p.values[k].low, o.values[k].low);
                    p.values[k].high = std::max(p.values[k].high, o.values[k].high);
                }
}

QUADRANT_DIAGNOSIS_DECL bool may_be_inside_its_tolerance(const axis_case& c,
                                                         const std::vector<parameter_estimate>& found) {
    if (!c.axis.drive.closes() || c.record.closed() || found.empty() ||
        !found.front().key.starts_with("drive."))
        return false;
    for (const parameter& p : c.path.front().fit.parameters)
        if (p.key == found.front().key && p.spread > 0) {
            const estimate& e = found.front().values.front();
            return e.low <= p.high && e.high >= p.low;
        }
    return false;
}

QUADRANT_DIAGNOSIS_DECL bool drowns_in_the_rest(const axis_case& c, const effect& e) {
    if (c.record.replayed() || !c.calibrated_within_tolerances()) return false;
    const std::array plants{c.best().fit.plant, c.models.plant_without(c.best(), e)};
    std::array<std::vector<double>, 2> innovation;
    c.record.observer.run(plants, innovation);
    auto &left = innovation[0], &does = innovation[1];
    for (std::size_t k = 0; k < does.size(); ++k) does[k] -= left[k];
    return std::all_of(c.record.score.channels.begin(), c.record.score.channels.end(),
                       [&](const channel& band) { return rms(seen(does, band)) < 2 * rms(seen(left, band)); });
}

/// Whether what was found of an effect says no more than that the machine follows another law than the file's:
/// the described number is in the interval of its value, which is as wide as other laws of it read otherwise.
inline bool is_as_described(const cause& found, const effect& e, const plant_model& as_given) {
    if (!found.described || !(e.by_another_law > 1)) return false;
    const estimate& value = found.parameters.front().values.front();
    const double described = e.read(as_given).front().values.front();
    return value.low <= described && described <= value.high;
}

/// Whether the record leaves the frequency or the period of a cause open: its interval is as wide to either
/// side as the value, so that none of a shorter period is distinguished from it.
inline bool is_undetermined(const std::vector<parameter_estimate>& values) {
    return std::any_of(values.begin(), values.end(), [](const parameter_estimate& p) {
        const bool cycle = p.key.find("frequency") != p.key.npos || p.key.find("period") != p.key.npos;
        return cycle && p.values[0].high - p.values[0].low > 2 * p.values[0].value;
    });
}

QUADRANT_DIAGNOSIS_DECL void to_suspects(std::span<cause> causes) {
    constexpr double guess = 0.4;
    for (cause& x : causes) {
        x.probability = std::min(x.probability, guess);
        x.group_probability = std::min(x.group_probability, guess);
    }
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<cause> plant_causes(const axis_case& c,
                                                        const std::vector<std::vector<detail::rival>>& rivals) {
    const auto& effects = c.best().effects;
    std::vector<cause> out;
    const bool of_laws = !effects.empty() && c.calibrated_within_its_laws();
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const effect& e = *effects[i];
        cause named;
        named.axis = c.axis.name;
        named.effect = e.name;
        named.exciting_motion = e.exciting_motion;
        named.parameters = estimates(c.best(), e, c.record.score);
        plant_model as_given = c.models.given().fit.plant, nothing_described;
        nothing_described.friction.contact.length = c.record.scale.give();
        for (const parameter& p : c.best().fit.parameters)
            if (p.key == named.parameters.front().key && p.of(as_given) != p.of(nothing_described))
                named.described = true;
        for (const auto& r : rivals[i]) {
            if (r.name == &e) {
                named.probability = r.weight;
                named.group_probability += r.weight;
            } else if (r.same && !r.unlikely) {
                named.confusable_with.emplace_back(r.name->name);
                named.group_probability += r.weight;
                auto values = estimates(r.model, *r.name, c.record.score);
                detail::add_model_error(values, *r.name, c, detail::left_beside(c, i));
                named.readings.push_back({std::string(r.name->name), std::move(values)});
            } else if (r.unlisted() && r.weight > 0.5) {
                named.better_form = r.name->name;
            }
        }
        // Where another cause has a second reading, this one's values under that reading belong to its
        // interval.
        for (std::size_t j = 0; j < rivals.size(); ++j)
            for (const auto& r : rivals[j])
                if (j != i && r.same && r.name != effects[j])
                    detail::widen(named.parameters, estimates(r.model, e, c.record.score));
        const bool undetermined = detail::is_undetermined(named.parameters); // by its own scatter
        detail::add_model_error(named.parameters, e, c, detail::left_beside(c, i));
        // A suspect that is worth its place on held-out motion was there in one of eleven, however little spoke
        // for it (docs/trial.md).
        constexpr double least = 0.08;
        const auto excluded = detail::excluded_instead_of(c, i);
        if (excluded.probability > 0.5) named.better_excluded = excluded.name->name;
        const double known =
            (1 - detail::unknown(c, i)) * detail::against_others(c, rivals[i]) * (1 - excluded.probability);
        named.probability = std::max(least, named.probability * known);
        named.group_probability = std::max(named.probability, named.group_probability * known);
        // An error of a law of friction is a force on the axis: it has no part in the command or the reading.
        const bool like_friction = e.joins != joint::command && e.joins != joint::reading;
        if ((of_laws && like_friction) || c.is_error_of_its_law(e) || undetermined ||
            detail::may_be_inside_its_tolerance(c, named.parameters) || detail::drowns_in_the_rest(c, e) ||
            detail::is_as_described(named, e, as_given))
            detail::to_suspects({&named, 1});
        out.push_back(std::move(named));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double rounding_force(const axis_case& c, double count) {
    return residual_force_floor(c.axis.plant.mass_kg, count / std::sqrt(12.0), c.record.period,
                                c.record.bandwidth_Hz);
}

QUADRANT_DIAGNOSIS_DECL std::optional<cause> count_cause(const axis_case& c) {
    if (!c.coarse() || c.count_unnamed) return {};
    cause out;
    out.axis = c.axis.name;
    out.effect = "encoder_quantization";
    out.exciting_motion = "any: the steps of the reading are counted";
    out.described = true;
    out.probability = out.group_probability = 0.97;
    out.parameters.push_back({"encoder.resolution_m", {{c.count, c.count, c.count}}});
    return out;
}

QUADRANT_DIAGNOSIS_DECL cause added_cause(const axis_case& c) {
    const added_finding& found = *c.controller->added;
    cause out;
    out.axis = c.axis.name;
    out.effect = "added_command";
    out.exciting_motion = "any: the controller is replayed from the log";
    out.probability = out.group_probability = found.probability;
    out.waveform = found.waveform;
    if (found.of_controller > 0.01) {
        out.confusable_with = {"controller_mismatch"};
        out.group_probability += found.of_controller;
        const double value = c.controller->value;
        out.readings.push_back({out.confusable_with.front(), {{c.controller->key, {{value, value, value}}}}});
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::optional<cause> controller_cause(const axis_case& c) {
    if (!c.controller_differs() || c.controller_unnamed) return {};
    if (c.command_is_added()) return added_cause(c);
    cause out;
    out.axis = c.axis.name;
    out.effect = "controller_mismatch";
    out.exciting_motion = "any: the controller is replayed from the log";
    out.described = true;
    out.probability = out.group_probability = c.controller->mended ? 0.97 : 0.4;
    if (!c.controller->key.empty())
        out.parameters.push_back(
            {c.controller->key, {{c.controller->value, c.controller->low, c.controller->high}}});
    for (const auto& other : c.controller->alternatives)
        out.readings.push_back({out.effect, {{other.key, {{other.value, other.value, other.value}}}}});
    return out;
}

} // namespace quadrant::inline v0::diagnosis
