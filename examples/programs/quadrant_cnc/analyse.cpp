// SPDX-License-Identifier: BSL-1.0
// quadrant-cnc analyse: the axes of a machine in the frequency and the time domain.
#include "../page/outputs.hpp"
#include "analyse_axis.hpp"
#include "analysis_page.hpp"
#include "chirp_log.hpp"
#include "commands.hpp"
#include "read_cnc.hpp"

namespace quadrant_cnc {

void analyse(const analyse_options& o) {
    quadrant_page::outputs files;
    files.reads("--cnc", o.cnc).reads("--frf", o.frf).reads("--chirp", o.chirp);
    files.writes("--report", o.report).writes("--json", o.json).writes("--write-frf", o.write_frf);
    const cnc_description cnc = read_cnc(std::filesystem::path(o.cnc));
    machine_analysis out{.cnc_file = cnc.file, .period = cnc.servo_period_s, .axes = {}, .notes = {}};
    std::optional<frf_file> frf;
    const char* const given = o.chirp.empty() ? "--frf" : "--chirp";
    if (!o.frf.empty() || !o.chirp.empty()) {
        if (!o.frf.empty() && !o.chirp.empty())
            throw quadrant::diagnosis::bad_input(o.chirp, "--chirp and --frf say the same: give one of them");
        if (o.axis.empty() && cnc.axes.size() > 1)
            throw quadrant::diagnosis::bad_input(
                cnc.file,
                fmt::format("axes: has {}; --axis must say which of them {} is of", cnc.axes.size(), given));
        frf = o.chirp.empty()
                  ? read_frf(o.frf, cnc.servo_period_s)
                  : frf_of_log(o.chirp, o.axis.empty() ? cnc.axes.front().name() : o.axis, cnc.servo_period_s);
    }
    if (!o.write_frf.empty() && o.chirp.empty())
        throw quadrant::diagnosis::bad_input(o.write_frf, "--write-frf needs --chirp, which it is made from");
    std::string names;
    for (const axis_description& a : cnc.axes) {
        names += fmt::format("{}{}", names.empty() ? "" : ", ", a.name());
        if (!o.axis.empty() && o.axis != a.name()) continue;
        out.axes.push_back(analyse_axis(a, cnc.servo_period_s, cnc.seed, o.step_m, frf ? &*frf : nullptr));
        if (frf && !out.axes.back().measured)
            throw quadrant::diagnosis::bad_input(
                cnc.file,
                fmt::format("{}.control: its loop must be stable and linear around the drive of this file, "
                            "so that its law can be put around {}; it is {}",
                            a.path, given, out.axes.back().stable ? "not linear" : "not stable"));
    }
    if (out.axes.empty())
        throw quadrant::diagnosis::bad_input(cnc.file,
                                             fmt::format("axes: has no axis {}; it has {}", o.axis, names));
    if (frf)
        out.notes.push_back(
            fmt::format("The responses are those of the law of the machine file around the measured "
                        "axis of {}, from {} to {} Hz; the step is that of the machine file.",
                        frf->file, number(frf->from_Hz()), number(frf->to_Hz())));
    if (frf)
        out.notes.insert(out.notes.end(), frf->notes.begin(), frf->notes.end());
    else
        out.notes.push_back(
            "The responses are those of the linear part: friction but the viscous one, play, steps "
            "and noise of the "
            "sensors, limits and the converter are left out. They lower what a machine reaches.");
    if (!o.write_frf.empty()) quadrant_page::write_output(o.write_frf, frf_table(*frf));
    if (!o.report.empty()) quadrant_page::write_output(o.report, html_report(out));
    if (!o.json.empty())
        quadrant_page::write_output(
            o.json, to_json(out).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.quiet) std::fputs(summary(out).c_str(), files.words());
}

} // namespace quadrant_cnc
