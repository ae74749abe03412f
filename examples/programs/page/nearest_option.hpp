// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/text/json_node.hpp>

#include <CLI/CLI.hpp>

/// What a mistyped command line may have meant.
namespace quadrant_page {

/// "there is no --jsn; did you mean --json?" for the first word that names no subcommand or option; empty when
/// every word does.
inline std::string nearest_option(const CLI::App& program, int argc, const char* const* argv) {
    using quadrant::diagnosis::detail::suggestion;
    const CLI::App* command = &program;
    const auto ask = [](const std::string& word, const std::vector<std::string>& names) {
        const std::string text = suggestion(word, names);
        return text.empty() ? text : fmt::format("there is no {}{}", word, text);
    };
    const auto subcommands = program.get_subcommands([](const CLI::App*) { return true; });
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        if (k == 1 && !word.starts_with('-') && !subcommands.empty()) {
            std::vector<std::string> names;
            for (const CLI::App* sub : subcommands) {
                names.push_back(sub->get_name());
                if (sub->get_name() == word) command = sub;
            }
            if (command == &program) return ask(word, names);
        }
        const std::string name = word.substr(0, word.find('='));
        if (!name.starts_with("--") || name == "--" || command->get_option_no_throw(name)) continue;
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
            for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
        return ask(name, names);
    }
    return "";
}

/// Prints what may have been meant, or else what CLI11 has to say: after a mistyped word it asks for what was
/// given under a wrong name. `refused` is the exit code of a wrong command line.
inline int said(const CLI::App& program, const CLI::ParseError& fault, int argc, const char* const* argv,
                int refused) {
    const auto hint = fault.get_exit_code() == 0 ? "" : nearest_option(program, argc, argv);
    if (hint.empty()) return program.exit(fault) == 0 ? 0 : refused;
    std::fprintf(stderr, "%s: %s\nRun with --help for more information.\n", program.get_name().c_str(),
                 hint.c_str());
    return refused;
}

} // namespace quadrant_page
