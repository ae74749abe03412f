// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../row.hpp"
#include "../virtual_cnc.hpp"

#include <array>
#include <vector>

namespace quadrant_reproduce {

/// Eqs. (7), (8), (10), Fig. 4: what a quantizer leaves of a ramp whose steps are no multiple of its own.
template <quadrant::signal_tag Signal> struct quantized_ramp {
    static constexpr int samples = 100'000, bins = 20;
    double variance = 0;              ///< in the unit of the signal, squared
    std::array<double, bins> share{}; ///< of the samples, from -step/2 to step/2

    explicit quantized_ramp(double step) {
        using value = quadrant::quantity_of<Signal>;
        quadrant::quantizer<Signal> round({value::from_value(step)}, vcnc::period);
        for (int k = 0; k < samples; ++k) {
            const double exact = step * 0.6180339887498949 * k,
                         error = round(value::from_value(exact)).value() - exact;
            variance += error * error / samples;
            const int bin = int(std::floor((error / step + 0.5) * bins));
            share[std::size_t(std::clamp(bin, 0, bins - 1))] += 1.0 / samples;
        }
    }
};

/// Figs. 4 to 6: the D/A converter, encoder and tachometer, guideway friction and backlash, each by its block.
inline outcome vcnc_parts_case(const std::string& id) {
    using namespace quadrant;
    using namespace quadrant::literals;
    const auto machine = vcnc::drive(vcnc::x_axis, 3_um);
    const quantized_ramp<signal::voltage> dac(vcnc::dac_step.value());
    const quantized_ramp<signal::position> encoder(machine.encoder_step.value());
    white_noise<signal::velocity> tachometer({machine.tachometer_noise, 1}, vcnc::period);
    const double radius = machine.drive.pitch.value() / (2 * std::numbers::pi);
    double noise = 0;
    constexpr int samples = 100'000;
    for (int k = 0; k < samples; ++k) {
        const double w = tachometer().value() / radius;
        noise += w * w / samples;
    }
    outcome out;
    out.rows = {
        {id, "dac_variance", "V2", dac.variance, {}, {}, {}, "of what rounding adds to a ramp, eq. (8)"},
        {id, "encoder_variance", "mm2", 1e6 * encoder.variance, {}, {}, {}, "the same, eq. (10)"},
        {id, "tachometer_variance", "(rad/s)2", noise, {}, {}, {}, "of 100 000 samples at rest, eq. (11)"}};
    line shares{.name = "D/A converter", .x = {}, .y = {}};
    for (std::size_t i = 0; i < dac.share.size(); ++i) {
        const double width = 1.0 / double(dac.share.size());
        for (const double edge : {0.0, 1.0}) {
            shares.x.push_back((double(i) + edge) * width - 0.5);
            shares.y.push_back(dac.share[i] / width);
        }
    }
    picture drawn{
        "Rounding, friction and backlash of the Virtual CNC",
        "Top: how often rounding adds how much, in steps of the D/A converter. Middle: friction at the "
        "motor, viscous part apart. Below: the table behind a backlash of 3 um, over its nut.",
        {panel{.x_label = "error [steps]",
               .y_label = "density [1/step]",
               .lines = {std::move(shares)},
               .y_range = std::pair{0.0, 1.5}},
         panel{.x_label = "speed of the motor [rad/s]", .y_label = "friction [N m]", .lines = {}},
         panel{.x_label = "nut [um]", .y_label = "table [um]", .lines = {}}}};
    for (const vcnc::axis* a : {&vcnc::x_axis, &vcnc::y_axis}) {
        asymmetric_stribeck<> friction(vcnc::drive(*a).drive.friction, vcnc::period);
        line curve{.name = std::string("axis ") + a->name, .x = {}, .y = {}};
        for (int k = -400; k <= 400; ++k) {
            const double w = 0.1 * (k == 0 ? -1e-9 : k);
            curve.x.push_back(w), curve.y.push_back(friction(w * 1_radps).value());
        }
        drawn.panels[1].lines.push_back(std::move(curve));
    }
    backlash<signal::position> play({machine.backlash}, vcnc::period);
    line loop{.name = "both ways", .x = {}, .y = {}};
    for (int k = 0; k <= 250; ++k) {
        const double nut = 10 * std::sin(2 * std::numbers::pi * k / 200.0);
        loop.x.push_back(nut), loop.y.push_back(1e6 * play(nut * 1_um).value());
    }
    drawn.panels[2].lines.push_back(std::move(loop));
    out.pictures = {std::move(drawn)};
    return out;
}

inline experiment vcnc_parts() {
    const std::string id = "vcnc.parts";
    return {
        "The parts of the Virtual CNC's feed drive",
        "[Yeung2006] section 2.1, eqs. (6-18), Figs. 4 to 6, Table 8",
        "Each by itself: a ramp through the D/A converter and the encoder, the tachometer at rest, guideway "
        "friction over speed in both directions, the table behind its backlash.",
        0.02,
        {{id, [=] { return vcnc_parts_case(id); }}}};
}

} // namespace quadrant_reproduce
