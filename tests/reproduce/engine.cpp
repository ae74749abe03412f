// SPDX-License-Identifier: BSL-1.0
#include "page/svg.hpp"
#include "quadrant_reproduce/choose.hpp"
#include "quadrant_reproduce/experiment/friction.hpp"
#include "quadrant_reproduce/markdown.hpp"

#include <doctest/doctest.h>

#include <thread> // run_all starts some: so tests/run.sh takes this folder to the thread sanitizer

using namespace quadrant_page;
using namespace quadrant_reproduce;

namespace {
run_case case_of(const std::string& id, std::optional<double> simulated, std::optional<double> reference = {}) {
    return {
        id, [=] {
            return outcome{
                {{id, "value", "um", simulated, {}, {}, reference, ""}},
                {{"shared",
                  "",
                  {panel{.x_label = "", .y_label = "", .lines = {{.name = id, .x = {0, 1}, .y = {1, 2}}}}}}}};
        }};
}
const auto deaf = [](const std::string&, std::size_t, std::size_t) {};
} // namespace

TEST_CASE("reproduce: cases keep their order and draw into one picture, whichever thread was first") {
    experiment e{"", "", "", 0.1, {}};
    for (int k = 0; k < 40; ++k) e.cases.push_back(case_of("case" + std::to_string(k), k));
    std::size_t told = 0;
    const auto all = run_all({e}, [&](const std::string&, std::size_t done, std::size_t of) {
        CHECK(done == ++told);
        CHECK(of == 40);
    });
    CHECK(told == 40);
    REQUIRE(all.size() == 1);
    REQUIRE(all[0].rows.size() == 40);
    REQUIRE(all[0].pictures.size() == 1);
    REQUIRE(all[0].pictures[0].panels[0].lines.size() == 40);
    for (int k = 0; k < 40; ++k) {
        CHECK(all[0].rows[std::size_t(k)].simulated == k);
        CHECK(all[0].pictures[0].panels[0].lines[std::size_t(k)].name == "case" + std::to_string(k));
    }
}
TEST_CASE("reproduce: what is not finite, and what throws, leaves a row without a figure that says so") {
    experiment e{"",
                 "",
                 "",
                 0.1,
                 {case_of("nan", std::nan("")),
                  case_of("inf", HUGE_VAL, 1.0),
                  {"throws", []() -> outcome { throw std::runtime_error("no such thing"); }}}};
    const auto rows = run_all({e}, deaf)[0].rows;
    REQUIRE(rows.size() == 3);
    for (const row& r : rows) {
        CHECK_FALSE(r.simulated);
        CHECK_FALSE(r.note.empty());
    }
    CHECK(rows[2].note == "no such thing");
    const tally t = count(rows, 0.1); // no figure is not within
    CHECK(t.compared == 1);
    CHECK(t.within == 0);
    CHECK(t.outside.size() == 1);
}
TEST_CASE("reproduce: an axis that diverges is a row without a figure, and never a picture") {
    thesis::axis wild = thesis::x;
    wild.kp = 20.0 * wild.kp;
    const auto found =
        friction_case<thesis::no_friction_model, thesis::no_observer>(wild, "wild", "none", {21.8, 16.8}, 1.5);
    REQUIRE(found.rows.size() == 2);
    for (const row& r : found.rows) {
        CHECK_FALSE(r.simulated);
        CHECK(r.note.find("diverged") == 0);
    }
    CHECK(found.pictures.empty());
}
TEST_CASE("reproduce: the tolerance is met on the line, and not beyond") {
    const auto at = [](double ours) { return row{"", "", "", ours, {}, {}, 100.0, ""}; };
    CHECK(count({at(102), at(98)}, 0.02 + 1e-12).within == 2);
    CHECK(count({at(102.1), at(97.9)}, 0.02).within == 0);
    CHECK(compared(at(97.95), 100.0) == "100 (-2.0 %)");
    CHECK(compared(at(99.99), 100.0) == "100 (+0.0 %)");
    CHECK(compared(at(150), 100.0) == "100 (+50 %)");
    CHECK(compared(at(1), {}) == "-");
}
TEST_CASE("reproduce: four digits that count") {
    CHECK(number(15.557) == "15.56");
    CHECK(number(0.062967) == "0.06297");
    CHECK(number(271.56) == "271.6");
    CHECK(number(2048.0) == "2048");
    CHECK(number(1234567.0) == "1.235e+06");
    CHECK(number({}) == "-");
}
TEST_CASE("reproduce: an id, what lies below it, its beginning, a glob, in this order") {
    const std::vector<std::string> ids{"a.loop.x", "a.loop.y", "a.loop_dob.x", "a.circle.dob",
                                       "a.circle.dob_gms"};
    CHECK(named_by("a.circle.dob", ids) == std::vector<std::string>{"a.circle.dob"});
    CHECK(named_by("a.loop", ids) == std::vector<std::string>{"a.loop.x", "a.loop.y"});
    CHECK(named_by("a.lo", ids).size() == 3);
    CHECK(named_by("*.x", ids) == std::vector<std::string>{"a.loop.x", "a.loop_dob.x"});
    CHECK(named_by("", ids).empty());
    CHECK(named_by("b", ids).empty());
    experiment one{"", "", "", 0.1, {case_of("a.x", 1), case_of("a.y", 2)}},
        two{"", "", "", 0.1, {case_of("b.x", 3)}};
    const auto chosen = choose({one, two}, {"a.y"});
    REQUIRE(chosen.size() == 1);
    REQUIRE(chosen[0].cases.size() == 1);
    CHECK(chosen[0].cases[0].id == "a.y");
    CHECK(choose({one, two}, {}).size() == 2);
    CHECK_THROWS_WITH_AS(choose({one, two}, {"b.z"}),
                         "no experiment is called \"b.z\"; the nearest is b.x (--list shows all)", unknown_id);
}
TEST_CASE("reproduce: thinning keeps the ends' neighbourhood and every peak") {
    std::vector<double> y(100000);
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::sin(0.001 * double(k));
    y[54321] = 7, y[12345] = -9;
    const auto keep = peaks(y);
    CHECK(keep.size() <= 1200);
    CHECK(std::is_sorted(keep.begin(), keep.end()));
    CHECK(std::count(keep.begin(), keep.end(), std::size_t{54321}) == 1);
    CHECK(std::count(keep.begin(), keep.end(), std::size_t{12345}) == 1);
    const std::vector<double> few{3, 1, 2};
    CHECK(peaks(few) == std::vector<std::size_t>{0, 1, 2});
}
TEST_CASE(
    "reproduce: pictures take their colours from the page, their ids are their own, and apostrophes are text" *
    doctest::skip(!gnuplot_is_here())) {
    const picture p{
        "",
        "",
        {panel{
            .x_label = "the axis' time [s]",
            .y_label = "error [um]",
            .lines = {{.name = "a_b", .x = {1, 2, 3}, .y = {1, std::nan(""), 3}, .drawn = line::style::points},
                      {.name = "c", .x = {1, 2}, .y = {2, 2}}}}}};
    const char* const was = std::getenv("TMPDIR");
    const std::string before = was ? was : "/tmp", odd = before + "/quadrant's own";
    std::filesystem::create_directories(odd);
    setenv("TMPDIR", odd.c_str(), 1);
    const std::string drawn = svg(p, 7, "label");
    setenv("TMPDIR", before.c_str(), 1);
    std::filesystem::remove_all(odd);
    CHECK(drawn.starts_with("<svg viewBox=\"0 0 480 300\" role=\"img\" aria-label=\"label\">"));
    for (const char* const has : {"var(--line-1)", "var(--line-2)", "var(--ink)", "var(--grid)", "error [µm]",
                                  "a_b", "the axis' time", "p7canvas"})
        CHECK_MESSAGE(drawn.find(has) != std::string::npos, has);
    for (const char* const has_not : {"rgb(", "black", "gpPt", "gnuplot_", "<?xml", "<title>"})
        CHECK_MESSAGE(drawn.find(has_not) == std::string::npos, has_not);
}
