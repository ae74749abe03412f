// SPDX-License-Identifier: BSL-1.0
// The list of what the sources print: how it counts, and that it is whole.
#include "quadrant_reproduce/markdown.hpp"

#include <doctest/doctest.h>

using namespace quadrant_reproduce;

namespace {
row row_of(const std::string& id, const std::string& quantity, std::optional<double> ours) {
    return {id, quantity, "um", ours, {}, {}, {}, ""};
}
std::vector<section> one_section(std::vector<row> rows) { return {section{{}, std::move(rows), {}}}; }
printed number_of(reading how, double scale = 1) {
    printed p{"s", "Table 1", "a", "50", "%", origin::measured};
    p.id = "a", p.quantity = "on", p.scale = scale, p.how = how;
    return p;
}
} // namespace

TEST_CASE("published: ours in the unit of the source, as reduction, rise, difference and deviation") {
    const auto all = one_section({row_of("a", "on", 3), row_of("a", "off", 4)});
    const row_index rows(all);
    CHECK(*rows.ours(number_of(reading::value, 1000)) == doctest::Approx(0.003));
    printed p = number_of(reading::reduction);
    p.base_id = "a", p.base_quantity = "off";
    CHECK(*rows.ours(p) == doctest::Approx(25));
    p.how = reading::rise;
    CHECK(*rows.ours(p) == doctest::Approx(-1));
    p = number_of(reading::deviation);
    p.base = 2;
    CHECK(*rows.ours(p) == doctest::Approx(50));
    p.how = reading::difference;
    CHECK(*rows.ours(p) == doctest::Approx(1));
    p.base_id = "a", p.base_quantity = "never computed";
    CHECK_FALSE(rows.ours(p));
}
TEST_CASE("published: a number counts once in its distance; what is printed as 0 has none, what was not "
          "computed is missing") {
    const auto all = one_section(
        {row_of("a", "on", 50.9), row_of("b", "on", 54), row_of("c", "on", 80), row_of("d", "on", 1)});
    const row_index rows(all);
    printed_list list;
    for (const char* id : {"a", "a", "b", "c", "never"}) {
        list.push_back(number_of(reading::value));
        list.back().id = id;
    }
    list.push_back(number_of(reading::value));
    list.back().id = "d", list.back().text = "0";
    const publication found(list, rows);
    CHECK(found.repeated == 1);
    CHECK(found.measured.all == 4);
    CHECK(found.measured.up_to(0) == 1);
    CHECK(found.measured.up_to(1) == 2);
    CHECK(found.measured.within[3] == 1);
    CHECK(found.measured.zero == 1);
    CHECK(found.measured.missing == 1);
}
TEST_CASE("published: the columns of a row are the first printing, and never overwrite what an experiment "
          "gives itself") {
    auto all = one_section({row_of("a", "on", 1), row_of("b", "on", 1)});
    all[0].rows[1].published_measured = 7;
    printed_list list{number_of(reading::value), number_of(reading::value), number_of(reading::value)};
    list[1].text = "51", list[2].id = "b";
    fill(all, list);
    CHECK(all[0].rows[0].published_measured == 50);
    CHECK(all[0].rows[1].published_measured == 7);
    CHECK_FALSE(all[0].rows[0].published_simulated);
}
