// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bounded_step.hpp"
#include "predictor.hpp"
#include "scoring.hpp"

#include <limits>
#include <string>
#include <vector>

namespace quadrant::diagnosis {

/// One number of the plant model that a fit may move.
struct parameter {
    std::string key;                       ///< the machine file's key
    double& (*of)(plant_model&) = nullptr; ///< where it lives in the model
    double start = 0, low = 0, high = 0;   ///< bounds, in the key's unit
    bool logarithmic = false;              ///< moves by ratio (start, low > 0)
    double step = 1e-4;                    ///< of the finite difference, in fit coordinates
    double expected = 0, spread = 0;       ///< the owner's knowledge, in fit coordinates; spread 0: none

    double to_fit(double natural) const { return logarithmic ? std::log(natural) : natural; }
    double from_fit(double x) const { return logarithmic ? std::exp(x) : x; }
};

/// Mean square of one block as a quadratic in the step of the parameters: ms + 2 g d + d' A d.
struct block_quadratic {
    double ms = 0;
    Eigen::VectorXd g;
    Eigen::MatrixXd a;
    double at(const Eigen::VectorXd& d) const { return std::max(0.0, ms + 2 * g.dot(d) + d.dot(a * d)); }
};

/// A plant model fitted to one record, and how well it predicts each block of it.
struct fit_result {
    plant_model plant{};
    std::vector<parameter> parameters{};
    Eigen::VectorXd x{}; ///< fit coordinates
    std::vector<double> innovation{};
    std::vector<std::vector<double>> ms{}; ///< by channel and block
    double choices = 0; ///< score that the model took from the log itself, see predictor::run
    std::vector<std::vector<block_quadratic>> quadratic{}; ///< by channel and block
    double objective = std::numeric_limits<double>::infinity();
};

/// Fits parameters of the plant by reweighted Gauss-Newton (Levenberg-Marquardt damping, bounds by projection).
class fitter {
public:
    fitter(const predictor& p, const scoring& s) : predictor_(p), scoring_(s) {}

    static void put(plant_model& plant, const std::vector<parameter>& ps, const Eigen::VectorXd& x) {
        for (std::size_t i = 0; i < ps.size(); ++i)
            ps[i].of(plant) = ps[i].from_fit(x[static_cast<Eigen::Index>(i)]);
    }

    double score_ms(const std::vector<std::vector<double>>& ms) const {
        double sum = 0;
        for (std::size_t i = 0; i < ms.size(); ++i) {
            const channel& c = scoring_.channels[i];
            for (double m : ms[i]) sum += 0.5 * c.nu * std::log(m + square(c.floor));
        }
        return sum;
    }

    /// How the innovation moves with each parameter.
    std::vector<std::vector<double>> slopes(const fit_result& r) const {
        std::vector<std::size_t> which;
        std::vector<double> step;
        const auto plants = moved(r, {}, which, step);
        std::vector<std::vector<double>> e(plants.size()), out(r.parameters.size());
        predictor_.run(plants, e);
        for (std::size_t j = 0; j < which.size(); ++j) out[which[j]] = slope(std::move(e[j]), r, step[j]);
        return out;
    }

    /// One fit from its start to its end; see fit_course.
    fit_result fit(const plant_model& start, const std::vector<parameter>& ps, int iterations) const;
    /// Several fits side by side: what their next steps need is found in one pass.
    template <class Course> void run(std::span<Course> courses) const {
        std::vector<plant_model> plants;
        std::vector<std::vector<double>> innovation;
        std::vector<double> choices;
        for (;;) {
            plants.clear();
            for (Course& c : courses) c.ask(plants);
            if (plants.empty()) return;
            innovation.resize(plants.size());
            choices.assign(plants.size(), 0.0);
            predictor_.run(plants, innovation, {}, choices);
            std::size_t next = 0;
            for (Course& c : courses)
                next += c.take(std::span(innovation).subspan(next), std::span(choices).subspan(next));
        }
    }

    void evaluate(fit_result& r) const {
        put(r.plant, r.parameters, r.x);
        const double choices = predictor_.run(r.plant, r.innovation);
        judge(r, choices);
    }
    /// What the innovations of a model say of it.
    void judge(fit_result& r, double choices) const {
        // As many of a block's rows are independent as its score says.
        double independent = 0;
        r.ms.clear();
        for (const channel& c : scoring_.channels) {
            independent += c.nu / static_cast<double>(c.block);
            r.ms.push_back(detail::block_ms(r.innovation, c));
        }
        r.choices = choices * independent;
        r.objective = score_ms(r.ms) + prior(r) + r.choices;
        if (!std::isfinite(r.objective)) r.objective = std::numeric_limits<double>::infinity();
    }

    double prior(const fit_result& r) const {
        double sum = 0;
        for (Eigen::Index i = 0; i < r.x.size(); ++i)
            if (const auto& q = p(r.parameters, i); q.spread > 0)
                sum += 0.5 * square((r.x[i] - q.expected) / q.spread);
        return sum;
    }

private:
    static double square(double v) { return v * v; }
    static const parameter& p(const std::vector<parameter>& ps, Eigen::Index i) {
        return ps[static_cast<std::size_t>(i)];
    }

