// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL std::vector<term> suspects_of(const position_link& l) {
    std::vector<term> out;
    if (l.asked) out.insert(out.end(), {term::delay, term::first_order, term::rate, term::steps});
    if (l.geared) {
        out.insert(out.end(), {term::scale, term::play, term::pitch, term::smooth});
        if (l.turn > 0) out.push_back(term::cyclic); // else it is reported as a pitch error
        if (!l.force.empty()) out.insert(out.end(), {term::spring, term::motor_friction});
        if (!l.asked) out.push_back(term::steps);
        if (!l.asked && l.force.empty()) out.push_back(term::delay); // two registers, read one after the other
    }
    out.push_back(term::drift);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> places(const readings& r, bool of_scale) {
    std::vector<double> out;
    for (std::size_t k : r.rows()) out.push_back(of_scale ? r.of().last[k] : r.first()[k]);
    return out;
}

QUADRANT_DIAGNOSIS_DECL bool is_fraction(const readings& r, double p, double turn) {
    for (int h = 1; turn > 0 && h <= 6; ++h)
        if (std::abs(r.travel() * (1 / p - h / turn)) < 0.5) return true;
    return false;
}

/// Whether a wave repeats with no fraction of a turn: half a wave lies between over the travel, or,
/// from a tenth of one on, its own period predicts the readings better.
inline bool is_own_period(const readings& r, const fitted& f, double margin) {
    const double turn = r.of().turn, p = f.model.cyclic_period;
    if (!is_fraction(r, p, turn)) return true;
    const double h = std::max(1.0, std::round(turn / p));
    if (std::abs(r.travel() * (1 / p - h / turn)) < 0.1) return false;
    link_model m = f.model;
    m.cyclic_period = turn / h;
    return f.score > fit_columns(r, m).score + margin;
}

QUADRANT_DIAGNOSIS_DECL double repeating_period(const readings& r, const fitted& from, double but,
                                                bool of_scale) {
    const auto z = places(r, of_scale);
    const std::vector<double> left(from.left.data(), from.left.data() + from.left.size());
    const double longest = r.travel() / 2, shortest = std::max(8 * r.of().count(), r.travel() / 4000);
    for (double p : spatial_peaks(left, z, longest, shortest, 12))
        if (!is_fraction(r, p, but)) return p;
    return 0;
}

QUADRANT_DIAGNOSIS_DECL std::pair<std::size_t, double> best_cut(const Eigen::VectorXd& left) {
    const auto n = static_cast<double>(left.size());
    const double mean = left.mean();
    double sum = 0, best = 0;
    std::size_t at = 0;
    for (Eigen::Index i = 1; i < left.size(); ++i) {
        sum += left[i - 1] - mean;
        const double k = static_cast<double>(i), energy = sum * sum * n / (k * (n - k));
        if (energy > best) best = energy, at = static_cast<std::size_t>(i);
    }
    return {at, best};
}

QUADRANT_DIAGNOSIS_DECL bool sudden(const readings& r, const fitted& f) {
    constexpr Eigen::Index beside = 6;
    for (std::size_t j = 0; j < f.of.size(); ++j) {
        if (f.of[j] != term::steps) continue;
        const auto column = static_cast<Eigen::Index>(j);
        const double size = f.values[column];
        Eigen::Index at = 0;
        while (at < f.left.size() && f.columns(at, column) == 0) ++at;
        const Eigen::Index before = std::min(beside, at), behind = std::min(beside, f.left.size() - at);
        if (before == 0 || behind == 0) return false;
        const double jump =
            size + f.left.segment(at, behind).mean() - f.left.segment(at - before, before).mean();
        if (!(jump * size > 0.25 * size * size) && std::abs(size) > 4 * r.noise()) return false;
    }
    return true;
}

QUADRANT_DIAGNOSIS_DECL fitted with_steps(const readings& r, const fitted& from, double margin) {
    fitted best = from;
    link_model m = from.model;
    constexpr std::size_t most = 12;
    while (m.steps.size() < most) {
        const auto cut = best_cut(best.left);
        m.steps.push_back(r.rows()[cut.first]);
        std::sort(m.steps.begin(), m.steps.end());
        if (!m.has(term::steps)) m.freed.push_back(term::steps);
        fitted next = settled(r, fit_columns(r, m));
        double smallest = std::numeric_limits<double>::max();
        for (std::size_t j = 0; j < next.of.size(); ++j)
            if (next.of[j] == term::steps)
                smallest = std::min(smallest, std::abs(next.values[static_cast<Eigen::Index>(j)]));
        // A step that is missed is one of the counter at least, and is there from one row to the next.
        if (!(next.score > best.score + margin) || smallest < std::max(r.of().first_count, r.of().last_count) ||
            !sudden(r, next))
            break;
        m = next.model;
        best = std::move(next);
    }
    return best;
}

QUADRANT_DIAGNOSIS_DECL fitted with_term(const readings& r, const fitted& from, term t, double margin) {
    fitted out = begun_with_term(r, from, t, margin);
    return possible(r, out) ? out : from;
}

