// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine/machine.hpp"
#include "units.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What a signal of an axis is.
enum class signal_role {
    reference,
    position,
    command,
    reference_velocity,
    velocity,
    current,
    torque,
    duty,
    supply,
    enabled,
    motor_position
};

/// One role: its key in a map, the middle of its column's name in a log ("x" + "_pos_" + "m"), its units and
/// whether the signal is held from one row to the next or goes on between them.
struct signal_kind {
    signal_role role;
    std::string_view key, infix;
    std::string_view linear, rotary; ///< SI units on either kind of axis, parted by blanks; empty: not there
    bool held = false;
};

/// Every role that a log may have.
inline constexpr std::array signal_kinds{
    signal_kind{signal_role::reference, "reference", "_ref_", "m", "rad"},
    signal_kind{signal_role::position, "position", "_pos_", "m", "rad"},
    signal_kind{signal_role::command, "command", "_cmd_", "V A N duty m_per_s m", "V A Nm duty rad_per_s rad",
                true},
    signal_kind{signal_role::reference_velocity, "reference_velocity", "_ref_", "m_per_s", "rad_per_s"},
    signal_kind{signal_role::velocity, "velocity", "_vel_", "m_per_s", "rad_per_s"},
    signal_kind{signal_role::current, "current", "_current_", "A", "A"},
    signal_kind{signal_role::torque, "torque", "_torque_", "", "Nm"},
    signal_kind{signal_role::duty, "duty", "_duty", "1", "1", true},
    signal_kind{signal_role::supply, "supply", "_supply_", "V", "V"},
    signal_kind{signal_role::enabled, "enabled", "_enabled", "1", "1", true},
    signal_kind{signal_role::motor_position, "motor_position", "_motor_pos_", "m rad", "rad"},
};

/// The record of a role.
constexpr const signal_kind& kind_of(signal_role role) {
    for (const signal_kind& k : signal_kinds)
        if (k.role == role) return k;
    return signal_kinds[0];
}

/// The unit of a signal in this role. A command without dimension has the unit duty, in which the name of its
/// column ends; of the duty signal the unit duty is read as 1.
constexpr std::string_view unit_as(signal_role role, std::string_view si) {
    if (role == signal_role::command) return si == "1" ? "duty" : si;
    return role == signal_role::duty && si == "duty" ? "1" : si;
}

/// Whether a command in this unit is the set-point of a drive, not a force or what makes one.
constexpr bool is_set_point(std::string_view si) {
    return si == "m_per_s" || si == "rad_per_s" || si == "m" || si == "rad";
}

/// Which column of another program's log is what (docs/schema/import.schema.json).
struct import_map {
    /// Where one quantity is found in a file, and what makes it SI.
    struct source {
        std::string column;      ///< its name; empty: by number
        std::size_t number = 0;  ///< from 1
        std::size_t element = 0; ///< of the list that its cells hold, from 1; 0: they hold a number
        std::string si;          ///< unit of the converted column; empty: the end of the column's name says it
        double factor = 1;       ///< SI per unit of the file
        std::string place;       ///< key path in the map, for messages
        std::size_t file = 0;    ///< which of the files, from 0
    };
    /// One signal of an axis.
    struct signal {
        signal_role role;
        source from;
    };
    /// The signals of one axis.
    struct axis {
        std::string name;
        std::vector<signal> signals;
        command_origin command_is = command_origin::asked;

        const source* find(signal_role role) const {
            for (const signal& s : signals)
                if (s.role == role) return &s.from;
            return nullptr;
        }
    };
    /// How one file is laid out.
    struct layout {
        char separator = ','; ///< ' ': any run of blanks
        char decimal = '.';
        std::size_t header_line = 0;    ///< from 1; 0: by `header_begins_with`, or none
        std::string header_begins_with; ///< first cell of the line that names the columns
        std::string end;                ///< a line of this text ends the rows
        bool halscope = false;          ///< as LinuxCNC's halscope saves (halscope_file.hpp)
        std::optional<source> time;
        double period_s = 0; ///< without a time column
        bool named() const { return header_line > 0 || !header_begins_with.empty() || halscope; }
    };
    std::string file;
    std::vector<layout> files{1}; ///< in the order in which they are given
    std::vector<axis> axes;
    std::vector<std::string> left_out{}; ///< columns that have no name of ours, of a file that needs no map
};

} // namespace quadrant::inline v0::diagnosis
