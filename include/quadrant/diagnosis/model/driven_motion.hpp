// SPDX-License-Identifier: BSL-1.0
// Long: one class for each way in which a drive takes its set-points, row by row.
#pragma once
#include "../log/log.hpp"
#include "../log/signals.hpp"
#include "../machine/set_point_rows.hpp"
#include "drive_model.hpp"

#include <cmath>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// A row at which another log begins, and with which velocity [m/s]: the machine stands there anew, and its
/// clocks begin.
struct log_start {
    std::size_t row;
    double velocity;
};

/// When a drive takes the set-points of a record, on its own clock.
struct set_point_arrivals {
    double every; ///< [rows]
    double first; ///< row of the first one
    bool between; ///< several come in a row of the log, which has one of them

    /// `set_points`: one a row, of one log.
    set_point_arrivals(const drive_model& d, double period, std::span<const double> set_points)
        : set_point_arrivals(d.set_point_period > 0 ? d.set_point_period / period : 1, d, set_points) {}
    /// The newest row as the n-th one arrives: one comes twice, or never, where the two clocks differ.
    std::size_t row(long n) const { return static_cast<std::size_t>(at(n)); }
    /// The n-th one, of the set-points in these rows. Of several in a row it lies on the curve through them.
    double value(std::span<const double> rows, long n) const {
        const std::size_t k = std::min(row(n), rows.size() - 1);
        return between ? on_curve(rows, k, at(n) - static_cast<double>(row(n))) : rows[k];
    }

private:
    set_point_arrivals(double rows, const drive_model& d, std::span<const double> set_points)
        : every(rows * (1 + std::clamp(d.clock_slip, -0.5, 0.5))),
          first(static_cast<double>(row_of_change(set_points, rows))), between(rows < 0.999) {}

    double at(long n) const { return std::max(0.0, first + static_cast<double>(n) * every + 1e-6); }
    /// At the share p of the way from a row to the next: the line, less the sagitta on which both ends agree. A
    /// step is no curve.
    static double on_curve(std::span<const double> x, std::size_t row, double p) {
        const auto at = [&](std::size_t k) { return x[std::min(k, x.size() - 1)]; };
        const double a = at(row > 0 ? row - 1 : 0), b = at(row), c = at(row + 1), d = at(row + 2),
                     here = a - 2 * b + c, there = b - 2 * c + d;
        const double bend = here * there > 0 ? (std::abs(here) < std::abs(there) ? here : there) : 0;
        return b + p * (c - b) - 0.5 * p * (1 - p) * bend;
    }
};

/// The set-points of a record on the drive's clock: what its loops follow during each part of a row.
class set_point_clock {
public:
    /// `values`: one a row, `period` seconds apart; `others`: the logs behind the first one.
    set_point_clock(const drive_model& d, std::span<const double> values, double period,
                    std::span<const log_start> others)
        : values_(values), others_(others), line_(d.between),
          loss_(d.losses_known() ? 0 : std::clamp(d.loss, 0.0, 1.0)), delay_((d.delay + d.read.age) / period),
          drive_(d), period_(period), arrivals_(d, period, own_values()), state_(line_state::at(values[0])) {}

    /// Mean of the set-point, of its slope and of the velocity that a feedforward takes [a row] from `begin` to
    /// `end`, in rows; call with rising times.
    struct stretch {
        double value, slope, velocity;
    };
    stretch between(double begin, double end) {
        if (!others_.empty() && begin >= static_cast<double>(others_.front().row)) begin_anew();
        const double since = first_ + delay_ + arrivals_.first, a = (begin - since) / arrivals_.every,
                     b = (end - since) / arrivals_.every;
        stretch out{0, 0, 0};
        for (double from = a; from < b;) { // pieces without an arrival
            const double to = std::min(b, static_cast<double>(next_));
            if (to > from) {
                const double p = std::clamp(0.5 * (from + to) - static_cast<double>(next_) + 1, 0.0, 1.0);
                out.value += (to - from) * line_(state_, p);
                out.slope += (to - from) * line_.slope(state_, p);
                out.velocity += (to - from) * line_.velocity(state_, p);
                from = to;
            }
            if (from < b) arrive();
        }
        const double mean = 1 / (b - a);
        const double a_row = mean / arrivals_.every;
        return {out.value * mean, out.slope * a_row, out.velocity * a_row};
    }

private:
    using line_state = set_point_line<>::state;

