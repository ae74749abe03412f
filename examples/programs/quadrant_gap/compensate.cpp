// SPDX-License-Identifier: BSL-1.0
// quadrant-gap compensate: what feedforwards built from a diagnosis would gain in the controller.
#include "commands.hpp"
#include "compensation_summary.hpp"

#include <quadrant/diagnosis/match.hpp>
#include <quadrant/diagnosis/read_diagnosis.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/write_compensation.hpp>

#include <memory>

namespace quadrant_gap {

namespace {

struct compensate_options {
    std::string machine, diagnosis, log, json, controller;
    bool all = false;
    double at_least = 0.5;
    terminal say;
};

void run(const compensate_options& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    files.reads("--machine", o.machine).reads("--diagnosis", o.diagnosis).reads("--log", o.log);
    files.writes("--json", o.json).writes("--controller", o.controller);
    const auto machine = read_machine(std::filesystem::path(o.machine));
    const auto diagnosis = read_diagnosis(std::filesystem::path(o.diagnosis));
    auto log = read_log(std::filesystem::path(o.log));
    keep_described(machine, log);
    check_match(machine, log);
    const auto result = quadrant::diagnosis::compensate(machine, diagnosis, log, o.all ? 0 : o.at_least);
    const auto write = [](const std::string& file, const nlohmann::ordered_json& json) {
        if (!file.empty())
            write_output(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    };
    write(o.json, to_json(result));
    write(o.controller, controller_patch(result));
    if (!o.say.quiet) std::fputs(summary(result, o.say.verbose).c_str(), files.words());
}

} // namespace

void add_compensate(CLI::App& app) {
    const auto o = std::make_shared<compensate_options>();
    auto* command =
        app.add_subcommand("compensate", "forecast what feedforwards built from a diagnosis would gain");
    command->add_option("--machine", o->machine, "machine file (JSON) that was diagnosed")->required();
    command->add_option("--diagnosis", o->diagnosis, "what diagnose --json wrote")->required();
    command->add_option("--log", o->log, "servo log (CSV) of that machine, any motion")->required();
    command->add_option("--json", o->json, "write the forecast, with the settings of each feedforward (JSON)");
    command->add_option("--controller", o->controller,
                        "write the controller's keys that gain (JSON, a merge patch to the machine file)");
    auto* all = command->add_flag("--all", o->all, "suspects too, however improbable");
    command->add_option("--at-least", o->at_least, "causes of at least this probability (default 0.5)")
        ->check(CLI::Range(0.0, 1.0))
        ->excludes(all);
    add_terminal_options(*command, o->say, "also the settings of each block");
    command->callback([o] { refuse_in_name_of(o->machine, [&] { run(*o); }); });
}

} // namespace quadrant_gap
