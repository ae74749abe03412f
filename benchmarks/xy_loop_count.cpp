// SPDX-License-Identifier: BSL-1.0
// usage: xy_loop_count typed|hand_written|virtual_graph[_without_fir] N   runs N samples; callgrind.sh counts.
//        xy_loop_count same                                                fails unless the loops agree bit for bit
#include "xy_loop.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace {
template <class Loop> int count(std::size_t n) {
    const auto in = quadrant_latency::circle();
    Loop loop;
    std::printf("%.17g\n", xy_loop::run(loop, in, std::min(n, in.size())));
    return 0;
}
} // namespace

int main(int argc, char** argv) {
    using namespace xy_loop;
    const std::string_view which = argc > 1 ? argv[1] : "";
    if (which == "same") return comparable<90, 61>() && comparable<1, 1>() ? 0 : 1;
    const std::size_t n = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
    if (which == "typed") return count<typed<90, 61>>(n);
    if (which == "hand_written") return count<by_hand<90, 61>>(n);
    if (which == "virtual_graph") return count<as_graph<90, 61>>(n);
    if (which == "typed_without_fir") return count<typed<1, 1>>(n);
    if (which == "hand_written_without_fir") return count<by_hand<1, 1>>(n);
    if (which == "virtual_graph_without_fir") return count<as_graph<1, 1>>(n);
    std::fprintf(stderr, "usage: xy_loop_count typed|hand_written|virtual_graph[_without_fir] N, or same\n");
    return 2;
}
