// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "sample_loss.hpp"
#include "stepper.hpp"

#include <span>
#include <vector>

namespace quadrant::diagnosis {

/// The plant inside an observer: driven by the logged command, corrected by the logged position, judged by what the
/// correction had to be. One pass, no drift of the double integrator, and a right model leaves only the encoder's
/// rounding: the innovation
///   e[k] = y[k] - reading(x(t_k));  x += L1 e, v += L2 e;  then one period of the plant
/// with both observer poles at z = exp(-2 pi corner T): L1 = 1 - z^2, L2 = (1 - z)^2 / T [Franklin1998] ch. 8.
/// A constant force error d shows as e = d T^2 / (M (1 - z)^2), which is d / (M (2 pi corner)^2) when T is short.
struct predictor {
    double period;         ///< T [s]
    double corner_Hz = 60; ///< lower: more sensitive to slow forces; higher: friction's sign is surer at creep
    std::span<const double> position, command;
    std::span<const double> other_acceleration{}; ///< of the axis that may be coupled [m/s^2]; empty: none

    /// Innovations; returned is what the model chose from the log itself [nats], 0 but for lost commands. When `acceleration` is given, also the mean acceleration that the model gives the encoder over each
    /// period [m/s^2].
    double run(const plant_model& plant, std::vector<double>& innovation,
               std::vector<double>* acceleration = nullptr) const {
        double choices = 0;
        if (plant.loss > 0) {
            pass(plant, command, innovation, nullptr);
            const auto held = commands_with_loss(plant, innovation, plant.loss);
            pass(plant, held.applied, innovation, acceleration);
            choices = held.choices;
        } else {
            pass(plant, command, innovation, acceleration);
        }
        return choices;
    }

    /// The commands that the drive acted on when it lost each with probability p, as the innovations of `plant` tell it.
    lossy_commands commands_with_loss(const plant_model& plant, const std::vector<double>& innovation,
                                      double p) const {
        return diagnosis::commands_with_loss(command, innovation, loss_response(plant),
                                             whole_periods(plant.delay), p);
    }

private:
    std::size_t whole_periods(double delay) const {
        return static_cast<std::size_t>(std::max(0.0, delay) / period);
    }
    double l1() const { return 1 - pole() * pole(); }
    double l2() const { return (1 - pole()) * (1 - pole()) / period; }
    double pole() const { return std::exp(-2 * std::numbers::pi * corner_Hz * period); }

    /// Innovations after one volt too much in one period, on a free axis.
    std::vector<double> loss_response(const plant_model& plant) const {
        const double to_position = l1(), to_velocity = l2();
        const double late =
            std::max(0.0, plant.delay) - static_cast<double>(whole_periods(plant.delay)) * period;
        const double per_volt = plant.force_constant / plant.mass;
        std::vector<double> out;
        double x = 0, v = 0;
        const auto rows = static_cast<std::size_t>(1.5 / (2 * std::numbers::pi * corner_Hz * period)) + 2;
        for (std::size_t k = 0; k <= rows; ++k) {
            if (k > 0) out.push_back(x);
            const double e = x, length = k == 0   ? period - late
                                         : k == 1 ? late
                                                  : 0; // of the volt in this period
            x -= to_position * e;
            v -= to_velocity * e;
            const double rise = per_volt * length;
            x += period * v + (k == 0 ? 0.5 * length : period - 0.5 * length) * rise;
            v += rise;
        }
        return out;
    }

    void pass(const plant_model& plant, std::span<const double> u, std::vector<double>& innovation,
              std::vector<double>* acceleration) const {
        const double to_position = l1(), to_velocity = l2();
        const std::size_t whole = whole_periods(plant.delay);
        const double first =
            std::max(0.0, plant.delay) - static_cast<double>(whole) * period; // the older command's part
        const stepper older(plant, first > 0 ? first : period), newer(plant, period - first);
        const auto past = [&](std::size_t k, std::size_t back) { return u[k >= back ? k - back : 0]; };
        innovation.resize(position.size());
        if (acceleration) acceleration->resize(position.size());
        auto s = plant_state::at(position[0] - plant.cyclic.at(position[0]));
        surroundings now;
        for (std::size_t k = 0; k < position.size(); ++k) {
            const double e = position[k] - s.load - plant.cyclic.at(s.load);
            innovation[k] = e;
            s.shift(to_position * e, to_velocity * e);
            if (!other_acceleration.empty()) now.other_acceleration = other_acceleration[k];
            now.time = static_cast<double>(k) * period;
            const double before = plant.backlash > 0 ? s.load_velocity : s.v;
            if (first > 0) {
                older(s, past(k, whole + 1), now);
                now.time += first;
            }
            newer(s, past(k, whole), now);
            if (acceleration) (*acceleration)[k] = (s.load_velocity - before) / period;
        }
    }
};

} // namespace quadrant::diagnosis
