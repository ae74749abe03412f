// SPDX-License-Identifier: BSL-1.0
// quadrant-gap compare: what differs between two logs?
#include "../page/progress.hpp"
#include "commands.hpp"
#include "comparison_report.hpp"
#include "comparison_summary.hpp"
#include "digested.hpp"
#include "make_match.hpp"

#include <quadrant/diagnosis/compare.hpp>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/write_comparison.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct compare_options {
    std::string machine, first, second, json, report;
    std::size_t threads = 0;
    bool fast = false;
    terminal say;
};

void run(const compare_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    files.reads("the first log", o.first).reads("the second log", o.second).reads("--machine", o.machine);
    files.writes("--json", o.json).writes("--report", o.report);
    auto first = read_digested_log(o.first), second = read_digested_log(o.second);
    const auto machine = o.machine.empty() ? digested<machine_description>{described_by(first.contents), ""}
                                           : read_digested_machine(o.machine);
    make_match(machine.contents, first.contents, &second.contents);
    quadrant_page::progress_line line(o.say.quiet);
    rules r = o.fast ? fast_rules() : rules{};
    r.threads = o.threads;
    auto result = compare(
        machine.contents, first.contents, second.contents,
        [&](const std::string& s, double done) {
            o.say.verbose ? void(fmt::print(stderr, "{}: {}\n", line.so_far(done), s)) : line(s, done);
        },
        r);
    line.clear();
    result.machine_sha256 = machine.sha256;
    result.first_sha256 = first.sha256;
    result.second_sha256 = second.sha256;
    if (!o.json.empty())
        write_output(o.json,
                     to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.report.empty()) write_output(o.report, html_report(result));
    if (!o.say.quiet) std::fputs(summary(result).c_str(), files.words());
}

} // namespace

void add_compare(CLI::App& app) {
    const auto o = std::make_shared<compare_options>();
    auto* command = app.add_subcommand(
        "compare", "name what differs between two logs: before and after, two sister machines, a simulator and "
                   "its machine");
    command->add_option("first", o->first, "log (CSV)")->required();
    command->add_option("second", o->second, "another one (CSV); its motion, length and rate may differ")
        ->required();
    command->add_option("--machine", o->machine,
                        "machine file (JSON) of both; without it, what the first log says of its machine");
    command->add_option("--json", o->json, "write the comparison (JSON)");
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    command
        ->add_option("--threads", o->threads, "at most; 0: as many as there are cores. The answer is the same")
        ->check(CLI::Range(0, 4096));
    command->add_flag("--fast", o->fast, "fewer models tried: half of the time, the same judgement at the end");
    add_terminal_options(*command, o->say, "every model tried, with its gain");
    command->callback([o] { refuse_in_name_of(o->machine.empty() ? o->first : o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
