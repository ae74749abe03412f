// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL bool axis_floors::is_calibration(const candidate& c, const effect* e) const {
    plant_model fitted = c.fit.plant;
    if (is_wave(*e)) return is_calibration_of_wave(fitted, *e);
    const auto values = e->read(fitted), described = e->read(given_.fit.plant);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string& key = values[i].key;
        const auto own = std::find_if(calibrated_.fit.parameters.begin(), calibrated_.fit.parameters.end(),
                                      [&](const parameter& p) { return p.key == key; });
        if (own != calibrated_.fit.parameters.end()) {
            const double x = own->of(fitted);
            if (key == "presliding_length_m" || !(x >= own->low && x <= own->high)) return false;
        } else if (i == 0 || (key.ends_with("_rad") && is_another_angle(values[i], described[i]))) {
            return false;
        }
    }
    return !values.empty();
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::is_another_angle(const key_value& found, const key_value& described) {
    const double off = std::remainder(found.values.front() - described.values.front(), 2 * std::numbers::pi);
    return std::abs(off) > tolerance_description::unstated;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::is_calibration_of_wave(plant_model& fitted, const effect& e) const {
    plant_model described = given_.fit.plant;
    bool any = false;
    // Inside its bounds, or as described where it has none.
    const auto stays = [&](double& (*of)(plant_model&)) {
        for (const parameter& own : calibrated_.fit.parameters)
            if (&own.of(fitted) == &of(fitted)) {
                any = true;
                return of(fitted) >= own.low && of(fitted) <= own.high;
            }
        return of(fitted) == of(described);
    };
    for (const machine_key& key : e.keys)
        if (!std::all_of(key.components.begin(), key.components.end(), stays)) return false;
    return any;
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::noise(const candidate& c) const {
    if (!*c.noise) {
        std::vector<double> innovation;
        record_.observer.run(c.fit.plant, innovation);
        *c.noise = position_noise(innovation, record_.score, record_.resolution);
    }
    return **c.noise;
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::structure(const std::vector<double>& ms, const channel& c,
                                                      double sigma) const {
    double sum = 0;
    for (std::size_t b = 0; b < ms.size(); ++b) {
        const double limit = 4 * (c.of_noise(sigma) + c.of_rounding(record_.resolution, b));
        sum += 0.5 * c.nu * std::max(0.0, std::log(ms[b] / limit));
    }
    return sum;
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::structure(const candidate& c, double sigma) const {
    double sum = 0;
    for (std::size_t i = 0; i < c.fit.ms.size(); ++i)
        sum += structure(c.fit.ms[i], record_.score.channels[i], sigma);
    return sum;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::immaterial(const std::vector<double>& ms, const channel& c,
                                                     double sigma, double cloud) const {
    return left_in(ms, c, sigma) < square(rules_.immaterial) * cloud;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::within_tolerances(const std::vector<std::vector<double>>& ms,
                                                            const scoring& score,
                                                            const std::vector<double>& cloud, double sigma) {
    for (std::size_t i = 0; i < ms.size(); ++i)
        if (!(left_in(ms[i], score.channels[i], sigma) < cloud[i])) return false;
    return true;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::immaterial(const candidate& c) const {
    const double sigma = noise(c);
    for (std::size_t i = 0; i < c.fit.ms.size(); ++i)
        if (!immaterial(c.fit.ms[i], record_.score.channels[i], sigma, tolerance_cloud()[i])) return false;
    return true;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::settled(const std::vector<std::vector<double>>& ms,
                                                  double sigma) const {
    return settled(ms, record_.score, sigma,
                   [this]() -> const std::vector<double>& { return tolerance_cloud(); });
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::floor_force(const candidate& c) const {
    return floor_force(c.fit.plant.moving_mass(), noise(c));
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::floor_force_of_described_mass(const candidate& c) const {
    return floor_force(record_.replayed() ? c.fit.plant.moving_mass() : given_.fit.plant.moving_mass(),
                       noise(c));
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::floor_force(double mass, double noise) const {
    if (!floors_) floors_ = force_floors(record_.period, record_.bandwidth_Hz, record_.reaction);
    return std::hypot((*floors_)(mass, noise), record_.command_noise);
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::at_noise(const candidate& c) const {
    // The innovations are free of the drift that a drive's integral makes of noise, the residual force is
    // not.
    const double most = record_.observer.drift_pole < 1 ? rules_.near_floor : 1.3;
    return structure(c, noise(c)) <= 0 && held_out_force(c) < most * floor_force(c);
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::near_its_laws(const candidate& c) const {
    // The readings show no more; what force a motor gave beside its friction is known less well than its path.
    if (record_.closed() && structure(c, noise(c)) < rules_.structure) return true;
    // A path is fitted whole: a motion that alone shows a cause is not to be lost.
    const auto left = [&](const candidate& m) {
        return record_.closed() ? rms(residual(m)) : held_out_force(m);
    };
    const double taken = std::max(0.0, square(left(calibrated_)) - square(left(c)));
    const double laws = law_error * std::hypot(friction_level(c.fit.plant), std::sqrt(taken));
    return left(c) < std::hypot(rules_.near_floor * floor_force(c), laws);
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_floors::tolerance_cloud(const axis_record& r,
                                                                         const plant_model& calibrated) const {
    return cloud_of_like_machines(r, calibrated, calibrated_.fit.parameters);
}

QUADRANT_DIAGNOSIS_DECL const std::vector<double>& axis_floors::tolerance_cloud() const {
    if (cloud_.empty()) cloud_ = tolerance_cloud(record_, calibrated_.fit.plant);
    return cloud_;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::pays(const candidate& more, const candidate& less) const {
    for (const effect* e : more.effects)
        if (!has(less, e) && is_calibration(more, e)) return false;
    const double gain = more.total - less.total, so_far = std::max(0.0, less.total - calibrated_.total);
    const auto added = static_cast<double>(more.effects.size()) - static_cast<double>(less.effects.size());
    if (gain < std::max(1.0, added) * std::max(rules_.margin, rules_.relative_margin * so_far)) return false;
    if (record_.closed() && !differs_from_like_machines(less)) return false;
    // What calibration bends to hides some of what an effect takes off.
    return shrinks(more, less) || (record_.closed() && less.stops_at_a_tolerance() && shrinks(more, given_));
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::shrinks(const candidate& more, const candidate& less) const {
    if (record_.closed()) { // evaluated on its path; the forces of a gear that friction holds say little
        const double law = square(record_.score.channels.front().floor);
        const auto left = [&](const candidate& c) { return std::max(0.0, mean_of(c.fit.ms.front()) - law); };
        if (left(more) < square(1 - rules_.least_shrink) * left(less)) return true;
        return left(more) <= left(less) && shrinks_behind_drive(more, less);
    }
    const double floor = square(floor_force(more)), fall = square(1 - rules_.least_shrink);
    const auto left = [&](const candidate& c) { return std::max(0.0, square(held_out_force(c)) - floor); };
    if (left(more) < fall * left(less)) return true;
    if (left(more) > left(less) / fall) return false;
    for (std::size_t i = 0; i < more.fit.ms.size(); ++i)
        if (shrinks_in(i, more, less)) return true;
    return shrinks_in_most_segments(more, less); // dear: asked last
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::shrinks_in(std::size_t channel, const candidate& more,
                                                     const candidate& less) const {
    const double sigma = noise(more);
    const auto left = [&](const candidate& c) {
        return std::max(0.0, left_in(c.fit.ms[channel], record_.score.channels[channel], sigma));
    };
    return left(more) < square(1 - rules_.least_shrink_of_band) * left(less);
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::shrinks_behind_drive(const candidate& more,
                                                               const candidate& less) const {
    const auto& channels = record_.score.channels;
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].of_tap && shrinks_in(i, more, less)) return true;
    return false;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::shrinks_in_most_segments(const candidate& more,
                                                                   const candidate& less) const {
    if (record_.segments < least_segments) return false;
    std::vector<double> floor(record_.segments, 0.0);
    const double of_row = square(floor_force(more));
    for (const std::size_t segment : record_.segment) floor[segment] += of_row;
    const auto before = energy_by_segment(less), after = energy_by_segment(more);
    const auto above = [&](const std::vector<double>& energy, std::size_t i) {
        return std::max(0.0, energy[i] - floor[i]);
    };
    std::size_t falls = 0, open = 0; // at rest nothing stands above the noise
    for (std::size_t i = 0; i < before.size(); ++i) {
        open += above(before, i) > 0;
        falls += above(after, i) < square(1 - rules_.least_shrink) * above(before, i);
    }
    return open >= least_segments && 4 * falls >= 3 * open;
}

QUADRANT_DIAGNOSIS_DECL bool axis_floors::differs_from_like_machines(const candidate& c) const {
    // What stops at an end of the tolerances would have left them.
    if (c.effects.empty() && c.stops_at_a_tolerance() && structure(c, noise(c)) >= rules_.structure)
        return true;
    // The 95th of 100 machines differs by two standard deviations.
    const candidate& before =
        c.effects.empty() && mean_of(given_.fit.ms.front()) > mean_of(c.fit.ms.front()) ? given_ : c;
    if (mean_of(before.fit.ms.front()) > tolerance_cloud().front() / 4) return true;
    const auto& channels = record_.score.channels; // the law of the drive is exact
    if (std::none_of(channels.begin(), channels.end(), [](const channel& x) { return x.of_tap; })) return false;
    if (cloud_of_fitted_.empty())
        cloud_of_fitted_ = cloud_of_fitted_machines(record_, calibrated_.fit.plant, calibrated_.fit.parameters);
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].of_tap && left_in(c.fit.ms[i], channels[i], noise(c)) > cloud_of_fitted_[i])
            return true;
    return false;
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::left_in(const std::vector<double>& ms, const channel& c,
                                                    double sigma) {
    return mean_of(ms) - c.of_noise(sigma);
}

QUADRANT_DIAGNOSIS_DECL double axis_floors::friction_level(const plant_model& p) const {
    const auto& f = p.friction;
    if (!(f.load > 0)) return f.coulomb + f.excess;
    std::vector<double> transmitted(record_.position.size());
    for (std::size_t k = 0; k < transmitted.size(); ++k)
        transmitted[k] = p.force_constant * record_.command[k] - p.static_force(record_.position[k]);
    return f.coulomb + f.excess + f.load * rms(transmitted);
}

} // namespace quadrant::inline v0::diagnosis
