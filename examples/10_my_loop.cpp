// SPDX-License-Identifier: BSL-1.0
// How long does my own loop take? Fifteen lines put it under the clock, and under callgrind, which counts the
// most instructions of a sample over all inputs and does not care what else runs.
//
//   build/release/examples/10_my_loop    times of 200 000 calls
//   sh benchmarks/bound.sh build/release/examples/10_my_loop once      instructions: the most of a call, and which call
//
// You should see: every call finite, and a median far below a servo period.
#include <quadrant/analysis/measure.hpp>
#include <quadrant/quadrant.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {

struct sample { // what my loop is given in a period
    quantity<si::length> reference, measured;
};
struct my_loop { // what I wrote: a PI on the error behind a notch, and a limit
    proportional_integral<signal::position, signal::voltage> control{
        {20'000_V / 1_m, 4e5_V / (1_m * 1_s), 10_V}, 500_us};
    notch<signal::voltage> resonance{{330_Hz, 0.1}, 500_us};
    limiter<signal::voltage> amplifier{{-10_V, 10_V}, 500_us};

    quantity<si::electric_potential> operator()(const sample& s) noexcept {
        return amplifier(resonance(control(s.reference - s.measured)));
    }
};

/// Every path that a sample can take: moving, at rest, beyond the limit, a lost encoder line, and back.
std::vector<sample> inputs() {
    std::vector<sample> all;
    for (int k = 0; k < 300; ++k) {
        const double r = 1e-3 * std::sin(0.05 * k), off = k < 100 ? 1e-5 : k < 200 ? 0 : 2e-3;
        all.push_back({r * 1_m, (r - off) * 1_m});
    }
    all.push_back({0_m, std::numeric_limits<double>::quiet_NaN() * 1_m});
    all.push_back({0_m, 0_m});
    return all;
}

} // namespace

int main(int argc, char** argv) {
    my_loop loop;
    const auto in = inputs();
    const bool once = argc > 1 && std::strcmp(argv[1], "once") == 0; // as bound.sh wants it
    const call_times t = measure(loop, in, once ? in.size() : 200'000);
    if (once) return 0;
    std::fprintf(stderr, "ns: median %.0f, 99.9 %% below %.0f, longest %.0f; the clock alone %.0f\n",
                 t.median(), t.p999(), t.longest(), t.clock);
    std::printf("%zu calls measured\n", t.ns.size());
    std::printf("the median is %s a period of 500 us\n",
                t.median() < 500e3 / 100 ? "less than a hundredth of" : "NOT small beside");
    std::printf("the loop %s\n",
                loop.control.faulted() ? "has told of the lost line" : "has NOT told of the lost line");
}
