// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../page/outputs.hpp"

#include <quadrant/base/error.hpp>
#include <quadrant/diagnosis/text/bad_input.hpp>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

/// The subcommands of quadrant-gap, one file each. A command throws bad_input when it cannot do what it was
/// asked for.
namespace quadrant_gap {
using quadrant_page::outputs, quadrant_page::write_output;

/// How much is said on the terminal.
struct terminal {
    bool quiet = false, verbose = false;
};

/// --quiet, --verbose and --version, the same for every subcommand.
inline void add_terminal_options(CLI::App& command, terminal& t, const std::string& verbose_text) {
    auto* quiet = command.add_flag("-q,--quiet", t.quiet, "no text, only the files");
    command.add_flag("-v,--verbose", t.verbose, verbose_text)->excludes(quiet);
    command.set_version_flag("--version", QUADRANT_VERSION);
}

/// Runs what a subcommand does; a value of a file that a block refuses is that file's fault.
template <class Run> void refuse_in_name_of(const std::string& file, Run run) {
    try {
        run();
    } catch (const quadrant::invalid_parameter& fault) {
        throw quadrant::diagnosis::bad_input(file, fault.what());
    }
}

void add_diagnose(CLI::App& app);
void add_apply(CLI::App& app);
void add_simulate(CLI::App& app);
void add_forecast(CLI::App& app);
void add_compensate(CLI::App& app);
void add_export(CLI::App& app);
void add_init(CLI::App& app);
void add_import(CLI::App& app);
void add_trial(CLI::App& app);
void add_compare(CLI::App& app);
void add_circle(CLI::App& app);
void add_fleet(CLI::App& app);

} // namespace quadrant_gap
