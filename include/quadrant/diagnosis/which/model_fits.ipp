// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL void model_fits::says(const std::string& line) const {
    const double done = looks_ / looks_of_a_round_;
    tell_(axis_.name + ": " + line, rounds_ ? done / std::max(*rounds_, done) : 1 - std::exp2(-done));
}

QUADRANT_DIAGNOSIS_DECL std::string model_fits::names_of(std::span<const std::size_t> some,
                                                         const std::vector<candidate>& models) {
    std::string out;
    for (const std::size_t i : some) {
        const effect& added = *models[i].effects.back();
        (out += out.empty() ? "" : ", ") += label_of(added);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void model_fits::begin_at(candidate& c, plant_model known) {
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i) {
        const parameter& p = c.fit.parameters[i];
        c.fit.x[static_cast<Eigen::Index>(i)] =
            std::clamp(p.to_fit(p.of(known)), p.to_fit(p.low), p.to_fit(p.high));
    }
    fitter::put(c.fit.plant, c.fit.parameters, c.fit.x);
}

QUADRANT_DIAGNOSIS_DECL std::size_t model_fits::effort() const {
    if (!record_.replayed()) return 1;
    const std::size_t affords =
        std::max<std::size_t>(1, rules_.rows_of_a_look / std::max<std::size_t>(1, record_.position.size()));
    // The valleys of a path are narrow: few steps from a start show little, but three times as many are enough.
    return record_.closed() ? std::min<std::size_t>(3, affords) : affords;
}

QUADRANT_DIAGNOSIS_DECL candidate model_fits::as_described(candidate c) {
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i)
        if (const parameter& p = c.fit.parameters[i]; p.spread > 0 && !is_of_record(p))
            c.fit.x[static_cast<Eigen::Index>(i)] = p.expected;
    fitter::put(c.fit.plant, c.fit.parameters, c.fit.x);
    return c;
}

QUADRANT_DIAGNOSIS_DECL const candidate* model_fits::alone(const effect& e) const {
    for (const candidate& c : tried_)
        if (c.effects.size() == 1 && c.effects.front() == &e) return pays(c, calibrated_) ? &c : nullptr;
    return nullptr;
}

QUADRANT_DIAGNOSIS_DECL candidate model_fits::joined(const candidate& from, const effect* added) {
    candidate c{.effects = from.effects};
    c.effects.push_back(added);
    return c;
}

QUADRANT_DIAGNOSIS_DECL void model_fits::sketch_each(const candidate& from,
                                                     const std::vector<std::size_t>& which,
                                                     std::vector<candidate>& models, when_late how,
                                                     begins_at start) const {
    if (which.empty()) return;
    const fitter fit(record_.observer, record_.score);
    const bool bent = record_.replayed() && from.stops_at_a_tolerance();
    const auto begins_as_described = [&](std::size_t i) {
        const effect& e = *models[i].effects.back();
        return bent || e.bends_calibration || (axis_.drive.closes() && is_beyond_tolerance(from, e));
    };
    std::vector<candidate> origins{from};
    if (std::any_of(which.begin(), which.end(), begins_as_described)) origins.push_back(as_described(from));
    std::vector<std::vector<double>> left, innovation;
    std::vector<shared_slopes> slopes;
    for (const candidate& origin : origins) {
        fit_result here = origin.fit;
        slopes.push_back(fit.slopes(here));
        left.push_back(residual_behind_drive(origin));
        innovation.push_back(std::move(here.innovation.rows));
    }
    std::vector<const fit_result*> found(models.size()); // here: what `pays` remembers is no thread's own
    if (start == begins_at::where_alone)
        for (const std::size_t i : which)
            if (const candidate* c = alone(*models[i].effects.back())) found[i] = &c->fit;
    const auto sketch = [&](std::span<const std::size_t> some) {
        const bool late = how == when_late::leave_out && over();
        for (const std::size_t i : some) {
            models[i].total = -std::numeric_limits<double>::infinity();
            models[i].missed = late;
        }
        if (late) return;
        std::vector<fit_course> courses;
        std::vector<std::size_t> starts_of; // how many of each model
        for (const std::size_t i : some) {
            const std::size_t before = courses.size();
            for (std::size_t j = 0; j < (begins_as_described(i) ? origins.size() : 1); ++j) {
                const screening look{axis_.plant,          axis_.tolerance, record_,
                                     origins[j].fit.plant, left[j],         innovation[j]};
                auto starts = first_looks(fit, origins[j], *models[i].effects.back(), look, slopes[j],
                                          steps_of_a_look(), found[i]);
                std::move(starts.begin(), starts.end(), std::back_inserter(courses));
            }
            starts_of.push_back(courses.size() - before);
        }
        detail::run_the_promising(fit, courses, starts_of, steps_of_a_look());
        std::span<fit_course> rest = courses;
        for (std::size_t j = 0; j < some.size(); rest = rest.subspan(starts_of[j++]))
            detail::take_best(models[some[j]], from, rest.first(starts_of[j]), rules_.near_best);
    };
    in_groups(which, 4, sketch, 1, models);
}

