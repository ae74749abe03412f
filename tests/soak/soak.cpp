// SPDX-License-Identifier: BSL-1.0
// usage: soak SAMPLES [PART OF]
// Every block of tests/conformance/blocks.hpp in double for so many samples; PART 0 ... OF - 1 of the blocks
// alone, so that several processes share the work. The plants that integrate in sub-steps, which run in
// simulations and not in a servo loop, make so many sub-steps: a tenth of the calls where a period has ten.
// Stretches of noise, of a held value, of rest and of a slow sine, of random length. A line a block; exit code
// 1 where one raised a fault, gave what is no finite number, allocated, or is not as new after a reset.
#include "conformance/blocks.hpp"
#include "count_allocations.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {
using namespace conformance;

/// What a machine gives a block over the years.
class years {
public:
    explicit years(double amplitude) : amplitude_(amplitude) {}
    double operator()() {
        if (left_-- == 0) begin();
        if (kind_ == 0) return next_(amplitude_);
        if (kind_ == 1) return held_;
        if (kind_ == 2) return 0;
        phase_ += pace_;
        if (phase_ > 1) phase_ -= 2;
        return amplitude_ * 4 * phase_ * (1 - std::abs(phase_)); // near a sine
    }

private:
    void begin() {
        const double which = next_(1);
        left_ = std::uint32_t(1) << std::uint32_t(4 + 8 * (1 + next_(1))); // 16 ... 1e6 samples
        kind_ = which < -0.25 ? 0 : which < 0.25 ? 1 : which < 0.5 ? 2 : 3;
        held_ = next_(amplitude_);
        pace_ = std::exp2(-12 + 6 * next_(1));
    }

    double amplitude_, held_ = 0, phase_ = 0, pace_ = 0;
    noise next_{3};
    std::uint32_t left_ = 0;
    int kind_ = 0;
};

/// Sub-steps of one call: those of the plant, 1 for every other block.
template <class Block> std::uint64_t steps_of(const Block& block) {
    if constexpr (requires { block.given().substeps; })
        return block.given().substeps;
    else if constexpr (requires { block.given().steps; })
        return block.given().steps;
    else if constexpr (requires { block.box.motor; })
        return steps_of(block.box.motor);
    else
        return 1;
}

template <class Block>
bool soaked(const char* name, double amplitude, const Block& fresh, std::uint64_t samples) {
    using in = input_of<Block, double>;
    const auto give = [](Block& b, double x) { return detail::plain(b(in::from_value(x)).value()); };
    Block block = fresh;
    years input(amplitude);
    double most = 0;
    std::uint64_t not_finite = 0;
    const std::uint64_t steps = steps_of(fresh), calls = (samples + steps - 1) / steps;
    const std::size_t before = counted::allocations;
    for (std::uint64_t k = 0; k < calls; ++k) {
        const double y = give(block, input());
        not_finite += !std::isfinite(y);
        most = std::abs(y) > most ? std::abs(y) : most;
    }
    const bool faulted = block.faulted(), allocated = counted::allocations != before;
    block.reset();
    Block as_new = fresh;
    as_new.reset();
    noise again(9);
    bool same = !block.faulted();
    for (int k = 0; k < 1000; ++k) {
        const double x = again(amplitude);
        same = same && give(block, x) == give(as_new, x);
    }
    const bool good = !faulted && !allocated && not_finite == 0 && same;
    std::printf("%-50s largest output %.3g in %llu calls of %llu %s: %s\n", name, most,
                static_cast<unsigned long long>(calls), static_cast<unsigned long long>(steps),
                steps == 1 ? "step" : "steps",
                good        ? "good"
                : faulted   ? "FAULTED"
                : allocated ? "ALLOCATED"
                : same      ? "NOT FINITE"
                            : "NOT AS NEW AFTER RESET");
    std::fflush(stdout);
    return good;
}
} // namespace

int main(int argc, char** argv) {
    const std::uint64_t samples = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 0;
    const std::size_t part = argc > 3 ? std::strtoul(argv[2], nullptr, 10) : 0,
                      of = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1;
    if (samples == 0 || part >= of) {
        std::fprintf(stderr, "usage: soak SAMPLES [PART OF]\n");
        return 2;
    }
    std::size_t block = 0, bad = 0;
    for_each_block([&](const auto& e) {
        if (block++ % of == part) bad += !soaked(e.name.c_str(), e.amplitude, e(values<double>{}), samples);
    });
    std::printf("%llu samples a block: %zu bad\n", static_cast<unsigned long long>(samples), bad);
    return bad != 0;
}
