// SPDX-License-Identifier: BSL-1.0
// quadrant-reproduce: published experiments computed again, and their figures beside ours.
#include "../page/nearest_option.hpp"
#include "../page/outputs.hpp"
#include "../page/progress.hpp"
#include "choose.hpp"
#include "experiments.hpp"
#include "markdown.hpp"
#include "page.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace {

namespace qr = quadrant_reproduce;
using quadrant_page::write_output;

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

void print_summary(const std::vector<qr::section>& all, std::FILE* out) {
    for (const qr::section& s : all) {
        const qr::tally t = qr::count(s.rows, s.what.tolerance);
        fmt::print(out, "{}: {} figures; published, simulated: {} within 10 %; measured: {} within 25 %\n",
                   s.what.title, s.rows.size(), qr::near_words(s.rows, &qr::row::published_simulated, 0.10),
                   qr::near_words(s.rows, &qr::row::published_measured, 0.25));
        for (const qr::row* r : t.outside)
            fmt::print(out, "  outside of the reference: {} {}: {} {} instead of {}\n", r->id, r->quantity,
                       qr::number(r->simulated), r->unit, qr::compared(*r, r->reference_computation));
        for (const qr::row& r : s.rows)
            if (!r.simulated) fmt::print(out, "  no figure: {} {}: {}\n", r.id, r.quantity, r.note);
    }
    const qr::publication found(qr::printed_numbers(), qr::row_index(all));
    fmt::print(out, "Published, simulated: {}\nPublished, measured: {}\n", found.simulated.words(),
               found.measured.words());
}

int reproduce(const options& o, bool wants_page) {
    quadrant_page::outputs files;
    files.writes("--json", o.json).writes("--markdown", o.markdown);
    if (wants_page) files.writes("--html", o.html);
    quadrant_page::progress_line line(o.quiet);
    const auto chosen = qr::choose(qr::experiments(), o.ids);
    if (o.list) {
        for (const qr::experiment& e : chosen)
            for (const qr::run_case& c : e.cases) fmt::print("{:28} {}\n", c.id, e.title);
        return 0;
    }
    auto all = qr::run_all(
        chosen, [&](const std::string& id, std::size_t done, std::size_t of) { line(done, of, id); });
    qr::fill(all, qr::printed_numbers());
    if (!o.json.empty())
        write_output(o.json, to_json(all).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!o.markdown.empty()) write_output(o.markdown, qr::markdown(all));
    if (wants_page) {
        const bool can_draw = quadrant_page::gnuplot_is_here();
        write_output(o.html, qr::page(all, can_draw, [&](std::size_t done, std::size_t of) {
                         line(fmt::format("picture {} of {}", done, of));
                     }));
        line.clear();
        if (!can_draw)
            fmt::print(stderr,
                       "quadrant-reproduce: no gnuplot, so the page has its tables but no pictures (Debian "
                       "package {})\n",
                       quadrant_page::gnuplot_package);
    }
    line.clear();
    if (!o.quiet) {
        print_summary(all, files.words());
        if (wants_page) fmt::print(files.words(), "Page: {}\n", o.html);
    }
    return 0;
}

int run_program(int argc, char** argv) {
    CLI::App app{
        "The experiments of [Jamaludin2008], [Yeung2006] and [LowKeck2003] computed again, our figures beside "
        "the published ones.\n"
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
        return quadrant_page::ended(reproduce(o, page->count() > 0 || (o.json.empty() && o.markdown.empty())),
                                    "quadrant-reproduce");
    } catch (const CLI::ParseError& e) {
        return quadrant_page::said(app, e, argc, argv, bad_input_code);
    }
}

} // namespace

int main(int argc, char** argv) {
    quadrant_page::end_without_memory("quadrant-reproduce");
    return quadrant_page::guarded("quadrant-reproduce", bad_input_code,
                                  [&] { return run_program(argc, argv); });
}