QUADRANT_DIAGNOSIS_DECL void model_fits::finish_best(std::vector<std::size_t>& which, std::size_t most,
                                                     std::vector<candidate>& models, when_late how) const {
    std::stable_sort(which.begin(), which.end(),
                     [&](auto a, auto b) { return models[a].fit.objective < models[b].fit.objective; });
    const std::size_t fitted = std::min(most, which.size());
    const auto fit = [&](std::span<const std::size_t> some) {
        std::vector<candidate*> pair;
        for (const std::size_t i : some) pair.push_back(&models[i]);
        if (how == when_late::leave_out && over())
            for (candidate* c : pair) judge(record_, *c);
        else
            finish(record_, pair);
    };
    in_groups(std::span(which).first(fitted), 4, fit, looks_of_a_fit, models);
    in_groups(std::span(which).subspan(fitted), 1,
              [&](std::span<const std::size_t> one) { judge(record_, models[one[0]]); });
}

QUADRANT_DIAGNOSIS_DECL void model_fits::finish_near(const std::vector<std::size_t>& which, std::size_t fitted,
                                                     const candidate& from,
                                                     std::vector<candidate>& models) const {
    double most = 0; // gained by one of them
    for (const std::size_t i : which)
        if (std::isfinite(models[i].total)) most = std::max(most, models[i].total - from.total);
    if (!(most > rules_.margin)) return;
    std::vector<std::size_t> near;
    for (std::size_t j = std::min(fitted, which.size()); j < which.size(); ++j)
        if (models[which[j]].total - from.total > rules_.near_best * most ||
            (axis_.drive.closes() && is_beyond_tolerance(from, *models[which[j]].effects.back())))
            near.push_back(which[j]);
    const auto fit = [&](std::span<const std::size_t> some) {
        if (over()) return;
        std::vector<candidate*> each;
        for (const std::size_t i : some) each.push_back(&models[i]);
        finish(record_, each);
    };
    in_groups(near, 4, fit, looks_of_a_fit, models);
}

QUADRANT_DIAGNOSIS_DECL const candidate* model_fits::tried(const candidate& from, const effect* added) const {
    for (const candidate& c : tried_)
        if (c.effects.size() == from.effects.size() + 1 && has(c, added) && has_all(c, from)) return &c;
    return nullptr;
}

QUADRANT_DIAGNOSIS_DECL std::string model_fits::describe(const candidate& c) const {
    std::string out;
    for (const effect* e : c.effects) (out += out.empty() ? "" : ", ") += label_of(*e);
    if (!std::isfinite(c.total)) return out += ": this record does not show it";
    return (out += ": gain ") += std::to_string(static_cast<long>(c.total - calibrated_.total));
}

