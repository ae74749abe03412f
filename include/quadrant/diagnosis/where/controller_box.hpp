// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../controller/kinds.hpp"
#include "../log/log.hpp"
#include "../log/signals.hpp"
#include "../machine/own_controller.hpp"

#include <span>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// A controller of the user's own, behind it the limit and the DAC that the machine file describes.
struct own_loop {
    running_loop loop;
    output_stage out;

    double step(double reference, double measured) { return out(loop(nullptr, reference, measured)); }
    void settle(const loop_start& row) { loop(&row, 0, 0); }
    bool remembers() const { return true; }
    bool limited() const { return false; }
    bool faulted() const { return false; }
};

} // namespace detail

/// The controller that is described, as new: of the machine file's kind, or the user's own.
QUADRANT_DIAGNOSIS_DECL std::unique_ptr<running_controller> made(const controller_description& c,
                                                                 const actuator_description& a, double period);

/// What a controller saw and did: columns of a log, of one length. Those that are empty are differences of the
/// positions.
struct loop_columns {
    std::span<const double> reference, position, command;
    std::span<const double> reference_velocity{}, reference_acceleration{}, velocity{};
    std::span<const unsigned char> left_out{}; ///< of every row, as axis_log::left_out; empty: none

    /// Some rows of them, as if all counted.
    loop_columns part(std::size_t first, std::size_t rows) const {
        const auto of = [&](std::span<const double> x) { return x.empty() ? x : x.subspan(first, rows); };
        return {.reference = of(reference),
                .position = of(position),
                .command = of(command),
                .reference_velocity = of(reference_velocity),
                .reference_acceleration = of(reference_acceleration),
                .velocity = of(velocity)};
    }
    static loop_columns of(const axis_log& log) {
        const auto& reads = log.controller_reads.empty() ? log.position : log.controller_reads;
        return {log.reference, reads,       log.command, log.reference_velocity, log.reference_acceleration,
                log.velocity,  log.left_out};
    }
    /// The rows from one on.
    loop_columns from(std::size_t row) const {
        const auto part = [&](std::span<const double> x) { return x.empty() ? x : x.subspan(row); };
        return {part(reference),
                part(position),
                part(command),
                part(reference_velocity),
                part(reference_acceleration),
                part(velocity)};
    }
};

/// Rows from one to before another through which a loop runs: between them are more than four rows that do not
/// count, of which nothing is known. None is shorter than eight rows. `left_out`: empty, or one a row.
QUADRANT_DIAGNOSIS_DECL std::vector<std::pair<std::size_t, std::size_t>>
stretches(std::span<const unsigned char> left_out, std::size_t rows);

/// The inputs of a controller row by row. Before row 0 both motions were even, as from row 0 to row 1.
class loop_inputs {
public:
    loop_inputs(const loop_columns& columns, double period) : c_(columns), period_(period) {}

    axis_motion<> asked(std::ptrdiff_t k) const {
        return {in_si(along(c_.reference, k)), in_si(reference_velocity(k)), in_si(reference_acceleration(k))};
    }
    /// The position that was read, and the velocity that was measured or follows from it.
    axis_measurement<> measured(std::ptrdiff_t k) const {
        const double v = c_.velocity.empty() ? difference(c_.position, k) : c_.velocity[row(k)];
        return {in_si(along(c_.position, k)), in_si(v)};
    }
    loop_start start(double command) const {
        return {.reference = c_.reference[0],
                .measured = c_.position[0],
                .reference_velocity = (c_.reference[1] - c_.reference[0]) / period_,
                .measured_velocity = (c_.position[1] - c_.position[0]) / period_,
                .command = command};
    }
    std::ptrdiff_t rows() const { return static_cast<std::ptrdiff_t>(c_.reference.size()); }

private:
    std::size_t row(std::ptrdiff_t k) const { return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, k)); }
    double along(std::span<const double> x, std::ptrdiff_t k) const {
        return k >= 0 ? x[row(k)] : x[0] + static_cast<double>(k) * (x[1] - x[0]);
    }
    double difference(std::span<const double> x, std::ptrdiff_t k) const {
        return k > 0 ? (x[row(k)] - x[row(k - 1)]) / period_ : (x[1] - x[0]) / period_;
    }
    double reference_velocity(std::ptrdiff_t k) const {
        return c_.reference_velocity.empty() ? difference(c_.reference, k) : c_.reference_velocity[row(k)];
    }
    double reference_acceleration(std::ptrdiff_t k) const {
        if (!c_.reference_acceleration.empty()) return k < 0 ? 0 : c_.reference_acceleration[row(k)];
        return k > 0 ? (reference_velocity(k) - reference_velocity(k - 1)) / period_ : 0;
    }

    loop_columns c_;
    double period_;
};

/// Puts a controller into the middle of a motion, as new: row 0 of a log is its past, and `command` is what it
/// gave there. One that has to run first is run through an even motion that ends at row 0, twice: the second
/// time with what the first missed.
QUADRANT_DIAGNOSIS_DECL std::unique_ptr<running_controller> begun(const running_controller& fresh,
                                                                  const loop_inputs& in, double command);

/// The controller box alone, one stretch of a record without gaps: fed the logged reference and position, it
/// puts out what the described controller would have commanded. Row 0 is taken from the log. What went before
/// it is unknown, at rest too: the noise of the encoder is in the first command by way of the velocity. What
/// that leaves open of the initial integral is a constant offset of the replay, which further passes take from
/// the record up to where the command reaches its limit, which the integral does not outlive: one pass, and up
/// to three more where two rows of a coarse encoder say a velocity that takes the integral to its limit. A law
/// that follows from what it applied is told so by the log. Rows that a controller is only shown, and those
/// whose look-ahead ends behind the log, are the logged ones.
QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_stretch(const controller_description& c,
                                                           const actuator_description& a, double period,
                                                           const loop_columns& log);

/// The controller box over a whole record: begun anew behind a gap, as at the start of a record. Rows that are
/// left out, those behind them in which the controller forgets what was filled in, and stretches too short to
/// begin in are the logged ones.
QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_controller(const controller_description& c,
                                                              const actuator_description& a, double period,
                                                              const loop_columns& log);
QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_controller(const controller_description& c,
                                                              const actuator_description& a, double period,
                                                              std::span<const double> reference,
                                                              std::span<const double> position,
                                                              std::span<const double> command);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "controller_box.ipp"
#endif
