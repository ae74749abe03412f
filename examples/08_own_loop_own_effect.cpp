// SPDX-License-Identifier: BSL-1.0
// The diagnosis as a library, with what it cannot know: a controller of your own and an effect of your own.
//
// The machine here is simulated by the code below. Its controller is a PID with a lead, no cascade. Somebody
// has turned its
// lead from 25 ms to 30 ms, and a way cover pulls on it with the square of its stretch: no list has either.
// You should see: the controller found by replay, with the number that corrects it; without the cover in the
// list no name is claimed for what is behind the command; with it the cover is named and its number found.
#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/effect/own_effect.hpp>
#include <quadrant/diagnosis/machine/own_controller.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

#include <cmath>
#include <cstdio>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.001;

/// u = gain (e + lead de/dt) + integral of e, the derivative behind 200 Hz. Plain doubles; quadrant's loops go
/// as well.
struct lead_pid {
    double gain, lead, integral, last = 0, slope = 0, sum = 0;
    double operator()(double reference, double measured) noexcept {
        const double e = reference - measured;
        slope += 0.715 * ((e - last) / period - slope);
        last = e;
        sum += integral * period * e;
        return gain * (e + lead * slope) + sum;
    }
    void settle(const loop_start& row) noexcept { // where a log begins
        last = row.reference - row.measured;
        slope = row.reference_velocity - row.measured_velocity;
        sum = row.command - gain * (last + lead * slope);
    }
};

/// The effect: its numbers, and the force that it makes of them. Force is where a law acts when it names no
/// other joint.
constexpr own_law way_cover{.name = "way_cover",
                            .exciting_motion = "strokes over the whole travel, slow and fast",
                            .numbers = {{{.key = "way_cover_N_per_m2", .low = 0, .high = 500000}}},
                            .law = [](const auto& now, const auto& number, auto&) {
                                return -number[0] * now.position * std::abs(now.position);
                            }};

double motion(double t) { // strokes that get faster, and three tones that shake the mass
    double x = 0.05 * (1 - std::cos(2 * M_PI * (0.3 * t + 0.12 * t * t)));
    for (const double f : {11, 17, 29}) x += 0.02 * t / (1 + t) * std::sin(2 * M_PI * f * t) / (f * f);
    return x;
}

/// The machine: 200 kg, 1000 N/V, 300 N s/m, 40 N of friction, and the cover. Twenty steps a period.
machine_log record(double seconds) {
    axis_log x;
    x.name = "x";
    lead_pid controller{.gain = 2500, .lead = 0.030, .integral = 20000};
    double position = 0, velocity = 0, bristle = 0, dither = 1;
    for (int k = 0; k < seconds / period; ++k) {
        dither = std::fmod(dither * 16807, 2147483647); // the encoder's last digit
        x.reference.push_back(motion(k * period));
        x.position.push_back(std::round((position + 2e-7 * (dither / 2147483647 - 0.5)) / 1e-7) * 1e-7);
        x.command.push_back(controller(x.reference.back(), x.position.back()));
        for (int i = 0; i < 20; ++i) {
            const double h = period / 20, before = bristle;
            bristle = std::clamp(bristle + velocity * h, -5e-7, 5e-7);
            const double friction = 300 * velocity + 40 * bristle / 5e-7 + 8e4 * (bristle - before) / h;
            const double cover = 30000 * position * std::abs(position);
            velocity += h * (1000 * x.command.back() - friction - cover) / 200;
            position += h * velocity;
        }
    }
    return {.file = "log", .sample_period_s = period, .samples = x.position.size(), .axes = {x}, .notes = {}};
}

/// What its simulation believes: a machine file, and the controller as code with the numbers that may be
/// others.
machine_description believed() {
    auto machine = read_machine(std::string_view(R"({
        "schema": "quadrant.machine/1", "sample_period_s": 0.001,
        "excluded_effects": ["cogging", "force_ripple", "encoder_cyclic_error", "cutting_force", "sample_loss"],
        "axes": {"x": {
            "plant": {"mass_kg": 202, "force_constant_N_per_V": 1000, "viscous_N_s_per_m": 290, "coulomb_N": 41},
            "tolerance": {"mass": 0.02, "force_constant": 0.01, "viscous": 0.1, "coulomb": 0.05},
            "encoder": {"resolution_m": 1e-7}, "controller": {"kind": "lead_pid"}}}})"),
                                "machine.json");
    const auto make = [](std::span<const double> n) { return lead_pid{n[0], n[1], n[2]}; };
    machine.axes[0].controller =
        own_controller({{"gain_V_per_m", 2500}, {"lead_s", 0.025}, {"integral_V_per_m_s", 20000}}, make);
    return machine;
}

void print(const char* title, const diagnosis_result& d) {
    std::printf("%s: %s\n", title, name_of(d.verdict));
    for (const cause& c : d.causes) {
        const bool claimed = c.probability >= 0.5;
        std::printf("  %s %s", claimed ? "cause" : "suspect, no claim:", c.effect.c_str());
        if (claimed) std::printf(", %s %.2g", c.parameters[0].key.c_str(), c.parameters[0].values[0].value);
        std::printf("\n");
    }
}

} // namespace

int main() {
    const auto log = record(6), other = record(3);
    auto machine = believed();
    print("with the list alone", diagnose(machine, log));
    machine.axes[0].own_effects = {own_effect<way_cover>};
    const auto found = diagnose(machine, log);
    print("with the way cover in it", found);

    const auto off_um = [&](const machine_description& m) {
        return 1e6 * simulate(m, other).axes[0].gap.position_rms_m;
    };
    std::printf("another log, simulated: %.0f um off before, %.1f um after\n", off_um(machine),
                off_um(apply(machine, found)));
}
