// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../chain/diagnose_chain.hpp"
#include "../fit/both_motions.hpp"
#include "../fit/neighbour.hpp"
#include "../fit/turned_beam.hpp"
#include "../fit/with_drives.hpp"
#include "../log/thinned.hpp"
#include "../where/columns_in_time.hpp"
#include "../where/places.hpp"
#include "../which/between_rows.hpp"
#include "../which/looks.hpp"
#include "diagnose_axis.hpp"
#include "loop_witness.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Whether two encoders are recorded whose difference shows the transmission.
inline bool shows_transmission(const axis_description& axis, const axis_log& log) {
    return !log.motor.empty() && (axis.transmission != transmission_description{} || log.motor_unit == "rad");
}

/// How many rows of a long record are taken as one. A measured command is not replayed, and no cause lies
/// within a row of it: such a record needs no more rows than its time scale does. A described controller needs
/// its own period, in which the corrected loop is simulated.
inline std::size_t rows_in_one(const axis_description& axis, const axis_log& log, double period,
                               const rules& r) {
    if (axis.actuator.command_is != command_origin::measured || axis.controller || axis.drive.closes())
        return 1;
    const double corner = bandwidth_of(axis, log, period) / record_scales{.corner_Hz = 1}.bandwidth_Hz();
    return std::clamp<std::size_t>(log.position.size() / r.rows_of_a_look, 1,
                                   diagnosis::rows_in_one(corner, period));
}

/// Log and hold-out log as they were read, and with what a drive's columns say.
struct read_logs {
    read_logs(const machine_description& m, const machine_log& l, const machine_log* second)
        : machine(m), as_read(l), as_read_too(second), log(with_drives(m, l)) {
        if (second) with_drives_too = with_drives(m, *second);
    }
    const machine_log* holdout() const { return with_drives_too ? &*with_drives_too : nullptr; }

    const machine_description& machine;
    const machine_log& as_read;
    const machine_log* as_read_too;
    machine_log log;
    std::optional<machine_log> with_drives_too;
};

/// An axis and what of the logs its models are fitted to.
struct ready_axis {
    /// `by`: the axis as its two encoders are compared; as described where none is given.
    ready_axis(const axis_description& a, const axis_log& logged, const read_logs& logs, const rules& r,
               std::vector<std::string>& notes, const axis_description* by = nullptr);

    axis_description axis;
    double period;
    std::optional<chain::two_encoders> transmission{};
    axis_description rigid{}; ///< with the friction of both sides in one
    exclusions excluded{};
    stages stage{};
    axis_log log{};                    ///< that of the axis with its neighbour's motion
    std::optional<axis_log> holdout{}; ///< the same of the hold-out log
    other_axes others{};
    /// Whether the path is judged. A servo's law on duty is soft, and a force moves it where it shows. A stiff
    /// loop hides it from the path, and is replayed as long as there are rows enough.
    bool soft = false;
    std::optional<axis_log> both{}; ///< six seconds of a servo hold a dozen readings: none to spare for a test

private:
    void thin(double band, const rules& r, std::vector<std::string>& notes);
};

inline ready_axis::ready_axis(const axis_description& a, const axis_log& logged, const read_logs& logs,
                              const rules& r, std::vector<std::string>& notes, const axis_description* by)
    : axis(as_logged(a, logged)), period(logs.machine.sample_period_s) {
    if (axis.controller && !axis.drive.closes() && axis.actuator.command_is == command_origin::measured)
        notes.push_back(worded("axis %s: the command was measured behind the amplifier; what the controller "
                               "asked for is not in the log, and nothing is said of the controller.",
                               axis.name.c_str()));
    if (shows_transmission(axis, logged))
        transmission = chain::diagnose_transmission(by ? *by : axis, logged, period, logs.log.file,
                                                    logs.machine.excluded_effects, r);
    excluded.by_owner = logs.machine.excluded_effects;
    if (transmission) excluded.by_readings = {"backlash", "structural_resonance"}; // of the two encoders
    rigid = transmission ? transmission->rigid(axis) : axis;
    stage = stages_of(axis.actuator.command_is == command_origin::measured && !axis.drive.closes());
    const axis_log& at_motor = transmission ? transmission->carried : logged;
    for (std::string& note : told_by_turn(axis, at_motor, period)) notes.push_back(std::move(note));
    const double band = bandwidth_of(axis, at_motor, period);
    log = with_neighbour(logs.log, at_motor, period, band);
    const machine_log* const second = logs.holdout();
    if (const auto found = second ? named(second->axes, axis.name) : nullptr)
        holdout = with_neighbour(
            *second,
            transmission ? chain::carried_too(*transmission, axis, *found, period, second->file) : *found,
            period, band);
    for (const auto* axes : {&logs.log.axes, &logs.log.beside})
        for (const axis_log& each : *axes) others.logs.push_back(&each);
    put_columns_in_time(axis, period, log, holdout, notes);
    thin(band, r, notes);
    const bool servo = axis.drive.kind == drive_kind::position_servo;
    // Between two rows a replay has nothing to hold on to, and the path shows as much.
    const bool too_few_rows =
        axis.drive.kind == drive_kind::position && answers_between_rows(axis, at_motor, period);
    soft = at_motor.drive && (servo || too_few_rows);
    if (soft && servo && holdout && !transmission)
        both = both_motions(axis, *named(logs.as_read.axes, axis.name),
                            *named(logs.as_read_too->axes, axis.name), logs.machine.sample_period_s);
}

