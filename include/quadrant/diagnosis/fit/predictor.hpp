// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/signals.hpp"
#include "../model/driven_motion.hpp"
#include "../model/sample_loss.hpp"
#include "pass.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace quadrant::diagnosis {

/// The passes to use: those of this translation unit's instruction set; in a program that has more of them,
/// those of the best set that the processor has.
#ifdef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
const pass_table& passes();
#else
inline const pass_table& passes() { return passes_of<>; }
#endif

/// Second difference of a reading around each row, without what a plant's encoder adds to it, over the square
/// of the period [m/s^2]; 0 at both ends.
inline std::vector<double> acceleration_of(const plant_model& plant, std::span<const double> position,
                                           double period) {
    std::vector<double> out(position.size(), 0.0);
    const auto at = [&](std::size_t k) { return position[k] - plant.cyclic.at(position[k]); };
    for (std::size_t k = 1; k + 1 < position.size(); ++k)
        out[k] = (at(k + 1) - 2 * at(k) + at(k - 1)) / (period * period);
    return out;
}

/// A motion that plants are led along instead of being corrected by its readings: what an expert's regression
/// does.
struct led_motion {
    std::vector<double> way;           ///< smoothed without phase at the corner [m]
    std::vector<unsigned char> counts; ///< of every row: 1 where the axis surely moves
    double mass, force_constant;       ///< of the machine file: forces are compared in units of the command
};

/// The plant inside an observer: driven by the logged command, corrected by the logged position, judged by what
/// the correction had to be. One pass, no drift of the double integrator, and a right model leaves only the
/// encoder's
/// rounding: the innovation
///   e[k] = y[k] - reading(x(t_k));  x += L1 e, v += L2 e;  then one period of the plant
/// with both observer poles at z = exp(-2 pi corner T): L1 = 1 - z^2, L2 = (1 - z)^2 / T [Franklin1998] ch. 8.
/// A constant force error d shows as e = d T^2 / (M (1 - z)^2), which is d / (M (2 pi corner)^2) when T is
/// short.
struct predictor {
    /// e'[k] = e[k] - e[k-1] + pole e'[k-1]: makes a drift of independent steps a signal of one size.
    static void take_drift_out(std::vector<double>& e, double pole) {
        double before = e.empty() ? 0 : e.front(), out = 0;
        for (double& x : e) {
            out = pole * out + x - before;
            before = std::exchange(x, out);
        }
    }

    static constexpr std::size_t abreast = 8; ///< plants in one pass
    double period;                            ///< T [s]
    double corner_Hz; ///< lower: more sensitive to slow forces; higher: friction's sign is surer at creep
    std::span<const double> position, command;
    std::span<const double> other_acceleration{}; ///< of the axis that may be coupled [m/s^2]; empty: none
    double resolution = 0;                        ///< step of the position [m]
    std::size_t substeps = 1;                     ///< of a period, see substeps_of()
    const driven_motion* drive =
        nullptr; ///< of a drive with loops of its own; null: `command` is the actuator's
    /// Null: the plant is corrected by the readings. Else it is led along this motion, and the innovations are
    /// those that the forces which this motion does not need would make of a free mass. An observer lets a
    /// model stand, or creep behind a stiff damping, where a light machine moves slowly under forces that the
    /// model
    /// does not have: the corrections carry it, and little shows in them. No state of a led plant takes part.
    std::shared_ptr<const led_motion> led{};
    double drift_pole =
        1; ///< of the filter that takes the drift of a drive's integral out, see drift_pole_of(); 1: none

