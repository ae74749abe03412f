// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/lanes.hpp"
#include "../model/plant_axis.hpp"
#include "closed_pass.hpp"
#include "products.hpp"

#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What one pass of an observer over a log needs, and where its results go.
struct pass_input {
    /// One plant: its axis, and the delay of its commands.
    struct plant {
        plant_axis::parameters axis{};
        double delay = 0; ///< [s]
    };
    double period = 0;
    std::size_t substeps = 1; ///< of each part of a period with one command
    std::size_t rows = 0;
    const double *position = nullptr, *command = nullptr;
    const double* const* command_of = nullptr;  ///< one command a plant instead of one for all; null: none
    const double* other_acceleration = nullptr; ///< null: none
    double to_position = 0, to_velocity = 0;    ///< gains of the correction by the innovation
    bool leads = false;                         ///< instead of it the axis is led along the positions
    std::size_t plants = 0;
    const plant* plant_of = nullptr;
    double* const* innovation = nullptr;   ///< one array a plant
    double* const* acceleration = nullptr; ///< the same; null: not asked for

    /// The plants from `first` on, at most `most`.
    pass_input from(std::size_t first, std::size_t most) const {
        pass_input out = *this;
        out.plants = plants - first < most ? plants - first : most;
        out.plant_of += first;
        if (command_of) out.command_of += first;
        out.innovation += first;
        if (acceleration) out.acceleration += first;
        return out;
    }
};

