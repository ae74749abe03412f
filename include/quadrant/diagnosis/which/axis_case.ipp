// SPDX-License-Identifier: BSL-1.0
// Long: what is asked of one axis, one question after the other.
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL axis_case::axis_case(const axis_description& a, const axis_log& l,
                                             const axis_log* other, double period, const exclusions& excluded,
                                             const rules& r, const progress& tell, held_by how,
                                             const axis_case* before, std::optional<tap_reading> tap)
    : axis(a), log(l), holdout(other), limits(r), count(observed_count(l.position, l.position_step)),
      resolution(std::max({a.encoder.resolution_m, coarse() ? count : 0.0, l.position_step})),
      record(record_of(period, excluded, tell, how, before, tap)), models(record, a, excluded, r, tell) {
    // A velocity drive's controller commands set-points; no force shows how far a difference there moves the
    // axis. What was measured behind an amplifier is not what the controller asked for.
    if (axis.controller && log.has_reference && log.as_sampled && !axis.drive.closes() &&
        axis.actuator.command_is == command_origin::asked)
        controller = judge_controller(*axis.controller, axis.actuator, log, record,
                                      coarse() ? count : axis.encoder.resolution_m);
    if (controller && excluded.contains("added_command")) controller->added.reset();
    controller_unnamed =
        controller_differs() && !command_is_added() && excluded.contains("controller_mismatch");
    if (controller_unnamed) controller->mended = false;
    if (holdout)
        second = for_machine(in_pieces(prepare(*holdout, period, resolution, record.scale), motions_of_second),
                             axis, how, known_);
    count_unnamed = coarse() && excluded.contains("encoder_quantization");
    models.begins(tell.part(detail::share_of_record(how), 1));
    if (before && how == held_by::readings) models.take_over(before->models);
    follow(models.run());
    leave_out_what_the_holdout_denies();
    if (!tested_apart() || !record.replayed() || best().effects.empty()) return;
    const auto worth_of = [&](const candidate& m) { return worth(m); };
    if (auto more = models.most_worth(best(), least_score(), worth_of); !search::same(more, best()))
        follow(models.path_to(more));
}

QUADRANT_DIAGNOSIS_DECL void axis_case::leave_out_what_the_holdout_denies() {
    if (!tested_apart() || record.replayed()) return;
    const double machine = second_log(path.front()).force;
    while (best().effects.size() > 1 && second_log(best()).force > machine && !models.over()) {
        const auto each = models.without_each(best(), best().effects);
        const auto left = [this](const candidate& m) { return second_log(m).force; };
        const auto least =
            std::min_element(each.begin(), each.end(),
                             [&](const candidate& a, const candidate& b) { return left(a) < left(b); });
        if (!(left(*least) < machine)) return;
        denied_.push_back(best().effects[static_cast<std::size_t>(least - each.begin())]);
        follow(models.path_to(*least));
    }
}

QUADRANT_DIAGNOSIS_DECL axis_record axis_case::record_of(double period, const exclusions& excluded,
                                                         const progress& tell, held_by how,
                                                         const axis_case* before,
                                                         std::optional<tap_reading> tap) {
    const axis_record ready =
        in_pieces(prepare(log, period, resolution, scales_of(axis.plant, log, period, resolution)), motions);
    axis_record out = for_machine(ready, axis, how);
    const auto first = [&] {
        search s(out, axis, excluded, limits, tell);
        s.begins(tell.part(0, detail::share_of_record(how)), 1);
        return s;
    };
    if (how == held_by::motion && before) {
        known_.push_back(first().with(before->best().effects).fit.plant);
        for (const candidate& m : before->path) known_.push_back(m.fit.plant);
        if (forgets_within_the_response(before->best().fit.plant, out))
            if (const auto other = as_regressed_on_motion(out, log.kind, {axis, out.scale.give()}))
                known_.push_back(*other);
    } else if (how == held_by::loop) {
        known_.push_back(first().nearest());
    }
    if (!known_.empty()) out = for_machine(ready, axis, how, known_);
    out.tap = tap;
    return out;
}

