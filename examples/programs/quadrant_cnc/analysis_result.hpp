// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/analysis/frf.hpp>
#include <quadrant/analysis/law_figures.hpp>

#include <string>
#include <vector>

/// What an analysis says of the axes of a machine; SI.
namespace quadrant_cnc {

/// One line of the frequency responses.
struct response_line {
    double frequency_Hz = 0;
    quadrant::analysis::complex open, sensitivity, tracking; ///< tracking: 0 where it is not known
};

/// The answer to a step of the reference: of the axis as it is, and of its linear part.
struct step_answer {
    double size_m = 0;
    quadrant::analysis::step_figures as_it_is, linear;
    std::size_t limited = 0; ///< periods in which a limit held
    bool differs() const;    ///< whether what is not linear can be seen
};

/// Gains of a cascade (law cascade_p_pi), and what keeps each loop from more.
struct proposed_gains {
    double velocity_gain = 0, velocity_integral = 0, position_gain = 0;
    std::string velocity_limit{};
    double velocity_limit_Hz = 0;
    std::string position_limit{};
    double position_limit_Hz = 0;
};
struct proposed_notch {
    double frequency_Hz = 0, width = 0, prominence_dB = 0;
    double without = 0; ///< velocity gain without it
};
/// What would suit a measured axis; where there is none, why.
struct proposal {
    std::string estimator{};
    double velocity_filter_Hz = 0; ///< 0: the estimator takes none
    struct {
        double gain_dB = 0, phase_deg = 0, modulus = 0;
    } wanted{};
    std::optional<proposed_notch> notch{};
    std::optional<proposed_gains> gains{};
    std::string no_notch{}, no_gains{};
};

/// The response of a user that stood in for the axis of the machine file.
struct measured_axis {
    std::string file;
    std::size_t lines = 0;
    double from_Hz = 0, to_Hz = 0;
    bool coherence = false;                                         ///< whether it is known
    std::vector<quadrant::analysis::measured_frf::line> response{}; ///< as it was measured
    std::string not_told{}; ///< why its band does not show whether the loop is stable; empty: it does
    proposal proposed{};
};

struct axis_analysis {
    std::string name, law;
    double period = 0;
    bool stable = false, linear = false;
    /// Empty where there is no frequency response: the loop is not stable, or its law is not linear.
    std::vector<response_line> lines{};
    quadrant::analysis::law_figures figures{}; ///< of the open loop
    std::optional<double> bandwidth_Hz;        ///< where tracking falls through -3 dB
    double tracking_peak = 0, tracking_peak_Hz = 0;
    double stiffness_N_per_m = 0, stiffness_Hz = 0; ///< dynamic, at its least
    step_answer step{};                             ///< of the machine file
    std::optional<measured_axis> measured{};

    bool told() const { return !measured || measured->not_told.empty(); } ///< `stable` is known
};

struct machine_analysis {
    std::string cnc_file;
    double period = 0;
    std::vector<axis_analysis> axes;
    std::vector<std::string> notes;
};

} // namespace quadrant_cnc
