// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/control/axis_law.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/filter/lowpass.hpp>

namespace quadrant_cnc {

/// What `acceleration_feedback` of a machine file adds to the command of any law: the accelerometer's
/// loop around the drive (block `acceleration_feedback`). Behind it the limit and the converter of the command
/// hold for the sum.
class acceleration_loop {
public:
    acceleration_loop(const acceleration_feedback_description& f, const command_description& c, double dac_step,
                      double period)
        : gain_(f.gain_V_s2_per_m), filter_({quadrant::in_si(f.filter_Hz)}, quadrant::in_si(period)),
          limit_({quadrant::in_si(-c.limit_V), quadrant::in_si(c.limit_V)}, quadrant::in_si(period)),
          dac_({quadrant::in_si(dac_step)}, quadrant::in_si(period)) {}

    /// The command with what the axis accelerates too little.
    double operator()(double u, const quadrant::axis_motion<>& asked,
                      const quadrant::axis_measurement<>& measured) noexcept {
        const double wanted = u + gain_ * filter_(asked.acceleration - measured.acceleration).value();
        const auto limited = limit_(volts::from_value(wanted));
        limited_ = limited.value() != wanted;
        return dac_(limited).value();
    }
    void rest() noexcept {
        filter_.reset();
        limited_ = false;
    }
    bool limited() const noexcept { return limited_; }

private:
    using volts = quadrant::quantity_of<quadrant::signal::voltage>;
    double gain_;
    quadrant::lowpass<quadrant::signal::acceleration> filter_;
    quadrant::limiter<quadrant::signal::voltage> limit_;
    quadrant::quantizer<quadrant::signal::voltage> dac_;
    bool limited_ = false;
};

/// None where the file has none. Throws quadrant::invalid_parameter: a filter at or above half the servo rate,
/// a law that is asked before its reference is due.
inline std::optional<acceleration_loop> make_acceleration_loop(const axis_description& a, double period,
                                                               std::size_t lead) {
    if (!a.acceleration) return {};
    quadrant::require(lead == 0, "acceleration_feedback with a law that looks ahead", double(lead),
                      "must be 0 periods: the accelerometer is compared with the reference of now");
    return acceleration_loop(*a.acceleration, a.command, a.dac_step(), period);
}

} // namespace quadrant_cnc
