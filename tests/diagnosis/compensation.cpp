// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/apply.hpp"
#include "quadrant/diagnosis/compensate.hpp"
#include "quadrant/diagnosis/compensate/advice.hpp"
#include "quadrant/diagnosis/effect/effect_list.hpp"
#include "quadrant/diagnosis/write_compensation.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

// The machines are those of workshop.hpp: LuGre bristles, finer steps, another controller code. What was fitted
// is not right
// either: each value of a cause stands as far off as a diagnosis may be, with an interval that holds the truth.
using namespace quadrant::diagnosis;

namespace {

constexpr double seconds = 5.1; // strokes, and reversals of 20 mm

parameter_estimate value(const char* key, double x, double half) { return {key, {{x, x - half, x + half}}}; }

diagnosis_result found(std::vector<cause> causes) {
    diagnosis_result d;
    d.verdict = verdict::explained;
    d.axes.resize(1);
    d.axes[0].name = "x";
    d.causes = std::move(causes);
    for (cause& c : d.causes) {
        c.axis = "x";
        c.probability = c.group_probability = 0.9;
    }
    return d;
}
cause named(const char* effect, std::vector<parameter_estimate> parameters, bool described = false) {
    cause c;
    c.effect = effect;
    c.described = described;
    c.parameters = std::move(parameters);
    return c;
}

compensated_axis forecast(const machine_description& file, const diagnosis_result& d, const axis_log& log) {
    const auto r = compensate(file, d, workshop::as_log(log));
    REQUIRE(r.axes.size() == 1);
    return r.axes[0];
}
const compensation& of(const compensated_axis& a, const std::string& name) {
    for (const compensation& c : a.compensations)
        if (c.name == name) return c;
    FAIL("no compensation " << name);
    return a.compensations.front();
}

/// Error of a log, and the mean of its peaks after reversals, by arithmetic of its own.
/// Without the first block, as in the forecast.
double error_rms(const axis_log& log) {
    const auto plant = workshop::described({}).axes[0].plant;
    const double block = scales_of(plant, log, workshop::period, workshop::count).block() / workshop::period;
    const std::size_t skip = 5 * static_cast<std::size_t>(std::lround(block / 5));
    double sum = 0;
    for (std::size_t k = skip; k < log.position.size(); ++k)
        sum += (log.reference[k] - log.position[k]) * (log.reference[k] - log.position[k]);
    return std::sqrt(sum / static_cast<double>(log.position.size() - skip));
}

/// The same machine with a compensation in it, `scale` times: keys in its controller, the rest as a force of
/// the motor.
axis_log with(workshop::machine m, const machine_description& file, const diagnosis_result& d,
              const compensation& c, double scale = 1) {
    for (const key_value& k : c.keys) {
        if (k.key == "coulomb_feedforward_V") m.control.coulomb_feedforward = scale * k.values[0];
        if (k.key == "viscous_feedforward_V_s_per_m") m.control.viscous_feedforward = scale * k.values[0];
    }
    const plant_model fitted(apply(file, d).axes[0], 2e-7);
    std::vector<double> reference;
    for (double t = 0; t < seconds; t += workshop::period) reference.push_back(workshop::motion(t));
    const auto u = compensator(fitted, c.forces, workshop::period)(reference);
    m.stranger = [=](double, double, double t) { // t is that of the row
        const double told = std::max(0.0, t + workshop::period / 2 - m.delay) / workshop::period;
        return scale * m.force_constant * u[std::min(u.size() - 1, static_cast<std::size_t>(told))];
    };
    return workshop::run(m, seconds, 2);
}

/// Forecast against what the machine does; then the same with the wrong sign, which must be worse than nothing.
void kept(const workshop::machine& m, const machine_description& file, const diagnosis_result& d,
          const axis_log& log, const compensation& c, double at_least) {
    const std::string name = c.name;
    CAPTURE(name);
    CHECK((c.claimed || at_least < 0.1)); // less is within what the simulation misses
    CHECK(c.gain.value > at_least);
    const double before = error_rms(log), achieved = error_rms(with(m, file, d, c));
    CAPTURE(before);
    CAPTURE(achieved);
    CAPTURE(c.after.rms_m.value);
    CHECK(achieved > c.after.rms_m.low);
    CHECK(achieved < c.after.rms_m.high);
    CHECK(std::abs((1 - achieved / before) - c.gain.value) < 0.1); // ten percentage points
    CHECK(error_rms(with(m, file, d, c, -1)) > 1.2 * before);
}

} // namespace

