// SPDX-License-Identifier: BSL-1.0
// The run itself: program -> trajectory -> axes -> what is kept of them, one servo period after another.
#include "simulate.hpp"

#include "axis.hpp"
#include "contour.hpp"
#include "program.hpp"
#include "run_memory.hpp"

#include <chrono>
#include <ctime>
#include <deque>

namespace quadrant_cnc {

namespace {

using namespace quadrant;
using clock = std::chrono::steady_clock;

class run {
public:
    run(const cnc_description& cnc, const std::string& path_file, log_writer* log, kept_for what)
        : cnc_(cnc), program_(cnc, path_file), log_(log), drawn_(what == kept_for::pages),
          period_(cnc.servo_period_s), drive_(make_drive(cnc)), waiting_(0),
          cuts_(std::any_of(cnc.axes.begin(), cnc.axes.end(),
                            [](const axis_description& a) { return a.load.has_value(); })) {
        std::size_t most_lead = 0;
        for (const axis_description& a : cnc.axes) {
            try {
                axes_.push_back({a.axis, make_axis(a, period_, cnc.seed + a.axis), 0});
            } catch (const invalid_parameter& fault) {
                throw diagnosis::bad_input(cnc.file, fmt::format("{}: {}", a.path, fault.what()));
            }
            out_.axes.push_back({.name = a.name(),
                                 .effort_unit = effort_unit(a),
                                 .effort_limit = axes_.back().box->effort_limit()});
            most_lead = std::max(most_lead, axes_.back().box->lead());
        }
        for (one& a : axes_) a.wait = most_lead - a.box->lead();
        waiting_ = waiting_line(most_lead);
        values_.resize(1 + run_outcome::of_axis * axes_.size());
        out_.signals = decimated(values_.size());
        out_.cnc_file = cnc.file, out_.path_file = path_file, out_.period = period_;
    }

    run_outcome operator()(const std::function<void(const progress&)>& tell) {
        const auto start = clock::now();
        const std::clock_t cpu_start = std::clock(); // on a busy computer the other one says what else runs
        const auto cpu_seconds = [&] { return double(std::clock() - cpu_start) / CLOCKS_PER_SEC; };
        auto told = start;
        const auto seconds = [&](clock::time_point t) {
            return std::chrono::duration<double>(t - start).count();
        };
        fill();
        const std::size_t rest = waiting_.longest() + std::size_t(std::ceil(at_rest_after / period_));
        for (std::size_t left = rest; left > 0;) {
            fill();
            if (drive_->done()) --left; // the path is over, the axes come to rest
            step((*drive_)());
            if (out_.samples % 4096 == 0 && tell)
                if (const auto now = clock::now(); seconds(now) - seconds(told) > 0.2) {
                    told = now;
                    tell(
                        {program_.share(), double(out_.samples) * period_, seconds(now), cpu_seconds(), line_});
                }
        }
        out_.signals.finish();
        out_.contour_plot.finish();
        out_.worst = close_up_.finish();
        out_.duration = double(out_.samples) * period_;
        out_.wall_time = seconds(clock::now());
        out_.cpu_time = cpu_seconds();
        return std::move(out_);
    }

private:
    static constexpr double at_rest_after = 0.05; ///< [s] that the run goes on behind the end of the path
    using interpolator = trajectory::interpolator<128>;
    struct one {
        std::size_t axis;
        std::unique_ptr<quadrant_cnc::axis> box;
        std::size_t wait; ///< periods that its references come later than the first law wants them
    };

    static std::unique_ptr<interpolator> make_drive(const cnc_description& cnc) {
        try {
            return std::make_unique<interpolator>(
                interpolator::parameters{program::limits_of(cnc), program::kind_of(cnc)},
                duration::from_value(cnc.servo_period_s));
        } catch (const invalid_parameter& fault) {
            throw diagnosis::bad_input(cnc.file, fmt::format("trajectory: {}", fault.what()));
        }
    }
    void fill() {
        while (more_ && !drive_->full()) {
            const auto move = program_.next();
            more_ = move.has_value();
            if (!move) break;
            try {
                drive_->push(*move);
            } catch (const invalid_parameter& fault) {
                program_.refuse(fault);
            }
            if (out_.moves++ == 0) settle(move->path.start());
            contour_.add(move->path, move->line);
            if (cuts_) feeds_.push_back({move->line, !move->rapid});
            out_.path_length += move->path.length();
            out_.lines = move->line;
        }
    }
    void settle(point at) {
        due_sample here;
        for (int i = 0; i < 3; ++i)
            here.axis[std::size_t(i)].position = quantity_of<signal::position>::from_value(at[i]);
        waiting_.settle(here);
        for (one& a : axes_) a.box->settle(at[int(a.axis)]);
    }

