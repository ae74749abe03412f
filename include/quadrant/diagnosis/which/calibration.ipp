// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<parameter> timing_of_readings(const drive_model& d, double period) {
    if (!d.reads_in_turn()) return {};
    const auto within_a_row = [&](const char* key, double& (*of)(plant_model&), double start) {
        return parameter{.key = key,
                         .of = of,
                         .start = start,
                         .low = -period,
                         .high = period,
                         .step = 0.05 * period,
                         .expected = 0,
                         .spread = period / std::numbers::sqrt3};
    };
    return {within_a_row(
                "reading_age", [](plant_model& p) -> double& { return p.drive.read.age; }, d.read.age),
            within_a_row(
                "tap_lateness", [](plant_model& p) -> double& { return p.drive.read.tap_lateness; },
                d.read.tap_lateness)};
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter> numbers_of_record(const plant_model& described,
                                                                 const axis_record& record) {
    std::vector<parameter> out;
    if (described.drive.has_integral())
        out.push_back(start_of_drive(described.force_constant * record.scale.command));
    if (record.observer.drive && record.observer.drive->tapped())
        for (parameter& p : timing_of_readings(described.drive, record.period)) out.push_back(std::move(p));
    return out;
}

namespace detail {

/// A number that moves by its tolerance, relative to its value; none where either is missing. One that is not
/// positive moves by sums, the others by ratios.
struct within_tolerance {
    std::vector<parameter>& out;
    void operator()(std::string_view key, double& (*of)(plant_model&), double value, double relative) const {
        if (value == 0 || !(relative > 0)) return;
        const double ratio = std::min(relative, 0.9);
        // Delay and gains of a drive's loops nearly stand for one another: what their slopes are wrong by must
        // be small beside what is left of them along that valley, or the fit stops where it reaches it.
        constexpr double of_loop = 1e-5;
        const double step = key.starts_with("drive.") ? of_loop : 1e-3, size = std::abs(value);
        const bool by_ratio = value > 0;
        out.push_back({.key = std::string(key),
                       .of = of,
                       .start = value,
                       .low = value - ratio * size,
                       .high = value + ratio * size,
                       .logarithmic = by_ratio,
                       .step = by_ratio ? step : step * size,
                       .expected = by_ratio ? std::log(value) : value,
                       // the standard deviation of a uniform inside the bounds
                       .spread = (by_ratio ? ratio : ratio * size) / std::numbers::sqrt3});
    }
};

/// The components of a wave, each by its own share: the size then stays inside its tolerance, and the phase
/// gives way as far as that lets it.
inline void add_wave(const within_tolerance& within, const machine_key& key, plant_model described,
                     double relative) {
    for (double& (*const of)(plant_model&) : key.components) within(key.name, of, of(described), relative);
}

/// Both levels of friction move inside their tolerances, and the excess between them by what either lets it.
inline void add_friction(std::vector<parameter>& out, const plant_description& d,
                         const tolerance_description& tolerance) {
    const within_tolerance within{out};
    const double coulomb = d.coulomb_N.value_or(0), excess = d.static_N ? *d.static_N - coulomb : 0;
    within(
        "coulomb_N", [](plant_model& p) -> double& { return p.friction.coulomb; }, coulomb,
        tolerance.of("coulomb"));
    if (!(excess > 0)) return;
    within(
        "static_N", [](plant_model& p) -> double& { return p.friction.excess; }, excess,
        tolerance.of("static") * *d.static_N / excess);
    if (out.empty() || out.back().key != "static_N") return;
    const double play = tolerance.of("static") * *d.static_N + tolerance.of("coulomb") * coulomb;
    out.back().low = std::max(0.01 * excess, excess - play);
    out.back().high = excess + play;
}

/// Each direction has its own level of friction inside the tolerance. Behind loops of a drive the log says too
/// little of it.
inline void add_directions(std::vector<parameter>& out, const axis_description& axis) {
    const plant_description& d = axis.plant;
    const double ratio = std::min(axis.tolerance.of("coulomb"), 0.9);
    if (axis.drive.closes() || !(d.coulomb_N.value_or(0) > 0) || !(ratio > 0) ||
        d.coulomb_asymmetry.value_or(0) != 0)
        return;
    out.push_back({.key = "coulomb_asymmetry",
                   .of = [](plant_model& p) -> double& { return p.friction.coulomb_asymmetry; },
                   .start = 0,
                   .low = -ratio,
                   .high = ratio,
                   .step = 1e-3, // of a level, as of the level itself
                   .expected = 0,
                   .spread = ratio / std::numbers::sqrt3});
}

/// What the drive gives was measured as a current, whose force is known to the force constant's tolerance only:
/// gains and limit of the drive's force, as that current shows them, move by it, too. A box of both tolerances,
/// with the variance of both.
inline void join_with_constant(std::vector<parameter>& out, const axis_description& axis) {
    const double constant = std::min(axis.tolerance.of("force_constant"), 0.9);
    if (!(constant > 0) || is_force(axis.command_unit)) return;
    for (parameter& p : out)
        if (p.key == "drive.velocity_gain_N_s_per_m" || p.key == "drive.velocity_integral_N_per_m") {
            p.low *= 1 - constant;
            p.high *= 1 + constant;
            p.spread = std::hypot(p.spread, constant / std::numbers::sqrt3);
        }
    if (axis.drive.force_limit_N)
        within_tolerance{out}(
            "drive.force_limit_N", [](plant_model& p) -> double& { return p.drive.force_limit; },
            *axis.drive.force_limit_N, constant);
}

/// Every contact gives way a little before it slips; up to ten times that it is no cause, nor is any
/// presliding displacement of a friction that is not described at all. One that is described as giving way
/// further, or element by element, stays as described.
inline void add_contact(std::vector<parameter>& out, const plant_description& d, double give) {
    const double most = (d.describes_friction() ? 10 : 500) * give;
    const friction_contact contact = plant_model(d, give).friction.contact;
    if (contact.elements == 1 && contact.length <= most)
        out.push_back({.key = "presliding_length_m",
                       .of = [](plant_model& p) -> double& { return p.friction.contact.length; },
                       .start = contact.length,
                       .low = std::min(0.05 * give, contact.length),
                       .high = most,
                       .logarithmic = true,
                       .step = 1e-2,
                       .expected = std::log(contact.length),
                       .spread = 1.5});
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::vector<parameter> calibration(const axis_description& axis, double give,
                                                           bool in_current) {
    const plant_description& d = axis.plant;
    const tolerance_description& tolerance = axis.tolerance;
    std::vector<parameter> out;
    const detail::within_tolerance within{out};
    within(
        "mass_kg", [](plant_model& p) -> double& { return p.mass; }, d.mass_kg, tolerance.of("mass"));
    within(
        "force_constant_N_per_V", [](plant_model& p) -> double& { return p.force_constant; },
        d.force_constant_N_per_V, tolerance.of("force_constant"));
    within(
        "viscous_N_s_per_m", [](plant_model& p) -> double& { return p.friction.viscous_slope; },
        d.viscous_N_s_per_m, tolerance.of("viscous"));
    within(
        "delay_s", [](plant_model& p) -> double& { return p.delay; }, d.delay_s, tolerance.of("delay"));
    detail::add_friction(out, d, tolerance);
    detail::add_directions(out, axis);
    within(
        "stribeck_velocity_m_per_s", [](plant_model& p) -> double& { return p.friction.stribeck_velocity; },
        d.stribeck_velocity_m_per_s.value_or(0), tolerance.of("stribeck_velocity"));
    const plant_model described(axis, give);
    for (const effect* e : every_effect())
        for (const machine_key& key : e->keys) {
            if (!key.tolerance) continue;
            const double relative = tolerance.of(std::string(key.tolerance_name()), key.unstated);
            detail::add_wave(within, key, described, relative);
            if (key.of)
                for (double value : numbers_of(axis, key, *e)) within(key.name, key.of, value, relative);
        }
    if (in_current) detail::join_with_constant(out, axis);
    detail::add_contact(out, d, give);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
