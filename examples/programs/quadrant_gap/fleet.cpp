// SPDX-License-Identifier: BSL-1.0
// quadrant-gap fleet: the gaps of many machines, on every core, resumed where it was stopped.
#include "fleet/fleet.hpp"
#include "commands.hpp"
#include "fleet/desk.hpp"
#include "fleet/teller.hpp"
#include "fleet/work_list.hpp"

#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <memory>
#include <sys/file.h>
#include <thread>

namespace quadrant_gap {

namespace fleet {

namespace {

using namespace std::chrono_literals;
constexpr auto pause = 5ms;

fs::path results_of(const options& o) {
    return o.out.empty() ? fs::path(o.folder) / "diagnosed" : fs::path(o.out);
}

workshop workshop_of(const options& o) {
    workshop w;
    w.out = results_of(o);
    w.program = o.program;
    w.program_sha256 = sha256_of_file(w.program);
    w.host = host_name();
    w.threads = std::max<std::size_t>(o.threads, 1);
    w.limit_s = o.limit_s;
    return w;
}

/// One run at a time in a folder of results; let go of by the system when this process ends, in whatever way.
class folder_lock {
public:
    explicit folder_lock(const fs::path& out) {
        handle_ = open((out / ".fleet.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (handle_ < 0) throw bad_input(out.string(), "cannot be written");
        if (flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            close(handle_);
            throw bad_input(out.string(), "another fleet is at work in this folder");
        }
    }
    ~folder_lock() { close(handle_); }
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;

private:
    int handle_ = -1;
};

/// What killed runs have left half done.
void sweep(const fs::path& out) {
    std::error_code fault;
    for (const auto& old : fs::directory_iterator(out, fault))
        if (old.path().filename().string().starts_with(working_prefix)) fs::remove_all(old.path(), fault);
}

void do_all(work_list& list, const options& o, const workshop& w, crew& others) {
    const auto write_overview = [&] {
        write_aside(w.out / "fleet.html", page(list.rows(), o.folder, QUADRANT_VERSION));
    };
    desk crew_desk(others, w);
    pool hands(w, std::max<std::size_t>(o.jobs, 1));
    teller tell(o);
    const auto begin = std::chrono::steady_clock::now();
    auto written = begin;
    write_overview();
    while (list.left() > 0 || !crew_desk.all_have_come()) {
        while (hands.has_room() && !list.to_do().empty()) {
            const std::size_t k = list.next();
            hands.start(k, list.at(k));
        }
        auto ended = hands.ended();
        while (const auto heard = crew_desk.hear()) ended.push_back(*heard);
        crew_desk.hand_out(list);
        const auto now = std::chrono::steady_clock::now();
        for (const outcome& e : ended) {
            list.ended(e);
            tell.log(list.at(e.index).name, e);
        }
        tell.progress(list.progress(std::chrono::duration<double>(now - begin).count()), false);
        if (now - written > 30s) write_overview(), written = now;
        if (ended.empty()) std::this_thread::sleep_for(pause);
    }
    tell.progress(list.progress(0), true);
    write_overview();
}

void print_list(const std::vector<row>& rows) {
    for (const row& r : rows)
        std::printf("%s: %s%s\n", r.name.c_str(), spaced(r.verdict).c_str(),
                    r.verdict == "failed" ? fmt::format(": {}", r.error).c_str() : "");
}

} // namespace

void add_options(CLI::App& command, options& o) {
    command
        .add_option("DIR", o.folder,
                    "folder with logs at any depth: log.csv or NAME.log.csv, its machine file and hold-out "
                    "log beside it; or fleet.csv, a list")
        ->required();
    command.add_option("--out", o.out,
                       "folder of the results and of the overview fleet.html (default: DIR/diagnosed)");
    command
        .add_option("--jobs", o.jobs,
                    "logs at a time (default: as many as there are cores; under MPI 1 a process)")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--threads", o.threads,
                    "of one diagnosis (default: what the logs at a time leave of the cores; "
                    "under MPI 1). The answer is the same")
        ->check(CLI::Range(0, 4096));
    command.add_option("--limit", o.limit_s, "seconds after which a diagnosis counts as failed")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--program", o.program, "diagnose with this quadrant-gap instead of the one at hand");
    command.add_flag("--retry", o.retry,
                     "do again what failed before, on the same files with the same program");
    command.add_flag("--list", o.list, "say what is done, failed and not done; do nothing");
}

/// Says how many logs have which verdict, and which differ from their sisters; returns how many have none.
template <class Rows> std::size_t conclude(const Rows& rows, const options& o, const workshop& w) {
    std::vector<std::string> counts;
    std::size_t failed = 0;
    for (const std::string_view v : verdicts)
        if (const auto n =
                std::count_if(rows.begin(), rows.end(), [&](const row& r) { return r.verdict == v; })) {
            counts.push_back(fmt::format("{} {}", n, spaced(v)));
            if (v == "failed") failed = static_cast<std::size_t>(n);
        }
    const std::string overview = (w.out / "fleet.html").string();
    if (!o.quiet) std::printf("%s: %s\n", listed(counts).c_str(), overview.c_str());
    for (const row& r : rows)
        if (!o.quiet && r.verdict == "failed") std::printf("  %s: %s\n", r.name.c_str(), r.error.c_str());
    constexpr std::size_t most_told = 5;
    const auto odd = odd_ones(rows);
    if (!o.quiet && !odd.empty()) {
        std::printf("Different from their sisters:\n");
        for (std::size_t k = 0; k < std::min(odd.size(), most_told); ++k)
            std::printf("  %s\n", sentence(odd[k]).c_str());
        if (odd.size() > most_told) std::printf("  and %zu more in the overview\n", odd.size() - most_told);
    }
    std::fflush(stdout);
    return failed;
}

void lead(options o, crew& others) {
    if (o.jobs == 0) o.jobs = others.others() > 0 ? 1 : std::max(1U, std::thread::hardware_concurrency());
    std::vector<entry> entries;
    workshop w;
    std::optional<folder_lock> alone;
    try {
        entries = find_entries(o.folder);
        w = workshop_of(o);
        if (w.program_sha256.empty())
            throw bad_input(w.program.string(), "no such program; --program says where it is");
        if (!o.list) {
            std::error_code fault;
            fs::create_directories(w.out, fault);
            if (!fs::is_directory(w.out, fault)) throw bad_input(w.out.string(), "cannot be made a folder");
            alone.emplace(w.out);
            sweep(w.out);
        }
    } catch (...) {
        const desk dismissed(others, w);
        throw;
    }
    work_list list(std::move(entries), w.out, w.program_sha256, o.retry);
    if (o.list) {
        const desk dismissed(others, w);
        return print_list(list.rows());
    }
    if (o.threads == 0 && others.others() == 0 && !list.to_do().empty())
        w.threads = std::max<std::size_t>(1, std::thread::hardware_concurrency() /
                                                 std::min(o.jobs, list.to_do().size()));
    if (!o.quiet) {
        std::printf("%zu logs: %zu done before, %zu failed before%s, %zu to do\n", list.rows().size(),
                    list.done_before(), list.failed_before(),
                    list.failed_before() ? " (--retry does them again)" : "", list.left());
        std::fflush(stdout);
    }
    do_all(list, o, w, others);
    const std::size_t failed = conclude(list.rows(), o, w);
    if (failed)
        throw bad_input(o.folder, fmt::format("{} of {} logs have no diagnosis", failed, list.rows().size()));
}

void help(options o, leader& boss) {
    const workshop w = workshop_of(o);
    const std::size_t jobs = std::max<std::size_t>(o.jobs, 1);
    pool hands(w, jobs);
    boss.tell(ordered_json{{"jobs", jobs}, {"program_sha256", w.program_sha256}, {"host", w.host}}.dump());
    for (;;) {
        while (const auto task = boss.hear()) {
            if (task->empty()) return;
            const auto t = ordered_json::parse(*task);
            entry e;
            e.name = t["name"];
            e.machine = t["machine"].get<std::string>();
            e.log = t["log"].get<std::string>();
            e.holdout = t["holdout"].get<std::string>();
            e.fault = t["fault"];
            hands.start(t["index"], std::move(e));
        }
        for (const outcome& done : hands.ended())
            boss.tell(
                ordered_json{{"index", done.index}, {"error", done.error}, {"seconds", done.seconds}}.dump(
                    -1, ' ', false, ordered_json::error_handler_t::replace));
        std::this_thread::sleep_for(pause);
    }
}

} // namespace fleet

void add_fleet(CLI::App& app) {
    const auto o = std::make_shared<fleet::options>();
    const auto say = std::make_shared<terminal>();
    CLI::App* const command = app.add_subcommand(
        "fleet", "diagnose every log of a folder, resume what is missing, one overview page");
    fleet::add_options(*command, *o);
    add_terminal_options(*command, *say, "every log as it is done");
    command->callback([o, say] {
        if (o->program.empty()) o->program = std::filesystem::read_symlink("/proc/self/exe").string();
        o->quiet = say->quiet;
        o->verbose = say->verbose;
        quadrant_page::remove_scratch_when_interrupted();
        fleet::crew alone;
        fleet::lead(*o, alone);
    });
}

} // namespace quadrant_gap
