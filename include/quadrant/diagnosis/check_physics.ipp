// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "import/map.hpp"
#include "import/physics.hpp"
#include "text/bad_input.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Beyond this ratio a unit is wrong: the smallest slips are 1000 (mm, mV), 57 (degrees) and 25.4 (inch); no
/// machine is so far from what its owner believes.
inline constexpr double slip_of_a_unit = 24;
/// Between the two a ratio is only noted: a wrong mass, a soft controller or a poor regression can make it.
inline constexpr double remarkable = 3;
/// A turned sign is refused only when it is this many standard deviations sure, and explains a share of the
/// command.
inline constexpr double sure_of_a_sign = 10;

/// "1000 times": the ratio for a sentence, the larger way round.
inline std::string times(double ratio) {
    return ratio >= 1 ? fmt::format("{:.3g} times", ratio) : fmt::format("1/{:.3g} of", 1 / ratio);
}

/// One axis of a log, checked.
class axis_physics {
public:
    axis_physics(const axis_log& axis, double period, const std::string& file, const known_axis& known)
        : a_(axis), c_(check_units(axis, period)), file_(file), known_(known), m_(key_of("m", axis.kind)),
          constant_(known.force_constant > 0      ? known.force_constant
                    : is_force(axis.command_unit) ? 1
                                                  : 0) {}

    /// Throws bad_input where a unit or a sign cannot be.
    void refuse_what_cannot_be() const {
        if (!(c_.travel > 0)) return;
        if (a_.has_reference && std::abs(c_.correlation) > 0.9) against_the_reference();
        if (std::abs(c_.velocity_correlation) > 0.9) against_the_position();
        if (known_.drive == drive_kind::position || known_.drive == drive_kind::position_servo) return;
        if (!c_.sign_is_known() || known_.drive == drive_kind::velocity) {
            against_the_motion();
            return;
        }
        const double mass = c_.command_per_acceleration * constant_;
        const bool right_size = known_.mass > 0 && constant_ > 0 && -mass < remarkable * known_.mass &&
                                -mass * remarkable > known_.mass;
        const bool turned = c_.command_per_acceleration < -sure_of_a_sign * c_.spread && c_.share > least_share;
        if (turned && (right_size || !mass_is_known()))
            refuse(fmt::format(
                "the command drives against the acceleration ({:.3g} {} per {}/s^2): the sign of {} or "
                "of {} is turned; give one of them a negative scale",
                c_.command_per_acceleration, a_.command_unit, m_, column("pos", m_), command_column()));
        if (mass_is_known() && mass > 0 && c_.share > least_share) against_the_mass(mass / known_.mass);
    }

    /// What is to be reported of the units.
    std::vector<std::string> notes() const {
        if (!(c_.travel > 0))
            return {fmt::format("axis {}: does not move: its units cannot be checked", a_.name)};
        std::vector<std::string> out{
            fmt::format("axis {}: travel {:.4g} {}, peak {:.3g} {}/s and {:.3g} {}/s^2, below "
                        "{:.3g} Hz",
                        a_.name, c_.travel, m_, c_.peak_speed, m_, c_.peak_acceleration, m_, c_.corner_Hz)};
        if (a_.command_unit.empty() || is_set_point(a_.command_unit)) return out;
        if (!c_.sign_is_known()) {
            out.push_back(fmt::format(
                "axis {}: the acceleration shows too little in the command to check its sign and size by it",
                a_.name));
            return out;
        }
        const double mass = c_.command_per_acceleration * constant_;
        out.push_back(fmt::format(
            "axis {}: the command grows by {:.3g} {} per {}/s^2{}", a_.name, c_.command_per_acceleration,
            a_.command_unit, m_,
            constant_ > 0 ? fmt::format(": a moving {} of {:.3g}", text_of("mass", a_.kind), mass) : ""));
        return out;
    }

private:
    static constexpr double least_share = 0.1; ///< of the variance, before a size says anything

