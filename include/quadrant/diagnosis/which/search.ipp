// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::run() const {
    candidate best = calibrated_;
    std::vector<candidate> beam{calibrated_};
    while (best.effects.size() < rules_.most_causes && !at_noise(best) &&
           (best.effects.empty() || (!over() && !(enough(best) && beyond_tolerance(best).empty())))) {
        std::vector<candidate> next;
        const auto add = [&](std::vector<candidate> some) {
            for (candidate& c : some)
                if (std::none_of(next.begin(), next.end(), [&](const auto& n) { return same(n, c); }))
                    next.push_back(std::move(c));
        };
        for (const candidate& from : beam)
            add(!best.effects.empty() && enough(best) ? with_each(from, beyond_tolerance(from))
                                                      : with_each(from));
        if (calibrate_again(best, next)) {
            beam.assign(1, best);
            continue;
        }
        const candidate* step = paying(next, best);
        if (best.effects.empty() && !over() && !(step && (at_noise(*step) || enough(*step)))) {
            add(everyday(step ? *step : calibrated_));
            step = paying(next, best);
        }
        if (step && goes_on_without(best, *step)) {
            beam.assign(1, best);
            continue;
        }
        if (step) {
            const candidate chosen = *step;
            beam.assign(1, chosen);
            for (const auto& c : next)
                if (beam.size() < rules_.beam && !has_all(c, chosen) &&
                    c.total - best.total >
                        std::max(rules_.margin, rules_.abreast * (chosen.total - best.total)))
                    beam.push_back(c);
            best = chosen;
            continue;
        }
        if (!best.effects.empty() && !over() && begin_as_described(best)) {
            beam.assign(1, best);
            continue;
        }
        if (!best.effects.empty() || immaterial(best) || over()) break;
        next = in_pairs(next);
        step = paying(next, best);
        if (!step) break;
        best = *step;
        beam.assign(1, best);
    }
    best = by_the_scale(best);
    cut_ = over();
    if (cut_ && !best.effects.empty()) fit_to_the_end(best); // a first look may be all that there was time for
    // What does not take the gap of the machine file down explains nothing, however well it scores.
    if (!best.effects.empty() && !shrinks(best, given_)) best = calibrated_;
    return path_to(best);
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::in_pairs(std::vector<candidate> single) const {
    std::erase_if(single, [](const candidate& c) { return c.effects.size() > 1; });
    single.resize(std::min(rules_.in_pairs, single.size()));
    std::vector<candidate> out;
    for (std::size_t i = 0; i < single.size() && !over(); ++i) {
        std::vector<const effect*> others;
        for (std::size_t j = i + 1; j < single.size(); ++j)
            if (!has(single[i], single[j].effects.back())) others.push_back(single[j].effects.back());
        for (candidate& c : with_these(single[i], others)) out.push_back(std::move(c));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void search::fit_to_the_end(candidate& best) const {
    finish(record_, best);
    for (candidate& known : tried_)
        if (same(known, best)) known = best;
}

QUADRANT_DIAGNOSIS_DECL bool search::explains_the_rest(const candidate& step, const candidate& best) const {
    constexpr double most = 0.2;
    const bool matters = best.effects.empty() || !record_.replayed() || !near_floor(best) || !settled(best);
    const auto is_added_beyond_tolerance = [&](const effect* e) {
        return !has(best, e) && is_beyond_tolerance(best, *e);
    };
    return matters || std::any_of(step.effects.begin(), step.effects.end(), is_added_beyond_tolerance) ||
           structure(step, noise(step)) < std::max(rules_.structure, most * structure(best, noise(best)));
}

QUADRANT_DIAGNOSIS_DECL candidate search::by_the_scale(const candidate& best) const {
    const candidate *head = nullptr, *scale = nullptr; // what the best of its names does alone
    for (const effect* e : best.effects)
        if (const candidate* c = alone(*e); c && (!head || c->total > head->total)) head = c;
    for (const effect* e : suspects())
        if (e->joins == joint::motor_gain && !is_wave(*e) && !has(best, e))
            if (const candidate* c = alone(*e); c && (!scale || c->total > scale->total)) scale = c;
    if (best.effects.size() < 2 || !head || !scale || scale->total < head->total - rules_.margin) return best;
    std::vector<const effect*> others = suspects();
    std::erase(others, head->effects.front());
    candidate way = *scale;
    while (way.effects.size() < best.effects.size() && !over()) {
        std::vector<candidate> next = with_each(way, others);
        const candidate* step = paying(next, way);
        if (!step) break;
        way = *step;
    }
    return worth(way) > worth(best) + rules_.margin ? way : best;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::path_to(const candidate& best) const {
    std::vector<candidate> path{best};
    while (!path.back().effects.empty()) {
        const candidate& whole = path.back();
        candidate kept;
        kept.total = -std::numeric_limits<double>::infinity();
        for (candidate& c : without_each(whole, whole.effects))
            if (c.total > kept.total) kept = std::move(c);
        // What remains without a name must explain something by itself: two may be needed together.
        const bool both = !kept.effects.empty() && pays(whole, calibrated_) && !pays(kept, calibrated_);
        if (path.size() == 1 && !pays(whole, kept) && !both) path.pop_back();
        path.push_back(std::move(kept));
    }
    std::reverse(path.begin(), path.end());
    for (std::size_t i = 1; i < path.size(); ++i) { // the order in which the causes are reported
        auto order = path[i - 1].effects;
        for (const effect* e : path[i].effects)
            if (!has(path[i - 1], e)) order.push_back(e);
        path[i].effects = order;
    }
    return path;
}

QUADRANT_DIAGNOSIS_DECL bool search::calibrate_again(candidate& best,
                                                     const std::vector<candidate>& next) const {
    if (best.effects.empty()) return false;
    const candidate* better = nullptr;
    const auto is_calibrated_beside = [&](const candidate& c) {
        const auto added =
            std::find_if(c.effects.begin(), c.effects.end(), [&](const effect* e) { return !has(best, e); });
        return c.effects.size() == best.effects.size() + 1 && has_all(c, best) && is_calibration(c, *added);
    };
    for (const candidate& c : next)
        if (c.total > best.total + rules_.margin && (!better || c.total > better->total) &&
            is_calibrated_beside(c))
            better = &c;
    if (!better) return false;
    return fits_better_from(better->fit.plant, best);
}

QUADRANT_DIAGNOSIS_DECL bool search::begin_as_described(candidate& best) const {
    if (structure(best, noise(best)) < rules_.structure) return false;
    plant_model begun = best.fit.plant, described = given_.fit.plant;
    for (const parameter& p : best.fit.parameters)
        if (is_calibrated(p)) p.of(begun) = p.of(described);
    return fits_better_from(begun, best);
}

QUADRANT_DIAGNOSIS_DECL bool search::fits_better_from(const plant_model& begun, candidate& best) const {
    candidate again = best;
    begin_at(again, begun);
    finish(record_, again);
    if (!(again.total > best.total + rules_.margin)) return false;
    // What gained beside it had gone on from where the fit had stopped.
    const double gained = best.total + rules_.margin;
    std::erase_if(tried_,
                  [&](const candidate& c) { return same(c, best) || (has_all(c, best) && c.total > gained); });
    tried_.push_back(again);
    best = std::move(again);
    return true;
}

QUADRANT_DIAGNOSIS_DECL bool search::goes_on_without(candidate& best, const candidate& step) const {
    candidate again = best;
    begin_at(again, step.fit.plant);
    finish(record_, again);
    if (!(again.total > best.total + rules_.margin)) return false;
    // What was tried had gone on from where the fit had stopped. Where the step is still worth its place, the
    // others matter that the same gain would bring beside it.
    const double gain = again.total - best.total;
    const bool stays = pays(step, again);
    std::erase_if(tried_, [&](const candidate& c) {
        const bool near = !stays || c.total + gain > step.total - rules_.margin;
        return same(c, best) || (has_all(c, best) && near);
    });
    if (best.effects.empty()) {
        calibrated_ = again;
        cloud_.clear();
        cloud_of_fitted_.clear();
    } else {
        tried_.push_back(again);
    }
    best = std::move(again);
    return true;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::everyday(const candidate& single) const {
    std::vector<const effect*> each;
    for (const effect* e : suspects())
        if (e->everyday) each.push_back(e);
    // Each set from the one without its last name, and those that begin at the same one side by side.
    std::vector<std::vector<std::size_t>> begun{{}};
    for (std::size_t i = 0; i < begun.size(); ++i) {
        const std::vector<std::size_t> set = begun[i]; // a copy: the list grows
        candidate from;
        for (const std::size_t j : set) from.effects.push_back(each[j]);
        std::vector<const effect*> later;
        for (std::size_t j = set.empty() ? 0 : set.back() + 1; j < each.size(); ++j) {
            later.push_back(each[j]);
            begun.push_back(set);
            begun.back().push_back(j);
        }
        const auto known = std::find_if(tried_.begin(), tried_.end(), [&](const candidate& c) {
            return std::isfinite(c.total) && same(c, from);
        });
        if (!set.empty() && known != tried_.end() && !over()) with_these(*known, later);
    }
    std::vector<candidate> out;
    for (std::size_t set = 3; set < (std::size_t{1} << each.size()) && !over(); ++set) {
        std::vector<const effect*> some;
        for (std::size_t i = 0; i < each.size(); ++i)
            if (set >> i & 1) some.push_back(each[i]);
        if (some.size() > 1) out.push_back(with(some));
    }
    if (!single.effects.empty() && !single.effects.front()->everyday && !over()) {
        const std::vector<candidate> beside = with_these(single, each);
        out.insert(out.end(), beside.begin(), beside.end());
    }
    std::erase_if(out, [](const candidate& c) { return !std::isfinite(c.total); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL const candidate* search::paying(std::vector<candidate>& next,
                                                        const candidate& best) const {
    std::stable_sort(next.begin(), next.end(),
                     [&](const auto& a, const auto& b) { return worth(a) > worth(b); });
    const auto found = std::find_if(next.begin(), next.end(), [&](const auto& c) { return pays(c, best); });
    if (found == next.end() || !explains_the_rest(*found, best)) return nullptr;
    const candidate* step = &*found;
    for (const candidate& c : next) // what a name adds to another that it holds must pay as one more name would
        if (holds(*step, c) && pays(c, best) &&
            step->total - c.total <
                std::max(rules_.margin, rules_.relative_margin * (c.total - calibrated_.total)))
            step = &c;
    return step;
}

} // namespace quadrant::inline v0::diagnosis
