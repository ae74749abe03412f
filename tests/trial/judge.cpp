// SPDX-License-Identifier: BSL-1.0
#include "quadrant_gap/trial/tally.hpp"

#include <doctest/doctest.h>

using namespace quadrant_gap::trial;

namespace {

using list =
    std::vector<ordered_json>; // an ordered_json of one in braces is a copy with Clang, an array with GCC

ordered_json effect(const std::string& name, double size = 5,
                    ordered_json parameters = ordered_json::object()) {
    return {{"effect", name}, {"axis", "x"}, {"size", size}, {"parameters", std::move(parameters)}};
}
ordered_json truth(const std::string& kind, const list& effects = {}) {
    return {{"index", 7}, {"kind", kind}, {"effects", effects}};
}
ordered_json cause(const std::string& name, double probability, std::vector<std::string> confusable = {},
                   const std::string& axis = "x") {
    return {{"axis", axis},
            {"effect", name},
            {"probability", probability},
            {"confusable_with", std::move(confusable)},
            {"parameters", ordered_json::object()},
            {"shrink", 0.5}};
}
ordered_json said(const std::string& verdict, const list& causes = {}, const std::string& block = "mechanics") {
    return {{"verdict", verdict},
            {"axes", {{"x", {{"where", {{{"view", "block"}, {"block", block}}}}}}}},
            {"causes", causes}};
}

} // namespace

TEST_CASE("judge: a machine without an effect is right in silence, and blamed by any claim") {
    const auto t = truth("none");
    CHECK(judge(t, said("within_tolerance")).right);
    CHECK(judge(t, said("no_gap")).right);
    CHECK_FALSE(judge(t, said("unexplained")).right);
    CHECK_FALSE(judge(t, said("unexplained")).blamed_falsely);
    const auto suspect = judge(t, said("partly_explained", {cause("mass", 0.4)}));
    CHECK_FALSE(suspect.blamed_falsely);
    const auto blamed = judge(t, said("explained", {cause("mass", 0.5)}));
    CHECK(blamed.blamed_falsely);
    CHECK_FALSE(blamed.right);
    CHECK(blamed.first == "mass");
}

TEST_CASE("judge: a single effect has to be first, explained, and alone among the claims") {
    const auto t = truth("single", {effect("cogging")});
    CHECK(judge(t, said("explained", {cause("cogging", 0.9)})).right);
    CHECK(judge(t, said("explained", {cause("cogging", 0.4)})).right); // as check.py: a suspect in first place
    CHECK_FALSE(judge(t, said("partly_explained", {cause("cogging", 0.9)})).right);
    CHECK_FALSE(judge(t, said("explained", {cause("mass", 0.3), cause("cogging", 0.9)})).right);
    CHECK_FALSE(judge(t, said("explained", {cause("cogging", 0.9), cause("mass", 0.6)})).right);
    CHECK(judge(t, said("explained", {cause("cogging", 0.9), cause("mass", 0.2)})).right);
    CHECK_FALSE(judge(t, said("within_tolerance")).right);
    CHECK_FALSE(judge(t, said("explained", {cause("cogging", 0.9, {}, "y")})).right);
    CHECK(judge(t, said("explained", {cause("cogging", 0.9)})).outcome == found::named);
    CHECK(judge(t, said("unexplained", {cause("mass", 0.9)})).outcome == found::another);
    CHECK(judge(t, said("within_tolerance")).outcome == found::silent);
}

TEST_CASE("judge: the known equivalences count, other relatives do not") {
    CHECK(judge(truth("single", {effect("mass")}), said("explained", {cause("force_constant", 0.8)})).right);
    CHECK(judge(truth("single", {effect("constant_force")}),
                said("explained", {cause("asymmetric_friction", 0.8)}))
              .right);
    CHECK_FALSE(
        judge(truth("single", {effect("time_delay")}), said("explained", {cause("actuator_lag", 0.8)})).right);
}

TEST_CASE("judge: a pair needs both in the first two places") {
    const auto t = truth("pair", {effect("cogging", 5), effect("mass", 2)});
    CHECK(judge(t, said("explained", {cause("mass", 0.9), cause("cogging", 0.9)})).right);
    CHECK_FALSE(judge(t, said("explained", {cause("mass", 0.9)})).right);
    CHECK_FALSE(
        judge(t, said("explained", {cause("mass", 0.9), cause("backlash", 0.1), cause("cogging", 0.9)})).right);
    CHECK_FALSE(
        judge(t, said("explained", {cause("mass", 0.9), cause("cogging", 0.9), cause("backlash", 0.7)})).right);
    CHECK(judge(t, said("explained", {cause("mass", 0.9)})).size == 2);
}

