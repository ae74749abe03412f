// SPDX-License-Identifier: BSL-1.0
// Long: one rule, retuning without a jump, for each law: a case needs the law in bare doubles.
// Control laws of an axis, observers and feedforwards get other parameters in the middle of a random motion:
// the coming command is off by the formula in the block's doc comment.
#include "retuned.hpp"

#include <quadrant/control/acceleration_feedback.hpp>
#include <quadrant/control/gain_schedule.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/linuxcnc_pid.hpp>
#include <quadrant/control/p_pi.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/predictive.hpp>
#include <quadrant/control/rst.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/feedforward/backlash_compensation.hpp>
#include <quadrant/feedforward/cogging_harmonics.hpp>
#include <quadrant/feedforward/cogging_table.hpp>
#include <quadrant/feedforward/friction_feedforward.hpp>
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/feedforward/sampled_inverse_model.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/feed_control.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>
#include <quadrant/observer/kalman.hpp>
#include <quadrant/observer/lugre_observer.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>

#include <doctest/doctest.h>

#include <array>
#include <concepts>
#include <numbers>

namespace {
struct sample {
    axis_motion<> r;
    quantity_of<signal::position> x{};
    quantity_of<signal::velocity> v{};
};
/// A reference of random size and pace, and an axis that follows it badly.
std::vector<sample> motion(random_numbers& random, std::size_t samples) {
    const auto r = random.signal(samples), off = random.signal(samples);
    const double size = random.decades(1e-6, 1e-2) / largest(r),
                 error = random.decades(1e-7, 1e-3) / largest(off);
    std::vector<sample> out(samples);
    double x = 0, v = 0, y = 0;
    for (std::size_t k = 0; k < samples; ++k) {
        const double rate = (size * r[k] - x) / T.value(), at = size * r[k] + error * off[k];
        out[k] = {{size * r[k] * 1_m, rate * 1_mps, (rate - v) / T.value() * 1_mps2},
                  at * 1_m,
                  (at - y) / T.value() * 1_mps};
        x = size * r[k], v = rate, y = at;
    }
    return out;
}
template <class Law> double give(Law& law, const sample& s) { return law(s.r, s.x, s.v).value(); }
template <class Law> void retune(Law& law, const Law& next, const sample& s, double u) {
    law.retune(next, s.r, s.x, s.v, Law::value::from_value(u));
}
double size_of(const sample& s, double gain) {
    return gain * (std::abs(s.r.position.value()) + std::abs(s.x.value()) + std::abs(s.r.velocity.value()) +
                   std::abs(s.v.value()) + std::abs(s.r.acceleration.value()));
}
/// `step(last, now)`: from the block's doc comment, how far the command of the retuned law may be from `u`.
template <class Law> verdict after_retune(auto draw, auto bound, double gain) {
    random_numbers random;
    verdict said;
    for (int trial = 0; trial < 20000; ++trial) { // 50 x 20 000 = 1e6 samples
        Law law = draw(random);
        const Law next = draw(random);
        const auto in = motion(random, 50);
        double u = 0;
        for (std::size_t k = 0; k < 49; ++k) u = give(law, in[k]);
        if (trial % 2) u *= random.between(0.9, 1.1); // as where the friction fed forward changed as well
        retune(law, next, in[48], u);
        const Law before = law;
        const double is = give(law, in[49]);
        said(is - u, bound(next, before, law, in[48], in[49], u),
             1e-12 * (size_of(in[48], gain) + size_of(in[49], gain) + std::abs(u)));
    }
    return said;
}
double moved(auto of, const sample& last, const sample& now) { return std::abs(of(now) - of(last)); }
double error_of(const sample& s) { return (s.r.position - s.x).value(); }
using v_per_m = gain_of<signal::voltage, signal::position>;
using v_per_mps = gain_of<signal::voltage, signal::velocity>;
using v_per_mps2 = gain_of<signal::voltage, signal::acceleration>;
using v_per_ms = gain_rate_of<signal::voltage, signal::position>;
const auto per_s = 1.0 / 1_s;
} // namespace

