// SPDX-License-Identifier: BSL-1.0
// From a log to a compensation in the controller, and back to the machine:
//
//   machine --> log --> diagnose --> apply --> feedforward blocks --> forecast --> the same machine again
//
// The machine: a linear motor whose friction is bristles (LuGre) and whose magnets cog. The machine file knows
// its Coulomb level and nothing else of that; the diagnosis fits laws of its own (sticking contacts,
// harmonics), so that neither the forecast nor the feedforward shares a friction law with the machine.
// You should see: both causes named, and less than a third of the error left with them in the controller,
// inside what was forecast.
#include <quadrant/base/literals.hpp>
#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/axis_load.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration period = 1_ms;
using boxes = cascade_p_pi_boxes<>;
using motor = linear_motor<lugre<>, 32, double, axis_load<cogging_force<1>>>;

const boxes::parameters tuning{.position_gain = 70.0 / 1_s,
                               .velocity_gain = 40_V / 1_mps,
                               .velocity_integral = 300_V / 1_m,
                               .estimator = {.corner = 150_Hz},
                               .acceleration_feedforward = 340_kg / (1450_N / 1_V),
                               .viscous_feedforward = 850_N / 1_mps / (1450_N / 1_V),
                               .limit = 10_V};
const lugre<>::parameters bristles{
    .curve = {.coulomb = 120_N, .static_level = 180_N, .stribeck_velocity = 5_mmps, .viscous = 850_N / 1_mps},
    .stiffness = 300_N / 1_um,
    .damping = 2000_N / 1_mps};
const motor::parameters table{.mass = 343_kg,
                              .force_constant = 1450_N / 1_V,
                              .friction = bristles,
                              .delay = 0.4_ms,
                              .encoder_step = 250_nm,
                              .load = {.cogging = {.period = 24_mm, .size = {25_N}, .phase = {0.6}}}};

/// What the owner believes: the Coulomb level, nothing else of the friction, no cogging.
diagnosis::machine_description machine_file() {
    return diagnosis::read_machine(std::string_view(R"({
      "schema": "quadrant.machine/1", "sample_period_s": 0.001,
      "excluded_effects": ["backlash", "structural_resonance", "cutting_force", "cross_coupling"], "axes": {"x": {
        "plant": {"mass_kg": 340, "force_constant_N_per_V": 1450, "viscous_N_s_per_m": 850, "delay_s": 0.0004,
                  "coulomb_N": 122},
        "encoder": {"resolution_m": 2.5e-7}, "actuator": {"limit_V": 10},
        "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 70, "velocity_gain_V_s_per_m": 40,
          "velocity_integral_V_per_m": 300, "velocity_filter_Hz": 150, "velocity_feedforward": 1,
          "acceleration_feedforward_V_s2_per_m": 0.23448275862, "viscous_feedforward_V_s_per_m": 0.58620689655}}}})"),
                                   "machine");
}

/// A slow and a fast stroke of 80 mm, then reversals of 2 mm.
quantity<si::length> reference(double t) {
    const double turn = 6.283185307179586;
    const double slow = t < 2.5 ? 40 * (1 - std::cos(turn * t / 2.5)) : 0;
    const double fast = t > 2.6 && t < 3.6 ? 40 * (1 - std::cos(turn * (t - 2.6))) : 0;
    const double small = t > 3.7 ? 1.0 * (1 - std::cos(turn * 2 * (t - 3.7))) : 0;
    return (slow + fast + small) * 1_mm;
}

/// Runs the machine; `friction` and `cogging` are what is fed forward beside the cascade.
template <class Friction, class Cogging> diagnosis::machine_log run(Friction friction, Cogging cogging) {
    cascade<boxes> axis{.box = {tuning, period}};
    motor machine{table, period};
    diagnosis::axis_log x;
    x.name = "x";
    quantity<si::length> reading{};
    for (int k = 0; k < 5000; ++k) {
        const auto r = reference(k * period.value());
        auto u = axis(r, reading);
        u += friction(axis.wire.reference_velocity) + cogging(r);
        x.reference.push_back(r.value());
        x.position.push_back(reading.value());
        x.command.push_back(u.value());
        reading = machine(u);
    }
    diagnosis::machine_log log;
    log.sample_period_s = period.value();
    log.samples = x.position.size();
    log.axes.push_back(x);
    return log;
}
} // namespace

int main() {
    const auto nothing = [](auto) { return 0_V; };
    const auto log = run(nothing, nothing);
    const auto found = diagnosis::diagnose(machine_file(), log);
    for (const auto& cause : found.causes)
        std::printf("found: %s (%.0f %%)\n", cause.effect.c_str(), 100 * cause.probability);

    const auto forecast = diagnosis::compensate(machine_file(), found, log).axes[0];
    const diagnosis::compensation& both = forecast.compensations.back();
    std::printf("built: %s\n", both.block.c_str());

    const diagnosis::plant_model fitted(diagnosis::apply(machine_file(), found).axes[0], 2e-7);
    const auto again = run(diagnosis::level_block{level_parameters(fitted), period},
                           diagnosis::travel_block{cogging_parameters(fitted), period});
    const auto achieved = diagnosis::compensate(machine_file(), found, again).axes[0].measured;
    const auto row = [](const char* name, const diagnosis::tracking& t) {
        std::printf("%-9s %5.1f um rms (%.1f to %.1f)  %5.1f um at reversals\n", name, 1e6 * t.rms_m.value,
                    1e6 * t.rms_m.low, 1e6 * t.rms_m.high, 1e6 * t.glitch_m.value);
    };
    row("before", forecast.measured);
    row("forecast", both.after);
    row("achieved", achieved);
}
