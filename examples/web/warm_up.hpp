// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace quadrant_web {

/// Diagnoses a short record of an axis that lacks its Coulomb friction, and forgets it. A browser compiles what
/// runs often once more, and faster: with this done before a log is dropped, its first diagnosis takes seven
/// tenths of the time.
inline void warm_up() {
    using namespace quadrant::diagnosis;
    constexpr double period = 5e-4, mass = 20, viscous = 100, coulomb = 15, force_constant = 50;
    const auto machine = read_machine(
        R"({"schema": "quadrant.machine/1", "sample_period_s": 5e-4, "axes": {"x": {
            "plant": {"mass_kg": 20, "viscous_N_s_per_m": 100, "force_constant_N_per_V": 50, "delay_s": 2.5e-4},
            "encoder": {"resolution_m": 1e-7}, "actuator": {"limit_V": 10, "dac_bits": 16, "dac_range_V": 20},
            "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 100, "velocity_gain_V_s_per_m": 100,
                "velocity_integral_V_per_m": 1000, "velocity_filter_Hz": 200}}}})",
        "the warm-up");
    const auto log = [&](double slow, double fast) {
        std::string text = "t_s,x_ref_m,x_pos_m,x_cmd_V\n";
        for (int k = 0; k < 3000; ++k) {
            const double t = k * period;
            const double x = 0.02 * std::sin(slow * t) + 1e-3 * std::sin(fast * t),
                         v = 0.02 * slow * std::cos(slow * t) + 1e-3 * fast * std::cos(fast * t),
                         a = -0.02 * slow * slow * std::sin(slow * t) - 1e-3 * fast * fast * std::sin(fast * t);
            const double force = mass * a + viscous * v + coulomb * std::tanh(v / 1e-3);
            text += fmt::format("{:.4f},{:.7f},{:.7f},{:.5f}\n", t, x, x, force / force_constant);
        }
        return read_log_text(text, "the warm-up");
    };
    const machine_log one = log(9, 70), other = log(13, 50);
    (void)diagnose(machine, one, &other);
}

} // namespace quadrant_web