    /// Those of the log that runs.
    std::span<const double> own_values() const {
        return others_.empty() ? values_
                               : values_.first(others_.front().row - static_cast<std::size_t>(first_));
    }
    void begin_anew() {
        const std::size_t row = others_.front().row;
        others_ = others_.subspan(1);
        values_ = values_.subspan(row - static_cast<std::size_t>(first_));
        first_ = static_cast<double>(row);
        arrivals_ = set_point_arrivals(drive_, period_, own_values());
        state_ = line_state::at(values_[0]);
        next_ = 0;
    }
    void arrive() {
        const double x = arrivals_.value(values_, next_);
        // A lost set-point repeats the one before; on average a share of them does.
        line_.arrive(state_, x + loss_ * (state_.last[0] - x));
        ++next_;
    }

    std::span<const double> values_; ///< of the log that runs, and of those behind it
    std::span<const log_start> others_;
    set_point_line<> line_;
    double loss_, delay_;
    double first_ = 0; ///< row of the log that runs
    const drive_model& drive_;
    double period_;
    set_point_arrivals arrivals_;
    line_state state_;
    long next_ = 0; ///< the set-point that arrives next
};

/// What a drive's loops follow in each step of each row, as many steps in every row.
struct followed_set_points {
    std::vector<double> value;    ///< of the set-point, mean over the step
    std::vector<double> velocity; ///< of its velocity [a second]
};

/// The set-points that drives of one timing follow, made once: most models of a search differ in anything but
/// the drive's clock. Threads may ask side by side. A copy begins empty.
class set_point_memory {
public:
    set_point_memory() = default;
    set_point_memory(const set_point_memory&) {}
    set_point_memory& operator=(const set_point_memory&) {
        const std::lock_guard lock(mutex_);
        kept_.clear();
        return *this;
    }

    /// `set_point`: one a row, the same in every call for drives that received the same; `others`: the logs
    /// behind the first one, likewise.
    std::shared_ptr<const followed_set_points> of(const drive_model& d, std::size_t steps,
                                                  std::span<const double> set_point, double period,
                                                  std::span<const log_start> others) const {
        const bool known = d.losses_known();
        const timing asked{.between = d.between,
                           .set_point_period = d.set_point_period,
                           .delay = d.delay + d.read.age,
                           .loss = known ? 0 : d.loss,
                           .clock_slip = d.clock_slip,
                           .steps = steps,
                           .received = known ? d.received : nullptr};
        {
            const std::lock_guard lock(mutex_);
            for (const auto& [of, points] : kept_)
                if (of == asked) return points;
        }
        auto made = std::make_shared<const followed_set_points>(follow(d, steps, set_point, period, others));
        const std::size_t size = 2 * sizeof(double) * std::max<std::size_t>(1, steps * set_point.size());
        const std::size_t most = std::max(least, affordable / size);
        const std::lock_guard lock(mutex_);
        if (kept_.size() < most)
            kept_.emplace_back(asked, made);
        else
            kept_[next_++ % kept_.size()] = {asked, made};
        return made;
    }

private:
    static constexpr std::size_t least = 8, // the models of one pass
        affordable = std::size_t{1} << 25;  // bytes
    struct timing {
        interpolation between;
        double set_point_period, delay, loss, clock_slip;
        std::size_t steps;
        std::shared_ptr<const received_set_points> received;
        bool operator==(const timing&) const = default;
    };
    static followed_set_points follow(const drive_model& d, std::size_t steps,
                                      std::span<const double> set_point, double period,
                                      std::span<const log_start> others) {
        const std::size_t all = set_point.size() * steps;
        followed_set_points out{std::vector<double>(all), std::vector<double>(all)};
        set_point_clock clock(d, set_point, period, others);
        for (std::size_t j = 0; j < all; ++j) {
            const double begin = static_cast<double>(j) / static_cast<double>(steps);
            const auto r = clock.between(begin, begin + 1 / static_cast<double>(steps));
            out.value[j] = r.value;
            out.velocity[j] = r.velocity / period;
        }
        return out;
    }

    mutable std::mutex mutex_{};
    mutable std::vector<std::pair<timing, std::shared_ptr<const followed_set_points>>> kept_{};
    mutable std::size_t next_ = 0;
};

