// SPDX-License-Identifier: BSL-1.0
#include "bound.hpp"

#include "loop.hpp"

#include <quadrant/analysis/measure.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

namespace quadrant_latency {

namespace {

/// The kinds of calls, in their order, and how many of each.
struct kind {
    const char* name;
    std::size_t calls;
};
constexpr std::array kinds{kind{"first sample", 1},
                           kind{"moving", 300},
                           kind{"reversing", 100},
                           kind{"held for a NaN", 3},
                           kind{"retune", 1},
                           kind{"cycle fades", 90},
                           kind{"standing, after 32 000", 50},
                           kind{"beyond the limit", 20}};

template <class Loop> void directed_calls() {
    using control = typename Loop::control;
    const auto loop = std::make_unique<Loop>();
    const auto calls = [&](const std::vector<sample>& in, std::size_t n) {
        const auto step = [&](const sample& s) { return loop->step(s); };
        for (std::size_t k = 0; k < n; ++k) detail::use(measured_call(step, in[k % in.size()]));
    };
    calls(circle(1), kinds[0].calls);
    calls(circle(1000), kinds[1].calls);
    calls(reversing(1000), kinds[2].calls);
    auto lost = circle(1);
    lost[0].y.measured = std::numeric_limits<double>::quiet_NaN();
    calls(lost, kinds[3].calls);

    auto x = parameters_of<memory>(thesis::x), y = parameters_of<memory>(thesis::y);
    x.memory.cycle = y.memory.cycle = 87.2 * thesis::period;
    x.friction.curve.coulomb = 0.9 * x.friction.curve.coulomb;
    const auto next = std::make_unique<control>(typename control::parameters{x, y}, thesis::period);
    const auto retune = [&](const typename control::motions& r) {
        loop->both.retune(*next, r);
        return 0;
    };
    detail::use(measured_call(retune, typename control::motions{}));
    calls(circle(1000), kinds[5].calls);
    const auto rest = standing(1);
    for (int k = 0; k < 32'000; ++k) loop->step(rest[0]);
    calls(rest, kinds[6].calls);
    auto far = standing(1);
    far[0].x.position = far[0].y.position = 0.01; // metres away
    calls(far, kinds[7].calls);
}

std::vector<std::size_t> counts_in(const std::filesystem::path& folder, std::size_t calls) {
    std::vector<std::size_t> counts;
    for (std::size_t k = 1; k <= calls; ++k) {
        std::ifstream file(folder / fmt::format("out.{}", k));
        std::size_t count = 0;
        for (std::string line; std::getline(file, line);)
            if (line.rfind("summary: ", 0) == 0) count = std::strtoul(line.c_str() + 9, nullptr, 10);
        if (count == 0) throw std::runtime_error(fmt::format("callgrind counted nothing for call {}", k));
        counts.push_back(count);
    }
    return counts;
}
/// A folder of its own that goes with it.
struct scratch {
    std::filesystem::path path;
    scratch() {
        std::string name = (std::filesystem::temp_directory_path() / "quadrant_latency_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder can be made");
        path = name;
    }
    ~scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    scratch(const scratch&) = delete;
    scratch& operator=(const scratch&) = delete;
};

} // namespace

void make_directed_calls() {
    directed_calls<typed_loop<memory>>();
    directed_calls<typed_lanes<memory>>();
}

std::string bound(const std::string& program) {
    const scratch folder;
    const std::string command = fmt::format(
        "LD_BIND_NOW=1 valgrind --tool=callgrind '--toggle-collect=*measured_call*' '--dump-after=*measured_call<*' "
        "'--callgrind-out-file={0}/out' '{1}' --directed_calls >'{0}/said' 2>&1",
        folder.path.string(), program);
    if (std::system("command -v valgrind >/dev/null 2>&1") != 0)
        throw std::runtime_error("--bound needs valgrind (Debian package valgrind)");
    if (std::system(command.c_str()) != 0) throw std::runtime_error("callgrind did not run: " + command);

    std::size_t calls = 0;
    for (const kind& each : kinds) calls += each.calls;
    const auto counts = counts_in(folder.path, 2 * calls);
    std::string text =
        fmt::format("Instructions of one call of the two-axis loop, as this program was compiled, by "
                    "callgrind (they do not depend on what else runs):\n{:24}{:>8}{:>10}{:>8}{:>16}{:>8}\n",
                    "", "calls", "typed", "most", "typed in lanes", "most");
    std::size_t at = 0;
    std::array<std::size_t, 2> most{};
    for (const kind& each : kinds) {
        text += fmt::format("{:24}{:>8}", each.name, each.calls);
        for (std::size_t form = 0; form < 2; ++form) {
            const auto begin = counts.begin() + std::ptrdiff_t(form * calls + at);
            std::vector<std::size_t> sorted(begin, begin + std::ptrdiff_t(each.calls));
            std::sort(sorted.begin(), sorted.end());
            text += fmt::format("{:>{}}{:>8}", sorted[sorted.size() / 2], form == 0 ? 10 : 16, sorted.back());
            if (std::string_view(each.name) != "retune") most[form] = std::max(most[form], sorted.back());
        }
        text += '\n';
        at += each.calls;
    }
    return text +
           fmt::format(
               "The most of a sample: {} typed, {} typed in lanes. A retune comes on top of the sample in "
               "which it is done.\n",
               most[0], most[1]);
}

} // namespace quadrant_latency
