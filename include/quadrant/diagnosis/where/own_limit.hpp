// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller_floor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quadrant::inline v0::diagnosis::detail {

/// A log without the rows in which the command stands at the controller's own limit: a replay begins anew
/// behind them. What a controller does with its integral there is its own affair, and no file says it.
struct within_limit {
    axis_log log;
    double from = 0; ///< when the limit is reached for the first time [s]
};

/// Nothing where the command is never at its limit, or half of the record is.
inline std::optional<within_limit> without_limit(const axis_log& log, const actuator_description& a,
                                                 double period) {
    constexpr std::size_t behind = 5; // rows: more than a replay bridges
    const double limit = stage_of(a).limit;
    if (!std::isfinite(limit)) return {};
    within_limit out{.log = log, .from = -1};
    out.log.left_out.resize(log.command.size());
    std::size_t since = behind, gone = 0;
    for (std::size_t k = 0; k < log.command.size(); ++k) {
        const bool there = std::abs(log.command[k]) >= limit * (1 - 1e-6) - log.command_step;
        if (there && out.from < 0) out.from = static_cast<double>(k) * period;
        since = there ? 0 : since + 1;
        if (since < behind) out.log.left_out[k] = 1;
        gone += out.log.left_out[k];
    }
    if (out.from < 0 || 2 * gone > log.command.size()) return {};
    return out;
}

/// When the limit is first reached [s], where the described controller gives the log's command but for what it
/// does there; else nothing.
inline std::optional<double> limit_of_another_law(const controller_description& c, const replay_box& box,
                                                  const axis_record& record) {
    const auto inside = without_limit(box.log(), box.actuator(), box.period());
    if (!inside || !made(c, box.actuator(), box.period())->remembers()) return {};
    replay_box other(inside->log, box.actuator(), record);
    other.skip_to(box.from());
    const auto left = block_ms(other.difference(c, other.replay(c)), 0, box.block());
    return floor_of(c, other).explains(left) ? std::optional(inside->from) : std::nullopt;
}

} // namespace quadrant::inline v0::diagnosis::detail
