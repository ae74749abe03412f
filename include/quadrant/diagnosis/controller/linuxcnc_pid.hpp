// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../control/linuxcnc_pid.hpp"
#include "kind.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// LinuxCNC's component on a log in metres: its pins count in units of the machine.
struct linuxcnc_loop {
    quadrant::linuxcnc_pid<> law;
    double units; ///< a metre has
    output_stage out;

    double step(double reference, double measured) {
        return out(
            law(in_si(units * reference), quantity_of<signal::position>(in_si(units * measured))).value());
    }
    void settle(const loop_start& row) {
        law.settle({in_si(units * row.reference), in_si(units * row.measured),
                    in_si(units * row.reference_velocity), in_si(units * row.measured_velocity),
                    in_si(row.command)});
    }
    bool remembers() const { return law.given().igain.value() != 0; }
    bool limited() const { return law.limited(); }
    bool faulted() const { return law.faulted(); }
};

} // namespace detail

namespace controllers {

namespace pin {
/// A pin that limits, with 0 for none: where it is none, the search has no size to begin with.
constexpr controller_key limit(std::string_view name, std::string_view says) {
    return {.name = name, .says = says, .rule = detail::rule::not_negative, .scale = 0};
}
/// A gain of a pin.
constexpr controller_key gain(std::string_view name, std::string_view says, std::string_view unit) {
    return {.name = name, .says = says, .of_unit = unit};
}
} // namespace pin

inline constexpr std::array<controller_key, 18> linuxcnc_pid_keys{{
    {.name = "units_per_m",
     .says = "machine units of the pins in a metre: 1000 for millimetres",
     .rule = detail::rule::positive,
     .otherwise = 1,
     .searched = false},
    {.name = "Pgain", .says = "P, of the error", .needed = true},
    {.name = "Igain", .says = "I, of the error", .scale_of = "Pgain"},
    pin::gain("Dgain", "D, of the error", "V_s_per_m"),
    pin::gain("FF0", "times the command", "V_per_m"),
    pin::gain("FF1", "times its first derivative", "V_s_per_m"),
    pin::gain("FF2", "times its second derivative", "V_s2_per_m"),
    pin::gain("FF3", "times its third derivative", "V_s3_per_m"),
    pin::gain("bias", "added to the output", "V"),
    pin::limit("deadband", "error that is ignored"),
    pin::limit("maxerror", "limit of the error"),
    pin::limit("maxerrorI", "limit of its integral"),
    pin::limit("maxerrorD", "limit of its derivative"),
    pin::limit("maxcmdD", "limit of the command's first derivative"),
    pin::limit("maxcmdDD", "limit of its second derivative"),
    pin::limit("maxcmdDDD", "limit of its third derivative"),
    pin::limit("maxoutput", "limit of the output"),
    {.name = "error-previous-target",
     .says = "the error is against the command of the sample before; absent: true, as in the component",
     .otherwise = 1,
     .form = key_form::yes_no},
}};

/// LinuxCNC's component `pid`; keys are the names of its pins, values in machine units.
inline constexpr controller_kind linuxcnc_pid{
    .name = "linuxcnc_pid",
    .label = "LinuxCNC's pid",
    .law = "block `linuxcnc_pid`",
    .keys = linuxcnc_pid_keys,
    .make = [](const given_values& v, const actuator_description& a,
               double period) -> std::unique_ptr<running_controller> {
        quadrant::linuxcnc_pid<> law({.pgain = in_si(v["Pgain"]),
                                      .igain = in_si(v["Igain"]),
                                      .dgain = in_si(v["Dgain"]),
                                      .ff0 = in_si(v["FF0"]),
                                      .ff1 = in_si(v["FF1"]),
                                      .ff2 = in_si(v["FF2"]),
                                      .ff3 = in_si(v["FF3"]),
                                      .bias = in_si(v["bias"]),
                                      .deadband = in_si(v["deadband"]),
                                      .maxerror = in_si(v["maxerror"]),
                                      .maxerror_i = in_si(v["maxerrorI"]),
                                      .maxerror_d = in_si(v["maxerrorD"]),
                                      .maxcmd_d = in_si(v["maxcmdD"]),
                                      .maxcmd_dd = in_si(v["maxcmdDD"]),
                                      .maxcmd_ddd = in_si(v["maxcmdDDD"]),
                                      .maxoutput = in_si(v["maxoutput"]),
                                      .error_previous_target = v["error-previous-target"] != 0},
                                     duration::from_value(period));
        return std::make_unique<detail::positions_only<detail::linuxcnc_loop>>(
            detail::linuxcnc_loop{law, v["units_per_m"], detail::stage_of(a)});
    },
    .viscous = {"FF1", "units_per_m"},
    .acceleration = {"FF2", "units_per_m"},
    .constant = {"bias"},
    .position = {"FF0", "units_per_m"},
    .dead_band = "deadband",
    .length_unit = "units_per_m"};

} // namespace controllers
} // namespace quadrant::inline v0::diagnosis
