// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller_floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace quadrant::inline v0::diagnosis {

/// By how many rows reference and command stand later in a log than the position; negative: earlier.
struct column_shift {
    int reference = 0, command = 0;
};

namespace detail {

/// A column read from other rows; `lost` are those that have none to read.
template <class Value>
void read_from(std::vector<Value>& column, int rows_later, std::vector<unsigned char>& lost) {
    const std::vector<Value> as_read = column;
    const auto last = static_cast<std::ptrdiff_t>(as_read.size()) - 1;
    for (std::ptrdiff_t k = 0; k <= last; ++k) {
        const std::ptrdiff_t from = std::clamp<std::ptrdiff_t>(k + rows_later, 0, last);
        column[static_cast<std::size_t>(k)] = as_read[static_cast<std::size_t>(from)];
        if (from != k + rows_later) lost[static_cast<std::size_t>(k)] = 1;
    }
}

} // namespace detail

/// A log whose reference and command are read as much earlier as they stand late. The rows at its ends that
/// have none are left out.
inline axis_log put_right(axis_log log, column_shift late) {
    log.left_out.resize(log.position.size());
    for (auto* column : {&log.reference, &log.reference_velocity, &log.reference_acceleration})
        detail::read_from(*column, late.reference, log.left_out);
    for (auto* column : {&log.command, &log.duty, &log.effort})
        detail::read_from(*column, late.command, log.left_out);
    return log;
}

/// The shift with which the described controller gives the logged command, to rounding, if it does not give
/// it on the log as read. A controller is arithmetic: with another key, or on other rows, it gives another
/// command.
/// Programs that sample a loop between its parts, and those that log a reference before it is used, write such
/// logs. Within two rows; from a quarter of the record on, before which a filter may not know its past.
/// `count`: of the encoder, where it is known [m].
inline std::optional<column_shift> shift_of_columns(const controller_description& described,
                                                    const actuator_description& actuator, const axis_log& log,
                                                    double period, double count) {
    constexpr int most = 2;
    const axis_log as_read = detail::as_controlled(log, count);
    const std::size_t rows = log.position.size(), block = std::max<std::size_t>(16, rows / 256);
    if (rows < 8 * block) return {};
    double left_as_read = 0;
    // How much is left, and whether it is rounding.
    const auto tried = [&](column_shift late) {
        const axis_log moved = late.reference || late.command ? put_right(as_read, late) : as_read;
        const detail::replay_box box(moved, actuator, period, rows / 4, block);
        const auto difference = box.difference(described, box.replay(described));
        const double left = rms(difference);
        if (!std::isfinite(left) || (left_as_read > 0 && left > 0.5 * left_as_read)) return false;
        left_as_read = left_as_read > 0 ? left_as_read : left;
        return detail::floor_of(described, box).explains(detail::block_ms(difference, 0, block));
    };
    if (tried({}) || !(left_as_read > 0)) return {};
    for (int sum = 1; sum <= 2 * most; ++sum) // the least shift that will do
        for (int reference = -most; reference <= most; ++reference)
            for (int command = -most; command <= most; ++command)
                if (std::abs(reference) + std::abs(command) == sum && tried({reference, command}))
                    return column_shift{reference, command};
    return {};
}

} // namespace quadrant::inline v0::diagnosis
