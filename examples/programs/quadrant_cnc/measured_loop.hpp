// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "frf_file.hpp"

#include <quadrant/analysis/impulse_test.hpp>

namespace quadrant_cnc {

/// The loop of a law around a measured axis G: what the law does is taken from the loop that runs with the
/// axis of the machine file, whose open loop L and disturbance response G0 S its impulse test knows.
///   law          C = L/G0 = (1 - S)/(G0 S)
///   open loop    L' = C G,  S' = 1/(1 + L')
///   tracking     T' = T G S'/(G0 S)
/// Exact for a law that reads the position; of one that reads the velocity too the ratio of both readings is
/// that of the machine file. Known within the lines of G.
class measured_loop {
public:
    using complex = quadrant::analysis::complex;
    using frequency = quadrant::frequency;

    measured_loop(const quadrant::analysis::impulse_test& model, quadrant::analysis::tabulated_response axis)
        : model_(model), axis_(std::move(axis)) {}

    complex axis(frequency f) const { return axis_(f); }
    complex open(frequency f) const { return (1.0 - model_.sensitivity(f)) / model_.disturbance(f) * axis_(f); }
    complex sensitivity(frequency f) const { return 1.0 / (1.0 + open(f)); }
    complex disturbance(frequency f) const { return axis_(f) * sensitivity(f); }
    complex tracking(frequency f) const { return model_.tracking(f) * disturbance(f) / model_.disturbance(f); }
    quadrant::analysis::band band() const { return axis_.all(); }

private:
    const quadrant::analysis::impulse_test& model_;
    quadrant::analysis::tabulated_response axis_;
};

} // namespace quadrant_cnc
