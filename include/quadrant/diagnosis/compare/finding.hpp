// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../effect/rules.hpp"
#include "comparison_result.hpp"
#include "fit_of_log.hpp"
#include "with_causes.hpp"

#include <functional>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail::beside {

/// One log explained by the machine that the other shows.
struct direction {
    bool found_in_second = true;
    const diagnosis_result* reference = nullptr; ///< the log whose machine is the description
    const diagnosis_result* own = nullptr;       ///< the log that is explained
    machine_description of_reference{}, of_own{};
    machine_description for_own{}, for_reference{}; ///< what the one shows, as it is lent to the other
    diagnosis_result across{};                      ///< the log that is explained against for_own
};

/// What a direction says of one axis.
struct finding {
    std::vector<difference> named, undecided;
    fit_of_log reference{}, before{}, after{}, own{};
    double score = 0; ///< log-score of both logs with the differences, less what these must bring
    /// A process that this log shows and the other does not: the other would show it, or could not.
    std::vector<difference> process, process_undecided;
};

/// An axis whose forces the log shows: each difference is asked of both logs.
QUADRANT_DIAGNOSIS_DECL finding by_scores(const direction& d, const std::string& axis, log_of_axis& reference,
                                          log_of_axis& own, const rules& r);
/// An axis behind a drive with loops of its own, or of which positions alone are known: what one log claims
/// against the machine file and against the other's machine, and the other does not have.
QUADRANT_DIAGNOSIS_DECL finding by_names(const direction& d, const std::string& axis, const rules& r);
/// What a replay shows: another key of the controller in one log than in the other, a signal that is added in
/// one, a coarser count.
QUADRANT_DIAGNOSIS_DECL void add_replayed(std::vector<difference>& to, const direction& d,
                                          const direction& back, const std::string& axis);
/// A process that runs in one log, and not in the other. `asked`: how the other log is explained with it, if
/// that can be asked: where it is explained no worse, that log cannot show the process, and nothing is decided.
QUADRANT_DIAGNOSIS_DECL void find_process(finding& out, const direction& d, const std::string& axis,
                                          const std::function<fit_of_log(const machine_description&)>& asked,
                                          const rules& r);
/// Whether the two logs differ by more than what neither machine explains in its own log, and than laws are
/// right to, whatever the name.
QUADRANT_DIAGNOSIS_DECL bool differ_without_a_name(const finding& f, const direction& d,
                                                   const std::string& axis, const rules& r);
/// Whether the log that is explained holds a force that no name explains, and the other nothing like it.
QUADRANT_DIAGNOSIS_DECL bool holds_more(const finding& f, const direction& d, const std::string& axis,
                                        const rules& r);

} // namespace quadrant::inline v0::diagnosis::detail::beside

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "finding.ipp"
#endif
