// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/lanes.hpp"
#include "../model/closed_drive.hpp"

namespace quadrant::inline v0::diagnosis {

/// What a pass over a log needs in which drives close their loops on the plants, and where its results go.
struct closed_input {
    /// One plant, and what its drive follows in each step of each row.
    struct plant {
        plant_axis::parameters axis{};
        loop_numbers<double> loops{};
        const double *set_point = nullptr, *its_velocity = nullptr;
    };
    double period = 0;
    std::size_t rows = 0, steps = 1; ///< steps of a row
    const double* position = nullptr;
    double velocity = 0;                            ///< at the first row [m/s]
    std::span<const driven_motion::start> begins{}; ///< where another log begins
    const double* other_acceleration = nullptr;     ///< null: none
    const unsigned char* off = nullptr;             ///< rows in which the drive gives nothing; null: none
    std::size_t plants = 0;
    const plant* plant_of = nullptr;
    double* const* innovation = nullptr; ///< one array a plant

    /// The plants from `first` on, at most `most`.
    closed_input from(std::size_t first, std::size_t most) const {
        closed_input out = *this;
        out.plants = plants - first < most ? plants - first : most;
        out.plant_of += first;
        out.innovation += first;
        return out;
    }
};

namespace detail {

/// The loops of several plants, a lane each.
template <class Real> loop_numbers<Real> side_by_side(const closed_input& in) {
    loop_numbers<Real> out;
    out.kind = in.plant_of[0].loops.kind;
    for (std::size_t i = 0; i < lane_count<Real>; ++i) {
        const loop_numbers<double>& n = in.plant_of[i < in.plants ? i : in.plants - 1].loops;
        set_lane(out.servo.gain, i, n.servo.gain);
        set_lane(out.servo.minimum, i, n.servo.minimum);
        set_lane(out.servo.maximum, i, n.servo.maximum);
        set_lane(out.servo.rate, i, n.servo.rate);
        set_lane(out.loop.gain, i, n.loop.gain);
        set_lane(out.loop.velocity_feedforward, i, n.loop.velocity_feedforward);
        set_lane(out.loop.velocity.gain, i, n.loop.velocity.gain);
        set_lane(out.loop.velocity.integral, i, n.loop.velocity.integral);
        set_lane(out.loop.velocity.filter_Hz, i, n.loop.velocity.filter_Hz);
        set_lane(out.loop.velocity.limit, i, n.loop.velocity.limit);
        set_lane(out.of_duty, i, n.of_duty);
        set_lane(out.start_force, i, n.start_force);
        set_lane(out.off_from, i, n.off_from);
        set_lane(out.off_until, i, n.off_until);
    }
    return out;
}

/// Plants in the lanes of one number, their drives' loops closed on them, from the first row to the last.
template <class Real> void closed_group(const closed_input& in) {
    using axis = plant_axes<Real>;
    constexpr std::size_t width = lane_count<Real>;
    const double h = in.period / static_cast<double>(in.steps);
    const auto gathered = [&](const auto& number_of) {
        std::array<double, width> out;
        for (std::size_t i = 0; i < width; ++i)
            out[i] = number_of(in.plant_of[i < in.plants ? i : in.plants - 1]);
        return Real(out);
    };
    closed_axis<Real, axis> plant(
        axis::side_by_side(
            in.plants, [&](std::size_t i) -> const auto& { return in.plant_of[i].axis; }),
        side_by_side<Real>(in), Real(h));
    const closed_input::plant& first = in.plant_of[0];
    const bool alike = std::all_of(in.plant_of, in.plant_of + in.plants, [&](const closed_input::plant& p) {
        return p.set_point == first.set_point && p.its_velocity == first.its_velocity;
    });
    const auto begin = [&](std::size_t k, double velocity) {
        plant.begin(Real(in.position[k]), Real(velocity),
                    gathered([&](const closed_input::plant& p) { return p.set_point[k * in.steps]; }));
    };
    begin(0, in.velocity);
    auto anew = in.begins.begin();
    typename axis::surroundings now{};
    for (std::size_t k = 0; k < in.rows; ++k) {
        if (anew != in.begins.end() && anew->row == k) {
            begin(k, anew->velocity);
            ++anew;
        }
        const auto path = plant.reading().each();
        for (std::size_t i = 0; i < width && i < in.plants; ++i) in.innovation[i][k] = in.position[k] - path[i];
        now.time = Real(static_cast<double>(k) * in.period);
        if (in.other_acceleration) now.other_acceleration = Real(in.other_acceleration[k]);
        for (std::size_t j = k * in.steps; j < (k + 1) * in.steps; ++j) {
            if (alike)
                plant(Real(first.set_point[j]), Real(first.its_velocity[j]), in.off && in.off[k], now);
            else
                plant(gathered([j](const closed_input::plant& p) { return p.set_point[j]; }),
                      gathered([j](const closed_input::plant& p) { return p.its_velocity[j]; }),
                      in.off && in.off[k], now);
            now.time = now.time + Real(h);
        }
    }
}
template <class Real> void closed_pass(const closed_input& in) {
    for (std::size_t first = 0; first < in.plants; first += lane_count<Real>)
        closed_group<Real>(in.from(first, lane_count<Real>));
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
