// SPDX-License-Identifier: BSL-1.0
// quadrant-gap: why does the machine not do what its simulation says?
#include "report.hpp"
#include "summary.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <unistd.h>

namespace {

namespace qd = quadrant::diagnosis;

constexpr int bad_input_code = 2;

struct diagnose_options {
    std::string machine, log, holdout, json, report;
    bool quiet = false, verbose = false;
};

/// One line on the terminal that is overwritten; every line with --verbose, none with --quiet or into a file.
class progress_line {
public:
    explicit progress_line(const diagnose_options& o)
        : verbose_(o.verbose), shown_(!o.quiet && isatty(STDERR_FILENO)) {}
    ~progress_line() { clear(); }
    progress_line(const progress_line&) = delete;
    progress_line& operator=(const progress_line&) = delete;
    void operator()(const std::string& text) {
        if (verbose_)
            std::fprintf(stderr, "%s\n", text.c_str());
        else if (shown_)
            std::fprintf(stderr, "\r\033[K%.*s", 78, text.c_str());
    }
    void clear() const {
        if (shown_ && !verbose_) std::fputs("\r\033[K", stderr);
    }

private:
    bool verbose_, shown_;
};

int diagnose(const diagnose_options& o) {
    const auto machine = qd::read_machine(std::filesystem::path(o.machine));
    const auto log = qd::read_log(std::filesystem::path(o.log));
    qd::check_match(machine, log);
    std::optional<qd::machine_log> holdout;
    if (!o.holdout.empty()) {
        holdout = qd::read_log(std::filesystem::path(o.holdout));
        qd::check_match(machine, *holdout);
    }
    progress_line tell(o);
    const auto result =
        qd::diagnose(machine, log, holdout ? &*holdout : nullptr, [&](const std::string& s) { tell(s); });
    tell.clear();
    if (!o.json.empty())
        qd::write_aside(
            o.json, qd::to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.report.empty()) qd::write_aside(o.report, quadrant_gap::html_report(result));
    if (!o.quiet) std::fputs(quadrant_gap::summary(result).c_str(), stdout);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Why does the machine not do what its simulation says?", "quadrant-gap"};
    app.set_version_flag("--version", QUADRANT_VERSION);
    app.require_subcommand(1);
    diagnose_options o;
    auto* command = app.add_subcommand(
        "diagnose", "name the effect that the simulation lacks, and how far the gap shrinks with it");
    command->add_option("--machine", o.machine, "machine file (JSON): what the simulation believes")
        ->required();
    command->add_option("--log", o.log, "servo log (CSV): what the machine did")->required();
    command->add_option("--holdout", o.holdout,
                        "log of another motion of the same machine, to judge the forecast on");
    command->add_option("--json", o.json, "write the diagnosis (JSON)");
    command->add_option("--report", o.report, "write the report (one HTML file, opens without a network)");
    auto* quiet = command->add_flag("--quiet", o.quiet, "no text, only the files");
    command->add_flag("--verbose", o.verbose, "every model tried, with its gain")->excludes(quiet);
    try {
        app.parse(argc, argv);
        return diagnose(o);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : bad_input_code;
    } catch (const qd::bad_input& e) {
        std::fprintf(stderr, "quadrant-gap: %s\n", e.what());
    } catch (const quadrant::invalid_parameter& e) {
        std::fprintf(stderr, "quadrant-gap: %s: %s\n", o.machine.c_str(), e.what());
    }
    return bad_input_code;
}
