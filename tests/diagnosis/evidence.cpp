// SPDX-License-Identifier: BSL-1.0
#include "claims.hpp"
#include "quadrant/diagnosis/effect/effects.hpp"
#include "quadrant/diagnosis/text/bad_input.hpp"
#include "quadrant/diagnosis/which/causes.hpp"

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

constexpr double pole = 0.9;

/// Innovations of an observer with both poles at `pole` on a reading of white noise with rms 1.
std::vector<double> noise_seen(std::size_t rows) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> reading;
    std::vector<double> out(rows);
    double x = 0, v = 0; // v: a row
    for (double& e : out) {
        e = reading(random) - x;
        x += (1 - pole * pole) * e;
        v += (1 - pole) * (1 - pole) * e;
        x += v;
    }
    return out;
}
std::vector<channel> channels(std::size_t rows) {
    const std::vector<std::size_t> segment(rows, 0);
    return quadrant::diagnosis::detail::channels_of(8, 0, pole, segment, [&](std::size_t block) {
        std::vector<std::size_t> first;
        for (std::size_t k = block; k + block <= rows; k += block) first.push_back(k);
        return first;
    });
}
double mean_square(const std::vector<double>& e, const channel& c) {
    const auto ms = quadrant::diagnosis::detail::block_ms(e, c);
    double sum = 0;
    for (double m : ms) sum += m / static_cast<double>(ms.size());
    return sum;
}
std::vector<const effect*> suspects_of(command_origin origin) {
    const workshop::machine real;
    auto axis = workshop::described(real).axes[0];
    axis.actuator.command_is = origin;
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(axis.plant, log, workshop::period, workshop::count));
    return search(record, axis, {}, {}, [](const std::string&) {}).suspects();
}

} // namespace

TEST_CASE("channels: each is five times slower than the one before, as long as it has five blocks") {
    const auto all = channels(20000);
    std::vector<std::size_t> means;
    for (const channel& c : all) means.push_back(c.mean);
    CHECK(means == std::vector<std::size_t>{1, 8, 40, 200});
    CHECK(all.back().first_of_block.size() >= 5);
    CHECK(channels(1000).size() == 2); // four blocks of the third
    CHECK(channels(1200).size() == 3);
}

TEST_CASE("channels: what each sees of the reading's noise is what an observer passes to it") {
    const auto e = noise_seen(400000);
    for (const channel& c : channels(400000)) {
        CAPTURE(c.mean);
        CHECK(std::sqrt(mean_square(e, c)) ==
              doctest::Approx(c.noise_gain).epsilon(c.mean < 100 ? 0.03 : 0.15));
    }
}

TEST_CASE("channels: a slow signal that the noise hides row by row stands out in the mean over a stroke") {
    auto e = noise_seen(40000);
    const auto all = channels(e.size());
    const double row = mean_square(e, all.front()), stroke = mean_square(e, all.back());
    for (double& x : e) x += 0.05;
    CHECK(mean_square(e, all.front()) < 1.01 * row);
    CHECK(mean_square(e, all.back()) > 100 * stroke);
}

TEST_CASE("suspects: what acts on the command before the tap of a measured one is none") {
    const auto on_command = [](const effect* e) { return e->joins == quadrant::joint::command; };
    const auto asked = suspects_of(command_origin::asked), measured = suspects_of(command_origin::measured);
    CHECK(std::count_if(asked.begin(), asked.end(), on_command) ==
          5); // dead zone, limit, lag, delay, lost samples
    CHECK(std::none_of(measured.begin(), measured.end(), on_command));
    CHECK(asked.size() == measured.size() + 5);
}

TEST_CASE("chance: a law that takes nearly all off is believed, one that takes a third off is not") {
    namespace d = quadrant::diagnosis::detail;
    constexpr std::size_t names = 30;
    CHECK(d::by_chance(names, 0) == doctest::Approx(0.03));
    CHECK(d::by_chance(names, std::sqrt(1.0 / 9)) < 0.05); // nine tenths of the energy
    CHECK(d::by_chance(names, std::sqrt(2.0)) > 0.9);      // a third
    for (double left = 0; left < 3; left += 0.1)
        CHECK(d::by_chance(names, left) <= d::by_chance(names, left + 0.1));
    CHECK(d::by_chance(60, 1) > d::by_chance(30, 1)); // more laws tried, more luck
}

TEST_CASE("chance: two rare effects must bring more than two common ones") {
    namespace d = quadrant::diagnosis::detail;
    CHECK(d::rarity({&suspect::coulomb_friction}) == 0);
    CHECK(d::rarity({&suspect::actuator_dead_zone}) > d::rarity({&suspect::viscous_friction}));
    CHECK(d::rarity({&suspect::actuator_dead_zone, &suspect::sample_loss}) ==
          doctest::Approx(d::rarity({&suspect::actuator_dead_zone}) + d::rarity({&suspect::sample_loss})));
}