TEST_CASE("judge: what is in no list has to be left without a name") {
    const auto t = truth("unknown", {effect("unknown", 5, {{"unknown", "drag"}})});
    CHECK(judge(t, said("unexplained")).right);
    CHECK(judge(t, said("partly_explained", {cause("mass", 0.3)})).right);
    CHECK_FALSE(judge(t, said("partly_explained", {cause("mass", 0.6)})).right);
    CHECK_FALSE(judge(t, said("within_tolerance")).right);
    CHECK(judge(t, said("unexplained")).truth == "drag");
}

TEST_CASE("judge: with poor excitation a group of three may hold it") {
    const auto t = truth("poor_excitation", {effect("coulomb_friction")});
    CHECK(judge(t, said("explained", {cause("viscous_friction", 0.4, {"coulomb_friction"})})).right);
    CHECK_FALSE(
        judge(t, said("explained", {cause("viscous_friction", 0.4, {"coulomb_friction", "mass", "cogging"})}))
            .right);
    CHECK_FALSE(judge(t, said("explained", {cause("viscous_friction", 0.6, {"mass"})})).right);
    CHECK_FALSE(
        judge(t, said("explained", {cause("viscous_friction", 0.4, {"coulomb_friction"}), cause("mass", 0.7)}))
            .right);
}

TEST_CASE("judge: the first box, with what docs/formats.md lets pass") {
    CHECK(*judge(truth("single", {effect("sample_loss")}), said("explained", {}, "actuator")).box);
    CHECK_FALSE(*judge(truth("single", {effect("sample_loss")}), said("explained", {}, "mechanics")).box);
    CHECK(*judge(truth("single", {effect("cogging")}), said("explained", {}, "actuator")).box);
    CHECK(*judge(truth("single", {effect("mass")}), said("explained", {}, "actuator")).box);
    CHECK_FALSE(judge(truth("none"), said("explained")).box);
}

TEST_CASE("judge: intervals of claims are compared, the first harmonic of several") {
    auto c = cause("cogging", 0.9);
    c["parameters"] = {{"cogging_period_m", {{"value", 0.03}, {"ci95", {0.0299, 0.0301}}}},
                       {"cogging_N", {{"value", {4.0, 1.0}}, {"ci95", {{3.8, 4.2}, {0.9, 1.1}}}}}};
    const auto t = truth("single", {effect("cogging", 5, {{"cogging_period_m", 0.03}, {"cogging_N", 4.5}})});
    const auto j = judge(t, said("explained", {c}));
    REQUIRE(j.parameters.size() == 2);
    CHECK(j.parameters[0].covered());
    CHECK_FALSE(j.parameters[1].covered());
}
TEST_CASE("judge: a wave that is found with twice its period is the same wave, in the second harmonic") {
    ordered_json c = cause("cogging", 0.9);
    c["parameters"] = {
        {"cogging_period_m", {{"value", 0.0601}, {"ci95", {0.0595, 0.0605}}}},
        {"cogging_N", {{"value", {0.2, 6.1}}, {"ci95", {ordered_json{-0.1, 0.5}, ordered_json{5.8, 6.4}}}}}};
    const auto t = truth("single", {effect("cogging", 5, {{"cogging_period_m", 0.03}, {"cogging_N", 6.0}})});
    const auto j = judge(t, said("explained", {c}));
    REQUIRE(j.parameters.size() == 2);
    CHECK(j.parameters[0].value == doctest::Approx(0.03005));
    CHECK(j.parameters[0].covered());
    CHECK(j.parameters[1].value == 6.1);
    CHECK(j.parameters[1].covered());
}

TEST_CASE("judge: no diagnosis is no answer, and wrong") {
    const auto j = judge(truth("none"), nullptr);
    CHECK_FALSE(j.answered);
    CHECK_FALSE(j.right);
    CHECK_FALSE(claims(nullptr));
}

