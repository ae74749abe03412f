// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "controller_box.hpp"
#include "record.hpp"

#include <fmt/format.h>

#include <random>
#include <stdexcept>

namespace quadrant::diagnosis {

/// The controller box judged by replay: deterministic, so whatever is above rounding is a controller that is
/// not the one described. Which key differs is found by fitting one at a time, on this box alone.
struct controller_finding {
    std::vector<double> replayed; ///< the described controller on the logged r and y
    double difference_rms = 0;    ///< against the logged command
    double floor_rms = 0;         ///< DAC and the rounding of the columns, carried through the differences
    bool differs = false;
    std::string key; ///< that mends it best; empty: none does
    double described = 0, value = 0, low = 0, high = 0;
    double after_rms = 0; ///< with the key mended
    bool mended = false;  ///< the mended controller agrees to rounding
    std::vector<double> mended_command;
    /// Another key that brings the replay back to rounding as well: the log cannot distinguish the two.
    struct alternative {
        std::string key;
        double value = 0;
    };
    std::vector<alternative> alternatives; ///< of `key`, where that mends
};

namespace detail {

/// A number of a controller that may be found to be another.
struct searched_key {
    std::string key;
    std::function<double&(controller_description&)> of;
    double scale; ///< a sensible size when the described value is zero
    std::function<bool(double)> allowed = [](double) { return true; };
    std::vector<double> only{}; ///< the values that it may have; empty: any
};

/// A small size of a quantity on this axis, a hundredth of what its unit is made of there: largest command, speed and time constant
/// of the record. 0: the word holds no unit.
inline double size_of(std::string_view words, const record_scales& of) {
    double size = 0.01;
    bool divides = false, any = false;
    while (!words.empty()) {
        const std::string_view word = words.substr(0, words.find('_'));
        words.remove_prefix(std::min(words.size(), word.size() + 1));
        const auto times = [&](double x) {
            size *= divides ? 1 / x : x;
            any = true;
        };
        const bool was_unit = any;
        if (word == "per")
            divides = true;
        else if (word == "V" || word == "A" || word == "N")
            times(of.command);
        else if (word == "m" || word == "rad")
            times(of.speed * of.response());
        else if (word == "s")
            times(of.response());
        else if (word == "s2")
            times(of.response() * of.response());
        else if (word == "s3")
            times(of.response() * of.response() * of.response());
        else if (word == "Hz")
            return of.bandwidth_Hz();
        else if (was_unit)
            return 0; // a word behind a unit: it was none
    }
    return any ? size : 0;
}
inline double size_of(const controller_key& key, const controller_kind& kind, const given_values& values,
                      const record_scales& of) {
    const double size = size_of(key.of_unit.empty() ? key.last() : key.of_unit, of);
    if (size == 0) return key.scale;
    const bool in_units_of_its_own =
        !key.of_unit.empty() && key.of_unit.find("per_m") != key.of_unit.npos &&
        std::any_of(kind.keys.begin(), kind.keys.end(), [](auto& k) { return k.name == "units_per_m"; });
    return in_units_of_its_own ? size / values["units_per_m"] : size;
}

/// The numbers of a controller that are searched for the one that differs; the sizes of those that are 0 follow from the record.
inline std::vector<searched_key> searched_keys(const controller_description& c, const record_scales& of = {}) {
    using d = controller_description;
    std::vector<searched_key> out;
    if (c.own) {
        for (std::size_t i = 0; i < c.own->keys.size(); ++i)
            out.push_back({c.own->keys[i].key, [i](d& x) -> double& { return x.own->keys[i].value; },
                           c.own->keys[i].scale});
        return out;
    }
    const controller_kind& kind = kind_of(c);
    const given_values values(kind, c);
    for (const controller_key& key : kind.keys) {
        const bool there = values.has(key.name) || (!key.in_box() && std::isfinite(key.otherwise)),
                   in_box = key.in_box() && values.has_box(key.box()) && std::isfinite(key.otherwise),
                   sized = key.scale != 0 || values[key.name] != 0,
                   one_number = key.form == key_form::number || key.form == key_form::yes_no;
        if (!key.searched || !one_number || !sized || !(there || in_box)) continue;
        const double scale =
            key.scale_of.empty() ? size_of(key, kind, values, of) : values[key.scale_of] * size_of("per_s", of);
        out.push_back({std::string(key.name),
                       [name = std::string(key.name), start = values[key.name]](d& x) -> double& {
                           auto& place = x.values[name];
                           if (place.empty()) place = {start};
                           return place.front();
                       },
                       scale, key.rule.holds});
        if (key.form == key_form::yes_no) out.back().only = {0, 1};
    }
    return out;
}

/// A difference at row k without what the sign of the reference's velocity makes of it where rounding of the
/// column decides that sign: by one or two Coulomb feedforwards the command may then be off.
inline double but_for_the_sign(double difference, double coulomb_feedforward, std::size_t k,
                               const axis_log& log) {
    if (std::abs(log.reference[k] - log.reference[k - 1]) > log.reference_step) return difference;
    double least = difference;
    for (const double signs : {-2.0, -1.0, 1.0, 2.0})
        if (const double other = difference + signs * coulomb_feedforward; std::abs(other) < std::abs(least))
            least = other;
    return least;
}

/// Largest command that rounding alone explains: half a DAC step on each side, and half a digit of each column
/// carried through the differences and gains of the controller.
inline double replay_rounding(const controller_kind& kind, const controller_description& c,
                              const actuator_description& a, const axis_log& log, double period) {
    const double dac = a.dac_bits && a.dac_range_V ? *a.dac_range_V / std::exp2(*a.dac_bits) : 0;
    return dac + log.command_step +
           kind.rounding(given_values(kind, c), log.reference_step, log.position_step, period);
}

/// The same where it has no closed form: the columns are perturbed by as much as they were rounded.
template <class Replay>
double replay_rounding(const actuator_description& a, const axis_log& log, std::size_t from,
                       const std::vector<double>& replayed, Replay replay) {
    std::mt19937_64 random(20080901);
    const auto shaken = [&](std::vector<double> column, double step) {
        for (double& x : column) x += step * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
        return column;
    };
    const auto moved =
        replay(shaken(log.reference, log.reference_step), shaken(log.position, log.position_step));
    double most = a.dac_bits && a.dac_range_V ? *a.dac_range_V / std::exp2(*a.dac_bits) : 0;
    for (std::size_t k = from; k < moved.size(); ++k) most = std::max(most, std::abs(moved[k] - replayed[k]));
    return most + log.command_step;
}

} // namespace detail

inline controller_finding judge_controller(const controller_description& described,
                                           const actuator_description& actuator, const axis_log& log,
                                           const axis_record& record) {
    using namespace detail;
    controller_finding out;
    const controller_kind* kind = described.own ? nullptr : &kind_of(described);
    const double coulomb =
        kind && !kind->coulomb.key.empty() ? given_values(*kind, described)[kind->coulomb.key] : 0;
    const auto from = std::min(record.score.skip, log.command.size());
    const auto difference = [&](const std::vector<double>& replayed) {
        std::vector<double> d(replayed.size() - from);
        for (std::size_t k = from; k < replayed.size(); ++k)
            d[k - from] =
                but_for_the_sign(replayed[k] - log.command[k], coulomb, std::max<std::size_t>(1, k), log);
        return d;
    };
    const auto replay = [&](const controller_description& c) {
        return replay_controller(c, actuator, record.period, loop_columns::of(log));
    };
    out.replayed = replay(described);
    const auto broken =
        std::find_if_not(out.replayed.begin(), out.replayed.end(), [](double u) { return std::isfinite(u); });
    if (described.own && broken != out.replayed.end())
        throw std::invalid_argument(
            fmt::format("the controller of axis {}: its command at row {} is not finite", log.name,
                        broken - out.replayed.begin()));
    const double rounding =
        kind && kind->rounding
            ? replay_rounding(*kind, described, actuator, log, record.period)
            : replay_rounding(actuator, log, from, out.replayed,
                              [&](const auto& reference, const auto& position) {
                                  loop_columns perturbed = loop_columns::of(log);
                                  perturbed.reference = reference, perturbed.position = position;
                                  return replay_controller(described, actuator, record.period, perturbed);
                              });
    const auto score = [&](const std::vector<double>& d) {
        double sum = 0;
        for (double ms : block_ms(d, 0, record.score.block)) sum += std::log(ms + rounding * rounding);
        return sum;
    };
    const auto d0 = difference(out.replayed);
    out.difference_rms = rms(d0);
    out.floor_rms = rounding;
    // Below half a per cent of the command a controller is the described one, to the accuracy of its recording.
    const double agrees = std::max(2 * rounding, 0.005 * rms(std::span(log.command).subspan(from)));
    out.differs = out.difference_rms > agrees;
    out.after_rms = out.difference_rms;
    if (!out.differs) return out;

    constexpr double none = std::numeric_limits<double>::infinity();
    double best = score(d0), width = 0;
    std::vector<controller_finding::alternative> mends;
    for (const auto& key : searched_keys(described, record.scale)) {
        controller_description trial = described;
        double& value = key.of(trial);
        const double given = value, scale = given != 0 ? std::abs(given) : key.scale;
        const double nyquist = 0.499 / record.period;
        const bool is_frequency = key.key.ends_with("_Hz");
        const auto at = [&](double x) {
            value = is_frequency ? std::min(x, nyquist) : x;
            try {
                const double s = score(difference(replay(trial)));
                if (std::isfinite(s)) return s;
                return none;
            } catch (const std::exception&) { // no controller has this value
                return none;
            }
        };
        // A coarse scan over ratios finds the valley, golden section its bottom.
        std::vector<double> grid = key.only;
        const double sign = given < 0 ? -1 : 1;
        for (double x :
             {0.0, 0.1, 0.25, 0.4, 0.55, 0.7, 0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.25, 1.5, 1.8, 2.3, 3.0, 4.5})
            if (key.only.empty() && key.allowed(sign * x * scale)) grid.push_back(sign * x * scale);
        if (given == 0 && key.only.empty())
            for (double x : {0.03, 10.0, 30.0}) grid.push_back(x * scale);
        std::sort(grid.begin(), grid.end());
        std::size_t low_at = 0;
        double low_score = none;
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (const double s = at(grid[i]); s < low_score) {
                low_score = s;
                low_at = i;
            }
        double a = grid[low_at == 0 ? 0 : low_at - 1], b = grid[std::min(low_at + 1, grid.size() - 1)];
        if (!key.only.empty()) a = b = grid[low_at];
        constexpr double golden = 0.6180339887498949;
        double x1 = b - golden * (b - a), x2 = a + golden * (b - a), f1 = at(x1), f2 = at(x2);
        for (int i = 0; i < 24 && b - a > 1e-7 * scale; ++i) {
            if (f1 < f2) {
                b = x2;
                x2 = x1;
                f2 = f1;
                x1 = b - golden * (b - a);
                f1 = at(x1);
            } else {
                a = x1;
                x1 = x2;
                f1 = f2;
                x2 = a + golden * (b - a);
                f2 = at(x2);
            }
        }
        const double x = 0.5 * (a + b), s = at(x);
        if (!(s < none)) continue;
        const auto command = replay(trial);
        const double after = rms(difference(command));
        if (after <= agrees && after < 0.5 * out.difference_rms) mends.push_back({key.key, value});
        if (s < best) {
            best = s;
            out.key = key.key;
            out.described = given;
            out.value = value;
            out.mended_command = command;
            out.after_rms = after;
            // What rounding of the command leaves open, from the command's sensitivity to the value.
            const double h = 1e-3 * scale * (x > given ? -1 : 1); // towards what it can have
            width = std::abs(x - given);
            try {
                value = x + h;
                auto moved = replay(trial);
                for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = (moved[k] - command[k]) / h;
                const double slope = rms(std::span<const double>(moved).subspan(from));
                width = slope > 0 ? 1.96 * std::max(out.after_rms, rounding) /
                                        (slope * std::sqrt(static_cast<double>(log.command.size()) /
                                                           static_cast<double>(record.score.block)))
                                  : 0;
            } catch (const std::exception&) { // at the edge of what it can have: it is only known to differ
            }
        }
    }
    out.low = out.value - width;
    out.high = out.value + width;
    out.mended = !out.key.empty() && out.after_rms <= agrees && out.after_rms < 0.5 * out.difference_rms;
    if (out.mended)
        for (auto& other : mends)
            if (other.key != out.key) out.alternatives.push_back(std::move(other));
    return out;
}

} // namespace quadrant::diagnosis