    void step(const trajectory::path_reference& reference) {
        waiting_.push(reference);
        const due_sample& due = waiting_.ago(waiting_.longest());
        const double t = double(out_.samples) * period_;
        point asked{due.axis[0].position.value(), due.axis[1].position.value(), due.axis[2].position.value()};
        point place = asked;
        line_ = due.line;
        if (cuts_) cut(due.line);
        if (log_) log_->number(t, 7);
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            one& a = axes_[i];
            const trajectory::motion& m = waiting_.ago(a.wait).axis[a.axis];
            const trajectory::motion& now = due.axis[a.axis];
            const axis_sample s = a.box->step({m.position, m.velocity, m.acceleration});
            if (s.faulted)
                throw diagnosis::bad_input(
                    cnc_.file, fmt::format("{}: the simulation leaves all numbers at {:.6g} s, line {} of {}",
                                           cnc_.axes[i].path, t, line_, program_.file()));
            place[int(a.axis)] = s.place;
            take(i, now, now.position.value() - s.place, s, t);
            if (log_) {
                log_->number(s.reference, 12);
                if (cnc_.axes[i].motion_is_logged()) {
                    log_->number(now.velocity.value(), 12);
                    log_->number(now.acceleration.value(), 12);
                    log_->number(s.velocity, 12);
                }
                log_->number(s.reading, 11);
                log_->number(s.command, 8);
            }
        }
        if (log_) log_->end_row();
        contour_.follow(asked, line_, due.speed * period_);
        const contour::deviation off = contour_(place);
        const double distance = off.distance();
        const bool worst = distance > out_.contour.most;
        out_.contour.add(distance, t, line_);
        if (worst) out_.worst_place = off.foot;
        if (drawn_) {
            const contour_sample sample{contour_.path_place(), off.foot, off.off};
            values_[0] = distance;
            out_.signals.add(values_.data());
            out_.contour_plot.add(sample, distance);
            close_up_.add(sample, worst);
        }
        ++out_.samples;
    }
    /// The tool is in the cut in feed moves, until the path is over.
    void cut(std::size_t line) {
        while (line != 0 && feeds_.size() > 1 && feeds_.front().line != line) feeds_.pop_front();
        const bool over = drive_->done() && waiting_.ago(waiting_.longest()).speed == 0;
        const bool in_the_cut = !feeds_.empty() && feeds_.front().line == line && feeds_.front().feed && !over;
        for (one& a : axes_) a.box->cut(in_the_cut);
    }
    void take(std::size_t i, const trajectory::motion& asked, double error, const axis_sample& s, double t) {
        const double velocity = asked.velocity.value(), acceleration = asked.acceleration.value(),
                     jerk = asked.jerk.value();
        axis_outcome& o = out_.axes[i];
        o.error.add(error, t, line_);
        o.velocity.add(velocity, t, line_);
        o.acceleration.add(acceleration, t, line_);
        o.jerk.add(jerk, t, line_);
        o.effort.add(s.effort, t, line_);
        o.limited += s.limited;
        if (!drawn_) return;
        double* const v = values_.data() + 1 + run_outcome::of_axis * i;
        v[0] = error, v[1] = velocity, v[2] = acceleration, v[3] = jerk, v[4] = s.effort;
    }

    const cnc_description& cnc_;
    quadrant_cnc::program program_;
    log_writer* log_;
    bool drawn_; ///< somebody asked for a page
    double period_;
    std::unique_ptr<interpolator> drive_;
    std::vector<one> axes_;
    waiting_line waiting_;
    struct line_kind {
        std::size_t line;
        bool feed;
    };
    std::deque<line_kind> feeds_{}; ///< of the moves on their way; only for machines that cut
    bool cuts_;
    contour contour_;
    close_up close_up_;
    std::vector<double> values_;
    std::size_t line_ = 0;
    bool more_ = true;
    run_outcome out_;
};

} // namespace

run_outcome simulate(const cnc_description& cnc, const std::string& path_file, log_writer* log,
                     const std::function<void(const progress&)>& tell, kept_for what) {
    return run(cnc, path_file, log, what)(tell);
}

std::string log_header(const cnc_description& cnc) {
    std::string out = "t_s";
    for (const axis_description& a : cnc.axes) {
        out += fmt::format(",{}_ref_m", a.name());
        if (a.motion_is_logged())
            out += fmt::format(",{0}_ref_m_per_s,{0}_ref_m_per_s2,{0}_vel_m_per_s", a.name());
        out += fmt::format(",{0}_pos_m,{0}_cmd_V", a.name());
    }
    return out;
}

} // namespace quadrant_cnc
