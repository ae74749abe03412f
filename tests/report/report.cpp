// SPDX-License-Identifier: BSL-1.0
// Long: one page: a case for each thing that it says or draws.
#include "quadrant_gap/report.hpp"

#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "quadrant_gap/summary.hpp"
#include "sample_result.hpp"

using namespace quadrant_gap;

namespace {
bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

std::size_t count(const std::string& text, std::string_view part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
    return n;
}

nlohmann::json charts_of(const std::string& html) {
    const std::string_view open = "<script type=\"application/json\" id=\"charts\">";
    const std::size_t from = html.find(open) + open.size();
    return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}
} // namespace

TEST_CASE("words: a number has the digits that its interval leaves, and the unit that is read") {
    CHECK(interval({20.36, 19.94, 20.77}, "N") == "20.4 N (19.9 to 20.8)");
    CHECK(interval({2.5e-6, 2.41e-6, 2.59e-6}, "m") == "2.50 µm (2.41 to 2.59)");
    CHECK(interval({0.0004, 0.0004, 0.0004}, "s") == "0.40 ms");
    CHECK(interval({-0.01, -4, 4}, "") == "0 (-4 to 4)");
    CHECK(quantity(0, "m") == "0 m");
    CHECK(quantity(0.0032, "m/s") == "3.2 mm/s");
    CHECK(quantity(12340, "N") == "12.3 kN");
    CHECK(change(81e-6, 6.3e-6, "m") == "81.0 → 6.3 µm");
    CHECK(quantity_beside(0.078, 0.0438, "N m") == "0.044 N m"); // not 43.8 mN m beside 0.078 N m
    CHECK(quantity_beside(3.2, 0.0031, "N") == "3.1 mN");
    CHECK(percent(estimate{0.81, 0.79, 0.83}) == "81 % (79 to 83)");
    CHECK(shrinkage(estimate{0.81, 0.79, 0.83}) == "shrinks by 81 % (79 to 83)");
    CHECK(shrinkage(estimate{-0.46, -0.5, -0.4}) == "grows by 46 %");
    CHECK(shrinkage(estimate{-14614105, 0, 0}) == "grows to 1.46e+07 times");
    CHECK(probability(0.9999) == "> 99 %");
    CHECK(lines_of(parameter_estimate{"stribeck_velocity_m_per_s", {{0.0022, 0.0022, 0.0022}}})[0] ==
          "Stribeck velocity: 2.2 mm/s");
    CHECK(lines_of(parameter_estimate{"static_N", {{3, 3, 3}}})[0] == "static friction: 3.0 N");
    CHECK(lines_of(parameter_estimate{"coulomb_N", {{3, 3, 3}}})[0] == "Coulomb friction: 3.0 N");
    CHECK(lines_of(parameter_estimate{"cogging_N", {{3, 3, 3}, {1, 1, 1}}}) ==
          std::vector<std::string>{"cogging 1: 3.0 N", "cogging 2: 1.0 N"});
    CHECK(lines_of(parameter_estimate{"cogging_phase_rad", {{1, 1, 1}}})[0] == "cogging phase: 57.3 deg");
    CHECK(lines_of(parameter_estimate{"backlash_rad", {{2e-5, 2e-5, 2e-5}}})[0] == "backlash: 20.0 µrad");
    CHECK(lines_of(parameter_estimate{"viscous_Nm_s_per_rad", {{2, 2, 2}}})[0] ==
          "viscous friction: 2.0 N m s/rad");
    CHECK(lines_of(parameter_estimate{"velocity_gain_V_s_per_rad", {{2, 2, 2}}},
                   {axis_kind::rotary, "Nm"})[0] == "velocity gain: 2.0 N m s/rad");
    CHECK(lines_of(parameter_estimate{"viscous_asymmetry", {{0.1, 0.08, 0.12}}})[0] ==
          "viscous asymmetry: 10 % (8 to 12)");
}

