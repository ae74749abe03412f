// SPDX-License-Identifier: BSL-1.0
// quadrant-gap forecast: how far the gap will shrink on a motion that was not recorded yet.
#include "commands.hpp"
#include "simulation_summary.hpp"

#include <quadrant/diagnosis/forecast.hpp>
#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_diagnosis.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct forecast_options {
    std::string machine, diagnosis, motion, json;
    double at_least = 0.5;
    terminal say;
};

std::string forecast_summary(const forecast_result& f, bool verbose) {
    std::string text =
        wrapped(fmt::format("{} on a machine as the diagnosis of {} expects it", f.motion_file, f.machine_file),
                0) +
        "\n";
    for (const forecast_axis& a : f.axes) {
        std::string words = fmt::format("{} of residual force as described, {} corrected: the gap {}.",
                                        quantity(a.before.force_rms_N, "N"), quantity(a.after.force_rms_N, "N"),
                                        shrinkage({a.shrink, a.shrink, a.shrink}));
        if (verbose)
            words += fmt::format(
                " Floor of sensor and rounding {}; position of the closed loop {} rms beside the machine as "
                "described, {} corrected.",
                quantity(a.after.noise_floor_force_rms_N, "N"), quantity(a.before.position_rms_m, "m"),
                quantity(a.after.position_rms_m, "m"));
        text += wrapped("Axis " + a.name + ": " + text_of(words, a.kind), 0);
    }
    for (const std::string& note : f.notes) text += wrapped("Note: " + note, 0);
    return text;
}

void run(const forecast_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    using namespace quadrant::diagnosis;
    outputs files;
    files.reads("--machine", o.machine).reads("--diagnosis", o.diagnosis).reads("--motion", o.motion);
    files.writes("--json", o.json);
    const auto machine = read_machine(std::filesystem::path(o.machine));
    auto motion = read_motion(std::filesystem::path(o.motion));
    join_gantry_pairs(machine, motion);
    for (auto& planned : motion.axes)
        if (const auto axis = quadrant::diagnosis::detail::named(machine.axes, planned.name)) {
            planned.command_unit = axis->drive.kind == drive_kind::velocity
                                       ? axis->drive.velocity_per_V ? "V" : key_of("m_per_s", axis->kind)
                                   : axis->drive.closes() ? ""
                                                          : axis->command_unit;
        }
    check_match(machine, motion);
    const auto found = read_diagnosis(std::filesystem::path(o.diagnosis));
    const auto result = forecast(machine, found, motion, o.at_least);
    if (!o.json.empty())
        write_output(o.json,
                     to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.say.quiet) std::fputs(forecast_summary(result, o.say.verbose).c_str(), files.words());
}

} // namespace

void add_forecast(CLI::App& app) {
    const auto o = std::make_shared<forecast_options>();
    auto* command = app.add_subcommand("forecast", "how far the gap will shrink on a motion not recorded yet");
    command->add_option("--machine", o->machine, "machine file (JSON) that was diagnosed")->required();
    command->add_option("--diagnosis", o->diagnosis, "what diagnose --json wrote")->required();
    command->add_option("--motion", o->motion, "references (CSV: t_s, x_ref_m, ...; a log will do)")
        ->required();
    command->add_option("--json", o->json, "write the gaps before and after (JSON)");
    command->add_option("--at-least", o->at_least, "causes of at least this probability (default 0.5)")
        ->check(CLI::Range(0.0, 1.0));
    add_terminal_options(*command, o->say, "also the floor and the closed loop");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
