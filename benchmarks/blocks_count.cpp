// SPDX-License-Identifier: BSL-1.0
// usage: blocks_count list        the numbers and names of what can be counted, one a line
//        blocks_count I N [standing]   runs N samples (at most 20000) of number I; blocks.sh counts the instructions.
//                                      Standing: at zero, after a motion and 32 000 samples of rest
#include "counted.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {
using namespace counted;

/// Number `at` of what is counted, or all names.
class counter {
public:
    counter(int wanted, std::size_t n, bool stands = false)
        : wanted_(wanted), n_(std::min<std::size_t>(n, 20'000)), stands_(stands) {}
    template <class Make> void operator()(const char* name, double amplitude, Make make) {
        if (wanted_ < 0) std::printf("%d %s\n", at_, name);
        if (wanted_ != at_++) return;
        const auto x = input(amplitude);
        std::printf("%.17g\n",
                    stands_ ? run(rested(make(), x), std::vector<double>(n_, 0.0), n_) : run(make(), x, n_));
    }

private:
    int wanted_, at_ = 0;
    std::size_t n_;
    bool stands_;
};
} // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string(argv[1]) == "list") {
        all(counter(-1, 0));
        return same_notch() && same_sums() ? 0 : 1;
    }
    const bool stands = argc == 4 && std::string_view(argv[3]) == "standing";
    if (argc == 3 || stands)
        return all(counter(std::atoi(argv[1]), std::strtoul(argv[2], nullptr, 10), stands)), 0;
    std::fprintf(stderr, "usage: blocks_count list, or blocks_count I N [standing]\n");
    return 2;
}
