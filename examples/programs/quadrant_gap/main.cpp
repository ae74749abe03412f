// SPDX-License-Identifier: BSL-1.0
// quadrant-gap: why does the machine not do what its simulation says?
#include "../page/nearest_option.hpp"
#include "commands.hpp"

namespace {

constexpr int bad_input_code = 2;

int run_program(int argc, char** argv) {
    CLI::App app{"Why does the machine not do what its simulation says?", "quadrant-gap"};
    app.set_version_flag("--version", QUADRANT_VERSION);
    app.require_subcommand(1);
    app.footer("Output files: \"-\" is standard output, words then go to standard error. An output that is "
               "also an input is\n"
               "refused.\n"
               "Exit code: 0 when what was asked for is written, 1 when standard output fails, 2 on bad input "
               "(one line\n"
               "says where).");
    quadrant_gap::add_diagnose(app);
    quadrant_gap::add_apply(app);
    quadrant_gap::add_simulate(app);
    quadrant_gap::add_forecast(app);
    quadrant_gap::add_compensate(app);
    quadrant_gap::add_compare(app);
    quadrant_gap::add_export(app);
    quadrant_gap::add_init(app);
    quadrant_gap::add_import(app);
    quadrant_gap::add_trial(app);
    quadrant_gap::add_circle(app);
    quadrant_gap::add_fleet(app);
    try {
        app.parse(argc, argv);
        return quadrant_page::ended(0, "quadrant-gap");
    } catch (const CLI::ParseError& e) {
        return quadrant_page::ended(quadrant_page::said(app, e, argc, argv, bad_input_code), "quadrant-gap");
    }
}

} // namespace

int main(int argc, char** argv) {
    return quadrant_page::guarded("quadrant-gap", bad_input_code, [&] { return run_program(argc, argv); });
}
