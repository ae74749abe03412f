// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bounded_step.hpp"
#include "quadratic.hpp"

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

/// A plant model fitted to one record, and how well it predicts each block of it.
struct fit_result {
    plant_model plant{};
    std::vector<parameter> parameters{};
    Eigen::VectorXd x{}; ///< fit coordinates
    viewed_signal innovation{};
    std::vector<std::vector<double>> ms{}; ///< by channel and block
    double choices = 0; ///< score that the model took from the log itself, see predictor::run
    std::vector<block_quadratics> quadratic{}; ///< by channel
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

    /// A model with its innovations, and how they move with each parameter.
    shared_slopes slopes(fit_result& r) const {
        put(r.plant, r.parameters, r.x);
        std::vector<double> step;
        std::vector<plant_model> plants = moved(r, 0, step);
        plants.insert(plants.begin(), r.plant);
        std::vector<std::vector<double>> e(plants.size());
        predictor_.run(plants, e);
        r.innovation = {std::move(e.front()), scoring_};
        e.erase(e.begin());
        for (std::size_t j = 0; j < e.size(); ++j) to_slope(e[j], r, step[j]);
        return {std::move(e), scoring_};
    }

    /// One fit from its start to its end; see fit_course.
    fit_result fit(const plant_model& start, const std::vector<parameter>& ps, int iterations) const;
    /// The objective of models as they stand, side by side.
    std::vector<double> objectives(std::span<const plant_model> plants) const;
    /// Several fits side by side: what their next steps need is found in one pass. As many are under way as
    /// fill the lanes twice; the others would hold their slopes in memory meanwhile.
    template <class Course> void run(std::span<Course> courses) const {
        std::vector<plant_model> plants;
        std::vector<std::vector<double>> innovation;
        std::vector<double> choices;
        std::vector<Course*> under_way;
        for (std::size_t begun = 0;;) {
            plants.clear();
            for (Course* c : under_way) c->ask(plants);
            while (begun < courses.size() && plants.size() < 2 * predictor::abreast) {
                under_way.push_back(&courses[begun++]);
                under_way.back()->ask(plants);
            }
            if (plants.empty()) return;
            innovation.resize(plants.size());
            choices.assign(plants.size(), 0.0);
            predictor_.run(plants, innovation, {}, choices);
            std::size_t next = 0;
            for (Course* c : under_way)
                next += c->take(std::span(innovation).subspan(next), std::span(choices).subspan(next));
            std::erase_if(under_way, [](const Course* c) { return c->done(); });
        }
    }

