// SPDX-License-Identifier: BSL-1.0
// usage:
//        xy_loop_count typed|typed_lanes|hand_written|virtual_graph|expert[_without_fir] N [standing|reversing]
//                                runs N samples, at most 18 850, standing 50 850 (callgrind.sh counts); on a circle
//                                without a third word
//        xy_loop_count same             fails unless the loops agree: bit for bit, or behind the DAC those that round otherwise
//        xy_loop_count same_commands    the latter alone: for a build in which the compiler may fuse products and sums
#include "xy_loop.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace {
xy_loop::motion in_motion = xy_loop::motion::moving;

template <class Loop> int count(std::size_t n) {
    const auto in = xy_loop::inputs(in_motion);
    Loop loop;
    std::printf("%.17g\n", xy_loop::run(loop, in, std::min(n, in.size())));
    return 0;
}
} // namespace

int main(int argc, char** argv) {
    using namespace xy_loop;
    const std::string_view which = argc > 1 ? argv[1] : "";
    if (which == "same") return comparable<90, 61>() && comparable<1, 1>() ? 0 : 1;
    if (which == "same_commands") return same_behind_the_dac<90, 61>() && same_behind_the_dac<1, 1>() ? 0 : 1;
    const std::string_view moves = argc > 3 ? argv[3] : "moving";
    if (moves == "standing")
        in_motion = motion::standing;
    else if (moves == "reversing")
        in_motion = motion::reversing;
    const std::size_t n = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
    if (which == "typed") return count<typed<90, 61>>(n);
    if (which == "hand_written") return count<by_hand<90, 61>>(n);
    if (which == "virtual_graph") return count<as_graph<90, 61>>(n);
    if (which == "typed_lanes") return count<typed_lanes<90, 61>>(n);
    if (which == "typed_lanes_without_fir") return count<typed_lanes<1, 1>>(n);
#ifdef __AVX2__
    if (which == "expert") return count<by_expert<90, 61>>(n);
    if (which == "expert_without_fir") return count<by_expert<1, 1>>(n);
#endif
    if (which == "typed_without_fir") return count<typed<1, 1>>(n);
    if (which == "hand_written_without_fir") return count<by_hand<1, 1>>(n);
    if (which == "virtual_graph_without_fir") return count<as_graph<1, 1>>(n);
    std::fprintf(stderr,
                 "usage: xy_loop_count typed|typed_lanes|hand_written|virtual_graph|expert[_without_fir] N "
                 "[standing|reversing], same or same_commands\n");
    return 2;
}
