// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect.hpp"

#include <numeric>

namespace quadrant::inline v0::diagnosis::detail {

/// Play between two masses: on which side of it the encoder is, and what of mass and friction is on the
/// motor's.
class play_starts {
public:
    play_starts(const screening& s, double widest)
        : s_(s), widest_(widest), mass_(s.leader.moving_mass()),
          level_(std::max(0.0, s.leader.friction.coulomb)), stated_(s.leader.motor_mass < mass_) {}

    /// Some for either side of the encoder: the best of many looks. One is not enough: events that are late by
    /// less than a row hide the right one behind others.
    std::vector<std::vector<parameter>> take() const {
        std::vector<std::vector<parameter>> out;
        for (const bool behind : {false, true}) {
            if (const plant_model& p = s_.leader; behind ? p.backlash > 0 : p.backlash_behind > 0)
                continue; // the file says on which side of the encoder it is
            auto plants = ladder(width(behind));
            const auto looks = fitter(s_.record.observer, s_.record.score).objectives(plants);
            std::vector<std::size_t> order(plants.size());
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::stable_sort(order.begin(), order.end(),
                             [&](std::size_t a, std::size_t b) { return looks[a] < looks[b]; });
            order.resize(std::min<std::size_t>(3, order.size()));
            for (const std::size_t i : order) out.push_back(begun_at(plants[i], behind));
        }
        return out;
    }

private:
    using number = double& (*)(plant_model&);
    static number width(bool behind) {
        if (behind) return [](plant_model& p) -> double& { return p.backlash_behind; };
        return [](plant_model& p) -> double& { return p.backlash; };
    }
    std::vector<plant_model> ladder(number width_of) const {
        constexpr double rung = 1.7; // a step of this size in the width is still seen by the next one
        std::vector<plant_model> out;
        for (double w = 2 * s_.record.resolution; w < widest_; w *= rung)
            for (const double share : {0.2, 0.5})
                for (const double rubs : {0.05, 0.3}) {
                    plant_model p = s_.leader;
                    width_of(p) = w;
                    if (!stated_) p.motor_mass = share * mass_;
                    if (!(p.motor_coulomb < level_)) p.motor_coulomb = rubs * level_;
                    out.push_back(p);
                }
        return out;
    }
    std::vector<parameter> begun_at(plant_model& p, bool behind) const {
        // A load that friction holds tells the product of width and motor mass only. Drives are chosen so that
        // the load has one to five times the motor's inertia.
        constexpr double matched = 0.33;
        std::vector<parameter> out{{.key = behind ? "backlash_behind_m" : "backlash_m",
                                    .of = width(behind),
                                    .start = width(behind)(p),
                                    .low = s_.record.resolution,
                                    .high = widest_,
                                    .logarithmic = true,
                                    .step = 1e-2},
                                   {.key = "backlash_motor_mass_kg",
                                    .of = [](plant_model& q) -> double& { return q.motor_mass; },
                                    .start = std::clamp(p.motor_mass, 0.02 * mass_, 0.98 * mass_),
                                    .low = 0.02 * mass_,
                                    .high = 0.98 * mass_,
                                    .logarithmic = true,
                                    .step = 1e-2,
                                    .expected = std::log(stated_ ? s_.leader.motor_mass : matched * mass_),
                                    .spread = stated_ ? s_.tolerance.of("backlash_motor_mass") : 0.5}};
        if (level_ > 0)
            out.push_back({.key = "backlash_motor_coulomb_N",
                           .of = [](plant_model& q) -> double& { return q.motor_coulomb; },
                           .start = p.motor_coulomb,
                           .low = 0.01 * level_,
                           .high = level_,
                           .logarithmic = true,
                           .step = 1e-2});
        return out;
    }

    const screening& s_;
    double widest_, mass_, level_;
    bool stated_; ///< the machine file says what is on the motor's side
};

} // namespace quadrant::inline v0::diagnosis::detail