    /// Innovations; lost commands are found, and counted, by what they leave in them. Returned is what the
    /// model chose from the log itself [nats], 0 but for lost commands. When `acceleration` is given, also the
    /// second difference of the model's positions around each row, over the square of the period [m/s^2].
    double run(const plant_model& plant, std::vector<double>& innovation,
               std::vector<double>* acceleration = nullptr) const {
        const std::span one(&plant, 1);
        const std::span into(&innovation, 1);
        if (plant.loss > 0) {
            pass(one, command, into, nullptr);
            const auto held =
                commands_with_loss(plant, innovation, {.probability = plant.loss, .learned = true});
            pass(one, held.applied, into, acceleration);
            return held.choices;
        }
        pass(one, command, into, acceleration);
        return 0;
    }
    /// The same for several plants, some at a time side by side: a third of the time and less. One list of
    /// innovations a plant, of accelerations where they are asked for, and of choices likewise. Plants with the
    /// same joints share lanes, which all pay for what one of them has.
    void run(std::span<const plant_model> plants, std::span<std::vector<double>> innovation,
             std::span<std::vector<double>> acceleration = {}, std::span<double> choices = {}) const {
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < plants.size(); ++i) {
            if (plants[i].loss == 0) {
                order.push_back(i);
                continue;
            }
            const double chosen =
                run(plants[i], innovation[i], acceleration.empty() ? nullptr : &acceleration[i]);
            if (!choices.empty()) choices[i] = chosen;
        }
        if (order.size() > abreast / 2)
            std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
                return joints_of(plants[a]) > joints_of(plants[b]);
            });
        std::vector<plant_model> some;
        std::array<std::vector<double>, abreast> e, a;
        for (std::size_t first = 0; first < order.size(); first += abreast) {
            const std::size_t n = std::min(abreast, order.size() - first);
            some.clear();
            for (std::size_t i = 0; i < n; ++i) {
                some.push_back(plants[order[first + i]]);
                e[i].swap(innovation[order[first + i]]);
                if (!acceleration.empty()) a[i].swap(acceleration[order[first + i]]);
            }
            pass(some, command, std::span(e).first(n), acceleration.empty() ? nullptr : a.data());
            for (std::size_t i = 0; i < n; ++i) {
                innovation[order[first + i]].swap(e[i]);
                if (!acceleration.empty()) acceleration[order[first + i]].swap(a[i]);
            }
        }
    }

    /// What the forces on each plant leave when it is led along a motion, in units of the command times the
    /// described force constant [N]; 0 where that motion does not count. At most `abreast` plants.
    void forces_beside(const led_motion& by, std::span<const plant_model> plants, std::span<const double> u,
                       std::span<std::vector<double>> left) const {
        constexpr double heavier = 1e4; // so heavy that no force moves it beside the way
        std::vector<std::vector<double>> unused(plants.size());
        pass(plants, u, unused, left.data(), {by.way.data(), 1, 1 / period, heavier});
        for (std::size_t i = 0; i < plants.size(); ++i) {
            const plant_model& p = plants[i];
            const double base = p.moving_mass() - p.mode.mass,
                         led_base = heavier * p.moving_mass() - p.mode.mass;
            for (double& x : left[i]) x *= led_base;
            left[i] = zero_phase(left[i], corner_Hz, period);
            const auto needed = acceleration_of(p, by.way, period);
            // Force that one volt more would make: a weak motor, or friction that takes its share, explains
            // nothing by making all forces small.
            const auto a_volt = [&](std::size_t k) {
                const double of_motor = p.force_constant * (1 + p.ripple.at(by.way[k]));
                const double through = of_motor * u[k] - p.static_force(by.way[k]);
                const bool against = through * (by.way[k + 1] - by.way[k - 1]) > 0;
                return of_motor * (1 - (against ? 1 : -1) * p.friction.load);
            };
            for (std::size_t k = 0; k < left[i].size(); ++k) {
                if (k == 0 || k + 1 == left[i].size() || !by.counts[k]) {
                    left[i][k] = 0;
                    continue;
                }
                left[i][k] = by.force_constant / a_volt(k) * (left[i][k] - base * needed[k]);
            }
        }
    }

    /// Rows of the innovations: those of the position, and behind them, where something was measured behind the
    /// drive, what the drive gives otherwise.
    std::size_t rows() const { return position.size() * (drive && drive->tapped() ? 2 : 1); }

    /// Both poles of the observer.
    double pole() const { return std::exp(-2 * std::numbers::pi * corner_Hz * period); }

    /// The commands that the drive acted on when it lost some, as the innovations of `plant` without a loss
    /// tell it.
    lossy_commands commands_with_loss(const plant_model& plant, const std::vector<double>& innovation,
                                      const loss_assumption& a) const {
        return lost_commands::find(command, innovation, loss_response(plant), whole_periods(plant.delay),
                                   resolution / std::sqrt(12.0), a);
    }