TEST_CASE(
    "judge: a claim is a cause of one half or more; forecast and remaining force are read, or are not there") {
    CHECK(claims(said("explained", {cause("mass", 0.3), cause("cogging", 0.5)})));
    CHECK_FALSE(claims(said("explained", {cause("mass", 0.49)})));
    CHECK(*forecast_shrink({{"axes", {{"x", {{"shrink", 0.8}}}}}}) == 0.8);
    CHECK_FALSE(forecast_shrink({{"axes", {{"y", {{"shrink", 0.8}}}}}}));
    CHECK_FALSE(forecast_shrink(nullptr));
    CHECK(*remaining_force({{"axes", {{"x", {{"gap", {{"force_rms_N", 3.5}}}}}}}}) == 3.5);
    CHECK_FALSE(remaining_force(ordered_json::object()));
}

TEST_CASE("judge: an effect that the file excludes has to be left without a name") {
    CHECK(judge(truth("removed", {effect("cogging", 5)}), said("unexplained")).right);
    CHECK_FALSE(judge(truth("removed", {effect("cogging", 5)}), said("within_tolerance")).right);
    const auto j =
        judge(truth("removed", {effect("cogging", 5)}), said("explained", {cause("force_ripple", 0.9)}));
    CHECK_FALSE(j.right);
    CHECK(j.blamed_falsely);
    CHECK(j.truth == "cogging (removed)");
}

TEST_CASE("recalibration: finds the line that the answers were drawn from") {
    const auto drawn = [](double slope,
                          double offset) { // 5000 of each probability, right exactly as often as the line says
        std::vector<std::pair<double, bool>> all;
        for (const double p : {0.1, 0.3, 0.6, 0.9, 0.97}) {
            const double q = 1 / (1 + std::exp(-offset - slope * std::log(p / (1 - p))));
            for (int k = 0; k < 5000; ++k) all.emplace_back(p, k < 5000 * q);
        }
        return recalibrate(all);
    };
    for (const auto& [slope, offset] : {std::pair{1.0, 0.0}, {0.6, -0.4}, {1.3, 0.5}}) {
        const auto r = drawn(slope, offset);
        CHECK(std::abs(r.slope - slope) < 0.01);
        CHECK(std::abs(r.offset - offset) < 0.01);
        CHECK(r.slope_95.first < slope);
        CHECK(r.slope_95.second > slope);
    }
    CHECK(recalibrate({}).slope == 1);
    CHECK(recalibrate(std::vector<std::pair<double, bool>>(30, {0.97, true})).offset >
          0); // finite, and the right way
    CHECK(recalibrate(std::vector<std::pair<double, bool>>(30, {0.97, false})).slope < 0.5);
}

TEST_CASE("tally: bounds of Clopper and Pearson, Brier score and bins by hand") {
    std::vector<judged_machine> all;
    for (int k = 0; k < 60; ++k) all.push_back({judge(truth("none"), said("within_tolerance")), {}});
    auto t = tally(all);
    CHECK(t["false_blame"]["upper95"] == doctest::Approx(1 - std::pow(0.05, 1.0 / 60)));
    CHECK(t["top1"]["from_2_clouds"]["of"] == 60);
    CHECK(t["top1"]["none"]["ci95"][0] == doctest::Approx(std::pow(0.025, 1.0 / 60)));
    CHECK(t["calibration"]["causes"] == 0);
    const auto three_of_ten = detail::share{3, 10}.json()["ci95"]; // tables of the binomial: 6.67 % and 65.25 %
    CHECK(three_of_ten[0] == doctest::Approx(0.0667).epsilon(1e-3));
    CHECK(three_of_ten[1] == doctest::Approx(0.6525).epsilon(1e-3));

    all = {{judge(truth("single", {effect("cogging", 5)}),
                  said("explained", {cause("cogging", 0.9), cause("mass", 0.2)})),
            shrink_pair{0.8, 0.75}},
           {judge(truth("single", {effect("backlash", 0.3)}), said("explained", {cause("mass", 0.8)})),
            shrink_pair{0.8, 0.5}}};
    t = tally(all);
    CHECK(t["calibration"]["brier"] == doctest::Approx((0.01 + 0.04 + 0.64) / 3));
    CHECK(t["calibration"]["bins"].size() == 3);
    CHECK(t["forecast_within_10_points"]["right"] == 1);
    CHECK(t["top1"]["single_from_3_clouds"]["of"] == 1);
    CHECK(t["top1"]["from_2_clouds"] == detail::share{1, 1}.json());
    CHECK(t["top1"]["single"]["right"] == 1);
    CHECK(t["detection"][0]["another"] == 1);
    CHECK(t["detection"][5]["named"] == 1);
    CHECK(t["confusion"]["backlash"]["mass"] == 1);
    CHECK(t["false_blame"]["of"] == 0);
}
