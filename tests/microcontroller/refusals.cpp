// SPDX-License-Identifier: BSL-1.0
// All blocks, with exceptions and without: the same refusals in the same words. Built twice by host.sh, which
// compares.
// usage: refusals           prints what is made and what is refused
//        refusals direct    (without exceptions) a constructor refuses outside of make(): handler, then trap
#include <quadrant/quadrant.hpp>

#include <cstdio>
#include <string_view>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using loop = cascade<cascade_p_pi_boxes<two_sample_derivative<signal::position, signal::velocity>>>;
made<loop> in_static_storage;

template <class Block> void print(const char* name, const made<Block>& tried) {
    char why[120] = "made";
    if (!tried) tried.why().write(why, sizeof why);
    std::printf("%s: %s\n", name, why);
}
} // namespace

int main(int argc, char** argv) {
    using force_notch = notch<signal::force>;
#ifndef __cpp_exceptions
    if (argc > 1 && std::string_view(argv[1]) == "direct") {
        on_refusal = [](const refused_parameter& r) {
            char why[120];
            r.write(why, sizeof why);
            std::puts(why);
            std::fflush(stdout);
        };
        made<force_notch> before; // a make() that is over, either way, takes no part in what follows
        before.make({.centre = 1200_Hz}, 500_us);
        before.make({.centre = 330_Hz}, 500_us);
        force_notch refused({.centre = 1200_Hz}, 500_us);
        std::puts("a refused block is in use");
    }
#else
    if (argc > 1) std::printf("%s: for the other build\n", argv[1]);
#endif
    print("nothing", made<force_notch>());
    auto one = make<force_notch>({.centre = 330_Hz, .width = 0.4}, 500_us);
    print("notch", one);
    std::printf("steps: %.17g\n", (*one)(1_N).value());
    print("a notch above half the sampling rate", make<force_notch>({.centre = 1200_Hz}, 500_us));
    print("a period that is none", make<force_notch>({.centre = 330_Hz}, 0_us));
    one.make({.centre = 330_Hz, .width = -1}, 500_us);
    print("in place of the good one", one);
    one.make({.centre = 330_Hz, .width = 0.4}, 500_us);
    print("and mended", one);
    print("rule with one number", make<delay_line<signal::force, 8>>({.length = 9}, 500_us));
    print("rule with two numbers", make<fractional_delay<signal::force, 8>>({.delay = 5_ms}, 500_us));
    print("field of a part", make<cogging_force<2>>({}, 500_us));
    const loop::command limit = 10_V;
    in_static_storage.make(
        {.position_gain = 150.0 / 1_s, .velocity_gain = 60_V / 1_mps, .velocity_integral = {}, .limit = limit},
        500_us);
    print("a loop", in_static_storage);
    in_static_storage.make(
        {.position_gain = 150.0 / 1_s, .velocity_gain = 60_V / 1_mps, .velocity_integral = {}, .limit = -limit},
        500_us);
    print("a loop with a bad box", in_static_storage);
    char cut[10];
    const auto whole = in_static_storage.why().write(cut, sizeof cut);
    std::printf("cut off: %s, of %zu\n", cut, whole);
}
