// SPDX-License-Identifier: BSL-1.0
// A signal that is added to the command: found with its form and its times, and never taken for a gain.
#include "workshop.hpp"

#include <quadrant/diagnosis/result/words.hpp>

#include <doctest/doctest.h>

#include <functional>
#include <random>

using namespace controllers_workshop;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
using signal_of_time = std::function<double(double)>;

/// The log of an axis whose controller is as described, with a signal behind it in the closed loop.
axis_log logged_with(const axis_description& axis, const signal_of_time& signal, double seconds = 4.4) {
    axis_log log = asked(seconds);
    const double T = machine().sample_period_s, step = dac(axis);
    std::vector<double> added(log.reference.size());
    for (std::size_t k = 0; k < added.size(); ++k)
        added[k] = std::round(signal(static_cast<double>(k) * T) / step) * step;
    const auto run =
        simulate_closed_loop(*axis.controller, axis, plant_model(axis, 2e-7), T, log, {}, 4, added);
    log.position = run.position;
    for (double& y : log.position) y = std::round(y * 1e12) / 1e12;
    log.command = run.command;
    return log;
}
controller_finding found_with(const axis_description& axis, const signal_of_time& signal) {
    const auto out = judged(axis, *axis.controller, logged_with(axis, signal));
    CAPTURE(out.key);
    CHECK(out.differs);
    CHECK_FALSE(out.mended);
    REQUIRE(out.added);
    CHECK(out.added->probability > 0.9);
    return out;
}
/// A square wave that begins at `begin`: `size`, then `then`, each for its time.
signal_of_time square(double begin, double size, double on, double off, bool alternates = false) {
    return [=](double t) {
        if (t < begin - 1e-9) return 0.0;
        const double turn = std::floor((t - begin + 1e-9) / (on + off)), in = t - begin - turn * (on + off);
        const double sign = alternates && std::fmod(turn, 2.0) > 0.5 ? -1 : 1;
        return in < on - 1e-9 ? sign * size : 0.0;
    };
}
const std::vector<std::string> kinds{"cascade_p_pi", "p_velocity", "linuxcnc_pid", "pid", "p_pi"};

} // namespace

TEST_CASE("added command: a constant from a time on is found with its size and its time to a few samples") {
    for (const auto& kind : kinds) {
        CAPTURE(kind);
        const auto w = found_with(axis_of(kind), [](double t) { return t < 1.3 ? 0.0 : 0.4; }).added->waveform;
        CHECK(w.form == waveform_form::constant);
        REQUIRE(w.levels.size() == 1);
        CHECK(w.levels[0].value == doctest::Approx(0.4).epsilon(0.01));
        CHECK(w.from_s == doctest::Approx(1.3).epsilon(0.001));
        CHECK(w.to_end);
    }
}

TEST_CASE("added command: a constant that goes again is found with both times" * doctest::test_suite("all")) {
    const auto w = found_with(axis_of("cascade_p_pi"), [](double t) {
                       return t > 1.3 && t < 3.6 ? -0.25 : 0.0;
                   }).added->waveform;
    CHECK(w.form == waveform_form::constant);
    REQUIRE(w.levels.size() == 1);
    CHECK(w.levels[0].value == doctest::Approx(-0.25).epsilon(0.01));
    CHECK(w.from_s == doctest::Approx(1.3).epsilon(0.001));
    CHECK(w.to_s == doctest::Approx(3.6).epsilon(0.001));
}

TEST_CASE("added command: a square wave is found with its levels, its times and its period" *
          doctest::test_suite("all")) {
    for (const auto& kind : kinds) {
        CAPTURE(kind);
        const auto found = found_with(axis_of(kind), square(1.2, 0.5, 0.3, 0.2));
        const auto& w = found.added->waveform;
        CHECK(w.form == waveform_form::square);
        CHECK(w.period_s == doctest::Approx(0.5).epsilon(0.002));
        CHECK(w.from_s == doctest::Approx(1.2).epsilon(0.001));
        CHECK(w.to_end);
        REQUIRE(w.levels.size() == 2);
        CHECK(w.levels[0].value == doctest::Approx(0.5).epsilon(0.01));
        CHECK(w.levels[0].duration_s == doctest::Approx(0.3).epsilon(0.005));
    }
    const auto w = found_with(axis_of("cascade_p_pi"), square(1.2, 0.5, 0.15, 0.35, true)).added->waveform;
    CHECK(w.form == waveform_form::square);
    CHECK(in_words(w, "V") ==
          "a square wave of +-0.5 V, 0.15 s on and 0.35 s off, is added to the command from 1.2 s on");
}

