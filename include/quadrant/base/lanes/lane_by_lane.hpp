// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../finite.hpp"
#include "../signal.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace quadrant::inline v0 {

/// W blocks of one lane behind the call of one block in lanes: for a law whose state holds whole numbers (where
/// in a ring the delay of this lane is read). It loops over its lanes and costs what W blocks cost. The blocks
/// run in lanes<1>, a double that carries the instruction set in its type.
/// Lane i's block is of(i); what is not a verb of all blocks is asked of it, such as response.
template <class Block, several_lanes Real> class lane_by_lane {
public:
    static constexpr std::size_t size = lane_count<Real>;
    using input = typename Block::input;
    using output = typename Block::output;
    using argument = quantity_of<input, Real>;
    using value = quantity_of<output, Real>;
    using number = Real; ///< of parameters
    using single = typename Real::single;
    using mask = mask_of<Real>;
    using state = std::array<typename Block::state, size>; ///< that of each lane

    value operator()(argument x) noexcept {
        const std::array<double, size> in = x.value().each();
        std::array<double, size> out;
        for (std::size_t i = 0; i < size; ++i)
            out[i] = each_[i](Block::argument::from_value(single(in[i]))).value()[0];
        return value::from_value(Real(out));
    }
    void reset() noexcept {
        for (Block& block : each_) block.reset();
    }
    void settle(argument x) noexcept {
        for (std::size_t i = 0; i < size; ++i) each_[i].settle(in_real<single>(lane(x, i)));
    }
    void shift(argument by) noexcept requires requires(Block& b, typename Block::argument x) { b.shift(x); }
    {
        for (std::size_t i = 0; i < size; ++i) each_[i].shift(in_real<single>(lane(by, i)));
    }

    /// The block of lane i.
    Block& of(std::size_t i) noexcept { return each_[i]; }
    const Block& of(std::size_t i) const noexcept { return each_[i]; }
    state now() const noexcept {
        state out;
        for (std::size_t i = 0; i < size; ++i) out[i] = each_[i].now();
        return out;
    }
    bool faulted() const noexcept { return any(faulted_lanes()); } ///< some lane has a fault
    mask faulted_lanes() const noexcept {
        mask out;
        for (std::size_t i = 0; i < size; ++i) out.set(i, each_[i].faulted());
        return out;
    }

protected:
    /// parameters_of(i): those of lane i, as the block in double takes them.
    template <class ParametersOf>
    lane_by_lane(const ParametersOf& parameters_of, duration period)
        : lane_by_lane(parameters_of, period, std::make_index_sequence<size>()) {}
    void retune_each(const lane_by_lane& next) noexcept { ///< lane i as lane i of `next`
        for (std::size_t i = 0; i < size; ++i) each_[i].retune(next.each_[i]);
    }

private:
    template <class ParametersOf, std::size_t... I>
    lane_by_lane(const ParametersOf& parameters_of, duration period, std::index_sequence<I...>)
        : each_{Block(parameters_of(I), period)...} {}

    std::array<Block, size> each_;
};

} // namespace quadrant::inline v0
