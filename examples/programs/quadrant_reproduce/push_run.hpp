// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "observer_slots.hpp"
#include "one_axis.hpp"

#include <complex>
#include <vector>

/// The y axis pushed by some harmonics of the cutter while an observer takes them off: [Jamaludin2008] sections
/// 5.2 and 5.3, Appendices C and D.
namespace thesis {

/// What is done to the axis.
struct push {
    int harmonics = 15; ///< of Table 3.6
    bool tracking =
        false; ///< along the sinusoid of 30 mm at 100 mm/s on GMS friction, or at rest on the linear plant
    double scale = 1.38;                            ///< times milling_harmonics::scale, as in the cuts
    double seconds = 4;                             ///< at rest; the second half counts
    std::vector<std::pair<double, double>> sines{}; ///< instead of the table: hertz and newtons
};
struct push_result {
    double rms = 0, first = 0; ///< of the error, and the amplitude of its first harmonic [um]
    bool diverged = false;
    std::vector<double> time{}, error{}, force{}; ///< [s], [um], [N]; of all samples
};

namespace detail {
/// The force of a push, sample by sample [N].
class pushing {
public:
    explicit pushing(const push& p)
        : sines_(p.sines),
          cutter_({milling_harmonics::fundamental, p.scale * milling_harmonics::scale, cut(p.harmonics)},
                  period) {}
    quantity_of<signal::force> at(double t) {
        if (sines_.empty()) return cutter_();
        double sum = 0;
        for (const auto& [hertz, newtons] : sines_) sum += newtons * std::sin(2 * pi_ * hertz * t);
        return sum * 1_N;
    }

private:
    static harmonic_table<15> cut(int harmonics) {
        auto table = milling_harmonics::y;
        for (std::size_t i = std::size_t(harmonics); i < 15; ++i) table.real[i] = table.imaginary[i] = 0;
        return table;
    }
    std::vector<std::pair<double, double>> sines_;
    cutting_force<15> cutter_;
};
/// Runs the axis from 0 to `end`; from `counts` on it goes into the rms.
template <class Axis> push_result run_push(Axis axis, const push& p, double counts, double end) {
    pushing force(p);
    using motion = typename Axis::motion;
    const double amplitude = p.tracking ? 0.03 : 0, w = 0.1 / 0.03, T = period.value();
    push_result out;
    std::complex<double> sum = 0;
    double squares = 0, samples = 0;
    auto before = axis.now().v;
    for (long k = 0; double(k) * T < end; ++k) {
        const double t = double(k) * T;
        const motion r{amplitude * (1 - std::cos(w * t)) * 1_m, amplitude * w * std::sin(w * t) * 1_mps,
                       amplitude * w * w * std::cos(w * t) * 1_mps2};
        const double error = 1e6 * (r.position - axis.now().x).value();
        if (!(std::abs(error) < 2000) || axis.stopped()) return {.diverged = true};
        const auto pushes = force.at(t);
        out.time.push_back(t), out.error.push_back(error), out.force.push_back(pushes.value());
        if (t >= counts) {
            squares += error * error, samples += 1;
            sum += error * std::polar(1.0, -2 * pi_ * milling_harmonics::fundamental.value() * t);
        }
        axis.disturbance().sense((axis.now().v - before) / period);
        before = axis.now().v;
        axis.step(r, r, pushes);
    }
    out.rms = std::sqrt(squares / samples);
    out.first = 2 * std::abs(sum) / samples;
    return out;
}
} // namespace detail

/// At rest the plant is linear, as the thesis analyses it: pre-sliding friction would hold the table. While
/// tracking it is on GMS friction, which is fed forward.
template <class Slot, template <class, class> class Axis = one_axis>
push_result pushed(const push& p, typename Slot::parameters slot = {}) {
    const axis& a = slot.of;
    if (p.tracking) {
        using boxes = milling_axis_boxes<gms_model::box, Slot>;
        using motor = linear_motor<maxwell_slip<4>>;
        const quantity<si::mass> mass = a.kf / a.B;
        one_axis_parameters<boxes, motor> is{
            controller_of<boxes>(a),
            {.mass = mass,
             .force_constant = a.kf,
             .friction = gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0)),
             .delay = 0.4_ms,
             .substeps = 10},
            250_nm};
        is.controller.friction = gms_model::of(a);
        slot.of.A = a.A_gms; // beside GMS friction
        is.controller.disturbance = slot;
        is.motor.friction.curve.viscous += a.A_gms * mass;
        const double cycle = 2 * pi_ * 0.03 / 0.1;
        return detail::run_push(Axis<boxes, motor>(is), p, cycle, 2 * cycle);
    }
    using boxes = milling_axis_boxes<absent<signal::velocity, signal::voltage>, Slot>;
    using motor = linear_motor<coulomb_viscous<>>;
    one_axis_parameters<boxes, motor> is{controller_of<boxes>(a), linear_machine(a, 0.4_ms, 10), 250_nm};
    is.controller.plant_pole = a.A;
    is.controller.disturbance = slot;
    return detail::run_push(Axis<boxes, motor>(is), p, p.seconds / 2, p.seconds);
}

} // namespace thesis
