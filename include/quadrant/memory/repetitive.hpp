// SPDX-License-Identifier: BSL-1.0
// Long: one block; taken apart, g++ makes two instructions more of its step (sh benchmarks/callgrind.sh).
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"
#include "../base/lanes/lane_by_lane.hpp"
#include "../base/standstill.hpp"
#include "cubic_weights.hpp"
#include "cycle_change.hpp"
#include "fir.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <type_traits>

namespace quadrant::inline v0 {

namespace detail {
template <std::size_t Order, std::size_t LearningTaps, std::size_t SmoothingTaps>
concept repeats = Order >= 1 && LearningTaps >= 1 && SmoothingTaps % 2 == 1;
} // namespace detail

/// Repetitive memory loop: learns, cycle after cycle, what to add to the position error so that an error that
/// returns with the same cycle (a circle, a turning cutter) dies out.
///   r = sum over i = 1 ... Order of w[i] z^{-i N} Q(z) (e + r),   y = L(z) r, added to e by the loop;   N = cycle / period
/// Q low-pass, symmetric, read without phase; L reads `ahead` samples ahead: both look into the cycle before.
/// Source: [Jamaludin2008] ch. 5 (repetitive control); weights of order 2 and above trade a cycle that is not
/// quite known against errors that do not repeat. N need not be whole: cubic interpolation of Q (e + r),
/// [Laakso1996].
/// Ports: error in, what to add to it out, the same signal; y[k] does not depend on e[k].
/// State: Order cycles of Q (e + r) and the taps of L and Q; `reset` leaves zeros and the cycle of the
/// parameters; `settle(x)` the state of a constant x. With sum w Q(1) = 1 (integrates(), the usual case) no
/// such state exists: `settle(x, y)`, where the next step gives y; settle(x) then takes the last output for y.
/// A memory that gives constants no way out (weights, Q or L of sum zero) has no state for a y but zero:
/// settle(x, y) then leaves that of a constant x. `cycle(d)` changes N between two steps; the memory is read in
/// the old and the new way and one is faded into the other during `fade`, so y never jumps. A change asked for
/// during a fade starts after it; the last one asked for wins. The r that L reads then moves by 1/F of what the
/// two ways differ by, each of the F steps of the fade, y by sum |l| times that. `retune(next)`: other filters,
/// weights and cycle (by fading), the same ahead; what was learnt stays. Jump = |sum l_j' r_j' - l_j r_j| <=
/// sum |l' - l| max |r| + 1.25 |l_0'| sum |w' - w| max |p|, p = Q (e + r); the new Q is heard a cycle later.
/// Range: (ahead + (SmoothingTaps - 1)/2 + 2) periods <= cycle <= Capacity periods; cycle(d) outside saturates,
/// and limited() reports it. Stable where |Q W (1 - L T)| < 1, T the loop's complementary sensitivity:
/// analysis/repetitive_design.hpp.
/// NaN and infinities: holds the last output, keeps the state, raises faulted().
/// Throws "repetitive.<field> = ...: must ..." for period, cycle, fade, weights, learning, ahead, smoothing.
/// Cost: LearningTaps + SmoothingTaps + 4 Order multiplications (8 Order in a fade), 8 (Order Capacity + 2 both
/// taps) bytes. Q and L are summed in four parts (SIMD where there is one): detail::fir_taps says how far that
/// is from the exact sum.
/// A delay alone: `delay_line`.
template <signal_tag Signal, std::size_t Capacity, std::size_t Order = 1, std::size_t LearningTaps = 90,
          std::size_t SmoothingTaps = 61, class Real = double>
requires detail::repeats<Order, LearningTaps, SmoothingTaps>
class repetitive {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters
    static constexpr std::size_t half = SmoothingTaps / 2;

    /// The cycle, its filters and weights, and how fast another cycle takes over.
    struct parameters {
        quantity<si::time, number> cycle; ///< what repeats; (ahead + half + 2) ... Capacity periods
        std::array<number, Order> weights{
            number(1)}; ///< w[1] first; their sum 1 lets nothing of the cycle through
        std::array<number, LearningTaps> learning{number(1)}; ///< L, the tap `ahead` samples ahead first
        std::size_t ahead = 0;                                ///< below LearningTaps
        std::array<number, SmoothingTaps> smoothing = only_the_middle(); ///< Q, symmetric
        duration fade{};                                                 ///< of a change of cycle; 0: one cycle

