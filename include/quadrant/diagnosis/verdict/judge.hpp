// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../result/result.hpp"
#include "../which/axis_case.hpp"

#include <algorithm>

namespace quadrant::inline v0::diagnosis::detail {

inline verdict judge(const axis_case& c, const std::vector<cause>& causes) {
    if ((c.at_floor() || c.within_its_laws()) && !c.count_unnamed && !c.controller_open()) {
        // Suspects for what calibration leaves are no finding where machines inside the tolerances differ more.
        const bool silent =
            causes.empty() || (std::none_of(causes.begin(), causes.end(), claimed) &&
                               (c.models.immaterial(c.path.front()) || c.calibrated_within_its_laws() ||
                                c.calibrated_within_tolerances()));
        if (!silent)
            return std::all_of(causes.begin(), causes.end(), claimed) || c.claims_suffice()
                       ? verdict::explained
                       : verdict::partly_explained;
        const auto& given = c.models.given();
        // What a law of friction may be wrong by is no gap where calibration does no better.
        const bool as_given =
            !c.models.pays(c.models.calibrated(), given) &&
            (c.models.structure(given, c.noise) < c.limits.structure || c.calibrated_within_its_laws());
        return as_given ? verdict::no_gap : verdict::within_tolerance;
    }
    const bool blamed = std::any_of(causes.begin(), causes.end(), claimed);
    if (!blamed && !c.count_unnamed && !c.controller_open() &&
        (c.calibrated_within_tolerances() || c.calibrated_within_its_laws()))
        return verdict::within_tolerance;
    const bool helps =
        std::any_of(causes.begin(), causes.end(), [](const cause& x) { return x.shrink.value > 0.2; });
    return helps ? verdict::partly_explained : verdict::unexplained;
}

} // namespace quadrant::inline v0::diagnosis::detail
