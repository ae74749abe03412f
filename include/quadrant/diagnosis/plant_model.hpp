// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace quadrant::diagnosis {

/// The plant that the diagnosis simulates: the described machine plus whatever the effects under trial join to it.
/// Boxes in the order of the loop; every member is neutral when its effect is absent. SI numbers.
struct plant_model {
    static constexpr std::size_t max_harmonics = 4;

    // actuator
    double delay = 0;          ///< [s]
    double force_constant = 0; ///< [N/V]
    // mechanics
    double mass = 0; ///< [kg]
    struct friction_box {
        double viscous_slope = 0;        ///< [N s/m]
        double coulomb = 0;              ///< [N]
        double excess = 0;               ///< static minus Coulomb level [N]
        double stribeck_velocity = 1;    ///< [m/s]
        double viscous_asymmetry = 0;    ///< relative, signed
        double coulomb_asymmetry = 0;    ///< relative, signed
        double presliding_length = 2e-7; ///< the contact's deflection at the Coulomb level [m]
    } friction;
    double constant_force = 0; ///< [N]
    struct cogging_box {
        double period = 0; ///< [m]; 0: none
        std::size_t harmonics = 0;
        std::array<double, max_harmonics> cosine{}, sine{}; ///< [N]
        /// sum of cosine_i cos(2 pi i x / period) + sine_i sin(2 pi i x / period)
        double force(double x) const {
            if (harmonics == 0) return 0;
            const double angle = 2 * std::numbers::pi * x / period, c1 = std::cos(angle), s1 = std::sin(angle);
            double c = c1, s = s1, sum = 0;
            for (std::size_t i = 0; i < harmonics; ++i) {
                sum += cosine[i] * c + sine[i] * s;
                const double next = c * c1 - s * s1; // angle addition: cheaper than another cosine
                s = s * c1 + c * s1;
                c = next;
            }
            return sum;
        }
    } cogging;

    explicit plant_model(const plant_description& d)
        : delay(d.delay_s), force_constant(d.force_constant_N_per_V), mass(d.mass_kg),
          constant_force(d.constant_force_N.value_or(0)) {
        friction.viscous_slope = d.viscous_N_s_per_m;
        friction.coulomb = d.coulomb_N.value_or(0);
        friction.excess = d.static_N ? *d.static_N - friction.coulomb : 0;
        friction.stribeck_velocity = d.stribeck_velocity_m_per_s.value_or(1);
        friction.viscous_asymmetry = d.viscous_asymmetry.value_or(0);
        friction.coulomb_asymmetry = d.coulomb_asymmetry.value_or(0);
        cogging.period = d.cogging_period_m.value_or(0);
        cogging.harmonics = std::min(d.cogging_N.size(), max_harmonics);
        for (std::size_t i = 0; i < cogging.harmonics; ++i) {
            const double phase = i < d.cogging_phase_rad.size() ? d.cogging_phase_rad[i] : 0;
            cogging.cosine[i] = d.cogging_N[i] * std::sin(phase); // N sin(angle + phase)
            cogging.sine[i] = d.cogging_N[i] * std::cos(phase);
        }
    }

    struct state {
        double x = 0, v = 0;
        bool slipping = false;
        double deflection = 0; ///< of the friction contact before it slips [m]
    };

    /// Advances the plant by steps of one length h under a constant command. Friction is taken implicitly, as in
    /// friction/stick_slip.hpp, but a contact at rest gives way like a spring until it breaks away: every real stick
    /// does, by a micrometre or so, and a model without it sees a gap in each reversal. What does not change between
    /// steps is worked out once: a diagnosis runs millions of them.
    class stepper {
    public:
        stepper(const plant_model& plant, double h) : plant_(plant), h_(h) {
            for (int i = 0; i < 2; ++i) {
                const double direction = i == 0 ? -1 : 1;
                side& d = side_[static_cast<std::size_t>(i)];
                d.level = plant.friction.coulomb * (1 + plant.friction.coulomb_asymmetry * direction);
                d.breakaway = d.level + plant.friction.excess;
                d.stiffness = d.breakaway / plant.friction.presliding_length;
                const double slope = plant.mass + h * plant.friction.viscous_slope *
                                                      (1 + plant.friction.viscous_asymmetry * direction);
                d.inverse_slip = 1 / slope;
                d.inverse_stick = 1 / (slope + d.stiffness * h * h);
                d.compliance = d.stiffness > 0 ? 1 / d.stiffness : 0;
            }
            inverse_stribeck_ = 1 / plant.friction.stribeck_velocity;
        }

        void operator()(state& s, double command) const {
            const double drive =
                plant_.force_constant * command + plant_.constant_force + plant_.cogging.force(s.x);
            const double push = plant_.mass * s.v + h_ * drive; // momentum before friction
            const side& d = side_[(s.v != 0 ? s.v : push) > 0 ? 1 : 0];
            double v = 0;
            if (d.breakaway <= 0) {
                v = push * d.inverse_slip;
            } else {
                v = (push - h_ * d.stiffness * s.deflection) * d.inverse_stick;
                const double deflection = s.deflection + h_ * v;
                const double slip =
                    plant_.friction.excess != 0
                        ? d.level + plant_.friction.excess * std::exp(-std::abs(s.v) * inverse_stribeck_)
                        : d.level;
                if (std::abs(d.stiffness * deflection) <=
                    (s.slipping && deflection * s.v > 0 ? slip : d.breakaway)) {
                    s.deflection = deflection;
                    s.slipping = false;
                } else {
                    const double force = deflection > 0 ? slip : -slip;
                    v = (push - h_ * force) * d.inverse_slip;
                    s.deflection = force * d.compliance;
                    s.slipping = true;
                }
            }
            s.x += 0.5 * h_ * (s.v + v);
            s.v = v;
        }

    private:
        struct side { // of one direction of motion
            double level, breakaway, stiffness, compliance, inverse_slip, inverse_stick;
        };
        const plant_model& plant_;
        double h_, inverse_stribeck_;
        std::array<side, 2> side_{};
    };
};

} // namespace quadrant::diagnosis
