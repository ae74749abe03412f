// SPDX-License-Identifier: BSL-1.0
// Responses read off a loop that runs, beside those that its blocks know in closed form.
#include "quadrant_reproduce/virtual_cnc.hpp"

#include <quadrant/analysis/impulse_test.hpp>
#include <quadrant/analysis/law_figures.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
namespace an = quadrant::analysis;

namespace {
const quadrant::axis_model<signal::voltage> plant = vcnc::model(vcnc::x_axis);
const an::sampled_axis<> axis{plant, 1_ms};

/// A law on the sampled axis, one period at a time, with a gain that bends for large commands.
template <class Law> struct running {
    Law law;
    double bend = 0;
    viscous_step<> way{plant.viscous_rate.value(), 1e-3};
    double x = 0, v = 0;

    void rest() {
        law.reset();
        x = v = 0;
        asked_before.clear();
    }
    std::size_t lead() const {
        if constexpr (requires { Law::most_lead; }) return law.lead();
        return 0;
    }
    std::vector<double> asked_before{};
    an::loop_sample step(const axis_motion<>& asked, double push) {
        const double read = x;
        double u = law(asked, in_si(x), in_si(v)).value() + push;
        if constexpr (requires { law.applied(volt(u)); }) law.applied(volt(u - push));
        u -= bend * u * u * u;
        x += way.gained * v + way.way * plant.gain.value() * u;
        v = way.kept * v + way.gained * plant.gain.value() * u;
        asked_before.push_back(asked.position.value());
        const std::size_t ahead = lead();
        const double due = asked_before.size() > ahead ? asked_before[asked_before.size() - 1 - ahead] : 0;
        return {u, read, due};
    }
    static quantity_of<signal::voltage> volt(double u) { return quantity_of<signal::voltage>::from_value(u); }
};

template <class Law> void same_as_closed_form(const Law& law) {
    const an::law_loop exact{law, axis};
    running<Law> loop{law};
    const an::impulse_test found(loop, 1_ms, 1e-3, 1e-6);
    REQUIRE(found.decays());
    CHECK(found.linear());
    for (const double f : {0.5, 3.0, 17.0, 60.0, 150.0, 333.0, 499.0}) {
        CAPTURE(f);
        const auto at = an::hertz(f);
        CHECK(std::abs(found.open(at) / exact.open(at) - 1.0) < 1e-6);
        CHECK(std::abs(found.sensitivity(at) - exact.sensitivity(at)) < 1e-8);
        CHECK(std::abs(found.disturbance(at) / exact.disturbance(at) - 1.0) < 1e-6);
        if (at < found.highest()) CHECK(std::abs(found.tracking(at) - exact.tracking(at)) < 1e-5);
    }
    const auto by_run = an::frequency_figures(found, an::hertz(0.5), found.nyquist());
    const auto by_form = an::frequency_figures(exact, an::hertz(0.5), 500_Hz);
    CHECK(by_run.sensitivity_peak == doctest::Approx(by_form.sensitivity_peak).epsilon(1e-6));
    REQUIRE(by_run.phase);
    CHECK(by_run.phase->value == doctest::Approx(by_form.phase->value).epsilon(1e-6));
}
} // namespace

TEST_CASE("impulse_test: a PID's responses are those of the closed form") {
    same_as_closed_form(pid<>{vcnc::pid_of(vcnc::x_axis), 1_ms});
}
TEST_CASE("impulse_test: a law with preview is asked ahead, and compared with what was due") {
    same_as_closed_form(
        zero_phase_tracking<>{zero_phase_rst(plant, {.natural = 20_Hz, .observer = 30_Hz}, 1_ms), 1_ms});
}
TEST_CASE("impulse_test: a loop that is not stable does not decay, a bent one is not linear") {
    auto hot = vcnc::pid_of(vcnc::x_axis);
    hot.gain = hot.gain * 40.0;
    running<pid<>> loop{pid<>{hot, 1_ms}};
    CHECK_FALSE(an::impulse_test(loop, 1_ms, 1e-3, 1e-6).decays());
    running<pid<>> bent{pid<>{vcnc::pid_of(vcnc::x_axis), 1_ms}, 1e3};
    const an::impulse_test found(bent, 1_ms, 1e-3, 1e-9);
    CHECK(found.decays());
    CHECK_FALSE(found.linear());
}
TEST_CASE("impulse_test: a push or a way of nothing is refused by name") {
    running<pid<>> loop{pid<>{vcnc::pid_of(vcnc::x_axis), 1_ms}};
    const auto said = [&](double push, double way) {
        try {
            an::impulse_test(loop, 1_ms, push, way);
        } catch (const invalid_parameter& fault) {
            return std::string(fault.what());
        }
        return std::string("accepted");
    };
    CHECK(said(0, 1e-6) == "impulse_test.push = 0: must be finite and not zero");
    CHECK(said(1, NAN).starts_with("impulse_test.way = "));
}
