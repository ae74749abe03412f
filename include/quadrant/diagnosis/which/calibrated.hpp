// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "axis_case.hpp"
#include "interval.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Whether a model has a wave, or a mean beside it.
inline bool is_there(plant_model& p, const effect& wave) {
    return std::any_of(wave.keys.begin(), wave.keys.end(), [&](const machine_key& k) {
        const auto acts = [&](auto of) { return of(p) != 0; };
        return std::any_of(k.components.begin(), k.components.end(), acts) ||
               (k.of && k.needs.front().empty() && acts(k.of));
    });
}

/// The described machine's own numbers as machine keys. Friction that gives way
/// a little is written as one element.
inline constexpr effect described_values{
    .name = "calibration",
    .box = "",
    .exciting_motion = "",
    .starts = nullptr,
    .read = [](const plant_model& p) -> std::vector<key_value> {
        const auto& f = p.friction;
        std::vector<key_value> out{{"mass_kg", {p.moving_mass()}},
                                   {"force_constant_N_per_V", {p.force_constant}},
                                   {"viscous_N_s_per_m", {f.viscous_slope}},
                                   {"delay_s", {p.delay}},
                                   {"coulomb_N", {f.coulomb}}};
        if (f.excess > 0) {
            out.push_back({"static_N", {f.coulomb + f.excess}});
            out.push_back({"stribeck_velocity_m_per_s", {f.stribeck_velocity}});
        }
        plant_model model = p;
        for (const effect* e : every_effect())
            if (is_wave(*e)) {
                if (is_there(model, *e))
                    for (key_value& v : e->read(model)) out.push_back(std::move(v));
            } else {
                for (const machine_key& key : e->keys)
                    if (key.of && key.tolerance && key.of(model) != key.neutral)
                        out.push_back({std::string(key.name), {key.of(model)}});
            }
        if (f.coulomb + f.excess > 0 && f.contact.elements == 1) {
            out.push_back({"gms_weights", {1}});
            out.push_back({"gms_stiffness_N_per_m", {(f.coulomb + f.excess) / f.contact.lengths()[0]}});
        }
        return out;
    }};

} // namespace detail

/// What a model of an axis has moved inside the owner's tolerance, as machine keys. A key that a cause gives is
/// that cause's; a value that the machine file does not describe stays undescribed, but for the give of its
/// friction.
QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> calibrated(const axis_case& c, const candidate& model,
                                                                   const std::vector<cause>& causes);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "calibrated.ipp"
#endif