QUADRANT_DIAGNOSIS_DECL void axis_case::follow(std::vector<candidate> way) {
    path = std::move(way);
    claims = path.size() - 1;
    noise = models.noise(best());
    const auto ms = detail::beside_own_noise(best().fit.ms, record, log, best().fit.plant);
    settled = models.settled(ms, noise) && (best().effects.empty() || models.near_its_laws(best()));
    excused = settled && !(models.immaterial(path.front()) && models.structure(best(), noise) > 0);
    if (tested_apart()) settled_on_second = second_log(best()).settled;
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::calibrated_within_tolerances() const {
    const candidate& m = path.front();
    if (m.stops_at_a_tolerance()) return false; // it would have left them
    if (!models.within_tolerances(m.fit.ms, record.score, models.tolerance_cloud(), noise)) return false;
    if (!tested_apart()) return true;
    fit_result there{.plant = restarted(m.fit.plant, *second), .x = Eigen::VectorXd(0)};
    fitter(second->observer, second->score).evaluate(there);
    return models.within_tolerances(there.ms, second->score, cloud_of_second(), noise);
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::within_its_laws(const axis_record& r,
                                                        const std::vector<plant_model>& plants) const {
    std::vector<std::vector<double>> e(plants.size());
    r.observer.run(plants, e);
    for (std::size_t k = 0; k < e[0].size(); ++k) e[2][k] -= e[0][k];
    for (const channel& c : r.score.channels) {
        const auto energy = [&](const std::vector<double>& x) {
            const double size = rms(detail::seen(x, c));
            return size * size;
        };
        const double law = energy(e[2]) + law_error * law_error * energy(e[1]);
        if (energy(e[0]) > c.of_noise(noise) + law) return false;
    }
    return true;
}

QUADRANT_DIAGNOSIS_DECL std::vector<plant_model>
axis_case::beside_stronger_friction(const plant_model& m) const {
    plant_model stronger = m;
    stronger.friction.coulomb *= 1 + law_error;
    stronger.friction.excess *= 1 + law_error;
    stronger.friction.load *= 1 + law_error;
    return {m, path.front().fit.plant, stronger};
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::within_its_laws() const {
    if (best().effects.empty() || record.closed() || !models.near_its_laws(best())) return false;
    auto plants = beside_stronger_friction(best().fit.plant);
    if (!settled && !within_its_laws(record, plants)) return false;
    if (!tested_apart() || settled_on_second) return true;
    for (plant_model& p : plants) p = restarted(p, *second);
    return within_its_laws(*second, plants);
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::within_its_laws_on_both(std::vector<plant_model> plants) const {
    if (!within_its_laws(record, plants)) return false;
    if (!tested_apart()) return true;
    for (plant_model& p : plants) p = restarted(p, *second);
    return within_its_laws(*second, plants);
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::calibrated_within_its_laws() const {
    return !record.closed() && models.near_its_laws(path.front()) &&
           within_its_laws_on_both(beside_stronger_friction(path.front().fit.plant));
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::is_error_of_its_law(const effect& e) const {
    if (!e.of_described_friction || best().effects.size() < 2 || record.closed()) return false;
    const candidate without = models.without(best(), &e);
    auto plants = beside_stronger_friction(without.fit.plant);
    plants[1] = plants[0]; // of friction's law alone: what the other causes are wrong by is no friction
    return models.near_its_laws(without) && within_its_laws_on_both(std::move(plants));
}

QUADRANT_DIAGNOSIS_DECL bool axis_case::claims_suffice() const {
    const candidate& m = applied();
    if (claims == 0 || !models.near_its_laws(m)) return false;
    if (models.settled(m)) return true;
    return !record.closed() && within_its_laws_on_both(beside_stronger_friction(m.fit.plant));
}

QUADRANT_DIAGNOSIS_DECL std::vector<double>
axis_case::left_along_motion(std::span<const plant_model> some) const {
    std::vector<double> out;
    if (!measured_motion_) measured_motion_ = motion_to_lead(record, plant_model(axis, record.scale.give()));
    const led_motion& by = *measured_motion_;
    // Every model leaves the noise of a measured command, which is known to a tenth.
    const double of_command = record.command_noise_below(record.observer.corner_Hz),
                 noise_energy = square(of_command) * by.share_that_counts();
    for (; !some.empty(); some = some.subspan(std::min(some.size(), predictor::abreast))) {
        const auto plants = some.first(std::min(some.size(), predictor::abreast));
        std::array<std::vector<double>, predictor::abreast> left;
        record.observer.forces_beside(by, plants, record.command, std::span(left).first(plants.size()));
        for (std::size_t i = 0; i < plants.size(); ++i)
            out.push_back(std::sqrt(std::max(square(rms(left[i])) - noise_energy, 0.2 * noise_energy)));
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double axis_case::left_along_motion(const candidate& m) const {
    if (!*m.along_motion) *m.along_motion = left_along_motion(std::span(&m.fit.plant, 1)).front();
    return **m.along_motion;
}

QUADRANT_DIAGNOSIS_DECL double axis_case::left_along_motion() const {
    return left_along_motion(best()) / left_along_motion(path.front());
}

QUADRANT_DIAGNOSIS_DECL double axis_case::takes_off(const candidate& to, const candidate& from) const {
    const auto energy = [&](const candidate& m) { return square(models.held_out_force(m)); };
    const double left = energy(from), floor = square(floor_force());
    return left > floor ? (left - energy(to)) / (left - floor) : 0;
}

QUADRANT_DIAGNOSIS_DECL axis_case::on_second axis_case::second_log(const candidate& m) const {
    if (!*m.holdout) {
        fit_result there{.plant = restarted(m.fit.plant, *second), .x = Eigen::VectorXd(0)};
        std::vector<double> a;
        const double choices = second->observer.run(there.plant, there.innovation.rows, &a);
        fitter(second->observer, second->score).judge(there, choices);
        *m.holdout = {-there.objective, std::move(there.ms),
                      rms_judged(*second, residual_of(*second, there.plant, a))};
    }
    const candidate::on_holdout& known = **m.holdout;
    const auto cloud = [&]() -> const std::vector<double>& { return cloud_of_second(); };
    return {known.score, models.settled(known.ms, second->score, noise, cloud), known.force};
}

QUADRANT_DIAGNOSIS_DECL const std::vector<double>& axis_case::cloud_of_second() const {
    if (cloud_of_second_.empty())
        cloud_of_second_ = models.tolerance_cloud(*second, restarted(path.front().fit.plant, *second));
    return cloud_of_second_;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double>
axis_case::scores_on_second(const std::vector<const candidate*>& some) const {
    std::vector<plant_model> plants;
    for (const candidate* m : some) plants.push_back(restarted(m->fit.plant, *second));
    auto out = fitter(second->observer, second->score).objectives(plants);
    for (double& score : out) score = -score;
    return out;
}

QUADRANT_DIAGNOSIS_DECL double axis_case::worth(const candidate& m) const {
    if (!tested_apart() || !record.replayed()) return m.total;
    // A replay scores no slow force: its integral drifts. What leaves more of the force is worth nothing.
    const auto left = [&](const candidate& x) {
        return square(models.held_out_force(x)) + square(second_log(x).force);
    };
    if (left(m) * square(1 - limits.least_shrink) > left(best()))
        return -std::numeric_limits<double>::infinity();
    return m.total + second_log(m).score;
}

QUADRANT_DIAGNOSIS_DECL double axis_case::least_score() const {
    return record.replayed() ? best().total - 5 * score_temperature : -std::numeric_limits<double>::infinity();
}

QUADRANT_DIAGNOSIS_DECL controller_description axis_case::mended() const {
    controller_description c = *axis.controller;
    if (controller->mended)
        for (const auto& key : detail::searched_keys(c))
            if (controller->key == key.key) key.of(c) = controller->value;
    return c;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_case::command_left(bool without_added) const {
    auto d = command_difference(log, mended());
    if (!command_is_added()) return d;
    std::vector<double> left = d;
    for (std::size_t k = 0; k < d.size(); ++k)
        left[k] += controller->added->waveform.values[k] * axis.plant.force_constant_N_per_V;
    const double constant = quantile(left, 0.5);
    if (without_added) d = std::move(left);
    for (double& x : d) x -= constant;
    return d;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double>
axis_case::command_difference(const axis_log& l, const controller_description& c) const {
    auto d = replay_controller(c, axis.actuator, record.period, loop_columns::of(l));
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = (d[k] - l.command[k]) * axis.plant.force_constant_N_per_V;
    return d;
}

} // namespace quadrant::inline v0::diagnosis
