// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <numbers>
#include <string_view>

namespace quadrant::diagnosis {

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
};

/// Null where the name is not known.
inline const unit_name* find_unit(std::string_view name) {
    for (const unit_name& u : unit_names)
        if (u.name == name) return &u;
    return nullptr;
}

} // namespace quadrant::diagnosis
