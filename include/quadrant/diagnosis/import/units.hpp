// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <numbers>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// A unit as files name it: factor to the SI unit of its kind.
struct unit_name {
    std::string_view name, si;
    double factor;
};

inline constexpr std::array unit_names{
    unit_name{"m", "m", 1},
    unit_name{"mm", "m", 1e-3},
    unit_name{"um", "m", 1e-6},
    unit_name{"nm", "m", 1e-9},
    unit_name{"inch", "m", 0.0254},
    unit_name{"rad", "rad", 1},
    unit_name{"mrad", "rad", 1e-3},
    unit_name{"deg", "rad", std::numbers::pi / 180},
    unit_name{"turn", "rad", 2 * std::numbers::pi},
    unit_name{"s", "s", 1},
    unit_name{"ms", "s", 1e-3},
    unit_name{"us", "s", 1e-6},
    unit_name{"ns", "s", 1e-9},
    unit_name{"100ns", "s", 1e-7},
    unit_name{"V", "V", 1},
    unit_name{"mV", "V", 1e-3},
    unit_name{"A", "A", 1},
    unit_name{"mA", "A", 1e-3},
    unit_name{"N", "N", 1},
    unit_name{"kN", "N", 1e3},
    unit_name{"Nm", "Nm", 1},
    unit_name{"mNm", "Nm", 1e-3},
    unit_name{"m/s", "m_per_s", 1},
    unit_name{"mm/s", "m_per_s", 1e-3},
    unit_name{"mm/min", "m_per_s", 1e-3 / 60},
    unit_name{"rad/s", "rad_per_s", 1},
    unit_name{"deg/s", "rad_per_s", std::numbers::pi / 180},
    unit_name{"turn/s", "rad_per_s", 2 * std::numbers::pi},
    unit_name{"rpm", "rad_per_s", 2 * std::numbers::pi / 60},
    unit_name{"1", "1", 1}, // a share, or a yes and no
    unit_name{"%", "1", 0.01},
    unit_name{"duty", "duty", 1}, // a share, of a command
};

/// Null where the name is not known.
inline const unit_name* find_unit(std::string_view name) {
    for (const unit_name& u : unit_names)
        if (u.name == name) return &u;
    return nullptr;
}

/// The unit at the end of a column's name: "time_ms", "Time [ms]", "Position (mm)". Null where there is none.
inline const unit_name* unit_at_end(std::string_view name) {
    while (name.ends_with(' ')) name.remove_suffix(1);
    if (name.ends_with(']') || name.ends_with(')')) {
        const std::size_t open = name.find_last_of("[(");
        return open == name.npos ? nullptr : find_unit(name.substr(open + 1, name.size() - open - 2));
    }
    const unit_name* out = nullptr;
    std::size_t longest = 0; // "_rad_per_s" ends in "_s" too
    for (const unit_name& u : unit_names)
        for (const std::string_view text : {u.name, u.factor == 1 ? u.si : u.name})
            if (text.size() > longest && name.size() > text.size() && name.ends_with(text) &&
                name[name.size() - text.size() - 1] == '_') {
                out = &u;
                longest = text.size();
            }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
