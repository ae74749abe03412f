// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "apply.hpp"
#include "chain/position_compensation.hpp"
#include "compensate/advice.hpp"
#include "compensate/dead_band.hpp"
#include "compensate/tracking_forecast.hpp"
#include "compensate/velocity_drive_feedforward.hpp"
#include "fit/neighbour.hpp"
#include "fit/with_drives.hpp"
#include "match.hpp"

#include <array>
#include <random>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Whether one of an axis' compensations is against this effect.
inline bool paid(const compensated_axis& a, const std::string& effect) {
    return std::any_of(a.compensations.begin(), a.compensations.end(), [&](const compensation& c) {
        return std::find(c.effects.begin(), c.effects.end(), effect) != c.effects.end();
    });
}

/// A diagnosis with every fitted value elsewhere: place() says where, -1 and 1 at the ends of its interval.
/// Values are moved independently, since a diagnosis does not say how they go together.
template <class Place> diagnosis_result moved(diagnosis_result d, Place place) {
    const auto move = [&](std::vector<parameter_estimate>& parameters) {
        for (parameter_estimate& p : parameters) {
            const bool shares = p.key == "gms_weights", stiffness = p.key == "gms_stiffness_N_per_m";
            double sum = 0;
            for (estimate& e : p.values) {
                const double z = place(), was = e.value;
                e.value += z * std::max(0.0, z > 0 ? e.high - e.value : e.value - e.low);
                if (shares || stiffness) e.value = std::max(e.value, 0.1 * was);
                sum += e.value;
            }
            for (estimate& e : p.values)
                if (shares) e.value /= sum;
        }
    };
    for (cause& c : d.causes) move(c.parameters);
    for (axis_result& a : d.axes) move(a.calibrated);
    return d;
}

/// Machines of which the diagnosis may be: one drawn half of the intervals apart, the other at their ends.
struct drawn_machines {
    std::vector<machine_description> inside, at_ends;

    drawn_machines(const machine_description& machine, const diagnosis_result& d, double at_least) {
        constexpr std::size_t drawn = 16, ends = 8, tries = 20;
        std::mt19937_64 random(20080901);
        const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
        const auto normal = [&] { // a standard deviation is 1/1.96 of half an interval
            return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform()) / 1.96;
        };
        const auto end = [&] { return uniform() < 0.5 ? -1.0 : 1.0; };
        const auto fill = [&](std::vector<machine_description>& out, std::size_t count, auto place) {
            for (std::size_t i = 0; i < count * tries && out.size() < count; ++i) try {
                    out.push_back(apply(machine, moved(d, place), at_least));
                } catch (const bad_input&) { // values that no machine has: drawn again
                }
        };
        fill(inside, drawn, normal);
        fill(at_ends, ends, end);
    }
    /// Axis i of each: inside, at the ends.
    std::array<std::vector<const axis_description*>, 2> of_axis(std::size_t i) const {
        std::array<std::vector<const axis_description*>, 2> out;
        for (const auto& m : inside) out[0].push_back(&m.axes[i]);
        for (const auto& m : at_ends) out[1].push_back(&m.axes[i]);
        return out;
    }
};

/// Axis i, of which a log has positions only.
inline compensated_axis in_positions(const machine_description& machine, const diagnosis_result& d,
                                     const axis_description& axis, std::size_t i, const axis_log& log,
                                     const std::string& file, const drawn_machines& drawn, double at_least) {
    const auto [inside, at_ends] = drawn.of_axis(i);
    std::vector<std::string> effects;
    for (const cause& c : d.causes)
        if (c.axis == axis.name && c.probability >= at_least) effects.push_back(c.effect);
    compensated_axis out = chain::compensated_positions(machine.axes[i], axis, log, machine.sample_period_s,
                                                        file, inside, at_ends, effects);
    for (const std::string& effect : effects)
        if (!paid(out, effect)) out.others.push_back({effect, std::string(effect_named(effect)->remedy)});
    return out;
}

