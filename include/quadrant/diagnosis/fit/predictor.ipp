// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>

namespace quadrant::inline v0::diagnosis {

#ifdef QUADRANT_DIAGNOSIS_PASSES // the program has pass.hpp compiled for these sets too
extern const pass_table passes_avx2, passes_avx512;
QUADRANT_DIAGNOSIS_DECL const pass_table& passes() {
    static const pass_table& best = __builtin_cpu_supports("avx512f") ? passes_avx512
                                    : __builtin_cpu_supports("avx2")  ? passes_avx2
                                                                      : passes_of<>;
    return best;
}
#else
QUADRANT_DIAGNOSIS_DECL const pass_table& passes() { return passes_of<>; }
#endif

QUADRANT_DIAGNOSIS_DECL std::vector<double> acceleration_of(const plant_model& plant,
                                                            std::span<const double> position, double period) {
    std::vector<double> out(position.size(), 0.0);
    const auto at = [&](std::size_t k) { return position[k] - plant.cyclic.at(position[k]); };
    for (std::size_t k = 1; k + 1 < position.size(); ++k)
        out[k] = (at(k + 1) - 2 * at(k) + at(k - 1)) / (period * period);
    return out;
}

QUADRANT_DIAGNOSIS_DECL void predictor::take_drift_out(std::vector<double>& e, double pole) {
    double before = e.empty() ? 0 : e.front(), out = 0;
    for (double& x : e) {
        out = pole * out + x - before;
        before = std::exchange(x, out);
    }
}

QUADRANT_DIAGNOSIS_DECL double predictor::run(const plant_model& plant, std::vector<double>& innovation,
                                              std::vector<double>* acceleration) const {
    const std::span one(&plant, 1);
    const std::span into(&innovation, 1);
    if (plant.loss > 0) {
        pass(one, command, into, nullptr);
        const auto held = commands_with_loss(plant, innovation, {.probability = plant.loss, .learned = true});
        pass(one, held.applied, into, acceleration);
        return held.choices;
    }
    pass(one, command, into, acceleration);
    return plant.drive.losses_known() ? plant.drive.received->choices : 0;
}

QUADRANT_DIAGNOSIS_DECL unsigned predictor::joints_of(const plant_model& p) const {
    unsigned out = 0;
    for (const bool there :
         {std::fmod(std::max(0.0, p.delay), period) != 0, p.friction.contact.elements > 1, !p.own.empty(),
          p.friction.along.count > 0, p.ripple.count > 0, p.cogging.count > 0, p.cutting.count > 0,
          p.cyclic.count > 0, p.gravity.torque != 0, p.friction.drift_rate != 0, p.mode.mass > 0,
          p.friction.excess > 0, p.friction.stribeck_exponent != 1,
          std::isfinite(p.friction.contact.attraction), p.friction.load != 0, p.backlash > 0,
          p.backlash_behind > 0, std::isfinite(p.motor_mass), p.lag > 0})
        out = 2 * out + there;
    return out;
}

QUADRANT_DIAGNOSIS_DECL void predictor::run(std::span<const plant_model> plants,
                                            std::span<std::vector<double>> innovation,
                                            std::span<std::vector<double>> acceleration,
                                            std::span<double> choices) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < plants.size(); ++i) {
        if (plants[i].loss == 0) {
            order.push_back(i);
            if (!choices.empty() && plants[i].drive.losses_known())
                choices[i] = plants[i].drive.received->choices;
            continue;
        }
        const double chosen = run(plants[i], innovation[i], acceleration.empty() ? nullptr : &acceleration[i]);
        if (!choices.empty()) choices[i] = chosen;
    }
    if (order.size() > in_a_group / 2)
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return joints_of(plants[a]) > joints_of(plants[b]);
        });
    std::vector<plant_model> some;
    std::array<std::vector<double>, abreast> e, a;
    const std::size_t most = closed ? in_a_group : abreast; // loops that are closed share the steps of a row
    for (std::size_t first = 0; first < order.size(); first += most) {
        const std::size_t n = std::min(most, order.size() - first);
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

QUADRANT_DIAGNOSIS_DECL lossy_commands predictor::commands_with_loss(const plant_model& plant,
                                                                     const std::vector<double>& innovation,
                                                                     const loss_assumption& a) const {
    return lost_commands::find(command, innovation, loss_response(plant), whole_periods(plant.delay),
                               resolution / std::sqrt(12.0), a);
}

QUADRANT_DIAGNOSIS_DECL std::size_t predictor::whole_periods(double delay) const {
    return static_cast<std::size_t>(std::max(0.0, delay) / period);
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> predictor::loss_response(const plant_model& plant) const {
    const double to_position = l1(), to_velocity = l2();
    const double late = std::max(0.0, plant.delay) - static_cast<double>(whole_periods(plant.delay)) * period;
    const double per_volt = plant.force_constant / plant.moving_mass();
    std::vector<double> out;
    double x = 0, v = 0;
    const auto rows = static_cast<std::size_t>(6 / (2 * std::numbers::pi * corner_Hz * period)) + 2;
    for (std::size_t k = 0; k <= rows; ++k) {
        if (k > 0) out.push_back(x);
        const double e = x, length = k == 0 ? period - late : k == 1 ? late : 0; // of the volt in this period
        x -= to_position * e;
        v -= to_velocity * e;
        const double rise = per_volt * length;
        x += period * v + (k == 0 ? 0.5 * length : period - 0.5 * length) * rise;
        v += rise;
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL void predictor::pass(std::span<const plant_model> plants, std::span<const double> u,
                                             std::span<std::vector<double>> innovation,
                                             std::vector<double>* acceleration) const {
    if (led) return pass_led(plants, u, innovation, acceleration);
    if (closed) return pass_closed(plants, u, innovation, acceleration);
    pass(plants, u, innovation, acceleration, {position.data(), l1(), l2(), 1});
    if (drift_pole < 1)
        for (std::size_t i = 0; i < plants.size(); ++i) take_drift_out(innovation[i], drift_pole);
}

QUADRANT_DIAGNOSIS_DECL void predictor::pass(std::span<const plant_model> plants, std::span<const double> u,
                                             std::span<std::vector<double>> innovation,
                                             std::vector<double>* acceleration, const guidance& by) const {
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
              .leads = by.heavier > 1,
              .plants = plants.size(),
              .plant_of = each.data(),
              .innovation = e.data(),
              .acceleration = acceleration ? a.data() : nullptr},
             passes());
}

} // namespace quadrant::inline v0::diagnosis