inline fitted begun_with_lag(const readings& r, const fitted& from, term t) {
    link_model m = from.model;
    const double seconds = r.of().period * static_cast<double>(r.of().rows());
    m.late(t) = least(
        [&](double late) {
            m.late(t) = late;
            return fit_columns(r, m).rms;
        },
        0.002 * r.of().period, seconds / 20, 22, 12);
    if (!m.has(t)) m.freed.push_back(t);
    return settled(r, fit_columns(r, m));
}
inline fitted begun_with_rate(const readings& r, const fitted& from) {
    link_model m = from.model;
    m.rate = least(
        [&](double rate) {
            m.rate = rate;
            return fit_columns(r, m).rms;
        },
        0.02 * r.speed(), r.speed(), 16, 12);
    if (!m.has(term::rate)) m.freed.push_back(term::rate);
    return settled(r, fit_columns(r, m));
}
inline fitted begun_with_pitch(const readings& r, const fitted& from) {
    link_model m = from.model;
    const double known = m.pitch_period > 0 ? m.pitch_period : r.of().turn;
    if (!m.has(term::pitch)) m.freed.push_back(term::pitch);
    m.pitch_harmonics = 1;
    const bool passed = known > 0 && r.travel() >= 1.5 * known;
    if (known > 0 && !passed) return from;
    const double p = known > 0 ? known : repeating_period(r, from, 0, false);
    if (!(p > 0)) return from;
    m.pitch_period = p;
    fitted best = known > 0 ? fit_columns(r, m)
                            : refined_period(r, m, p, [](link_model& x, double y) { x.pitch_period = y; });
    for (int h = 2; h <= 4; ++h) {
        link_model more = best.model;
        more.pitch_harmonics = h;
        if (known > 0 && m.pitch.size() > static_cast<std::size_t>(h)) continue;
        fitted next = fit_columns(r, more);
        if (next.score > best.score + 5) best = std::move(next);
    }
    return settled(r, std::move(best));
}
inline fitted begun_with_cyclic(const readings& r, const fitted& from, double margin) {
    link_model m = from.model;
    if (!m.has(term::cyclic)) m.freed.push_back(term::cyclic);
    const auto put = [](link_model& x, double y) { x.cyclic_period = y; };
    // The strongest wave first, however near it is to a turn: then its own period has to predict better.
    for (const double but : {0.0, r.of().turn}) {
        const double p = repeating_period(r, from, but, true);
        if (!(p > 0)) return from;
        fitted best = refined_period(r, m, p, put);
        if (is_own_period(r, best, margin)) return settled(r, std::move(best));
    }
    return from;
}

QUADRANT_DIAGNOSIS_DECL fitted begun_with_term(const readings& r, const fitted& from, term t, double margin) {
    link_model m = from.model;
    const auto freed = [&](link_model& x) {
        if (!x.has(t)) x.freed.push_back(t);
    };
    switch (t) {
    case term::rate:
        return begun_with_rate(r, from);
    case term::delay:
    case term::first_order:
        return begun_with_lag(r, from, t);
    case term::play:
        m.play = least(
            [&](double width) {
                m.play = width;
                return fit_columns(r, m).rms;
            },
            std::max(0.25 * r.of().count(), 0.5 * r.noise()), r.travel() / 12, 16, 10);
        freed(m);
        return settled(r, fit_columns(r, m));
    case term::pitch:
        return begun_with_pitch(r, from);
    case term::cyclic:
        return begun_with_cyclic(r, from, margin);
    case term::motor_friction:
        if (!(m.compliance > 0 || m.has(term::spring))) return from; // it winds up nothing
        if (m.play > 0)                                              // it decides which flank is in contact
            m.motor_coulomb = least(
                [&](double level) {
                    m.motor_coulomb = level;
                    return fit_columns(r, m).rms;
                },
                0.01 * rms(r.of().force), 1.5 * rms(r.of().force), 16, 10);
        break;
    case term::steps:
        return with_steps(r, from, margin);
    default:
        break;
    }
    freed(m);
    return settled(r, fit_columns(r, m));
}

QUADRANT_DIAGNOSIS_DECL fitted without_term(const readings& r, const fitted& from, term t,
                                            const link_model& described) {
    link_model m = from.model;
    std::erase(m.freed, t);
    if (t == term::play) m.play = described.play;
    if (of_lateness(t)) m.late(t) = described.late(t);
    if (t == term::rate) m.rate = described.rate;
    if (t == term::motor_friction) m.motor_coulomb = described.motor_coulomb;
    if (t == term::steps) m.steps.clear();
    fitted out = settled(r, fit_columns(r, m));
    if (t != term::pitch || !m.has(term::cyclic)) return out;
    // Beside the turn's wave the other one had a period that makes up for it: alone it has its own.
    fitted alone = refined_period(r, m, m.cyclic_period, [](link_model& x, double y) { x.cyclic_period = y; });
    return alone.score > out.score && is_own_period(r, alone, rules().margin) ? settled(r, std::move(alone))
                                                                              : out;
}

} // namespace quadrant::inline v0::diagnosis::chain
