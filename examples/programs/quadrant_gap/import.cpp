// SPDX-License-Identifier: BSL-1.0
// quadrant-gap import: another program's log in the columns and units of docs/formats.md.
#include "commands.hpp"
#include "log_of_text.hpp"

#include <quadrant/diagnosis/check_physics.hpp>
#include <quadrant/diagnosis/import/table_file.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <iostream>
#include <memory>
#include <tuple>
#include <unistd.h>

namespace quadrant_gap {

namespace {

struct import_options {
    std::string map, command_is;
    std::vector<std::string> files; ///< those to read, and the one to write
    quadrant::diagnosis::import_choice choice;
    quadrant::diagnosis::known_axis known;
    bool unchecked = false, propose = false;
    terminal say;
};

/// Asks where a current or torque was taken, when neither map nor option says it and somebody is there to
/// answer.
void ask_origin(quadrant::diagnosis::import_map& map) {
    using namespace quadrant::diagnosis;
    for (auto& axis : map.axes) {
        const auto* command = axis.find(signal_role::command);
        if (!command || command->si == "V" || is_set_point(command->si) ||
            axis.command_is == command_origin::measured)
            continue;
        std::fprintf(stderr,
                     "axis %s: the command in %s is asked by the controller, or measured behind the amplifier "
                     "(asked or measured): ",
                     axis.name.c_str(), command->si.c_str());
        std::string answer;
        if (std::getline(std::cin, answer) && answer.starts_with('m'))
            axis.command_is = command_origin::measured;
    }
}

/// A map file with what the header says; what it does not say is "?".
void propose(const import_options& o) {
    using namespace quadrant::diagnosis;
    const std::string &in = o.files.front(), &out = o.files.back();
    outputs paths;
    paths.reads("input 1", in).writes("MAP", out);
    if (o.files.size() != 2 || !o.map.empty())
        throw bad_input("--propose", "takes one log and the map to write");
    const auto proposed = propose_map(
        text_of_table_file(quadrant::diagnosis::detail::read_whole(std::filesystem::path(in)), in), in);
    if (proposed.columns.empty())
        throw bad_input(in,
                        fmt::format("is no table: none of its first {} lines is a row of numbers. Begin with a "
                                    "map of examples/import",
                                    quadrant::diagnosis::detail::most_header_lines));
    write_output(out, proposed.map().dump(2) + "\n");
    if (o.say.quiet) return;
    const std::string by = proposed.tool.empty() ? "the names of the columns say" : proposed.tool + " wrote";
    const std::string said = proposed.said();
    std::fprintf(paths.words(), "%s: a map of what %s: %s\n", out.c_str(), by.c_str(),
                 said.empty() ? "nothing" : said.c_str());
    for (const auto& note : proposed.notes) std::fprintf(paths.words(), "Note: %s.\n", note.c_str());
    for (const auto& open : proposed.open) std::fprintf(paths.words(), "To put in: %s.\n", open.c_str());
}

void run(const import_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    if (o.propose) return propose(o);
    using namespace quadrant::diagnosis;
    outputs paths;
    paths.reads("--map", o.map);
    for (std::size_t i = 0; i + 1 < o.files.size(); ++i)
        paths.reads(fmt::format("input {}", i + 1), o.files[i]);
    paths.writes("OUT", o.files.back());
    std::vector<foreign_file> files;
    for (std::size_t i = 0; i + 1 < o.files.size(); ++i) {
        std::string text = quadrant::diagnosis::detail::read_whole(std::filesystem::path(o.files[i]));
        files.push_back({text_of_table_file(std::move(text), o.files[i]), o.files[i]});
    }
    const std::string& out = o.files.back();
    import_map map;
    std::vector<std::string> guesses;
    if (!o.map.empty())
        map = read_import_map(std::filesystem::path(o.map));
    else if (files.size() > 1)
        throw bad_input("--map", "is needed to join several files");
    else
        try {
            map = map_of_header(files.front().text, files.front().name);
        } catch (const bad_input&) {
            auto guessed = guessed_map(files.front().text, files.front().name);
            if (!guessed) throw;
            std::tie(map, guesses) = std::move(*guessed);
        }
    if (o.command_is == "measured")
        for (auto& axis : map.axes) axis.command_is = command_origin::measured;
    else if (o.command_is.empty() && isatty(STDIN_FILENO))
        ask_origin(map);
    auto imported = import_log(map, files, o.choice);
    if (!o.unchecked) check_physics(imported, o.known);
    write_output(out, imported.text);
    if (o.say.quiet) return;
    std::fprintf(paths.words(), "%zu rows, sample period %.6g s: %s\n", imported.log.samples,
                 imported.log.sample_period_s, out.c_str());
    for (const auto& note : guesses) std::fprintf(paths.words(), "Note: %s.\n", note.c_str());
    for (const auto& note : imported.notes) std::fprintf(paths.words(), "Note: %s.\n", note.c_str());
}

} // namespace

void add_import(CLI::App& app) {
    const auto o = std::make_shared<import_options>();
    auto* command = app.add_subcommand(
        "import", "turn another program's log into one that diagnose reads, and check its units by physics");
    command->add_option(
        "--map", o->map,
        "which column is what, in which unit (JSON; examples/import). Not needed where the columns "
        "have our names, in any unit (t_ms, x_pos_mm), or those of ODrive");
    command->add_flag(
        "--propose", o->propose,
        "IN MAP: write a map with what the header of ODrive, TwinCAT Scope, halscope or halsampler, or the "
        "names of any other table's columns say; put in what is \"?\"");
    command
        ->add_option(
            "FILES", o->files,
            "IN... OUT: the log as the other program wrote it, or several files that the map joins on time; "
            "then the log to write (CSV)")
        ->required()
        ->expected(2, 100);
    command->add_flag("--resample", o->choice.resample,
                      "onto an even clock, with the median step of the stamps as its period");
    command->add_option("--sample-period", o->choice.period_s, "resample onto an even clock of this period [s]")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--from", o->choice.from_s, "leave out the rows before this time [s], from the first row")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--to", o->choice.to_s, "leave out the rows behind this time [s]")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--command-is", o->command_is,
                     "where the command was taken: asked by the controller, or measured behind the amplifier")
        ->check(CLI::IsMember({"asked", "measured"}));
    command
        ->add_option("--mass,--inertia", o->known.mass,
                     "moving mass [kg], or inertia [kg m^2], to check the units by")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--force-constant,--torque-constant", o->known.force_constant,
                     "force [N], or torque [N m], per unit of the command, to check the units by")
        ->check(CLI::PositiveNumber);
    command->add_flag("--unchecked", o->unchecked, "write it whatever physics says");
    add_terminal_options(*command, o->say, "the same as without: everything assumed is reported");
    command->callback([o] { refuse_in_name_of(o->files.front(), [&] { run(*o); }); });
}

} // namespace quadrant_gap