/// What compensates the causes on an axis, and what to do about the others.
inline void add_compensations(compensated_axis& a, const diagnosis_result& d, const axis_description& axis,
                              const tracking_forecast& forecast, const axis_log& coupled, double period,
                              double at_least) {
    std::vector<std::string> causes;
    for (const cause& c : d.causes) {
        if (c.axis != axis.name || c.probability < at_least) continue;
        if (axis.drive.closes()) {
            if (paid_by_drive(c.effect))
                causes.push_back(c.effect);
            else
                a.others.push_back({c.effect, std::string(effect_named(c.effect)->remedy)});
            continue;
        }
        const std::string text =
            advice_on(c.effect, forecast.plant(), axis.encoder.resolution_m, axis.command_unit);
        if (!text.empty())
            a.others.push_back({c.effect, text});
        else if (!c.parameters.empty())
            causes.push_back(c.effect);
    }
    const controller_description controller = axis.controller.value_or(controller_description());
    if (axis.drive.takes_position()) {
        a.compensations = for_position_drive(forecast.plant(), axis, period, causes);
    } else if (axis.drive.closes()) {
        if (axis.controller)
            a.compensations =
                for_velocity_drive(forecast.plant(), axis, period, coupled.drive->in_volts, causes);
    } else {
        compensations_of ways(forecast.plant(), controller, period, std::move(causes));
        a.compensations = ways.take();
        for (const std::string& effect : ways.without_key())
            a.others.push_back({effect, fmt::format("a feedforward, for which controller kind {} has no key",
                                                    controller.kind)});
    }
    if (axis.controller)
        if (auto quiet = with_dead_band(
                controller, a.compensations,
                least_dead_band(forecast.resolution(), forecast.noise(), forecast.plant().backlash)))
            a.compensations.push_back(std::move(*quiet));
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL compensation_result compensate(const machine_description& machine,
                                                       const diagnosis_result& d, const machine_log& as_read,
                                                       double at_least) {
    const machine_log log = with_drives(machine, as_read);
    constexpr double shortest_s = 0.5;
    const double seconds = static_cast<double>(log.samples) * machine.sample_period_s;
    if (seconds < shortest_s)
        throw bad_input(log.file, fmt::format("{} samples are {:.3g} s: a forecast needs at least {} s",
                                              log.samples, seconds, shortest_s));
    for (const axis_description& axis : machine.axes)
        if (axis.kind == axis_kind::rotary && !axis.drive.closes())
            throw bad_input(machine.file, fmt::format("axes.{}: is rotary; feedforwards are built for linear "
                                                      "axes only, and for drives that close loops of their own",
                                                      axis.name));
    const machine_description corrected = apply(machine, d, at_least);
    const detail::drawn_machines drawn(machine, d, at_least);
    compensation_result out{.machine_file = machine.file, .log_file = log.file, .axes = {}, .notes = {}};
    for (std::size_t i = 0; i < corrected.axes.size(); ++i) {
        const axis_description& axis = corrected.axes[i];
        const auto logged = std::find_if(log.axes.begin(), log.axes.end(),
                                         [&](const axis_log& l) { return l.name == axis.name && !l.still; });
        if (logged == log.axes.end()) continue;
        if (axis.positions_only) {
            out.axes.push_back(detail::in_positions(machine, d, axis, i, *logged, log.file, drawn, at_least));
            continue;
        }
        const axis_log coupled = detail::with_neighbour(log, *logged, machine.sample_period_s,
                                                        bandwidth_of(axis, *logged, machine.sample_period_s));
        const detail::tracking_forecast forecast(axis, coupled, machine.sample_period_s);
        compensated_axis& a = out.axes.emplace_back();
        a.name = axis.name;
        a.command_unit = axis.command_unit;
        a.kind = axis.kind;
        detail::add_compensations(a, d, axis, forecast, coupled, machine.sample_period_s, at_least);
        if (!logged->has_reference) {
            out.notes.push_back(fmt::format("axis {}: the log has no reference: nothing is forecast", a.name));
            continue;
        }
        if (!axis.controller && !axis.drive.takes_position()) {
            out.notes.push_back(
                fmt::format("axis {}: no controller is described: nothing is forecast", a.name));
            continue;
        }
        const auto [inside, at_ends] = drawn.of_axis(i);
        if (inside.empty()) throw bad_input(machine.file, "the intervals of the diagnosis hold no machine");
        forecast.run(a, inside, at_ends);
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
