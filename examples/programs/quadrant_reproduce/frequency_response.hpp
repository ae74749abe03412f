// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "thesis.hpp"
#include "white_noise.hpp"

#include <quadrant/analysis/fit_plant.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <cstddef>

/// How [Jamaludin2008] section 2.3 measures an axis: white noise at the amplifier, encoder out, H1 under a Hann
/// window.
namespace thesis {

inline constexpr double frf_minutes = 5;
inline constexpr std::size_t frf_window = 2048;

/// The linear axis of eq. (2.2).
struct linear_plant {
    using friction = coulomb_viscous<>;
    static friction::parameters of(const axis& a, per_second pole) { return {.viscous = pole * (a.kf / a.B)}; }
};
/// Eq. (2.2) with another pole, and GMS friction beside it: Fig. 4.2.
struct gms_beside {
    using friction = maxwell_slip<4>;
    static friction::parameters of(const axis& a, per_second pole) {
        auto p = gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0));
        p.curve.viscous += pole * (a.kf / a.B);
        return p;
    }
};

/// A motor by itself, with its encoder. Tests put an axis of an `xy_table` in its place: the loop is open here,
/// and of an `xy_loop` only the table is left.
template <class Friction> class driven_motor {
public:
    using motor = linear_motor<Friction>;
    driven_motor(const typename motor::parameters& p, quantity<si::length> encoder)
        : motor_(p, period), encoder_({encoder}, period) {}
    quantity<si::length> operator()(quantity_of<signal::voltage> u) {
        motor_(u);
        return encoder_(motor_.now().x);
    }

private:
    motor motor_;
    quantizer<signal::position> encoder_;
};

/// The frequency response of a simulated axis under white noise of so many volts rms. The hold is half a period
/// of Td.
template <class Plant, template <class> class Driven = driven_motor>
analysis::measured_frf measured_response(const axis& a, per_second pole, double rms,
                                         double minutes = frf_minutes) {
    Driven<typename Plant::friction> motor({.mass = a.kf / a.B,
                                            .force_constant = a.kf,
                                            .friction = Plant::of(a, pole),
                                            .delay = a.delay - 0.5 * period,
                                            .substeps = 5},
                                           250_nm);
    analysis::frf<signal::voltage, signal::position> estimate(
        {.samples = frf_window, .remove = analysis::trend::line}, period);
    white_noise noise(1);
    const auto samples = static_cast<long>(60 * minutes / period.value());
    quantity<si::length> reading{};
    for (long k = 0; k < samples; ++k) {
        const auto u = rms * noise() * 1_V;
        estimate.add(u, reading); // the reading at the moment at which u goes out
        reading = motor(u);
    }
    return estimate.result();
}

/// Eq. (2.2) fitted to it.
inline analysis::plant_fit<> fitted(const analysis::measured_frf& frf) {
    return analysis::fit_plant<>(frf, {.from = 3_Hz, .to = 200_Hz});
}

/// The procedure of section 4.2.1: the pole beside GMS with which the fitted response has the pole A of the
/// original. By the secant from A and from zero; friction makes the response depend on how large the noise is.
inline double pole_beside_gms(const axis& a, double rms, double minutes = 1) {
    const auto excess = [&](double pole) {
        return fitted(measured_response<gms_beside>(a, pole * 1_per_s, rms, minutes)).pole.value.value() -
               a.A.value();
    };
    double before = 0, off_before = excess(0), now = -off_before, off = 0;
    if (off_before > 0) return -off_before; // friction alone damps more than A: below zero, to first order
    for (int step = 0; step < 6; ++step) {
        off = excess(now);
        if (std::abs(off) < 0.02 || off == off_before) break;
        const double next = now - off * (now - before) / (off - off_before);
        before = now, off_before = off, now = std::max(0.0, next);
    }
    return now;
}

} // namespace thesis
