// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/progress.hpp"

#include <chrono>
#include <cstddef>

namespace quadrant::inline v0::diagnosis {

/// What the selection asks of a cause, in one place. Scores are log-scores of held-out motion.
struct rules {
    double margin = 15;                ///< least held-out gain of one more effect; less is undecided
    double relative_margin = 0.01;     ///< least share of everything gained so far
    double least_shrink = 0.05;        ///< least relative fall of the residual force on held-out motion
    double least_shrink_of_band = 0.5; ///< the same of what one channel sees
    double structure = 5;              ///< log-score of blocks above their limit that still counts as the floor
    double immaterial =
        /// of the tolerance cloud's residual force: what is left below it is no finding (a tenth in energy)
        0.3;
    double near_floor = 3; ///< times the noise's residual force: more is left is not explained
    std::size_t most_causes = 4, beam = 2;
    std::size_t in_pairs = 4; ///< of the single effects that are tried two at once where none pays
    double abreast = 0;       ///< least share of the best way's gain at which another is followed beside it
    std::size_t threads = 0;  ///< 0: as many as there are cores; the result is the same
    std::size_t finalists =
        4;                  ///< of each round are fitted to the end; the others showed little at a first look
    double near_best = 0.5; ///< share of the best's gain with which a first look is fitted to the end as well
    int first_look = 2;     ///< steps from each start
    /// Rows that these looks and finalists are for. A shorter record affords more of them in the same time, and
    /// needs them: a few blocks distinguish little after a step or two.
    std::size_t rows_of_a_look = 14000;
    bool near_rivals = false; ///< a cause's rivals are only those that gained something where it was found
    std::size_t forms = 4;    ///< of the forms without a name that are fitted to the end
    /// When the search ends with what it has; the names that it did not come to are reported, and count against
    /// what it has. With such an end the result depends on how fast the computer is.
    using clock = std::chrono::steady_clock;
    clock::time_point until = clock::time_point::max();
    clock::time_point (*now)() = clock::now; ///< another clock, for tests
};

/// Some half of the time: a second way only where it is nearly as good, shorter first looks, fewer fitted to
/// the end, fewer rivals. What is named is fitted and judged as ever, on the whole record.
inline rules fast_rules() {
    rules r;
    r.abreast = 0.8;
    r.finalists = 2;
    r.near_best = 0.8;
    r.first_look = 1;
    r.near_rivals = true;
    r.forms = 1;
    r.in_pairs = 2;
    return r;
}

} // namespace quadrant::inline v0::diagnosis
