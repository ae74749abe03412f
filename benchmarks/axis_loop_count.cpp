// SPDX-License-Identifier: BSL-1.0
// usage: axis_loop_count typed|hand_written|hand_written_unchecked N [standing|reversing]
//                                                                      runs N samples; callgrind.sh counts.
//        axis_loop_count same                                          fails unless the loops agree bit for bit
#include "axis_loop.hpp"

#include <cstdlib>
#include <string_view>

namespace {
std::string_view moves = "moving";

template <class Loop> int count(std::size_t n) {
    const std::vector<double> reference = moves == "standing"    ? axis_loop::standing()
                                          : moves == "reversing" ? axis_loop::reversing()
                                                                 : axis_loop::sine();
    Loop loop;
    std::printf("%.17g\n", axis_loop::run(loop, reference.data(), n < reference.size() ? n : reference.size()));
    return 0;
}
} // namespace

int main(int argc, char** argv) {
    const std::string_view which = argc > 1 ? argv[1] : "";
    if (which == "same") return axis_loop::comparable() ? 0 : 1;
    const std::size_t n = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
    if (argc > 3) moves = argv[3];
    if (which == "typed") return count<axis_loop::typed_loop>(n);
    if (which == "hand_written") return count<axis_loop::hand_loop<true>>(n);
    if (which == "hand_written_unchecked") return count<axis_loop::hand_loop<false>>(n);
    std::fprintf(stderr,
                 "usage: axis_loop_count typed|hand_written|hand_written_unchecked N [standing|reversing], "
                 "or same\n");
    return 2;
}
