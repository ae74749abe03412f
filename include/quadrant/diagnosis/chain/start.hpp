// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../effect/rules.hpp"
#include "../fit/spatial_spectrum.hpp"
#include "fit.hpp"
#include "possible.hpp"

/// How each term joins a model: where its fit begins.
namespace quadrant::inline v0::diagnosis::chain {

/// Terms that can lie between these two readings.
QUADRANT_DIAGNOSIS_DECL std::vector<term> suspects_of(const position_link& l);

/// Positions at which what is left was read, of the first reading or of the scale.
QUADRANT_DIAGNOSIS_DECL std::vector<double> places(const readings& r, bool of_scale);

/// Whether a period is not distinguished from a turn or a fraction of it on this travel.
QUADRANT_DIAGNOSIS_DECL bool is_fraction(const readings& r, double p, double turn);

/// The period at which what a model leaves repeats best along the travel; 0: none. Those near a fraction of
/// `but` do not count.
QUADRANT_DIAGNOSIS_DECL double repeating_period(const readings& r, const fitted& from, double but,
                                                bool of_scale);

/// The period beside p at which one wave takes most off what a model leaves.
template <class Put> fitted refined_period(const readings& r, link_model m, double p, Put put) {
    const double half = 0.5 * p * p / r.travel();
    const double best = least(
        [&](double x) {
            put(m, x);
            return fit_columns(r, m).rms;
        },
        p - std::min(half, 0.4 * p), p + half, 5, 14);
    put(m, best);
    return fit_columns(r, m);
}

/// The row that counts before which and behind which the means of `left` differ most, by the energy that it
/// takes; and that energy.
QUADRANT_DIAGNOSIS_DECL std::pair<std::size_t, double> best_cut(const Eigen::VectorXd& left);

/// Whether each jump happens from one row to the next, not over a stretch of the record.
QUADRANT_DIAGNOSIS_DECL bool sudden(const readings& r, const fitted& f);

/// Jumps, one after the other, while each pays.
QUADRANT_DIAGNOSIS_DECL fitted with_steps(const readings& r, const fitted& from, double margin);

/// A model with one term more, fitted; the model itself where the term cannot join, or where the values would
/// not be possible(). `margin`: what each jump has to pay.
QUADRANT_DIAGNOSIS_DECL fitted with_term(const readings& r, const fitted& from, term t, double margin);
/// The same, whatever the values.
QUADRANT_DIAGNOSIS_DECL fitted begun_with_term(const readings& r, const fitted& from, term t, double margin);

/// A model without one of its terms, the others fitted again.
QUADRANT_DIAGNOSIS_DECL fitted without_term(const readings& r, const fitted& from, term t,
                                            const link_model& described);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "start.ipp"
#endif