TEST_CASE("retune: p_pi starts from the command that it is given; the next one is the step of the new gains") {
    using law = p_pi<double, signal::voltage, integral_clamp>;
    const auto said = after_retune<law>(
        [](auto& r) {
            return law({.position_gain = r.decades(1, 300) * per_s,
                        .gain = v_per_mps::from_value(r.decades(1, 100)),
                        .integral_gain = v_per_m::from_value(r.decades(1, 1e4)),
                        .velocity_weight = r.between(0, 1),
                        .acceleration_gain = v_per_mps2::from_value(r.decades(0.01, 1))},
                       T);
        },
        [](const law& next, auto&&, auto&&, const sample& last, const sample& now, double) {
            const auto& p = next.given();
            const auto e = [&](const sample& s) {
                return p.position_gain.value() * error_of(s) + p.velocity_weight * s.r.velocity.value() -
                       s.v.value();
            };
            return p.gain.value() * moved(e, last, now) +
                   p.integral_gain.value() * T.value() * std::abs(e(now)) +
                   p.acceleration_gain.value() *
                       moved([](const sample& s) { return s.r.acceleration.value(); }, last, now);
        },
        3e4);
    CHECK(said.broken == 0);
    CHECK(said.most > 0.99);
}

TEST_CASE("retune: pid starts from the command that it is given; the next one is the step of the new gains") {
    using law = pid<double, signal::voltage, integral_clamp>;
    const auto said = after_retune<law>(
        [](auto& r) {
            return law({.gain = v_per_m::from_value(r.decades(10, 1e4)),
                        .integral_gain = v_per_ms::from_value(r.decades(1, 1e6)),
                        .derivative_gain = v_per_mps::from_value(r.decades(0.1, 100)),
                        .derivative_corner = r.decades(10, 900) * 1_Hz,
                        .position_weight = r.between(0, 1),
                        .velocity_weight = r.between(0, 1)},
                       T);
        },
        [](const law& next, const law& before, const law& after, const sample& last, const sample& now,
           double) {
            const auto& p = next.given();
            return p.gain.value() * moved(error_of, last, now) +
                   p.integral_gain.value() * T.value() * std::abs(error_of(now)) +
                   p.gain.value() * std::abs(p.position_weight - 1) *
                       moved([](const sample& s) { return s.r.position.value(); }, last, now) +
                   p.derivative_gain.value() * std::abs((after.now().q - before.now().q).value());
        },
        1e6);
    CHECK(said.broken == 0);
    CHECK(said.most > 0.99);
}

TEST_CASE(
    "retune: acceleration_feedback starts from the command that it is given, and its law takes what the gain "
    "changes") {
    using inner = pid<double, signal::voltage, integral_clamp>;
    struct law : acceleration_feedback<inner> { // on an axis that accelerates a third of what it is asked
        using acceleration_feedback::acceleration_feedback;
        auto operator()(const axis_motion<>& r, position x, velocity v) noexcept {
            return acceleration_feedback::operator()(r, x, v, r.acceleration / 3.0);
        }
    };
    const auto said = after_retune<law>(
        [](auto& r) {
            return law({.law = {.gain = v_per_m::from_value(r.decades(10, 1e4)),
                                .integral_gain = v_per_ms::from_value(r.decades(1, 1e6)),
                                .derivative_gain = {}},
                        .gain = v_per_mps2::from_value(r.decades(1e-3, 1)),
                        .corner = r.decades(1, 900) * 1_Hz},
                       T);
        },
        [](const law& next, const law& before, const law& after, const sample& last, const sample& now,
           double) {
            const auto& p = next.given().law;
            return p.gain.value() * moved(error_of, last, now) +
                   p.integral_gain.value() * T.value() * std::abs(error_of(now)) +
                   std::abs((after.added() - before.added()).value());
        },
        1e6);
    CHECK(said.broken == 0);
    CHECK(said.most > 0.99);
}

