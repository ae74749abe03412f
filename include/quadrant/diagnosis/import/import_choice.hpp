// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>

namespace quadrant::inline v0::diagnosis {

/// What to take of the files, and on which clock.
struct import_choice {
    bool resample = false; ///< onto an even clock; several files always are
    double period_s = 0;   ///< of that clock; 0: the median step of the first file's stamps
    double from_s = 0;     ///< rows before it are left out, counted from the first row of the first file
    double to_s = 1e300;   ///< rows behind it likewise
};

/// A file that was read: its text, and the name by which messages call it.
struct foreign_file {
    std::string text, name;
};

} // namespace quadrant::inline v0::diagnosis
