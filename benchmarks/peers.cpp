// SPDX-License-Identifier: BSL-1.0
// Long: each block beside its peers; all() is their list.
// usage: peers list            numbers and names; exit code 1 when two of one group do not give the same
//        peers I SAMPLES       runs number I; peers.sh counts the instructions
//        peers times           nanoseconds a sample of each, CPU time, the shortest of 60 runs
// The same small filter, law or limit by this library, by plain C, and by what others use: LinuxCNC's
// components, liquid-dsp's second-order section (float) and Eigen's state space where they are installed, and
// the published forms of what is in no Debian package: iir1's direct form II, CMSIS-DSP's
// arm_biquad_cascade_df2T_f64, wpimath's LinearFilter, PIDController and SlewRateLimiter. One sample a call.
#include "hal_chain.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/linuxcnc_pid.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/rate_limiter.hpp>
#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <time.h>
#include <vector>
#if __has_include(<Eigen/Core>)
#    include <Eigen/Core>
#    define QUADRANT_PEER_EIGEN
#endif
#ifdef QUADRANT_PEER_LIQUID // C with complex numbers of its own: peers.sh links it where it is installed
#    include <complex>
#    include <liquid/liquid.h>
#endif

namespace {

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

constexpr duration T = 500_us;
constexpr double h = 0.0005;
const std::vector<double>& input() {
    static const std::vector<double> x = [] {
        std::vector<double> all(20'000);
        std::uint64_t bits = 20081124;
        for (double& each : all) {
            bits = bits * 6364136223846793005u + 1442695040888963407u;
            each = double(bits >> 11) * 0x1p-53 - 0.5;
        }
        return all;
    }();
    return x;
}
template <class Step> [[gnu::noinline, gnu::flatten]] double sample(Step& step, double x) { return step(x); }
template <class Step> double run(Step& step, std::size_t n) {
    const double* const x = input().data();
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += sample(step, x[k]);
    return sum;
}

// ---- a notch of 330 Hz ----
struct coefficients {
    double b0, b1, b2, a1, a2;
};
coefficients notch_at_330_Hz() {
    const double t = std::tan(std::numbers::pi * 330 * h), a0 = 1 + 0.1 * t + t * t;
    const double ends = (1 + t * t) / a0, middle = 2 * (t * t - 1) / a0;
    return {ends, middle, ends, middle, (1 - 0.1 * t + t * t) / a0};
}
struct plain_section {
    coefficients c = notch_at_330_Hz();
    double s0 = 0, s1 = 0;
    double operator()(double x) {
        const double y = c.b0 * x + s0;
        s0 = c.b1 * x - c.a1 * y + s1;
        s1 = c.b2 * x - c.a2 * y;
        return y;
    }
};
/// iir1, DirectFormII.
struct direct_form_2 {
    coefficients c = notch_at_330_Hz();
    double v1 = 0, v2 = 0;
    double operator()(double x) {
        const double w = x - c.a1 * v1 - c.a2 * v2, out = c.b0 * w + c.b1 * v1 + c.b2 * v2;
        v2 = v1, v1 = w;
        return out;
    }
};
/// CMSIS-DSP, arm_biquad_cascade_df2T_f64: any number of sections over a block of samples, here one of each.
struct cascade_df2t {
    struct instance {
        std::uint8_t sections;
        double* state;
        const double* coefficients;
    };
    std::array<double, 5> b;
    std::array<double, 2> d{};
    cascade_df2t() {
        const coefficients c = notch_at_330_Hz();
        b = {c.b0, c.b1, c.b2, -c.a1, -c.a2};
    }
    [[gnu::noinline]] static void filter(const instance* s, const double* in, double* out,
                                         std::uint32_t block) {
        double* state = s->state;
        const double* b = s->coefficients;
        for (std::uint32_t section = s->sections; section > 0; --section, b += 5, state += 2, in = out) {
            double d1 = state[0], d2 = state[1];
            for (std::uint32_t k = 0; k < block; ++k) {
                const double x = in[k], y = b[0] * x + d1;
                d1 = b[1] * x + b[3] * y + d2;
                d2 = b[2] * x + b[4] * y;
                out[k] = y;
            }
            state[0] = d1, state[1] = d2;
        }
    }
    double operator()(double x) {
        const instance one{1, d.data(), b.data()};
        double y;
        filter(&one, &x, &y, 1);
        return y;
    }
};
/// wpimath, LinearFilter: sums over two rings, the newest in front.
template <int Inputs, int Outputs> struct linear_filter {
    template <int N> struct ring {
        std::array<double, std::size_t(N)> data{};
        std::size_t front = 0;
        void push_front(double x) {
            front = (front == 0 ? std::size_t(N) : front) - 1;
            data[front] = x;
        }
        double operator[](int i) const { return data[(front + std::size_t(i)) % std::size_t(N)]; }
    };
    std::array<double, std::size_t(Inputs)> in_gain;
    std::array<double, std::size_t(Outputs)> out_gain;
    ring<Inputs> in{};
    ring<Outputs> out{};
    double operator()(double x) {
        double y = 0;
        in.push_front(x);
        for (int i = 0; i < Inputs; ++i) y += in[i] * in_gain[std::size_t(i)];
        for (int i = 0; i < Outputs; ++i) y -= out[i] * out_gain[std::size_t(i)];
        out.push_front(y);
        return y;
    }
};
#ifdef QUADRANT_PEER_EIGEN
struct state_space {
    Eigen::Matrix2d A;
    Eigen::Vector2d B, x = Eigen::Vector2d::Zero();
    Eigen::RowVector2d C;
    double D;
    state_space() {
        const coefficients c = notch_at_330_Hz();
        A << -c.a1, 1, -c.a2, 0;
        B << c.b1 - c.a1 * c.b0, c.b2 - c.a2 * c.b0;
        C << 1, 0;
        D = c.b0;
    }
    double operator()(double u) {
        const double y = C * x + D * u;
        x = (A * x + B * u).eval();
        return y;
    }
};
#endif
#ifdef QUADRANT_PEER_LIQUID
struct by_liquid {
    iirfilt_rrrf filter;
    by_liquid() {
        const coefficients c = notch_at_330_Hz();
        float b[3] = {float(c.b0), float(c.b1), float(c.b2)}, a[3] = {1, float(c.a1), float(c.a2)};
        filter = iirfilt_rrrf_create(b, 3, a, 3);
    }
    double operator()(double x) {
        float y;
        iirfilt_rrrf_execute(filter, float(x), &y);
        return double(y);
    }
};
#endif

/// A LinuxCNC component with one input and one output.
struct component {
    volatile double *in, *out;
    void (*call)(void*, long);
    void* argument;
    component(const std::string& name, const std::string& function, const char* input = ".in",
              const char* output = ".out") {
        in = hal::net({name + input});
        out = hal::net({name + output});
        std::tie(call, argument) = hal::at(hal::known().functions, function);
    }
    double operator()(double x) {
        *in = x;
        call(argument, 500'000);
        return *out;
    }
};

// ---- other laws, by hand ----
struct plain_lowpass {
    double gain, y = 0;
    double operator()(double x) { return y += (x - y) * gain; }
};
constexpr double p_gain = 701, i_gain = 8000, d_gain = 3.1;
struct plain_pid { // the sum counts the newest error, as LinuxCNC's
    double sum = 0, last = 0;
    double operator()(double e) {
        sum += e * h;
        const double d = (e - last) / h;
        last = e;
        return p_gain * e + i_gain * sum + d_gain * d;
    }
};
/// wpimath, PIDController: Calculate(measurement) towards 0.
struct pid_controller {
    double previous = 0, total = 0, error = 0, error_rate = 0, measurement = 0;
    bool continuous = false, have_measurement = false, have_setpoint = true;
    double i_zone = HUGE_VAL, low = -1e9, high = 1e9;
    double operator()(double e) {
        measurement = -e;
        previous = error;
        have_measurement = true;
        error = continuous ? std::remainder(-measurement, 1) : 0.0 - measurement;
        error_rate = (error - previous) / h;
        if (std::abs(error) > i_zone)
            total = 0;
        else if (i_gain != 0)
            total = std::clamp(total + error * h, low / i_gain, high / i_gain);
        return p_gain * error + i_gain * total + d_gain * error_rate;
    }
};

template <class Block> auto of(Block block) { // a block of one wire
    return [block](double x) mutable { return block(Block::argument::from_value(x)).value(); };
}
template <class Law> auto on_error(Law law) {
    return [law](double e) mutable {
        return law({.position = quantity_of<s::position>::from_value(e)}, quantity_of<s::position>(),
                   quantity_of<s::velocity>())
            .value();
    };
}

/// add(group, name, what may differ, what makes the step), always in the same order.
template <class Add> void all(bool linuxcnc, Add&& add) {
    const double gain = 1 - std::exp(-2 * std::numbers::pi * 100 * h);
    add("notch", "quadrant notch", 0, [] { return of(notch<s::voltage>({330_Hz, 0.1}, T)); });
    add("notch", "plain C, transposed form", 1e-11, [] { return plain_section(); });
#ifdef QUADRANT_PEER_EIGEN
    add("notch", "Eigen, state space", 1e-11, [] { return state_space(); });
#endif
    if (linuxcnc)
        add("notch", "LinuxCNC biquad", 1e-11, [] {
            const coefficients c = notch_at_330_Hz();
            for (const auto& [pin, to] :
                 {std::pair{"n0", c.b0}, {"n1", c.b1}, {"n2", c.b2}, {"d1", c.a1}, {"d2", c.a2}})
                hal::set(std::string("biquad.0.") + pin, to);
            hal::set_bit("biquad.0.enable", true);
            return component("biquad.0", "biquad.0");
        });
#ifdef QUADRANT_PEER_LIQUID
    add("notch", "liquid-dsp iirfilt_rrrf (float)", 1e-4, [] { return by_liquid(); });
#endif
    add("notch", "form of iir1 (direct form II)", 1e-11, [] { return direct_form_2(); });
    add("notch", "form of CMSIS-DSP df2T_f64", 1e-11, [] { return cascade_df2t(); });
    add("notch", "form of wpimath LinearFilter", 1e-11, [] {
        const coefficients c = notch_at_330_Hz();
        return linear_filter<3, 2>{{c.b0, c.b1, c.b2}, {c.a1, c.a2}};
    });

    add("low pass", "quadrant lowpass (bilinear)", HUGE_VAL,
        [] { return of(lowpass<s::voltage>({100_Hz}, T)); });
    add("low pass", "plain C", 0, [=] { return plain_lowpass{gain}; });
    if (linuxcnc)
        add("low pass", "LinuxCNC lowpass", 1e-12, [=] {
            hal::set("lowpass.0.gain", gain);
            return component("lowpass.0", "lowpass.0");
        });
    add("low pass", "form of wpimath LinearFilter", 1e-12, [=] {
        return linear_filter<1, 1>{{gain}, {gain - 1}};
    });

    add("PID", "quadrant pid (filtered D)", HUGE_VAL, [] {
        return on_error(pid<>({.gain = 701_V / 1_m,
                               .integral_gain = 8000.0 * 1_V / (1_m * 1_s),
                               .derivative_gain = 3.1_V / 1_mps,
                               .derivative_corner = 200_Hz},
                              T));
    });
    add("PID", "quadrant linuxcnc_pid", 0, [] {
        return on_error(linuxcnc_pid<>({.pgain = 701_V / 1_m,
                                        .igain = 8000.0 * 1_V / (1_m * 1_s),
                                        .dgain = 3.1_V / 1_mps,
                                        .error_previous_target = false},
                                       T));
    });
    add("PID", "plain C", 1e-7, [] { return plain_pid(); });
    if (linuxcnc)
        add("PID", "LinuxCNC pid", 1e-7, [] {
            hal::set("pid.0.Pgain", p_gain);
            hal::set("pid.0.Igain", i_gain);
            hal::set("pid.0.Dgain", d_gain);
            hal::set_bit("pid.0.error-previous-target", false);
            hal::set_bit("pid.0.enable", true);
            component law("pid.0", "pid.0.do-pid-calcs", ".command", ".output");
            law(0); // the first call only enables it
            return law;
        });
    add("PID", "form of wpimath PIDController", 1e-7, [] { return pid_controller(); });

    add("limit", "quadrant limiter", 0, [] { return of(limiter<s::voltage>({-0.3_V, 0.3_V}, T)); });
    add("limit", "plain C", 0, [] { return [](double x) { return std::min(std::max(x, -0.3), 0.3); }; });
    if (linuxcnc)
        add("limit", "LinuxCNC limit1", 0, [] {
            hal::set("limit1.0.min", -0.3);
            hal::set("limit1.0.max", 0.3);
            return component("limit1.0", "limit1.0");
        });

    add("slope limit", "quadrant rate_limiter", 0,
        [] { return of(rate_limiter<s::voltage>({300_V / 1_s}, T)); });
    add("slope limit", "form of wpimath SlewRateLimiter", 1e-12,
        [] { return [y = 0.0](double x) mutable { return y += std::clamp(x - y, -300 * h, 300 * h); }; });
    if (linuxcnc)
        add("slope limit", "LinuxCNC limit2", 1e-12, [] {
            hal::set("limit2.0.min", -1e9);
            hal::set("limit2.0.max", 1e9);
            hal::set("limit2.0.maxv", 300);
            return component("limit2.0", "limit2.0");
        });

    add("derivative", "quadrant backward_difference", 0,
        [] { return of(backward_difference<s::position, s::velocity>({}, T)); });
    add("derivative", "plain C", 1e-9,
        [] { return [last = 0.0](double x) mutable { return (x - std::exchange(last, x)) / h; }; });
    if (linuxcnc) add("derivative", "LinuxCNC ddt", 1e-9, [] { return component("ddt.0", "ddt.0"); });
}

/// Within a group everything gives what the first one gives that is not said to be another law.
bool agree(bool linuxcnc) {
    bool good = true;
    std::string of_group;
    std::vector<double> first;
    all(linuxcnc, [&](const char* group, const char* name, double may_differ, auto make) {
        if (of_group != group) of_group = group, first.clear();
        auto step = make();
        std::vector<double> y(input().size());
        for (std::size_t k = 0; k < y.size(); ++k) y[k] = sample(step, input()[k]);
        if (may_differ == HUGE_VAL) return;
        if (first.empty()) return void(first = y);
        double off = 0;
        for (std::size_t k = 0; k < y.size(); ++k) off = std::max(off, std::abs(y[k] - first[k]));
        if (off <= may_differ) return;
        std::fprintf(stderr, "%s: %s is off by %g\n", group, name, off);
        good = false;
    });
    return good;
}
double cpu_ns() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * double(t.tv_sec) + double(t.tv_nsec);
}
bool has_linuxcnc() {
    try {
        for (const char* each : {"biquad", "lowpass", "limit1", "limit2", "ddt"}) hal::load(each, "count", 1);
        hal::load("pid", "num_chan", 1);
        return true;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "LinuxCNC's components are left out: %s (Debian package linuxcnc-uspace)\n",
                     e.what());
        return false;
    }
}

} // namespace

