// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "segment.hpp"

#include <cstddef>

namespace quadrant::inline v0::path {

/// How a move hands over to the next one.
enum class path_ending {
    exact_stop, ///< at rest at the end of the piece
    continuous  ///< on without a stop; a corner may be rounded within the tolerance
};

/// One move of a program: a piece of path and how it is to be travelled. The next move starts where this one
/// ends.
struct move {
    segment path;       ///< never empty
    double feed = 0;    ///< along the path [m/s], above 0; no meaning when rapid
    bool rapid = false; ///< as fast as the machine allows
    path_ending ending = path_ending::exact_stop;
    double tolerance =
        0; ///< of a continuous ending [m]: how far the path may leave the corner; 0: the joint must be tangent
    double dwell = 0;        ///< rest at the end of the move [s]; above 0 only with exact_stop
    double dwell_before = 0; ///< rest before the move starts [s]; the first move of a program only
    std::size_t line = 0;    ///< of the file, from 1
};

} // namespace quadrant::inline v0::path
