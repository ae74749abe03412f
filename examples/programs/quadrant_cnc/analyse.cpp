// SPDX-License-Identifier: BSL-1.0
// quadrant-cnc analyse: the axes of a machine in the frequency and the time domain.
#include "../page/outputs.hpp"
#include "analyse_axis.hpp"
#include "analysis_page.hpp"
#include "commands.hpp"
#include "read_cnc.hpp"

namespace quadrant_cnc {

void analyse(const analyse_options& o) {
    quadrant_page::outputs files;
    files.reads("--cnc", o.cnc).writes("--report", o.report).writes("--json", o.json);
    const cnc_description cnc = read_cnc(std::filesystem::path(o.cnc));
    machine_analysis out{.cnc_file = cnc.file, .period = cnc.servo_period_s, .axes = {}, .notes = {}};
    std::string names;
    for (const axis_description& a : cnc.axes) {
        names += fmt::format("{}{}", names.empty() ? "" : ", ", a.name());
        if (!o.axis.empty() && o.axis != a.name()) continue;
        out.axes.push_back(analyse_axis(a, cnc.servo_period_s, cnc.seed, o.step_m));
    }
    if (out.axes.empty())
        throw quadrant::diagnosis::bad_input(cnc.file,
                                             fmt::format("axes: has no axis {}; it has {}", o.axis, names));
    out.notes.push_back("The responses are those of the linear part: friction but the viscous one, play, steps "
                        "and noise of the "
                        "sensors, limits and the converter are left out. They lower what a machine reaches.");
    if (!o.report.empty()) quadrant_page::write_output(o.report, html_report(out));
    if (!o.json.empty())
        quadrant_page::write_output(
            o.json, to_json(out).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.quiet) std::fputs(summary(out).c_str(), files.words());
}

} // namespace quadrant_cnc
