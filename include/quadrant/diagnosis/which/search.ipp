// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/unlisted.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The way in which the tap is read with which the described machine, calibrated, gives least otherwise: by the
/// median over the rows, which an effect in a part of them moves little. Where it bends the calibration, the
/// choice may be wrong.
inline tap_reading best_tap(const fitter& fit, const driven_motion& drive, plant_model described,
                            const std::vector<parameter>& own) {
    constexpr int steps = 6; // of a fit: the ways differ by more than its last digits
    tap_reading best = described.drive.read.tap;
    double least = std::numeric_limits<double>::infinity();
    for (const auto way :
         {tap_reading::before_set_point, tap_reading::after_set_point, tap_reading::row_mean}) {
        described.drive.read.tap = way;
        auto size = drive.run(fit.fit(described, own, steps).plant.drive).beside;
        for (double& e : size) e = std::abs(e);
        const double left = quantile(std::move(size), 0.5);
        if (left < least) best = way;
        least = std::min(least, left);
    }
    return best;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL search::search(const axis_record& record, const axis_description& axis,
                                       exclusions excluded, rules r, progress tell)
    : record_(record), axis_(axis), excluded_(std::move(excluded)), rules_(r), tell_(std::move(tell)) {
    given_.fit.plant = plant_model(axis, record.scale.give());
    given_.fit.plant.drive.read = record.read;
    given_.fit.parameters = {};
    given_.fit.x = Eigen::VectorXd(0);
    const fitter fit(record.observer, record.score);
    candidate start;
    start.fit.parameters = calibration(axis, record.scale.give());
    // In the unit of a score that counts in full. Described numbers lie nearer the middle of their tolerance
    // than its ends: a triangle, of half the variance.
    if (record.closed())
        for (parameter& p : start.fit.parameters) p.spread /= std::sqrt(2 * score_temperature);
    for (parameter& p : numbers_of_record(given_.fit.plant, record))
        start.fit.parameters.push_back(std::move(p));
    if (record.taps_force(given_.fit.plant.drive))
        given_.fit.plant.drive.read.tap =
            detail::best_tap(fit, *record.observer.drive, given_.fit.plant, start.fit.parameters);
    start.fit.plant = given_.fit.plant;
    fit.evaluate(given_.fit);
    given_.total = -fit.score_ms(given_.fit.ms); // nothing was fitted: every motion is held out
    start.fit.x.resize(static_cast<Eigen::Index>(start.fit.parameters.size()));
    for (std::size_t i = 0; i < start.fit.parameters.size(); ++i)
        start.fit.x[static_cast<Eigen::Index>(i)] =
            start.fit.parameters[i].to_fit(start.fit.parameters[i].start);
    calibrated_ = std::move(start);
    calibrated_.fit.objective = given_.fit.objective;
    finish(record_, calibrated_);
}

namespace detail {

/// CPU of fitting a model to the end and testing it, in first looks (measured on the practice logs).
inline constexpr double looks_of_a_fit = 3;

} // namespace detail

QUADRANT_DIAGNOSIS_DECL void search::begins(const progress& part, std::optional<double> rounds) const {
    tell_ = part;
    looks_ = 0;
    looks_of_a_round_ =
        static_cast<double>(suspects().size()) + detail::looks_of_a_fit * static_cast<double>(most_fitted());
    rounds_ = rounds;
}

QUADRANT_DIAGNOSIS_DECL void search::says(const std::string& line) const {
    const double done = looks_ / looks_of_a_round_;
    tell_(axis_.name + ": " + line, rounds_ ? done / std::max(*rounds_, done) : 1 - std::exp2(-done));
}

QUADRANT_DIAGNOSIS_DECL std::string search::names_of(std::span<const std::size_t> some,
                                                     const std::vector<candidate>& models) {
    std::string out;
    for (const std::size_t i : some) {
        const effect& added = *models[i].effects.back();
        (out += out.empty() ? "" : ", ") += added.label.empty() ? added.name : added.label;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> search::residual(const candidate& c) const {
    std::vector<double> out;
    residuals({c.fit.plant}, [&](std::size_t, std::vector<double> r) { out = std::move(r); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> search::held_out_residual(const candidate& c) const {
    if (c.leave.empty()) return residual(c);
    std::vector<plant_model> plants(folds, c.fit.plant);
    for (std::size_t f = 0; f < folds; ++f) fitter::put(plants[f], c.fit.parameters, c.leave[f]);
    std::vector<double> out(record_.position.size());
    residuals(plants, [&](std::size_t f, const std::vector<double>& r) {
        for (std::size_t k = 0; k < r.size(); ++k)
            if (fold_of(record_.segment[k]) == f) out[k] = r[k];
    });
    return out;
}

QUADRANT_DIAGNOSIS_DECL double search::held_out_force(const candidate& c) const {
    if (!*c.held_out_force) *c.held_out_force = rms(held_out_residual(c));
    return **c.held_out_force;
}

QUADRANT_DIAGNOSIS_DECL double search::force_without(const candidate& whole, const effect& e) const {
    candidate c;
    c.fit.plant = plant_without(whole, e);
    return rms(residual(c));
}

QUADRANT_DIAGNOSIS_DECL double search::force_of(const candidate& whole, const effect& e) const {
    std::array<std::vector<double>, 2> left;
    residuals({whole.fit.plant, plant_without(whole, e)},
              [&](std::size_t i, std::vector<double> r) { left[i] = std::move(r); });
    for (std::size_t k = 0; k < left[0].size(); ++k) left[1][k] -= left[0][k];
    return rms(left[1]);
}

QUADRANT_DIAGNOSIS_DECL bool search::is_calibrated(const parameter& p) const {
    plant_model there;
    return p.spread > 0 && std::any_of(calibrated_.fit.parameters.begin(), calibrated_.fit.parameters.end(),
                                       [&](const parameter& q) { return &q.of(there) == &p.of(there); });
}

QUADRANT_DIAGNOSIS_DECL plant_model search::plant_without(const candidate& whole, const effect& e) const {
    plant_model out = whole.fit.plant, described = given_.fit.plant;
    const auto values = e.read(out);
    for (const parameter& p : whole.fit.parameters)
        if (!is_calibrated(p) &&
            std::any_of(values.begin(), values.end(), [&](const key_value& v) { return v.key == p.key; }))
            p.of(out) = p.of(described);
    for (harmonics* h : {&out.ripple, &out.cogging, &out.cutting, &out.cyclic, &out.friction.along})
        if (!(h->period > 0)) h->count = 0;
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
search::with_each(const candidate& from, const std::vector<const effect*>& among) const {
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

QUADRANT_DIAGNOSIS_DECL candidate search::with(const candidate& from, const effect* added) const {
    return with_these(from, {added}).front();
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
search::with_these(const candidate& from, const std::vector<const effect*>& added, std::size_t most) const {
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
    for (std::size_t i : fresh) {
        says(describe(out[i]));
        tried_.push_back(out[i]);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL candidate search::with(const std::vector<const effect*>& effects) const {
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

QUADRANT_DIAGNOSIS_DECL candidate search::taken_off(const candidate& whole, const effect* own) const {
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

QUADRANT_DIAGNOSIS_DECL candidate search::without(const candidate& whole, const effect* own) const {
    return without_each(whole, {own}).front();
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate>
search::without_each(const candidate& whole, const std::vector<const effect*>& each) const {
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
search::exchanged(const candidate& whole, const effect* own, const std::vector<const effect*>& added) const {
    const candidate from = taken_off(whole, own);
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

QUADRANT_DIAGNOSIS_DECL bool search::is_calibration(const candidate& c, const effect* e) const {
    plant_model fitted = c.fit.plant;
    const auto values = e->read(fitted);
    for (const parameter& own : calibrated_.fit.parameters)
        if (!values.empty() && own.key == values.front().key && own.key != "presliding_length_m") {
            const double x = own.of(fitted);
            return x >= own.low && x <= own.high;
        }
    return false;
}

QUADRANT_DIAGNOSIS_DECL bool search::possible(const effect& e) const {
    // What is logged behind the amplifier has passed everything that acts on the command.
    if (axis_.actuator.command_is == command_origin::measured && e.joins == joint::command) return false;
    if (e.rotary_only && axis_.kind == axis_kind::linear) return false;
    if (e.of_described_friction && !axis_.plant.describes_friction()) return false;
    return axis_.drive.closes() ? beside_drive(e) : e.box != "drive";
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> search::suspects() const {
    std::vector<const effect*> out;
    const auto allowed = [&](const effect* e) { return !excluded_.contains(e->name) && possible(*e); };
    for (const effect* e : every_effect())
        if (e->starts && allowed(e)) out.push_back(e);
    std::copy_if(axis_.own_effects.begin(), axis_.own_effects.end(), std::back_inserter(out), allowed);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::with_excluded(const candidate& from) const {
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
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> search::forms() const {
    std::vector<const effect*> out(unlisted::curves.begin(), unlisted::curves.end());
    if (record_.observer.led) std::erase(out, &unlisted::by_command);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<const effect*> search::relatives(const candidate& before) const {
    std::vector<const effect*> out = suspects();
    if (rules_.near_rivals)
        std::erase_if(out, [&](const effect* e) {
            const candidate* there = tried(before, e);
            return there && !(there->total > before.total + rules_.margin);
        });
    return out;
}

QUADRANT_DIAGNOSIS_DECL double search::noise(const candidate& c) const {
    if (!*c.noise) {
        std::vector<double> innovation;
        record_.observer.run(c.fit.plant, innovation);
        *c.noise = position_noise(innovation, record_.score, record_.resolution);
    }
    return **c.noise;
}

QUADRANT_DIAGNOSIS_DECL double search::structure(const std::vector<double>& ms, const channel& c,
                                                 double sigma) const {
    double sum = 0;
    for (std::size_t b = 0; b < ms.size(); ++b) {
        const double limit = 4 * (c.of_noise(sigma) + c.of_rounding(record_.resolution, b));
        sum += 0.5 * c.nu * std::max(0.0, std::log(ms[b] / limit));
    }
    return sum;
}

QUADRANT_DIAGNOSIS_DECL double search::structure(const candidate& c, double sigma) const {
    double sum = 0;
    for (std::size_t i = 0; i < c.fit.ms.size(); ++i)
        sum += structure(c.fit.ms[i], record_.score.channels[i], sigma);
    return sum;
}

QUADRANT_DIAGNOSIS_DECL bool search::immaterial(const std::vector<double>& ms, const channel& c, double sigma,
                                                std::size_t i) const {
    return left_in(ms, c, sigma) < square(rules_.immaterial) * tolerance_cloud()[i];
}

QUADRANT_DIAGNOSIS_DECL bool search::within_tolerances(const std::vector<std::vector<double>>& ms,
                                                       const scoring& score, double sigma) const {
    for (std::size_t i = 0; i < std::min(ms.size(), tolerance_cloud().size()); ++i)
        if (!(left_in(ms[i], score.channels[i], sigma) < tolerance_cloud()[i])) return false;
    return true;
}

QUADRANT_DIAGNOSIS_DECL bool search::immaterial(const candidate& c) const {
    const double sigma = noise(c);
    for (std::size_t i = 0; i < c.fit.ms.size(); ++i)
        if (!immaterial(c.fit.ms[i], record_.score.channels[i], sigma, i)) return false;
    return true;
}

QUADRANT_DIAGNOSIS_DECL bool search::settled(const std::vector<std::vector<double>>& ms, const scoring& score,
                                             double sigma) const {
    for (std::size_t i = 0; i < ms.size(); ++i)
        if (structure(ms[i], score.channels[i], sigma) >= rules_.structure &&
            (i >= record_.score.channels.size() || !immaterial(ms[i], score.channels[i], sigma, i)))
            return false;
    return true;
}

QUADRANT_DIAGNOSIS_DECL double search::floor_force(double noise) const {
    if (!floor_of_noise_)
        floor_of_noise_ = residual_force_floor(axis_.plant.mass_kg, 1, record_.period, record_.bandwidth_Hz,
                                               record_.reaction);
    return std::hypot(noise * *floor_of_noise_, record_.command_noise);
}

QUADRANT_DIAGNOSIS_DECL bool search::at_noise(const candidate& c) const {
    // The innovations are free of the drift that a drive's integral makes of noise, the residual force is
    // not.
    const double most = record_.observer.drift_pole < 1 ? rules_.near_floor : 1.3;
    return structure(c, noise(c)) <= 0 && held_out_force(c) < most * floor_force(c);
}

QUADRANT_DIAGNOSIS_DECL bool search::near_its_laws(const candidate& c) const {
    // A path is fitted whole: a motion that alone shows a cause is not to be lost.
    const auto left = [&](const candidate& m) {
        return record_.closed() ? rms(residual(m)) : held_out_force(m);
    };
    const double taken = std::max(0.0, square(left(calibrated_)) - square(left(c)));
    const double laws = law_error * std::hypot(friction_level(c.fit.plant), std::sqrt(taken));
    return left(c) < std::hypot(rules_.near_floor * floor_force(c), laws);
}

QUADRANT_DIAGNOSIS_DECL const std::vector<double>& search::tolerance_cloud() const {
    if (!cloud_.empty()) return cloud_;
    std::mt19937_64 random(20080901);
    std::vector<plant_model> plants(21,
                                    calibrated_.fit.plant); // the first is the calibrated machine itself
    for (std::size_t j = 1; j < plants.size(); ++j)
        for (const auto& p : calibrated_.fit.parameters) {
            const double low = p.to_fit(p.low), high = p.to_fit(p.high);
            const double share = static_cast<double>(random() >> 11) * 0x1p-53;
            if (p.key != "presliding_length_m" && !is_of_record(p) && !is_of_feedback(p))
                p.of(plants[j]) = p.from_fit(low + share * (high - low));
        }
    std::vector<std::vector<double>> e(plants.size());
    record_.observer.run(plants, e);
    const auto& channels = record_.score.channels;
    std::vector<std::vector<double>> sizes(channels.size());
    for (std::size_t j = 1; j < e.size(); ++j) {
        for (std::size_t k = 0; k < e[j].size(); ++k) e[j][k] -= e.front()[k];
        for (std::size_t i = 0; i < channels.size(); ++i)
            sizes[i].push_back(square(rms(detail::seen(e[j], channels[i]))));
    }
    for (auto& of_channel : sizes) cloud_.push_back(quantile(of_channel, 0.95));
    return cloud_;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::run() const {
    candidate best = calibrated_;
    std::vector<candidate> beam{calibrated_};
    while (best.effects.size() < rules_.most_causes && !at_noise(best) && (best.effects.empty() || !over()) &&
           (best.effects.empty() || !near_floor(best) || !settled(best))) {
        std::vector<candidate> next;
        const auto add = [&](std::vector<candidate> some) {
            for (candidate& c : some)
                if (std::none_of(next.begin(), next.end(), [&](const auto& n) { return same(n, c); }))
                    next.push_back(std::move(c));
        };
        for (const candidate& from : beam) add(with_each(from));
        if (calibrate_again(best, next)) {
            beam.assign(1, best);
            continue;
        }
        const candidate* step = paying(next, best);
        if (best.effects.empty() && !over() &&
            !(step && (at_noise(*step) || (near_floor(*step) && settled(*step))))) {
            add(everyday());
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
        if (!best.effects.empty() || immaterial(best) || over()) break;
        // What two effects do to the force may cancel: then neither pays alone.
        const std::vector<candidate> single(
            next.begin(), next.begin() + static_cast<std::ptrdiff_t>(std::min(rules_.in_pairs, next.size())));
        next.clear();
        for (std::size_t i = 0; i < single.size() && !over(); ++i) {
            std::vector<const effect*> others;
            for (std::size_t j = i + 1; j < single.size(); ++j)
                if (!has(single[i], single[j].effects.back())) others.push_back(single[j].effects.back());
            add(with_these(single[i], others));
        }
        step = paying(next, best);
        if (!step || best.effects.size() + 2 > rules_.most_causes) break;
        best = *step;
        beam.assign(1, best);
    }
    cut_ = over();
    // What does not take the gap of the machine file as it stands down explains nothing, however well it
    // scores.
    if (!best.effects.empty() && !shrinks(best, given_)) best = calibrated_;
    return path_to(best);
}

QUADRANT_DIAGNOSIS_DECL plant_model search::nearest() const {
    const candidate* best = &calibrated_;
    const auto single = with_each(calibrated_);
    for (const candidate& c : single)
        if (c.total > best->total) best = &c;
    return best->fit.plant;
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::path_to(const candidate& best) const {
    std::vector<candidate> path{best};
    while (!path.back().effects.empty()) {
        const candidate& whole = path.back();
        candidate kept;
        kept.total = -std::numeric_limits<double>::infinity();
        for (candidate& c : without_each(whole, whole.effects))
            if (c.total > kept.total) kept = std::move(c);
        if (path.size() == 1 && !pays(whole, kept)) path.pop_back();
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

QUADRANT_DIAGNOSIS_DECL bool search::pays(const candidate& more, const candidate& less) const {
    for (const effect* e : more.effects)
        if (!has(less, e) && is_calibration(more, e)) return false;
    const double gain = more.total - less.total, so_far = std::max(0.0, less.total - calibrated_.total);
    const auto added = static_cast<double>(more.effects.size()) - static_cast<double>(less.effects.size());
    if (gain < std::max(1.0, added) * std::max(rules_.margin, rules_.relative_margin * so_far)) return false;
    if (record_.closed() && !differs_from_like_machines(less)) return false;
    // What calibration bends to hides some of what an effect takes off.
    return shrinks(more, less) || (record_.closed() && less.stops_at_a_tolerance() && shrinks(more, given_));
}

QUADRANT_DIAGNOSIS_DECL bool search::shrinks(const candidate& more, const candidate& less) const {
    if (record_.closed()) { // evaluated on its path; the forces of a gear that friction holds say little
        const double law = square(record_.score.channels.front().floor);
        const auto left = [&](const candidate& c) { return std::max(0.0, mean_of(c.fit.ms.front()) - law); };
        return left(more) < square(1 - rules_.least_shrink) * left(less);
    }
    const double floor = square(floor_force(more)), fall = square(1 - rules_.least_shrink);
    const auto left = [&](const candidate& c) { return std::max(0.0, square(held_out_force(c)) - floor); };
    if (left(more) < fall * left(less)) return true;
    if (left(more) > left(less) / fall) return false;
    const double sigma = noise(more);
    for (std::size_t i = 0; i < more.fit.ms.size(); ++i) {
        const double of_noise = record_.score.channels[i].of_noise(sigma);
        const auto above = [&](const candidate& c) { return std::max(0.0, mean_of(c.fit.ms[i]) - of_noise); };
        if (above(more) < square(1 - rules_.least_shrink_of_band) * above(less)) return true;
    }
    return shrinks_in_most_segments(more, less); // dear: asked last
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> search::energy_by_segment(const candidate& c) const {
    std::vector<double> out(record_.segments, 0.0);
    const auto left = held_out_residual(c);
    for (std::size_t k = 0; k < left.size(); ++k) out[record_.segment[k]] += square(left[k]);
    return out;
}

QUADRANT_DIAGNOSIS_DECL bool search::shrinks_in_most_segments(const candidate& more,
                                                              const candidate& less) const {
    if (record_.segments < least_segments) return false;
    std::vector<double> floor(record_.segments, 0.0);
    const double of_row = square(floor_force(more));
    for (const std::size_t segment : record_.segment) floor[segment] += of_row;
    const auto before = energy_by_segment(less), after = energy_by_segment(more);
    const auto above = [&](const std::vector<double>& energy, std::size_t i) {
        return std::max(0.0, energy[i] - floor[i]);
    };
    std::size_t falls = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        falls += above(after, i) < square(1 - rules_.least_shrink) * above(before, i);
    return 4 * falls >= 3 * record_.segments;
}

QUADRANT_DIAGNOSIS_DECL std::optional<std::size_t> search::odd_segment(const candidate& c) const {
    if (record_.closed() || record_.segments < least_segments) return {};
    const auto energy = energy_by_segment(c);
    const auto most = std::max_element(energy.begin(), energy.end());
    const double all = std::accumulate(energy.begin(), energy.end(), 0.0);
    if (!(*most > all / 2)) return {};
    return static_cast<std::size_t>(most - energy.begin());
}

QUADRANT_DIAGNOSIS_DECL double search::held_out_force_beside(const candidate& c, std::size_t segment) const {
    const auto energy = energy_by_segment(c);
    const auto rows = std::count(record_.segment.begin(), record_.segment.end(), segment);
    const double all = std::accumulate(energy.begin(), energy.end(), 0.0) - energy[segment];
    return std::sqrt(all / static_cast<double>(record_.segment.size() - static_cast<std::size_t>(rows)));
}

QUADRANT_DIAGNOSIS_DECL bool search::differs_from_like_machines(const candidate& c) const {
    // The 95th of 100 machines differs by two standard deviations.
    const candidate& before =
        c.effects.empty() && mean_of(given_.fit.ms.front()) > mean_of(c.fit.ms.front()) ? given_ : c;
    return mean_of(before.fit.ms.front()) > tolerance_cloud().front() / 4;
}

QUADRANT_DIAGNOSIS_DECL bool search::has(const candidate& c, const effect* e) {
    return std::find(c.effects.begin(), c.effects.end(), e) != c.effects.end();
}

QUADRANT_DIAGNOSIS_DECL bool search::same(const candidate& a, const candidate& b) {
    return a.effects.size() == b.effects.size() && has_all(a, b);
}

QUADRANT_DIAGNOSIS_DECL bool search::has_all(const candidate& c, const candidate& of) {
    return std::all_of(of.effects.begin(), of.effects.end(), [&](const effect* e) { return has(c, e); });
}

QUADRANT_DIAGNOSIS_DECL bool search::is_of_feedback(const parameter& p) const {
    const drive_kind kind = given_.fit.plant.drive.kind;
    return p.key.starts_with("drive.") && kind != drive_kind::position_servo;
}

QUADRANT_DIAGNOSIS_DECL double search::left_in(const std::vector<double>& ms, const channel& c, double sigma) {
    return mean_of(ms) - c.of_noise(sigma);
}

QUADRANT_DIAGNOSIS_DECL double search::friction_level(const plant_model& p) const {
    const auto& f = p.friction;
    if (!(f.load > 0)) return f.coulomb + f.excess;
    std::vector<double> transmitted(record_.position.size());
    for (std::size_t k = 0; k < transmitted.size(); ++k)
        transmitted[k] = p.force_constant * record_.command[k] - p.static_force(record_.position[k]);
    return f.coulomb + f.excess + f.load * rms(transmitted);
}

QUADRANT_DIAGNOSIS_DECL bool search::beside_drive(const effect& e) const {
    if (e.name == "force_constant" && is_force(axis_.command_unit)) return false; // the drive's gain
    if (e.joins != joint::command || e.box == "drive" || e.name == "actuator_lag") return true;
    return e.name == "actuator_saturation" && record_.observer.drive && record_.observer.drive->tapped();
}

QUADRANT_DIAGNOSIS_DECL void search::begin_at(candidate& c, plant_model known) {
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i) {
        const parameter& p = c.fit.parameters[i];
        c.fit.x[static_cast<Eigen::Index>(i)] =
            std::clamp(p.to_fit(p.of(known)), p.to_fit(p.low), p.to_fit(p.high));
    }
    fitter::put(c.fit.plant, c.fit.parameters, c.fit.x);
}

QUADRANT_DIAGNOSIS_DECL std::size_t search::effort() const {
    if (!record_.replayed()) return 1;
    const std::size_t affords =
        std::max<std::size_t>(1, rules_.rows_of_a_look / std::max<std::size_t>(1, record_.position.size()));
    // The valleys of a path are narrow: few steps from a start show little, but three times as many are enough.
    return record_.closed() ? std::min<std::size_t>(3, affords) : affords;
}

QUADRANT_DIAGNOSIS_DECL candidate search::as_described(candidate c) {
    for (std::size_t i = 0; i < c.fit.parameters.size(); ++i)
        if (const parameter& p = c.fit.parameters[i]; p.spread > 0 && !is_of_record(p))
            c.fit.x[static_cast<Eigen::Index>(i)] = p.expected;
    fitter::put(c.fit.plant, c.fit.parameters, c.fit.x);
    return c;
}

QUADRANT_DIAGNOSIS_DECL bool search::calibrate_again(candidate& best,
                                                     const std::vector<candidate>& next) const {
    if (best.effects.empty()) return false;
    const candidate* better = nullptr;
    for (const candidate& c : next)
        if (c.effects.size() == best.effects.size() + 1 && is_calibration(c, c.effects.back()) &&
            c.total > best.total + rules_.margin && (!better || c.total > better->total))
            better = &c;
    if (!better) return false;
    candidate again = best;
    begin_at(again, better->fit.plant);
    finish(record_, again);
    if (!(again.total > best.total + rules_.margin)) return false;
    for (candidate& known : tried_)
        if (same(known, again)) known = again;
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
    } else {
        tried_.push_back(again);
    }
    best = std::move(again);
    return true;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> search::residual_behind_drive(const candidate& c) const {
    std::vector<double> out;
    residuals(
        {c.fit.plant}, [&](std::size_t, std::vector<double> r) { out = std::move(r); }, true);
    return out;
}

QUADRANT_DIAGNOSIS_DECL double search::mean_of(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v;
    return x.empty() ? 0 : sum / static_cast<double>(x.size());
}

QUADRANT_DIAGNOSIS_DECL std::vector<candidate> search::everyday() const {
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
        if (!set.empty() && known != tried_.end()) with_these(*known, later);
    }
    std::vector<candidate> out;
    for (std::size_t set = 3; set < (std::size_t{1} << each.size()); ++set) {
        std::vector<const effect*> some;
        for (std::size_t i = 0; i < each.size(); ++i)
            if (set >> i & 1) some.push_back(each[i]);
        if (some.size() > 1) out.push_back(with(some));
    }
    std::erase_if(out, [](const candidate& c) { return !std::isfinite(c.total); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL const candidate* search::paying(std::vector<candidate>& next,
                                                        const candidate& best) const {
    const auto worth = [&](const candidate& c) {
        return c.total - rules_.margin * static_cast<double>(c.effects.size());
    };
    std::stable_sort(next.begin(), next.end(),
                     [&](const auto& a, const auto& b) { return worth(a) > worth(b); });
    const auto found = std::find_if(next.begin(), next.end(), [&](const auto& c) { return pays(c, best); });
    if (found == next.end()) return nullptr;
    const candidate* step = &*found;
    for (const candidate& c : next) // what a name adds to another that it holds must pay as one more name would
        if (holds(*step, c) && pays(c, best) &&
            step->total - c.total <
                std::max(rules_.margin, rules_.relative_margin * (c.total - calibrated_.total)))
            step = &c;
    return step;
}

QUADRANT_DIAGNOSIS_DECL bool search::holds(const candidate& more, const candidate& less) {
    if (more.effects.size() != less.effects.size()) return false;
    return std::any_of(more.effects.begin(), more.effects.end(), [&](const effect* whole) {
        return std::all_of(
                   less.effects.begin(), less.effects.end(),
                   [&](const effect* e) { return e->name == whole->holds || (e != whole && has(more, e)); }) &&
               !whole->holds.empty() && !has(less, whole);
    });
}

QUADRANT_DIAGNOSIS_DECL const fit_result* search::found_alone(const effect& e) const {
    if (record_.closed()) return nullptr; // a path is looked at from many starts
    for (const candidate& c : tried_)
        if (c.effects.size() == 1 && c.effects.front() == &e && pays(c, calibrated_)) return &c.fit;
    return nullptr;
}

QUADRANT_DIAGNOSIS_DECL candidate search::joined(const candidate& from, const effect* added) {
    candidate c{.effects = from.effects};
    c.effects.push_back(added);
    return c;
}

QUADRANT_DIAGNOSIS_DECL void search::sketch_each(const candidate& from, const std::vector<std::size_t>& which,
                                                 std::vector<candidate>& models, when_late how) const {
    if (which.empty()) return;
    const fitter fit(record_.observer, record_.score);
    std::vector<candidate> origins{from};
    if (record_.replayed() && from.stops_at_a_tolerance()) origins.push_back(as_described(from));
    std::vector<std::vector<double>> left, innovation;
    std::vector<shared_slopes> slopes;
    for (const candidate& origin : origins) {
        fit_result here = origin.fit;
        slopes.push_back(fit.slopes(here));
        left.push_back(residual_behind_drive(origin));
        innovation.push_back(std::move(here.innovation.rows));
    }
    const auto sketch = [&](std::span<const std::size_t> some) {
        const bool late = how == when_late::leave_out && over();
        for (const std::size_t i : some) {
            models[i].total = -std::numeric_limits<double>::infinity();
            models[i].missed = late;
        }
        if (late) return;
        std::vector<first_look> looks;
        std::vector<fit_course> courses;
        for (const std::size_t i : some)
            for (std::size_t j = 0; j < origins.size(); ++j) {
                const screening look{axis_.plant,          axis_.tolerance, record_,
                                     origins[j].fit.plant, left[j],         innovation[j]};
                looks.emplace_back(fit, origins[j], *models[i].effects.back(), look, slopes[j],
                                   rules_.first_look * static_cast<int>(std::min<std::size_t>(effort(), 4)),
                                   found_alone(*models[i].effects.back()));
                std::move(looks.back().courses().begin(), looks.back().courses().end(),
                          std::back_inserter(courses));
            }
        fit.run(std::span(courses));
        auto next = courses.begin();
        for (std::size_t j = 0; j < looks.size(); ++j) {
            for (fit_course& c : looks[j].courses()) c = std::move(*next++);
            fit_result best = looks[j].best();
            fit_result& kept = models[some[j / origins.size()]].fit;
            if (j % origins.size() == 0 || best.objective < kept.objective) kept = std::move(best);
        }
    };
    in_groups(which, 4, sketch, 1, models);
}

QUADRANT_DIAGNOSIS_DECL void search::finish_best(std::vector<std::size_t>& which, std::size_t most,
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
    in_groups(std::span(which).first(fitted), 4, fit, detail::looks_of_a_fit, models);
    in_groups(std::span(which).subspan(fitted), 1,
              [&](std::span<const std::size_t> one) { judge(record_, models[one[0]]); });
}

QUADRANT_DIAGNOSIS_DECL void search::finish_near(const std::vector<std::size_t>& which, std::size_t fitted,
                                                 const candidate& from, std::vector<candidate>& models) const {
    double most = 0; // gained by one of them
    for (const std::size_t i : which)
        if (std::isfinite(models[i].total)) most = std::max(most, models[i].total - from.total);
    if (!(most > rules_.margin)) return;
    std::vector<std::size_t> near;
    for (std::size_t j = std::min(fitted, which.size()); j < which.size(); ++j)
        if (models[which[j]].total - from.total > rules_.near_best * most) near.push_back(which[j]);
    const auto fit = [&](std::span<const std::size_t> some) {
        if (over()) return;
        std::vector<candidate*> each;
        for (const std::size_t i : some) each.push_back(&models[i]);
        finish(record_, each);
    };
    in_groups(near, 4, fit, detail::looks_of_a_fit, models);
}

QUADRANT_DIAGNOSIS_DECL void search::mend_from_parts(std::vector<candidate>& models,
                                                     const std::vector<std::size_t>& which,
                                                     const candidate& from) const {
    std::vector<std::pair<std::size_t, candidate>> again; // of which model
    for (const std::size_t i : which) {
        const candidate& c = models[i];
        if (!std::isfinite(c.total) || c.missed) continue;
        const candidate* part = nullptr;
        for (const candidate& t : tried_)
            if (t.effects.size() + 1 == c.effects.size() && has_all(c, t) && !same(t, from) &&
                t.total > c.total + rules_.margin && (!part || t.total > part->total))
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

QUADRANT_DIAGNOSIS_DECL const candidate* search::tried(const candidate& from, const effect* added) const {
    for (const candidate& c : tried_)
        if (c.effects.size() == from.effects.size() + 1 && has(c, added) && has_all(c, from)) return &c;
    return nullptr;
}

QUADRANT_DIAGNOSIS_DECL std::string search::describe(const candidate& c) const {
    std::string out;
    for (const effect* e : c.effects) (out += out.empty() ? "" : ", ") += e->label.empty() ? e->name : e->label;
    if (!std::isfinite(c.total)) return out += ": this record does not show it";
    return (out += ": gain ") += std::to_string(static_cast<long>(c.total - calibrated_.total));
}

} // namespace quadrant::inline v0::diagnosis