TEST_CASE("retune: sliding_mode starts from the command that it is given; the next one is the step of the new "
          "gains") {
    using law = sliding_mode<double, signal::voltage, integral_clamp>;
    const auto said = after_retune<law>(
        [](auto& r) {
            return law({.plant = {r.decades(0.1, 10) * (1_mps2 / 1_V), r.decades(0.1, 100) * per_s},
                        .sliding = r.decades(10, 300) * per_s,
                        .gain = v_per_mps::from_value(r.decades(1, 100)),
                        .adaptation = v_per_m::from_value(r.decades(1, 1e4))},
                       T);
        },
        [](const law& next, auto&&, auto&&, const sample& last, const sample& now, double) {
            const auto& p = next.given();
            const double B = p.plant.gain.value(), A = p.plant.viscous_rate.value(), slide = p.sliding.value();
            const auto rest = [&](const sample& s) {
                const double slower = (s.r.velocity - s.v).value();
                return (slide * slower + s.r.acceleration.value() + A * s.v.value()) / B +
                       p.gain.value() * (slide * error_of(s) + slower);
            };
            return moved(rest, last, now) + p.adaptation.value() * moved(error_of, last, now) +
                   slide * p.adaptation.value() * T.value() * std::abs(error_of(now));
        },
        1e6);
    CHECK(said.broken == 0);
    CHECK(said.most > 0.99);
}

TEST_CASE("retune: an rst with an integral makes the step that the new law would have made anyway, exactly") {
    using law = rst<2, 2, 2>;
    random_numbers random;
    verdict said;
    const auto draw = [&] {
        law::parameters p;
        const double pole = random.between(-0.9, 0.95);
        p.r = {1, -1 - pole, pole};
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double s = random.between(-1, 1) * 1e4, t = random.between(-1, 1) * 1e4;
            p.feedback[i] = v_per_m::from_value(s), p.reference[i] = v_per_m::from_value(i < 2 ? t : 0);
            sum += s - (i < 2 ? t : 0);
        }
        p.reference[2] = v_per_m::from_value(sum);
        return law(p, T);
    };
    for (int trial = 0; trial < 20000; ++trial) {
        law one = draw();
        const law next = draw();
        const auto in = motion(random, 50);
        double u = 0, before = 0;
        for (std::size_t k = 0; k < 49; ++k) before = u, u = give(one, in[k]);
        const double to = random.between(0.5, 2) * u;
        retune(one, next, in[48], to);
        const double is = give(one, in[49]);
        const auto& p = next.given();
        double more = -p.r[2] * (before - u);
        for (std::size_t i = 0; i < 3; ++i)
            more += p.reference[i].value() * (in[49 - i].r.position - in[49].x).value() -
                    p.feedback[i].value() * (in[49 - i].x - in[49].x).value();
        said(is - to, std::abs(more), 1e-11 * (std::abs(u) + size_of(in[49], 1e5)));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);
}

TEST_CASE(
    "retune: predictive starts from the command that it is given, by a first move of the new plan; another "
    "horizon is refused") {
    using law = predictive<12>;
    random_numbers random;
    const auto draw = [&](std::size_t horizon) {
        return law({.plant = {random.between(4, 6) * (1_mps2 / 1_V), random.between(20, 30) * per_s},
                    .weights = {{{{1e10, 0}, {0, random.between(1e4, 2e4)}}}, random.between(100, 140)},
                    .horizon = horizon,
                    .limit = 1e6 * 1_V,
                    .rate_limit = decltype(law::parameters::rate_limit)::from_value(random.decades(1, 1e3))},
                   T);
    };
    int broken = 0, whole = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        law one = draw(11);
        const law next = draw(11);
        const auto in = motion(random, 30);
        double u = 0;
        for (std::size_t k = 0; k < 29; ++k) u = give(one, in[k]);
        const double to = u + random.between(-1, 1);
        retune(one, next, in[28], to);
        const double most = next.given().rate_limit.value() * T.value(), move = give(one, in[29]) - to;
        broken += !(std::abs(move) <= most * (1 + 1e-12) + 1e-12 * std::abs(to));
        whole += std::abs(move) > 0.999 * most;
    }
    CHECK(broken == 0);
    CHECK(whole > 100);
    law one = draw(11);
    retune(one, draw(12), {}, 0);
    CHECK(one.faulted());
    CHECK(one.given().horizon == 11);
}

