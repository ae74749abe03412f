// SPDX-License-Identifier: BSL-1.0
// quadrant-gap simulate: a log as its machine file predicts it, and what remains between the two.
#include "commands.hpp"
#include "digested.hpp"
#include "simulation_report.hpp"
#include "simulation_summary.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/write_simulation.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct simulate_options {
    std::string machine, log, json, report;
    terminal say;
};

void run(const simulate_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    files.reads("--machine", o.machine).reads("--log", o.log);
    files.writes("--json", o.json).writes("--report", o.report);
    const auto machine = read_digested_machine(o.machine);
    auto log = read_digested_log(o.log);
    keep_described(machine.contents, log.contents);
    check_match(machine.contents, log.contents);
    auto result = quadrant::diagnosis::simulate(machine.contents, log.contents);
    result.machine_sha256 = machine.sha256;
    result.log_sha256 = log.sha256;
    if (!o.json.empty())
        write_output(o.json,
                     to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.report.empty()) write_output(o.report, html_report(result, log.contents));
    if (!o.say.quiet) std::fputs(summary(result, o.say.verbose).c_str(), files.words());
}

} // namespace

void add_simulate(CLI::App& app) {
    const auto o = std::make_shared<simulate_options>();
    auto* command =
        app.add_subcommand("simulate", "predict a log from a machine file, and what remains between them");
    command->add_option("--machine", o->machine, "machine file (JSON)")->required();
    command->add_option("--log", o->log, "servo log (CSV) of that machine, any motion")->required();
    command->add_option("--json", o->json, "write the gaps (JSON)");
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    add_terminal_options(*command, o->say, "also in which regimes the gap is");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
