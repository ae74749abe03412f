// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

namespace quadrant::inline v0::diagnosis::suspect {

/// Friction that gives way before it slips and remembers where it turned: elements in parallel, each a spring
/// with its share of the friction level (Maxwell-slip [Jamaludin2008] eq. 3.6-3.8; Dahl and LuGre have nearly
/// the same curve). Joins the force, in the friction box. Shows within some ten micrometres after each reversal
/// and in small motions. Every contact
/// gives way a little: ten times record_scales::give() is no cause.
inline constexpr effect presliding_friction{
    .name = "presliding_friction",
    .label = "presliding friction",
    .box = "mechanics",
    .joins = joint::friction,
    .exciting_motion = "sinusoids of 15 and 450 um at 0.1 to 1 Hz, where friction gives way before it slips",
    .of_described_friction = true,
    .shows = "hysteresis in the first ten micrometres after a reversal",
    .keys = {machine_key{.name = "presliding_length_m",
                         .rule = detail::rule::positive,
                         .meaning = "deflection at which friction has reached 1 - 1/e of its level; "
                                    "gms_weights say it more exactly and go before it",
                         .at = member<&plant_description::presliding_length_m>},
             machine_key{.name = "presliding_damping_s",
                         .rule = detail::rule::up_to_a_second,
                         .meaning = "damping of the contact before it slips, over its stiffness",
                         .at = member<&plant_description::presliding_damping_s>},
             machine_key{.name = "gms_weights",
                         .rule = detail::rule::positive,
                         .meaning = "shares of the friction level, one entry an element; they add up to 1",
                         .at = member<&plant_description::gms_weights>,
                         .needs = {"gms_stiffness_N_per_m"},
                         .shape = key_shape::elements},
             machine_key{.name = "gms_stiffness_N_per_m",
                         .rule = detail::rule::positive,
                         .meaning = "stiffness of each element",
                         .at = member<&plant_description::gms_stiffness_N_per_m>,
                         .needs = {"gms_weights"},
                         .entries_of = "gms_weights",
                         .shape = key_shape::elements},
             machine_key{.name = "gms_attraction_N_per_s",
                         .rule = detail::rule::positive,
                         .meaning = "how fast a slipping element reaches its limit; absent: at once",
                         .at = member<&plant_description::gms_attraction_N_per_s>,
                         .needs = {"gms_weights"}}},
    .fault = [](const axis_description& a) -> key_fault {
        const plant_description& p = a.plant;
        if (!p.coulomb_N && !p.static_N) {
            if (p.presliding_length_m)
                return {"presliding_length_m", "needs {}: the friction that gives way", "coulomb_N"};
            if (!p.gms_weights.empty())
                return {"gms_weights", "needs {}: the friction that gives way", "coulomb_N"};
        }
        const double sum = std::accumulate(p.gms_weights.begin(), p.gms_weights.end(), 0.0);
        if (!p.gms_weights.empty() && std::abs(sum - 1) > 1e-3)
            return {"gms_weights", "must add up to 1: shares of the friction level"};
        return {};
    },
    .prior = {0.4, "every contact gives way, but few logs reverse slowly enough to show by how much"},
    .compensation = "friction with its give (maxwell_slip)",
    .remedy = "Feed the friction forward with the give of the contact (maxwell_slip); it matters where circles "
              "change quadrant.",
    .trial = {.low = 3e-6,
              .high = 3e-4,
              .into = [](trial_machine& m) { m.set("presliding_length_m", m.amplitude); },
              .needs_coulomb = true},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        if (!(s.leader.friction.coulomb > 0)) return {};
        std::vector<std::vector<parameter>> out;
        const double give = s.record.scale.give();
        std::vector<double> lengths{15 * give, 50 * give, 200 * give};
        // A contact that is described gives way by that much; its law may be another.
        if (s.described.presliding_length_m) lengths.push_back(*s.described.presliding_length_m);
        for (const double length : lengths)
            out.push_back({{.key = "presliding_length_m",
                            .of = [](plant_model& p) -> double& { return p.friction.contact.length; },
                            .start = length,
                            .low = 5 * give,
                            .high = std::max(5e-3 * s.record.scale.travel, 500 * give),
                            .logarithmic = true,
                            .step = 1e-2},
                           {.key = "presliding_length_m",
                            .of = [](plant_model& p) -> double& { return p.friction.contact.spread; },
                            .start = 2.2,
                            .low = 1.05,
                            .high = 8,
                            .logarithmic = true,
                            .step = 1e-2},
                           {.key = "presliding_damping_s",
                            .of = [](plant_model& p) -> double& { return p.friction.contact.damping; },
                            .start = 0.4 * s.record.scale.response(),
                            .low = 0,
                            .high = 20 * s.record.scale.response(),
                            .step = 4e-3 * s.record.scale.response()}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        const auto& c = p.friction.contact;
        key_value weights{"gms_weights", {}}, stiffness{"gms_stiffness_N_per_m", {}};
        const auto lengths = c.lengths();
        for (std::size_t i = 0; i < c.elements; ++i) {
            weights.values.push_back(c.weights[i]);
            stiffness.values.push_back(c.weights[i] * (p.friction.coulomb + p.friction.excess) / lengths[i]);
        }
        return {{"presliding_length_m", {c.way_to_63_percent()}},
                {"presliding_damping_s", {c.damping}},
                weights,
                stiffness};
    },
    .join =
        [](plant_model& p, const screening&) {
            p.friction.contact.exponential(p.friction.contact.length);
            p.friction.contact.lengths_as_described = {};
        },
    // After a full turn a contact without memory of past reversals (Dahl, LuGre) follows exp(-x/l) where one
    // with memory follows exp(-x/2l): the same branch at twice the length. Where LuGre's bristle is damped it
    // looks stiffer: up to 2.8 times (tests/diagnosis/presliding_law.cpp).
    .by_another_law = 3};

} // namespace quadrant::inline v0::diagnosis::suspect