private:
    /// Which joints of a plant take time, one bit each, those that take most first.
    unsigned joints_of(const plant_model& p) const {
        unsigned out = 0;
        for (const bool there :
             {std::fmod(std::max(0.0, p.delay), period) != 0, p.friction.contact.elements > 1, !p.own.empty(),
              p.friction.along.count > 0, p.ripple.count > 0, p.cogging.count > 0, p.cutting.count > 0,
              p.cyclic.count > 0, p.gravity.torque != 0, p.friction.drift != 0, p.mode.mass > 0,
              p.friction.excess > 0, std::isfinite(p.friction.contact.attraction), p.friction.load != 0,
              p.backlash > 0, p.lag > 0})
            out = 2 * out + there;
        return out;
    }
    /// How a pass is corrected: the position that leads it, its gains, and how much heavier the plants are.
    struct guidance {
        const double* position;
        double to_position, to_velocity, heavier;
    };
    /// Innovations of a free mass on which these forces act, and the accelerations that say the same.
    void pass_led(std::span<const plant_model> plants, std::span<const double> u,
                  std::span<std::vector<double>> innovation, std::vector<double>* acceleration) const {
        std::vector<std::vector<double>> left(plants.size());
        forces_beside(*led, plants, u, left);
        for (std::size_t i = 0; i < plants.size(); ++i) {
            innovation[i].resize(rows());
            double x = 0, v = 0;
            for (std::size_t k = 0; k < left[i].size(); ++k) {
                innovation[i][k] = x;
                const double a = -left[i][k] / led->mass;
                v -= l2() * x;
                x += period * (v + period / 2 * a) - l1() * x;
                v += period * a;
            }
            if (!acceleration) continue;
            acceleration[i] = acceleration_of(plants[i], position, period);
            for (std::size_t k = 1; k + 1 < position.size(); ++k)
                acceleration[i][k] += left[i][k] / plants[i].mass;
        }
    }
    std::size_t whole_periods(double delay) const {
        return static_cast<std::size_t>(std::max(0.0, delay) / period);
    }
    double l1() const { return 1 - pole() * pole(); }
    double l2() const { return (1 - pole()) * (1 - pole()) / period; }

    /// Innovations after one volt too much in one period, on a free axis, until the observer has forgotten it.
    std::vector<double> loss_response(const plant_model& plant) const {
        const double to_position = l1(), to_velocity = l2();
        const double late =
            std::max(0.0, plant.delay) - static_cast<double>(whole_periods(plant.delay)) * period;
        const double per_volt = plant.force_constant / plant.moving_mass();
        std::vector<double> out;
        double x = 0, v = 0;
        const auto rows = static_cast<std::size_t>(6 / (2 * std::numbers::pi * corner_Hz * period)) + 2;
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

    /// The command of each plant's actuator, and its innovations behind the drive. Plants with one drive share
    /// its replay.
    void drive_each(std::span<const plant_model> plants, std::array<std::vector<double>, abreast>& own,
                    std::array<const double*, abreast>& command_of,
                    std::span<std::vector<double>> innovation) const {
        const auto n = static_cast<std::ptrdiff_t>(position.size());
        for (std::size_t i = 0; i < plants.size(); ++i) {
            std::size_t same = 0;
            while (same < i && !(plants[same].drive == plants[i].drive)) ++same;
            if (same == i) {
                auto replay = drive->run(plants[i].drive);
                own[i] = std::move(replay.command);
                for (std::size_t k = 0; k < replay.beside.size(); ++k)
                    innovation[i][position.size() + k] = drive->to_position * replay.beside[k];
            } else if (drive->tapped()) {
                std::copy(innovation[same].begin() + n, innovation[same].end(), innovation[i].begin() + n);
            }
            command_of[i] = own[same].data();
        }
    }

    /// Several plants side by side in the lanes of one number.
    void pass(std::span<const plant_model> plants, std::span<const double> u,
              std::span<std::vector<double>> innovation, std::vector<double>* acceleration) const {
        if (led) return pass_led(plants, u, innovation, acceleration);
        pass(plants, u, innovation, acceleration, {position.data(), l1(), l2(), 1});
        if (drift_pole < 1)
            for (std::size_t i = 0; i < plants.size(); ++i) take_drift_out(innovation[i], drift_pole);
    }
    void pass(std::span<const plant_model> plants, std::span<const double> u,
              std::span<std::vector<double>> innovation, std::vector<double>* acceleration,
              const guidance& by) const {
        std::array<double*, abreast> e{}, a{};
        std::array<pass_input::plant, abreast> each;
        for (std::size_t i = 0; i < plants.size(); ++i) {
            each[i] = {axis_parameters(plants[i]), plants[i].delay};
            each[i].axis.mass *= by.heavier;
            each[i].axis.coupling /= by.heavier; // a share of the mass
            innovation[i].resize(rows());
            e[i] = innovation[i].data();
            if (!acceleration) continue;
            acceleration[i].resize(position.size());
            a[i] = acceleration[i].data();
        }
        std::array<std::vector<double>, abreast> own;
        std::array<const double*, abreast> command_of{};
        if (drive) drive_each(plants, own, command_of, innovation);
        pass_all({.period = period,
                  .substeps = substeps,
                  .rows = position.size(),
                  .position = by.position,
                  .command = u.data(),
                  .command_of = drive ? command_of.data() : nullptr,
                  .other_acceleration = other_acceleration.empty() ? nullptr : other_acceleration.data(),
                  .to_position = by.to_position,
                  .to_velocity = by.to_velocity,
                  .plants = plants.size(),
                  .plant_of = each.data(),
                  .innovation = e.data(),
                  .acceleration = acceleration ? a.data() : nullptr},
                 passes());
    }
};

} // namespace quadrant::diagnosis
