// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../result/waveform.hpp"

#include <cstddef>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// That a signal is added to the command, beside the other readings of the same difference.
struct added_finding {
    added_waveform waveform;
    double probability = 0;   ///< that it is this, and no other controller
    double of_controller = 0; ///< that it is the best key of the described controller
};

namespace detail {

/// What the log commands beyond the replay.
struct added_signal {
    std::vector<double> values;  ///< logged less replayed, from the first row that is compared [V]
    double noise = 0;            ///< that rounding leaves in a row, rms [V]
    double period = 0;           ///< of the samples [s]
    std::size_t first_row = 0;   ///< of `values`, in the log
    bool offset_unknown = false; ///< the controller's first integral is unknown, and with it a constant

    double time(std::size_t row) const { return period * static_cast<double>(row + first_row); }
};

/// One form that the signal may have: what is linear in it as columns, what is not as numbers.
struct waveform_candidate {
    added_waveform form;
    std::vector<std::vector<double>> columns;
    std::size_t numbers = 0; ///< that were chosen beside the sizes of the columns
};

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
