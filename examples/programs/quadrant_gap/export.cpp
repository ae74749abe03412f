// SPDX-License-Identifier: BSL-1.0
// quadrant-gap export: a machine file as other programs take it.
#include "commands.hpp"
#include "settings.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_mjcf.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct export_options {
    std::string machine, log, mjcf, linuxcnc, drive, table;
    terminal say;
};

void run(const export_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    files.reads("--machine", o.machine).reads("--log", o.log);
    files.writes("--mjcf", o.mjcf).writes("--linuxcnc", o.linuxcnc);
    files.writes("--drive", o.drive).writes("--compensation", o.table);
    if (o.mjcf.empty() && o.linuxcnc.empty() && o.drive.empty() && o.table.empty())
        throw bad_input(o.machine, "nothing is asked for: --mjcf, --linuxcnc, --drive or --compensation FILE");
    const auto machine = read_machine(std::filesystem::path(o.machine));
    const auto write = [&](const std::string& path, const std::string& text,
                           const std::vector<std::string>& notes) {
        write_output(path, text);
        if (o.say.quiet) return;
        for (const auto& note : notes) std::fprintf(files.words(), "Note: %s.\n", note.c_str());
    };
    if (!o.mjcf.empty()) {
        const auto model = to_mjcf(machine);
        write(o.mjcf, model.xml, model.notes);
    }
    if (!o.linuxcnc.empty()) {
        const auto lines = linuxcnc_lines(machine);
        write(o.linuxcnc, lines.text, lines.notes);
    }
    if (!o.drive.empty()) {
        const auto values = drive_values(machine);
        write(o.drive, values.text, values.notes);
    }
    if (!o.table.empty()) {
        spans travel;
        if (!o.log.empty()) {
            auto log = read_log(std::filesystem::path(o.log));
            join_gantry_pairs(machine, log);
            check_match(machine, log);
            travel = travel_of(log);
        }
        const auto table = compensation_table(machine, travel);
        write(o.table, table.text, table.notes);
    }
}

} // namespace

void add_export(CLI::App& app) {
    const auto o = std::make_shared<export_options>();
    auto* command = app.add_subcommand("export", "write a machine file as other programs take it");
    command->add_option("--machine", o->machine, "machine file (JSON); apply writes a corrected one")
        ->required();
    command->add_option("--mjcf", o->mjcf, "write the plant as MuJoCo reads it (XML)");
    command->add_option("--linuxcnc", o->linuxcnc, "write lines for the INI and the HAL file of LinuxCNC");
    command->add_option("--drive", o->drive, "write values for the parameters of a drive (CSV)");
    auto* table = command->add_option("--compensation", o->table,
                                      "write corrections of command and position over the position (CSV)");
    command->add_option("--log", o->log, "log of that machine: the table covers where it went; else one period")
        ->needs(table);
    add_terminal_options(*command, o->say, "the same as without: what the format cannot hold is reported");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
