// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// A payload is a part of the described inertia and gravity. A hundredth is the rounding of numbers with two
/// digits.
inline key_fault payload_beyond_its_axis(const axis_description& a) {
    constexpr double rounding = 1.01;
    const plant_model p(a, 0);
    if (!a.payload.mass_kg) return {};
    if (p.payload.inertia() > rounding * p.mass)
        return {"payload.mass_kg",
                "makes a larger inertia, (mass_kg + link_mass_kg / 3) arm_m^2, than {}, of which it is "
                "a part",
                "mass_kg"};
    if (!p.turns_level && p.payload.gravity() > rounding * p.gravity.torque)
        return {"payload.mass_kg",
                "makes a larger torque, (mass_kg + link_mass_kg / 2) g arm_m, than {}, of which it is a "
                "part",
                "gravity_torque_Nm"};
    return {};
}
/// The keys that follow a payload: it is a part of both.
inline void add_what_payload_moves(std::vector<key_value>& keys, const plant_model& p) {
    keys.push_back({"mass_kg", {p.moving_mass()}});
    if (!p.turns_level) keys.push_back({"gravity_torque_Nm", {p.weight()}});
}
/// What to feed forward for the payload that was found.
inline std::string feedforwards_of_payload(const plant_model& p, double, std::string_view) {
    return fmt::format("feedforwards of acceleration and gravity that follow from the payload found: "
                       "{:.3g} kg m^2 and {:.3g} N m in all",
                       p.moving_mass(), p.weight());
}

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Another mass at the end of the arm than described. Moves the inertia by m l^2 and the gravity torque by m g
/// l together, which `mass` and `gravity` do one by one. Without `gravity_torque_Nm` the arm turns in a level
/// plane.
inline constexpr effect payload_mass{
    .name = "payload_mass",
    .label = "another payload",
    .box = "mechanics",
    .joins = joint::force,
    .exciting_motion = "strong accelerations beside slow strokes, hanging and level",
    .equivalent = {"arm_length", "gravity", "mass"},
    .shows = "a sine of the position and a part that follows the acceleration, in the ratio of the arm",
    .keys = {machine_key{
                 .name = "payload.mass_kg",
                 .rule = detail::rule::not_negative,
                 .meaning =
                     "at the end of the arm; part of inertia_kg_m2 and gravity_torque_Nm, not added to them",
                 .at = member<&payload_description::mass_kg>,
                 .needs = {"arm_m"},
                 .same_when_rotary = true},
             machine_key{
                 .name = "payload.link_mass_kg",
                 .rule = detail::rule::not_negative,
                 .meaning = "of the arm itself, spread along it; a third of it in the inertia, half in gravity",
                 .at = member<&payload_description::link_mass_kg>,
                 .needs = {"arm_m"},
                 .same_when_rotary = true}},
    .rotary_only = true,
    .fault = detail::payload_beyond_its_axis,
    .prior = {0.4, "tools and workpieces are changed more often than the file"},
    .remedy = "Weigh the payload and describe it; set the feedforward of gravity and acceleration to it.",
    .advice = detail::feedforwards_of_payload,
    .trial = {.low = 0.02,
              .high = 3,
              .into =
                  [](trial_machine& m) {
                      m.set("payload.mass_kg", m.changed(m.described("payload.mass_kg")));
                  }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        const arm_load& load = s.leader.payload;
        const double scale = load.mass + load.link_mass;
        if (!(scale > 0 && load.arm > 0)) return {};
        std::vector<std::vector<parameter>> out;
        for (const double start : {load.mass, 0.0}) // changed, or taken off
            out.push_back({{.key = "payload.mass_kg",
                            .of = [](plant_model& p) -> double& { return p.payload.mass; },
                            .start = start,
                            .low = 0,
                            .high = 10 * scale,
                            .step = 1e-3 * scale}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        std::vector<key_value> out{{"payload.mass_kg", {p.payload.mass}}};
        detail::add_what_payload_moves(out, p);
        return out;
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