namespace quadrant::inline v0::diagnosis::suspect {

/// Play between the motor and what it moves. With the encoder on the load the reading stands still until the
/// motor has crossed it, or coasts on where the motor brakes; with the encoder on the motor a part of mass and
/// friction is missing there while it crosses. Joins the transmission. Shows at each reversal, and where a load
/// of little friction is braked. A direct drive cannot have it: name it in excluded_effects.
inline constexpr effect backlash{
    .name = "backlash",
    .label = "backlash",
    .box = "mechanics",
    .joins = joint::transmission,
    .exciting_motion = "slow reversals of 0.1 mm and more, with rest before each",
    .bends_calibration = true,
    .shows = "a reading that stands still at full command after a reversal",
    .keys = {machine_key{.name = "backlash_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "play between drive and encoder",
                         .at = member<&plant_description::backlash_m>,
                         .of = [](plant_model& p) -> double& { return p.backlash; },
                         .tolerance = true},
             machine_key{.name = "backlash_behind_m",
                         .rule = detail::rule::not_negative,
                         .meaning = "play between an encoder on the motor and the load",
                         .at = member<&plant_description::backlash_behind_m>,
                         .needs = {"backlash_motor_mass_kg"},
                         .of = [](plant_model& p) -> double& { return p.backlash_behind; },
                         .tolerance = true},
             machine_key{.name = "backlash_motor_mass_kg",
                         .rule = detail::rule::positive,
                         .meaning = "part of mass_kg on the motor's side of the play; absent: all of it",
                         .at = member<&plant_description::backlash_motor_mass_kg>,
                         .of = [](plant_model& p) -> double& { return p.motor_mass; },
                         .neutral = std::numeric_limits<double>::infinity(),
                         .tolerance = true},
             machine_key{.name = "backlash_motor_coulomb_N",
                         .rule = detail::rule::not_negative,
                         .meaning = "part of coulomb_N on the motor's side of the play; absent: all of it",
                         .at = member<&plant_description::backlash_motor_coulomb_N>,
                         .of = [](plant_model& p) -> double& { return p.motor_coulomb; },
                         .neutral = std::numeric_limits<double>::infinity(),
                         .tolerance = true}},
    .fault = [](const axis_description& a) -> key_fault {
        const plant_description& p = a.plant;
        if (p.backlash_m.value_or(0) > 0 && p.backlash_behind_m.value_or(0) > 0)
            return {"backlash_behind_m", "must be 0 beside {}: the encoder is on one side of the play",
                    "backlash_m"};
        if (p.backlash_motor_mass_kg && *p.backlash_motor_mass_kg >= p.mass_kg)
            return {"backlash_motor_mass_kg", "must lie below {}, of which it is a part", "mass_kg"};
        if (p.backlash_motor_mass_kg && p.mode_mass_kg)
            return {"backlash_motor_mass_kg", "is not simulated beside {}", "mode_mass_kg"};
        return {};
    },
    .prior = {0.4, "screws, gears and couplings wear; a direct drive cannot have it"},
    .remedy =
        "Preload the nut or the gear; an encoder on the load lets the loop see the play, but not remove it.",
    .advice =
        [](const plant_model& p, double, std::string_view) {
            if (p.backlash_behind > 0)
                return fmt::format("preload or a stiffer drive ({:.3g} um of play behind the encoder), or "
                                   "backlash_compensation on the set-point",
                                   1e6 * p.backlash_behind);
            return fmt::format(
                "preload or a stiffer drive ({:.3g} um of play): the encoder sits behind the play, "
                "so that the loop sees it already; backlash_compensation is for an encoder "
                "before it",
                1e6 * p.backlash);
        },
    .trial = {.low = 5e-7, .high = 5e-4, .into = [](trial_machine& m) { m.set("backlash_m", m.amplitude); }},
    .starts = [](const screening& s) -> std::vector<std::vector<parameter>> {
        double& (*const of)(plant_model&) = [](plant_model& p) -> double& { return p.backlash; };
        const double count = s.record.resolution, travel = s.record.scale.travel;
        std::vector<double> ladder;
        for (double share : {5e-6, 1.5e-5, 5e-5, 1.5e-4, 5e-4})
            ladder.push_back(std::max(share * travel, 2 * count));
        const double widest = std::max(5e-3 * travel, 40 * count);
        auto out = detail::play_starts(s, widest).take();
        if (!s.leader.play_has_masses())
            out.insert(out.begin(), {{.key = "backlash_m",
                                      .of = of,
                                      .start = detail::best_start(s, of, ladder),
                                      .low = count,
                                      .high = widest,
                                      .logarithmic = true,
                                      .step = 1e-2}});
        return out;
    },
    .read = [](const plant_model& p) -> std::vector<key_value> {
        std::vector<key_value> out{p.backlash_behind > 0 ? key_value{"backlash_behind_m", {p.backlash_behind}}
                                                         : key_value{"backlash_m", {p.backlash}}};
        if (std::isfinite(p.motor_mass)) out.push_back({"backlash_motor_mass_kg", {p.motor_mass}});
        if (std::isfinite(p.motor_coulomb)) out.push_back({"backlash_motor_coulomb_N", {p.motor_coulomb}});
        return out;
    }};

} // namespace quadrant::inline v0::diagnosis::suspect