        static constexpr std::array<number, SmoothingTaps> only_the_middle() {
            std::array<number, SmoothingTaps> q{};
            q[SmoothingTaps / 2] = number(1);
            return q;
        }
    };
    /// The cycles that were learnt, and the samples that are inside the filters.
    struct state {
        detail::fir_window<value, detail::fir_taps<Real, SmoothingTaps>::size> m{}; ///< e + r
        detail::fir_window<value, detail::fir_taps<Real, LearningTaps>::size> r{}; ///< r, `ahead` samples early
        std::array<value, Order * Capacity + 5>
            p{};                ///< ring of Q (e + r), `half` samples late; its first three again at the end
        std::size_t next_p = 0; ///< where the coming p goes
        std::size_t fading = 0; ///< steps left of a change of cycle
    };

    repetitive(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive<Real>("repetitive.period", period);
        require_not_negative<Real>("repetitive.fade", p.fade);
        require(p.ahead < LearningTaps, "repetitive.ahead", double(p.ahead),
                "must be below the taps of learning (" + detail::shortest(double(LearningTaps)) + ")");
        const double least = double(p.ahead + half + 2), cycles = detail::plain(p.cycle) / period.value();
        require(detail::cycle_change<number>::fits(cycles, least, double(Capacity)), "repetitive.cycle",
                p.cycle,
                "must lie between " + detail::shortest(least * period) +
                    " (look-ahead of learning and smoothing, and two periods) and " +
                    detail::shortest(double(Capacity) * period) + " (capacity)");
        for (std::size_t i = 0; i < Order; ++i) {
            require_finite<Real>("repetitive.weights", p.weights[i]);
            weights_[i] = Real(p.weights[i]);
        }
        for (std::size_t i = 0; i < LearningTaps; ++i) {
            require_finite<Real>("repetitive.learning", p.learning[i]);
            learning_[i] = Real(p.learning[i]);
        }
        for (std::size_t i = 0; i < SmoothingTaps; ++i) {
            const double one = detail::plain(p.smoothing[i]),
                         other = detail::plain(p.smoothing[SmoothingTaps - 1 - i]);
            require_finite<Real>("repetitive.smoothing", p.smoothing[i]);
            require(std::abs(one - other) <= 1e-12 * (std::abs(one) + std::abs(other)), "repetitive.smoothing",
                    p.smoothing[i], "must be symmetric (linear phase)");
            smoothing_[i] = Real(p.smoothing[i]);
        }
        reset();
    }

    value operator()(argument e) noexcept {
        value early = read(reader_);
        if (state_.fading > 0) [[unlikely]]
            early += Real(cycle_.left(state_.fading)) * (read(old_reader_) - early);
        state_.r.put(early);
        const value m = e + state_.r.ago(given_.ahead);
        state_.m.put(m);
        const value p = smoothing_(state_.m.oldest()), y = learning_(state_.r.oldest());
        if (none(finite(early, m, p, y))) return out_.hold();
        const std::size_t now = state_.next_p;
        state_.p[now] = unless_died_out(p);
        if (now < 3) state_.p[now + size_p] = state_.p[now];
        state_.next_p = now + 1 == size_p ? 0 : now + 1;
        state_.m.advance();
        state_.r.advance();
        if (state_.fading > 0 && --state_.fading == 0 && cycle_.is_pending()) [[unlikely]]
            start();
        return out_.keep(y);
    }
    void reset() noexcept {
        state_ = state();
        cycle_.begin(given_.cycle.value() / number(period_.value()));
        reader_ = old_reader_ = reader(cycle_.periods());
        out_.reset();
    }
    void settle(argument x) noexcept { stand(x, out_.last(), false); }
    void settle(argument x, value y) noexcept { stand(x, y, true); }

    /// Of what repeats, from the next step on; see above.
    void cycle(quantity<si::time, number> d) noexcept {
        if (none(finite(d))) return out_.raise();
        if (cycle_.ask(d.value() / number(period_.value()), double(given_.ahead + half + 2), double(Capacity),
                       state_.fading > 0))
            start();
    }
    void retune(const repetitive& next) noexcept {
        if (next.period_ != period_ || next.given_.ahead != given_.ahead) return out_.raise();
        given_ = next.given_;
        weights_ = next.weights_;
        learning_ = next.learning_;
        smoothing_ = next.smoothing_;
        reader_ = reader(cycle_.periods());
        cycle(given_.cycle);
    }
    quantity<si::time, number> cycle() const noexcept {
        return cycle_.periods() * quantity<si::time, number>::from_value(number(period_.value()));
    }