TEST_CASE("verdict sentence: names the effects, the axis and the gap before, after and at the floor") {
    diagnosis_result d = sample::explained();
    CHECK(verdict_sentence(d) ==
          "Coulomb friction and constant force are missing from the simulation of axis x: with them, the "
          "force gap shrinks from 20.7 N to 2.4 N (floor 0.90 N).");
    SUBCASE("one missing, one not as described") {
        d.causes.resize(2);
        d.causes[1].effect = "mass";
        d.causes[1].described = true;
        CHECK(has(verdict_sentence(d),
                  "Coulomb friction is missing from the simulation of axis x, and the moving "
                  "mass is not as the machine file says: with them,"));
    }
    SUBCASE("one cause that the machine file describes") {
        d.causes.resize(1);
        d.causes[0].effect = "mass";
        d.causes[0].described = true;
        CHECK(has(verdict_sentence(d), "The moving mass of axis x is not as the machine file says: with it,"));
    }
    SUBCASE("a record that cannot tell two names apart claims neither") {
        d.causes = {d.causes[1]};
        d.causes[0].probability = 0.45;
        CHECK(has(verdict_sentence(d), "Constant force or friction that differs by direction is"));
    }
    SUBCASE("a suspect is not a claim") {
        CHECK(has(verdict_sentence(sample::unexplained()),
                  "the nearest suspect is cutting force (probability 22 %)"));
    }
    SUBCASE("a suspect that takes most of the gap is not hidden behind \"no known effect\"") {
        d = sample::unexplained();
        d.causes[0].shrink.value = 0.89;
        CHECK(has(verdict_sentence(d), "No known effect surely explains the gap of axis "));
        CHECK(has(verdict_sentence(d),
                  "; with the nearest suspect, cutting force (probability 22 %), it shrinks by 89 %."));
    }
    SUBCASE("a cause that is claimed is said although it explains little of the gap") {
        d.verdict = d.axes[0].verdict = verdict::unexplained;
        CHECK(has(verdict_sentence(d),
                  "Coulomb friction and constant force are missing from the simulation of axis x:"));
        CHECK(has(verdict_sentence(d), "but most of the gap stays unexplained."));
        CHECK_FALSE(has(verdict_sentence(d), "No known effect"));
    }
    SUBCASE("what calibration takes off does not remain") {
        d = sample::unexplained();
        d.causes.clear();
        d.axes[0].gap.force_rms_N = d.axes[0].gap_after.force_rms_N = 239;
        CHECK(has(verdict_sentence(d), "No known effect explains the gap of axis x: 239 N of force where"));
        d.axes[0].gap_after.force_rms_N = 2.3;
        CHECK(
            has(verdict_sentence(d), "what calibration leaves of the gap of axis x: 2.3 N of 239 N of force"));
    }
    SUBCASE("no gap") {
        CHECK(has(verdict_sentence(sample::no_gap()), "Simulation and machine agree on axis x"));
    }
    SUBCASE("an effect that this program does not know keeps its name") {
        d.causes.resize(1);
        d.causes[0].effect = "ball_screw_wear";
        CHECK(has(verdict_sentence(d), "Ball screw wear is missing"));
    }
}

TEST_CASE("report: says the verdict, the causes with their intervals, the alternatives and the next motion") {
    const std::string html = html_report(sample::explained());
    for (const char* part :
         {"Coulomb friction and constant force", ">explained</span>", "20.4 N (19.9 to 20.8)",
          "cannot be distinguished from friction that differs by direction", "Coulomb asymmetry",
          "20.7 → 3.9 N", "81 % (79 to 83)", "mechanics (95 % of the gap)", "Reverse slowly ten times",
          "odds of 66.7 to 1", "<p>Simulated beforehand.</p>", "emps_run2.csv", "5 % is assumed", "MIT licence",
          "Dan Vanderkam"})
        CHECK_MESSAGE((has(html, part) || has(html, escape(part))), part);
    CHECK(count(html, "data-effect=") == 3);
    CHECK(count(html, "class=\"box guilty\" data-box=\"mechanics\"") == 1);
    CHECK(count(html, "class=\"mark\"") == 1);
    CHECK(has(html, "The gap sits in mechanics (95"));
    CHECK(has(html, "a laser interferometer along the travel"));
    CHECK_FALSE(has(html_report(sample::unexplained()), "id=\"unseen\""));
    CHECK(count(html, "at the end of what was searched, it may lie beyond") == 1);
    CHECK(count(html, "class=\"bar range\"") == 8); // five values, no phase, and three shrinks
    CHECK(charts_of(html).size() == 6);
}

TEST_CASE("report: a rotary axis is in radians and newton metres, from the verdict to the charts") {
    diagnosis_result d = sample::explained();
    d.axes[0].kind = axis_kind::rotary;
    d.axes[0].command_unit = "Nm";
    d.causes[0].parameters[0].key = "coulomb_Nm";
    const std::string html = html_report(d), text = summary(d);
    CHECK(has(verdict_sentence(d),
              "constant torque are missing from the simulation of axis x: with them, the torque "
              "gap shrinks from 20.7 N m to 2.4 N m (floor 0.90 N m)"));
    CHECK_FALSE(has(verdict_sentence(d), "force"));
    CHECK(has(html, escape(verdict_sentence(d))));
    CHECK(has(html, escape("20.4 N m (19.9 to 20.8)")));
    CHECK(has(html, ">Constant torque<"));
    CHECK(has(text, "20.4 N m (19.9 to 20.8)"));
    CHECK(has(text, "torque gap 20.7 → 3.9 N m"));
    CHECK(has(text, "torque, rms"));
    CHECK(has(text, "81.0 µrad"));
    const auto charts = charts_of(html);
    CHECK(charts[0]["y"] == "torque [N m]");
    CHECK(charts[1]["y"] == "position [µrad]");
    CHECK(charts[2]["y"] == "command [N m]");
    CHECK(charts[3]["x"] == "velocity [mrad/s]");
    CHECK(charts[5]["y"] == "torque [N m/√Hz]");
    CHECK_FALSE(has(html, "Residual force"));
}

