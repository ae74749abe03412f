// SPDX-License-Identifier: BSL-1.0
// Long: draw() draws in the order that a seed stands for.
#pragma once
#include "gap_meter.hpp"
#include "hidden.hpp"

#include <functional>

/// One machine of the trial: drawn, with its effects put in at a size measured against what its tolerances
/// alone can do.
namespace quadrant_gap::trial {

namespace detail {

/// Puts an effect into the machine at the amplitude whose own gap is `target` clouds, or as near as its range
/// allows. Returns what puts it into another machine of this description.
template <class Into>
std::function<void(axis_truth&)> put_in(drawn_machine& m, const std::string& name, double low, double high,
                                        Into into, double target, std::uint64_t seed) {
    gap_meter meter(m);
    const surroundings s = around(m, meter);
    if (m.cloud == 0) m.cloud = tolerance_cloud(m, meter, dice(seed, 7));
    const auto put = [=, described = m.described[0]](axis_truth& a, double amplitude) {
        insertion i{a, described, amplitude, dice(seed, 8), s};
        into(i);
        return i.parameters;
    };
    const auto size = [&](double amplitude) {
        drawn_machine tried = m;
        tried.truth = m.described;
        put(tried.truth[0], amplitude);
        std::vector<axis_truth> plain;
        for (std::size_t k = 0; k < tried.truth.size(); ++k) {
            plain.push_back(ideal(tried.truth[k]));
            if (name == "encoder_quantization") plain[k].encoder.resolution = tried.truth[k].encoder.resolution;
        }
        return meter(plain) / m.cloud;
    };
    double a = low * std::pow(high / low, 0.5), found = size(a);
    for (int n = 0; n < 8 && !(std::abs(std::log(found / target)) < 0.12); ++n) {
        if (!std::isfinite(found))
            high = a, a = std::sqrt(low * a);
        else
            (found < target ? low : high) = a,
                                    a = std::clamp(a * std::clamp(target / std::max(found, 1e-9), 0.02, 50.0),
                                                   low * std::pow(high / low, 0.03),
                                                   low * std::pow(high / low, 0.97));
        found = size(a);
    }
    if (!std::isfinite(found)) a = low, found = size(a);
    m.effects.push_back({name, found, put(m.truth[0], a)});
    return [put, a](axis_truth& other) { put(other, a); };
}

inline double travel(const std::vector<double>& position) {
    const auto [low, high] = std::minmax_element(position.begin(), position.end());
    return *high - *low;
}

} // namespace detail

/// Machine `index` of the trial with this seed: the same whatever else is drawn.
inline drawn_machine draw(std::uint64_t seed, std::size_t index, const planned& p) {
    for (std::uint64_t attempt = 0;; ++attempt) {
        const std::uint64_t own = seed * 1000003 + index * 101 + attempt * 7919;
        dice random(own, 2);
        drawn_machine m;
        m.index = index;
        m.what = p.what;
        m.how = p.how;
        m.noise_seed = own;
        m.period = random.one_of(
            std::vector<double>{0.000125, 0.00025, 0.00025, 0.0004, 0.0005, 0.0005, 0.0005, 0.001, 0.002});
        m.tolerance = {random.log_uniform(0.005, 0.05), random.log_uniform(0.005, 0.04),
                       random.uniform(0.05, 0.2), random.uniform(0.03, 0.12), random.uniform(0.03, 0.12)};
        for (double* t : {&m.tolerance.mass, &m.tolerance.force_constant, &m.tolerance.viscous,
                          &m.tolerance.coulomb, &m.tolerance.at_rest})
            *t = std::round(*t * 1000) / 1000;
        for (int n = 0; n < (p.two_axes ? 2 : 1); ++n)
            m.described.push_back(detail::drawn_axis(m.period, n == 0 ? "x" : "y", random));
        if (m.how == logs::coarse)
            for (axis_truth& a : m.described) make_coarse(a, m.period, random);
        const bool closes = drive_of(p.machines_of) != quadrant::diagnosis::drive_kind::current;
        if (closes) {
            m.period = random.one_of(p.machines_of == population::position_servo
                                         ? std::vector<double>{0.002, 0.005, 0.005}
                                         : std::vector<double>{0.0005, 0.001, 0.001, 0.002});
            detail::give_loops(m.described[0], p.machines_of, m.period, m.how, random);
        }
        if (p.machines_of == population::joint) detail::give_joint(m.described[0], m.period, random);
        bool needs_coulomb = false;
        for (const std::string& e : p.effects)
            needs_coulomb = needs_coulomb || effect_named(e)->trial.needs_coulomb;
        if (needs_coulomb && m.described[0].friction.coulomb == 0) continue;
        const auto has = [&](const char* e) {
            return std::find(p.effects.begin(), p.effects.end(), e) != p.effects.end();
        };
        auto& described = m.described[0];
        if (has("stribeck_friction")) described.friction.level_at_rest = 0;
        if (has("coulomb_friction") && random.chance(0.6)) // the file says nothing of it
            described.friction.coulomb = described.friction.level_at_rest =
                described.controller.coulomb_feedforward = 0;

        const double seconds = std::min(random.uniform(7, 13), 36000 * m.period);
        for (auto* references : {&m.log_reference, &m.holdout_reference}) {
            const double length = references == &m.log_reference ? seconds : std::max(3.5, 0.6 * seconds);
            const auto samples = [&](double s) { return static_cast<std::size_t>(s / m.period); };
            for (const axis_truth& a : m.described) {
                const motion_limits l = detail::limits(a, length, m.period, random);
                const motion way = p.slow_only ? poor_motion(l, random) : rich_motion(l, random);
                references->push_back(way.sampled(m.period, samples(std::min(length, way.seconds()))));
            }
            std::size_t shortest = references->front().size();
            for (const auto& r : *references) shortest = std::min(shortest, r.size());
            for (auto& r : *references) r.resize(shortest);
        }
        if (static_cast<double>(m.log_reference[0].size()) * m.period < 2.2 ||
            static_cast<double>(m.holdout_reference[0].size()) * m.period < 2.2)
            continue;

        m.truth = m.described;
        if (const gap_meter meter(m); !meter.runs() || !std::isfinite(meter(m.described))) continue;
        const auto target = [&] {
            if (p.what == kind::single) return random.log_uniform(0.25, 15);
            return p.what == kind::removed ? random.log_uniform(4, 15) : random.log_uniform(2, 12);
        };
        if (p.what == kind::unknown)
            detail::put_in(
                m, "unknown", 1e-3, 1, [](insertion& i) { put_stranger(i); }, random.log_uniform(4, 15), own);
        if (m.how == logs::measured && m.truth[0].actuator.slew > 0) continue; // it is in the column already
        std::uint64_t stream = own;
        std::vector<std::function<void(axis_truth&)>> put;
        for (const std::string& e : p.effects) {
            const auto& w = effect_named(e)->trial;
            const auto into = [into = w.into, e, what = p.what](insertion& i) {
                into(i);
                i.vary(e);
                if (what == kind::removed) i.truth.process.mean = 0; // a constant force, which is no lie
            };
            put.push_back(detail::put_in(m, e, w.low, w.high, into, target(), stream++));
        }
        const double least =
            p.what == kind::single || attempt > 5 ? 0 : 1.2; // a single one may hide in the cloud
        if (std::any_of(m.effects.begin(), m.effects.end(),
                        [&](const drawn_effect& e) { return e.size < least; }))
            continue;
        if (m.cloud == 0) m.cloud = detail::tolerance_cloud(m, gap_meter(m), dice(own, 7));
        for (axis_truth& a : m.truth) detail::move_inside(a, m.tolerance, random);
        for (drawn_effect& e : m.effects) detail::read_again(e.parameters, m.truth[0]);
        bool shown = true;
        for (std::size_t k = 0; closes && shown && k < put.size() && attempt < 60; ++k) {
            axis_truth without = m.described[0];
            for (std::size_t other = 0; other < put.size(); ++other)
                if (other != k) put[other](without);
            shown = detail::shows_in_a_log(m, without);
        }
        if (!shown) continue;
        for (const char* c : {"backlash", "cutting_force", "sample_loss", "structural_resonance", "cogging"})
            if (random.chance(0.08) && !has(c)) m.excluded.emplace_back(c);
        if (p.what == kind::removed) m.excluded.push_back(p.effects.front());
        bool stays = true;
        for (const auto* references : {&m.log_reference, &m.holdout_reference})
            for (const axis_record& r : trial::run(m.truth, *references, m.period, own))
                stays = stays && !std::isnan(r.position.back()) &&
                        detail::travel(r.position) > 20 * m.described[0].encoder.resolution &&
                        (closes || std::abs(r.position.back() - r.reference.back()) <
                                       (m.described[0].turns ? 0.2 : 0.02));
        if (stays) return m;
    }
}

} // namespace quadrant_gap::trial