    /// From e to y, at the cycle that is being faded to.
    std::complex<double> response(frequency f) const {
        const double angle = -2 * std::numbers::pi * f.value() * period_.value();
        std::complex<double> memory = 0, q = 0, l = 0;
        for (std::size_t i = 0; i < Order; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                memory += detail::plain(reader_.weight[i][j]) *
                          std::polar(1.0, angle * double(reader_.oldest[i] + j - 3 + given_.ahead));
        for (std::size_t i = 0; i < SmoothingTaps; ++i)
            q += detail::plain(smoothing_[i]) * std::polar(1.0, angle * double(i));
        for (std::size_t i = 0; i < LearningTaps; ++i)
            l += detail::plain(learning_[i]) * std::polar(1.0, angle * (double(i) - double(given_.ahead)));
        return l * memory * q / (1.0 - memory * q);
    }
    bool integrates() const noexcept { ///< has a pole at z = 1
        return std::abs(detail::plain(smoothing_.sum()) * detail::plain(sum(weights_)) - 1) <= whole_tolerance;
    }
    bool fading() const noexcept { return state_.fading > 0; }
    bool limited() const noexcept { return cycle_.limited(); } ///< the last cycle(d) lay outside the range
    bool faulted() const noexcept { return out_.faulted(); }
    const parameters& given() const noexcept { return given_; }
    const state& now() const noexcept { return state_; }

private:
    template <signal_tag S, std::size_t C, std::size_t O, std::size_t L, std::size_t Q, class R>
    requires detail::repeats<O, L, Q>
    friend class repetitive; // the one in lanes takes its cycle apart the same way

    static constexpr double whole_tolerance = ///< of the sum of a Q and weights that let nothing through
        16 * double(SmoothingTaps) * (sizeof(Real) < sizeof(double) ? 6e-8 : 1.1e-16);
    static constexpr std::size_t size_p = Order * Capacity + 2;

    /// Which samples of p make r, and how much of each.
    struct memory_reader {
        std::array<std::size_t, Order> oldest{}; ///< of the four: how far before the coming p
        std::array<std::array<Real, 4>, Order> weight{};
    };
    memory_reader reader(number periods) const noexcept {
        return reader_for(periods, given_.weights, given_.ahead);
    }
    static memory_reader reader_for(number periods, const std::array<number, Order>& weights,
                                    std::size_t ahead) noexcept {
        const number least(double(ahead + half + 2)), most{double(Capacity)};
        if (detail::plain(periods) < detail::plain(least)) periods = least; // by rounding
        if (detail::plain(periods) > detail::plain(most)) periods = most;
        memory_reader out;
        for (std::size_t i = 0; i < Order; ++i) {
            const number delay = number(double(i + 1)) * periods;
            const double whole = std::floor(detail::plain(delay));
            const auto cubic = detail::cubic_weights(number(delay - number(whole)));
            out.oldest[i] = std::size_t(whole) - ahead - half + 2;
            for (std::size_t j = 0; j < 4; ++j) out.weight[i][j] = Real(weights[i] * cubic[j]);
        }
        return out;
    }
    value read(const memory_reader& from) const noexcept {
        value all{};
        for (std::size_t i = 0; i < Order; ++i) {
            const std::size_t by = from.oldest[i], next = state_.next_p;
            const value* oldest = &state_.p[next >= by ? next - by : next + size_p - by];
            for (std::size_t j = 0; j < 4; ++j) all += from.weight[i][j] * oldest[3 - j];
        }
        return all;
    }
    void start() noexcept {
        const std::size_t steps = cycle_.start(given_.fade.value(), period_.value());
        if (steps == 0) return;
        state_.fading = steps;
        old_reader_ = reader_;
        reader_ = reader(cycle_.periods());
    }
    /// What a memory at rest holds: m = e + r, r, and its output.
    struct standing {
        value m{}, r{}, y{};
    };
    /// At the input x, or, where any output may stand at one input or `has_output`, at the output y. `gain`:
    /// sum of L; g: of Q and the weights.
    static standing at_rest(value x, value y, bool has_output, const Real& gain, const Real& g) noexcept {
        const bool any_output = std::abs(detail::plain(g) - 1) <= whole_tolerance;
        if ((has_output || any_output) && detail::plain(gain) != 0 && detail::plain(g) != 0) {
            const value r = y / gain;
            return {r / g, r, y};
        }
        if (any_output) return {};
        const value r = g / (Real(1) - g) * x;
        return {x + r, r, gain * r};
    }
    void stand(value x, value y, bool has_output) noexcept {
        if (none(finite(x, y))) return out_.raise();
        const Real q = smoothing_.sum();
        const standing now = at_rest(x, y, has_output, learning_.sum(), q * sum(weights_));
        const value p = q * now.m;
        if (none(finite(now.m, p, now.r, now.y))) return out_.raise();
        state_.m.x.fill(now.m), state_.p.fill(p), state_.r.x.fill(now.r);
        state_.fading = 0;
        if (cycle_.is_pending()) start();
        state_.fading = 0; // nothing to fade: both cycles read the same
        out_.reset(now.y);
    }

    static Real sum(const std::array<Real, Order>& c) noexcept {
        Real all(0);
        for (const Real& each : c) all += each;
        return all;
    }

    parameters given_;
    duration period_;
    std::array<Real, Order> weights_{};
    detail::fir_taps<Real, LearningTaps> learning_{};
    detail::fir_taps<Real, SmoothingTaps> smoothing_{};
    detail::cycle_change<number> cycle_;
    memory_reader reader_, old_reader_;
    state state_;
    held_output<value> out_;
};

namespace detail {
/// Parameters of several memories in lanes: as those of one, each for all lanes; `ahead` and `fade` are common
/// to them.
template <class One, std::size_t Order, std::size_t LearningTaps, std::size_t SmoothingTaps, class Real>
struct repetitive_lanes {
    using single = typename One::number;

