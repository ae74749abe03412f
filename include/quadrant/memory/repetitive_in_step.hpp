// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "lane_fir.hpp"
#include "repetitive.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// In lanes that step together: one ring and one position in it for all of them. Each lane has its own cycle,
/// weights and filters; a sample costs little more than one lane does, since neighbouring taps of all lanes
/// fill a register. A fade is common: it starts where one lane's cycle changes.
/// The sums are those of `repetitive` in another order: see detail::lane_taps.
template <signal_tag Signal, std::size_t Capacity, std::size_t Order, std::size_t LearningTaps,
          std::size_t SmoothingTaps, several_lanes Real>
requires detail::repeats<Order, LearningTaps, SmoothingTaps> && steps_together<Real>
class repetitive<Signal, Capacity, Order, LearningTaps, SmoothingTaps, Real> {
    static constexpr std::size_t W = lane_count<Real>;
    using one = repetitive<Signal, Capacity, Order, LearningTaps, SmoothingTaps, double>;

    using pair = typename Real::template times<2>;
    using taps_of_m = detail::lane_taps<Real, SmoothingTaps>;
    using taps_of_r = detail::lane_taps<Real, LearningTaps>;

public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = Real; ///< of parameters

    using parameters = detail::repetitive_lanes<one, Order, LearningTaps, SmoothingTaps, Real>;
    /// The cycles that were learnt, and the samples that are inside the filters.
    struct state {
        detail::lane_window<W, taps_of_m::size> m{};            ///< e + r
        detail::lane_window<W, taps_of_r::size> r{};            ///< r, `ahead` samples early
        std::array<double, 2 * (Order * Capacity + 2) * W> p{}; ///< ring of Q (e + r), written twice
        std::size_t next_p = 0;                                 ///< where the coming p goes, in samples
        std::size_t fading = 0;                                 ///< steps left of a change of cycle
    };

    repetitive(const parameters& p, duration period) : given_(p), period_(period) {
        for (std::size_t i = 0; i < W; ++i) static_cast<void>(one(p.of(i), period)); // checks
        take_filters();
        reset();
    }

    value operator()(argument e) noexcept {
        Real early = read(reader_);
        if (state_.fading > 0) [[unlikely]]
            early = faded(early);
        const Real before = given_.ahead == 0 ? early : state_.r.template ago<Real>(given_.ahead);
        const Real m = e.value() + before;
        Real p, y;
        if (alike_) [[likely]] { // asked once for both filters
            p = smoothing_.alike(state_.m, m);
            y = learning_.alike(state_.r, early);
        } else {
            p = smoothing_.each(state_.m, m);
            y = learning_.each(state_.r, early);
        }
        p = unless_died_out(p);
        state_.r.put(early);
        state_.m.put(m);
        const std::size_t now = state_.next_p;
        state_.next_p = now + 1 == size_p ? 0 : now + 1;
        p.write(&state_.p[now * W]);
        p.write(&state_.p[(now + size_p) * W]);
        if (state_.fading > 0) [[unlikely]]
            fade_on();
        return out_.keep(value::from_value(y));
    }
    void reset() noexcept {
        state_ = state();
        cycle_.begin(given_.cycle.value() / Real(period_.value()));
        reader_ = old_reader_ = reader(cycle_.periods());
        out_.reset();
    }
    void settle(argument x) noexcept { stand(x.value(), out_.last().value(), false); }
    void settle(argument x, value y) noexcept { stand(x.value(), y.value(), true); }

    /// Of what repeats in each lane, from the next step on; see `repetitive`.
    void cycle(quantity<si::time, Real> d) noexcept {
        if (!all(d.value().finite_mask())) return out_.raise();
        if (cycle_.ask(d.value() / Real(period_.value()), double(given_.ahead + one::half + 2),
                       double(Capacity), state_.fading > 0))
            start();
    }
    void retune(const repetitive& next) noexcept {
        if (next.period_ != period_ || next.given_.ahead != given_.ahead) return out_.raise();
        given_ = next.given_;
        learning_ = next.learning_;
        smoothing_ = next.smoothing_;
        alike_ = next.alike_;
        reader_ = reader(cycle_.periods());
        cycle(given_.cycle);
    }
    quantity<si::time, Real> cycle() const noexcept {
        return quantity<si::time, Real>::from_value(cycle_.periods() * Real(period_.value()));
    }

