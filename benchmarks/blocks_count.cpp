// SPDX-License-Identifier: BSL-1.0
// usage: blocks_count list        the numbers and names of what can be counted, one a line
//        blocks_count I N         runs N samples (at most 20000) of number I; blocks.sh counts the instructions
#include "counted.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {
using namespace counted;

/// Number `at` of what is counted, or all names.
class counter {
public:
    counter(int wanted, std::size_t n) : wanted_(wanted), n_(std::min<std::size_t>(n, 20'000)) {}
    template <class Make> void operator()(const char* name, double amplitude, Make make) {
        if (wanted_ < 0) std::printf("%d %s\n", at_, name);
        if (wanted_ == at_++) std::printf("%.17g\n", run(make(), input(amplitude), n_));
    }

private:
    int wanted_, at_ = 0;
    std::size_t n_;
};
} // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string(argv[1]) == "list") {
        all(counter(-1, 0));
        return same_notch() && same_sums() ? 0 : 1;
    }
    if (argc == 3) return all(counter(std::atoi(argv[1]), std::strtoul(argv[2], nullptr, 10))), 0;
    std::fprintf(stderr, "usage: blocks_count list, or blocks_count I N\n");
    return 2;
}
