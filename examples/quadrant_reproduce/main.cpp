// SPDX-License-Identifier: BSL-1.0
// quadrant-reproduce: published experiments computed again, and their figures beside ours.
#include "choose.hpp"
#include "experiments.hpp"
#include "markdown.hpp"
#include "page.hpp"

#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace {

namespace qr = quadrant_reproduce;
using quadrant::diagnosis::write_aside;

constexpr int bad_input_code = 2;

struct options {
    std::vector<std::string> ids;
    std::string json, html = "quadrant_reproduction.html", markdown;
    bool list = false, quiet = false;
};

nlohmann::ordered_json to_json(const std::vector<qr::section>& all) {
    const auto value = [](const std::optional<double>& v) {
        return v ? nlohmann::ordered_json(*v) : nlohmann::ordered_json();
    };
    auto rows = nlohmann::ordered_json::array();
    for (const qr::section& s : all)
        for (const qr::row& r : s.rows)
            rows.push_back(
                {{"id", r.id},
                 {"quantity", r.quantity},
                 {"unit", r.unit},
                 {"simulated", value(r.simulated)},
                 {"published_simulated", value(r.published_simulated)},
                 {"published_measured", value(r.published_measured)},
                 {"reference_computation", value(r.reference_computation)},
                 {"note", r.note.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(r.note)}});
    return rows;
}

void print_summary(const std::vector<qr::section>& all) {
    for (const qr::section& s : all) {
        const qr::tally t = qr::count(s.rows, s.what.tolerance);
        fmt::print("{}: {} figures", s.what.title, s.rows.size());
        if (t.compared > 0)
            fmt::print(", {} of {} within {:g} % of the reference computation", t.within, t.compared,
                       100 * s.what.tolerance);
        fmt::print("\n");
        for (const qr::row* r : t.outside)
            fmt::print("  outside: {} {}: {} {} instead of {}\n", r->id, r->quantity, qr::number(r->simulated),
                       r->unit, qr::compared(*r, r->reference_computation));
        for (const qr::row& r : s.rows)
            if (!r.simulated) fmt::print("  no figure: {} {}: {}\n", r.id, r.quantity, r.note);
    }
}

int reproduce(const options& o, bool wants_page) {
    const bool shown = !o.quiet && isatty(STDERR_FILENO);
    const auto say = [&](const std::string& text) {
        if (shown) fmt::print(stderr, "\r\033[K{:.78}", text);
    };
    const auto chosen = qr::choose(qr::experiments(), o.ids);
    if (o.list) {
        for (const qr::experiment& e : chosen)
            for (const qr::run_case& c : e.cases) fmt::print("{:28} {}\n", c.id, e.title);
        return 0;
    }
    const auto all = qr::run_all(chosen, [&](const std::string& id, std::size_t done, std::size_t of) {
        say(fmt::format("{} of {}: {}", done, of, id));
    });
    if (!o.json.empty())
        write_aside(o.json, to_json(all).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.markdown.empty()) write_aside(o.markdown, qr::markdown(all));
    if (wants_page) {
        const bool can_draw = quadrant_page::gnuplot_is_here();
        write_aside(o.html, qr::page(all, can_draw, [&](std::size_t done, std::size_t of) {
                        say(fmt::format("picture {} of {}", done, of));
                    }));
        say("");
        if (!can_draw)
            fmt::print(stderr,
                       "quadrant-reproduce: no gnuplot, so the page has its tables but no pictures (Debian "
                       "package {})\n",
                       quadrant_page::gnuplot_package);
    }
    say("");
    if (!o.quiet) {
        print_summary(all);
        if (wants_page) fmt::print("Page: {}\n", o.html);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"The milling table of [Jamaludin2008]: its experiments computed again, our figures beside the "
                 "published ones.\n"
                 "Without options it runs all of them and writes one HTML page with pictures.",
                 "quadrant-reproduce"};
    app.set_version_flag("--version", QUADRANT_VERSION);
    options o;
    app.add_flag("--list", o.list, "the experiments' ids, and stop");
    app.add_option("--id", o.ids,
                   "run this one only: an id, its beginning, or a glob such as '*.y.*'; may be given again")
        ->take_all();
    app.add_option("--json", o.json, "write the rows (JSON), all digits");
    auto* page =
        app.add_option("--html", o.html,
                       "write the page (one HTML file, opens without a network); without it the page is "
                       "written when neither --json nor --markdown is given")
            ->capture_default_str();
    app.add_option("--markdown", o.markdown, "write the tables as text; docs/reproduction.md is made so");
    app.add_flag("--quiet", o.quiet, "no text, only the files");
    try {
        app.parse(argc, argv);
        return reproduce(o, page->count() > 0 || (o.json.empty() && o.markdown.empty()));
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : bad_input_code;
    } catch (const std::exception& e) { // unknown_id, bad_input, or what this computer refuses
        fmt::print(stderr, "quadrant-reproduce: {}\n", e.what());
    }
    return bad_input_code;
}
