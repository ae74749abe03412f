// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/dual.hpp>
#include <quadrant/base/finite.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/base/signal.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

/// What the lists of blocks and of sources are made of, and what their cases need.
namespace conformance {

using namespace quadrant;
using namespace quadrant::literals;
inline const duration T = 500_us;
inline constexpr std::size_t most_parameters = 8;

/// Hands out the parameters of a block under test, numbered in the order of the calls. For a dual the number i
/// is the variable i; else the one that is `bumped` is scaled, for a difference quotient. `fixed` is for what
/// has no derivative. Of all calls together the one that is `replaced` hands out another number.
template <class Real> struct values {
    std::size_t bumped = std::size_t(-1);
    double factor = 1;
    std::size_t replaced = std::size_t(-1);
    double by = 0;
    std::size_t count = 0, calls = 0;
    std::array<double, most_parameters> given{};

    template <class Unit> quantity<Unit, parameter_real<Real>> operator()(quantity<Unit> q) {
        return quantity<Unit, parameter_real<Real>>::from_value((*this)(q.value()));
    }
    parameter_real<Real> operator()(double q) {
        const std::size_t i = count++;
        given.at(i) = q;
        q = now(q);
        if constexpr (std::is_floating_point_v<Real>)
            return i == bumped ? factor * q : q;
        else
            return Real::variable(q, i);
    }
    parameter_real<Real> fixed(double q) { return parameter_real<Real>(now(q)); }
    template <class Unit> quantity<Unit, parameter_real<Real>> fixed(quantity<Unit> q) {
        return quantity<Unit, parameter_real<Real>>::from_value(fixed(q.value()));
    }

private:
    double now(double q) { return calls++ == replaced ? by : q; }
};
template <class Make> struct entry {
    std::string name;
    double amplitude; ///< of the input, SI; a power of two, so that float, double and dual see the same numbers
    Make make;

    template <class Real> auto operator()(values<Real> given = {}) const { return make(given); }
};
template <class Make> entry(const char*, double, Make) -> entry<Make>;

namespace s = quadrant::signal;

/// How often this program has allocated.
std::size_t allocated();

template <class Block, class Real> using input_of = quantity_of<typename Block::input, Real>;
template <class Block>
concept linear = requires(const Block& b) {
    b.response(1_Hz);
};

/// A number that the compiler cannot know: with -ffast-math it may work out one operation with a NaN or an
/// overflow that it sees as anything at all, and then it would be the test that has no number to give.
template <class Real> Real unknown(Real x) {
    volatile Real hidden = x;
    return hidden;
}
/// One sample, always by the same piece of code: with -ffast-math two of them may round differently, and
/// outputs that are compared bit for bit would differ for no fault of the block.
template <class Block, class... X> [[gnu::noinline]] auto one_sample(Block& block, X... x) {
    return block(x...);
}

/// Repeatable input between -amplitude and amplitude in steps of 1/1024: exact in float, and never at a switch
/// of a block.
class noise {
public:
    explicit noise(std::uint32_t seed = 1) : x_(seed) {}
    double operator()(double amplitude) {
        x_ = x_ * 1664525u + 1013904223u;
        return amplitude * (double(x_ >> 22) * 2 - 1023) / 1024;
    }

private:
    std::uint32_t x_;
};

} // namespace conformance