    friend class fit_course;

    using columns = std::vector<const std::vector<double>*>;

    /// The model with each parameter moved by a step, but those whose slope is known.
    static std::vector<plant_model> moved(const fit_result& r, const columns& known,
                                          std::vector<std::size_t>& which, std::vector<double>& step) {
        std::vector<plant_model> plants;
        which.clear();
        step.clear();
        for (std::size_t i = 0; i < r.parameters.size(); ++i) {
            if (i < known.size() && known[i]) continue;
            const auto& q = r.parameters[i];
            const double x = r.x[static_cast<Eigen::Index>(i)];
            which.push_back(i);
            step.push_back(x + q.step > q.to_fit(q.high) ? -q.step : q.step);
            plants.push_back(r.plant);
            q.of(plants.back()) = q.from_fit(x + step.back());
        }
        return plants;
    }
    static std::vector<double> slope(std::vector<double> moved, const fit_result& r, double step) {
        const double inverse = 1 / step;
        for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = (moved[k] - r.innovation[k]) * inverse;
        return moved;
    }

    static columns pointers(const std::vector<std::vector<double>>& d, const columns& known = {}) {
        columns out;
        for (std::size_t i = 0; i < d.size(); ++i)
            out.push_back(i < known.size() && known[i] ? known[i] : &d[i]);
        return out;
    }
    /// The blocks as quadratics, with these slopes.
    void linearize(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known) const {
        r.quadratic.clear();
        for (const auto& blocks : r.ms) r.quadratic.emplace_back(blocks.size());
        quadratics(r, found, known, true);
    }
    /// The same at another point with the slopes kept.
    void follow(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known) const {
        quadratics(r, found, known, false);
    }
    void quadratics(fit_result& r, const std::vector<std::vector<double>>& found, const columns& known,
                    bool curvature) const {
        const auto d = pointers(found, known);
        for (std::size_t i = 0; i < scoring_.channels.size(); ++i) {
            const channel& c = scoring_.channels[i];
            if (c.mean == 1) {
                quadratics(r.quadratic[i], r.innovation, d, c.block, curvature,
                           [&](std::size_t b) { return c.first_of_block[b]; });
                continue;
            }
            std::vector<std::vector<double>> slow;
            for (const auto* x : d) slow.push_back(detail::seen(*x, c));
            const std::size_t means = c.block / c.mean;
            quadratics(r.quadratic[i], detail::seen(r.innovation, c), pointers(slow), means, curvature,
                       [&](std::size_t b) { return b * means; });
        }
    }
    /// `first_of(b)`: where block b begins.
    template <class FirstOf>
    static void quadratics(std::vector<block_quadratic>& out, const std::vector<double>& e, const columns& d,
                           std::size_t block, bool curvature, FirstOf first_of) {
        const auto n = static_cast<Eigen::Index>(d.size());
        Eigen::MatrixXd j(static_cast<Eigen::Index>(block), n);
        for (std::size_t b = 0; b < out.size(); ++b) {
            const std::size_t k0 = first_of(b);
            for (Eigen::Index i = 0; i < n; ++i)
                std::copy_n(d[static_cast<std::size_t>(i)]->data() + k0, block, j.col(i).data());
            const Eigen::Map<const Eigen::VectorXd> eb(e.data() + k0, static_cast<Eigen::Index>(block));
            const double inverse = 1 / static_cast<double>(block);
            out[b].ms = eb.squaredNorm() * inverse;
            out[b].g = j.transpose() * eb * inverse;
            if (curvature) out[b].a = j.transpose() * j * inverse;
        }
    }

    Eigen::VectorXd step(const fit_result& r, double damping) const {
        const auto n = r.x.size();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
        for (std::size_t i = 0; i < r.quadratic.size(); ++i) add(r.quadratic[i], scoring_.channels[i], a, g);
        for (Eigen::Index i = 0; i < n; ++i)
            if (const auto& q = p(r.parameters, i); q.spread > 0) {
                a(i, i) += 1 / square(q.spread);
                g[i] += (r.x[i] - q.expected) / square(q.spread);
            }
        for (Eigen::Index i = 0; i < n; ++i) a(i, i) *= 1 + damping;
        Eigen::VectorXd low(n), high(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            low[i] = p(r.parameters, i).to_fit(p(r.parameters, i).low) - r.x[i];
            high[i] = p(r.parameters, i).to_fit(p(r.parameters, i).high) - r.x[i];
        }
        return r.x + bounded_step(a, g, low, high);
    }
    static void add(const std::vector<block_quadratic>& blocks, const channel& c, Eigen::MatrixXd& a,
                    Eigen::VectorXd& g) {
        for (const auto& b : blocks) {
            const double w = c.nu / (b.ms + square(c.floor));
            a += w * b.a;
            g += w * b.g;
        }
    }

