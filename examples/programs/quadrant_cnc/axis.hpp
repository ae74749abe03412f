// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/control/axis_law.hpp>

#include <memory>

/// One axis of the virtual machine, whatever its drive and its control law: assembled in axis.cpp.
namespace quadrant_cnc {

/// What an axis did in one servo period; SI.
struct axis_sample {
    double reference = 0, reading = 0, velocity = 0, command = 0; ///< of this sample: what a log holds
    double place = 0;                                             ///< where the table was when it was read
    double effort = 0; ///< current [A], or command of the motor [V], until the next sample
    bool limited = false, faulted = false;
};

class axis {
public:
    virtual ~axis() = default;
    /// One servo period on.
    virtual axis_sample step(const quadrant::axis_motion<>& asked) noexcept = 0;
    virtual void settle(double at) noexcept = 0;
    /// Whether the tool is in the cut, from the coming period on.
    virtual void cut(bool in_the_cut) noexcept = 0;
    /// Periods that the reference has to be ahead.
    virtual std::size_t lead() const noexcept = 0;
    virtual double effort_limit() const noexcept = 0; ///< of current or command, both ways; infinite: none
};

/// Throws quadrant::invalid_parameter for what no block can be made of.
std::unique_ptr<axis> make_axis(const axis_description& a, double period, std::uint64_t seed);

/// "A", or "V" where the file does not say what a volt makes.
const char* effort_unit(const axis_description& a);

} // namespace quadrant_cnc
