// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// How the missing friction grows with what the drive transmits: `slope` beside a level that stays, `share`
/// without one.
struct friction_over_load {
    double slope = 0, share = 0;
};
inline friction_over_load friction_over_load_in(const screening& s) {
    const double fast = 0.01 * s.record.scale.speed;
    double n = 0, sum = 0, force = 0, square = 0, product = 0;
    for (std::size_t k = s.record.score.skip; k < s.residual.size(); ++k) {
        const double v = s.record.velocity[k];
        if (!(std::abs(v) > fast)) continue;
        const double load = std::abs(s.leader.force_constant * s.record.command[k] -
                                     s.leader.static_force(s.record.position[k]));
        const double missing = v > 0 ? s.residual[k] : -s.residual[k];
        n += 1;
        sum += load;
        force += missing;
        square += load * load;
        product += load * missing;
    }
    const double spread = n * square - sum * sum;
    return {spread > 0 ? (n * product - sum * force) / spread : 0, square > 0 ? product / square : 0};
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// The Coulomb level grows by load_friction |motor - load|, what the drive carries between the motor and the
/// constant forces on its load (constant force, spring, gravity): teeth and nuts that are pressed together rub.
/// Joins the friction. Shows as a jump with the direction that is large where the motor pushes much.
inline constexpr effect load_friction{
    .name = "load_friction",
    .label = "friction that grows with the load",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "slow strokes in both directions under different loads: an arm level and hanging, a "
                       "spindle pushing and free",
    .shows = "a jump with the direction that grows with the motor's force",
    .keys = {machine_key{.name = "load_friction",
                         .rule = detail::rule::not_negative,
                         .meaning =
                             "the Coulomb level grows by this times the transmitted force, |motor - load|",
                         .at = member<&plant_description::load_friction>,
                         .of = [](plant_model& p) -> double& { return p.friction.load; },
                         .tolerance = true}},
    .prior = {0.2, "gears, worms and nuts have it; direct drives and belts hardly"},
    .remedy =
        "Feed a friction forward that grows with the commanded force; look at lubrication and alignment of "
        "the gear.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            return fmt::format("{:.3g} times the size of the commanded force, with the sign of the reference "
                               "velocity, in the command (not simulated here)",
                               p.friction.load);
        },
    .trial = {.low = 0.005, .high = 0.8, .into = [](trial_machine& m) { m.set("load_friction", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const auto found = detail::friction_over_load_in(s);
        std::vector<std::vector<parameter>> out;
        constexpr double most = 0.9; // what holds itself still under any load moves under none
        for (const double more : {found.slope, found.share}) {
            const double start = s.leader.friction.load + more;
            if (start > 0)
                out.push_back({{.key = "load_friction",
                                .of = [](plant_model& p) -> double& { return p.friction.load; },
                                .start = std::min(start, most),
                                .low = 0.01 * std::min(start, most),
                                .high = most,
                                .logarithmic = true,
                                .step = 1e-3}});
        }
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        return {{"load_friction", {p.friction.load}}};
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
