// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL double flexibility(const fit_result& f) {
    const auto free = std::count_if(f.parameters.begin(), f.parameters.end(),
                                    [](const parameter& p) { return !(p.spread > 0); });
    return 0.5 * static_cast<double>(free) *
           std::log(static_cast<double>(std::max<std::size_t>(2, f.ms.empty() ? 0 : f.ms.front().size())));
}

QUADRANT_DIAGNOSIS_DECL double rarity(const std::vector<const effect*>& effects) {
    double sum = 0;
    for (const effect* e : effects) sum -= score_temperature * std::log(e->prior.odds);
    return sum;
}

/// Sums of the blocks; the candidate gets those that intervals are made of.
inline fold_sums sums_of(candidate& c, const scoring& s) {
    const auto n = c.fit.x.size();
    fold_sums out;
    out.all = {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    out.of.fill(out.all);
    c.curvature = c.unknown = Eigen::MatrixXd::Zero(n, n);
    c.gradient = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(s.segments));
    Eigen::MatrixXd scratch;
    each_channel(c.fit, s, [&](const auto& blocks, const channel& view) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const double whole = blocks.ms[b] + view.least(b), w = view.nu / whole;
            auto& f = out.of[fold_of(view.segment_of_block[b])];
            const Eigen::MatrixXd& curvature = blocks.curvature(b, scratch);
            f.a += w * curvature;
            f.g += w * blocks.gradient(b);
            c.curvature += w * curvature;
            if (view.unknown > 0) c.unknown += w * square(view.unknown) / whole * curvature;
            c.gradient.col(static_cast<Eigen::Index>(view.segment_of_block[b])) += w * blocks.gradient(b);
        }
    });
    for (const auto& f : out.of) out.all.a += f.a;
    for (const auto& f : out.of) out.all.g += f.g;
    return out;
}

/// What the owner knows of each number, and its bounds.
inline void add_what_is_known(fold_sums& sums, const fit_result& fit) {
    const auto n = fit.x.size();
    sums.low.resize(n);
    sums.high.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& p = fit.parameters[static_cast<std::size_t>(i)];
        const double x = fit.x[i];
        sums.low[i] = std::min(p.to_fit(p.low) - x, 0.0);
        sums.high[i] = std::max(p.to_fit(p.high) - x, 0.0);
        if (!(p.spread > 0)) {
            // A fold may leave a number open. That it lies within its bounds is known all the same, and is
            // worth the inverse variance of an even spread over them.
            if (const double width = sums.high[i] - sums.low[i]; width > 0 && std::isfinite(width))
                sums.all.a(i, i) += 12 / (width * width);
            continue;
        }
        sums.all.a(i, i) += 1 / (p.spread * p.spread);
        sums.all.g[i] += (x - p.expected) / (p.spread * p.spread);
    }
}

QUADRANT_DIAGNOSIS_DECL Eigen::VectorXd step_without(const fold_sums& sums, std::size_t fold, bool replayed) {
    // Behind a drive's replay what this fold alone shows stays where it is: the others do not know it, and
    // predict nothing by it. Where a command was logged, forces without a name fill single folds.
    const double alone = replayed ? 0.1 : 0;
    Eigen::MatrixXd a = sums.all.a - (1 - alone) * sums.of[fold].a;
    a.diagonal() *= 1 + 1e-9;
    Eigen::VectorXd g = -sums.of[fold].g;
    if (replayed) g += sums.all.g; // elsewhere as at the optimum, where nothing presses against a bound
    return bounded_step(a, g, sums.low, sums.high);
}

