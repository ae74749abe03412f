// SPDX-License-Identifier: BSL-1.0
// quadrant-cnc tune: a sliding mode law by fuzzy rules, its gains written back into the machine file.
#include "../page/outputs.hpp"
#include "commands.hpp"
#include "read_cnc.hpp"
#include "tuning_page.hpp"

namespace quadrant_cnc {

void tune(const tune_options& o) {
    quadrant_page::outputs files;
    files.reads("--cnc", o.cnc).writes("--out", o.out).writes("--report", o.report).writes("--json", o.json);
    const auto dumped = [](const nlohmann::ordered_json& j) {
        return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    };
    const cnc_description cnc = read_cnc(std::filesystem::path(o.cnc));
    const trial_stroke stroke{o.distance_m, o.speed_m_per_s, o.threshold_Hz, o.trials};
    if (!(o.threshold_Hz < 0.5 / cnc.servo_period_s))
        throw quadrant::diagnosis::bad_input(
            cnc.file,
            fmt::format("servo_period_s: --threshold {:.9g} Hz must be below half the servo rate ({:.9g} Hz)",
                        o.threshold_Hz, 0.5 / cnc.servo_period_s));
    std::vector<axis_tuning> all;
    std::string axis_names;
    for (const axis_description& a : cnc.axes) {
        axis_names += fmt::format("{}{}", axis_names.empty() ? "" : ", ", a.name());
        if (o.axis.empty() || o.axis == a.name()) all.push_back(tune_axis(cnc, a, stroke));
    }
    if (all.empty())
        throw quadrant::diagnosis::bad_input(
            cnc.file, fmt::format("axes: has no axis {}; it has {}", o.axis, axis_names));
    if (!o.report.empty())
        quadrant_page::write_output(o.report, html_report(all, cnc.file, cnc.servo_period_s));
    if (!o.json.empty())
        quadrant_page::write_output(o.json, dumped(to_json(all, cnc.file, cnc.servo_period_s)));
    if (!o.quiet) std::fputs(summary(all).c_str(), files.words());
    if (o.out.empty()) return;
    auto machine = nlohmann::ordered_json::parse(qd::read_whole(std::filesystem::path(o.cnc)));
    for (const axis_tuning& t : all) {
        if (!t.trials.settled)
            throw quadrant::diagnosis::bad_input(
                cnc.file,
                fmt::format("axes.{}.control: the rules still ask for a change after {} trials, so {} is "
                            "not written: give --trials or other gains to begin with",
                            t.name, t.trials.steps.size(), o.out));
        auto& control = machine["axes"][t.name]["control"];
        control["gain_V_s_per_m"] = t.end().gain.value();
        control["adaptation_V_per_m"] = t.end().adaptation.value();
    }
    quadrant_page::write_output(o.out, dumped(machine));
}

} // namespace quadrant_cnc
