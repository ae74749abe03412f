// SPDX-License-Identifier: BSL-1.0
// quadrant-gap init: begins a machine file from options, a log, and a few questions on a terminal.
#include "commands.hpp"
#include "log_of_text.hpp"

#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/machine_file/init_fields.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <iostream>
#include <memory>
#include <unistd.h>

namespace quadrant_gap {

namespace {

using namespace quadrant::diagnosis;

struct init_options {
    std::string out, log, command_is, drive;
    bool questions = false;
    init_request request;
    std::array<std::vector<std::string>, init_fields.size()> texts;
    std::array<std::vector<std::string>, drive_init_fields.size()> drive_texts;
    terminal say;
};

/// "340", "0.4ms", "x=340": the axis ("" is every axis) and the number in SI. `kind_of` returns an axis' kind.
template <class KindOf>
std::pair<std::string, double> parse(const init_field& f, std::string_view text, KindOf kind_of) {
    const auto refuse = [&](std::string_view what) {
        throw bad_input(fmt::format("--{}", f.option),
                        fmt::format("{}: {}", quadrant::diagnosis::detail::in_quotes(text), what));
    };
    const std::size_t equals = text.find('=');
    const std::string axis(equals == text.npos ? "" : text.substr(0, equals));
    const std::string_view rest = equals == text.npos ? text : text.substr(equals + 1);
    const std::size_t end = std::min(rest.find_first_not_of("0123456789.eE+-"), rest.size());
    std::string_view unit = rest.substr(end);
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    double value = 0;
    if (const char* fault = quadrant::diagnosis::detail::parse_number(rest.substr(0, end), value))
        refuse(fault);
    const std::string wanted = key_of(f.unit, kind_of(axis));
    if (unit.empty() || unit == wanted) return {axis, value};
    const unit_name* known = find_unit(unit);
    if (!known || known->si != wanted)
        refuse(fmt::format("is not a number of {}", *f.unit ? text_of(f.unit, kind_of(axis)) : "no unit"));
    return {axis, known->factor < 1 ? value / (1 / known->factor) : value * known->factor};
}

/// Asks for what is not given; an empty answer leaves it out.
void ask(init_options& o, axis_kind kind) {
    constexpr std::string_view asked[]{
        "mass",           "force-constant",           "viscous",        "delay", "coulomb",
        "tolerance-mass", "tolerance-force-constant", "resolution",     "limit", "position-gain",
        "velocity-gain",  "velocity-integral",        "velocity-filter"};
    for (std::size_t i = 0; i < init_fields.size(); ++i) {
        const init_field& f = init_fields[i];
        if (!o.texts[i].empty() || std::find(std::begin(asked), std::end(asked), f.option) == std::end(asked))
            continue;
        const std::string question =
            text_of(f.meaning, kind) + (*f.unit ? fmt::format(" [{}]", text_of(f.unit, kind)) : "");
        std::fprintf(stderr, "%s: ", question.c_str());
        std::string answer;
        if (!std::getline(std::cin, answer)) return;
        if (!answer.empty()) o.texts[i].push_back(answer);
    }
}

/// Asks where the command was taken, when no option says it; an empty answer means before the amplifier.
void ask_origin(init_options& o) {
    if (!o.command_is.empty()) return;
    std::fputs("the command is asked by the controller, or measured behind the amplifier (asked or measured): ",
               stderr);
    std::string answer;
    if (std::getline(std::cin, answer) && answer.starts_with('m'))
        o.command_is = name_of(command_origin::measured);
}

/// A log in our own format; another program's is refused with what brings it in.
machine_log read_own_log(const std::string& file) {
    const std::filesystem::path path(file);
    try {
        return read_log(path);
    } catch (const bad_input&) {
        const auto proposed = propose_map(quadrant::diagnosis::detail::read_whole(path), file);
        if (proposed.tool.empty()) throw;
        throw bad_input(file,
                        fmt::format("looks like a file of {}: bring it in first, with \"quadrant-gap import {} "
                                    "log.csv\"",
                                    proposed.tool, file));
    }
}

void run(init_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    const bool to_file = o.out != quadrant_page::standard_output;
    const std::string beside =
        to_file ? std::filesystem::path(o.out).replace_extension("md").string() : std::string();
    files.reads("--log", o.log).writes("--out", o.out).writes("the comments of --out", beside);
    std::optional<machine_log> log;
    if (!o.log.empty()) log = read_own_log(o.log);
    const auto kind_of = [&](const std::string& axis) { // "": of the log's first
        if (!log) return o.request.rotary ? axis_kind::rotary : axis_kind::linear;
        for (const axis_log& a : log->axes)
            if (a.name == axis) return a.kind;
        return log->axes.front().kind;
    };
    if (o.questions || isatty(STDIN_FILENO)) {
        if (!log && !o.request.rotary) {
            std::fputs("a rotary axis, in rad and N m (yes or no): ", stderr);
            std::string answer;
            o.request.rotary = std::getline(std::cin, answer) && answer.starts_with('y');
        }
        ask(o, kind_of(""));
        ask_origin(o);
    }
    const auto take = [&](const auto& fields, const auto& texts) {
        for (std::size_t i = 0; i < fields.size(); ++i)
            for (const std::string& text : texts[i]) {
                const auto [axis, value] = parse(fields[i], text, kind_of);
                o.request.values[fields[i].option][axis] = value;
            }
    };
    take(init_fields, o.texts);
    take(drive_init_fields, o.drive_texts);
    if (!o.drive.empty())
        o.request.drive = static_cast<drive_kind>(std::find(drive_kinds.begin(), drive_kinds.end(), o.drive) -
                                                  drive_kinds.begin());
    else
        for (std::size_t i = 0; i < drive_init_fields.size(); ++i)
            if (!o.drive_texts[i].empty())
                throw bad_input(
                    fmt::format("--{}", drive_init_fields[i].option),
                    "is of a drive with loops of its own: say which with --drive velocity, position "
                    "or position_servo");
    if (o.command_is == name_of(command_origin::measured)) o.request.command_is = command_origin::measured;
    const auto begun = init_machine(o.request, log ? &*log : nullptr);
    write_output(o.out, begun.machine.dump(2) + "\n");
    if (to_file) write_output(beside, begun.comments);
    if (o.say.quiet) return;
    if (to_file)
        std::fprintf(files.words(), "%s written; %s says what each value means and where it is from.\n",
                     o.out.c_str(), beside.c_str());
    for (const auto& note : begun.notes) std::fprintf(files.words(), "Note: %s\n", note.c_str());
    if (o.say.verbose) std::fputs(("\n" + begun.comments).c_str(), files.words());
}

} // namespace

void add_init(CLI::App& app) {
    const auto o = std::make_shared<init_options>();
    auto* command =
        app.add_subcommand("init", "begin a machine file from a few numbers, and a log when there is one");
    command->add_option("--out", o->out, "machine file to write; its comments go beside it (.md)")->required();
    command->add_option("--log", o->log, "servo log (CSV): period, axes, units and resolution come from it");
    command->add_option("--axes", o->request.axes, "names of the axes (default: the log's, or x)")
        ->delimiter(',');
    command->add_option("--sample-period", o->request.sample_period_s, "period of the servo loop [s]")
        ->check(CLI::PositiveNumber);
    command->add_option("--command-unit", o->request.command_unit, "unit of the command: V, A or N (Nm)")
        ->check(CLI::IsMember({"V", "A", "N", "Nm"}));
    command
        ->add_option(
            "--command-is", o->command_is,
            "where the log's command was taken: asked by the controller (default), or measured behind the "
            "amplifier (a measured current or torque)")
        ->check(CLI::IsMember({"asked", "measured"}));
    command->add_flag("--rotary", o->request.rotary,
                      "rotary axes, in rad and N m (a log says so itself): --inertia for --mass");
    command->add_flag("--from-log", o->request.from_log,
                      "mass, friction and gravity that are not given: from the log, where it is sure of them");
    command->add_flag("--unchecked", o->request.unchecked,
                      "write the file although the log contradicts mass or force constant, with a note");
    command->add_flag("--questions", o->questions, "ask for what is not given, though no terminal listens");
    command
        ->add_option(
            "--drive", o->drive,
            "a drive with loops of its own: velocity, position or position_servo; what is not given of "
            "its loops is identified from the log")
        ->check(CLI::IsMember(std::vector<std::string>(drive_kinds.begin() + 1, drive_kinds.end())));
    const auto add_value = [&](const init_field& f, std::vector<std::string>& texts, const char* group) {
        const std::string unit = *f.unit ? fmt::format(" [{}]", f.unit) : "",
                          of_rotary = text_of(f.option, axis_kind::rotary);
        const std::string names = of_rotary == f.option ? fmt::format("--{}", f.option)
                                                        : fmt::format("--{},--{}", f.option, of_rotary);
        command->add_option(names, texts, f.meaning + unit)->delimiter(',')->group(group);
    };
    for (std::size_t i = 0; i < init_fields.size(); ++i)
        add_value(init_fields[i], o->texts[i], "Values, for every axis or AXIS=VALUE,...");
    for (std::size_t i = 0; i < drive_init_fields.size(); ++i)
        add_value(drive_init_fields[i], o->drive_texts[i], "Values of a drive with loops of its own");
    add_terminal_options(*command, o->say, "also every value with its meaning");
    command->callback([o] { refuse_in_name_of(o->out, [&] { run(*o); }); });
}

} // namespace quadrant_gap