TEST_CASE("retune: state_feedback keeps its estimates and is off by the change of gains and model") {
    using law = state_feedback<>;
    random_numbers random;
    const auto draw = [&] {
        const axis_model<signal::voltage> plant{random.decades(0.1, 10) * (1_mps2 / 1_V),
                                                random.decades(0.1, 30) * per_s};
        return law(place_state_feedback(
                       plant, {.natural = random.decades(5, 100) * 1_Hz, .encoder_noise = 1_um}, 10_V, T),
                   T);
    };
    verdict said;
    for (int trial = 0; trial < 5000; ++trial) {
        law kept = draw(), twin = kept;
        const law next = draw();
        const auto in = motion(random, 30);
        for (std::size_t k = 0; k < 29; ++k) give(kept, in[k]), give(twin, in[k]);
        retune(kept, next, in[28], 7);
        CHECK(kept.now().x == twin.now().x);
        CHECK(kept.now().disturbance == twin.now().disturbance);
        const double was = give(twin, in[29]), is = give(kept, in[29]);
        const auto parts = [&](const law& l, const law::state& s) {
            const auto& p = l.given();
            const double B = p.plant.gain.value();
            const auto& r = in[29].r;
            return std::array{p.position_gain.value() * (r.position - s.x).value(),
                              p.velocity_gain.value() * (r.velocity - s.v).value(), r.acceleration.value() / B,
                              p.plant.viscous_rate.value() / B * r.velocity.value(), -s.disturbance.value()};
        };
        // Gains and inverse of the plant on the twin's estimates, and what the estimates differ by.
        const auto a = parts(twin, twin.now()), b = parts(next, twin.now());
        double jump = 0, size = 0;
        for (std::size_t i = 0; i < 5; ++i) jump += b[i] - a[i], size += std::abs(a[i]) + std::abs(b[i]);
        const auto& p = next.given();
        jump -= p.position_gain.value() * (kept.now().x - twin.now().x).value() +
                p.velocity_gain.value() * (kept.now().v - twin.now().v).value() +
                (kept.now().disturbance - twin.now().disturbance).value();
        said(is - was, std::abs(jump), 1e-11 * size);
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);
}

TEST_CASE("retune: linuxcnc_pid jumps by the change of its gains times what they multiply, as when its pins "
          "are set") {
    using law = linuxcnc_pid<>;
    random_numbers random;
    const auto draw = [&] {
        law::parameters p;
        p.pgain = v_per_m::from_value(random.decades(1, 1e4));
        p.igain = decltype(p.igain)::from_value(random.decades(1, 1e5));
        p.dgain = v_per_mps::from_value(random.decades(0.1, 100));
        p.ff1 = v_per_mps::from_value(random.decades(0.1, 100));
        p.bias = random.between(-1, 1) * 1_V;
        p.error_previous_target = false;
        return law(p, T);
    };
    verdict said;
    for (int trial = 0; trial < 20000; ++trial) {
        law kept = draw(), twin = kept;
        const law next = draw();
        const auto in = motion(random, 50);
        for (std::size_t k = 0; k < 49; ++k) give(kept, in[k]), give(twin, in[k]);
        retune(kept, next, in[48], 0);
        const double was = give(twin, in[49]), is = give(kept, in[49]);
        const auto parts = [&](const law& l) {
            const auto& p = l.given();
            const double dr = (in[49].r.position - in[48].r.position).value() / T.value(),
                         dy = (in[49].x - in[48].x).value() / T.value();
            return std::array{p.bias.value(), p.pgain.value() * error_of(in[49]),
                              p.igain.value() * twin.now().error_i.value(), p.dgain.value() * (dr - dy),
                              p.ff1.value() * dr};
        };
        double jump = 0, size = 0;
        const auto a = parts(twin), b = parts(next);
        for (std::size_t i = 0; i < a.size(); ++i) jump += b[i] - a[i], size += std::abs(a[i]) + std::abs(b[i]);
        said(is - was, std::abs(jump), 1e-11 * size);
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);
}

