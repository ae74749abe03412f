// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL tap_reading best_tap(const fitter& fit, const driven_motion& drive,
                                             plant_model described, const std::vector<parameter>& own,
                                             double band_Hz) {
    constexpr int steps = 6; // of a fit: the ways differ by more than its last digits
    tap_reading best = described.drive.read.tap;
    double least = std::numeric_limits<double>::infinity();
    for (const auto way :
         {tap_reading::before_set_point, tap_reading::after_set_point, tap_reading::row_mean}) {
        described.drive.read.tap = way;
        // Above the band the noise of the position decides, which is smaller on average over a row.
        auto size =
            zero_phase(drive.run(fit.fit(described, own, steps).plant.drive).beside, band_Hz, drive.period);
        for (double& e : size) e = std::abs(e);
        const double left = quantile(std::move(size), 0.5);
        if (left < least) best = way;
        least = std::min(least, left);
    }
    return best;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL axis_models::axis_models(const axis_record& record, const axis_description& axis,
                                                 const rules& r)
    : record_(record), axis_(axis), rules_(r) {
    given_.fit.plant = plant_model(axis, record.scale.give());
    given_.fit.plant.drive.read = record.read;
    given_.fit.parameters = {};
    given_.fit.x = Eigen::VectorXd(0);
    const fitter fit(record.observer, record.score);
    candidate start;
    start.fit.parameters = calibration(axis, record.scale.give(), record.taps_force(given_.fit.plant.drive));
    // In the unit of a score that counts in full. Described numbers lie nearer the middle of their tolerance
    // than its ends: a triangle, of half the variance.
    if (record.closed())
        for (parameter& p : start.fit.parameters) p.spread /= std::sqrt(2 * score_temperature);
    for (parameter& p : numbers_of_record(given_.fit.plant, record))
        start.fit.parameters.push_back(std::move(p));
    if (record.taps_force(given_.fit.plant.drive))
        given_.fit.plant.drive.read.tap = record.tap
                                              ? *record.tap
                                              : detail::best_tap(fit, *record.observer.drive, given_.fit.plant,
                                                                 start.fit.parameters, record.bandwidth_Hz);
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

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_models::residual(const candidate& c) const {
    std::vector<double> out;
    residuals({c.fit.plant}, [&](std::size_t, std::vector<double> r) { out = std::move(r); });
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_models::held_out_residual(const candidate& c) const {
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

QUADRANT_DIAGNOSIS_DECL double axis_models::held_out_force(const candidate& c) const {
    if (!*c.held_out_force) *c.held_out_force = rms_judged(record_, held_out_residual(c));
    return **c.held_out_force;
}

QUADRANT_DIAGNOSIS_DECL double axis_models::held_out_force_of_described_mass(const candidate& c) const {
    const double lighter = given_.fit.plant.moving_mass() / c.fit.plant.moving_mass();
    return held_out_force(c) * (record_.replayed() ? 1 : lighter); // what a drive makes otherwise is a force
}

QUADRANT_DIAGNOSIS_DECL double axis_models::force_without(const candidate& whole, const effect& e) const {
    candidate c;
    c.fit.plant = plant_without(whole, e);
    return rms(residual(c));
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_models::does(const candidate& whole, const effect& e) const {
    std::array<std::vector<double>, 2> left;
    residuals({whole.fit.plant, plant_without(whole, e)},
              [&](std::size_t i, std::vector<double> r) { left[i] = std::move(r); });
    for (std::size_t k = 0; k < left[0].size(); ++k) left[1][k] -= left[0][k];
    return left[1];
}

QUADRANT_DIAGNOSIS_DECL bool axis_models::is_calibrated(const parameter& p) const {
    plant_model there;
    return p.spread > 0 && std::any_of(calibrated_.fit.parameters.begin(), calibrated_.fit.parameters.end(),
                                       [&](const parameter& q) { return &q.of(there) == &p.of(there); });
}

QUADRANT_DIAGNOSIS_DECL plant_model axis_models::plant_without(const candidate& whole, const effect& e) const {
    plant_model out = whole.fit.plant, described = given_.fit.plant;
    const auto values = e.read(out);
    for (const parameter& p : whole.fit.parameters)
        if (!is_calibrated(p) &&
            std::any_of(values.begin(), values.end(), [&](const key_value& v) { return v.key == p.key; }))
            p.of(out) = p.of(described);
    if (out.drive.loss == described.drive.loss) out.drive.received = described.drive.received;
    for (harmonics* h : out.waves())
        if (!(h->period > 0)) h->count = 0;
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_models::energy_by_segment(const candidate& c) const {
    std::vector<double> out(record_.segments, 0.0);
    const auto left = held_out_residual(c);
    for (std::size_t k = 0; k < left.size(); ++k) out[record_.segment[k]] += square(left[k]);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::optional<std::size_t> axis_models::odd_segment(const candidate& c) const {
    if (record_.closed() || record_.segments < least_segments) return {};
    const auto energy = energy_by_segment(c);
    const auto most = std::max_element(energy.begin(), energy.end());
    const double all = std::accumulate(energy.begin(), energy.end(), 0.0);
    if (!(*most > all / 2)) return {};
    return static_cast<std::size_t>(most - energy.begin());
}

QUADRANT_DIAGNOSIS_DECL double axis_models::held_out_force_beside(const candidate& c,
                                                                  std::size_t segment) const {
    const auto energy = energy_by_segment(c);
    const auto rows = std::count(record_.segment.begin(), record_.segment.end(), segment);
    const double all = std::accumulate(energy.begin(), energy.end(), 0.0) - energy[segment];
    return std::sqrt(all / static_cast<double>(record_.segment.size() - static_cast<std::size_t>(rows)));
}

QUADRANT_DIAGNOSIS_DECL bool axis_models::has(const candidate& c, const effect* e) {
    return std::find(c.effects.begin(), c.effects.end(), e) != c.effects.end();
}

QUADRANT_DIAGNOSIS_DECL bool axis_models::same(const candidate& a, const candidate& b) {
    return a.effects.size() == b.effects.size() && has_all(a, b);
}

QUADRANT_DIAGNOSIS_DECL bool axis_models::has_all(const candidate& c, const candidate& of) {
    return std::all_of(of.effects.begin(), of.effects.end(), [&](const effect* e) { return has(c, e); });
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> axis_models::residual_behind_drive(const candidate& c) const {
    std::vector<double> out;
    residuals(
        {c.fit.plant}, [&](std::size_t, std::vector<double> r) { out = std::move(r); }, true);
    return out;
}

QUADRANT_DIAGNOSIS_DECL double axis_models::mean_of(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v;
    return x.empty() ? 0 : sum / static_cast<double>(x.size());
}

QUADRANT_DIAGNOSIS_DECL bool axis_models::holds(const candidate& more, const candidate& less) {
    if (more.effects.size() != less.effects.size()) return false;
    return std::any_of(more.effects.begin(), more.effects.end(), [&](const effect* whole) {
        return std::all_of(
                   less.effects.begin(), less.effects.end(),
                   [&](const effect* e) { return e->name == whole->holds || (e != whole && has(more, e)); }) &&
               !whole->holds.empty() && !has(less, whole);
    });
}

} // namespace quadrant::inline v0::diagnosis