/// Of a path: a machine far from its description has to be worth it, and so has a number that is free.
inline double penalty_of_path(const fit_result& fit, double readings) {
    const auto free = std::count_if(fit.parameters.begin(), fit.parameters.end(),
                                    [](const parameter& p) { return !(p.spread > 0); });
    const auto& friction = fit.plant.friction;
    constexpr double frictionless = 0.03; // odds of a servo whose record shows none
    const bool none = !(friction.coulomb + friction.excess + friction.load > 0);
    return fitter::prior(fit) +
           0.5 * score_temperature * static_cast<double>(free) * std::log(std::max(2.0, readings)) -
           (none ? score_temperature * std::log(frictionless) : 0);
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL void cross_validate(candidate& c, const scoring& s, bool replayed, bool closed) {
    detail::fold_sums sums = detail::sums_of(c, s);
    detail::add_what_is_known(sums, c.fit);
    c.held_out.assign(s.segments, 0.0);
    c.leave.clear();
    std::array<Eigen::VectorXd, folds> step;
    for (std::size_t f = 0; f < folds; ++f) {
        step[f] = detail::step_without(sums, f, replayed);
        c.leave.push_back(c.fit.x + step[f]);
    }
    double readings = 0;
    Eigen::MatrixXd scratch;
    detail::each_channel(c.fit, s, [&](const auto& blocks, const channel& view) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const auto segment = view.segment_of_block[b];
            const double ms = closed ? blocks.ms[b] : blocks.at(b, step[fold_of(segment)], scratch);
            c.held_out[segment] -= 0.5 * view.nu * std::log(ms + view.least(b));
            readings += view.nu / score_temperature;
        }
    });
    c.penalty = (closed ? detail::penalty_of_path(c.fit, readings) : detail::flexibility(c.fit)) +
                c.fit.choices + detail::rarity(c.effects);
    c.total = -c.penalty;
    for (double v : c.held_out) c.total += v;
}

QUADRANT_DIAGNOSIS_DECL std::vector<parameter> resumed(const fit_result& f) {
    std::vector<parameter> ps = f.parameters;
    for (std::size_t i = 0; i < ps.size(); ++i) ps[i].start = ps[i].from_fit(f.x[static_cast<Eigen::Index>(i)]);
    return ps;
}

QUADRANT_DIAGNOSIS_DECL void judge(const axis_record& record, candidate& c) {
    if (!std::isfinite(c.fit.objective)) return;
    cross_validate(c, record.score, record.replayed(), record.closed());
    c.held_out_force = std::make_shared<std::optional<double>>();
    c.along_motion = std::make_shared<std::optional<double>>();
    c.noise = std::make_shared<std::optional<double>>();
    c.holdout = std::make_shared<std::optional<candidate::on_holdout>>();
    if (const auto& innovation = c.fit.innovation.rows; !innovation.empty())
        *c.noise = position_noise(innovation, record.score, record.resolution);
    c.fit.innovation = {};
    c.fit.quadratic = {};
    c.other_ways.clear();
}

QUADRANT_DIAGNOSIS_DECL void finish(const axis_record& record, std::span<candidate* const> sketches) {
    const fitter fit(record.observer, record.score);
    std::vector<fit_course> courses;
    std::vector<candidate*> fitted; // of each course
    for (candidate* c : sketches) {
        if (!std::isfinite(c->fit.objective)) continue;
        c->other_ways.insert(c->other_ways.begin(), std::move(c->fit));
        for (const fit_result& way : c->other_ways) {
            courses.emplace_back(fit, way.plant, resumed(way), 30);
            fitted.push_back(c);
        }
        c->other_ways.clear();
    }
    fit.run(std::span(courses));
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        candidate way{.effects = fitted[i]->effects,
                      .fit = std::move(courses[i].result()),
                      .total = -std::numeric_limits<double>::infinity()};
        judge(record, way);
        if (i == 0 || fitted[i] != fitted[i - 1] || way.total > fitted[i]->total) *fitted[i] = std::move(way);
    }
}

QUADRANT_DIAGNOSIS_DECL void finish(const axis_record& record, candidate& c) {
    candidate* const one = &c;
    finish(record, std::span(&one, 1));
}

} // namespace quadrant::inline v0::diagnosis
