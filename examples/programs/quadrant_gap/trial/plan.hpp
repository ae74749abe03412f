// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effects.hpp"

#include <array>
#include <string>

/// Which machines a trial holds: kinds in fixed shares, effects in turn, so that a population of any size is
/// balanced.
namespace quadrant_gap::trial {

/// Which machines a trial draws: commanded in volts of force (the cascade of the machine file's format); with
/// drives that close loops of their own; with a second encoder on the motor; known by positions alone; or
/// joints of an arm, with gears and gravity.
enum class population {
    current,
    velocity_p,
    velocity_pi,
    position,
    position_servo,
    two_encoders,
    kinematic,
    joint
};
inline constexpr std::array<const char*, 8> populations{
    "current", "velocity_p", "velocity_pi", "position", "position_servo", "two_encoders", "kinematic", "joint"};
/// Whether its machines have two positions an axis.
constexpr bool is_chain(population p) { return p == population::two_encoders || p == population::kinematic; }
inline quadrant::diagnosis::drive_kind drive_of(population p) {
    using quadrant::diagnosis::drive_kind;
    constexpr std::array kinds{drive_kind::current,  drive_kind::velocity,       drive_kind::velocity,
                               drive_kind::position, drive_kind::position_servo, drive_kind::current,
                               drive_kind::current,  drive_kind::current};
    return kinds[static_cast<std::size_t>(p)];
}

/// Whether machines of this population are drawn with logs of this kind.
inline bool can_be_logged(population of, logs how) {
    if (how == logs::plain || of == population::current) return true;
    return how == logs::measured && drive_of(of) != quadrant::diagnosis::drive_kind::current;
}

enum class kind { none, single, pair, unknown, removed, poor };
constexpr const char* name_of(kind k) {
    switch (k) {
    case kind::none:
        return "none";
    case kind::single:
        return "single";
    case kind::pair:
        return "pair";
    case kind::unknown:
        return "unknown";
    case kind::removed:
        return "removed";
    default:
        return "poor_excitation";
    }
}

struct planned {
    kind what = kind::none;
    std::vector<std::string> effects{};
    bool two_axes = false, slow_only = false;
    population machines_of = population::current;
    logs how = logs::plain;
};

/// Names that one log can hardly distinguish: never both in one machine.
inline bool near_relatives(std::string_view a, std::string_view b) {
    static const std::vector<std::vector<std::string_view>> families{
        {"mass", "force_constant"},
        {"time_delay", "actuator_lag"},
        {"coulomb_friction", "stribeck_friction", "presliding_friction", "asymmetric_friction",
         "position_dependent_friction", "friction_drift", "load_friction"},
        {"constant_force", "asymmetric_friction", "position_spring"},
        {"drive_gain", "supply_voltage", "force_constant"},
        {"command_delay", "set_point_loss", "clock_slip"},
        {"minimum_duty", "coulomb_friction"},
        {"command_delay", "drive_gain"},
        {"gravity", "payload_mass", "arm_length", "constant_force"},
        {"mass", "payload_mass", "arm_length", "force_constant"},
        {"wind_up", "motor_friction"},
        {"coulomb_friction", "motor_friction"},
        {"cogging", "force_ripple", "encoder_cyclic_error", "position_dependent_friction"}};
    for (const auto& f : families)
        if (std::find(f.begin(), f.end(), a) != f.end() && std::find(f.begin(), f.end(), b) != f.end())
            return true;
    return a == b;
}

/// Names that are one model on any motion (docs/formats.md): with one of them out of the candidates the other
/// is no lie.
inline bool has_a_twin(std::string_view effect) {
    return effect == "mass" || effect == "force_constant" || effect == "constant_force" ||
           effect == "asymmetric_friction" || effect == "supply_voltage" || effect == "drive_gain" ||
           effect == "payload_mass" || effect == "arm_length" || effect == "gravity";
}

/// The effects that a population withholds, in the order of the list.
inline std::vector<const quadrant::diagnosis::effect*> withheld_from(population of, logs how = logs::plain) {
    if (of == population::joint) return effects_of_a_joint();
    if (!is_chain(of)) {
        auto out = withheld_effects(drive_of(of), how);
        if (of == population::velocity_pi && how != logs::measured) // shows_in_a_log(): where it began
            std::erase_if(out, [](const auto* e) { return e->name == "constant_force"; });
        return out;
    }
    const std::vector<std::string_view> gears{"lost_motion", "pitch_error", "scale_error", "travel_error",
                                              "encoder_cyclic_error"},
        forces{"wind_up", "motor_friction", "coulomb_friction", "viscous_friction", "mass", "constant_force"},
        drive{"command_delay", "drive_gain", "missed_steps"};
    const auto in = [](const auto& names, std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::vector<const quadrant::diagnosis::effect*> out;
    for (const auto* e : quadrant::diagnosis::every_effect())
        if (in(gears, e->name) || in(of == population::two_encoders ? forces : drive, e->name))
            out.push_back(e);
    return out;
}

/// Of every 20 machines: 6 without an effect (one with slow strokes only), 6 with one, 3 with two, 2 with
/// something that is in no list, 2 with an effect that the machine file excludes from the candidates, 1 with
/// slow strokes only. One in ten has two axes, and all with cross-coupling. Machines with two positions an axis
/// have one effect in place of slow strokes, and one axis.
inline std::vector<planned> plan(std::uint64_t seed, std::size_t machines, population of = population::current,
                                 logs how = logs::plain) {
    using enum kind;
    const auto withheld = withheld_from(of, how);
    dice random(seed, 1);
    std::vector<std::string> turn, slow_turn, removed_turn;
    const auto next = [&](std::vector<std::string>& bag, auto&& may) {
        if (bag.empty()) {
            for (const auto* e : withheld)
                if (may(*e)) bag.emplace_back(e->name);
            random.shuffle(bag);
        }
        std::string out = bag.back();
        bag.pop_back();
        return out;
    };
    std::vector<planned> out;
    while (out.size() < machines) {
        std::vector<kind> twenty{none,   none,   none, none, none, none,    single,  single,  single,  single,
                                 single, single, pair, pair, pair, unknown, unknown, removed, removed, poor};
        random.shuffle(twenty);
        bool slow_none = true;
        for (const kind drawn : twenty) {
            const kind k = drawn == poor && is_chain(of) ? single : drawn;
            planned p{k, {}, random.chance(0.1) && of == population::current, k == poor, of, how};
            if (k == none && slow_none && !is_chain(of)) slow_none = false, p.slow_only = true;
            if (k == single) p.effects = {next(turn, [](const auto&) { return true; })};
            if (k == poor) p.effects = {next(slow_turn, [](const auto& e) { return e.trial.slow_shows_it; })};
            if (k == removed)
                p.effects = {next(removed_turn, [](const auto& e) { return !has_a_twin(e.name); })};
            if (k == pair) {
                std::vector<std::string> all;
                for (const auto* e : withheld) all.emplace_back(e->name);
                p.effects = {random.one_of(all)};
                while (p.effects.size() < 2)
                    if (const std::string& other = random.one_of(all); !near_relatives(other, p.effects[0]))
                        p.effects.push_back(other);
            }
            if (std::find(p.effects.begin(), p.effects.end(), "cross_coupling") != p.effects.end())
                p.two_axes = true;
            out.push_back(std::move(p));
        }
    }
    out.resize(machines);
    return out;
}

} // namespace quadrant_gap::trial
