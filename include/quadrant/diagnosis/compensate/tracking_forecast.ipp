// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL tracking_forecast::tracking_forecast(const axis_description& axis, const axis_log& log,
                                                             double period)
    : axis_(axis), log_(log), period_(period) {
    const double count = observed_count(log.position, log.position_step);
    const double resolution = resolution_ = std::max({axis.encoder.resolution_m, log.position_step, count});
    const axis_record record =
        for_machine(prepare(log, period, resolution, scales_of(axis.plant, log, period, resolution)), axis);
    scale_ = record.scale;
    skip_ = record.score.skip;
    plant_ = restarted(plant_model(axis, scale_.give()), record);
    std::vector<double> innovation;
    record.observer.run(plant_, innovation);
    noise_ = position_noise(innovation, record.score, resolution);
    for (std::size_t k = 0; k < log.position.size(); ++k) error_.push_back(log.reference[k] - log.position[k]);
}

QUADRANT_DIAGNOSIS_DECL void tracking_forecast::run(compensated_axis& out,
                                                    const std::vector<const axis_description*>& inside,
                                                    const std::vector<const axis_description*>& at_ends) const {
    out.forecast = true;
    out.noise_m = noise_;
    const figures now = measure(error_, log_.command);
    const auto known = [](double x) { return estimate{x, x, x}; };
    out.measured = {known(now.rms), known(now.peak), known(now.glitch), known(now.command)};
    const auto before = loop(axis_, plant_, {}, {});
    std::vector<double> e(error_.size()), u(error_.size());
    for (std::size_t k = 0; k < e.size(); ++k) {
        e[k] = before.position[k] - log_.position[k];
        u[k] = before.command[k] - log_.command[k];
    }
    const figures missed = measure(e, u);
    out.missed_rms_m = missed.rms;

    const std::size_t plants = inside.size() + at_ends.size(), n = out.compensations.size();
    std::vector<std::vector<double>> added;
    for (const compensation& c : out.compensations)
        added.push_back(compensator(plant_, c.forces, period_)(log_.reference));
    std::vector<std::vector<figures>> after(n, std::vector<figures>(plants));
    on_all_cores(plants, 0, [&](std::size_t i) {
        const axis_description& axis = i < inside.size() ? *inside[i] : *at_ends[i - inside.size()];
        plant_model plant(axis, scale_.give());
        plant.cutting_start = plant_.cutting_start;
        plant.drive.start_force = plant_.drive.start_force;
        const auto bare = loop(axis, plant, {}, {});
        for (std::size_t c = 0; c < n; ++c)
            after[c][i] = changed(
                bare, loop(axis, plant, out.compensations[c].keys, added[c], out.compensations[c].drive));
    });
    for (std::size_t c = 0; c < n; ++c) {
        const figures as_found = changed(
            before, loop(axis_, plant_, out.compensations[c].keys, added[c], out.compensations[c].drive));
        summarise(out.compensations[c], now, missed, as_found, after[c], inside.size());
    }
}

QUADRANT_DIAGNOSIS_DECL closed_loop_run tracking_forecast::loop(axis_description axis, const plant_model& plant,
                                                                const std::vector<key_value>& keys,
                                                                const std::vector<double>& added,
                                                                const drive_addition& told) const {
    axis.encoder.resolution_m = 0;
    axis.actuator.dac_bits.reset();
    if (axis.controller) set_keys(*axis.controller, keys);
    if (axis.drive.closes()) {
        if (!told.set_point.any() && !told.force.any()) return simulate_driven(axis, plant, period_, log_);
        axis_log told_log = log_; // with the numbers of the plant that was found, on whatever machine
        driven_motion motion = *log_.drive;
        if (told.set_point.any()) {
            const auto shift = told.set_point.of(plant_, log_.reference, period_);
            for (std::size_t k = 0; k < shift.size(); ++k) motion.set_point[k] += shift[k];
        }
        if (told.force.any()) motion.added = told.force.of(plant_, log_.reference, period_);
        told_log.drive = std::make_shared<const driven_motion>(std::move(motion));
        return simulate_driven(axis, plant, period_, told_log);
    }
    return simulate_closed_loop(*axis.controller, axis, plant, period_, log_, {}, 4, added);
}

QUADRANT_DIAGNOSIS_DECL tracking_forecast::figures
tracking_forecast::changed(const closed_loop_run& bare, const closed_loop_run& with) const {
    std::vector<double> e(error_.size()), u(error_.size());
    for (std::size_t k = 0; k < e.size(); ++k) {
        e[k] = error_[k] + bare.position[k] - with.position[k];
        u[k] = log_.command[k] + with.command[k] - bare.command[k];
    }
    return measure(e, u);
}

QUADRANT_DIAGNOSIS_DECL tracking_forecast::figures
tracking_forecast::measure(const std::vector<double>& error, const std::vector<double>& command) const {
    figures out;
    std::vector<quantity_of<signal::position>> reference(error.size()), position(error.size());
    double e2 = 0, u2 = 0;
    for (std::size_t k = 0; k < error.size(); ++k) {
        reference[k] = quantity_of<signal::position>::from_value(log_.reference[k]);
        position[k] = quantity_of<signal::position>::from_value(log_.reference[k] - error[k]);
        if (k < skip_) continue;
        out.peak = std::max(out.peak, std::abs(error[k]));
        e2 += error[k] * error[k];
        u2 += command[k] * command[k];
    }
    const double rows = std::max(1.0, static_cast<double>(error.size()) - static_cast<double>(skip_));
    out.rms = std::sqrt(e2 / rows);
    out.command = std::sqrt(u2 / rows);
    const auto all =
        analysis::quadrant_glitches(reference, position, duration::from_value(period_),
                                    {.window = duration::from_value(std::max(2 * scale_.block(), period_)),
                                     .settle = duration::from_value(scale_.block())});
    for (const auto& g : all) out.glitch += std::abs(g.peak.value()) / static_cast<double>(all.size());
    return out;
}

QUADRANT_DIAGNOSIS_DECL void tracking_forecast::summarise(compensation& c, const figures& now,
                                                          const figures& missed, const figures& as_found,
                                                          const std::vector<figures>& after,
                                                          std::size_t inside) const {
    const auto over = [&](double figures::*of) {
        std::vector<double> x;
        for (std::size_t i = 0; i < inside; ++i) x.push_back(after[i].*of);
        return estimate{quantile(x, 0.5),
                        std::max(0.0, std::min(quantile(x, 0), as_found.*of) - 2 * missed.*of),
                        quantile(x, 1) + 2 * missed.*of};
    };
    c.after = {over(&figures::rms), over(&figures::peak), over(&figures::glitch), over(&figures::command)};
    const auto share = [&](double rms) { return now.rms > 0 ? 1 - rms / now.rms : 0; };
    c.gain = {share(c.after.rms_m.value), share(c.after.rms_m.high), share(c.after.rms_m.low)};
    double worst = c.after.rms_m.high;
    for (std::size_t i = inside; i < after.size(); ++i) worst = std::max(worst, after[i].rms + 2 * missed.rms);
    c.gain_at_ends = share(worst);
    c.claimed = now.rms - c.after.rms_m.high > noise_;
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
