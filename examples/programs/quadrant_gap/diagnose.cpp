// SPDX-License-Identifier: BSL-1.0
// quadrant-gap diagnose: why does the machine not do what its simulation says?
#include "../page/progress.hpp"
#include "commands.hpp"
#include "digested.hpp"
#include "make_match.hpp"
#include "report.hpp"
#include "summary.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <memory>
#include <optional>

namespace quadrant_gap {

namespace {

struct diagnose_options {
    std::string machine, log, holdout, json, report, next_motion;
    std::size_t threads = 0;
    double seconds = 0; ///< 0: as long as it takes
    bool fast = false;
    terminal say;
};

rules chosen(const diagnose_options& o) {
    rules r = o.fast ? fast_rules() : rules{};
    r.threads = o.threads;
    if (o.seconds > 0) {
        const auto left = std::chrono::duration<double>(o.seconds);
        r.until = rules::clock::now() + std::chrono::duration_cast<rules::clock::duration>(left);
    }
    return r;
}

void run(const diagnose_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    files.reads("--machine", o.machine).reads("--log", o.log).reads("--holdout", o.holdout);
    files.writes("--json", o.json).writes("--report", o.report).writes("--next-motion", o.next_motion);
    const auto machine = read_digested_machine(o.machine);
    auto log = read_digested_log(o.log);
    std::optional<digested<machine_log>> holdout;
    if (!o.holdout.empty()) holdout = read_digested_log(o.holdout);
    if (holdout && holdout->sha256 == log.sha256)
        throw bad_input(o.holdout,
                        "--holdout is the log itself, and judges nothing: leave it out, parts of the "
                        "log are then held out, or give another motion");
    make_match(machine.contents, log.contents, holdout ? &holdout->contents : nullptr);
    quadrant_page::progress_line line(o.say.quiet);
    auto result = diagnose(
        machine.contents, log.contents, holdout ? &holdout->contents : nullptr,
        [&](const std::string& s, double done) {
            o.say.verbose ? void(fmt::print(stderr, "{}: {}\n", line.so_far(done), s)) : line(s, done);
        },
        chosen(o));
    line.clear();
    result.machine_sha256 = machine.sha256;
    result.log_sha256 = log.sha256;
    if (holdout) result.holdout_sha256 = holdout->sha256;
    if (!o.json.empty())
        write_output(o.json,
                     to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.report.empty()) write_output(o.report, html_report(result));
    if (!o.next_motion.empty() && !result.next.reference.empty())
        write_output(o.next_motion, reference_csv(result.next, result.kind_of(result.next.axis)));
    if (!o.say.quiet) std::fputs(summary(result, o.say.verbose).c_str(), files.words());
    if (!o.next_motion.empty() && result.next.reference.empty() && !o.say.quiet)
        std::fprintf(files.words(), "Note: no motion was found to propose: %s is not written\n",
                     o.next_motion.c_str());
}

} // namespace

void add_diagnose(CLI::App& app) {
    const auto o = std::make_shared<diagnose_options>();
    auto* command = app.add_subcommand(
        "diagnose", "name the effect that the simulation lacks, and how far the gap shrinks with it");
    command->add_option("--machine", o->machine, "machine file (JSON): what the simulation believes")
        ->required();
    command->add_option("--log", o->log, "servo log (CSV): what the machine did")->required();
    command->add_option("--holdout", o->holdout,
                        "log of another motion of the same machine, to judge the forecast on");
    command->add_option("--json", o->json, "write the diagnosis (JSON)");
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    command->add_option("--next-motion", o->next_motion,
                        "write the reference of the next experiment (CSV: time, position), if one is proposed: "
                        "no further, faster or stronger than the log");
    command
        ->add_option("--threads", o->threads, "at most; 0: as many as there are cores. The answer is the same")
        ->check(CLI::Range(0, 4096));
    command->add_flag("--fast", o->fast, "fewer models tried: half of the time, the same judgement at the end");
    command
        ->add_option("--seconds", o->seconds,
                     "end the search after this time with what it has, and say what was not tried")
        ->check(CLI::Range(1e-3, 1e6));
    add_terminal_options(*command, o->say, "every model tried, with its gain; and what this log cannot see");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
