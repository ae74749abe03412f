// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
namespace s = quadrant::signal;
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
const axis_model<s::voltage> y{8.916_mps2 / 1_V, 20.0 / 1_s}; // [Jamaludin2008] Table 2.1
template <std::size_t N> using observer = harmonic_force_observer<s::voltage, N>;
template <std::size_t N> using placed = placed_poles<N>;
const std::array two{46_Hz, 69_Hz};

/// The axis behind a DAC and a delay of whole periods, exact for a held command; a push that is held too.
class plant {
public:
    explicit plant(std::size_t delay = 0) : past_(delay + 1, 0.0) {}
    void step(double u, double push) {
        past_.insert(past_.begin(), u);
        past_.pop_back();
        const double a = 20, h = T.value(), e = std::exp(-a * h), to = 8.916 * (past_.back() + push) / a;
        x += to * h + (v - to) * (1 - e) / a;
        v = to + (v - to) * e;
    }
    double x = 0, v = 0;

private:
    std::vector<double> past_;
};

/// The thesis' y axis in its loop (without notch), the observer in it; error over time [m]. The observer gets
/// the command `late` periods late.
template <class Observer>
std::vector<double> errors(Observer ob, std::size_t delay, std::size_t late, const std::vector<double>& push) {
    plant p(delay);
    proportional_integral<s::velocity, s::voltage> velocity_loop{{30_V / 1_mps, 250_V / 1_m, 1e30_V}, T};
    delay_line<s::voltage, 8> acting{{late}, T};
    std::vector<double> e;
    auto command = 0_V;
    for (const double f : push) {
        const auto z = p.x * 1_m;
        const auto d = ob(z, acting(command)); // z^-1: the command of the last cycle
        command = velocity_loop(150.0 / 1_s * (0_m - z) - p.v * 1_mps) - d;
        p.step(command.value(), f);
        e.push_back(p.x);
        if (!(std::abs(p.x) < 1)) break;
    }
    return e;
}
std::vector<double> forces(const std::vector<double>& hertz, std::size_t samples) {
    std::vector<double> f(samples);
    for (std::size_t k = 0; k < samples; ++k)
        for (std::size_t i = 0; i < hertz.size(); ++i)
            f[k] += 0.05 * std::cos(2 * pi * hertz[i] * double(k) * T.value() + double(i));
    return f;
}
double last_peak(const std::vector<double>& e, std::size_t samples = 400) {
    double most = 0;
    for (std::size_t k = e.size() - std::min(samples, e.size()); k < e.size(); ++k)
        most = std::max(most, std::abs(e[k]));
    return most;
}
struct no_observer { // an observer that is not there
    quantity_of<s::voltage> operator()(quantity_of<s::position>, quantity_of<s::voltage>) { return 0_V; }
};
bool stable(const std::vector<double>& e) {
    return e.size() == 8000 && last_peak(e) < 1e-3 * last_peak({e.begin(), e.begin() + 1000}, 1000);
}
std::vector<double> knock() {
    std::vector<double> f(8000);
    f[0] = 1;
    return f;
}
} // namespace

