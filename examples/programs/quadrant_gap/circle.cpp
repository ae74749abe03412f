// SPDX-License-Identifier: BSL-1.0
// quadrant-gap circle: circles of two axes, from servo logs or from a ball-bar, diagnosed as a ball-bar would.
#include "circle/page.hpp"
#include "commands.hpp"

#include <quadrant/diagnosis/circle/ball_bar.hpp>
#include <quadrant/diagnosis/circle/find_circles.hpp>
#include <quadrant/diagnosis/circle/read_radius.hpp>
#include <quadrant/diagnosis/circle/write_circle.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/text/text.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <memory>
#include <sstream>

namespace quadrant_gap {

namespace {

struct circle_command {
    std::vector<std::string> logs;
    std::string machine, json, report;
    double shortest_mm = 0;
    terminal say;
};

void run(const circle_command& o) {
    quadrant_page::end_without_memory("quadrant-gap");
    outputs files;
    for (const auto& log : o.logs) files.reads("--log", log);
    files.reads("--machine", o.machine).writes("--json", o.json).writes("--report", o.report);
    circle_options options;
    options.shortest_period = 1e-3 * o.shortest_mm;
    if (!o.machine.empty())
        options.excluded_effects = read_machine(std::filesystem::path(o.machine)).excluded_effects;
    std::vector<circle_run> runs;
    for (std::size_t k = 0; k < o.logs.size(); ++k) {
        const std::string text = quadrant::diagnosis::detail::read_whole(std::filesystem::path(o.logs[k]));
        std::vector<circle_run> more;
        if (is_radius_file(text)) {
            more = read_radius(text, o.logs[k], k);
        } else {
            std::istringstream in(text);
            const auto log = read_log(in, o.logs[k]);
            const auto [first, second] = circle_axes(log);
            const std::array<std::string, 2> names{first->name, second->name};
            if (k > 0 && names != options.axes)
                throw bad_input(o.logs[k], fmt::format("moves axes {} and {}, the logs before it {} and {}",
                                                       names[0], names[1], options.axes[0], options.axes[1]));
            options.axes = names;
            more = find_circles(log, k);
        }
        std::move(more.begin(), more.end(), std::back_inserter(runs));
    }
    const auto result = ball_bar(std::move(runs), options);
    if (!o.json.empty())
        write_output(o.json,
                     to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.report.empty()) write_output(o.report, circle::page(result));
    if (!o.say.quiet) std::fputs(circle::summary(result, o.say.verbose).c_str(), files.words());
}

} // namespace

void add_circle(CLI::App& app) {
    const auto o = std::make_shared<circle_command>();
    auto* command = app.add_subcommand("circle", "circles of two axes, diagnosed as a ball-bar would");
    command
        ->add_option("--log", o->logs,
                     "servo log (CSV) with circles, or the radius file of an instrument; several")
        ->required();
    command->add_option("--machine", o->machine, "machine file (JSON): its excluded effects are not blamed");
    command
        ->add_option("--shortest-period", o->shortest_mm,
                     "of a cyclic error that is sought, in mm; default a hundredth of the largest radius")
        ->check(CLI::PositiveNumber);
    command->add_option("--json", o->json, "write the errors (JSON)");
    command->add_option("--report", o->report, "write the report (one HTML file, opens without a network)");
    add_terminal_options(*command, o->say, "also what each error means and which instrument sees the others");
    command->callback([o] { run(*o); });
}

} // namespace quadrant_gap