    bool mass_is_known() const { return known_.mass > 0 && constant_ > 0; }
    std::string column(std::string_view what, std::string_view unit) const {
        return fmt::format("{}_{}_{}", a_.name, what, unit);
    }
    std::string command_column() const {
        const bool measured = a_.command_is == command_origin::measured;
        return column(!measured ? "cmd" : a_.command_unit == "A" ? "current" : "torque", a_.command_unit);
    }
    [[noreturn]] void refuse(const std::string& message) const {
        throw bad_input(file_, fmt::format("axis {}: {}", a_.name, message));
    }
    void against_the_reference() const {
        const double ratio = c_.position_per_reference;
        if (std::abs(ratio) > slip_of_a_unit || std::abs(ratio) < 1 / slip_of_a_unit)
            refuse(fmt::format(
                "the position moves {} the distance of the reference: {} or {} is in another unit (mm in a "
                "column of m: times 0.001); scale it",
                times(std::abs(ratio)), column("pos", m_), column("ref", m_)));
        if (ratio < -1 / remarkable)
            refuse(fmt::format(
                "the position moves against the reference ({:.3g} times it): the sign of {} or of {} is "
                "turned; give one of them a negative scale",
                ratio, column("pos", m_), column("ref", m_)));
    }
    /// Two readings of one motion: a filter takes some per cent of the one, a unit or the period much more.
    void against_the_position() const {
        const double ratio = c_.velocity_per_position;
        if (ratio < 0)
            refuse(
                fmt::format("the velocity goes against the position: the sign of {} or of {} is turned; give "
                            "one of them a negative scale",
                            column("vel", m_ + "_per_s"), column("pos", m_)));
        if (ratio < remarkable && ratio > 1 / remarkable) return;
        refuse(fmt::format(
            "the velocity is {} what the position makes of itself: {} is in another unit (degrees "
            "in a column of rad: 57 times), or the time is (a period that is too short or too long)",
            times(ratio), column("vel", m_ + "_per_s")));
    }
    /// Friction takes work. A command whose part that follows speed and direction gives work instead is turned.
    void against_the_motion() const {
        if (c_.friction > -sure_of_a_sign * c_.friction_spread || c_.friction_share < least_share) return;
        refuse(fmt::format(
            "the command pushes against the motion ({:.3g} {} on average while the axis moves), and friction "
            "cannot: the sign of {} or of {} is turned; give one of them a negative scale (or something else "
            "moves the axis, a hand or another drive: then the log says nothing of its friction)",
            c_.friction, a_.command_unit, column("pos", m_), command_column()));
    }
    /// Noise of the acceleration makes the slope of the command over it too small. The other slope is an upper
    /// bound of the same number. Only where both are off by a unit it is one.
    void against_the_mass(double ratio) const {
        if (ratio < slip_of_a_unit && ratio / c_.share_of_left > 1 / slip_of_a_unit) return;
        refuse(fmt::format(
            "the command moves {} the {} of {:g}: check the units of {} ({}), of {} ({}), and of {}",
            times(ratio), text_of("mass", a_.kind), known_.mass, column("pos", m_),
            ratio < 1 ? "mm in it make 1/1000" : "km in it make 1000", command_column(),
            ratio < 1 ? "kV in it make 1/1000" : "mV in it make 1000 times",
            text_of("mass and force constant", a_.kind)));
    }

    const axis_log& a_;
    unit_check c_;
    const std::string& file_;
    known_axis known_;
    std::string m_;
    double constant_; ///< force per unit of the command; 0: not known
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL void check_physics(imported_log& in, const known_axis& known) {
    for (const axis_log& a : in.log.axes) {
        const detail::axis_physics physics(a, in.log.sample_period_s, in.log.file, known);
        physics.refuse_what_cannot_be();
        for (const auto& note : physics.notes()) in.notes.push_back(note);
    }
}

QUADRANT_DIAGNOSIS_DECL void check_physics(const machine_description& machine, const machine_log& log) {
    for (const axis_description& axis : machine.axes)
        for (const axis_log& a : log.axes)
            if (a.name == axis.name && !a.still && !axis.positions_only)
                detail::axis_physics(a, log.sample_period_s, log.file,
                                     {axis.plant.mass_kg, axis.plant.force_constant_N_per_V, axis.drive.kind})
                    .refuse_what_cannot_be();
}

} // namespace quadrant::inline v0::diagnosis