    bool fading() const noexcept { return state_.fading > 0; }
    bool limited() const noexcept {
        return cycle_.limited();
    } ///< the last cycle(d) lay outside the range in some lane
    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    static constexpr std::size_t size_p = one::size_p;

    /// Which samples of p make r in each lane, and how much of each; where all lanes read the same ones, in one
    /// go.
    struct memory_reader {
        std::array<std::array<std::size_t, W>, Order> oldest{}; ///< of the four: how far before the coming p
        std::array<std::array<pair, 2>, Order> weight{};        ///< of the oldest first
        bool alike = true;
    };
    memory_reader reader(const Real& periods) const noexcept {
        memory_reader out;
        for (std::size_t i = 0; i < W; ++i) {
            const auto of_one = one::reader_for(periods[i], lane(given_.weights, i), given_.ahead);
            for (std::size_t k = 0; k < Order; ++k) {
                out.oldest[k][i] = of_one.oldest[k];
                out.alike = out.alike && out.oldest[k][i] == out.oldest[k][0];
                for (std::size_t j = 0; j < 4; ++j)
                    out.weight[k][j / 2].set(j % 2 * W + i, of_one.weight[k][3 - j]);
            }
        }
        return out;
    }
    std::size_t ring_at(std::size_t before) const noexcept { return state_.next_p + size_p - before; }
    [[gnu::always_inline]] Real read(const memory_reader& from) const noexcept {
        pair sum{};
        for (std::size_t k = 0; k < Order; ++k) {
            std::array<double, 4 * W> each;
            const double* at = &state_.p[ring_at(from.oldest[k][0]) * W];
            if (!from.alike) {
                gather(from.oldest[k], each);
                at = each.data();
            }
            sum += from.weight[k][0] * pair::read(at) + from.weight[k][1] * pair::read(at + 2 * W);
        }
        return part<W>(sum, 0) + part<W>(sum, 1);
    }
    void gather(const std::array<std::size_t, W>& oldest, std::array<double, 4 * W>& each) const noexcept {
        for (std::size_t i = 0; i < W; ++i)
            for (std::size_t j = 0; j < 4; ++j) each[j * W + i] = state_.p[(ring_at(oldest[i]) + j) * W + i];
    }
    /// Out of the way of the samples without a fade.
    [[gnu::noinline]] Real faded(const Real& early) const noexcept {
        return early + Real(cycle_.left(state_.fading)) * (read(old_reader_) - early);
    }
    [[gnu::noinline]] void fade_on() noexcept {
        if (--state_.fading == 0 && cycle_.is_pending()) start();
    }
    void start() noexcept {
        const std::size_t steps = cycle_.start(given_.fade.value(), period_.value());
        if (steps == 0) return;
        state_.fading = steps;
        old_reader_ = reader_;
        reader_ = reader(cycle_.periods());
    }
    /// Each lane as one memory is that was settled; see there.
    void stand(const Real& x, const Real& y, bool has_output) noexcept {
        if (!all((x + y).finite_mask())) return out_.raise();
        Real weights(0), to_m, to_r, to_y;
        for (const Real& w : given_.weights) weights += w;
        const Real gain = learning_.sum(), q = smoothing_.sum();
        for (std::size_t i = 0; i < W; ++i) {
            using level = typename one::value;
            const auto of_one = one::at_rest(level::from_value(x[i]), level::from_value(y[i]), has_output,
                                             gain[i], q[i] * weights[i]);
            to_m.set(i, of_one.m.value());
            to_r.set(i, of_one.r.value());
            to_y.set(i, of_one.y.value());
        }
        const Real p = q * to_m;
        if (!all((to_m + p + to_r + to_y).finite_mask())) return out_.raise();
        state_.m.fill(to_m);
        state_.r.fill(to_r);
        for (std::size_t i = 0; i < state_.p.size(); i += W) p.write(&state_.p[i]);
        state_.fading = 0;
        if (cycle_.is_pending()) start();
        state_.fading = 0; // nothing to fade: both cycles read the same
        out_.reset(value::from_value(to_y));
    }
    void take_filters() noexcept {
        learning_.set(given_.learning);
        smoothing_.set(given_.smoothing);
        alike_ = learning_.alike() && smoothing_.alike();
    }

    parameters given_;
    duration period_;
    taps_of_r learning_{};
    taps_of_m smoothing_{};
    detail::cycle_change<Real> cycle_;
    memory_reader reader_, old_reader_;
    bool alike_ = true;
    state state_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