TEST_CASE("added command: short pulses are found, down to a few samples and a few converter steps") {
    const auto w = found_with(axis_of("cascade_p_pi"), square(0.8, 0.01, 0.005, 0.195)).added->waveform;
    CHECK(w.form == waveform_form::square);
    CHECK(w.period_s == doctest::Approx(0.2).epsilon(0.005));
    REQUIRE(w.levels.size() == 2);
    CHECK(w.levels[0].value == doctest::Approx(0.01).epsilon(0.05));
}

TEST_CASE("added command: a tone is found with frequency, size and phase, whole or in a part of the record" *
          doctest::test_suite("all")) {
    for (const auto& kind : kinds) {
        CAPTURE(kind);
        const auto signal = [](double t) { return t < 1 ? 0 : 0.3 * std::sin(two_pi * 7.3 * (t - 1) + 0.6); };
        const auto w = found_with(axis_of(kind), signal).added->waveform;
        CHECK(w.form == waveform_form::tone);
        CHECK(w.frequency_Hz == doctest::Approx(7.3).epsilon(0.001));
        CHECK(w.amplitude == doctest::Approx(0.3).epsilon(0.01));
        CHECK(w.from_s == doctest::Approx(1).epsilon(0.005));
        CHECK(w.phase_rad == doctest::Approx(0.6 + two_pi * 7.3 * (w.from_s - 1)).epsilon(0.02));
    }
    const auto w = found_with(axis_of("cascade_p_pi"), [](double t) {
                       return 0.05 * std::sin(two_pi * 41 * t);
                   }).added->waveform;
    CHECK(w.form == waveform_form::tone);
    CHECK(w.frequency_Hz == doctest::Approx(41).epsilon(0.001));
}

TEST_CASE("added command: a sweep is found with both its frequencies" * doctest::test_suite("all")) {
    const auto signal = [](double t) {
        const double s = t - 0.7;
        return s < 0 || s > 3 ? 0 : 0.2 * std::sin(two_pi * (4 * s + 0.5 * 12 * s * s));
    };
    const auto w = found_with(axis_of("cascade_p_pi"), signal).added->waveform;
    CHECK(w.form == waveform_form::chirp);
    CHECK(w.frequency_Hz == doctest::Approx(4).epsilon(0.02));
    CHECK(w.sweep_Hz_per_s == doctest::Approx(12).epsilon(0.01));
    CHECK(w.amplitude == doctest::Approx(0.2).epsilon(0.02));
}

TEST_CASE("added command: noise in a part of the record has no simple form, and its rms and times are told" *
          doctest::test_suite("all")) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 0.2);
    const auto signal = [&](double t) { return t > 1.5 && t < 3.2 ? normal(random) : 0.0; };
    const auto w = found_with(axis_of("cascade_p_pi"), signal).added->waveform;
    CHECK(w.form == waveform_form::unknown);
    CHECK(w.rms == doctest::Approx(0.2).epsilon(0.05));
    CHECK(w.from_s == doctest::Approx(1.5).epsilon(0.04));
    CHECK(w.to_s == doctest::Approx(3.2).epsilon(0.04));
}

TEST_CASE("added command: a wrong key is never an added command, by a tenth, by half or doubled" *
          doctest::test_suite("all")) {
    int differed = 0;
    for (const auto& kind : kinds) {
        const auto& axis = axis_of(kind);
        for (const auto& key : detail::searched_keys(*axis.controller))
            for (const double factor : {0.5, 0.9, 1.1, 2.0}) {
                auto real = *axis.controller;
                double& value = key.of(real);
                if (value == 0 || !key.only.empty() || !key.allowed(factor * value)) continue;
                value *= factor;
                CAPTURE(kind);
                CAPTURE(key.key);
                CAPTURE(factor);
                const auto found = judged(axis, *axis.controller, logged(axis, real));
                differed += found.differs;
                CHECK_FALSE(found.is_added());
            }
    }
    CHECK(differed > 40);
}

TEST_CASE("added command: two wrong keys at once are no added command" * doctest::test_suite("all")) {
    const auto& axis = axis_of("cascade_p_pi");
    const auto keys = detail::searched_keys(*axis.controller);
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        auto real = *axis.controller;
        keys[i].of(real) *= 1.3;
        keys[i + 1].of(real) *= 0.7;
        CAPTURE(keys[i].key);
        const auto found = judged(axis, *axis.controller, logged(axis, real));
        CHECK(found.differs);
        CHECK_FALSE(found.is_added());
    }
}
