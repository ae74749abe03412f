// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/described_numbers.hpp"
#include "../result/result.hpp"
#include "links.hpp"
#include "search.hpp"

/// The findings of a link as keys of the machine file, with intervals.
namespace quadrant::inline v0::diagnosis::chain {

/// What no law is better than, relative.
inline constexpr double best_law = 0.01;

/// A value with 95 %: scatter between pieces, and what no law is better than: one per cent, and `count`.
QUADRANT_DIAGNOSIS_DECL estimate with_interval(double value, double deviation, double count);

/// The described value of a cause's first key, 0 when there is none.
QUADRANT_DIAGNOSIS_DECL double described_value(const axis_description& axis, const std::string& key);
/// Whether a value, or a part of its interval, is inside what its owner says of it.
QUADRANT_DIAGNOSIS_DECL bool inside_tolerance(const axis_description& axis, const parameter_estimate& p);

/// Values of one term of the best model.
class term_values {
public:
    term_values(const described_link& d, const fitted& f, const axis_description& axis)
        : d_(d), f_(f), axis_(axis) {}

    std::vector<parameter_estimate> of(term t) const;
    double compliance() const;

private:
    std::vector<Eigen::Index> places(term t) const;
    double value(Eigen::Index j) const { return f_.values[j]; }
    double deviation(Eigen::Index j) const { return std::sqrt(std::max(0.0, f_.covariance(j, j))); }

    std::vector<parameter_estimate> scale(Eigen::Index j) const;
    std::vector<parameter_estimate> wave(const std::vector<Eigen::Index>& at, const char* size,
                                         const char* period, const char* phase, double p, bool described) const;
    std::vector<parameter_estimate> smooth(const std::vector<Eigen::Index>& at) const;
    std::vector<parameter_estimate> steps(const std::vector<Eigen::Index>& at) const;

    const described_link& d_;
    const fitted& f_;
    const axis_description& axis_;
};

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "values.ipp"
#endif