TEST_CASE("compensate: Coulomb friction by the controller's key takes off what the forecast says") {
    workshop::machine m;
    m.coulomb = 90;
    auto file = workshop::described(m);
    file.axes[0].plant.coulomb_N.reset();
    const auto d = found({named("coulomb_friction", {value("coulomb_N", 86, 6)})});
    const auto log = workshop::run(m, seconds);
    const auto r = compensate(file, d, workshop::as_log(log));
    REQUIRE(r.axes.size() == 1);
    CHECK(workshop::near(r.axes[0].measured.rms_m.value, error_rms(log), 1e-9));
    kept(m, file, d, log, of(r.axes[0], "coulomb_feedforward"), 0.15);

    const auto patch = controller_patch(r);
    const double volts = patch["axes"]["x"]["controller"]["coulomb_feedforward_V"];
    CHECK(workshop::near(volts, 86 / file.axes[0].plant.force_constant_N_per_V, 1e-6));
    const auto json = to_json(r);
    CHECK(json["axes"]["x"]["compensations"][0]["claimed"] == true);
    CHECK(json["axes"]["x"]["compensations"][0]["controller"].size() == 1);
}

TEST_CASE("compensate: cogging, and friction that falls with speed, are paid by blocks as forecast" *
          doctest::test_suite("all")) {
    workshop::machine m;
    m.excess = 90;
    m.cogging = 40;
    auto file = workshop::described(m);
    const auto d = found({named("stribeck_friction",
                                {value("static_N", 144, 9), value("stribeck_velocity_m_per_s", 0.0045, 8e-4)}),
                          named("cogging", {value("cogging_period_m", 0.03, 1e-5), value("cogging_N", 38, 3),
                                            value("cogging_phase_rad", 0.72, 0.04)})});
    const auto log = workshop::run(m, seconds);
    const auto a = forecast(file, d, log);
    kept(m, file, d, log, of(a, "cogging feedforward"), 0.02);
    kept(m, file, d, log, of(a, "friction_feedforward"), 0.05);
    kept(m, file, d, log, of(a, "friction_feedforward and the rest"), 0.15);
    REQUIRE(a.best());
    CHECK(a.best()->effects.size() == 2);
}

TEST_CASE("compensate: wider intervals promise less, and plants are not the feedforward's own numbers" *
          doctest::test_suite("all")) {
    workshop::machine m;
    m.coulomb = 90;
    auto file = workshop::described(m);
    file.axes[0].plant.coulomb_N.reset();
    const auto log = workshop::run(m, seconds);
    const auto of_width = [&](double half) {
        return of(forecast(file, found({named("coulomb_friction", {value("coulomb_N", 86, half)})}), log),
                  "coulomb_feedforward");
    };
    const auto sharp = of_width(0), wide = of_width(40);
    CHECK(wide.after.rms_m.high > sharp.after.rms_m.high + 1e-7);
    CHECK(wide.gain_at_ends < sharp.gain_at_ends - 0.01);
    CHECK(wide.gain_at_ends < wide.gain.low + 1e-12);
}

TEST_CASE("compensate: an effect without a feedforward gets advice and no gain, one below the noise no claim" *
          doctest::test_suite("all")) {
    workshop::machine m;
    m.constant_force = 4;
    m.control.coulomb_feedforward = m.coulomb / m.force_constant;
    const auto file = workshop::described(m);
    const auto log = workshop::run(m, seconds);
    const auto a = forecast(file,
                            found({named("time_delay", {value("delay_s", 0.0009, 1e-5)}, true),
                                   named("backlash", {value("backlash_m", 1e-5, 1e-6)}),
                                   named("constant_force", {value("constant_force_N", 4, 1)})}),
                            log);
    REQUIRE(a.others.size() == 2);
    CHECK(a.others[0].effect == "time_delay");
    CHECK(a.others[0].text.find("0.9 ms") != std::string::npos);
    CHECK(a.others[1].text.find("behind the play") != std::string::npos);
    REQUIRE(a.compensations.size() == 1);
    CHECK(a.compensations[0].name == "constant command");
    CHECK(!a.compensations[0].claimed);      // the integral pays it already
    for (const effect* e : every_effect()) { // either a feedforward or advice, for every name
        CAPTURE(e->name);
        CHECK((advice_on(e->name, plant_model(file.axes[0], 2e-7), 1e-7, "V").empty() ==
               !e->compensation.empty()));
        CHECK(!e->remedy.empty());
    }
}

TEST_CASE(
    "compensate: without a controller nothing is forecast; a diagnosis that is applied already is refused") {
    const workshop::machine m;
    auto file = workshop::described(m);
    const auto log = workshop::as_log(workshop::run(m, 1.0));
    file.axes[0].controller.reset();
    file.axes[0].plant.coulomb_N.reset();
    const auto d = found({named("coulomb_friction", {value("coulomb_N", 58, 2)})});
    const auto r = compensate(file, d, log);
    CHECK(!r.axes[0].forecast);
    CHECK(!r.axes[0].compensations[0].claimed);
    CHECK(r.notes.back().find("no controller is described") != std::string::npos);
    CHECK(controller_patch(r).empty());
    CHECK_THROWS_AS(compensate(apply(file, d), d, log), bad_input);
}
