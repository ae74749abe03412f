// SPDX-License-Identifier: BSL-1.0
// quadrant-cnc: what a machine makes of a part program, before there is a machine.
#include "../page/nearest_option.hpp"
#include "../page/outputs.hpp"
#include "commands.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

namespace {

void add_run(CLI::App& app) {
    const auto o = std::make_shared<quadrant_cnc::run_options>();
    auto* command = app.add_subcommand("run", "drive a part program through the virtual machine");
    command->add_option("--cnc", o->cnc, "the machine (JSON, docs/cnc.md)")->required();
    command->add_option("--path", o->path, "the part program: a CL file (.cl, .cls, .apt), else G-code")
        ->required();
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    command->add_option("--log", o->log, "write every servo sample (CSV), as quadrant-gap reads it");
    command->add_option("--export-gap-machine", o->machine,
                        "write the machine as quadrant-gap reads it (JSON)");
    auto* json =
        command->add_option("--json", o->json, "write the figures (JSON); without a file name: print them");
    json->expected(0, 1);
    command->add_flag("-q,--quiet", o->quiet, "no text, only the files");
    command->set_version_flag("--version", QUADRANT_VERSION);
    command->callback([o, json] {
        if (json->count() > 0 && o->json.empty()) o->json = "-";
        quadrant_cnc::run(*o);
    });
}

void add_analyse(CLI::App& app) {
    const auto o = std::make_shared<quadrant_cnc::analyse_options>();
    auto* command =
        app.add_subcommand("analyse", "margins, bandwidth, stiffness and step response of each axis");
    command->add_option("--cnc", o->cnc, "the machine (JSON, docs/cnc.md)")->required();
    command->add_option("--axis", o->axis, "this one only");
    command->add_option(
        "--frf", o->frf,
        "a measured frequency response of the axis (CSV: frequency_Hz, magnitude_m_per_V, phase_deg, "
        "docs/howto/analyse_an_axis.md), in place of its drive");
    command->add_option("--chirp", o->chirp,
                        "a log of the axis with a chirp in its reference (CSV, as quadrant-gap reads it): its "
                        "frequency response in place of the drive");
    command->add_option("--write-frf", o->write_frf,
                        "write the response made from --chirp (CSV), as --frf reads it");
    command
        ->add_option("--step", o->step_m,
                     "of the reference, in metres; without: what takes half of the command's limit")
        ->check(CLI::PositiveNumber);
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    auto* json = command->add_option("--json", o->json,
                                     "write the figures and responses (JSON); without a file name: print them");
    json->expected(0, 1);
    command->add_flag("-q,--quiet", o->quiet, "no text, only the files");
    command->set_version_flag("--version", QUADRANT_VERSION);
    command->callback([o, json] {
        if (json->count() > 0 && o->json.empty()) o->json = "-";
        quadrant_cnc::analyse(*o);
    });
}

void add_tune(CLI::App& app) {
    const auto o = std::make_shared<quadrant_cnc::tune_options>();
    auto* command = app.add_subcommand("tune", "gains of the sliding mode law by fuzzy rules, trial by trial");
    command->add_option("--cnc", o->cnc, "the machine (JSON, docs/cnc.md)")->required();
    command->add_option("--axis", o->axis, "this one only");
    command->add_option("--out", o->out, "write the machine with the gains found (JSON)");
    command->add_option("--distance", o->distance_m, "of a trial's stroke, forth and back, in metres")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--speed", o->speed_m_per_s, "of the stroke, in metres per second")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        ->add_option("--threshold", o->threshold_Hz,
                     "above this frequency what is in the command counts as oscillation, in hertz")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--trials", o->trials, "at most so many")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    auto* json =
        command->add_option("--json", o->json, "write the trials (JSON); without a file name: print them");
    json->expected(0, 1);
    command->add_flag("-q,--quiet", o->quiet, "no text, only the files");
    command->set_version_flag("--version", QUADRANT_VERSION);
    command->callback([o, json] {
        if (json->count() > 0 && o->json.empty()) o->json = "-";
        quadrant_cnc::tune(*o);
    });
}

constexpr int bad_input_code = 2;

int run_program(int argc, char** argv) {
    CLI::App app{
        "A virtual CNC: its axes analysed and tuned, and a part program driven through them, with tracking "
        "and contour errors.",
        "quadrant-cnc"};
    app.set_version_flag("--version", QUADRANT_VERSION);
    app.require_subcommand(1);
    app.footer("Exit code: 0 when what was asked for is written, 1 when standard output fails, 2 on bad "
               "input (one line says where).");
    add_run(app);
    add_analyse(app);
    add_tune(app);
    try {
        app.parse(argc, argv);
        return quadrant_page::ended(0, "quadrant-cnc");
    } catch (const CLI::ParseError& e) {
        return quadrant_page::ended(quadrant_page::said(app, e, argc, argv, bad_input_code), "quadrant-cnc");
    }
}

} // namespace

int main(int argc, char** argv) {
    quadrant_page::end_without_memory("quadrant-cnc");
    return quadrant_page::guarded("quadrant-cnc", bad_input_code, [&] { return run_program(argc, argv); });
}