QUADRANT_DIAGNOSIS_DECL bool model_fits::ends_short_of(const candidate& c, const candidate& part) {
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i) {
        const parameter& p = c.fit.parameters[i];
        const double x = p.from_fit(c.fit.x[static_cast<Eigen::Index>(i)]);
        if (p.spread > 0 || !c.ends_at_a_bound(i) || x - p.low < p.high - x) continue;
        for (std::size_t j = 0; j < part.fit.parameters.size(); ++j)
            if (const parameter& q = part.fit.parameters[j];
                q.key == p.key && q.from_fit(part.fit.x[static_cast<Eigen::Index>(j)]) > p.high)
                return true;
    }
    return false;
}

QUADRANT_DIAGNOSIS_DECL void model_fits::mend_from_parts(std::vector<candidate>& models,
                                                         const std::vector<std::size_t>& which,
                                                         const candidate& from) const {
    std::vector<std::pair<std::size_t, candidate>> again; // of which model
    for (const std::size_t i : which) {
        const candidate& c = models[i];
        if (!std::isfinite(c.total) || c.missed) continue;
        const candidate* part = nullptr;
        for (const candidate& t : tried_)
            if (t.effects.size() + 1 == c.effects.size() && has_all(c, t) && !same(t, from) &&
                (t.total > c.total + rules_.margin || ends_short_of(c, t)) && (!part || t.total > part->total))
                part = &t;
        if (!part || over()) continue;
        const auto lacks =
            std::find_if(c.effects.begin(), c.effects.end(), [&](const effect* e) { return !has(*part, e); });
        std::vector<candidate> one{joined(*part, *lacks)};
        sketch_each(*part, {0}, one, when_late::go_on);
        if (std::isfinite(one.front().fit.objective)) again.emplace_back(i, std::move(one.front()));
    }
    std::vector<candidate*> sketches;
    for (auto& [i, c] : again) sketches.push_back(&c);
    finish(record_, sketches);
    for (auto& [i, c] : again) {
        if (!(c.total > models[i].total)) continue;
        c.effects = models[i].effects; // what was added last stays last
        models[i] = std::move(c);
    }
}

QUADRANT_DIAGNOSIS_DECL bool model_fits::is_beyond_tolerance(const candidate& c, const effect& e) {
    if (e.keys.empty()) return false;
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i)
        if (c.fit.parameters[i].key == e.keys.begin()->name && c.stops_at_its_tolerance(i)) return true;
    return false;
}

QUADRANT_DIAGNOSIS_DECL void model_fits::mend_from_alone(std::vector<candidate>& models,
                                                         const std::vector<std::size_t>& which,
                                                         const candidate& from) const {
    if (from.effects.empty() || record_.closed() || over()) return; // a path is looked at from many starts
    std::vector<std::pair<double, std::size_t>> short_of;           // gain alone, and of which model
    for (const std::size_t i : which) {
        const candidate& c = models[i];
        if (!std::isfinite(c.total) || c.missed || !is_beyond_tolerance(from, *c.effects.back())) continue;
        const candidate* const found = alone(*c.effects.back());
        if (!found) continue;
        const double gain = found->total - calibrated_.total;
        if (c.total - from.total < gain / 2) short_of.emplace_back(gain, i);
    }
    std::sort(short_of.rbegin(), short_of.rend());
    short_of.resize(std::min(short_of.size(), rules_.finalists));
    std::vector<candidate> again;
    std::vector<std::size_t> all;
    for (const auto& [gain, i] : short_of) {
        all.push_back(again.size());
        again.push_back(joined(from, models[i].effects.back()));
    }
    sketch_each(from, all, again, when_late::go_on, begins_at::where_alone);
    std::vector<candidate*> sketches;
    for (candidate& c : again)
        if (std::isfinite(c.fit.objective)) sketches.push_back(&c);
    finish(record_, sketches);
    for (std::size_t j = 0; j < again.size(); ++j)
        if (again[j].total > models[short_of[j].second].total) models[short_of[j].second] = std::move(again[j]);
}

} // namespace quadrant::inline v0::diagnosis