TEST_CASE("chance: a value whose interval reaches the number that does nothing is no claim") {
    using quadrant::diagnosis::detail::may_be_nothing;
    const auto one = [](const char* key, double value, double half) {
        return std::vector{parameter_estimate{.key = key, .values = {{value, value - half, value + half}}}};
    };
    CHECK(may_be_nothing(one("coulomb_N", 10, 10)));
    CHECK_FALSE(may_be_nothing(one("coulomb_N", 10, 9)));
    CHECK(may_be_nothing(one("constant_force_N", -1, 2)));
    CHECK_FALSE(may_be_nothing(one("actuator.drive_limit_V", 3, 3))); // no limit is infinite
    auto wave = one("cogging_period_m", 0.02, 0.001);
    wave.push_back({.key = "cogging_N", .values = {{1, -1, 3}, {3, 2, 4}}}); // one sure harmonic is enough
    CHECK_FALSE(may_be_nothing(wave));
    wave.back().values.back().low = -1;
    CHECK(may_be_nothing(wave));
    auto asymmetry = one("viscous_asymmetry", 0, 0.05);
    CHECK(may_be_nothing(asymmetry));
    asymmetry.push_back(one("coulomb_asymmetry", 0.3, 0.02).front()); // of the two the other one is sure
    CHECK_FALSE(may_be_nothing(asymmetry));
}

TEST_CASE("process: a period with which the motion repeats tells nothing of a process") {
    std::vector<double> strokes;
    for (int k = 0; k < 8000; ++k) strokes.push_back(std::abs(k % 1000 - 500)); // there and back in 1000 rows
    for (const double rows : {1000.0, 500.0, 1000.0 / 3, 250.0, 2000.0}) {
        CAPTURE(rows);
        CHECK(quadrant::diagnosis::detail::motion_repeats(strokes, rows));
    }
    for (const double rows : {20.0, 73.0, 370.0, 640.0}) {
        CAPTURE(rows);
        CHECK_FALSE(quadrant::diagnosis::detail::motion_repeats(strokes, rows));
    }
}

TEST_CASE("search: what comes near the best at a first look is fitted to the end, however many looked better") {
    workshop::machine real;
    auto axis = workshop::described(real).axes[0];
    axis.plant.coulomb_N = real.coulomb;
    real.viscous *= 2;
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(axis.plant, log, workshop::period, workshop::count));
    const auto gained = [&](std::size_t finalists, double near_best) {
        rules r;
        r.finalists = finalists;
        r.near_best = near_best;
        r.first_look = 1;
        const search models(record, axis, {}, r, [](const std::string&) {});
        const auto found =
            models.with_each(models.calibrated(), {&suspect::viscous_friction, &suspect::coulomb_friction});
        REQUIRE(found.size() == 2);
        const auto& viscous = found[found[0].effects[0] == &suspect::viscous_friction ? 0 : 1];
        return viscous.total - models.calibrated().total;
    };
    constexpr double never = 2;
    const double sketched = gained(0, never), fitted = gained(2, never);
    CHECK(fitted > sketched + rules{}.margin); // a first look is not the end
    CHECK(gained(0, rules{}.near_best) == fitted);
}

TEST_CASE("evidence: each direction has its own friction inside the tolerance, and beyond it a cause" *
          doctest::test_suite("all")) {
    workshop::machine real;
    auto file = workshop::described(real);
    file.axes[0].tolerance.given["coulomb"] = 0.12; // 7 N
    for (const double within : {-2.8, 4.0}) {
        real.constant_force = within;
        CHECK(workshop::diagnosed(file, real).causes.empty());
    }
    real.constant_force = -20;
    const auto d = workshop::diagnosed(file, real);
    REQUIRE(d.causes.size() == 1);
    CHECK((d.causes[0].effect == "constant_force" || d.causes[0].effect == "asymmetric_friction"));
    CHECK(d.causes[0].group_probability >= 0.9);
}

TEST_CASE("evidence: steps of the last digit that the log has say nothing of the encoder, with a note") {
    const workshop::machine real;
    auto file = workshop::described(real);
    file.axes[0].encoder.resolution_m = workshop::count / 8;
    auto log = workshop::as_log(workshop::run(real, workshop::three_strokes));
    log.axes[0].position_step = workshop::count;
    const auto d = diagnose(file, log);
    CAPTURE(workshop::said(d));
    CHECK(d.verdict <= verdict::within_tolerance); // which no suspect is
    CHECK(d.causes.empty());
    CHECK(std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& note) {
        return note.find("steps of 2.5e-07 m, the last digit of the log, and 3.12e-08 m are described") !=
               note.npos;
    }));
}

TEST_CASE("evidence: a record in pieces of which one alone is long enough to be judged is refused") {
    const workshop::machine real;
    const auto file = workshop::described(real);
    auto log = workshop::as_log(workshop::run(real, 8.15));
    std::vector<unsigned char>& out = log.axes[0].left_out;
    out.assign(log.samples, 0);
    for (std::size_t k = 300; k < out.size(); ++k) out[k] = k % 120 >= 30;
    try {
        diagnose(file, log);
        FAIL("it was diagnosed");
    } catch (const bad_input& e) {
        const std::string said = e.what();
        CHECK(said.find("pieces, the longest of 300 (import with a longer") != said.npos);
        CHECK(said.find("of them lie in pieces that are long enough to be judged") != said.npos);
    }
}
