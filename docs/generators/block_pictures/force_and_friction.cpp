// SPDX-License-Identifier: BSL-1.0
// What an acceleration sensor shows of a force, and its calibration; friction that is learned.
#include "families.hpp"
#include "quadrant_reproduce/friction_run.hpp"

#include <quadrant/analysis/ferraris_calibration.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/observer/ferraris_force_estimator.hpp>
#include <quadrant/observer/lugre_observer.hpp>
#include <quadrant/observer/maxwell_slip_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>
#include <quadrant/sensor/white_noise.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

picture draw_ferraris_force_estimator() {
    const auto& a = thesis::y;
    const auto mass = a.kf / a.B;
    const auto with = [&](const char* name, frequency corner) {
        ferraris_force_estimator<s::voltage> b{{.mass = mass, .force_constant = a.kf, .corner = corner}, T};
        linear_motor<> plant{{.mass = mass, .force_constant = a.kf}, T}; // free: no friction to tell
        curve c(name);
        double was = 0;
        for (int k = 0; k < 160; ++k) {
            const double t = 0.5 * k, v = plant.now().v.value();
            c.add(t, b((v - was) / T.value() * 1_mps2, 0_V).value());
            was = v;
            plant(0_V, (t < 10 ? 0 : t < 40 ? 100 : 100 + 60 * std::sin(2 * pi * 50e-3 * (t - 40))) * 1_N);
        }
        return c;
    };
    curve truth("force", dashed);
    for (int k = 0; k < 160; ++k) {
        const double t = 0.5 * k;
        truth.hold(t, 0.5, t < 10 ? 0 : t < 40 ? 100 : 100 + 60 * std::sin(2 * pi * 50e-3 * (t - 40)));
    }
    return of(
        "A step of 100 N and a sine of 50 Hz on a free mass, and the force from its acceleration with two "
        "corners",
        {over("time [ms]", "force [N]", {with("corner 90 Hz", 90_Hz), with("corner 300 Hz", 300_Hz), truth})});
}
picture draw_ferraris_calibration() {
    constexpr double gain_of_sensor = 32.98, offset = -8580e-6; // [Jamaludin2008] Appendix B
    std::vector<quantity<si::length>> positions;
    std::vector<quantity<si::electric_potential>> sensor;
    white_noise<s::voltage> noise{{1e-4 * 1_V, 5}, T};
    quantizer<s::position> encoder{{0.25_um}, T};
    curve raw("sensor"), truth("axis", dashed), calibrated("gain times sensor plus offset");
    std::vector<double> acceleration;
    for (int k = 0; k < 8000; ++k) {
        const double t = 5e-4 * k;
        const auto wave = [&](double size, double f) { return size * std::sin(2 * pi * f * t); };
        acceleration.push_back(-std::pow(pi, 2) * wave(5e-3, 0.5) - std::pow(8 * pi, 2) * wave(1e-3, 4));
        positions.push_back(encoder((wave(5e-3, 0.5) + wave(1e-3, 4)) * 1_m));
        sensor.push_back((acceleration.back() - offset) / gain_of_sensor * 1_V + noise());
    }
    const auto found = analysis::calibrate_ferraris(positions, sensor, T);
    for (std::size_t k = 0; k < 2000; ++k) {
        const double t = 0.5 * double(k);
        raw.add(t, 1e3 * sensor[k].value());
        truth.add(t, acceleration[k]);
        calibrated.add(t, (found.gain * sensor[k] + found.offset).value());
    }
    return of("Voltage of an acceleration sensor along a motion of 0.5 and 4 Hz, and the acceleration that its "
              "calibration makes of it",
              {over("", "sensor [mV]", {raw}), over("time [ms]", "acceleration [m/s^2]", {calibrated, truth})});
}
picture draw_lugre_observer() {
    const lugre<>::parameters believed{{8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1.5e6 * 1_N / 1_m};
    lugre_observer<s::force> learns{{believed, 20.0 / 1_s}, T}, model{{believed, 0.0 / 1_s}, T};
    curve v("reference velocity"), with("correction 20 /s"), without("correction 0: the model alone"),
        e("behind");
    for (int k = 0; k < 400;
         ++k) { // rests 10 um behind from 50 ms on, moves on at 120 ms, and is there from 150 ms on
        const double t = 0.5 * k, speed = t < 120 ? 0 : 2e-3, behind = t < 50 || t > 150 ? 0 : 10e-6;
        v.add(t, 1e3 * speed), e.add(t, 1e6 * behind);
        with.add(t, learns(speed * 1_mps, behind * 1_m).value());
        without.add(t, model(speed * 1_mps, behind * 1_m).value());
    }
    return of("Friction by a LuGre observer on an axis that stays 10 um behind from 50 to 150 ms and is sent "
              "on at 120 ms",
              {over("", "behind [um]", {e}), over("", "speed [mm/s]", {v}),
               over("time [ms]", "force [N]", {with, without})});
}
picture draw_maxwell_slip_observer() {
    const thesis::reading how{.substeps = 10, .cycles = 4, .level = 4.0 / 3};
    curve table("model of the table"), learned("level learned"), level("level"),
        truth("of the machine", dashed);
    int k = 0;
    const auto shows = [&k](const thesis::moment& m) { // every glitch, and now and then what lies between
        return m.turns >= 1 && (k++ % 20 == 0 || std::abs(m.error) > 0.5);
    };
    thesis::run<thesis::gms_model, thesis::observer>(thesis::y, how, [&](const thesis::moment& m) {
        if (shows(m)) table.add(m.time, m.error);
    });
    thesis::run<thesis::learning_model, thesis::observer>(thesis::y, how, [&](const thesis::moment& m) {
        if (!shows(m)) return;
        learned.add(m.time, m.error);
        if (k % 20 == 1) level.add(m.time, m.level), truth.add(m.time, how.level);
    });
    return of(
        "Axis y of the milling table with a third more friction than its table, along a sinusoid of 30 mm at "
        "100 mm/s, with observer",
        {over("", "tracking error [um]", {table, learned}), over("time [s]", "level", {level, truth})});
}
} // namespace

family force_and_friction() {
    return {{"ferraris_force_estimator", draw_ferraris_force_estimator},
            {"ferraris_calibration", draw_ferraris_calibration},
            {"lugre_observer", draw_lugre_observer},
            {"maxwell_slip_observer", draw_maxwell_slip_observer}};
}
} // namespace block_pictures
