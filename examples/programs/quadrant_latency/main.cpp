// SPDX-License-Identifier: BSL-1.0
// quadrant-latency: does my loop fit my period, with what margin?
#include "../page/nearest_option.hpp"
#include "../page/outputs.hpp"
#include "bound.hpp"
#include "page.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace {

constexpr int too_long_code = 1, bad_input_code = 2;

/// As CLI::Range, which lets NaN through.
CLI::Validator between(double low, double high) {
    return {[low, high](const std::string& given) {
                const double v = std::strtod(given.c_str(), nullptr);
                return v >= low && v <= high ? std::string()
                                             : fmt::format("must lie between {} and {}", low, high);
            },
            fmt::format("{} ... {}", low, high)};
}

int run(const quadrant_latency::plan& plan, const std::string& html) {
    const bool to_file = html != quadrant_page::standard_output;
    std::optional<quadrant::diagnosis::output_file> file; // opened before a minute has been spent
    if (to_file) file.emplace(html);
    const auto result = quadrant_latency::measure(plan);
    const bool can_draw = quadrant_page::gnuplot_is_here();
    const std::string page = quadrant_latency::page(result, plan.period_us, can_draw);
    if (file) {
        file->write(page);
        file->finish();
    } else {
        quadrant_page::write_output(html, page);
    }
    fmt::print(to_file ? stdout : stderr, "{}{}\n", quadrant_latency::text(result, plan.period_us),
               to_file ? "Page: " + html : "");
    if (!can_draw)
        fmt::print(stderr, "quadrant-latency: no gnuplot, so the page has no picture (Debian package {})\n",
                   quadrant_page::gnuplot_package);
    return quadrant_latency::fits(result, plan.period_us) ? 0 : too_long_code;
}

int run_program(int argc, char** argv) {
    CLI::App app{"Runs the two-axis controller of the milling table on this computer, with warm and cold "
                 "caches and on a\n"
                 "timer, and says how much of the servo period it needs.",
                 "quadrant-latency"};
    app.set_version_flag("--version", QUADRANT_VERSION);
    quadrant_latency::plan plan;
    std::string html = "quadrant_latency.html";
    app.add_option("--period_us", plan.period_us, "the servo period in us")
        ->check(between(1, 1e6))
        ->capture_default_str();
    app.add_option("--seconds", plan.seconds, "how long to measure")
        ->check(between(0.1, 86400))
        ->capture_default_str();
    app.add_option("--core", plan.core, "the core to run on; without it the last one that is allowed")
        ->check(CLI::Range(0, 1023));
    app.add_option("--html", html, "write the page (one HTML file, opens without a network)")
        ->capture_default_str();
    bool bound = false, directed_calls = false;
    app.add_flag("--bound", bound,
                 "count instead: the most instructions of one call over directed inputs (valgrind)");
    app.add_flag("--directed_calls", directed_calls, "")->group(""); // what --bound runs under callgrind
    app.footer("Exit code: 0 when no call was longer than the period, 1 when one was, 2 on bad input.");
    try {
        app.parse(argc, argv);
        if (directed_calls) {
            quadrant_latency::make_directed_calls();
            return 0;
        }
        if (bound) {
            fmt::print("{}", quadrant_latency::bound(std::filesystem::read_symlink("/proc/self/exe").string()));
            return quadrant_page::ended(0, "quadrant-latency");
        }
        return quadrant_page::ended(run(plan, html), "quadrant-latency");
    } catch (const CLI::ParseError& e) {
        return quadrant_page::said(app, e, argc, argv, bad_input_code);
    }
}

} // namespace

int main(int argc, char** argv) {
    return quadrant_page::guarded("quadrant-latency", bad_input_code, [&] { return run_program(argc, argv); });
}