TEST_CASE("report: the charts over velocity and position know when their samples were") {
    const auto charts = charts_of(html_report(sample::explained()));
    for (const std::size_t k : {3U, 4U}) {
        const auto t = charts[k]["times"].get<std::vector<double>>();
        CHECK(t.size() == charts[k]["columns"][0].size());
        CHECK(std::is_sorted(t.begin(), t.end()));
        CHECK(t.back() > 23.9);
    }
    CHECK(charts[0]["times"].is_null());
}

TEST_CASE("report: every axis has its charts; what cannot be drawn says why") {
    const std::string html = html_report(sample::unexplained());
    CHECK(charts_of(html).size() == 10); // no position error for either axis
    CHECK(count(html, "Not drawn: the machine file has no controller") == 2);
    CHECK(count(html, "Servo loop of axis x") == 2); // label and title
    CHECK(count(html, "Servo loop of axis y") == 2);
}

TEST_CASE("report: an empty result and an axis without signals are reports too") {
    diagnosis_result d;
    CHECK(charts_of(html_report(d)).empty());
    d.axes.resize(1);
    CHECK(charts_of(html_report(d)).empty());
    CHECK(count(html_report(d), "Not drawn") == 6);
}

TEST_CASE("report: what is not finite is a gap in the line") {
    diagnosis_result d = sample::no_gap();
    d.axes[0].signals.residual_before.resize(2);
    d.axes[0].signals.t = {0, 1};
    d.axes[0].signals.residual_before[1] = NAN;
    CHECK(charts_of(html_report(d))[0]["columns"][1][1].is_null());
}

TEST_CASE("report: a peak of one sample survives the drawing of few") {
    diagnosis_result d = sample::no_gap();
    d.axes[0].signals.residual_before[12345] = 777;
    const auto forces = charts_of(html_report(d))[0]["columns"][1].get<std::vector<double>>();
    CHECK(forces.size() <= 4000);
    CHECK(*std::max_element(forces.begin(), forces.end()) == 777);
}

TEST_CASE("report: names from files cannot become markup") {
    const std::string html = html_report(sample::hostile());
    CHECK(count(html, "<script") == 3);
    CHECK(count(html, "</script") == 3);
    CHECK_FALSE(has(html, "<img"));
    CHECK(has(html, "&lt;/script&gt;&lt;script&gt;alert(&#39;1&#39;)"));
}

TEST_CASE("report: loads nothing") {
    const std::string html = html_report(sample::explained());
    for (const char* part : {" src=", " href=", "url(h", "url(/", "@import", "sourceMappingURL"})
        CHECK_FALSE_MESSAGE(has(html, part), part);
    CHECK(has(html, "default-src 'none'"));
}

TEST_CASE("report: below 1 MB for one axis, below 3 MB for eight; the same bytes twice") {
    diagnosis_result d = sample::explained();
    CHECK(html_report(d).size() < 1'000'000);
    CHECK(html_report(d) == html_report(d));
    d.axes.resize(8, d.axes[0]);
    CHECK(html_report(d).size() < 3'000'000);
}

TEST_CASE("summary: lines of at most 100 columns, no control characters, whatever the names") {
    for (const diagnosis_result& d : {sample::explained(), sample::no_gap(), sample::unexplained(),
                                      sample::hostile(), diagnosis_result{}}) {
        std::istringstream text(summary(d));
        for (std::string line; std::getline(text, line);) {
            CHECK_MESSAGE(columns(line) <= 100, line);
            CHECK_FALSE(has(line, "\x1b"));
        }
    }
}

TEST_CASE("summary: says what the report says") {
    const std::string text = summary(sample::explained());
    for (const char* part :
         {"Explained: emps_run1.csv", "Coulomb friction, axis x: probability > 99 %",
          "Coulomb friction: 20.4 N", "95 % (93 to 97)", "a suspect, not a claim", "Next experiment", "Note: "})
        CHECK_MESSAGE(has(text, part), part);
}

TEST_CASE("loop picture: one box a row from the command to the mechanics, a drive and a transmission where the "
          "axis has them") {
    axis_result a = sample::explained().axes.at(0);
    const auto boxes = [](const std::string& svg) { return count(svg, "<g class=\"box"); };
    const std::string plain = loop(a);
    CHECK(boxes(plain) == 5);
    CHECK_FALSE(has(plain, "data-box=\"transmission\""));
    a.where.push_back(
        {"readings", "transmission", "lost motion takes this share off", {0.99, 0.99, 0.99}, "causes"});
    const std::string two = loop(a);
    CHECK(boxes(two) == 6);
    CHECK(has(two, "transmission (99 % of the difference of the two readings)"));
    a.driven = true;
    CHECK(boxes(loop(a)) == 7);
}
