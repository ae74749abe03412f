// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// The described machine with the numbers that a regression on its motion has.
inline plant_model as_regressed(plant_model p, const axis_regression& by) {
    const auto force = [&](const regressed& x) { return x.value * p.force_constant; };
    p.mass = force(by.acceleration);
    p.friction.viscous_slope = std::max(0.0, force(by.speed));
    p.friction.coulomb = std::max(0.0, force(by.direction));
    p.friction.excess = p.friction.load = 0;
    p.constant_force = -force(by.mean);
    if (by.weight.sure()) p.gravity.torque = force(by.weight), p.gravity.phase = by.phase;
    return p;
}

/// A regression of a record's command on its motion.
inline axis_regression regress_on_motion(const axis_record& r, axis_kind kind) {
    axis_log log;
    log.position.assign(r.position.begin(), r.position.end());
    log.command.assign(r.command.begin(), r.command.end());
    log.kind = kind;
    return regress(log, r.period);
}

/// White noise of this force [N] where the command was measured, but for what moves the axis: no more than any
/// of these machines leaves. What a wrong machine leaves is no noise.
inline void add_command_noise(axis_record& r, const std::vector<plant_model>& machines, double force) {
    const plant_model& described = machines.front();
    r.command_noise = r.observer.drive ? 0 : force * white_noise_below(r.bandwidth_Hz, r.period);
    for (channel& c : r.score.channels)
        c.command_noise = c.of_tap ? tap_noise_in(c, force, described.drive, r.period, r.observer.pole())
                                   : command_noise_in(c, force, described.mass, r.period, r.observer.pole());
    predictor corrected = r.observer;
    corrected.led = nullptr;
    double share = 1;
    std::vector<double> e;
    for (const plant_model& machine : machines) {
        corrected.run(machine, e);
        share = std::min(
            share, share_added_by_measurement(e, r.score.channels, position_noise(e, r.score, r.resolution)));
    }
    share = std::sqrt(share);
    r.command_noise *= share;
    for (channel& c : r.score.channels) c.command_noise *= share;
}

/// The noise of what was measured of the force: of the command, or behind a drive.
inline void add_noise_of_measured(axis_record& r, const axis_description& a, const plant_model& described) {
    if (r.taps_force(described.drive))
        return add_command_noise(r, {described}, white_noise_in(r.observer.drive->measured, r.position));
    if (a.actuator.command_is != command_origin::measured || r.observer.drive) return;
    std::vector<plant_model> machines{described};
    if (auto other = as_regressed_on_motion(r, a.kind, described)) machines.push_back(*other);
    add_command_noise(r, machines, described.force_constant * white_noise_in(r.command, r.position));
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::optional<plant_model>
as_regressed_on_motion(const axis_record& r, axis_kind kind, const plant_model& described) {
    if (r.observer.drive) return {}; // its command is no force
    const axis_regression by = detail::regress_on_motion(r, kind);
    if (!by.acceleration.sure() || !(by.acceleration.value > 0)) return {};
    return detail::as_regressed(described, by);
}

QUADRANT_DIAGNOSIS_DECL axis_record for_machine(axis_record r, const axis_description& a, held_by how,
                                                std::span<const plant_model> known) {
    const plant_model described(a, r.scale.give());
    if (how == held_by::motion) r.observer.led = motion_to_lead(r, described);
    r.observer.substeps = substeps_of(described, r.period);
    if (how == held_by::loop) r.observer.closed = r.velocity[0];
    if (r.observer.drive && r.observer.drive->tapped()) r.read = r.observer.drive->timing(described.drive);
    if (r.observer.drive) r.reaction = reaction_to_reading(described, *r.observer.drive);
    if (r.observer.drive && !r.observer.drive->tapped()) {
        r.observer.drift_pole = drift_pole_of(described, r.period);
        auto e = detail::innovation_of(r.reaction, described.mass, r.period, r.observer.pole());
        if (r.observer.drift_pole < 1) predictor::take_drift_out(e, r.observer.drift_pole);
        for (channel& c : r.score.channels) {
            const bool slow = 5 * c.mean > r.score.block;
            detail::set_gains(c, e);
            if (!slow) c.rounding = std::max(1.0, c.noise_gain);
            c.floor = (c.mean == 1 ? 0.4 : 0.2) * r.resolution * c.rounding;
        }
    }
    detail::add_noise_of_measured(r, a, described);
    if (how == held_by::loop) judge_path(r, described, known.empty() ? described : known.front());
    if (how == held_by::motion && !known.empty()) judge_beside_what_is_left(r, known);
    return r;
}

} // namespace quadrant::inline v0::diagnosis
