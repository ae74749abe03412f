// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/trajectory/limits.hpp>

/// Limits from plain numbers [m/s, m/s^2, m/s^3].
inline quadrant::trajectory::motion_limits at_most(double velocity,
                                                   double acceleration = quadrant::trajectory::unlimited,
                                                   double jerk = quadrant::trajectory::unlimited) {
    using namespace quadrant;
    return {quantity<si::velocity>::from_value(velocity), quantity<si::acceleration>::from_value(acceleration),
            trajectory::jerk::from_value(jerk)};
}