    predictor predictor_;
    scoring scoring_;
};

/// One fit on its way: it asks for the innovations of some plants, takes them, and asks again, until it is
/// done. Many courses that ask at the same time share the lanes of a pass (fitter::run).
class fit_course {
public:
    /// `known`: slopes that are taken as they are instead of being found again; null where there is none. For a
    /// first look
    /// at one more effect: the others' slopes are those of the model without it.
    /// `chords`: steps that may be taken with the slopes of an earlier point before they are found again.
    /// Slopes cost a pass for each parameter, a step costs one; the last steps are taken with new slopes in any
    /// case.
    fit_course(const fitter& f, const plant_model& start, const std::vector<parameter>& ps, int iterations,
               fitter::columns known = {}, int chords = 4)
        : fitter_(&f), known_(std::move(known)), iterations_(iterations),
          chords_(chords), best_{.plant = start,
                                 .parameters = ps,
                                 .x = Eigen::VectorXd(static_cast<Eigen::Index>(ps.size()))} {
        for (std::size_t i = 0; i < ps.size(); ++i)
            best_.x[static_cast<Eigen::Index>(i)] = ps[i].to_fit(ps[i].start);
        fitter::put(best_.plant, ps, best_.x);
    }

    /// Puts the plants that the next step needs behind `plants`; none when the fit is done.
    void ask(std::vector<plant_model>& plants) {
        if (stage_ == stage::done) return;
        if (stage_ == stage::begin) plants.push_back(best_.plant);
        if (stage_ == stage::trial) plants.push_back(trial_.plant);
        if (stage_ != stage::trial) {
            auto each = fitter::moved(best_, known_, which_, step_);
            plants.insert(plants.end(), std::make_move_iterator(each.begin()),
                          std::make_move_iterator(each.end()));
        }
    }
    /// Takes their innovations; returns how many it had asked for.
    std::size_t take(std::span<std::vector<double>> innovation, std::span<const double> choices) {
        switch (stage_) {
        case stage::begin:
            best_.innovation.swap(innovation[0]);
            fitter_->judge(best_, choices[0]);
            take_slopes(innovation.subspan(1));
            next();
            return 1 + which_.size();
        case stage::slopes:
            take_slopes(innovation);
            since_ = 0;
            old_ = 0;
            if (!better_) damping_ = damping_before_;
            next();
            return which_.size();
        case stage::trial:
            trial_.innovation.swap(innovation[0]);
            fitter_->judge(trial_, choices[0]);
            compare();
            return 1;
        case stage::done:
            break;
        }
        return 0;
    }
    fit_result& result() { return best_; }

private:
    enum class stage { begin, trial, slopes, done };

    void take_slopes(std::span<std::vector<double>> moved) {
        slopes_.resize(best_.parameters.size());
        for (std::size_t j = 0; j < which_.size(); ++j)
            slopes_[which_[j]] = fitter::slope(std::move(moved[j]), best_, step_[j]);
        fitter_->linearize(best_, slopes_, known_);
    }
    /// The next iteration, if there is one.
    void next() {
        if (++iteration_ > iterations_ || best_.x.size() == 0) {
            stage_ = stage::done;
            return;
        }
        better_ = false;
        gain_ = 0;
        damping_before_ = damping_;
        attempt_ = 0;
        try_step();
    }
    void try_step() {
        trial_.plant = best_.plant;
        trial_.parameters = best_.parameters;
        trial_.x = fitter_->step(best_, damping_);
        fitter::put(trial_.plant, trial_.parameters, trial_.x);
        stage_ = stage::trial;
    }
    void compare() {
        if (trial_.objective < best_.objective) {
            gain_ = best_.objective - trial_.objective;
            trial_.quadratic = std::move(best_.quadratic);
            std::swap(best_, trial_);
            better_ = true;
            damping_ = std::max(1e-6, damping_ / 24);
        }
        damping_ *= 8;
        if (!better_ && ++attempt_ < 6) return try_step();
        since_ += gain_;
        const bool settled = gain_ < 0.1; // a hair beside the margins of the selection
        if ((settled && since_ < 1) || iteration_ == iterations_) {
            if (better_) fitter_->follow(best_, slopes_, known_);
            stage_ = stage::done;
        } else if (settled || ++old_ > chords_) {
            stage_ = stage::slopes;
        } else {
            fitter_->follow(best_, slopes_, known_);
            next();
        }
    }

    const fitter* fitter_;
    fitter::columns known_;
    int iterations_, chords_, iteration_ = 0, attempt_ = 0, old_ = 0;
    stage stage_ = stage::begin;
    fit_result best_, trial_{};
    std::vector<std::vector<double>> slopes_{};
    std::vector<std::size_t> which_{};
    std::vector<double> step_{};
    double damping_ = 1e-3, damping_before_ = 0, since_ = 0,
           gain_ = 0; // since: what was gained with these slopes
    bool better_ = false;
};

inline fit_result fitter::fit(const plant_model& start, const std::vector<parameter>& ps,
                              int iterations) const {
    fit_course course(*this, start, ps, iterations);
    run(std::span(&course, 1));
    return std::move(course.result());
}

} // namespace quadrant::diagnosis
