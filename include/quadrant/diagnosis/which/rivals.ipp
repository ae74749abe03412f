// SPDX-License-Identifier: BSL-1.0
// Long: the rules by which a name is weighed against a cause are read together.
#pragma once

namespace quadrant::inline v0::diagnosis::detail {

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
    const auto force = [&](const candidate& m) { return c.models.held_out_force(m); };
    const double after = force(c.best()), found = between(least_before(c, which, force), after);
    if (!c.record.replayed() || !c.path[which].stops_at_a_tolerance()) return found;
    return std::max(found, between(c.models.force_without(c.best(), *c.best().effects[which]), after));
}

QUADRANT_DIAGNOSIS_DECL bool answers_less(const candidate& m, const candidate& than, double share) {
    const auto answer = [](const plant_model& p) {
        return p.force_constant * (1 - p.friction.load) / p.moving_mass();
    };
    return answer(m.fit.plant) < (1 - share) * answer(than.fit.plant);
}

QUADRANT_DIAGNOSIS_DECL bool ignores_the_command(const axis_case& c, const candidate& m) {
    if (c.axis.actuator.command_is != command_origin::measured || c.axis.drive.closes() ||
        c.record.observer.led || !shows_along_motion(m) || !shows_along_motion(c.best()))
        return false;
    if (!answers_less(m, c.path.front(), c.limits.least_shrink)) return false;
    return c.left_along_motion(m) > (1 + c.limits.least_shrink) * c.left_along_motion(c.best());
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

/// Whether an effect does far less in a model than this force, so that something beside it does the work there.
inline bool does_far_less(const axis_case& c, const candidate& m, const effect& e, double than) {
    return !(rms(c.models.does(m, e)) > than / 3);
}

/// The cause number `which` and the names that stand in its place on top of the model `without` it.
inline std::vector<rival> in_its_place(const axis_case& c, std::size_t which, const candidate& without) {
    const effect* own = c.best().effects[which];
    std::vector<rival> out{{.model = c.best(), .name = own}};
    std::vector<std::size_t> same;
    std::vector<const effect*> names;
    for (const auto& model : c.models.with_each(without, c.models.relatives(c.path[which])))
        for (const effect* e : model.effects)
            if (!search::has(without, e) && e != own && !contains(model, c.best(), *own)) {
                // The same model by another name is fitted as well as the first, whenever it was met. So is an
                // everyday force: on one motion many a rarer one does what it does.
                if (may_be_one(*e, *own) || e->everyday || (e->of_speed && own->of_speed)) {
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
    // beside it the name is no longer needed, or does far less than without it. A polynomial in the velocity
    // comes close to Coulomb friction, but the jump is missing in it.
    if (!c.settled && !c.models.over()) {
        const auto forms = c.models.forms();
        const auto models = c.models.with_these(without, forms, c.limits.forms);
        const double of_own = rms(c.models.does(c.best(), *own));
        for (std::size_t i = 0; i < models.size(); ++i) {
            if (!(c.takes_off(models[i], c.best()) > 0.5)) continue;
            const candidate both = c.models.with(models[i], own);
            if (!c.models.pays(both, models[i]) || does_far_less(c, both, *own, of_own))
                out.push_back({.model = models[i], .name = forms[i]});
        }
    }
    // What takes most of the gap off is not replaced by a name that leaves it: the score alone is also raised
    // by models that stand still, or that hide the motor's motion behind a play.
    if (!c.settled && !c.record.closed()) {
        const taken_gap gap(c, without);
        std::erase_if(
            out, [&](const rival& r) { return r.name != own && !r.unlisted() && !gap.is_taken_by(r.model); });
    }
    std::erase_if(out, [&](const rival& r) { return r.name != own && ignores_the_command(c, r.model); });
    return out;
}

/// How much a name leaves unexplained where another stands in its place: scores feel small differences, and two
/// names that leave the same are not distinguished by them.
class left_by_names {
public:
    left_by_names(const axis_case& c, std::size_t which, const candidate& without)
        : case_(c), own_(*c.best().effects[which]),
          energy_(square(c.models.held_out_force_of_described_mass(c.best()))),
          least_(without.total + c.limits.margin), explained_(square(law_error * explained_by(c, which))),
          by_speed_(of_one_speed(c.record) ? square(one_speed * explained_by(c, which)) : 0) {
        const double floor = c.models.floor_force_of_described_mass(c.best());
        if (!c.settled) unexplained_ = std::max(0.0, energy_ - square(floor));
        if (c.tested_apart()) there_ = square(c.second_log(c.best()).force);
        unexplained_there_ = there_ - square(c.floor_force());
        if (!c.record.observer.led && !c.record.replayed() && shows_along_motion(c.best()))
            along_ = c.left_along_motion(c.best());
        if (!(along_ > c.limits.near_floor * floor)) along_ = 0;
    }

    /// Weight of a name, and whether the record distinguishes it from the `first`, the cause itself. What it
    /// makes of the weight of that: `of_first`, for when every name has its own.
    void weigh(rival& r, const rival& first, double& of_first) const {
        const candidate& best = case_.best();
        // A name that corrects nothing is no rival. Two whose difference is smaller than what both leave
        // unexplained are not distinguished by it, nor are two that are one model (docs/formats.md) while their
        // predictions agree.
        const bool pays = r.model.total > least_;
        // Not distinguished by either log. A name that is more flexible and no better is no second reading.
        const bool leaner = r.model.penalty <= best.penalty || r.model.total >= best.total;
        const bool near = pays && leaner && by_force(r) && unexplained_ > 0;
        const double more = near ? excess(r) / unexplained_ + excess_on_second(r.model) : 1;
        const bool within = near && more < 1 && stands_in(r, first);
        const bool equivalent = may_be_one(*r.name, own_) && !case_.record.closed() &&
                                excess(r) < std::max(told_apart * energy_, explained_) && stands_in(r, first);
        // Laws of the speed that differ by no more than the speeds of this motion: only how common they are
        // counts.
        r.of_one_speed = &r != &first && r.name->of_speed && own_.of_speed && by_speed_ > 0 &&
                         !case_.record.closed() && excess(r) < by_speed_ && stands_in(r, first);
        const double commoner = r.name->prior.odds / own_.prior.odds, odds = std::min(1.0, commoner);
        if (within) r.weight = std::max(r.weight, odds * std::exp(-more) * first.weight);
        if (equivalent) r.weight = std::max(r.weight, odds / (1 + odds) * first.weight);
        // Where a gap stays open, a simpler and commoner name that leaves no more is the likelier one, whatever
        // the flexible one gains where the scores feel what neither explains.
        if (within && r.model.penalty < best.penalty && !(excess(r) > 0))
            r.weight = std::max(r.weight, commoner * first.weight);
        if (pays && unexplained_ > 0 && by_force(r) && commoner < 1 && r.model.penalty > best.penalty &&
            square(case_.models.held_out_force_of_described_mass(r.model)) >= energy_)
            r.weight = std::min(r.weight, commoner * first.weight);
        // Two names of one model whose difference is small beside what both leave: the commoner one is
        // likelier, whichever was found first.
        if (equivalent && within && case_.record.replayed()) {
            const double less = excess_of_own(r.model);
            r.weight = std::max(r.weight, commoner * std::exp(-more) * first.weight);
            if (&r != &first) of_first = std::max(of_first, std::exp(-less) / commoner * r.weight);
        }
        if (r.of_one_speed) r.weight = commoner * first.weight;
        const bool follows = pays && &r != &first && follows_the_motion(r) && stands_in(r, first);
        if (follows) r.weight = std::max(r.weight, odds * first.weight);
        r.same = !r.unlisted() && (r.of_one_speed || within || equivalent || follows ||
                                   (pays && r.weight > 0.01 && stands_in(r, first)));
    }

private:
    bool by_force(const rival& r) const { return !case_.record.closed() && !r.unlisted(); }
    /// Whether a name leaves less than half, in energy, of the forces along the measured motion that the cause
    /// itself leaves open: predictions that are corrected by the readings, or that stand still where the axis
    /// is slow, do not show it.
    bool follows_the_motion(const rival& r) const {
        return along_ > 0 && by_force(r) && shows_along_motion(r.model) &&
               2 * square(case_.left_along_motion(r.model)) < square(along_);
    }
    double excess(const rival& r) const {
        return std::max(0.0, square(case_.models.held_out_force_of_described_mass(r.model)) - energy_);
    }
    double excess_on_second(const candidate& m) const {
        if (!case_.tested_apart() || !case_.record.replayed() || !(unexplained_there_ > 0)) return 0;
        return std::max(0.0, square(case_.second_log(m).force) - there_) / unexplained_there_;
    }
    double excess_of_own(const candidate& m) const {
        const double here =
            std::max(0.0, energy_ - square(case_.models.held_out_force_of_described_mass(m))) / unexplained_;
        if (!case_.tested_apart() || !(unexplained_there_ > 0)) return here;
        return here + std::max(0.0, there_ - square(case_.second_log(m).force)) / unexplained_there_;
    }
    /// A name that does far less than the one that it would stand in for does not stand in for it: in its model
    /// something beside it does.
    bool stands_in(const rival& r, const rival& first) const {
        if (&r == &first || !by_force(r)) return true;
        if (!force_of_own_) force_of_own_ = rms(case_.models.does(case_.best(), own_));
        return !does_far_less(case_, r.model, *r.name, *force_of_own_);
    }

    const axis_case& case_;
    const effect& own_;
    double energy_, least_, explained_, by_speed_, unexplained_ = 0, there_ = 0, unexplained_there_ = 0,
                                                   along_ = 0;
    mutable std::optional<double> force_of_own_{};
};

/// The weights of all names add up to one.
inline void share_out(std::vector<rival>& out, const axis_case& c) {
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
}

QUADRANT_DIAGNOSIS_DECL std::vector<rival> rivals_of(const axis_case& c, std::size_t which) {
    const candidate without = c.models.without(c.best(), c.best().effects[which]);
    std::vector<rival> out = in_its_place(c, which, without);
    weigh(out, c);
    const left_by_names left(c, which, without);
    double of_first = 0;
    for (rival& r : out) left.weigh(r, out.front(), of_first);
    out.front().weight = std::max(out.front().weight, of_first);
    share_out(out, c);
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