namespace detail {

/// How many doubles one register of a set holds, at most `most`.
template <class Isa, std::size_t most = 8>
inline constexpr std::size_t register_width =
    most == 8 && quadrant::detail::lane_registers<8, Isa>::width == 8 ? 8
    : quadrant::detail::lane_registers<4, Isa>::width == 4            ? 4
                                                                      : 2;

/// Plants in the lanes of one number, on their way through the log.
template <class Real> class lane_group {
    static constexpr std::size_t width = lane_count<Real>;
    using axis = plant_axes<Real>;

public:
    explicit lane_group(const pass_input& in) : lane_group(in, delays(in)) {}

    /// The innovation of row k, and the correction by it.
    void correct(const pass_input& in, std::size_t k) {
        now_.time = Real(static_cast<double>(k) * in.period);
        if (in.other_acceleration) now_.other_acceleration = Real(in.other_acceleration[k]);
        const Real e = Real(in.position[k]) - newer_.reading(state_);
        keep(in, in.innovation, k, e);
        if (in.leads)
            state_.lead(e, faster_ahead(in, k));
        else
            state_.shift(Real(in.to_position) * e, Real(in.to_velocity) * e);
        begun_at_ = newer_.seen(state_);
        begun_with_ = newer_.seen_velocity(state_);
    }
    /// The part of the period in which the older command acts.
    void begin(const pass_input& in, std::size_t k) {
        if (!delay_.split) return;
        if (delay_.all_late)
            advance(older_, state_, command(in, k, 1), delay_.late, in.substeps);
        else {
            auto moved = state_;
            advance(older_, moved, command(in, k, 1), delay_.late, in.substeps);
            state_.take(greater(delay_.late, Real(0)), moved);
        }
    }
    /// The rest of it.
    void end(const pass_input& in, std::size_t k) {
        advance(newer_, state_, command(in, k, 0), Real(in.period) - delay_.late, in.substeps);
        if (!in.acceleration) return;
        // Second difference of the model's positions. Its corrections at row k are taken out: the velocity's by
        // the jump between the two periods, the position's because each way begins behind it.
        const Real way = newer_.seen(state_) - begun_at_, period(in.period);
        keep(in, in.acceleration, k,
             k == 0 ? Real(0)
                    : ((ended_with_ - begun_with_) * period + way - way_) * Real(1 / (in.period * in.period)));
        way_ = way;
        ended_with_ = newer_.seen_velocity(state_);
    }

private:
    struct delay {
        std::array<std::size_t, width> whole{}; ///< periods
        Real late{0};                           ///< the older command's part of a period [s]
        bool split = false, all_late = false, same = true;
    };
    static delay delays(const pass_input& in) {
        delay out;
        for (std::size_t i = 0; i < width; ++i) {
            const double given = in.plant_of[i < in.plants ? i : in.plants - 1].delay;
            const double d = given > 0 ? given : 0;
            out.whole[i] = static_cast<std::size_t>(d / in.period);
            set_lane(out.late, i, d - static_cast<double>(out.whole[i]) * in.period);
            out.same = out.same && out.whole[i] == out.whole[0];
        }
        const auto late = greater(out.late, Real(0));
        out.split = any(late);
        out.all_late = all(late);
        return out;
    }
    lane_group(const pass_input& in, const delay& d)
        : lane_group(in, d,
                     axis::side_by_side(
                         in.plants, [&](std::size_t i) -> const auto& { return in.plant_of[i].axis; })) {}
    lane_group(const pass_input& in, const delay& d, const typename axis::parameters& boxes)
        : delay_(d), older_(boxes, select(greater(d.late, Real(0)), d.late, Real(in.period)) * part(in),
                            already_checked()),
          newer_(boxes, (Real(in.period) - d.late) * part(in), already_checked()),
          state_(axis::state::at(newer_.position_of(Real(in.position[0])))) {}

    /// By how much the motion that is led along is faster in the period that begins at row k: with the velocity
    /// of the period before, each friction would act a row late.
    Real faster_ahead(const pass_input& in, std::size_t k) const {
        if (k + 1 == in.rows) return Real(0); // no period begins there
        return Real((in.position[k + 1] - in.position[k]) / in.period) - newer_.seen_velocity(state_);
    }
    static Real part(const pass_input& in) { return Real(1 / static_cast<double>(in.substeps)); }
    /// Through a part of the period of this length.
    void advance(const axis& a, typename axis::state& s, const Real& u, const Real& length, std::size_t steps) {
        if (steps == 1) {
            a.advance(s, u, now_);
            now_.time = now_.time + length;
            return;
        }
        const Real step = length * Real(1 / static_cast<double>(steps));
        for (std::size_t i = 0; i < steps; ++i) {
            a.advance(s, u, now_);
            now_.time = now_.time + step;
        }
    }
    Real command(const pass_input& in, std::size_t k, std::size_t more) const {
        if (in.command_of) return command_of_each(in, k, more);
        const auto row = [&](std::size_t back) { return in.command[k >= back ? k - back : 0]; };
        if (delay_.same) return Real(row(delay_.whole[0] + more));
        return each_lane([&](std::size_t i) { return row(delay_.whole[i] + more); });
    }
    Real command_of_each(const pass_input& in, std::size_t k, std::size_t more) const {
        return each_lane([&](std::size_t i) {
            const std::size_t back = delay_.whole[i] + more;
            return in.command_of[i < in.plants ? i : in.plants - 1][k >= back ? k - back : 0];
        });
    }
    /// Gathered in memory and read at once: no lane waits for the one before it.
    template <class NumberOf> static Real each_lane(const NumberOf& number_of) {
        std::array<double, width> out;
        for (std::size_t i = 0; i < width; ++i) out[i] = number_of(i);
        return Real(out);
    }
    static void keep(const pass_input& in, double* const* out, std::size_t k, const Real& value) {
        const auto numbers = value.each();
        for (std::size_t i = 0; i < width && i < in.plants; ++i) out[i][k] = numbers[i];
    }

    delay delay_;
    axis older_, newer_;
    typename axis::state state_;
    typename axis::surroundings now_{};
    Real begun_at_{0}, begun_with_{0}; ///< load at the start of the period: position, velocity
    Real way_{0}, ended_with_{0};      ///< in the period before: way, velocity at its end
};

/// The observer of predictor.hpp on up to lanes times groups plants, from the first row to the last. The groups
/// take turns, so that the processor works on the next one while a step waits for its own last result.
template <class Real> void pass(const pass_input& in) {
    constexpr std::size_t width = lane_count<Real>;
    std::vector<lane_group<Real>> groups;
    std::vector<pass_input> parts;
    for (std::size_t first = 0; first < in.plants; first += width) {
        parts.push_back(in.from(first, width));
        groups.emplace_back(parts.back());
    }
    const std::size_t n = groups.size();
    for (std::size_t k = 0; k < in.rows; ++k) {
        for (std::size_t g = 0; g < n; ++g) groups[g].correct(parts[g], k);
        for (std::size_t g = 0; g < n; ++g) groups[g].begin(parts[g], k);
        for (std::size_t g = 0; g < n; ++g) groups[g].end(parts[g], k);
    }
}

} // namespace detail

/// What takes the time of a fit, compiled for one instruction set: the observer's pass for any number of
/// plants, and products of the signals that come out of it.
struct pass_table {
    void (*one)(const pass_input&);
    void (*two)(const pass_input&);
    void (*four)(const pass_input&);
    void (*more)(const pass_input&);
    void (*products)(const products_input&);
    void (*closed)(const closed_input&);
};
template <class Isa = isa::here>
inline constexpr pass_table passes_of{&detail::pass<lanes<1, Isa>>,
                                      &detail::pass<lanes<2, Isa>>,
                                      &detail::pass<lanes<detail::register_width<Isa, 4>, Isa>>,
                                      &detail::pass<lanes<detail::register_width<Isa>, Isa>>,
                                      &detail::products<lanes<detail::register_width<Isa>, Isa>>,
                                      &detail::closed_pass<lanes<detail::register_width<Isa>, Isa>>};

/// All plants of `in`.
inline void pass_all(const pass_input& in, const pass_table& by) {
    (in.plants > 4 ? by.more : in.plants > 2 ? by.four : in.plants > 1 ? by.two : by.one)(in);
}

} // namespace quadrant::inline v0::diagnosis
