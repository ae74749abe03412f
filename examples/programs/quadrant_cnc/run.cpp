// SPDX-License-Identifier: BSL-1.0
// quadrant-cnc run: a part program through the virtual machine, and what it leaves behind.
#include "../page/outputs.hpp"
#include "commands.hpp"
#include "gap_machine.hpp"
#include "read_cnc.hpp"
#include "report.hpp"
#include "simulate.hpp"

#include <quadrant/diagnosis/write_diagnosis.hpp>
#include <quadrant/diagnosis/write_machine.hpp>

#include <memory>
#include <unistd.h>

namespace quadrant_cnc {

namespace {

/// On a terminal one line that changes; into a file one line every ten seconds.
class progress_line {
public:
    explicit progress_line(bool quiet) : quiet_(quiet) {}
    ~progress_line() { clear(); }
    void clear() {
        if (shown_) fmt::print(stderr, "\r\033[K");
        shown_ = false;
    }
    void operator()(const progress& p) {
        if (quiet_ || (!terminal_ && p.wall_time < next_)) return;
        next_ = p.wall_time + 10;
        fmt::print(stderr, "{}{:3.0f} %  line {}, {:.1f} s simulated, {:.0f} times faster than real time{}",
                   terminal_ ? "\r\033[K" : "", 100 * p.share, p.line, p.time,
                   p.cpu_time > 0 ? p.time / p.cpu_time : 0, terminal_ ? "" : "\n");
        std::fflush(stderr);
        shown_ = terminal_;
    }

private:
    bool quiet_, terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
    double next_ = 10;
};

} // namespace

void run(const run_options& o) {
    quadrant_page::outputs files;
    files.reads("--cnc", o.cnc).reads("--path", o.path).writes("--log", o.log);
    files.writes("--export-gap-machine", o.machine).writes("--report", o.report).writes("--json", o.json);
    const auto dumped = [](const nlohmann::ordered_json& j) {
        return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    };
    const cnc_description cnc = read_cnc(std::filesystem::path(o.cnc));
    std::unique_ptr<log_writer> log;
    if (!o.log.empty()) log = std::make_unique<log_writer>(o.log, log_header(cnc));
    progress_line line(o.quiet);
    const kept_for what = o.report.empty() ? kept_for::figures : kept_for::pages;
    run_outcome out = simulate(
        cnc, o.path, log.get(), [&](const progress& p) { line(p); }, what);
    line.clear();
    if (log) log->finish();
    if (!o.machine.empty())
        quadrant_page::write_output(o.machine, dumped(to_json(gap_machine(cnc, out.notes))));
    if (!o.report.empty()) quadrant_page::write_output(o.report, html_report(out));
    if (!o.json.empty()) quadrant_page::write_output(o.json, dumped(to_json(out)));
    if (!o.quiet) std::fputs(summary(out).c_str(), files.words());
}

} // namespace quadrant_cnc
