// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"

namespace quadrant::inline v0::diagnosis::detail {

/// Up to which share of an axis' work each of its stages goes: CPU, measured on the practice logs, between
/// those of one cause (the search ends at 0.9) and those of several (0.55 to 0.65). A look along the motion is
/// part of the search where the record may ask for one.
struct stages {
    double first_look, search, rivals = 0.94, causes = 0.95, gap = 0.97;
};
inline stages stages_of(bool may_look_again) {
    return may_look_again ? stages{.first_look = 0.4, .search = 0.7} : stages{.first_look = 0.7, .search = 0.7};
}
/// What making the record ready is of a look: along a motion, and behind a loop, a first search is part of it.
constexpr double share_of_record(held_by how) {
    return how == held_by::readings ? 0.08 : how == held_by::motion ? 0.1 : 0.3;
}

} // namespace quadrant::inline v0::diagnosis::detail