inline void ready_axis::thin(double band, const rules& r, std::vector<std::string>& notes) {
    const std::size_t n = rows_in_one(axis, log, period, r);
    if (n < 2) return;
    others.rows_in_one = n;
    notes.push_back(fmt::format("axis {}: {} samples of {:.4g} s are taken as one: the record is long, its "
                                "command is measured, and above {:.3g} Hz the noise of the position hides the "
                                "forces.",
                                axis.name, n, period, 0.6 * band));
    log = thinned(log, n);
    if (holdout) holdout = thinned(*holdout, n);
    period *= static_cast<double>(n);
}

/// An axis that was looked at, and what it was looked at with.
struct looked_axis {
    std::unique_ptr<ready_axis> ready;
    std::vector<std::string> notes{};
    std::unique_ptr<axis_case> found{};

    looked_axis(const axis_description& a, const axis_log& logged, const read_logs& logs, const rules& r,
                const axis_description* by = nullptr) {
        ready = std::make_unique<ready_axis>(a, logged, logs, r, notes, by);
    }
    void look(const read_logs& logs, const progress& tell, const rules& limits) {
        ready_axis& of = *ready;
        const auto look = [&](std::vector<std::string>& said, const axis_case* before) {
            return look_at({.axis = of.rigid,
                            .log = of.both ? *of.both : of.log,
                            .apart = of.log,
                            .holdout = of.holdout ? &*of.holdout : nullptr,
                            .both = of.both.has_value(),
                            .soft = of.soft,
                            .period = of.period,
                            .excluded = of.excluded,
                            .limits = limits,
                            .stage = of.stage,
                            .found = before},
                           logs.log.file, tell, said);
        };
        found = look(notes, nullptr);
        constexpr int most = 2; // names that are taken away
        if (found->best().effects.empty()) return;
        loop_witness loop(*found);
        for (int i = 0; i < most && !found->models.over(); ++i) {
            // What the owner excludes wrongly makes other names stand in for it, and is told beside them.
            if (!loop.against || excluded_instead_of(*found, loop.which).probability > 0.5) return;
            tell(fmt::format("axis {}: again, without {}", of.axis.name, label_of(*loop.against)));
            of.excluded.by_readings.emplace_back(loop.against->name);
            std::vector<std::string> said;
            const axis_record& r = found->record;
            const bool same_record = !r.observer.led && !r.closed() && !r.tap && !found->exchanged;
            auto other = look(said, same_record ? found.get() : nullptr);
            const auto left = [](const axis_case& c) { return c.models.held_out_force(c.best()); };
            const loop_witness of_other(*other);
            const bool stands = of_other.error < loop.error && left(*other) < left(*found);
            if (other->models.cut() || (!loop.surely && !stands)) {
                of.excluded.by_readings.pop_back();
                return;
            }
            notes.push_back(
                fmt::format("axis {}: {} would predict the readings, but the simulated loop does not "
                            "follow with it: looked at without it.",
                            of.axis.name, label_of(*loop.against)));
            notes.insert(notes.end(), said.begin(), said.end());
            found = std::move(other);
            loop = of_other;
        }
    }
    /// Causes between the two encoders whose size is that of the force.
    std::ptrdiff_t found_by_force() const {
        if (!ready->transmission) return 0;
        const auto& causes = ready->transmission->found.causes;
        return std::count_if(causes.begin(), causes.end(), [](const cause& c) {
            return c.effect == "wind_up" || c.effect == "motor_friction";
        });
    }
    /// The force constant that was found, where it is one.
    std::optional<double> force_constant() const {
        const auto& effects = found->best().effects;
        if (ready->axis.drive.closes() || std::none_of(effects.begin(), effects.end(), [](const effect* e) {
                return e->name == "force_constant";
            }))
            return {};
        return found->best().fit.plant.force_constant;
    }
};

} // namespace quadrant::inline v0::diagnosis::detail
