// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// Where the command column of a log was taken: before the amplifier (what the controller asked for), or behind
/// it (a measured current, force or torque). Behind it the limit, dead zone, lag, delay and lost samples of the
/// amplifier are already in the column, so they cannot be the cause of a gap.
enum class command_origin { asked, measured };

/// The word of a machine file for it.
constexpr std::string_view name_of(command_origin o) {
    return o == command_origin::measured ? "measured" : "asked";
}

} // namespace quadrant::inline v0::diagnosis