TEST_CASE("retune: feedforwards jump by the difference of both at the same input, gain_schedule too") {
    random_numbers random;
    int off = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const auto in = motion(random, 20);
        const auto compare = [&](auto kept, const auto& next, auto give) {
            for (std::size_t k = 0; k < 19; ++k) give(kept, in[k]);
            auto twin = next; // fed with the same past
            for (std::size_t k = 0; k < 19; ++k) give(twin, in[k]);
            kept.retune(next);
            const double is = give(kept, in[19]), new_one = give(twin, in[19]);
            off += !(std::abs(is - new_one) <= 1e-12 * std::abs(new_one));
        };
        const auto at_position = [](auto& b, const sample& s) { return b(s.r.position).value(); };
        const auto inverse = [&] {
            return inverse_model<signal::voltage>(
                {random.decades(0.1, 10) * (1_mps2 / 1_V), random.between(0, 30) * per_s}, T);
        };
        compare(inverse(), inverse(), [](auto& b, const sample& s) { return b(s.r).value(); });
        const auto sampled = [&] {
            return sampled_inverse_model<signal::voltage>(
                axis_model<signal::voltage>{random.decades(0.1, 10) * (1_mps2 / 1_V),
                                            random.between(0, 30) * per_s},
                T);
        };
        compare(sampled(), sampled(), at_position);
        const auto harmonics = [&] {
            return cogging_harmonics<2>(
                {random.decades(1, 50) * 1_mm, {{{1, random.between(0, 9) * 1_N, 0.3}, {3, 4_N, 1.0}}}}, T);
        };
        compare(harmonics(), harmonics(), at_position);
        const auto table = [&] {
            return cogging_table<4>(
                {random.decades(1, 50) * 1_mm, {random.between(-1, 1) * 1_N, 1_N, 2_N, -3_N}}, T);
        };
        compare(table(), table(), at_position);
        const auto friction = [&] {
            return friction_feedforward<stribeck<signal::velocity, signal::force>, signal::voltage>(
                {{122_N, 177_N, 22_mmps, random.between(1, 900) * (1_N / 1_mps)},
                 random.decades(10, 1000) * (1_N / 1_V),
                 1_mmps,
                 random.between(0.5, 1),
                 at_rest::off},
                T);
        };
        compare(friction(), friction(), [](auto& b, const sample& s) { return b(s.r.velocity).value(); });
        const auto schedule = [&] {
            return gain_schedule<signal::position, signal::velocity, signal::voltage, 2>(
                {{-1_mm, 1_mm},
                 {v_per_mps::from_value(random.between(-9, 9)), v_per_mps::from_value(random.between(-9, 9))}},
                T);
        };
        compare(schedule(), schedule(), [](auto& b, const sample& s) { return b(s.r.velocity, s.x).value(); });
        const auto ahead = [&] { return preview<6>({random.between(0, 6) * T}, T); };
        compare(ahead(), ahead(), [](auto& b, const sample& s) { return b(s.r).ahead.position.value(); });
    }
    CHECK(off == 0);
}

TEST_CASE(
    "retune: backlash_compensation goes on from where it is, no step above the new rate times the period") {
    using block = backlash_compensation<>;
    random_numbers random;
    int broken = 0;
    double most = 0;
    for (int trial = 0; trial < 20000; ++trial) { // 1e6 samples
        const auto draw = [&] {
            return block({random.decades(1e-3, 1) * 1_mm, random.decades(1e-3, 1) * 1_mps,
                          random.decades(1e-4, 1e-1) * 1_mm},
                         T);
        };
        block b = draw();
        const auto x = random.signal(50);
        double y = 0;
        for (std::size_t k = 0; k < 50; ++k) {
            if (k == 25) b.retune(draw());
            const double is = b(x[k] * 1_mm).value(), rate = b.given().rate.value() * T.value();
            broken += !(std::abs(is - y) <= rate * (1 + 1e-12));
            if (k >= 25) most = std::max(most, std::abs(is - y) / rate);
            y = is;
        }
    }
    CHECK(broken == 0);
    CHECK(most > 0.999);
}

