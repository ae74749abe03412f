// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../text/axis_words.hpp"
#include "outcome.hpp"

namespace quadrant::inline v0::diagnosis::chain {

/// Puts what was found on a link into the result of an axis.
QUADRANT_DIAGNOSIS_DECL void join(axis_result& result, std::vector<cause>& causes, diagnosis_result& out,
                                  outcome&& o, const char* view);

/// A link, or bad_input where its record is too short.
QUADRANT_DIAGNOSIS_DECL outcome link_or_refusal(const described_link& d, const axis_description& axis,
                                                const std::string& file,
                                                const std::vector<std::string>& excluded, const rules& limits);

/// Diagnoses an axis that is a chain of positions: asked, motor, scale, as far as they were recorded.
QUADRANT_DIAGNOSIS_DECL axis_result diagnose_positions(diagnosis_result& out, std::vector<cause>& causes,
                                                       const axis_description& axis, const axis_log& log,
                                                       double period, const std::string& file,
                                                       const std::vector<std::string>& excluded,
                                                       const rules& limits);

/// What two encoders of an axis with forces say of its transmission.
struct two_encoders {
    outcome found;
    std::vector<std::string> notes;
    /// The log with the centre of mass of motor and load for the position: it obeys the laws of a rigid axis,
    /// whatever lies between the two.
    axis_log carried;
    double motor_coulomb =
        0; ///< friction on the motor's side, described or claimed: part of what the force overcomes [N]
    double motor_share = 0; ///< of the mass; 0: not described, or the two move as one

    /// Puts the centre of mass in the place of the scale, whose load is so far from the motor in each row.
    void carry(axis_log& log, const axis_description& axis, const std::vector<double>& elastic) const {
        log.controller_reads = log.position;
        // While the load sticks, the centre of mass moves with the motor.
        log.least_give = motor_share * (found.play / 2 + axis.plant.coulomb_N.value_or(0) * found.compliance);
        for (std::size_t k = 0; k < log.position.size(); ++k) log.position[k] -= motor_share * elastic[k];
    }
    /// The axis as the force sees it: the friction of both sides in one.
    axis_description rigid(axis_description a) const {
        if (motor_coulomb == 0) return a;
        a.plant.coulomb_N = a.plant.coulomb_N.value_or(0) + motor_coulomb;
        if (a.plant.static_N) *a.plant.static_N += motor_coulomb;
        return a;
    }
    /// Values found for that axis as those of the guide alone.
    void of_the_guide(std::vector<parameter_estimate>& values) const {
        for (parameter_estimate& p : values)
            if (p.key == "coulomb_N" || p.key == "static_N")
                for (estimate& e : p.values)
                    e = {e.value - motor_coulomb, e.low - motor_coulomb, e.high - motor_coulomb};
    }
};
/// Another log of the same axis with the centre of mass for the position, by the transmission that was found;
/// as it is where it has no second encoder or is too short.
QUADRANT_DIAGNOSIS_DECL axis_log carried_too(const two_encoders& found, const axis_description& axis,
                                             const axis_log& log, double period, const std::string& file);
QUADRANT_DIAGNOSIS_DECL two_encoders diagnose_transmission(const axis_description& axis, const axis_log& log,
                                                           double period, const std::string& file,
                                                           const std::vector<std::string>& excluded,
                                                           const rules& limits);

} // namespace quadrant::inline v0::diagnosis::chain

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "diagnose_chain.ipp"
#endif
