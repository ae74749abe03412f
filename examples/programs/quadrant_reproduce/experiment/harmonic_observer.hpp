// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../milling_table.hpp"
#include "../push_run.hpp"
#include "harmonics.hpp"

#include <Eigen/Dense>

namespace quadrant_reproduce {

/// Eqs. (D.3), (D.11), (D.15) in continuous time, with L from poles by Ackermann's formula.
class force_observer_loop {
public:
    using complex = std::complex<double>;
    force_observer_loop(const thesis::axis& a, const std::vector<double>& hertz, double decay)
        : axis_(a), F_(Eigen::MatrixXd::Zero(size(hertz), size(hertz))), G_(Eigen::VectorXd::Zero(size(hertz))),
          H_(Eigen::RowVectorXd::Zero(size(hertz))) {
        F_(0, 1) = 1, F_(1, 1) = -a.A.value(), G_(1) = a.B.value();
        for (std::size_t i = 0; i < hertz.size(); ++i) {
            const auto q = Eigen::Index(2 + 2 * i);
            const double w = 2 * thesis::pi_ * hertz[i];
            F_(1, q) = a.B.value(), F_(q, q + 1) = 1, F_(q + 1, q) = -w * w, H_(q) = 1;
        }
        // Harmonics as they are and both other poles at zero, all shifted left by the decay.
        Eigen::MatrixXd shifted = Eigen::MatrixXd::Identity(F_.rows(), F_.rows());
        const auto one = shifted;
        for (int i = 0; i < 2; ++i) shifted = shifted * (F_ + decay * one);
        for (const double f : hertz) {
            const double w = 2 * thesis::pi_ * f;
            shifted = shifted * (F_ * F_ + 2 * decay * F_ + (decay * decay + w * w) * one);
        }
        Eigen::MatrixXd sees(F_.rows(), F_.rows());
        Eigen::RowVectorXd line = Eigen::RowVectorXd::Unit(F_.rows(), 0);
        for (Eigen::Index i = 0; i < F_.rows(); ++i, line = line * F_) sees.row(i) = line;
        L_ = shifted * sees.inverse() * Eigen::VectorXd::Unit(F_.rows(), F_.rows() - 1);
    }
    /// Eq. (D.15).
    complex sensitivity(quadrant::frequency f) const {
        const auto loop = thesis::loop_around(thesis::model_of(axis_), axis_);
        const complex s = quadrant::analysis::laplace(f), plant = complex(thesis::model_of(axis_)(f));
        const complex pi = axis_.kp.value() + axis_.ki.value() / s;
        const complex p_pi = thesis::position_gain.value() * pi;
        const complex velocity = (1.0 / loop.velocity_sensitivity(f) - 1.0) / plant; // PI Vest N
        Eigen::MatrixXcd m = s * Eigen::MatrixXcd::Identity(F_.rows(), F_.rows());
        m -= (F_ - G_ * H_ - L_ * Eigen::RowVectorXd::Unit(F_.rows(), 0)).cast<complex>();
        const Eigen::VectorXcd in = L_.cast<complex>() - G_.cast<complex>() * (p_pi + velocity);
        // Singular at the harmonics, where the loop gain is infinite: no rank is judged here.
        const complex fed = (H_.cast<complex>() * m.partialPivLu().solve(in))(0);
        return 1.0 / (1.0 + plant * p_pi + plant * velocity + plant * fed);
    }
    /// Error under 1 V, eq. (D.14) [um].
    double error(quadrant::frequency f) const {
        return 1e6 * std::abs(complex(thesis::model_of(axis_)(f)) * sensitivity(f));
    }

private:
    static Eigen::Index size(const std::vector<double>& hertz) { return Eigen::Index(2 + 2 * hertz.size()); }
    const thesis::axis& axis_;
    Eigen::MatrixXd F_;
    Eigen::VectorXd G_, L_;
    Eigen::RowVectorXd H_;
};

/// Figs. D.3 to D.5 by the transfer functions, and D.4 by simulation.
inline outcome harmonic_sensitivity(const std::string& id) {
    using quadrant::analysis::hertz;
    constexpr double decay = 200;
    const force_observer_loop one(thesis::y, {46}, decay), two(thesis::y, {46, 69}, decay);
    outcome out;
    thesis::by_harmonics<2>::parameters slot;
    slot.at = {hertz(46), hertz(69)};
    const thesis::push p{.sines = {{23, thesis::y.kf.value()}}};
    const auto run = thesis::pushed<thesis::by_harmonics<2>>(p, slot);
    const char* poles = "1 V at 23 Hz; depends on the observer's poles, which the thesis does not print: ours "
                        "decay with 200 1/s";
    out.rows.push_back({id,
                        "error_23Hz",
                        "um",
                        run.diverged ? std::nullopt : std::optional(std::sqrt(2.0) * run.rms),
                        {},
                        {},
                        {},
                        poles});
    out.rows.push_back({id, "error_23Hz_response", "um", two.error(hertz(23)), {}, {}, {}, poles});
    // At a harmonic itself eq. (D.15) is exactly 0, which has no decibels: the frequency is off by its last
    // digit.
    const auto zero = [&](const char* what, const force_observer_loop& l, double at) {
        const double beside = std::nextafter(at, 2 * at);
        out.rows.push_back(
            {id,
             what,
             "dB",
             quadrant::analysis::decibel(std::abs(l.sensitivity(hertz(beside)))),
             {},
             {},
             {},
             "an exact zero: digits of rounding, the published ones too; ours one last digit of the "
             "frequency beside it"});
    };
    zero("zero_one_46Hz", one, 46);
    zero("zero_two_46Hz", two, 46);
    zero("zero_two_69Hz", two, 69);
    const band b{hertz(1), hertz(400), 200};
    const auto curve = [&](const char* name, const force_observer_loop& l) {
        return over_frequency(name, b, [&](quadrant::frequency f) { return l.error(f); });
    };
    const auto bare = thesis::loop_around(thesis::model_of(thesis::y), thesis::y);
    out.pictures = {
        {"Error under 1 V with the harmonic observer",
         "By eq. (D.14), y axis: zero at the harmonics it knows, more beside them, the more harmonics the "
         "more.",
         {panel{.x_label = "frequency [Hz]",
                .y_label = "error amplitude [um]",
                .lines = {over_frequency("no observer", b,
                                         [&](quadrant::frequency f) {
                                             return 1e6 * std::abs(complex(thesis::model_of(thesis::y)(f)) *
                                                                   bare.sensitivity(f));
                                         }),
                          curve("46 Hz", one),
                          curve("46 and 69 Hz", two),
                          {.name = "published, Fig. D.4", .x = {23}, .y = {783}, .drawn = line::style::points}},
                .log_x = true,
                .log_y = true,
                .y_range = std::pair{0.1, 3000.0}}}}};
    return out;
}

/// The error from the moment when the observer comes on: half a run without it, half with it.
template <std::size_t Count>
line switched_on(const thesis::push& p, const typename thesis::by_harmonics<Count>::parameters& slot = {}) {
    const auto off = thesis::pushed<thesis::nothing_observed>(p),
               on = thesis::pushed<thesis::by_harmonics<Count>>(p, slot);
    line out{.name = fmt::format("{} harmonic{}", Count, Count > 1 ? "s" : ""), .x = {}, .y = {}};
    const std::size_t half = off.error.size() / 2, shown = std::min<std::size_t>(half, 800);
    for (std::size_t k = 0; k < shown; ++k)
        out.x.push_back(double(k) * thesis::period.value() - double(shown) * thesis::period.value()),
            out.y.push_back(off.error[half + k]);
    for (std::size_t k = 0; k < shown; ++k)
        out.x.push_back(double(k) * thesis::period.value()), out.y.push_back(on.error[k]);
    return out;
}

/// Figs. D.6 and D.7 (a frequency that the observer does not know), D.9 (at rest), D.10 and D.11 (tracking),
/// D.13 (switching on).
inline outcome harmonic_runs(const std::string& id) {
    using quadrant::analysis::hertz;
    outcome out;
    for (const int h : {1, 3}) {
        const thesis::push p{.harmonics = h, .tracking = true};
        const auto off = thesis::pushed<thesis::nothing_observed>(p);
        const auto on =
            h == 1 ? thesis::pushed<thesis::by_harmonics<1>>(p) : thesis::pushed<thesis::by_harmonics<3>>(p);
        const std::string n = std::to_string(h);
        out.rows.push_back({id,
                            "rms_off_" + n,
                            "um",
                            rms_of(off),
                            {},
                            {},
                            {},
                            "tracking 30 mm at 100 mm/s, friction by GMS feedforward; force scale 1.38"});
        out.rows.push_back({id,
                            "rms_on_" + n,
                            "um",
                            rms_of(on),
                            {},
                            {},
                            {},
                            "the thesis has the inverse-model observer beside it"});
    }
    thesis::by_harmonics<2>::parameters wrong;
    wrong.at = {hertz(23.3), hertz(46.6)};
    const thesis::push mismatch{.sines = {{23.3, 65}, {40, 65}}};
    const auto off = thesis::pushed<thesis::nothing_observed>(mismatch),
               on = thesis::pushed<thesis::by_harmonics<2>>(mismatch, wrong);
    const auto amplitude = [](const thesis::push_result& r, double f) {
        std::complex<double> sum = 0;
        const std::size_t from = r.error.size() / 2;
        for (std::size_t k = from; k < r.error.size(); ++k)
            sum +=
                r.error[k] * std::polar(2.0 / double(r.error.size() - from), -2 * thesis::pi_ * f * r.time[k]);
        return std::abs(sum);
    };
    for (const double f : {23.3, 40.0}) {
        const std::string n = fmt::format("{:.0f}", std::floor(f));
        out.rows.push_back({id,
                            "mismatch_" + n + "Hz_off",
                            "um",
                            amplitude(off, f),
                            {},
                            {},
                            {},
                            "amplitude of the error, force of 65 N at 23.3 and 40 Hz"});
        out.rows.push_back({id,
                            "mismatch_" + n + "Hz_on",
                            "um",
                            amplitude(on, f),
                            {},
                            {},
                            {},
                            f < 30 ? "the observer knows it" : "the observer has 46.6 Hz instead"});
    }
    const thesis::push rest1{.harmonics = 1}, rest2{.harmonics = 2}, rest3{.harmonics = 3};
    out.pictures = {
        {"The harmonic observer comes on",
         "At rest, force scale 1.38; the observer starts at 0 s from nothing.",
         {panel{.x_label = "time [s]",
                .y_label = "error [um]",
                .lines = {switched_on<1>(rest1), switched_on<2>(rest2), switched_on<3>(rest3)}}}},
        {"A harmonic that the observer does not know",
         "Force at 23.3 and 40 Hz, observer for 23.3 and 46.6 Hz: the last fifth of a second.",
         {panel{.x_label = "time [s]",
                .y_label = "error [um]",
                .lines = {last_of("without", off, off.error, 0.2), last_of("with", on, on.error, 0.2)}}}}};
    return out;
}

/// Fig. D.12: the circle under the first harmonic alone, without and with the observer that knows it.
struct one_harmonic {
    using box = thesis::by_harmonics<1>;
    static box::parameters of(const thesis::axis& a) {
        box::parameters p;
        p.of = a;
        return p;
    }
};
inline outcome harmonic_circle(const std::string& id) {
    using thesis::configuration, thesis::gms_model, thesis::gms_plant, thesis::no_memory;
    const thesis::cut c;
    outcome out;
    panel drawn{.x_label = "", .y_label = "um", .lines = {}, .polar = true, .polar_zero = 30.0};
    const auto add = [&]<class Configuration>(const char* quantity, const char* name, Configuration*) {
        const auto found = thesis::mill<Configuration, gms_plant>(c, thesis::synthesized(c, 1));
        out.rows.push_back(
            {id,
             quantity,
             "um",
             found.diverged ? std::nullopt : std::optional(found.rms),
             {},
             {},
             {},
             "radial error on the circle of 30 mm at 100 mm/s, first harmonic; GMS fed forward"});
        line turn{.name = name, .x = {}, .y = {}};
        for (std::size_t k = found.radial.size() / 3 * 2; k < found.radial.size(); ++k)
            turn.x.push_back(found.angle[k]), turn.y.push_back(found.radial[k]);
        drawn.lines.push_back(std::move(turn));
    };
    add("circle_rms_off_1", "without",
        static_cast<configuration<gms_model, thesis::no_observer, no_memory>*>(nullptr));
    add("circle_rms_on_1", "with", static_cast<configuration<gms_model, one_harmonic, no_memory>*>(nullptr));
    out.pictures = {{"Radial error with one harmonic",
                     "Polar plot of one turn in um about the nominal circle of 30 mm; force scale 1.38.",
                     {std::move(drawn)}}};
    return out;
}

inline experiment harmonic_observer() {
    const std::string id = "thesis.harmonic_observer";
    return {"The harmonic force observer",
            "[Jamaludin2008] Appendix D, Figs. D.3 to D.13",
            "The observer that carries the cutter's harmonics as states, in the slot of the loop and by the "
            "transfer functions "
            "of the appendix. Poles: those of the harmonics shifted left by 200 1/s; where the thesis put them "
            "is not printed, "
            "and what lies between the harmonics depends on them. Forces as in Table 3.6 times 1.38.",
            0.10,
            {{id, [=] {
                  auto out = harmonic_sensitivity(id);
                  for (auto& more : {harmonic_runs(id), harmonic_circle(id)}) {
                      out.rows.insert(out.rows.end(), more.rows.begin(), more.rows.end());
                      out.pictures.insert(out.pictures.end(), more.pictures.begin(), more.pictures.end());
                  }
                  return out;
              }}}};
}

} // namespace quadrant_reproduce
