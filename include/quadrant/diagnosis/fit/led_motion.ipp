// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/lanes.hpp"

#include <array>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Signals of equal length side by side: the last one again in the lanes that are left over.
template <class Real> class rows_of_each {
    static constexpr std::size_t width = lane_count<Real>;

public:
    explicit rows_of_each(std::span<std::vector<double>> signals) : signals_(std::min(width, signals.size())) {
        for (std::size_t i = 0; i < width; ++i) of_[i] = signals[std::min(i, signals_ - 1)].data();
    }
    Real operator[](std::size_t k) const {
        if constexpr (width == 1) {
            return Real(of_[0][k]);
        } else {
            std::array<double, width> out;
            for (std::size_t i = 0; i < width; ++i) out[i] = of_[i][k];
            return Real(out);
        }
    }
    void set(std::size_t k, const Real& value) {
        if constexpr (width == 1) {
            of_[0][k] = value;
        } else {
            const auto each = value.each();
            for (std::size_t i = 0; i < signals_; ++i) of_[i][k] = each[i];
        }
    }

private:
    std::array<double*, width> of_{};
    std::size_t signals_;
};

/// use(rows of these signals), a group after the other, in lanes where there are several.
template <class Use> void in_lanes(std::span<std::vector<double>> signals, const Use& use) {
    constexpr std::size_t width = predictor::in_a_group;
    for (; !signals.empty(); signals = signals.subspan(std::min(signals.size(), width)))
        if (const auto some = signals.first(std::min(signals.size(), width)); some.size() == 1)
            use(rows_of_each<double>(some), double{});
        else
            use(rows_of_each<lanes<width>>(some), lanes<width>{});
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL void predictor::forces_beside(const led_motion& by, std::span<const plant_model> plants,
                                                      std::span<const double> u,
                                                      std::span<std::vector<double>> left) const {
    constexpr double heavier = 1e4; // so heavy that no force moves it beside the way
    std::vector<std::vector<double>> unused(plants.size());
    pass(plants, u, unused, left.data(), {by.way.data(), 0, 0, heavier});
    for (std::size_t i = 0; i < plants.size(); ++i) {
        const double led_base = heavier * plants[i].moving_mass() - plants[i].second_mass();
        for (double& x : left[i]) x *= led_base;
    }
    const std::size_t n = by.way.size();
    detail::in_lanes(left, [&]<class Real>(detail::rows_of_each<Real> rows, Real) {
        std::vector<Real> all(n);
        for (std::size_t k = 0; k < n; ++k) all[k] = rows[k];
        all = zero_phase_of<Real>(all, corner_Hz, period);
        for (std::size_t k = 0; k < n; ++k) rows.set(k, all[k]);
    });
    std::vector<double> of_way; // acceleration that the motion needs, where no reading is in error
    for (std::size_t i = 0; i < plants.size(); ++i) {
        const plant_model& p = plants[i];
        const double base = p.moving_mass() - p.second_mass();
        if (p.cyclic.count > 0 || of_way.empty()) of_way = acceleration_of(p, by.way, period);
        const auto viscous = [&](std::size_t k) { // in this direction
            const double sign = by.way[k + 1] > by.way[k - 1] ? 1 : -1;
            return p.friction.viscous_slope * (1 + sign * p.friction.viscous_asymmetry);
        };
        const auto put = [&](const auto& a_volt) {
            for (std::size_t k = 1; k + 1 < n; ++k)
                left[i][k] = by.counts[k] ? by.force_constant / a_volt(k) *
                                                (left[i][k] - base * of_way[k] - viscous(k) * by.quick[k])
                                          : 0;
            if (n > 0) left[i].front() = left[i].back() = 0;
        };
        // Force that one volt more would make: a weak motor, or friction that takes its share, explains
        // nothing by making all forces small.
        const auto of_motor = [&](std::size_t k) { return p.force_constant * (1 + p.ripple.at(by.way[k])); };
        if (p.friction.load != 0)
            put([&](std::size_t k) {
                const double through = of_motor(k) * u[k] - p.static_force(by.way[k]);
                const bool against = through * (by.way[k + 1] - by.way[k - 1]) > 0;
                return of_motor(k) * (1 - (against ? 1 : -1) * p.friction.load);
            });
        else if (p.ripple.count > 0)
            put(of_motor);
        else
            put([&](std::size_t) { return p.force_constant; });
        if (p.cyclic.count > 0) of_way.clear();
    }
}

QUADRANT_DIAGNOSIS_DECL void predictor::pass_led(std::span<const plant_model> plants, std::span<const double> u,
                                                 std::span<std::vector<double>> innovation,
                                                 std::vector<double>* acceleration) const {
    std::vector<std::vector<double>> left(plants.size());
    forces_beside(*led, plants, u, left);
    for (std::size_t i = 0; i < plants.size(); ++i) {
        innovation[i] = left[i];
        innovation[i].resize(rows());
    }
    detail::in_lanes(innovation, [&]<class Real>(detail::rows_of_each<Real> of, Real) {
        const Real mass(led->mass), step(period), half(period / 2), to_position(l1()), to_velocity(l2());
        Real x(0), v(0);
        for (std::size_t k = 0; k < position.size(); ++k) {
            const Real a = -of[k] / mass;
            of.set(k, x);
            v -= to_velocity * x;
            x += step * (v + half * a) - to_position * x;
            v += step * a;
        }
    });
    if (!acceleration) return;
    for (std::size_t i = 0; i < plants.size(); ++i) {
        acceleration[i] = acceleration_of(plants[i], position, period);
        for (std::size_t k = 1; k + 1 < position.size(); ++k)
            acceleration[i][k] += left[i][k] / plants[i].moving_mass();
    }
}

} // namespace quadrant::inline v0::diagnosis