/// What a drive with loops of its own received, and the motion that it saw: as logged. Its law is replayed on
/// this, so that nothing is judged through a loop that hides what is wrong.
struct driven_motion {
    static constexpr std::size_t parts = 4; ///< of a row, in which the drive acts with one velocity

    double period = 0;
    std::vector<double> set_point;          ///< command of a velocity drive, else position; one a row
    bool in_volts = false;                  ///< a velocity drive's command
    std::vector<double> position, velocity; ///< of the motor [m], [m/s]
    bool one_encoder = true; ///< the position of the log is what the drive reads; else the motor has an encoder
    std::vector<double> position_in_parts, velocity_in_parts; ///< in the middle of each part of each row
    std::vector<unsigned char> off; ///< rows in which the drive gives nothing; empty: none
    /// What was measured behind the drive at the rows: duty of a position servo, else force [N]; empty: nothing
    /// was.
    std::vector<double> measured;
    /// Force that the drive is told to add to what its velocity loop gives, of each row [N]; empty: none. Only
    /// a forecast has it.
    std::vector<double> added{};
    double constant =
        1; ///< force of a unit of the actuator's command, as described, where the drive gives a force
    /// Force that the described machine needs for the measured motion, one a row [N], and what it moves [kg]:
    /// the level at which a replayed integral stands; empty: it stands where the replay takes it.
    std::vector<double> needed{};
    double mass = 0;
    /// Rows that nobody read, from `first` to before `behind`, and what the drive gave from `from` to `until`
    /// on average [N], as it was measured or as the described machine needs it. A replay gives that meanwhile,
    /// and finds its integral again from it.
    struct unread_rows {
        std::size_t first, behind, from, until;
        double force;
    };
    std::vector<unread_rows> unread{};
    std::vector<log_start> begins{}; ///< other logs behind the first one
    set_point_memory memory{};       ///< of set_point: not asked before that is whole
    double to_position =
        0; ///< of a position servo: scales duty given otherwise than measured to the noise of the reading [m]

    /// The velocity of the position: central differences of the sixth order, to half a per cent at a seventh of
    /// the sample rate. No
    /// filter: a drive that is excited fast follows the fast velocity.
    void find_velocity() {
        velocity = derivative(position, period);
        const auto& x = position;
        for (std::size_t k = 3; k + 3 < x.size(); ++k)
            velocity[k] = (45 * (x[k + 1] - x[k - 1]) - 9 * (x[k + 2] - x[k - 2]) + (x[k + 3] - x[k - 3])) /
                          (60 * period);
        position_in_parts = in_the_middle_of_parts(position);
        velocity_in_parts = in_the_middle_of_parts(velocity);
    }
    /// How fast a replayed integral goes to the level that the motion needs [1/s]; 0: not at all.
    /// The integral of a replay is in an open loop: a gain that is wrong by its tolerance takes it to any force
    /// within a stroke, and a limit would then hold it there, in every row, whatever the gains are. So the
    /// limit is judged near the level that the motion needs, to a quarter of it: what a described plant is
    /// wrong by must not move a limit that acts. What is given out is as if nothing had been lifted.
    double level_rate(const drive_model& d) const {
        return std::isfinite(d.force_limit) ? integral_rate(d) : 0;
    }
    /// How fast the integral of this drive moves the axis [1/s]; 0: it has none.
    double integral_rate(const drive_model& d) const {
        if (!(mass > 0) || !d.has_integral()) return 0;
        const double of_integral = d.velocity_integral / mass;
        return d.kind == drive_kind::position && d.position_gain > 0 ? std::cbrt(d.position_gain * of_integral)
                                                                     : std::sqrt(of_integral);
    }
    bool is_off(std::size_t k) const { return !off.empty() && off[k]; }
    bool tapped() const { return !measured.empty(); }
    /// What this drive received, where that was found of this record; else what was sent.
    std::span<const double> set_points_of(const drive_model& d) const {
        const bool here = d.losses_known() && d.received->values.size() == set_point.size();
        return here ? d.received->values : set_point;
    }

    /// What the loops of this drive follow in each step of each row, in the unit of `set_point`.
    std::shared_ptr<const followed_set_points> follows(const drive_model& d, std::size_t steps) const {
        return memory.of(d, steps, set_points_of(d), period, begins);
    }

    /// What the law of this drive gives in each row, on average: duty of a position servo, else force [N].
    std::vector<double> given(const drive_model& d) const { return row_means(in_parts(d).given); }

