// SPDX-License-Identifier: BSL-1.0
// usage: sub_steps typed|motor|plain|plain_as_accurate SECONDS [standing]     simulates so many seconds of an
//                                           axis on Stribeck friction with a period of 500 us; sub_steps.sh
//                                           counts the instructions. Standing: no command after a second
//        sub_steps errors                   how far each is from itself with 1000 sub-steps, over 20 s, in um
//        sub_steps times                    CPU time of each, and how many times real time that is
// typed: `stick_slip` alone, in a loop of 25 sub-steps. motor: `linear_motor`, with delay, limit, DAC and
// encoder, 25. plain: C as one writes it, semi-implicit, 25: the level of the old velocity, mass and viscous
// friction implicit, the axis held at rest. plain_as_accurate: the same with 48, as many as it takes for the
// error of typed.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <time.h>
#include <vector>

namespace {

using namespace quadrant;
using namespace quadrant::literals;

constexpr std::size_t sub_steps = 25, as_accurate = 48, samples_of_a_second = 2000;
const duration period = 500_us;
const stribeck<>::parameters friction{122_N, 177_N, 1_mps / 450.0, 850_N / 1_mps};

/// Volts on 1450 N/V that drive the axis back and forth, slowly enough that it stops on the way.
double command(std::size_t k) {
    const double t = double(k) / double(samples_of_a_second);
    return 0.2 * std::sin(2 * std::numbers::pi * 0.7 * t) + 0.05 * std::sin(2 * std::numbers::pi * 1.9 * t);
}

struct typed {
    explicit typed(std::size_t n) : n_(n), h_(period / double(n)) {}
    [[gnu::noinline]] double step(double u) noexcept {
        const quantity_of<signal::force> drive = force_constant * (u * 1_V);
        auto&& friction_now = in_sub_steps(law);
        for (std::size_t i = 0; i < n_; ++i) {
            const auto next = stick_slip<double>(friction_now, mass, v, drive, h_);
            x += (v + next) * (h_ * 0.5);
            v = next;
        }
        return x.value();
    }

private:
    static constexpr quantity<si::mass> mass = 340_kg;
    const gain_of<signal::force, signal::voltage> force_constant = 1450_N / 1_V;
    stribeck<> law{friction, period};
    quantity_of<signal::position> x{};
    quantity_of<signal::velocity> v{};
    std::size_t n_;
    duration h_;
};

struct motor {
    explicit motor(std::size_t n)
        : axis({.mass = 340_kg, .force_constant = 1450_N / 1_V, .friction = friction, .substeps = n}, period) {}
    [[gnu::noinline]] double step(double u) noexcept { return axis(u * 1_V).value(); }

private:
    linear_motor<stribeck<>, 4> axis;
};

struct plain {
    explicit plain(std::size_t n) : n_(n), h(period.value() / double(n)), inertia(340 / h), k(inertia + 850) {}
    [[gnu::noinline]] double step(double u) noexcept {
        const double drive = 1450 * u;
        for (std::size_t i = 0; i < n_; ++i) {
            const double level = 122 + 55 * std::exp(-std::fabs(v) * 450), push = inertia * v + drive;
            double next = 0;
            if (v != 0 || std::fabs(push) > 177) {
                next = push > 0 ? (push - level) / k : (push + level) / k;
                if (next * push < 0) next = 0;
            }
            x += (v + next) * (h * 0.5);
            v = next;
        }
        return x;
    }

private:
    double x = 0, v = 0;
    std::size_t n_;
    double h, inertia, k;
};

template <class Axis> std::vector<double> path(std::size_t n, std::size_t seconds, bool stands = false) {
    Axis axis(n);
    std::vector<double> x(seconds * samples_of_a_second);
    for (std::size_t k = 0; k < x.size(); ++k)
        x[k] = axis.step(stands && k >= samples_of_a_second ? 0 : command(k));
    return x;
}
/// In um.
template <class Axis> double error(std::size_t n = sub_steps) {
    const auto fine = path<Axis>(1000, 20), coarse = path<Axis>(n, 20);
    double most = 0;
    for (std::size_t k = 0; k < fine.size(); ++k) most = std::max(most, std::abs(fine[k] - coarse[k]));
    return 1e6 * most;
}
double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
template <class Axis> void time_of(const char* name, std::size_t n = sub_steps) {
    std::vector<double> u(20 * samples_of_a_second);
    for (std::size_t k = 0; k < u.size(); ++k) u[k] = command(k);
    double best = 1e9, sum = 0;
    for (int run = 0; run < 20; ++run) {
        Axis axis(n);
        const double begin = cpu_seconds();
        for (const double each : u) sum += axis.step(each);
        best = std::min(best, cpu_seconds() - begin);
    }
    std::printf("%s: %.1f ns a sub-step, %.0f times real time, CPU time, the shortest of 20 runs (%.3g)\n",
                name, 1e9 * best / double(u.size() * n), 20 / best, sum);
}
template <class Axis> int run(std::size_t seconds, bool stands, std::size_t n = sub_steps) {
    std::printf("%.17g\n", path<Axis>(n, seconds, stands).back());
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::string_view which = argc > 1 ? argv[1] : "";
    const std::size_t seconds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
    const bool stands = argc > 3 && std::string_view(argv[3]) == "standing";
    if (seconds > 0 && which == "typed") return run<typed>(seconds, stands);
    if (seconds > 0 && which == "motor") return run<motor>(seconds, stands);
    if (seconds > 0 && which == "plain") return run<plain>(seconds, stands);
    if (seconds > 0 && which == "plain_as_accurate") return run<plain>(seconds, stands, as_accurate);
    if (which == "errors") {
        std::printf("typed %.3f\nmotor %.3f\nplain %.3f\nplain_as_accurate %.3f\n", error<typed>(),
                    error<motor>(), error<plain>(), error<plain>(as_accurate));
        return 0;
    }
    if (which == "times") {
        time_of<typed>("typed");
        time_of<motor>("motor");
        time_of<plain>("plain");
        time_of<plain>("plain_as_accurate", as_accurate);
        return 0;
    }
    std::fprintf(
        stderr,
        "usage: sub_steps typed|motor|plain|plain_as_accurate SECONDS [standing], or errors, or times\n");
    return 2;
}