TEST_CASE("retune: reduced_order_observer is off by the change of 2 h/(1 + h) times the formula") {
    using observer = reduced_order_observer<signal::voltage>;
    random_numbers random;
    verdict said;
    for (int trial = 0; trial < 20000; ++trial) {
        const auto draw = [&] {
            return observer(
                {.mass = 170_kg, .force_constant = 1470_N / 1_V, .corner = random.decades(1, 900) * 1_Hz}, T);
        };
        observer kept = draw(), twin = kept;
        const observer next = draw();
        const auto in = motion(random, 50);
        for (std::size_t k = 0; k < 49; ++k)
            kept(in[k].x, in[k].r.acceleration), twin(in[k].x, in[k].r.acceleration);
        kept.retune(next);
        const double v = twin.now().velocity.value(), x = twin.now().position.value(),
                     a = twin.now().accelerated.value();
        const double was = twin(in[49].x, in[49].r.acceleration).value(),
                     is = kept(in[49].x, in[49].r.acceleration).value();
        const auto share = [](const observer& o) {
            const double h = std::numbers::pi * o.given().corner.value() * T.value();
            return 2 * h / (1 + h);
        };
        const double rate = (in[49].x.value() - x) / T.value(),
                     half = T.value() / 4 * (a + in[49].r.acceleration.value());
        said(is - was, std::abs((share(next) - share(twin)) * (rate - v - half)),
             1e-12 * (std::abs(rate) + std::abs(v) + std::abs(half)));
    }
    CHECK(said.broken == 0);
    CHECK(said.most > 0.999);
    CHECK(said.most < 1.001);
}

TEST_CASE("retune: kalman and harmonic_force_observer keep their estimates; one that has converged goes on as "
          "if nothing "
          "had happened") {
    using smooth = kalman<signal::voltage>;
    const auto made = [](double drift) {
        return smooth(
            {.mass = 340_kg, .force_constant = 1450_N / 1_V, .encoder_noise = 0.07_um, .drift = drift * 1_N},
            T);
    };
    smooth one = made(20), twin = one;
    double off = 0;
    for (int k = 0; k < 6000; ++k) { // 1 m/s^2: a constant force that it does not know, after a while it does
        const double t = k * T.value();
        if (k == 3000) one.retune(made(300));
        off = std::max(off, std::abs((one(t * t / 2 * 1_m, 0.1_V) - twin(t * t / 2 * 1_m, 0.1_V)).value()));
    }
    CHECK(off <= 1e-9);
    CHECK(one.given().drift == 300_N);
    one.retune(smooth(one.given(), 2.0 * T));
    CHECK(one.faulted());

    using tones = harmonic_force_observer<signal::voltage, 1>;
    const axis_model<signal::voltage> plant{8.916_mps2 / 1_V, 20.0 / 1_s};
    const auto tuned = [&](double pole) {
        return tones({plant, {46_Hz}, placed_poles<1>::equal(pole / 1_s)}, T);
    };
    tones seen = tuned(200), same = seen;
    double x = 0, v = 0, error = 0;
    for (int k = 0; k < 6000; ++k) { // the axis under a force of 46 Hz, held over each period
        const double f = std::sin(2 * std::numbers::pi * 46 * T.value() * k);
        if (k == 3000) seen.retune(tuned(300));
        const double is = seen(x * 1_m).value(), was = same(x * 1_m).value();
        if (k >= 2900) error = std::max(error, std::abs(is - was));
        const double kept = std::exp(-20 * T.value()), gained = (1 - kept) / 20;
        x += gained * v + 8.916 * (T.value() - gained) / 20 * f;
        v = kept * v + 8.916 * gained * f;
    }
    CHECK(error <= 1e-6);
    CHECK(same.now().in_phase[0] != 0_V);
}

