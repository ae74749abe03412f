// SPDX-License-Identifier: BSL-1.0
// Writes the sample reports for browser_test.py: make_reports DIRECTORY
#include <filesystem>
#include <fstream>

#include "quadrant_gap/comparison_report.hpp"
#include "quadrant_gap/report.hpp"
#include "quadrant_gap/summary.hpp"
#include "sample_result.hpp"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::filesystem::path directory = argv[1];
    std::filesystem::create_directories(directory);
    for (const auto& [name, result] : {std::pair{"explained", sample::explained()},
                                       {"no_gap", sample::no_gap()},
                                       {"unexplained", sample::unexplained()},
                                       {"hostile", sample::hostile()}}) {
        std::ofstream(directory / (std::string(name) + ".html")) << quadrant_gap::html_report(result);
        std::ofstream(directory / (std::string(name) + ".txt")) << quadrant_gap::summary(result);
    }
    std::ofstream(directory / "differ.html") << quadrant_gap::html_report(sample::differing());
}
