// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/signal.hpp"

#include <cstddef>
#include <limits>

/// From a path to what each axis is asked for in every servo period.
namespace quadrant::inline v0::trajectory {

/// m/s^3.
using jerk_unit = unit_quotient<si::acceleration, si::time>;
/// Change of acceleration over time.
using jerk = quantity<jerk_unit>;
/// A limit that never binds.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// How fast, how hard, how suddenly; above 0, infinite = no bound.
struct motion_limits {
    quantity<si::velocity> velocity = quantity<si::velocity>::from_value(unlimited);
    quantity<si::acceleration> acceleration = quantity<si::acceleration>::from_value(unlimited);
    trajectory::jerk jerk = trajectory::jerk::from_value(unlimited);
};

/// The same as plain numbers [m/s, m/s^2, m/s^3]: the mathematics of a path mixes the axes (path/point.hpp).
struct bounds {
    double velocity = unlimited, acceleration = unlimited, jerk = unlimited;
};
/// Limits without their units.
inline bounds plain(const motion_limits& of) {
    return {of.velocity.value(), of.acceleration.value(), of.jerk.value()};
}

/// What a trajectory asks of one axis at one moment, with what a feedforward of jerk wants.
struct motion {
    quantity_of<signal::position> position{};
    quantity_of<signal::velocity> velocity{};
    quantity_of<signal::acceleration> acceleration{};
    trajectory::jerk jerk{};
};

/// How the speed goes from one value to another.
enum class profile_kind : unsigned char {
    constant_velocity,        ///< at once: keeps no limit of acceleration or jerk
    constant_acceleration,    ///< ramps of speed ("trapezoidal velocity"): keeps no limit of jerk
    trapezoidal_acceleration, ///< ramps of acceleration, seven phases: jerk is bounded
    cubic_acceleration        ///< cubic ramps of acceleration: jerk is bounded and continuous
};

/// Refuses what stands in a line of a program: "line = 12: must ..."; the line is the refusal's value.
[[noreturn]] inline void refuse_line(std::size_t line, const quadrant::detail::rule& must) {
    quadrant::detail::refuse({"line", double(line), must});
}

/// Refuses limits that are not above 0, and limits that `kind` has no way to keep.
inline void require_limits(const char* block, const motion_limits& of, profile_kind kind) {
    using quadrant::detail::field_name;
    const bounds b = plain(of);
    require(b.velocity > 0, field_name(block, ".velocity"), of.velocity,
            "must be above 0 (infinite: no bound)");
    require(b.acceleration > 0, field_name(block, ".acceleration"), of.acceleration,
            "must be above 0 (infinite: no bound)");
    require(b.jerk > 0, field_name(block, ".jerk"), of.jerk, "must be above 0 (infinite: no bound)");
    require(kind != profile_kind::constant_velocity || b.acceleration == unlimited,
            field_name(block, ".acceleration"), of.acceleration,
            "must be infinite: a profile of constant velocity keeps no such limit");
    require(kind >= profile_kind::trapezoidal_acceleration || b.jerk == unlimited, field_name(block, ".jerk"),
            of.jerk, "must be infinite: only trapezoidal and cubic acceleration keep such a limit");
}

} // namespace quadrant::inline v0::trajectory
