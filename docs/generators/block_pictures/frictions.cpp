// SPDX-License-Identifier: BSL-1.0
// Friction: force over velocity where the law knows the velocity alone, over the displacement where it
// remembers.
#include "families.hpp"

#include <quadrant/friction/asymmetric_stribeck.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stribeck.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
const stribeck<>::parameters thesis_x{122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps};

/// Force over velocity, with a gap where the law jumps.
template <class Law> line over_velocity(const char* name, Law law, double most, double scale) {
    curve c(name);
    for (int i = -1000; i <= 1000; ++i) {
        const double v = most * std::pow(std::abs(i) / 1000.0, 2) * (i < 0 ? -1 : 1);
        if (i == 0)
            c.add(0, std::nan(""));
        else
            c.add(scale * v, law(Law::argument::from_value(v)).value());
    }
    return c;
}
picture draw_coulomb_viscous() {
    return of("Force over velocity of Coulomb and viscous friction, 122 N and 850 N s/m",
              {over("velocity [mm/s]", "force [N]",
                    {over_velocity("", coulomb_viscous<>{{122_N, 850_N / 1_mps}, T}, 0.1, 1e3)})});
}
picture draw_stribeck() {
    const stribeck<> b{thesis_x, T};
    return of("Force over velocity of the thesis' x axis, to 100 mm/s and to 10 mm/s",
              {over("velocity [mm/s]", "force [N]", {over_velocity("", b, 0.1, 1e3)}),
               over("velocity [mm/s]", "force [N]", {over_velocity("", b, 0.01, 1e3)})});
}
picture draw_asymmetric_stribeck() {
    const asymmetric_stribeck<> b{
        {{2.6256_Nm, 2.1529_Nm, 3.9_radps, 4.2_radps}, {1.9_Nm, 1.5_Nm, 3.5_radps, 3.6_radps}, {}}, T};
    return of("Torque over speed of a screw with other levels forward and backward",
              {over("speed [rad/s]", "torque [N m]", {over_velocity("", b, 40, 1)})});
}

/// Force over the displacement along places that are visited one after another, at an even speed.
template <class Law>
line over_way(const char* name, Law law, std::initializer_list<double> micrometres, double speed) {
    curve c(name);
    const double step = speed * T.value() * 1e6;
    double x = 0;
    c.add(0, 0);
    for (const double end : micrometres) {
        const double way = end - x;
        const int steps = int(std::lround(std::abs(way) / step));
        const double start = x, v = (way < 0 ? -1 : 1) * speed;
        for (int i = 1; i <= steps; ++i) {
            x = start + way * i / steps;
            c.add(x, law(v * 1_mps).value());
        }
    }
    return c;
}
picture draw_dahl() {
    const dahl<> b{{122_N, 60e6 * 1_N / 1_m}, T};
    return of(
        "Force over displacement of Dahl friction, 122 N and 60 N/um: there and back over 10 um, with a small "
        "loop inside",
        {over("position [um]", "force [N]", {over_way("", b, {10, 0, 3, 2, 10}, 20e-6)})});
}
picture draw_lugre() {
    const lugre<>::parameters p{{8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1.5e6 * 1_N / 1_m};
    lugre<> fast{{p.curve, p.stiffness, 300_N / 1_mps, 10_mmps}, T};
    curve up("faster"), down("slower");
    for (int k = -400; k <= 400; ++k) { // 5 Hz between 0 and 20 mm/s
        const double v = 0.02 * 0.5 * (1 - std::cos(2 * std::numbers::pi * k / 400.0)),
                     force = fast(v * 1_mps).value();
        if (k >= 0) (k <= 200 ? up : down).add(1e3 * v, force);
    }
    return of("LuGre friction: force over displacement with a small loop inside, and over a velocity that "
              "rises and falls",
              {over("position [um]", "force [N]", {over_way("", lugre<>{p, T}, {20, 0, 6, 3, 20}, 50e-6)}),
               over("velocity [mm/s]", "force [N]", {up, down})});
}
picture draw_maxwell_slip() {
    const maxwell_slip<4> b{
        {.curve = thesis_x,
         .weights = {},
         .forces = {40_N, 50_N, 41_N, 42_N},
         .stiffness = {60e6 * 1_N / 1_m, 15e6 * 1_N / 1_m, 5e6 * 1_N / 1_m, 1.5e6 * 1_N / 1_m},
         .attraction = 450_N / 1_s},
        T};
    return of("Force over displacement of four Maxwell slip elements: there and back over 40 um, with a small "
              "loop inside",
              {over("position [um]", "force [N]", {over_way("", b, {40, 0, 12, 8, 40}, 20e-6)})});
}
} // namespace

family frictions() {
    return {{"coulomb_viscous", draw_coulomb_viscous},
            {"stribeck", draw_stribeck},
            {"asymmetric_stribeck", draw_asymmetric_stribeck},
            {"dahl", draw_dahl},
            {"lugre", draw_lugre},
            {"maxwell_slip", draw_maxwell_slip}};
}
} // namespace block_pictures
