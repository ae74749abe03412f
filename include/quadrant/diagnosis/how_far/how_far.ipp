// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL void how_far::measure(axis_result& result, std::vector<cause>& causes) const {
    stage before = at(case_.models.given(), case_.axis.controller);
    result.gap = numbers(before);
    result.evaluated_on = case_.exchanged        ? "the log, fitted to the hold-out log"
                          : case_.tested_apart() ? "the hold-out log"
                          : case_.holdout        ? "the hold-out log, fitted as well"
                                                 : "held-out motion segments of the log";
    result.signals = {};
    result.signals.residual_before = before.force;
    if (before.loop) result.signals.simulated_position_before = before.loop->position;

    bool as_given = true;
    std::size_t plant_effects_added = 0;
    std::optional<controller_description> controller = case_.axis.controller;
    for (cause& c : causes) {
        const bool of_controller = c.effect == "controller_mismatch";
        if (c.effect == "encoder_quantization") {
            compare_rounding(c, before);
            continue;
        }
        if (c.waveform) { // of this log: the hold-out log may have another, or none
            const auto there = [&](const auto& x) {
                return segment_energy(x, case_.record.segment, case_.record.segments, case_.record.score.skip);
            };
            compare(c, there(case_.command_left(false)), there(case_.command_left()), case_.record.segments);
            continue;
        }
        if (of_controller)
            controller = case_.mended();
        else
            ++plant_effects_added;
        stage after = at(case_.path[plant_effects_added], controller);
        // A controller's gap is not behind the command: its force is what it commands otherwise than
        // logged.
        if (of_controller)
            compare(c, energy(case_.command_difference(log_, *case_.axis.controller)),
                    energy(case_.command_difference(log_, *controller)));
        else
            compare(c, energy(before.force), energy(after.force));
        if (before.loop && after.loop) compare(c, *before.loop, *after.loop);
        before = std::move(after);
        as_given = false;
    }
    if (as_given) before = at(case_.path.front(), controller); // calibration inside the tolerance alone
    result.gap_after = numbers(before);
    draw(result.signals, before);
    if (case_.command_is_added() && !case_.holdout)
        result.signals.command_added = case_.controller->added->waveform.values;
}

QUADRANT_DIAGNOSIS_DECL bool how_far::surely_shrinks(const candidate& from, const candidate& to) const {
    const segment_energy before = energy(force(from)), after = energy(force(to));
    const double floor = case_.floor_force(); // motions that show nothing speak for and against nothing
    const auto taken = [&](const auto& w) { return std::hypot(before.rms(w), floor) - after.rms(w); };
    const auto plainly = [&](const auto& w) { return before.rms(w) - after.rms(w); };
    const estimate shrinks = resampled(draws_, judged_.segments, plainly);
    // A gain over the motions whose interval reaches half as far below zero as above it is none, however far
    // above the floor.
    return resampled(draws_, judged_.segments, taken).low > 0 && shrinks.high > -2 * shrinks.low;
}

QUADRANT_DIAGNOSIS_DECL plant_model how_far::plant_of(const candidate& model) const {
    return case_.holdout ? restarted(model.fit.plant, judged_) : model.fit.plant;
}

