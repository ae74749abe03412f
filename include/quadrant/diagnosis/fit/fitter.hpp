// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../log/signals.hpp"
#include "bounded_step.hpp"
#include "quadratic.hpp"

#include <limits>
#include <string>
#include <vector>

namespace quadrant::inline v0::diagnosis {

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

    static void put(plant_model& plant, const std::vector<parameter>& ps, const Eigen::VectorXd& x);

    double score_ms(const std::vector<std::vector<double>>& ms) const;

    /// A model with its innovations, and how they move with each parameter.
    shared_slopes slopes(fit_result& r) const;

    /// One fit from its start to its end; see fit_course, in fit.hpp.
    fit_result fit(const plant_model& start, const std::vector<parameter>& ps, int iterations) const;
    /// The objective of models as they stand, side by side.
    std::vector<double> objectives(std::span<const plant_model> plants) const;
    /// Several fits side by side: what their next steps need is found in one pass. As many are under way as
    /// fill a pass; the others would hold their slopes in memory meanwhile.
    template <class Course> void run(std::span<Course> courses) const {
        std::vector<plant_model> plants;
        std::vector<std::vector<double>> innovation;
        std::vector<double> choices;
        std::vector<Course*> under_way;
        for (std::size_t begun = 0;;) {
            plants.clear();
            for (Course* c : under_way) c->ask(plants);
            while (begun < courses.size() && plants.size() < predictor::abreast) {
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

    void evaluate(fit_result& r) const;
    /// What the innovations of a model say of it.
    void judge(fit_result& r, double choices) const;

    static double prior(const fit_result& r);

private:
    static const parameter& p(const std::vector<parameter>& ps, Eigen::Index i);

    friend class fit_course;

    /// The model with each parameter moved by a step, from the `first` on.
    std::vector<plant_model> moved(const fit_result& r, std::size_t first, std::vector<double>& step) const;
    static void to_slope(std::vector<double>& moved, const fit_result& r, double step);
    /// The blocks as quadratics with these slopes; without `curvature` that of the point before is kept.
    void quadratics(fit_result& r, const std::vector<viewed_signal>& own, const known_slopes& known,
                    bool curvature) const;

    /// The next point; `gain`: what the quadratics promise for the step there [nats].
    Eigen::VectorXd step(const fit_result& r, double damping, double& gain) const;
    static void add(const block_quadratics& q, const channel& c, Eigen::MatrixXd& a, Eigen::VectorXd& g);

    predictor predictor_;
    scoring scoring_;
};

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "fitter.ipp"
#endif
