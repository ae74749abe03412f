// SPDX-License-Identifier: BSL-1.0
// quadrant-gap trial: does the diagnosis find what was put into machines that it did not make?
#include "../for_each_index.hpp"
#include "../page/progress.hpp"
#include "../page/scratch_folder.hpp"
#include "commands.hpp"
#include "sha256.hpp"
#include "trial/chain_files.hpp"
#include "trial/child.hpp"
#include "trial/files.hpp"
#include "trial/page.hpp"
#include "trial/tally.hpp"

#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <unistd.h>

namespace quadrant_gap {

namespace {

using namespace trial;
using quadrant::diagnosis::bad_input, quadrant::diagnosis::write_aside;
using quadrant_programs::for_each_index;

struct trial_options {
    std::size_t machines = 200;
    std::uint64_t seed = 1;
    std::string json, report, keep, program, how = "plain";
    std::string population = populations.front();
    std::vector<std::size_t> only;
    unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
    double limit_s = 300;
    bool no_forecast = false;
    terminal say;
};

/// In per cent, with the time that is left; with --verbose a line a machine.
class progress {
public:
    progress(const char* what, std::size_t of, const terminal& say)
        : what_(what), of_(of), say_(say), line_(say.quiet) {}
    void operator()(const std::string& more = "") {
        const std::lock_guard lock(telling_);
        ++done_;
        if (say_.verbose)
            std::fprintf(stderr, "%s %zu of %zu%s\n", what_, done_, of_, more.c_str());
        else
            line_(done_, of_, fmt::format("{} {} of {}", what_, done_, of_));
    }

private:
    const char* what_;
    std::size_t of_, done_ = 0;
    terminal say_;
    quadrant_page::progress_line line_;
    std::mutex telling_;
};

/// A diagnosis that never saw the hold-out log: its forecast for that motion, and what its claims do on that
/// log.
std::optional<shrink_pair> forecast_and_achieved(const trial_options& o, const std::filesystem::path& folder) {
    const auto file = [&](const char* name) { return (folder / name).string(); };
    const auto runs = [&](std::vector<std::string> words) {
        words.insert(words.begin(), o.program);
        words.emplace_back("--quiet");
        return run_child(words, folder / "heard.txt", o.limit_s) == 0;
    };
    const auto written = [&](const char* name) {
        std::ifstream text(file(name));
        return ordered_json::parse(text, nullptr, false);
    };
    if (!claims(diagnose_files(o.program, folder, false, o.limit_s).diagnosis) ||
        !runs({"forecast", "--machine", file("machine.json"), "--diagnosis", file("forecast.json"), "--motion",
               file("planned.csv"), "--json", file("expected.json")}) ||
        !runs({"apply", "--machine", file("machine.json"), "--diagnosis", file("forecast.json"), "--out",
               file("corrected.json")}))
        return std::nullopt;
    const auto left = [&](const char* machine) -> std::optional<double> {
        if (!runs({"simulate", "--machine", file(machine), "--log", file("holdout.csv"), "--json",
                   file("simulated.json")}))
            return std::nullopt;
        return remaining_force(written("simulated.json"));
    };
    const auto forecast = forecast_shrink(written("expected.json"));
    const auto before = left("machine.json"), after = left("corrected.json");
    if (!forecast || !before || !after || *before <= 0) return std::nullopt;
    return shrink_pair{*forecast, 1 - *after / *before};
}

/// A drawn machine of whatever population: what the parent keeps, and its files.
struct drawn_files {
    ordered_json truth{};
    std::function<void(const std::filesystem::path&)> write{};
};
template <class Machine> drawn_files files_of(Machine m) {
    ordered_json truth = truth_of(m);
    const auto kept = std::make_shared<const Machine>(std::move(m));
    return {std::move(truth), [kept](const std::filesystem::path& folder) { write_files(*kept, folder); }};
}

/// Before the work, that what it finds can be written.
void check_folders(const trial_options& o, outputs& files) {
    files.writes("--json", o.json).writes("--report", o.report);
    for (const std::filesystem::path file : {o.json, o.report})
        if (file.has_parent_path() && !std::filesystem::is_directory(file.parent_path()))
            throw bad_input(file.string(), "cannot be written: no such folder");
    if (o.keep.empty()) return;
    std::error_code fault;
    std::filesystem::create_directories(o.keep, fault);
    if (!std::filesystem::is_directory(o.keep, fault)) throw bad_input(o.keep, "cannot be made a folder");
}

/// Which machines of the population are diagnosed.
std::vector<std::size_t> chosen_machines(const trial_options& o) {
    std::vector<std::size_t> chosen(o.machines);
    for (std::size_t k = 0; k < o.machines; ++k) chosen[k] = k;
    if (!o.only.empty()) chosen = o.only;
    for (const std::size_t k : chosen)
        if (k >= o.machines) throw bad_input("--only", fmt::format("there is no machine {}", k));
    return chosen;
}
/// Those, in the order of `chosen`. Other populations than that of current drives have no forecast.
std::vector<drawn_files> draw_machines(trial_options& o, const std::vector<std::size_t>& chosen) {
    const auto named = std::find(populations.begin(), populations.end(), o.population);
    const auto of = static_cast<population>(named - populations.begin());
    const logs how = *logs_named(o.how);
    if (!can_be_logged(of, how))
        throw bad_input("--logs",
                        fmt::format("{} logs are not drawn of the population {}", o.how, o.population));
    o.no_forecast = o.no_forecast || of != population::current;
    const auto planned_machines = plan(o.seed, o.machines, of, how);
    progress drawn("drawn", chosen.size(), o.say);
    std::vector<drawn_files> machines(chosen.size());
    for_each_index(chosen.size(), o.jobs, [&](std::size_t k) {
        machines[k] = is_chain(of) ? files_of(draw_chain(o.seed, chosen[k], planned_machines.at(chosen[k])))
                                   : files_of(draw(o.seed, chosen[k], planned_machines.at(chosen[k])));
        drawn();
    });
    return machines;
}

void run_trial(trial_options o) {
    quadrant_page::remove_scratch_when_interrupted();
    outputs files;
    check_folders(o, files);
    if (o.program.empty()) o.program = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::vector<std::size_t> chosen = chosen_machines(o);
    std::vector<drawn_files> machines = draw_machines(o, chosen);
    std::vector<ordered_json> truths;
    for (const drawn_files& m : machines) truths.push_back(m.truth);
    const std::string truth = ordered_json(truths).dump(1) + "\n", digest = sha256(truth);
    if (!o.say.quiet) {
        std::fprintf(files.words(), "truth of %zu machines, seed %llu, sealed: SHA-256 %s\n", chosen.size(),
                     static_cast<unsigned long long>(o.seed), digest.c_str());
        std::fflush(files.words());
    }

    std::vector<judged_machine> judged(chosen.size());
    progress diagnosed("diagnosed", chosen.size(), o.say);
    for_each_index(chosen.size(), o.jobs, [&](std::size_t k) {
        const quadrant_page::scratch_folder folder(neutral_folder());
        machines[k].write(folder.path());
        machines[k] = {};
        const answer a = diagnose_files(o.program, folder.path(), true, o.limit_s);
        judged[k].judged = judge(truths[k], a.diagnosis);
        if (!a.error.empty()) judged[k].judged.said += ": " + a.error;
        if (!o.no_forecast && claims(a.diagnosis)) judged[k].shrink = forecast_and_achieved(o, folder.path());
        if (!o.keep.empty()) {
            const auto kept = std::filesystem::path(o.keep) / fmt::format("{:03}", chosen[k]);
            std::filesystem::create_directories(kept);
            std::filesystem::copy(folder.path(), kept,
                                  std::filesystem::copy_options::recursive |
                                      std::filesystem::copy_options::overwrite_existing);
        }
        const judgement& j = judged[k].judged;
        diagnosed(fmt::format(": {:03} {} {} ({:.1f}) {} in {:.0f} s: {}", j.index, j.kind, j.truth, j.size,
                              j.right ? "right" : "NOT RIGHT", a.seconds, j.said));
    });

    ordered_json result{{"schema", "quadrant.trial/1"},
                        {"seed", o.seed},
                        {"machines", chosen.size()},
                        {"logs", o.how},
                        {"truth_sha256", digest}};
    result.update(tally(judged));
    const std::string text = summary_text(result);
    if (!o.keep.empty()) write_aside(std::filesystem::path(o.keep) / "truth.json", truth);
    if (!o.json.empty()) write_output(o.json, result.dump(1) + "\n");
    if (!o.report.empty()) write_output(o.report, page(result));
    if (!o.say.quiet) std::fputs(text.c_str(), files.words());
}

} // namespace

void add_trial(CLI::App& app) {
    const auto o = std::make_shared<trial_options>();
    CLI::App* const command = app.add_subcommand(
        "trial", "draw machines at random, diagnose them from their files, and judge what was said");
    command->add_option("--machines", o->machines, "how many")->check(CLI::Range(1, 100000));
    command->add_option("--seed", o->seed, "another seed, another population; the same seed, the same result")
        ->check(CLI::NonNegativeNumber);
    command
        ->add_option("--logs", o->how,
                     "how the machines are logged: plain, coarse, measured, gaps, jitter, no_reference")
        ->check(CLI::IsMember(std::vector<std::string>(names_of_logs.begin(), names_of_logs.end())));
    command
        ->add_option("--population", o->population,
                     "the machines: their drives, a second encoder, or positions alone")
        ->check(CLI::IsMember(std::vector<std::string>(populations.begin(), populations.end())));
    command->add_option("--only", o->only, "of that population, these machines alone")
        ->delimiter(',')
        ->check(CLI::NonNegativeNumber);
    command->add_option("--json", o->json, "write every figure and case (JSON)");
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    command->add_option("--keep", o->keep, "keep every machine's files and diagnosis in this folder");
    command->add_option("--jobs", o->jobs, "machines at a time")->check(CLI::Range(1, 256));
    command->add_option("--program", o->program, "diagnose with this quadrant-gap instead of the running one");
    command->add_option("--limit", o->limit_s, "seconds after which a diagnosis counts as not answered")
        ->check(CLI::PositiveNumber);
    command->add_flag("--no-forecast", o->no_forecast, "do not diagnose again without the hold-out log");
    add_terminal_options(*command, o->say, "every machine as it is diagnosed");
    command->callback([o] { run_trial(*o); });
}

} // namespace quadrant_gap
