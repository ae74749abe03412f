// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_name.hpp"
#include "../text/axis_words.hpp"
#include "../text/decimal.hpp"
#include "../text/text.hpp"

#include <map>
#include <optional>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

struct log_column {
    std::string name;
    bool used = false;
    std::vector<double> values{};
    written_step step{};
};

/// Which column is what.
struct log_header {
    struct axis_columns {
        std::optional<std::size_t> reference, position, command;
        std::optional<std::size_t> enabled; ///< 0 where the drive is off
        std::optional<std::size_t> duty,
            effort; ///< of the drive's bridge; measured behind it, beside a command
        std::string effort_unit;
        std::optional<std::size_t> motor; ///< a second encoder
        std::string motor_unit;
        bool command_measured = false; ///< it was taken behind the amplifier
        std::optional<std::size_t> reference_velocity, reference_acceleration, velocity; ///< need not be there
        std::string command_unit;
        std::size_t command_at = 0; ///< in the header line
        std::optional<axis_kind> kind;
    };
    std::vector<log_column> columns;
    std::size_t time = 0;
    std::map<std::string, axis_columns> axes;
    std::vector<std::string> notes;
};

enum class column_role {
    reference,
    position,
    command,
    reference_velocity,
    reference_acceleration,
    velocity,
    current,
    torque,
    duty,
    enabled,
    motor_position,
    not_used_yet
};

struct column_suffix {
    std::string_view text;
    column_role role;
    std::string_view unit = {};
};
inline constexpr std::array column_suffixes{
    column_suffix{"_motor_pos_m", column_role::motor_position, "m"},
    column_suffix{"_motor_pos_rad", column_role::motor_position, "rad"},
    column_suffix{"_ref_m", column_role::reference, "m"},
    column_suffix{"_pos_m", column_role::position, "m"},
    column_suffix{"_ref_rad", column_role::reference, "rad"},
    column_suffix{"_pos_rad", column_role::position, "rad"},
    column_suffix{"_cmd_V", column_role::command, "V"},
    column_suffix{"_cmd_A", column_role::command, "A"},
    column_suffix{"_cmd_N", column_role::command, "N"},
    column_suffix{"_cmd_Nm", column_role::command, "Nm"},
    column_suffix{"_cmd_m_per_s", column_role::command, "m_per_s"},
    column_suffix{"_cmd_rad_per_s", column_role::command, "rad_per_s"},
    column_suffix{"_cmd_m", column_role::command, "m"},
    column_suffix{"_cmd_rad", column_role::command, "rad"},
    column_suffix{"_cmd_duty", column_role::command, "duty"},
    column_suffix{"_ref_m_per_s", column_role::reference_velocity, "m"},
    column_suffix{"_ref_m_per_s2", column_role::reference_acceleration, "m"},
    column_suffix{"_vel_m_per_s", column_role::velocity, "m"},
    column_suffix{"_ref_rad_per_s", column_role::reference_velocity, "rad"},
    column_suffix{"_ref_rad_per_s2", column_role::reference_acceleration, "rad"},
    column_suffix{"_vel_rad_per_s", column_role::velocity, "rad"},
    column_suffix{"_acc_m_per_s2", column_role::not_used_yet},
    column_suffix{"_force_N", column_role::not_used_yet},
    column_suffix{"_acc_rad_per_s2", column_role::not_used_yet},
    column_suffix{"_current_A", column_role::current, "A"},
    column_suffix{"_torque_Nm", column_role::torque, "Nm"},
    column_suffix{"_enabled", column_role::enabled},
    column_suffix{"_duty", column_role::duty},
    column_suffix{"_supply_V", column_role::not_used_yet},
};

/// The units of a command that only a drive with loops of its own takes, those of one kind of axis among them.
constexpr std::optional<axis_kind> kind_of_unit(std::string_view unit) {
    if (unit == "m" || unit == "m_per_s") return axis_kind::linear;
    if (unit == "rad" || unit == "rad_per_s") return axis_kind::rotary;
    return {};
}

/// Columns that say more of an axis that others make: they come behind those.
constexpr bool is_beside(column_role r) {
    return r != column_role::reference && r != column_role::position && r != column_role::command;
}

} // namespace quadrant::inline v0::diagnosis::detail
