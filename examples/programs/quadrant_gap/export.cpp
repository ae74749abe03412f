// SPDX-License-Identifier: BSL-1.0
// quadrant-gap export: the plant of a machine file for another simulator.
#include "commands.hpp"

#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_mjcf.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct export_options {
    std::string machine, mjcf;
    terminal say;
};

void run(const export_options& o) {
    using namespace quadrant::diagnosis;
    outputs files;
    files.reads("--machine", o.machine).writes("--mjcf", o.mjcf);
    const auto model = to_mjcf(read_machine(std::filesystem::path(o.machine)));
    write_output(o.mjcf, model.xml);
    if (o.say.quiet) return;
    for (const auto& note : model.notes) std::fprintf(files.words(), "Note: %s.\n", note.c_str());
}

} // namespace

void add_export(CLI::App& app) {
    const auto o = std::make_shared<export_options>();
    auto* command = app.add_subcommand("export", "write the plant of a machine file for another simulator");
    command->add_option("--machine", o->machine, "machine file (JSON); apply writes a corrected one")
        ->required();
    command->add_option("--mjcf", o->mjcf, "model to write, as MuJoCo reads it (XML)")->required();
    add_terminal_options(*command, o->say, "the same as without: what the model cannot hold is told");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
