// SPDX-License-Identifier: BSL-1.0
// quadrant-gap import: another program's log in the columns and units of FORMAT.md.
#include "commands.hpp"

#include <quadrant/diagnosis/import/check_physics.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct import_options {
    std::string map, in, out;
    quadrant::diagnosis::known_axis known;
    bool unchecked = false;
    terminal say;
};

void run(const import_options& o) {
    using namespace quadrant::diagnosis;
    const auto map = read_import_map(std::filesystem::path(o.map));
    auto imported = import_log(map, std::filesystem::path(o.in));
    if (!o.unchecked) check_physics(imported, map, o.known);
    write_aside(o.out, imported.text);
    if (o.say.quiet) return;
    std::printf("%zu rows, sample period %.6g s: %s\n", imported.log.samples, imported.log.sample_period_s,
                o.out.c_str());
    for (const auto& note : imported.notes) std::printf("Note: %s.\n", note.c_str());
}

} // namespace

void add_import(CLI::App& app) {
    const auto o = std::make_shared<import_options>();
    auto* command = app.add_subcommand(
        "import", "turn another program's log into one that diagnose reads, and check its units by physics");
    command->add_option("--map", o->map, "which column is what, in which unit (JSON; examples/import)")
        ->required();
    command->add_option("IN", o->in, "the log as the other program wrote it")->required();
    command->add_option("OUT", o->out, "log to write (CSV)")->required();
    command
        ->add_option("--mass,--inertia", o->known.mass,
                     "moving mass [kg], or inertia [kg m^2], to check the units by")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--force-constant,--torque-constant", o->known.force_constant,
                     "force [N], or torque [N m], per unit of the command, to check the units by")
        ->check(CLI::PositiveNumber);
    command->add_flag("--unchecked", o->unchecked, "write it whatever physics says");
    add_terminal_options(*command, o->say, "the same as without: everything assumed is told");
    command->callback([o] { refuse_in_name_of(o->in, [&] { run(*o); }); });
}

} // namespace quadrant_gap