QUADRANT_DIAGNOSIS_DECL how_far::stage
how_far::at(const candidate& model, const std::optional<controller_description>& controller) const {
    return {model.fit.plant.moving_mass(), force(model), loop(plant_of(model), controller)};
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> how_far::force(const candidate& model) const {
    if (!case_.holdout) return case_.models.held_out_residual(model);
    const plant_model plant = plant_of(model);
    std::vector<double> e, a;
    judged_.observer.run(plant, e, &a);
    return residual_of(judged_, plant, a);
}

QUADRANT_DIAGNOSIS_DECL std::optional<closed_loop_run>
how_far::loop(const plant_model& plant, const std::optional<controller_description>& controller) const {
    if (case_.axis.drive.closes()) {
        if (can_close(case_.axis, log_)) return simulate_driven(case_.axis, plant, judged_.period, log_);
    } else if (controller && log_.has_reference) {
        return simulate_closed_loop(*controller, case_.axis, plant, judged_.period, log_);
    }
    return {};
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> how_far::loop_errors() const {
    std::vector<double> out;
    if (case_.controller_open()) return out; // another controller ran
    std::optional<controller_description> controller;
    if (case_.axis.controller) controller = case_.mended();
    std::optional<closed_loop_run> calm; // what the machine does without a play
    for (const candidate& model : case_.path) {
        if (model.fit.plant.loss > 0 || model.fit.plant.drive.loss > 0) return {};
        auto run = loop(plant_of(model), controller);
        if (!run) return {};
        const std::vector<double> all(judged_.segments, 1.0);
        const bool chatters = model.fit.plant.has_play();
        const auto apart = [&](std::vector<double> closed_loop_run::*of, const std::vector<double>& logged) {
            const double by_row = energy(difference((*run).*of, logged)).rms(all);
            if (!chatters || !calm) return by_row;
            const auto &own = (*run).*of, &quiet = (*calm).*of;
            return std::min(by_row, apart_in_size(difference(own, quiet), difference(logged, quiet)));
        };
        const double way = apart(&closed_loop_run::position, log_.position);
        // A drive's command that was not recorded is what its described loops make of the motion: the motion
        // stands for both. So it does for a servo's duty: read at a moment of each row, while set-points arrive
        // in steps, it is not the row's mean, by more than a gain makes of it.
        const auto* const drive = judged_.observer.drive;
        const bool recorded =
            !drive || (drive->tapped() && case_.axis.drive.kind != drive_kind::position_servo);
        out.push_back(way * (recorded ? apart(&closed_loop_run::command, log_.command) : way));
        if (!calm && !chatters) calm = std::move(run);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL double how_far::apart_in_size(const std::vector<double>& a,
                                                      const std::vector<double>& b) const {
    const std::size_t block = std::max<std::size_t>(1, judged_.score.block);
    double sum = 0, rows = 0;
    for (std::size_t k = judged_.score.skip; k + block <= a.size(); k += block) {
        const auto size = [&](const std::vector<double>& x) { return rms(std::span(x).subspan(k, block)); };
        sum += square(size(a) - size(b)) * static_cast<double>(block);
        rows += static_cast<double>(block);
    }
    return rows > 0 ? std::sqrt(sum / rows) : std::numeric_limits<double>::infinity();
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> how_far::difference(const std::vector<double>& a,
                                                                const std::vector<double>& b) {
    std::vector<double> d(a.size());
    for (std::size_t k = 0; k < a.size(); ++k) d[k] = a[k] - b[k];
    return d;
}

QUADRANT_DIAGNOSIS_DECL segment_energy how_far::energy(const std::vector<double>& x) const {
    return {x, judged_.segment, judged_.segments, judged_.score.skip};
}

QUADRANT_DIAGNOSIS_DECL estimate how_far::interval(const segment_energy& e) const {
    return resampled(draws_, judged_.segments, [&](const auto& w) { return e.rms(w); });
}

QUADRANT_DIAGNOSIS_DECL void how_far::compare(cause& c, const segment_energy& before,
                                              const segment_energy& after) const {
    compare(c, before, after, judged_.segments);
}

QUADRANT_DIAGNOSIS_DECL void how_far::compare(cause& c, const segment_energy& before,
                                              const segment_energy& after, std::size_t segments) {
    const auto draws = segment_draws(segments);
    const auto interval = [&](auto of) { return resampled(draws, segments, of); };
    c.gap_before_force_rms_N = interval([&](const auto& w) { return before.rms(w); });
    c.gap_after_force_rms_N = interval([&](const auto& w) { return after.rms(w); });
    c.shrink = interval([&](const auto& w) {
        const double b = before.rms(w);
        return b > 0 ? 1 - after.rms(w) / b : 0;
    });
}

QUADRANT_DIAGNOSIS_DECL void how_far::compare(cause& c, const closed_loop_run& before,
                                              const closed_loop_run& after) const {
    c.gap_before_position_rms_m = interval(energy(difference(before.position, log_.position)));
    c.gap_after_position_rms_m = interval(energy(difference(after.position, log_.position)));
    c.gap_before_command_rms_V = interval(energy(difference(before.command, log_.command)));
    c.gap_after_command_rms_V = interval(energy(difference(after.command, log_.command)));
}

QUADRANT_DIAGNOSIS_DECL void how_far::compare_rounding(cause& c, const stage& s) const {
    const segment_energy now = energy(s.force);
    const std::vector<double> all(judged_.segments, 1.0);
    const double whole = square(now.rms(all));
    const double taken = square(rounding_force(case_, case_.count)) -
                         square(rounding_force(case_, case_.axis.encoder.resolution_m));
    const double share = whole > 0 ? std::clamp(1 - taken / whole, 0.0, 1.0) : 1;
    std::vector<double> left = s.force;
    for (double& f : left) f *= std::sqrt(share);
    compare(c, now, energy(left));
}

QUADRANT_DIAGNOSIS_DECL gap_numbers how_far::numbers(const stage& s) const {
    const std::vector<double> all(judged_.segments, 1.0);
    gap_numbers g;
    g.force_rms_N = energy(s.force).rms(all);
    g.noise_floor_force_rms_N = case_.models.floor_force(s.mass, case_.noise);
    g.bandwidth_Hz = judged_.bandwidth_Hz;
    if (s.loop) {
        const auto d = difference(s.loop->position, log_.position);
        g.position_rms_m = energy(d).rms(all);
        for (std::size_t k = judged_.score.skip; k < d.size(); ++k)
            g.position_peak_m = std::max(g.position_peak_m, std::abs(d[k]));
        g.command_rms_V = energy(difference(s.loop->command, log_.command)).rms(all);
    }
    return g;
}

QUADRANT_DIAGNOSIS_DECL void how_far::draw(axis_signals& s, const stage& after) const {
    for (std::size_t k = 0; k < log_.position.size(); ++k)
        s.t.push_back(static_cast<double>(k) * judged_.period);
    s.reference = log_.reference;
    s.position = log_.position;
    s.velocity = judged_.velocity;
    s.command = log_.command;
    s.residual_after = after.force;
    if (after.loop) {
        s.simulated_position_after = after.loop->position;
        if (case_.axis.controller && !case_.axis.drive.closes())
            s.command_replayed = replay_controller(*case_.axis.controller, case_.axis.actuator, judged_.period,
                                                   loop_columns::of(log_));
    }
    spectrum(s.residual_before, judged_.period, judged_.bandwidth_Hz, s.frequency_Hz, s.spectrum_before);
    spectrum(s.residual_after, judged_.period, judged_.bandwidth_Hz, s.frequency_Hz, s.spectrum_after);
}

QUADRANT_DIAGNOSIS_DECL void doubt_by_loop(std::span<cause> causes, const std::vector<double>& errors) {
    constexpr double clearly = 1.1;
    std::size_t claims = 0;
    for (std::size_t i = 0; i < causes.size(); ++i)
        if (claimed(causes[i])) claims = i + 1;
    if (claims == 0 || errors.empty()) return;
    const auto best =
        std::min_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(claims) + 1);
    if (errors[claims] > clearly * *best)
        detail::to_suspects(causes.subspan(static_cast<std::size_t>(best - errors.begin())));
}

} // namespace quadrant::inline v0::diagnosis
