// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL fit_course::fit_course(const fitter& f, const plant_model& start,
                                               const std::vector<parameter>& ps, int iterations,
                                               known_slopes known, int chords)
    : fitter_(&f), known_(std::move(known)), iterations_(iterations),
      chords_(chords), best_{.plant = start,
                             .parameters = ps,
                             .x = Eigen::VectorXd(static_cast<Eigen::Index>(ps.size()))} {
    for (std::size_t i = 0; i < ps.size(); ++i)
        best_.x[static_cast<Eigen::Index>(i)] = ps[i].to_fit(ps[i].start);
    fitter::put(best_.plant, ps, best_.x);
}

QUADRANT_DIAGNOSIS_DECL void fit_course::ask(std::vector<plant_model>& plants) {
    if (done()) return;
    if (stage_ == stage::begin) plants.push_back(best_.plant);
    if (stage_ == stage::trial) {
        for (const Eigen::VectorXd& x : tries_) {
            plants.push_back(best_.plant);
            fitter::put(plants.back(), best_.parameters, x);
        }
    } else {
        auto each = fitter_->moved(best_, known_.count(), step_);
        plants.insert(plants.end(), std::make_move_iterator(each.begin()), std::make_move_iterator(each.end()));
    }
}

QUADRANT_DIAGNOSIS_DECL std::size_t fit_course::take(std::span<std::vector<double>> innovation,
                                                     std::span<const double> choices) {
    if (done()) return 0;
    const std::size_t taken = took(innovation, choices);
    if (done()) release();
    return taken;
}

QUADRANT_DIAGNOSIS_DECL void fit_course::release() {
    slopes_ = {};
    trial_ = {};
    if (known_.from && !paused_) best_.innovation = {};
}

QUADRANT_DIAGNOSIS_DECL std::size_t fit_course::took(std::span<std::vector<double>> innovation,
                                                     std::span<const double> choices) {
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
    case stage::trial: {
        const std::size_t asked = tries_.size();
        for (std::size_t i = 0; i < asked && !better_; ++i) {
            trial_.x = tries_[i];
            trial_.plant = best_.plant;
            trial_.parameters = best_.parameters;
            fitter::put(trial_.plant, trial_.parameters, trial_.x);
            trial_.innovation.rows.swap(innovation[i]);
            fitter_->judge(trial_, choices[i]);
            if (!compare()) ++attempt_;
        }
        if (!better_ && attempt_ < attempts)
            try_step();
        else
            conclude();
        return asked;
    }
    case stage::done:
        break;
    }
    return 0;
}

QUADRANT_DIAGNOSIS_DECL void fit_course::take_slopes(std::span<std::vector<double>> moved) {
    slopes_.resize(step_.size());
    for (std::size_t j = 0; j < step_.size(); ++j) {
        fitter::to_slope(moved[j], best_, step_[j]);
        slopes_[j].rows.swap(moved[j]);
        slopes_[j].look(fitter_->scoring_);
    }
    fitter_->quadratics(best_, slopes_, known_, true);
}

QUADRANT_DIAGNOSIS_DECL void fit_course::next() {
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

QUADRANT_DIAGNOSIS_DECL void fit_course::try_step() {
    // Nearly every first step is better. Where it is not, all that may follow it are asked for at once: in
    // lanes they cost little more than the next one alone.
    const std::size_t most = attempt_ == 0 ? 1 : static_cast<std::size_t>(attempts - attempt_);
    tries_.clear();
    for (double damping = damping_; tries_.size() < most; damping *= 8) {
        double promised = 0;
        Eigen::VectorXd x = fitter_->step(best_, damping, promised);
        if (!(promised > least_promise)) break;
        tries_.push_back(std::move(x));
    }
    if (tries_.empty()) return conclude();
    stage_ = stage::trial;
}

QUADRANT_DIAGNOSIS_DECL bool fit_course::compare() {
    if (trial_.objective < best_.objective) {
        gain_ = best_.objective - trial_.objective;
        trial_.quadratic = std::move(best_.quadratic);
        std::swap(best_, trial_);
        better_ = true;
        damping_ = std::max(1e-6, damping_ / 24);
    }
    damping_ *= 8;
    return better_;
}

QUADRANT_DIAGNOSIS_DECL void fit_course::conclude() {
    since_ += gain_;
    const bool settled = gain_ < hair;
    if ((settled && since_ < 1) || iteration_ == iterations_) {
        if (better_) fitter_->quadratics(best_, slopes_, known_, false);
        stage_ = stage::done;
    } else if (settled || ++old_ > chords_ || iteration_ == pause_) {
        stage_ = stage::slopes;
        paused_ = iteration_ == pause_;
    } else {
        fitter_->quadratics(best_, slopes_, known_, false);
        next();
    }
}

QUADRANT_DIAGNOSIS_DECL fit_result fitter::fit(const plant_model& start, const std::vector<parameter>& ps,
                                               int iterations) const {
    fit_course course(*this, start, ps, iterations);
    run(std::span(&course, 1));
    return std::move(course.result());
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> fitter::objectives(std::span<const plant_model> plants) const {
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

} // namespace quadrant::inline v0::diagnosis