int main(int argc, char** argv) {
    const bool linuxcnc = has_linuxcnc();
    const std::string_view what = argc > 1 ? argv[1] : "";
    int at = 0;
    if (what == "list") {
        all(linuxcnc, [&](const char* group, const char* name, double, auto) {
            std::printf("%d|%s|%s\n", at++, group, name);
        });
        return agree(linuxcnc) ? 0 : 1;
    }
    if (what == "times") {
        all(linuxcnc, [&](const char*, const char*, double, auto make) {
            double best = HUGE_VAL, sum = 0;
            for (int k = 0; k < 60; ++k) {
                auto step = make();
                const double begin = cpu_ns();
                sum += run(step, input().size());
                best = std::min(best, cpu_ns() - begin);
            }
            std::printf("%d|%.1f|%g\n", at++, best / double(input().size()), sum);
        });
        return 0;
    }
    if (argc == 3) {
        const int wanted = std::atoi(argv[1]);
        const std::size_t n = std::min<std::size_t>(std::strtoul(argv[2], nullptr, 10), input().size());
        all(linuxcnc, [&](const char*, const char*, double, auto make) {
            if (at++ != wanted) return;
            auto step = make();
            std::printf("%.17g\n", run(step, n));
        });
        return 0;
    }
    std::fprintf(stderr, "usage: peers list, peers I SAMPLES, or peers times\n");
    return 2;
}
