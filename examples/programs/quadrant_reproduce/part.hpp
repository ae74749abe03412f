// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>

namespace quadrant_reproduce {

/// One system, procedure or figure of a source, and what we have of it. Tables follow from the printed numbers.
struct part {
    enum class state {
        done,      ///< computed in this run, or a block that tests hold against its equation
        differs,   ///< done, and not as the source has it
        cannot,    ///< the source lacks what one would need
        photograph ///< a photograph or a drawing of a scheme: nothing to compute
    };
    std::string source, name, what;
    state is;
    std::string where; ///< title of our picture, id of an experiment, or the header that has it
    std::string why{}; ///< differs, cannot
};

inline const char* words_of(part::state s) {
    switch (s) {
    case part::state::done:
        return "done";
    case part::state::differs:
        return "done, differs";
    case part::state::cannot:
        return "cannot be computed";
    default:
        return "a scheme";
    }
}

} // namespace quadrant_reproduce