    /// What the actuator gets of what the drive gives: volts of a duty, else the command that makes the force.
    std::vector<double> to_actuator(const drive_model& d, std::vector<double> out) const {
        const double by = d.kind == drive_kind::position_servo ? d.supply : 1 / constant;
        for (double& u : out) u *= by;
        return out;
    }
    /// What one drive makes of the record.
    struct replay {
        std::vector<double> command; ///< of the actuator, mean over each row
        std::vector<double>
            beside; ///< measured less given where it was measured: duty, else force [N]; empty: no tap
    };
    /// The actuator's command is what this drive gives, moved to what was measured: a bridge that follows
    /// set-points in steps was read once a row only, and its mean over the row is not that reading.
    replay run(const drive_model& d) const {
        const auto fine = in_parts(d);
        replay out{row_means(fine.given), {}};
        if (tapped()) {
            out.beside = beside(d, seen_by_tap(d, fine));
            const auto last = static_cast<double>(measured.size() - 1);
            const double middle = d.read.tap == tap_reading::row_mean ? 0 : 0.5;
            for (std::size_t k = 0; k < out.command.size(); ++k) {
                if (is_off(k)) continue;
                const double at = static_cast<double>(k) + middle - d.read.age / period;
                out.command[k] += between(out.beside, std::clamp(at, 0.0, last));
            }
        }
        out.command = to_actuator(d, std::move(out.command));
        return out;
    }
    /// When the readings of this record were taken, where registers are read one after another: the best of
    /// seven moments each for those of position and tap within a row. A set-point that arrives between two
    /// moments makes a step, which no slope sees: a fit has to begin on the right side of it.
    reading_times timing(drive_model d) const {
        reading_times best = d.read;
        if (!d.reads_in_turn()) return best;
        double least = drive_model::none;
        for (int age = -3; age <= 3; ++age)
            for (int lateness = -3; lateness <= 3; ++lateness) {
                d.read = {age * period / 4, lateness * period / 4};
                double sum = 0;
                for (double e : run(d).beside) sum += e * e;
                if (sum < least) best = d.read;
                least = std::min(least, sum);
            }
        return best;
    }
    /// What this drive gives less what was measured, as the force that it would have made on the axis [N];
    /// `force_constant`: of the plant.
    std::vector<double> force_beside_tap(const drive_model& d, double force_constant) const {
        auto out = to_actuator(d, run(d).beside);
        for (double& f : out) f *= -force_constant;
        return out;
    }

private:
    /// What a drive's law gives in each part of each row; of a force that has a limit, where a tap reads it at
    /// a moment, also what the law asks before that, and by how much its integral was lifted.
    struct law_in_parts {
        std::vector<double> given, asked{}, lifted{};
    };
    law_in_parts in_parts(const drive_model& d) const {
        return d.kind == drive_kind::position_servo ? law_in_parts{duty(d)} : force(d);
    }
    /// Share of a part of a row in which this drive is on.
    double share_on(const drive_model& d, std::size_t part) const {
        if (!(d.off_until > d.off_from)) return 1;
        const double length = period / parts, begin = static_cast<double>(part) * length;
        const double silent = std::min(begin + length, d.off_until) - std::max(begin, d.off_from);
        return 1 - std::clamp(silent / length, 0.0, 1.0);
    }
    /// What the law gives at the moments of the tap: with the set-point that the drive had then.
    law_in_parts seen_by_tap(drive_model d, const law_in_parts& fine) const {
        if (d.read.tap_lateness == 0) return fine;
        d.delay -= d.read.tap_lateness;
        return in_parts(d);
    }
    static double between(const std::vector<double>& x, double at) {
        const auto k = std::min(static_cast<std::size_t>(at), x.size() - 2);
        return x[k] + (at - static_cast<double>(k)) * (x[k + 1] - x[k]);
    }
    static std::vector<double> row_means(const std::vector<double>& fine) {
        std::vector<double> out(fine.size() / parts, 0.0);
        for (std::size_t i = 0; i < fine.size(); ++i) out[i / parts] += fine[i] / parts;
        return out;
    }
    /// At the moments of the tap's readings, which follow those of the position.
    std::vector<double> beside(const drive_model& d, const law_in_parts& fine) const {
        const auto last = static_cast<double>(fine.given.size() - 1);
        const auto at = [&](const std::vector<double>& x, double part) {
            return between(x, std::clamp(part, 0.0, last));
        };
        const auto steps = steps_at_tap(d);
        std::vector<double> out(measured.size(), 0.0);
        for (std::size_t k = 0; k < out.size(); ++k) {
            if (is_off(k)) continue;
            const double reading = (static_cast<double>(k) + d.read.age / period) * parts - 0.5;
            const double step = steps.empty() ? 0 : steps[k];
            double law = 0;
            if (d.read.tap == tap_reading::row_mean)
                for (std::size_t i = 0; i < parts; ++i)
                    law += at(fine.given, reading + 0.5 + static_cast<double>(i)) / parts;
            else if (fine.asked.empty())
                law = at(fine.given, reading) + step;
            else // a limit cuts off what is asked at this moment, not a mean that it has cut off before
                law = std::clamp(at(fine.asked, reading) + step, -d.force_limit, d.force_limit) -
                      at(fine.lifted, reading);
            out[k] = measured[k] - law;
        }
        return out;
    }
    /// What a drive with a velocity loop gives more at the readings of its tap than on average around them,
    /// because its set-points arrive in steps [N]; empty: nothing. A bus reads the drive before or after it
    /// hands over a set-point, in each row alike: whether a reading shows it is no matter of microseconds of
    /// delay.
    std::vector<double> steps_at_tap(const drive_model& d) const {
        if (d.kind == drive_kind::position_servo || d.read.tap == tap_reading::row_mean) return {};
        // Of a row; as far from a reading a set-point may come and still be the one that comes with it.
        constexpr double moment = 1e-6, aside = 0.25;
        const double to = d.read.tap == tap_reading::before_set_point ? -aside : aside,
                     scale = in_volts ? d.velocity_per_V : 1;
        const auto points = follows(d, parts);
        set_point_clock clock(d, set_points_of(d), period, begins);
        std::vector<double> out(measured.size());
        for (std::size_t k = 0; k < out.size(); ++k) {
            const double row = static_cast<double>(k), part = std::max(0.0, row * parts - 0.5);
            const auto there = clock.between(row + to, row + to + moment);
            const double step = there.value - to * there.slope - between(points->value, part),
                         turn = there.velocity / period - between(points->velocity, part);
            out[k] = d.velocity_gain * (d.kind == drive_kind::velocity
                                            ? scale * step
                                            : d.position_gain * step + d.velocity_feedforward * turn);
        }
        return out;
    }
    /// use(row, entry, set-point, its velocity [a second], position, velocity).
    template <class Use> void each_part(const drive_model& d, Use use) const {
        each_part(*follows(d, parts), 0, position.size(), use);
    }
    template <class Use>
    void each_part(const followed_set_points& points, std::size_t first, std::size_t behind, Use use) const {
        for (std::size_t k = first; k < behind; ++k)
            for (std::size_t at = k * parts; at < (k + 1) * parts; ++at)
                use(k, at, points.value[at], points.velocity[at], position_in_parts[at], velocity_in_parts[at]);
    }
    static std::vector<double> in_the_middle_of_parts(const std::vector<double>& x) {
        std::vector<double> out;
        out.reserve(x.size() * parts);
        for (std::size_t k = 0; k < x.size(); ++k)
            for (std::size_t i = 0; i < parts; ++i)
                out.push_back(through_four(x, k, (static_cast<double>(i) + 0.5) / parts));
        return out;
    }
    /// The cubic through a row, the one before and the two behind it, at the share p of the way to the next
    /// row.
    static double through_four(const std::vector<double>& x, std::size_t k, double p) {
        const std::size_t n = x.size();
        const double a = x[k > 0 ? k - 1 : 0], b = x[k], c = x[std::min(k + 1, n - 1)],
                     e = x[std::min(k + 2, n - 1)];
        return b + p * (-a / 3 - b / 2 + c - e / 6 + p * ((a + c) / 2 - b + p * ((e - a) / 6 + (b - c) / 2)));
    }
    std::vector<double> duty(const drive_model& d) const {
        std::vector<double> out(position.size() * parts, 0.0);
        // The mean over a part is what the law gives in its middle: half of the profile's way before it.
        const position_servo<> law(d.servo_numbers(), 0.5 * period / parts, already_checked());
        auto s = position_servo<>::state::at(set_point[0]);
        each_part(d, [&](std::size_t k, std::size_t at, double r, double, double x, double) {
            const double on = share_on(d, at);
            if (is_off(k) || on == 0) {
                s = position_servo<>::state::at(x);
                return;
            }
            out[at] = on * law(s, r, x);
            law.follow(s, r);
        });
        return out;
    }
    /// The loops of a drive that takes velocities, or positions.
    class loops {
    public:
        loops(const position_loop<>::parameters& p, drive_kind kind, double h)
            : of_position_(p, h, already_checked()), of_velocity_(p.velocity, h, already_checked()),
              takes_velocity_(kind == drive_kind::velocity) {}
        double operator()(velocity_loop<>::state& s, double asked, double slope, double x, double v) const {
            return takes_velocity_ ? of_velocity_(s, asked, v) : of_position_(s, asked, slope, x, v);
        }

