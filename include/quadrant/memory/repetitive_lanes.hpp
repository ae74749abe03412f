// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/lanes/lane_by_lane.hpp"
#include "../base/units.hpp"
#include "repetitive_reader.hpp"

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

/// A repetitive memory in lanes: what its two forms, lane by lane and in step, have in common, and the first.
namespace quadrant::inline v0::detail {

/// Parameters of several memories in lanes: as those of one, each for all lanes; `ahead` and `fade` are common
/// to them.
template <class One, std::size_t Order, std::size_t LearningTaps, std::size_t SmoothingTaps, class Real>
struct repetitive_lanes {
    using single = typename One::number;

    quantity<si::time, Real> cycle;
    std::array<Real, Order> weights{Real(1)};
    std::array<Real, LearningTaps> learning{Real(1)};
    std::size_t ahead = 0;
    std::array<Real, SmoothingTaps> smoothing = only_the_middle<Real, SmoothingTaps>();
    duration fade{};

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

/// One memory a lane; the call loops over them. `One`: the memory of one lane.
template <class One, std::size_t Order, std::size_t LearningTaps, std::size_t SmoothingTaps, class Real>
class repetitive_lane_by_lane : public lane_by_lane<One, Real> {
    using single = typename Real::single;

public:
    using parameters = repetitive_lanes<One, Order, LearningTaps, SmoothingTaps, Real>;
    repetitive_lane_by_lane(const parameters& p, duration period)
        : lane_by_lane<One, Real>([&](std::size_t i) { return p.of(i); }, period), given_(p) {}
    using lane_by_lane<One, Real>::settle;
    void settle(typename repetitive_lane_by_lane::argument x,
                typename repetitive_lane_by_lane::value y) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i)
            this->of(i).settle(in_real<single>(lane(x, i)), in_real<single>(lane(y, i)));
    }
    /// Of what repeats in each lane, from the next step on.
    void cycle(quantity<si::time, Real> d) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i) this->of(i).cycle(in_real<single>(lane(d, i)));
    }
    void retune(const repetitive_lane_by_lane& next) noexcept {
        for (std::size_t i = 0; i < lane_count<Real>; ++i) this->of(i).retune(next.of(i));
        given_ = next.given_;
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
};

} // namespace quadrant::inline v0::detail
