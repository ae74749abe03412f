// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

/// Sources that are added to a wire to measure it: `wire.command = ... + excite();`, or by type, `injected`.
/// Each call gives the coming sample; `now()` returns the last one again, for the FRF. No step allocates.
namespace quadrant::inline v0::analysis {

/// A sine of rising (or falling) frequency, once; then zero.
///   logarithmic: f(t) = from (to/from)^(t/length), the same time for every octave; linear: the same for every hertz
/// Faded in and out by half a cosine, so that it neither starts nor ends with a step.
/// Throws "chirp.<field> = ...: must ...".
template <signal_tag Signal> class chirp {
public:
    using output = Signal;
    using value = quantity_of<Signal>;
    /// Size, band and length of the sweep.
    struct parameters {
        value amplitude;         ///< peak; finite
        frequency from, to;      ///< above 0, below half the sampling rate
        duration length;         ///< of the whole sweep, > 0
        duration fade{};         ///< at either end, 0 ... length/2
        bool logarithmic = true; ///< else linear
    };
    chirp(const parameters& p, duration period) : given_(p), period_(period) {
        require_positive("chirp.period", period);
        require_finite("chirp.amplitude", p.amplitude);
        require_below_nyquist("chirp.from", p.from, period);
        require_below_nyquist("chirp.to", p.to, period);
        require_positive("chirp.length", p.length);
        require(p.fade >= duration() && p.fade <= 0.5 * p.length, "chirp.fade", p.fade,
                "must lie between 0 and half the length (" + quadrant::detail::shortest(0.5 * p.length) + ")");
    }
    value operator()() noexcept {
        now_ = done() ? value() : at(double(step_) * period_);
        ++step_;
        return now_;
    }
    bool done() const noexcept { return double(step_) * period_ > given_.length; }
    value now() const noexcept { return now_; }
    void reset() noexcept { step_ = 0, now_ = value(); }
    const parameters& given() const noexcept { return given_; }

private:
    value at(duration t) const noexcept {
        const double u = t / given_.length, ratio = given_.to / given_.from, turn = 2 * std::numbers::pi;
        const double cycles = given_.from.value() * given_.length.value(); // at the first frequency
        const double phase = given_.logarithmic && ratio != 1
                                 ? turn * cycles * (std::pow(ratio, u) - 1) / std::log(ratio)
                                 : turn * cycles * (u + 0.5 * (ratio - 1) * u * u);
        const duration edge = std::min(t, duration(given_.length - t));
        const double in = given_.fade > duration() ? std::min(1.0, double(edge / given_.fade)) : 1;
        return given_.amplitude * (0.5 * (1 - std::cos(std::numbers::pi * in)) * std::sin(phase));
    }

    parameters given_;
    duration period_;
    std::size_t step_ = 0;
    value now_{};
};

/// Sines at whole multiples of 1/record, all of one size, repeated for ever: what an FRF can measure without
/// leakage.
/// Phases: by Schroeder (low crest, the same each time) or at random from a seed (other phases show what is not
/// linear). Scaled so that the largest sample is `amplitude`.
/// Throws "multisine.<field> = ...: must ...", also when no line falls between from and to.
template <signal_tag Signal> class multisine {
public:
    using output = Signal;
    using value = quantity_of<Signal>;
    /// Size and lines of the excitation, in hertz and in samples of its record.
    struct parameters {
        value amplitude;           ///< largest sample; finite
        frequency from, to;        ///< of the lines, both included
        std::size_t record = 2048; ///< samples after which it repeats; 4 ... 2^24
        std::size_t every = 1;     ///< 2: only odd lines (of 1/record), so that even distortion shows; 1: all
        std::uint32_t seed = 0;    ///< 0: Schroeder phases; else random ones
    };
    multisine(const parameters& p, duration period) : given_(p) {
        require_positive("multisine.period", period);
        require_finite("multisine.amplitude", p.amplitude);
        require_below_nyquist("multisine.from", p.from, period);
        require_below_nyquist("multisine.to", p.to, period);
        require(p.record >= 4 && p.record <= (std::size_t(1) << 24), "multisine.record", double(p.record),
                "must lie between 4 and 2^24 samples");
        require(p.every == 1 || p.every == 2, "multisine.every", double(p.every), "must be 1 or 2");
        const double line = 1 / (double(p.record) * period.value()), slack = 1e-9;
        auto first = std::size_t(std::max(1.0, std::ceil(p.from.value() / line - slack)));
        const auto last = std::size_t(std::floor(p.to.value() / line + slack));
        if (p.every == 2 && first % 2 == 0) ++first;
        for (std::size_t k = first; k <= last && 2 * k < p.record; k += p.every) lines_.push_back(k);
        require(!lines_.empty(), "multisine.to", p.to,
                "must leave a multiple of " + quadrant::detail::shortest(line) +
                    " Hz (1/record) above multisine.from");
        // One turn of a cosine, read at (k n) mod record: no sine is evaluated record times lines times.
        std::vector<double> x(p.record), turn(p.record);
        for (std::size_t n = 0; n < p.record; ++n)
            turn[n] = std::cos(2 * std::numbers::pi * double(n) / double(p.record));
        std::uint32_t random = p.seed;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            random = random * 1664525u + 1013904223u;
            const double share = double(random >> 8) / double(1u << 24); // of a turn
            const double schroeder = -0.5 * double(i) * double(i + 1) / double(lines_.size());
            const double wrapped = p.seed != 0 ? share : schroeder - std::floor(schroeder);
            auto at = std::size_t(wrapped * double(p.record)) % p.record;
            for (std::size_t n = 0; n < p.record; ++n) {
                x[n] += turn[at];
                at = (at + lines_[i]) % p.record;
            }
        }
        double most = 0;
        for (const double each : x) most = std::max(most, std::abs(each));
        for (const double each : x) samples_.push_back(each / most * p.amplitude);
    }
    value operator()() noexcept {
        now_ = samples_[step_];
        step_ = step_ + 1 == samples_.size() ? 0 : step_ + 1;
        return now_;
    }
    value now() const noexcept { return now_; }
    void reset() noexcept { step_ = 0, now_ = value(); }
    const parameters& given() const noexcept { return given_; }
    const std::vector<std::size_t>& lines() const noexcept { return lines_; } ///< multiples of 1/record

private:
    parameters given_;
    std::vector<std::size_t> lines_;
    std::vector<value> samples_;
    std::size_t step_ = 0;
    value now_{};
};

/// A box with a source added behind it: put `injected<notch<force>, chirp<force>>` where the notch was, and the
/// cascade is excited at that wire, nothing redrawn. What was added: `source().now()`.
template <class Block, class Source>
requires std::same_as<typename Block::output, typename Source::output>
class injected {
public:
    using input = typename Block::input;
    using output = typename Block::output;
    using argument = typename Block::argument;
    using value = typename Block::value;
    /// Those of the box that is excited and of the source behind it.
    struct parameters {
        typename Block::parameters block;
        typename Source::parameters source;
    };
    injected(const parameters& p, duration period) : block_(p.block, period), source_(p.source, period) {}

    value operator()(argument x) noexcept { return block_(x) + source_(); }
    void reset() noexcept { block_.reset(), source_.reset(); }
    void settle(argument x) noexcept requires requires(Block b) { b.settle(x); }
    { block_.settle(x); }
    bool faulted() const noexcept { return block_.faulted(); }
    const Block& block() const noexcept { return block_; }
    const Source& source() const noexcept { return source_; }

private:
    Block block_;
    Source source_;
};

} // namespace quadrant::inline v0::analysis