    private:
        position_loop<> of_position_;
        velocity_loop<> of_velocity_;
        bool takes_velocity_;
    };
    /// The loop behind rows that nobody read: its integral is what the drive gave less what it gives without.
    velocity_loop<>::state found_again(const unread_rows& gap, const loops& asks,
                                       const followed_set_points& points, double scale, double limit) const {
        auto without = velocity_loop<>::state::at(velocity[gap.behind]);
        double sum = 0;
        each_part(points, gap.behind, gap.until,
                  [&](std::size_t k, std::size_t, double r, double slope, double x, double v) {
                      const double f = asks(without, scale * r, slope, x, v);
                      if (k >= gap.from) sum += f;
                  });
        const double force = gap.force - sum / static_cast<double>((gap.until - gap.from) * parts);
        return velocity_loop<>::state::at(velocity[gap.behind], std::clamp(force, -limit, limit));
    }
    law_in_parts force(const drive_model& d) const {
        const bool cut_off_at_tap =
            std::isfinite(d.force_limit) && tapped() && d.read.tap != tap_reading::row_mean;
        const std::size_t n = position.size() * parts, n_of_limit = cut_off_at_tap ? n : 0;
        law_in_parts out{std::vector<double>(n, 0.0), std::vector<double>(n_of_limit, 0.0),
                         std::vector<double>(n_of_limit, 0.0)};
        auto numbers = d.position_loop_numbers();
        const loops law(numbers, d.kind, period / parts);
        numbers.velocity.limit = drive_model::none;
        const loops asks(numbers, d.kind, period / parts);
        const double scale = in_volts && d.kind == drive_kind::velocity ? d.velocity_per_V : 1;
        auto s = velocity_loop<>::state::at(velocity[0], d.start_force);
        const double rate = needed.empty() ? 0 : level_rate(d) * period / parts, follow = 1 - std::exp(-rate),
                     smooth = 1 - std::exp(-5 * rate);
        double lifted = 0, beside = 0; // of the integral, so far; needed less given, without its noise
        const auto points = follows(d, parts);
        auto gap = d.has_integral() ? unread.begin() : unread.end();
        each_part(*points, 0, position.size(),
                  [&](std::size_t k, std::size_t at, double r, double slope, double x, double v) {
                      if (gap != unread.end() && k >= gap->first) {
                          if (k < gap->behind) {
                              out.given[at] = gap->force;
                              if (cut_off_at_tap) out.asked[at] = gap->force;
                              return;
                          }
                          s = found_again(*gap++, asks, *points, scale, d.force_limit);
                          lifted = beside = 0;
                      }
                      const double on = share_on(d, at);
                      if (is_off(k) || on == 0) {
                          s = velocity_loop<>::state::at(v);
                          lifted = beside = 0;
                          return;
                      }
                      if (cut_off_at_tap) {
                          auto before = s;
                          out.asked[at] = on * asks(before, scale * r, slope, x, v);
                          out.lifted[at] = on * lifted;
                      }
                      const double f = law(s, scale * r, slope, x, v);
                      out.given[at] = on * (f - lifted);
                      if (follow > 0) {
                          beside += smooth * (needed[k] - f - beside);
                          const double kept = d.force_limit / 4,
                                       lift = follow * (beside - std::clamp(beside, -kept, kept)),
                                       to = std::clamp(s.integral + lift, -d.force_limit, d.force_limit);
                          lifted += to - s.integral;
                          s.integral = to;
                      }
                  });
        return out;
    }
};

} // namespace quadrant::inline v0::diagnosis
