// SPDX-License-Identifier: BSL-1.0
// quadrant-gap apply: the machine file with what a diagnosis found.
#include "commands.hpp"
#include "sha256.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/read_diagnosis.hpp>
#include <quadrant/diagnosis/text/text.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct apply_options {
    std::string machine, diagnosis, out;
    bool all = false;
    double at_least = 0.5;
    terminal say;
};

void run(const apply_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    using namespace quadrant::diagnosis;
    outputs files;
    files.reads("--machine", o.machine).reads("--diagnosis", o.diagnosis).writes("--out", o.out);
    const std::string text = detail::read_whole(std::filesystem::path(o.machine));
    const auto diagnosis = read_diagnosis(std::filesystem::path(o.diagnosis));
    auto result = apply(text, o.machine, diagnosis, o.all ? 0 : o.at_least);
    if (!diagnosis.machine_sha256.empty() && diagnosis.machine_sha256 != sha256(text))
        result.notes.push_back(fmt::format("{} is not, byte for byte, the machine file that was diagnosed ({})",
                                           o.machine, diagnosis.machine_file));
    write_output(o.out, result.machine.dump(2) + "\n");
    if (o.say.quiet) return;
    if (result.changes.empty()) std::fputs("Nothing was changed.\n", files.words());
    for (const auto& c : result.changes) {
        std::fprintf(files.words(), "%s: %s -> %s (%s)\n", c.path.c_str(),
                     c.before.empty() ? "absent" : c.before.c_str(), c.after.c_str(), c.reason.c_str());
    }
    for (const auto& note : result.notes) std::fprintf(files.words(), "Note: %s.\n", note.c_str());
}

} // namespace

void add_apply(CLI::App& app) {
    const auto o = std::make_shared<apply_options>();
    auto* command = app.add_subcommand("apply", "write the machine file with the causes of a diagnosis in it");
    command->add_option("--machine", o->machine, "machine file (JSON) that was diagnosed")->required();
    command->add_option("--diagnosis", o->diagnosis, "what diagnose --json wrote")->required();
    command->add_option("--out", o->out, "corrected machine file to write")->required();
    auto* all = command->add_flag("--all", o->all, "suspects too, however improbable");
    command->add_option("--at-least", o->at_least, "causes of at least this probability (default 0.5)")
        ->check(CLI::Range(0.0, 1.0))
        ->excludes(all);
    add_terminal_options(*command, o->say, "the same as without: every change is reported");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
