// SPDX-License-Identifier: BSL-1.0
#include "bound.hpp"

#include "directed.hpp"

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
    const auto call = [](std::size_t, const auto& step, const auto& in) {
        detail::use(measured_call(step, in));
    };
    directed_calls<typed_loop<memory>>(call);
    directed_calls<typed_lanes<memory>>(call);
}

namespace {

bool is_here(const char* program) {
    return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}
/// Median and most of each kind of call.
struct figures {
    std::array<std::size_t, kinds.size()> median{}, most{};

    std::size_t most_of_a_sample() const {
        std::size_t out = 0;
        for (std::size_t i = 0; i < kinds.size(); ++i)
            if (std::string_view(kinds[i].name) != "retune") out = std::max(out, most[i]);
        return out;
    }
};
figures of_kinds(const std::size_t* counts) {
    figures out;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        std::vector<std::size_t> sorted(counts, counts + kinds[i].calls);
        std::sort(sorted.begin(), sorted.end());
        out.median[i] = sorted[sorted.size() / 2];
        out.most[i] = sorted.back();
        counts += kinds[i].calls;
    }
    return out;
}

/// What the image for a Cortex-M7 printed, row by row as cortex_m7.cpp writes them.
figures printed(const std::string& file) {
    figures out;
    std::ifstream in(file);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        std::string name, calls, median, most;
        const bool read = std::getline(in, name, '|') && std::getline(in, calls, '|') &&
                          std::getline(in, median, '|') && std::getline(in, most);
        if (!read || name != kinds[i].name)
            throw std::runtime_error("the image for the Cortex-M7 did not print its counts");
        out.median[i] = std::strtoul(median.c_str(), nullptr, 10);
        out.most[i] = std::strtoul(most.c_str(), nullptr, 10);
    }
    return out;
}
/// The image beside the program; empty when there is none.
std::string image_for_cortex_m7(const std::filesystem::path& program) {
    const auto image = program.parent_path() / "quadrant-latency-cortex-m7.elf";
    return std::filesystem::exists(image) ? image.string() : "";
}

std::string row(const std::string& name, const std::string& calls, const std::vector<std::string>& columns) {
    std::string out = fmt::format("{:24}{:>8}", name, calls);
    for (std::size_t i = 0; i < columns.size(); ++i)
        out += fmt::format("{:>{}}", columns[i], i % 2 == 1 ? 8 : i == 0 ? 10 : i == 2 ? 16 : 12);
    return out + "\n";
}

} // namespace

std::string bound(const std::string& program) {
    const scratch folder;
    const std::string command =
        fmt::format("LD_BIND_NOW=1 valgrind --tool=callgrind '--toggle-collect=*measured_call*' "
                    "'--dump-after=*measured_call<*' "
                    "'--callgrind-out-file={0}/out' '{1}' --directed_calls >'{0}/said' 2>&1",
                    folder.path.string(), program);
    if (!is_here("valgrind")) throw std::runtime_error("--bound needs valgrind (Debian package valgrind)");
    if (std::system(command.c_str()) != 0) throw std::runtime_error("callgrind did not run: " + command);

    std::size_t calls = 0;
    for (const kind& each : kinds) calls += each.calls;
    const auto counts = counts_in(folder.path, 2 * calls);
    std::vector<figures> all{of_kinds(counts.data()), of_kinds(counts.data() + calls)};

    std::string without; // the reason why there is no column of the Cortex-M7
    const std::string image = image_for_cortex_m7(program);
    if (image.empty())
        without = "its image was not built (cmake --build BUILD --target latency_cortex_m7; Debian packages "
                  "gcc-arm-none-eabi, libnewlib-arm-none-eabi, libstdc++-arm-none-eabi-newlib)";
    else if (!is_here("qemu-system-arm"))
        without = "no qemu-system-arm (Debian package qemu-system-arm)";
    else {
        const std::string run = fmt::format(
            "timeout 300 qemu-system-arm -M mps2-an500 -icount shift=8 -nographic -semihosting-config "
            "enable=on,target=native -kernel '{}' </dev/null >'{}/m7' 2>&1",
            image, folder.path.string());
        if (std::system(run.c_str()) != 0) throw std::runtime_error("QEMU did not run: " + run);
        all.push_back(printed((folder.path / "m7").string()));
    }

    std::string text = "Instructions of one call of the two-axis loop, as this program was compiled, by "
                       "callgrind (they do not depend on what else runs)";
    text += without.empty()
                ? ",\nand of the typed loop on a Cortex-M7 with double hardware, by QEMU (g++ -O2):\n"
                : ":\n";
    std::vector<std::string> heads{"typed", "most", "typed in lanes", "most"};
    if (without.empty()) heads.insert(heads.end(), {"Cortex-M7", "most"});
    text += row("", "calls", heads);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        std::vector<std::string> columns;
        for (const figures& each : all) {
            columns.push_back(std::to_string(each.median[i]));
            columns.push_back(std::to_string(each.most[i]));
        }
        text += row(kinds[i].name, std::to_string(kinds[i].calls), columns);
    }
    text += fmt::format("The most of a sample: {} typed, {} typed in lanes", all[0].most_of_a_sample(),
                        all[1].most_of_a_sample());
    text += without.empty() ? fmt::format(", {} on a Cortex-M7", all[2].most_of_a_sample()) : "";
    text += ". A retune comes on top of the sample in which it is done.\n";
    text += without.empty() ? "An instruction is not a cycle: cycles of a Cortex-M7 were not measured.\n"
                            : "Cortex-M7: SKIPPED: " + without + ".\n";
    return text;
}

} // namespace quadrant_latency