TEST_CASE("harmonic_force_observer: the gain is that of scipy's pole placement") {
    // F: scipy.linalg.expm of the axis and its held command over 0.5 ms, and the rotation by 46 Hz; states
    // scaled by D=diag(1,T,B T^2,B T^2); Lp=scipy.signal.place_poles(F.T, C.T,
    // exp([-150+100j,-150-100j,-200,-260]*T)).gain_matrix.T; inv(D) inv(F) Lp
    constexpr std::array L{0.3092656693626454, 51.61555689103484, -1659.8150771293806, -1482.9828335788309};
    placed<1> design{{std::complex{-150.0, 100.0}, {-150, -100}, {-200, 0}, {-260, 0}}};
    observer<1> ob{{y, {46_Hz}, design}, T};
    ob(1_m); // from rest at zero, the first reading moves every state by its gain
    CHECK(ob.now().position.value() == Approx(L[0]).epsilon(1e-9));
    CHECK(ob.now().velocity.value() == Approx(L[1]).epsilon(1e-9));
    CHECK(ob.now().in_phase[0].value() == Approx(L[2]).epsilon(1e-9));
    CHECK(ob.now().across[0].value() == Approx(L[3]).epsilon(1e-9));
    CHECK(ob.radius() == Approx(std::exp(-150 * T.value())).epsilon(1e-9));
}
TEST_CASE("harmonic_force_observer: the gain from noise is that of scipy's Riccati solution") {
    // the same F; s=.25e-6/sqrt(12), Q=diag(0,0,1,1)*.5^2*T*(B T^2/s)^2, P=scipy.linalg.solve_discrete_are(F.T,
    // C.T, Q, [[1]]), inv(D) P[:,:1]/(P[0,0]+1)
    constexpr std::array K{0.7784274352029832, 1120.220211741371, 98946.84858317021, 29068.957079949563};
    using noisy = harmonic_force_observer<s::voltage, 1, expected_noise<s::voltage>>;
    noisy ob{{y, {46_Hz}, {0.25_um / std::sqrt(12.0), 0.5_V}}, T};
    ob(1_m);
    CHECK(ob.now().position.value() == Approx(K[0]).epsilon(1e-8));
    CHECK(ob.now().velocity.value() == Approx(K[1]).epsilon(1e-8));
    CHECK(ob.now().in_phase[0].value() == Approx(K[2]).epsilon(1e-8));
    CHECK(ob.now().across[0].value() == Approx(K[3]).epsilon(1e-8));
    CHECK(ob.radius() == Approx(0.8649864768567784).epsilon(1e-9));
}
TEST_CASE("harmonic_force_observer: finds two harmonics, each by itself, whatever is commanded") {
    observer<2> ob{{y, two, placed<2>::equal(200.0 / 1_s)}, T};
    plant p;
    double u = 0;
    const auto tone = [](double f, int k) { return std::cos(2 * pi * f * k * T.value()); };
    for (int k = 0; k < 800; ++k) {
        ob(p.x * 1_m, u * 1_V);
        if (k > 400) { // 0.2 s: exp(-40)
            CHECK(ob.harmonic(0).value() == Approx(0.3 * tone(46, k)).epsilon(1e-6).scale(1));
            CHECK(ob.harmonic(1).value() == Approx(-0.1 * tone(69, k)).epsilon(1e-6).scale(1));
        }
        u = std::sin(0.05 * k);
        p.step(u, 0.3 * tone(46, k) - 0.1 * tone(69, k));
    }
}
TEST_CASE("harmonic_force_observer: in the loop nothing but rounding is left of forces at its frequencies, "
          "some -300 dB") {
    observer<2> ob{{y, two, placed<2>::equal(200.0 / 1_s)}, T};
    // In time: a peak of some micrometres goes to rounding.
    const auto push = forces({46, 69}, 8000);
    const double without = last_peak(errors(no_observer{}, 0, 0, push)),
                 with = last_peak(errors(ob, 0, 0, push));
    CHECK(without > 5e-6);
    CHECK(with < 1e-10 * without);
    // In frequency: u = wanted - Hz z - Hu u z^-1, so a force is multiplied by 1 + Hu z^-1 and what remains of
    // the loop.
    for (const frequency& f : two) {
        const auto hu = ob.response_to_command(f) * std::polar(1.0, -2 * pi * f.value() * T.value());
        CHECK(20 * std::log10(std::abs(1.0 + hu) + 1e-300) < -280);
    }
    const auto between = ob.response_to_command(57_Hz) * std::polar(1.0, -2 * pi * 57 * T.value());
    CHECK(std::abs(1.0 + between) > 0.02);
}
TEST_CASE("harmonic_force_observer: with the delay of the axis equal poles at 75 to 110 1/s destabilise the "
          "loop, at 150 not") {
    for (const double decay : {75.0, 100.0, 110.0})
        CHECK_FALSE(stable(errors(observer<2>{{y, two, placed<2>::equal(decay / 1_s)}, T}, 1, 0, knock())));
    for (const double decay : {150.0, 200.0, 300.0})
        CHECK(stable(errors(observer<2>{{y, two, placed<2>::equal(decay / 1_s)}, T}, 1, 0, knock())));
    // Shifted poles need no such care.
    for (const double decay : {25.0, 75.0, 150.0})
        CHECK(stable(errors(observer<2>{{y, two, placed<2>::shifted(two, decay / 1_s)}, T}, 1, 0, knock())));
}
TEST_CASE("harmonic_force_observer: 15 harmonics on a delayed axis need the lead; with it nothing is left") {
    std::array<frequency, 15> all;
    std::vector<double> hertz;
    for (std::size_t i = 0; i < 15; ++i) {
        hertz.push_back(23.294 * double(i + 1));
        all[i] = hertz.back() * 1_Hz;
    }
    const auto design = placed<15>::shifted(all, 75.0 / 1_s);
    CHECK_FALSE(stable(errors(observer<15>{{y, all, design}, T}, 1, 0, knock())));
    const observer<15> ahead{{y, all, design, T}, T};
    CHECK(stable(errors(ahead, 1, 1, knock())));
    const auto push = forces(hertz, 8000);
    CHECK(last_peak(errors(ahead, 1, 1, push)) < 1e-9 * last_peak(errors(no_observer{}, 1, 1, push)));
}
TEST_CASE("harmonic_force_observer: a bad sample holds the sum and changes no state") {
    observer<2> ob{{y, two, placed<2>::equal(200.0 / 1_s)}, T};
    ob(1_um, 1_V);
    const auto last = ob(3_um, 1_V);
    const auto before = ob.now();
    CHECK(ob(std::nan("") * 1_m) == last);
    CHECK(ob(1_um, std::nan("") * 1_V) == last);
    CHECK(ob.faulted());
    CHECK(ob.now().across[1] == before.across[1]);
    CHECK(ob.now().position == before.position);
    ob.settle(0.4_m);
    for (int k = 0; k < 10; ++k) CHECK(ob(0.4_m) == 0_V);
}
TEST_CASE("harmonic_force_observer: refuses frequencies, poles and plants that leave no stable observer") {
    const auto good = placed<2>::equal(200.0 / 1_s);
    CHECK_THROWS_WITH_AS(
        (observer<2>{{y, {46_Hz, 1000_Hz}, good}, T}),
        "harmonic_force_observer.harmonics = 1000 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
        invalid_parameter);
    CHECK_THROWS_WITH_AS((observer<2>{{y, {46_Hz, 46_Hz}, good}, T}),
                         "harmonic_force_observer.harmonics = 46 Hz: must not be there twice",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS(
        (observer<2>{{y, two, placed<2>::equal(-10.0 / 1_s)}, T}),
        "harmonic_force_observer.design.poles = 10 per s: must be finite and left of the imaginary axis",
        invalid_parameter);
    auto single = good;
    single.poles[0] = {-100, 50};
    CHECK_THROWS_WITH_AS((observer<2>{{y, two, single}, T}),
                         "harmonic_force_observer.design.poles = 50 per s: must come in conjugate pairs",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS(
        (observer<2>{{axis_model<s::voltage>{y.gain}, two, good}, T}),
        "harmonic_force_observer.plant.viscous_rate = 0 per s: must be above 0 for placed poles (or "
        "use expected_noise)",
        invalid_parameter);
    CHECK_THROWS_AS((observer<2>{{axis_model<s::voltage>{}, two, good}, T}), invalid_parameter);
    CHECK_THROWS_AS((observer<2>{{y, two, good, -1_ms}, T}), invalid_parameter);
    // 32 equal poles: beyond what double can place; said, not run.
    std::array<frequency, 15> all;
    for (std::size_t i = 0; i < 15; ++i) all[i] = 23.294 * double(i + 1) * 1_Hz;
    CHECK_THROWS_WITH_AS((observer<15>{{y, all, placed<15>::equal(150.0 / 1_s)}, T}),
                         doctest::Contains("leaves an eigenvalue at or outside the unit circle"),
                         invalid_parameter);
    using noisy = harmonic_force_observer<s::voltage, 2, expected_noise<s::voltage>>;
    CHECK_THROWS_AS((noisy{{y, two, {0_m, 0.5_V}}, T}), invalid_parameter);
    CHECK_THROWS_AS((noisy{{y, two, {1_um, 0_V}}, T}), invalid_parameter);
    CHECK_NOTHROW((noisy{{axis_model<s::voltage>{y.gain}, two, {1_um, 1_V}}, T})); // no damping needed
}