TEST_CASE(
    "retune: lugre_observer keeps the force of its bristles, as far as the new breakaway level bears it") {
    using observer = lugre_observer<>;
    const auto made = [](double level) {
        return observer(
            {{{level * 1_N, 1.5 * level * 1_N, 22_mmps, 0_N / 1_mps, 2}, 3.1e6 * 1_N / 1_m, 310_N / 1_mps},
             20.0 / 1_s},
            T);
    };
    observer o = made(100);
    o.settle(50_mmps);
    o.retune(made(120));
    CHECK(o.now().force.value() == doctest::Approx(100.3).epsilon(0.01));
    o.retune(made(10));
    CHECK(o.now().force == 15_N);
    o.retune(observer(o.given(), 2.0 * T));
    CHECK(o.faulted());
}

using clamped_p_pi = p_pi<double, signal::voltage, integral_clamp>;
using clamped_pid = pid<double, signal::voltage, integral_clamp>;
using clamped_sliding = sliding_mode<double, signal::voltage, integral_clamp>;
TEST_CASE_TEMPLATE(
    "retune: a feed_control whose gains and friction change gives the same command again at the same place",
    Law, clamped_p_pi, clamped_pid, clamped_sliding, lead_lag<>) {
    using friction = friction_feedforward<stribeck<signal::velocity, signal::force>, signal::voltage>;
    using boxes = feed_control_boxes<Law, friction>;
    static_assert(retunable_control_boxes<boxes>);
    const axis_model<signal::voltage> plant{0.63_mps2 / 1_V, 2.5 / 1_s};
    const auto made = [&](double hertz, double scale) {
        typename boxes::parameters p{
            .law = {},
            .friction = {{122_N, 177_N, 22_mmps, 850_N / 1_mps}, 60_N / 1_V, 1_mmps, scale},
            .limit = 100_V};
        const frequency f = hertz * 1_Hz;
        if constexpr (std::same_as<Law, lead_lag<>>)
            p.law = design_lead_lag(plant, {.crossover = f}, T);
        else if constexpr (requires { p.law.position_gain; }) {
            const auto q = place_p_pi(plant, {.natural = f}, T);
            p.law = {.position_gain = q.position_gain,
                     .gain = q.gain,
                     .integral_gain = q.integral_gain,
                     .acceleration_gain = q.acceleration_gain};
        } else if constexpr (requires { p.law.sliding; })
            p.law = {.plant = plant,
                     .sliding = 2 * std::numbers::pi * hertz * per_s,
                     .gain = v_per_mps::from_value(hertz),
                     .adaptation = v_per_m::from_value(hertz * hertz)};
        else {
            const auto q = place_pid(plant, {f});
            p.law = {.gain = q.gain, .integral_gain = q.integral_gain, .derivative_gain = q.derivative_gain};
        }
        return boxes(p, T);
    };
    feed_control<boxes> loop{.box = made(20, 1)};
    const axis_motion<> resting{10_mm};
    const axis_measurement<> on_it{10_mm};
    loop.settle(10_mm, 3_V);
    CHECK(loop(resting, on_it).value() == doctest::Approx(3));
    loop.retune(made(30, 0.5));
    CHECK(loop(resting, on_it).value() == doctest::Approx(3));
    // In even motion, a constant error: what the integral adds in a sample is left.
    for (int k = 0; k < 50; ++k) {
        const auto x = 10_mm + double(k) * 0.01_mm;
        loop({x, 20_mmps}, {x - 1_um, 20_mmps});
    }
    const double before = loop.wire.command.value();
    loop.retune(made(15, 1));
    const auto x = 10_mm + 50.0 * 0.01_mm;
    CHECK(std::abs(loop({x, 20_mmps}, {x - 1_um, 20_mmps}).value() - before) <= 0.02);
    CHECK_FALSE(loop.faulted());
}