    quantity<si::time, Real> cycle;
    std::array<Real, Order> weights{Real(1)};
    std::array<Real, LearningTaps> learning{Real(1)};
    std::size_t ahead = 0;
    std::array<Real, SmoothingTaps> smoothing = only_the_middle();
    duration fade{};

    static std::array<Real, SmoothingTaps> only_the_middle() {
        std::array<Real, SmoothingTaps> q{};
        q[SmoothingTaps / 2] = Real(1);
        return q;
    }
    /// Those of lane i.
    typename One::parameters of(std::size_t i) const {
        const auto taps = [i](const auto& from) {
            std::array<single, std::tuple_size_v<std::remove_cvref_t<decltype(from)>>> out;
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = single(lane(from[k], i));
            return out;
        };
        return {in_real<single>(lane(cycle, i)), taps(weights), taps(learning), ahead, taps(smoothing), fade};
    }
};
} // namespace detail

/// In lanes: each lane has its own cycle, weights and filters, and the call loops over the lanes.
template <signal_tag Signal, std::size_t Capacity, std::size_t Order, std::size_t LearningTaps,
          std::size_t SmoothingTaps, several_lanes Real>
requires detail::repeats<Order, LearningTaps, SmoothingTaps> &&
    (!steps_together<Real>)class repetitive<Signal, Capacity, Order, LearningTaps, SmoothingTaps, Real>
    : public lane_by_lane<
          repetitive<Signal, Capacity, Order, LearningTaps, SmoothingTaps, typename Real::single>, Real> {
    using one = repetitive<Signal, Capacity, Order, LearningTaps, SmoothingTaps, typename Real::single>;

    using single = typename Real::single;

public:
    using parameters = detail::repetitive_lanes<one, Order, LearningTaps, SmoothingTaps, Real>;
    repetitive(const parameters& p, duration period)
        : lane_by_lane<one, Real>([&](std::size_t i) { return p.of(i); }, period), given_(p) {}
    using lane_by_lane<one, Real>::settle;
    void settle(typename repetitive::argument x, typename repetitive::value y) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i)
            this->of(i).settle(in_real<single>(lane(x, i)), in_real<single>(lane(y, i)));
    }
    /// Of what repeats in each lane, from the next step on.
    void cycle(quantity<si::time, Real> d) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i) this->of(i).cycle(in_real<single>(lane(d, i)));
    }
    void retune(const repetitive& next) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i) this->of(i).retune(next.of(i));
        given_ = next.given_;
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
};

} // namespace quadrant::inline v0
