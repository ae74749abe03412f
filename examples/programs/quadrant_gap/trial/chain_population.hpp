// SPDX-License-Identifier: BSL-1.0
// Long: draw_two_masses() and what it calls draw in the order that a seed stands for.
#pragma once
#include "chain_simulator.hpp"
#include "population.hpp"

/// Machines with two positions an axis, drawn: with two encoders beside a force, or positions alone.
namespace quadrant_gap::trial {

struct drawn_chain {
    std::size_t index = 0;
    planned plan{};
    double period = 0.0005;
    chain_truth truth{}, described{};
    struct {
        double mass = 0.02, force_constant = 0.01, viscous = 0.1, coulomb = 0.05, stiffness = 0.1,
               backlash = 0.1, follows = 0.05;
    } tolerance{};
    std::vector<drawn_effect> effects{};
    std::string unknown{};
    std::vector<std::string> excluded{};
    std::vector<double> log_reference{}, holdout_reference{}; ///< of machines with forces
    motion log_motion{}, holdout_motion{};                    ///< of positions alone
    std::size_t log_rows = 0, holdout_rows = 0;
    std::uint64_t noise_seed = 0;
    double cloud = 0; ///< difference of the two readings by tolerances and rounding alone

    bool has_forces() const { return plan.machines_of == population::two_encoders; }
    std::string key(std::string_view linear) const {
        return quadrant::diagnosis::key_of(linear, described.kind);
    }
};

namespace detail {

inline chain_record recorded(const drawn_chain& m, const chain_truth& a, bool holdout = false) {
    const std::uint64_t seed = m.noise_seed + holdout;
    if (m.has_forces())
        return run_two_masses(a, holdout ? m.holdout_reference : m.log_reference, m.period, seed);
    return run_positions(a, holdout ? m.holdout_motion : m.log_motion, m.period,
                         holdout ? m.holdout_rows : m.log_rows, seed);
}

/// Whether a machine does what it is for: it stays inside its limits and does not swing.
inline bool works(const drawn_chain& m, const chain_truth& a, bool holdout = false) {
    const chain_record r = recorded(m, a, holdout);
    if (r.ran_away) return false;
    double square = 0, changes = 0;
    for (std::size_t k = 1; k < r.command.size(); ++k) {
        if (std::abs(r.command[k]) >= a.limit) return false;
        square += r.command[k] * r.command[k];
        changes += (r.command[k] - r.command[k - 1]) * (r.command[k] - r.command[k - 1]);
    }
    return changes <= 0.1 * square;
}

/// What one machine's readings differ by from another's: in the difference of the two positions; for causes
/// that act on the force, in the force that is asked for.
struct chain_gap {
    double readings = 0, force = 0;
};
inline chain_gap gap_between(const chain_truth& a, const chain_record& x, const chain_record& y) {
    if (x.ran_away || y.ran_away) return {HUGE_VAL, HUGE_VAL};
    const bool asked = a.recorded != positions_recorded::counter_and_scale;
    const auto difference = [&](const chain_record& r, std::size_t k) {
        return r.scale[k] - (asked ? r.reference[k] : r.motor[k]);
    };
    double mean = 0, square = 0, force = 0;
    const auto n = static_cast<double>(x.scale.size());
    for (std::size_t k = 0; k < x.scale.size(); ++k) {
        const double d = difference(x, k) - difference(y, k);
        mean += d / n;
        square += d * d / n;
    }
    for (std::size_t k = 0; k < x.command.size(); ++k)
        force += a.force_constant * a.force_constant * (x.command[k] - y.command[k]) *
                 (x.command[k] - y.command[k]) / n;
    return {std::sqrt(std::max(0.0, square - mean * mean)), std::sqrt(force)};
}

inline bool acts_on_force(std::string_view effect) {
    return effect == "coulomb_friction" || effect == "viscous_friction" || effect == "mass" ||
           effect == "constant_force";
}

/// An effect of this amplitude, its true values under machine keys. Amplitudes are relative to what the
/// machine's readings are rounded to, or to its described numbers.
inline nlohmann::ordered_json put(const drawn_chain& m, chain_truth& a, std::string_view effect,
                                  double amplitude, dice random) {
    const double count = std::max(a.motor_encoder.resolution, a.scale.resolution), size = amplitude * count;
    const double seconds = static_cast<double>(m.log_rows) * m.period;
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    const auto told = [&](std::string_view key, double value) { out[m.key(key)] = value; };
    const auto repeats = [&](double period) {
        wave w{period, {size}, {random.phase()}};
        if (random.chance(0.4))
            w.size.push_back(size * random.uniform(0.2, 0.5)), w.phase.push_back(random.phase());
        return w;
    };
    if (effect == "lost_motion") {
        told("transmission.backlash_m", a.gears.play = m.described.gears.play + 2 * size);
    } else if (effect == "wind_up") {
        a.gears.stiffness = m.described.gears.stiffness / (1 + amplitude);
        told("transmission.stiffness_N_per_m", a.gears.stiffness);
    } else if (effect == "pitch_error") {
        a.gears.pitch = repeats(a.gears.turn);
        told("transmission.pitch_error_m", a.gears.pitch.size[0]);
    } else if (effect == "scale_error") {
        a.gears.lead = random.sign() * size / (0.3 * a.gears.bend_over);
        told("transmission.travel_per_turn_m", a.gears.turn * (1 + a.gears.lead));
    } else if (effect == "travel_error") {
        a.gears.bend_with(size, random.phase());
    } else if (effect == "encoder_cyclic_error") {
        // No fraction of the turn: that would be its error.
        a.scale.cyclic = {
            a.gears.turn * random.uniform(1.4, 1.6) / random.whole(1, 3), {size}, {random.phase()}};
        told("encoder.cyclic_m", size);
    } else if (effect == "motor_friction") {
        a.motor_friction.coulomb = amplitude * 0.02 * m.described.mass;
        told("transmission.motor_coulomb_N", a.motor_friction.coulomb);
    } else if (effect == "missed_steps") {
        for (int n = random.whole(1, 3); n > 0; --n)
            a.follows.jumps.push_back({random.uniform(0.2, 0.8) * seconds,
                                       random.sign() * a.motor_encoder.resolution * std::ceil(2 * amplitude)});
        if (a.follows.jumps.size() == 1) told("missed_step_m", -a.follows.jumps[0].by);
    } else if (effect == "command_delay") { // no amplitude: a short one is no other model than a short lag
        told("drive.command_delay_s",
             a.follows.late = m.described.follows.late + random.log_uniform(0.02, 0.08));
    } else if (effect == "drive_gain") {
        a.follows.lag = m.described.follows.lag + random.log_uniform(0.02, 0.08);
        told("drive.position_gain_per_s", 1 / a.follows.lag);
    } else if (effect == "coulomb_friction") {
        told("coulomb_N", a.guide.coulomb = m.described.guide.coulomb + amplitude * 0.02 * m.described.mass);
    } else if (effect == "viscous_friction") {
        told("viscous_N_s_per_m", a.guide.viscous = m.described.guide.viscous * (1 + amplitude));
    } else if (effect == "mass") { // on the load
        told("mass_kg", a.mass = m.described.mass * (1 + 0.1 * amplitude));
    } else {
        told("constant_force_N", a.constant_force = random.sign() * amplitude * 0.02 * m.described.mass);
    }
    return out;
}

/// What is in no list.
inline const char* put_unknown(const drawn_chain& m, chain_truth& a, double amplitude, dice random) {
    const double count = std::max(a.motor_encoder.resolution, a.scale.resolution), size = amplitude * count;
    const double seconds = static_cast<double>(m.log_rows) * m.period;
    if (m.has_forces() && random.chance(0.5)) {
        a.gears.softer_along = std::min(0.9, 0.1 * amplitude);
        return "softer_along_the_travel";
    }
    switch (m.has_forces() ? 0 : random.whole(0, 2)) {
    case 1:
        a.follows.warmth = random.sign() * size;
        a.follows.warmth_time = seconds * random.uniform(0.2, 1);
        return "warmth";
    case 2:
        a.follows.swing = size;
        a.follows.swing_Hz = random.uniform(0.05, 0.3);
        return "swinging_head";
    default:
        a.gears.dent = random.sign() * size;
        a.gears.dent_over = a.gears.bend_over * random.uniform(0.03, 0.1);
        a.gears.dent_at = a.gears.bend_from + a.gears.bend_over * random.uniform(0.1, 0.6);
        return "dent";
    }
}

inline void move_inside(const drawn_chain& m, chain_truth& a, dice& random) {
    const auto moved = [&](double& value, double relative) {
        value *= 1 + random.uniform(-relative, relative);
    };
    moved(a.mass, m.tolerance.mass);
    moved(a.force_constant, m.tolerance.force_constant);
    moved(a.guide.viscous, m.tolerance.viscous);
    moved(a.guide.coulomb, m.tolerance.coulomb);
    moved(a.gears.stiffness, m.tolerance.stiffness);
    moved(a.gears.play, m.tolerance.backlash);
    moved(a.follows.late, m.tolerance.follows);
    moved(a.follows.lag, m.tolerance.follows);
}

/// The difference of the two readings, or the force, of machines that the file describes as well: the 95th
/// percentile of twelve, and the rounding.
inline chain_gap tolerance_cloud(const drawn_chain& m, const chain_record& plain, dice random) {
    std::vector<double> readings, force;
    for (int n = 0; n < 12; ++n) {
        chain_truth a = ideal(m.described);
        move_inside(m, a, random);
        const chain_gap g = gap_between(a, recorded(m, a), plain);
        readings.push_back(g.readings);
        force.push_back(g.force);
    }
    const auto high = [](std::vector<double>& x) {
        std::sort(x.begin(), x.end());
        return x[10] + 0.45 * (x[11] - x[10]);
    };
    const bool asked = m.described.recorded != positions_recorded::counter_and_scale;
    const double rounding =
        std::hypot(asked ? 0 : m.described.motor_encoder.resolution, m.described.scale.resolution) /
        std::sqrt(12.0);
    return {std::hypot(high(readings), rounding), std::max(high(force), 1e-9)};
}

/// The effect at the amplitude whose own gap is `target` clouds, or as near as it gets.
template <class Put>
void put_in(drawn_chain& m, const std::string& name, bool by_force, double target, std::uint64_t seed,
            Put&& into) {
    const chain_record plain = recorded(m, ideal(m.described));
    const chain_gap cloud = tolerance_cloud(m, plain, dice(seed, 7));
    m.cloud = cloud.readings;
    const auto size = [&](double amplitude) {
        chain_truth a = m.described;
        into(a, amplitude, dice(seed, 8));
        const chain_gap g = gap_between(a, recorded(m, ideal(a)), plain);
        return by_force ? g.force / cloud.force : g.readings / cloud.readings;
    };
    double low = 0.02, high = 80, a = 2, found = size(a);
    for (int n = 0; n < 10 && !(std::abs(std::log(found / target)) < 0.12); ++n) {
        (std::isfinite(found) && found < target ? low : high) = a;
        const double by = std::isfinite(found) ? target / std::max(found, 1e-9) : 0.2;
        a = std::clamp(a * std::clamp(by, 0.05, 20.0), low * 1.02, high / 1.02);
        found = size(a);
    }
    nlohmann::ordered_json parameters = into(m.truth, a, dice(seed, 8));
    m.effects.push_back({name, found, std::move(parameters)});
}

/// Motor, load and gears: a screw or belt in metres, or a gear in radians.
inline void draw_two_masses(drawn_chain& m, dice& random) {
    using quadrant::diagnosis::axis_kind;
    chain_truth& a = m.described;
    m.period = random.one_of(std::vector<double>{0.000125, 0.00025, 0.0005, 0.0005});
    const bool rotary = random.chance(0.4);
    a.kind = rotary ? axis_kind::rotary : axis_kind::linear;
    a.recorded = positions_recorded::counter_and_scale; // the difference is that of the two encoders
    a.gears.turn = written(rotary ? 2 * std::numbers::pi / random.whole(30, 160)
                                  : random.one_of(std::vector<double>{0.005, 0.01, 0.01, 0.02}));
    a.mass = written(rotary ? random.log_uniform(0.05, 5) : random.log_uniform(30, 300));
    a.motor_mass = written(a.mass * random.uniform(0.15, 0.6));
    const double peak = random.log_uniform(8, 40),
                 half = rotary ? random.uniform(0.4, 1.5) : a.gears.turn * random.uniform(6, 15);
    a.force_constant = written(a.mass * peak / a.limit);
    a.delay = written(m.period * random.uniform(0.1, 1.2));
    a.guide.viscous = written(a.mass * random.log_uniform(0.3, 3));
    a.guide.coulomb = random.chance(0.8) ? written(a.mass * peak * random.log_uniform(0.005, 0.03)) : 0;
    a.guide.law = static_cast<contact_law>(random.whole(0, 3));
    a.guide.exponent = random.uniform(0.6, 1.5);
    a.guide.weights = {0.3, 0.4, 0.3};
    a.guide.ways = {0.4, 1, 2};
    a.motor_friction.law = contact_law::dahl;
    const bool soft = random.chance(0.5);
    const double resonance = soft ? random.log_uniform(40, 90) : random.log_uniform(90, rotary ? 200 : 400);
    const double together = a.motor_mass * (a.mass - a.motor_mass) / a.mass;
    a.gears.stiffness = written(together * std::pow(2 * std::numbers::pi * resonance, 2));
    // Counts in proportion to what a fifth of the peak force winds up.
    const double unit = rotary ? 1e-5 : 1e-6;
    a.scale.resolution = unit * random.one_of(std::vector<double>{0.1, 0.5, 1, 1, 2, 5});
    a.motor_encoder.resolution =
        a.gears.turn / random.one_of(std::vector<double>{8192, 20000, 131072, 1048576});
    a.guide.length = a.motor_friction.length = (rotary ? 10 : 1) * random.log_uniform(5e-8, 4e-7);
    for (encoder_truth* e : {&a.motor_encoder, &a.scale})
        e->noise = e->resolution * random.log_uniform(0.05, 0.4);
    if (random.chance(0.3)) a.gears.play = written(a.scale.resolution * random.uniform(3, 20));
    // Above its resonance the motor is alone: that is where its velocity loop has to be stable.
    a.filter_Hz = 0.08 / m.period;
    const double late = a.delay + 1.5 * m.period + 1 / (2 * std::numbers::pi * a.filter_Hz);
    const double crossover =
        std::min({2 * std::numbers::pi * std::min(45.0, resonance / 4), 0.4 * a.motor_mass / a.mass / late});
    a.velocity_gain = crossover * a.mass / a.force_constant;
    a.position_gain = crossover * random.uniform(0.1, 0.2);
    a.integral = a.velocity_gain * crossover * random.uniform(0.05, 0.15);
    a.acceleration_feedforward = a.mass / a.force_constant * random.uniform(0.85, 1);
    motion_limits l;
    l.half_travel = half;
    l.acceleration = peak * random.uniform(0.2, 0.45);
    l.velocity = std::min(half * random.uniform(1, 4), 0.6 * (rotary ? 8 : 1));
    l.top_Hz = std::min(30.0, resonance / 3);
    for (const bool holdout : {false, true}) {
        l.seconds = holdout ? 6 : random.uniform(8, 12);
        const motion way = rich_motion(l, random);
        const auto rows = static_cast<std::size_t>(std::min(l.seconds, way.seconds()) / m.period);
        (holdout ? m.holdout_reference : m.log_reference) = way.sampled(m.period, rows);
        (holdout ? m.holdout_rows : m.log_rows) = rows;
    }
    const auto [low, high] = std::minmax_element(m.log_reference.begin(), m.log_reference.end());
    a.gears.bend_from = *low;
    a.gears.bend_over = *high - *low;
    m.tolerance = {written(random.log_uniform(0.005, 0.04)),
                   written(random.log_uniform(0.005, 0.03)),
                   written(random.uniform(0.05, 0.2)),
                   written(random.uniform(0.03, 0.1)),
                   written(random.uniform(0.05, 0.12)),
                   0.1,
                   0.05};
}

/// Moves from place to place, as a program makes them: long and short, fast and slow, with rests.
inline motion moves_of_a_program(double travel, double fastest, double seconds, dice& random) {
    motion out;
    out.rest(0.5);
    double x = 0;
    while (out.seconds() < seconds) {
        const bool far = random.chance(0.7);
        const double to =
            far ? random.uniform(0, travel)
                : std::clamp(x + random.sign() * random.log_uniform(0.003, 0.06) * travel, 0.0, travel);
        if (std::abs(to - x) < 1e-3 * travel) continue;
        const double speed = fastest * random.one_of(std::vector<double>{0.08, 0.3, 0.6, 1});
        out.stroke(to - x, speed, fastest / random.uniform(0.1, 0.5));
        x = to;
        if (random.chance(0.4)) out.rest(random.uniform(0.1, 1));
    }
    return out;
}

/// A counter, an order or a motor's encoder, and a scale.
inline void draw_positions(drawn_chain& m, bool asked, dice& random) {
    using quadrant::diagnosis::axis_kind;
    chain_truth& a = m.described;
    m.period = 1 / random.one_of(std::vector<double>{10, 20, 50, 50, 100});
    const bool rotary = random.chance(0.3);
    a.kind = rotary ? axis_kind::rotary : axis_kind::linear;
    const double unit = rotary ? 10 : 1, travel = unit * random.log_uniform(0.05, 0.5);
    a.gears.turn = written(rotary ? 2 * std::numbers::pi / random.whole(40, 180)
                                  : random.one_of(std::vector<double>{0.002, 0.005, 0.01}));
    a.motor_encoder.resolution = a.gears.turn / random.one_of(std::vector<double>{400, 1600, 3200, 12800});
    a.scale.resolution = unit * random.one_of(std::vector<double>{5e-7, 1e-6, 1e-6, 5e-6});
    a.scale.noise = a.scale.resolution * random.log_uniform(0.05, 0.5);
    a.recorded = !asked               ? positions_recorded::counter_and_scale
                 : random.chance(0.3) ? positions_recorded::all_three
                                      : positions_recorded::asked_and_scale;
    if (random.chance(0.3)) a.gears.play = written(random.uniform(3, 10) * a.scale.resolution);
    if (asked && random.chance(0.5)) {
        const auto& e = m.plan.effects;
        const bool gain = std::find(e.begin(), e.end(), "drive_gain") != e.end();
        const bool late = std::find(e.begin(), e.end(), "command_delay") != e.end();
        (gain || (!late && random.chance(0.5)) ? a.follows.lag : a.follows.late) =
            written(random.log_uniform(0.01, 0.06));
    }
    const double seconds = random.uniform(60, 120), fastest = travel * random.uniform(0.15, 0.5);
    m.log_motion = moves_of_a_program(travel, fastest, seconds, random);
    const auto way = m.log_motion.sampled(m.period, static_cast<std::size_t>(seconds / m.period));
    const auto [low, high] = std::minmax_element(way.begin(), way.end());
    a.gears.bend_from = *low;
    a.gears.bend_over = *high - *low;
    m.holdout_motion = moves_of_a_program(travel, fastest, 0.6 * seconds, random);
    m.log_rows = static_cast<std::size_t>(seconds / m.period);
    m.holdout_rows = static_cast<std::size_t>(0.6 * seconds / m.period);
}

} // namespace detail

/// Machine `index` of the trial with this seed: the same whatever else is drawn.
inline drawn_chain draw_chain(std::uint64_t seed, std::size_t index, const planned& p) {
    constexpr std::uint64_t most = 2000;
    for (std::uint64_t attempt = 0; attempt < most; ++attempt) {
        const std::uint64_t own = seed * 1000003 + index * 101 + attempt * 7919;
        dice random(own, 2);
        drawn_chain m;
        m.index = index;
        m.plan = p;
        m.noise_seed = own;
        const auto has = [&](const char* e) {
            return std::find(p.effects.begin(), p.effects.end(), e) != p.effects.end();
        };
        const bool of_the_drive = has("command_delay") || has("drive_gain");
        if (m.has_forces())
            detail::draw_two_masses(m, random);
        else
            detail::draw_positions(m, of_the_drive || random.chance(0.5), random);
        m.truth = m.described;
        if (static_cast<double>(m.log_rows) * m.period < 4 || !detail::works(m, m.described)) continue;
        const auto target = [&] {
            if (p.what == kind::single) return random.log_uniform(2, 15);
            return p.what == kind::removed || p.what == kind::unknown ? random.log_uniform(4, 15)
                                                                      : random.log_uniform(2.5, 12);
        };
        if (p.what == kind::unknown)
            detail::put_in(m, "unknown", false, target(), own, [&](chain_truth& a, double amplitude, dice d) {
                m.unknown = detail::put_unknown(m, a, amplitude, d);
                return nlohmann::ordered_json{{"unknown", m.unknown}};
            });
        std::uint64_t stream = own;
        for (const std::string& e : p.effects)
            detail::put_in(
                m, e, detail::acts_on_force(e), target(), stream++,
                [&](chain_truth& a, double amplitude, dice d) { return detail::put(m, a, e, amplitude, d); });
        const double least = p.what == kind::unknown || p.what == kind::removed ? 3 : 1.5;
        if (std::any_of(m.effects.begin(), m.effects.end(), [&](const drawn_effect& e) {
                return !(e.size > least && (of_the_drive || e.size < 30));
            }))
            continue;
        // Calibration moves what is described; what an effect has set stays.
        chain_truth moved = m.truth;
        detail::move_inside(m, moved, random);
        for (const drawn_effect& e : m.effects) {
            if (e.name == "lost_motion") moved.gears.play = m.truth.gears.play;
            if (e.name == "wind_up") moved.gears.stiffness = m.truth.gears.stiffness;
            if (e.name == "coulomb_friction") moved.guide.coulomb = m.truth.guide.coulomb;
            if (e.name == "viscous_friction") moved.guide.viscous = m.truth.guide.viscous;
            if (e.name == "mass") moved.mass = m.truth.mass;
            if (e.name == "command_delay") moved.follows.late = m.truth.follows.late;
            if (e.name == "drive_gain") moved.follows.lag = m.truth.follows.lag;
        }
        m.truth = std::move(moved);
        if (p.what == kind::removed) m.excluded.push_back(p.effects.front());
        if (detail::works(m, m.truth) && detail::works(m, m.truth, true)) return m;
    }
    throw std::logic_error("no machine of the trial has this effect at any size");
}

} // namespace quadrant_gap::trial
