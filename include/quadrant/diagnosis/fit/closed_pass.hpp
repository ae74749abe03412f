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
        double scale = 1; ///< of the set-points: a velocity drive's of a volt
    };
    double period = 0;
    std::size_t rows = 0, steps = 1; ///< steps of a row
    const double* position = nullptr;
    double velocity = 0;                        ///< at the first row [m/s]
    std::span<const log_start> begins{};        ///< where another log begins
    const double* other_acceleration = nullptr; ///< null: none
    const unsigned char* off = nullptr;         ///< rows in which the drive gives nothing; null: none
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
    out.reads_log = in.plant_of[0].loops.reads_log;
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

/// Plants in the lanes of one number, their drives' loops closed on them, on their way through the log.
template <class Real> class closed_group {
    using axis = plant_axes<Real>;
    static constexpr std::size_t width = lane_count<Real>;

public:
    explicit closed_group(const closed_input& in)
        : in_(in), h_(in.period / static_cast<double>(in.steps)),
          plant_(axis::side_by_side(
                     in.plants, [&](std::size_t i) -> const auto& { return in.plant_of[i].axis; }),
                 side_by_side<Real>(in), Real(h_)) {
        const closed_input::plant& first = in.plant_of[0];
        alike_ = std::all_of(in.plant_of, in.plant_of + in.plants, [&](const closed_input::plant& p) {
            return p.set_point == first.set_point && p.its_velocity == first.its_velocity;
        });
        scale_ = gathered([](const closed_input::plant& p) { return p.scale; });
    }

    /// A log begins: the axes stand at the reading of row k, and move with this velocity.
    void begin(std::size_t k, double velocity) {
        first_ = k;
        plant_.begin(Real(in_.position[k]), Real(velocity),
                     scale_ *
                         gathered([&](const closed_input::plant& p) { return p.set_point[k * in_.steps]; }));
    }
    /// What is between the path and the reading of row k, where the row begins.
    void compare(std::size_t k) {
        const auto path = plant_.reading().each();
        for (std::size_t i = 0; i < width && i < in_.plants; ++i)
            in_.innovation[i][k] = in_.position[k] - path[i];
        now_.time = Real(static_cast<double>(k - first_) * in_.period);
        if (in_.other_acceleration) now_.other_acceleration = Real(in_.other_acceleration[k]);
    }
    /// Step j of the record, in row k.
    void step(std::size_t k, std::size_t j) {
        const closed_input::plant& first = in_.plant_of[0];
        const bool off = in_.off && in_.off[k];
        const double began = static_cast<double>(first_) * in_.period;
        if (alike_)
            plant_(scale_ * Real(first.set_point[j]), Real(first.its_velocity[j]), off, now_, began);
        else
            plant_(scale_ * gathered([j](const closed_input::plant& p) { return p.set_point[j]; }),
                   gathered([j](const closed_input::plant& p) { return p.its_velocity[j]; }), off, now_, began);
        now_.time = now_.time + Real(h_);
    }

private:
    template <class NumberOf> Real gathered(const NumberOf& number_of) const {
        std::array<double, width> out;
        for (std::size_t i = 0; i < width; ++i)
            out[i] = number_of(in_.plant_of[i < in_.plants ? i : in_.plants - 1]);
        return Real(out);
    }

    closed_input in_;
    double h_;
    std::size_t first_ = 0; ///< row of the log that runs
    closed_axis<Real, axis> plant_;
    bool alike_ = false;
    Real scale_{1};
    typename axis::surroundings now_{};
};

/// From the first row to the last. The groups take turns, as in pass().
template <class Real> void closed_pass(const closed_input& in) {
    std::vector<closed_group<Real>> groups;
    for (std::size_t first = 0; first < in.plants; first += lane_count<Real>)
        groups.emplace_back(in.from(first, lane_count<Real>));
    for (closed_group<Real>& g : groups) g.begin(0, in.velocity);
    auto anew = in.begins.begin();
    for (std::size_t k = 0; k < in.rows; ++k) {
        if (anew != in.begins.end() && anew->row == k) {
            for (closed_group<Real>& g : groups) g.begin(k, anew->velocity);
            ++anew;
        }
        for (closed_group<Real>& g : groups) g.compare(k);
        for (std::size_t j = k * in.steps; j < (k + 1) * in.steps; ++j)
            for (closed_group<Real>& g : groups) g.step(k, j);
    }
}

} // namespace detail

} // namespace quadrant::inline v0::diagnosis