    void evaluate(fit_result& r) const {
        put(r.plant, r.parameters, r.x);
        const double choices = predictor_.run(r.plant, r.innovation.rows);
        judge(r, choices);
    }
    /// What the innovations of a model say of it.
    void judge(fit_result& r, double choices) const {
        // As many of a block's rows are independent as its score says.
        double independent = 0;
        r.ms.clear();
        r.innovation.look(scoring_);
        for (std::size_t i = 0; i < scoring_.channels.size(); ++i) {
            independent += scoring_.channels[i].nu / static_cast<double>(scoring_.channels[i].block);
            r.ms.push_back(r.innovation.block_ms(scoring_, i));
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

    /// The model with each parameter moved by a step, from the `first` on.
    static std::vector<plant_model> moved(const fit_result& r, std::size_t first, std::vector<double>& step) {
        std::vector<plant_model> plants;
        step.clear();
        for (std::size_t i = first; i < r.parameters.size(); ++i) {
            const auto& q = r.parameters[i];
            const double x = r.x[static_cast<Eigen::Index>(i)];
            step.push_back(x + q.step > q.to_fit(q.high) ? -q.step : q.step);
            plants.push_back(r.plant);
            q.of(plants.back()) = q.from_fit(x + step.back());
        }
        return plants;
    }
    static void to_slope(std::vector<double>& moved, const fit_result& r, double step) {
        const double inverse = 1 / step;
        for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = (moved[k] - r.innovation.rows[k]) * inverse;
    }
    /// The blocks as quadratics with these slopes; without `curvature` that of the point before is kept.
    void quadratics(fit_result& r, const std::vector<viewed_signal>& own, const known_slopes& known,
                    bool curvature) const {
        r.quadratic.resize(scoring_.channels.size());
        for (std::size_t i = 0; i < scoring_.channels.size(); ++i)
            find_quadratics(r.quadratic[i], r.innovation, own, known, scoring_.channels[i], i, curvature);
    }

    /// The next point; `gain`: what the quadratics promise for the way there [nats].
    Eigen::VectorXd step(const fit_result& r, double damping, double& gain) const {
        const auto n = r.x.size();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
        for (std::size_t i = 0; i < r.quadratic.size(); ++i) add(r.quadratic[i], scoring_.channels[i], a, g);
        for (Eigen::Index i = 0; i < n; ++i)
            if (const auto& q = p(r.parameters, i); q.spread > 0) {
                a(i, i) += 1 / square(q.spread);
                g[i] += (r.x[i] - q.expected) / square(q.spread);
            }
        const Eigen::MatrixXd curvature = a;
        for (Eigen::Index i = 0; i < n; ++i) a(i, i) *= 1 + damping;
        Eigen::VectorXd low(n), high(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            low[i] = p(r.parameters, i).to_fit(p(r.parameters, i).low) - r.x[i];
            high[i] = p(r.parameters, i).to_fit(p(r.parameters, i).high) - r.x[i];
        }
        const Eigen::VectorXd d = bounded_step(a, g, low, high);
        gain = -(g.dot(d) + 0.5 * d.dot(curvature * d));
        return r.x + d;
    }
    static void add(const block_quadratics& q, const channel& c, Eigen::MatrixXd& a, Eigen::VectorXd& g) {
        Eigen::MatrixXd scratch;
        for (std::size_t b = 0; b < q.size(); ++b) {
            const double w = c.nu / (q.ms[b] + square(c.floor));
            a += w * q.curvature(b, scratch);
            g += w * q.gradient(b);
        }
    }

    predictor predictor_;
    scoring scoring_;
};

/// One fit on its way: it asks for the innovations of some plants, takes them, and asks again, until it is
/// done. Many courses that ask at the same time share the lanes of a pass (fitter::run).
class fit_course {
public:
    /// `known`: slopes that are taken as they are instead of being found again. For a first look at one more
    /// effect: the others' slopes are those of the model without it.
    /// `chords`: steps that may be taken with the slopes of an earlier point before they are found again.
    /// Slopes cost a pass for each parameter, a step costs one; the last steps are taken with new slopes in any
    /// case.
    fit_course(const fitter& f, const plant_model& start, const std::vector<parameter>& ps, int iterations,
               known_slopes known = {}, int chords = 4)
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
        if (done()) return;
        if (stage_ == stage::begin) plants.push_back(best_.plant);
        if (stage_ == stage::trial) plants.push_back(trial_.plant);
        if (stage_ != stage::trial) {
            auto each = fitter::moved(best_, known_.count(), step_);
            plants.insert(plants.end(), std::make_move_iterator(each.begin()),
                          std::make_move_iterator(each.end()));
        }
    }
    /// Takes their innovations; returns how many it had asked for.
    std::size_t take(std::span<std::vector<double>> innovation, std::span<const double> choices) {
        const std::size_t taken = took(innovation, choices);
        if (done()) release();
        return taken;
    }
    bool done() const { return stage_ == stage::done; }
    fit_result& result() { return best_; }

private:
    enum class stage { begin, trial, slopes, done };

    std::size_t took(std::span<std::vector<double>> innovation, std::span<const double> choices) {
        switch (stage_) {
        case stage::begin:
            best_.innovation.rows.swap(innovation[0]);
            fitter_->judge(best_, choices[0]);
            take_slopes(innovation.subspan(1));
            next();
            return 1 + step_.size();
        case stage::slopes:
            take_slopes(innovation);
            since_ = 0;
            old_ = 0;
            if (!better_) damping_ = damping_before_;
            next();
            return step_.size();
        case stage::trial:
            trial_.innovation.rows.swap(innovation[0]);
            fitter_->judge(trial_, choices[0]);
            compare();
            return 1;
        case stage::done:
            break;
        }
        return 0;
    }
    /// What nobody asks a finished fit for; a first look is not asked for its innovations either.
    void release() {
        slopes_ = {};
        trial_ = {};
        if (known_.from) best_.innovation = {};
    }
    void take_slopes(std::span<std::vector<double>> moved) {
        slopes_.resize(step_.size());
        for (std::size_t j = 0; j < step_.size(); ++j) {
            fitter::to_slope(moved[j], best_, step_[j]);
            slopes_[j].rows.swap(moved[j]);
            slopes_[j].look(fitter_->scoring_);
        }
        fitter_->quadratics(best_, slopes_, known_, true);
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
        double promised = 0;
        trial_.x = fitter_->step(best_, damping_, promised);
        if (!(promised > least_promise)) return conclude();
        trial_.plant = best_.plant;
        trial_.parameters = best_.parameters;
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
        conclude();
    }
    /// The end of an iteration: whether another follows, and with which slopes.
    void conclude() {
        since_ += gain_;
        const bool settled = gain_ < hair;
        if ((settled && since_ < 1) || iteration_ == iterations_) {
            if (better_) fitter_->quadratics(best_, slopes_, known_, false);
            stage_ = stage::done;
        } else if (settled || ++old_ > chords_) {
            stage_ = stage::slopes;
        } else {
            fitter_->quadratics(best_, slopes_, known_, false);
            next();
        }
    }

    /// A gain beside the margins of the selection that is worth no pass [nats].
    static constexpr double hair = 0.1;
    /// A step that promises less is not tried. Far below the hair: where the score is rough a step gains more
    /// than its quadratics promise.
    static constexpr double least_promise = 1e-3;

    const fitter* fitter_;
    known_slopes known_;
    int iterations_, chords_, iteration_ = 0, attempt_ = 0, old_ = 0;
    stage stage_ = stage::begin;
    fit_result best_, trial_{};
    std::vector<viewed_signal> slopes_{}; ///< of the parameters behind the known ones
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

inline std::vector<double> fitter::objectives(std::span<const plant_model> plants) const {
    std::vector<double> out;
    for (std::size_t first = 0; first < plants.size(); first += predictor::abreast) {
        std::vector<fit_course> looks;
        for (const plant_model& p : plants.subspan(first, std::min(predictor::abreast, plants.size() - first)))
            looks.emplace_back(*this, p, std::vector<parameter>{}, 0);
        run(std::span(looks));
        for (fit_course& c : looks) out.push_back(c.result().objective);
    }
    return out;
}

} // namespace quadrant::diagnosis
