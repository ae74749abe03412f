// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What carries the motor's motion to the load.
enum class transmission_kind { screw, belt, gear };
inline constexpr std::array<std::string_view, 3> transmission_kinds{"screw", "belt", "gear"};

/// The word of a machine file for it.
constexpr std::string_view name_of(transmission_kind k) {
    return transmission_kinds[static_cast<std::size_t>(k)];
}

/// Between the motor and the load: position of the load = position of the motor in units of the load, its
/// errors added, less play and wind-up.
struct transmission_description {
    std::optional<transmission_kind> kind;
    std::optional<double> travel_per_turn_m; ///< of the load
    std::optional<double>
        counted_per_turn_m; ///< with which asked or counted positions were made; absent: the same
    std::optional<double> stiffness_N_per_m; ///< absent: rigid
    std::optional<double> damping_N_s_per_m;
    std::optional<double> backlash_m;
    std::optional<double> pitch_period_m; ///< absent: the travel of a turn
    std::vector<double> pitch_error_m, pitch_phase_rad;
    /// Legendre polynomials of order 2 on, between two places of the travel.
    std::vector<double> travel_error_m;
    std::optional<double> travel_error_from_m, travel_error_to_m;
    std::optional<double> motor_coulomb_N; ///< friction on the motor's side, in units of the load
    std::optional<double> motor_mass_kg;   ///< the part of the mass on the motor's side

    /// Units of the load for one of the motor's reading: "rad" of its turn, or "m" as it was counted; empty:
    /// not described.
    std::optional<double> to_load(std::string_view motor_unit) const {
        if (motor_unit == "rad" && !travel_per_turn_m) return {};
        if (motor_unit == "rad") return *travel_per_turn_m / (2 * std::numbers::pi);
        return counted_per_turn_m && travel_per_turn_m ? *travel_per_turn_m / *counted_per_turn_m : 1;
    }

    bool operator==(const transmission_description&) const = default;
};

/// The encoder on the motor, beside that on the load.
struct motor_encoder_description {
    std::optional<double> resolution_rad; ///< of the motor's turn
    std::optional<double> resolution_m;   ///< in units of the load

    bool operator==(const motor_encoder_description&) const = default;
};

} // namespace quadrant::inline v0::diagnosis
