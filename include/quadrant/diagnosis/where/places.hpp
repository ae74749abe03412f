// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../fit/record.hpp"
#include "../result/resample.hpp"

#include <cstdio>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Share of the residual's energy that its mean per bin predicts, the means taken from the other folds: a share
/// that is only noise comes out at zero, not above it. Rows with bin < 0 stand apart and are not predicted.
QUADRANT_DIAGNOSIS_DECL estimate predicted_share(const std::vector<double>& residual, const axis_record& r,
                                                 const std::vector<int>& bin, int bins,
                                                 const std::vector<std::vector<double>>& draws);

/// Share of the energy on the rows that `chosen` picks.
template <class Chosen>
estimate share_on(const std::vector<double>& residual, const axis_record& r,
                  const std::vector<std::vector<double>>& draws, Chosen chosen) {
    std::vector<double> energy(r.segments, 0.0), inside(r.segments, 0.0);
    for (std::size_t k = r.score.skip; k < residual.size(); ++k) {
        const double e = residual[k] * residual[k];
        energy[r.segment[k]] += e;
        if (chosen(k)) inside[r.segment[k]] += e;
    }
    return resampled(draws, r.segments, [&](const std::vector<double>& w) {
        double e = 0, i = 0;
        for (std::size_t s = 0; s < w.size(); ++s) {
            e += w[s] * energy[s];
            i += w[s] * inside[s];
        }
        return e > 0 ? i / e : 0;
    });
}

/// Rows within a block of a change of the measured direction.
QUADRANT_DIAGNOSIS_DECL std::vector<bool> near_reversal(const axis_record& r);

template <class... Numbers> std::string worded(const char* format, Numbers... numbers) {
    std::array<char, 240> text{};
    std::snprintf(text.data(), text.size(), format, numbers...);
    return text.data();
}

} // namespace detail

/// In which regime a residual force lives: one entry a view, its share of the energy with a 95 % interval. The
/// remainder of a view is what that view does not explain; views overlap and do not add up with each other.
QUADRANT_DIAGNOSIS_DECL std::vector<place> regimes(const std::vector<double>& residual, const axis_record& r);

/// Amplitude density of a signal [unit/sqrt(Hz)] by averaged periodograms with a Hann window, half overlapped,
/// at a hundred lines up to the bandwidth, each window as long as the cycle of the first. Direct sums: a report
/// needs no library.
QUADRANT_DIAGNOSIS_DECL void spectrum(const std::vector<double>& x, double period, double up_to_Hz,
                                      std::vector<double>& frequency, std::vector<double>& density);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "places.ipp"
#endif
