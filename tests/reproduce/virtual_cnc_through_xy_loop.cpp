// SPDX-License-Identifier: BSL-1.0
// Long: the boxes of one machine, and their comparison with its own loops.
// The loops of the Virtual CNC run again as an xy_loop. Its laws have no switching: PID and sliding mode are
// the cascade of a milling_axis in other words, and both axes of one loop move as two servos do.
#include "quadrant_reproduce/experiment/vcnc_contour.hpp"
#include "quadrant_reproduce/experiment/vcnc_program.hpp"
#include "quadrant_reproduce/fuzzy_trial.hpp"

#include <quadrant/control/acceleration_feedback.hpp>
#include <quadrant/control/proportional.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/loop/xy_loop.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace virtual_cnc_through_xy_loop { // named: templates of the program are made of its types
using namespace quadrant;
using namespace quadrant::literals;

/// A velocity that is not estimated from positions: that of the tachometer, or of the trajectory.
class told_velocity {
public:
    using input = signal::position;
    using output = signal::velocity;
    quantity_of<signal::velocity> operator()(quantity_of<signal::position>) noexcept { return now; }
    void reset() noexcept { now = {}; }
    void settle(quantity_of<signal::position>) noexcept { now = {}; }
    quantity_of<signal::velocity> now{};
};

/// What the accelerometer misses of the acceleration that was asked for, filtered, as something to be
/// subtracted.
class told_acceleration {
public:
    using input = signal::position;
    using output = signal::voltage;
    told_acceleration(gain_of<signal::voltage, signal::acceleration> gain, frequency corner)
        : gain_(gain), filter_({corner}, vcnc::period) {}
    quantity_of<signal::voltage> operator()(quantity_of<signal::position>) noexcept {
        return -(gain_ * filter_(missing));
    }
    void reset() noexcept { filter_.reset(); }
    void settle(quantity_of<signal::position>) noexcept { filter_.settle({}); }
    quantity_of<signal::acceleration> missing{};

private:
    gain_of<signal::voltage, signal::acceleration> gain_;
    lowpass<signal::acceleration> filter_;
};

/// u = e_v on + (e + of_sum T sum e) at on + a_r inertia + v_r drag, e_v = v_r - v: what both laws come to. The
/// sum sits in the slot of the memory.
struct gains {
    gain_of<signal::voltage, signal::velocity> on;
    gain_of<signal::velocity, signal::position> at;
    gain_rate_of<signal::position, signal::position> of_sum;
    gain_of<signal::voltage, signal::acceleration> inertia{};
    gain_of<signal::voltage, signal::velocity> drag{};
    gain_of<signal::voltage, signal::acceleration> missing{}; ///< of the accelerometer, behind 150 Hz
};
gains gains_of(const pid<>::parameters& p) {
    return {p.derivative_gain, p.gain / p.derivative_gain, p.integral_gain / p.gain};
}
gains gains_of(const sliding_mode<>::parameters& p) {
    const auto inertia = 1.0 / p.plant.gain;
    const auto drag = p.plant.viscous_rate / p.plant.gain;
    const gain_of<signal::voltage, signal::velocity> on = p.gain + p.sliding * inertia - drag;
    const gain_of<signal::voltage, signal::position> at = p.gain * p.sliding + p.adaptation;
    return {on, at / on, p.sliding * p.adaptation / at, inertia, drag};
}
gains gains_of(const acceleration_feedback<pid<>>::parameters& p) {
    gains out = gains_of(p.law);
    out.missing = p.gain;
    return out;
}

struct boxes {
    using parameters = gains;
    boxes(const parameters& p, duration T)
        : memory({{}, p.of_sum, 1e9_m}, T), position_loop({p.at}, T), reference_notch({}, T),
          measured_notch({}, T), velocity_loop({p.on, {}, 1e9_V}, T), inertia({p.inertia}, T),
          drag({p.drag}, T), disturbance(p.missing, 150_Hz), travel({}, T), friction({}, T),
          amplifier({-vcnc::command_limit, vcnc::command_limit}, T), dac({vcnc::dac_step}, T) {}
    proportional_integral<signal::position, signal::position> memory; // the integral alone
    proportional<signal::position, signal::velocity> position_loop;
    told_velocity reference_velocity, measured_velocity;
    through<signal::velocity> reference_notch, measured_notch;
    proportional_integral<signal::velocity, signal::voltage> velocity_loop; // without integral
    proportional<signal::acceleration, signal::voltage> inertia;
    proportional<signal::velocity, signal::voltage> drag;
    told_acceleration disturbance;
    backward_difference<signal::position, signal::velocity> travel;
    absent<signal::velocity, signal::voltage> friction;
    limiter<signal::voltage> amplifier;
    quantizer<signal::voltage> dac;
};
static_assert(milling_boxes<boxes>);

/// Two feed drives as the table of an `xy_loop`.
class two_drives {
public:
    using drive = feed_drive<vcnc::machine_boxes>;
    using commands = xy<quantity_of<signal::voltage>>;
    using forces = xy<quantity_of<signal::force>>;
    using positions = xy<quantity_of<signal::position>>;
    struct parameters {
        vcnc::machine_boxes::parameters x, y;
    };
    two_drives(const parameters& p, duration T) : x_{.box = {p.x, T}}, y_{.box = {p.y, T}} {}
    positions operator()(const commands& u, const forces& f = {}) noexcept {
        x_(u.x, f.x);
        y_(u.y, f.y);
        return reading();
    }
    positions reading() const noexcept { return {.x = on_x(x_.wire.reading), .y = on_y(y_.wire.reading)}; }
    void settle(const positions& at) noexcept {
        x_.settle(at.x);
        y_.settle(at.y);
    }
    void reset() noexcept { settle({}); }
    bool faulted() const noexcept { return x_.faulted() || y_.faulted(); }
    const drive& x() const noexcept { return x_; }
    const drive& y() const noexcept { return y_; }

private:
    drive x_, y_;
};

class machine {
public:
    machine(const gains& of_x, const gains& of_y, quantity<si::length> play, std::uint64_t seed_x,
            std::uint64_t seed_y)
        : loop_({.control = {of_x, of_y},
                 .table = {vcnc::drive(vcnc::x_axis, play, seed_x), vcnc::drive(vcnc::y_axis, play, seed_y)}},
                vcnc::period) {}
    void settle(const vcnc::asked& at) { loop_.settle({.x = on_x(at.x.position), .y = on_y(at.y.position)}); }
    void step(const vcnc::asked& r) {
        tell(loop_.control().x(), r.x, loop_.table().x().measured());
        tell(loop_.control().y(), r.y, loop_.table().y().measured());
        loop_({.x = r.x, .y = r.y});
        clipped_ = clipped_ || loop_.limited();
    }
    double x() const { return loop_.table().x().wire.place.value(); }
    double y() const { return loop_.table().y().wire.place.value(); }
    bool clipped() const { return clipped_; }
    bool faulted() const { return loop_.faulted(); }

private:
    template <class Axis, class Measured>
    static void tell(Axis& axis, const axis_motion<>& r, const Measured& measured) {
        axis.box.reference_velocity.now = r.velocity;
        axis.box.measured_velocity.now = measured.velocity;
        axis.box.disturbance.missing = r.acceleration - measured.acceleration;
    }
    xy_loop<boxes, boxes, two_drives> loop_;
    bool clipped_ = false;
};

constexpr double same = 1e-9; // asked, relative to the largest error

/// Every sample of both axes along one contour: servos by themselves, and one loop.
template <class Law, class Path>
void same_contour(typename Law::parameters (*law_of)(const vcnc::axis&), quantity<si::length> play) {
    const auto alone = quadrant_reproduce::along<Law, Path>(law_of, play, 1);
    machine table(gains_of(law_of(vcnc::x_axis)), gains_of(law_of(vcnc::y_axis)), play, 2, 3);
    table.settle(Path::at(0));
    double furthest = 0, largest = 0;
    for (std::size_t k = 0; k < alone.time.size(); ++k) {
        const vcnc::asked r = Path::at(int(k));
        const double ex = 1e6 * (r.x.position.value() - table.x()),
                     ey = 1e6 * (r.y.position.value() - table.y());
        furthest = std::max({furthest, std::abs(ex - alone.x_error[k]), std::abs(ey - alone.y_error[k])});
        largest = std::max({largest, std::abs(alone.x_error[k]), std::abs(alone.y_error[k])});
        table.step(r);
    }
    CHECK_FALSE(table.faulted());
    CHECK_FALSE(table.clipped());
    CHECK(largest > 5);
    CHECK(furthest <= same * largest);
}
} // namespace virtual_cnc_through_xy_loop
using namespace virtual_cnc_through_xy_loop;

TEST_CASE("xy_loop: the Virtual CNC errs along diamond and circle as its two servos do, with PID and with the "
          "sliding mode law, without and with backlash") {
    for (const auto& play : {0_um, 3_um}) {
        CAPTURE(play.value());
        same_contour<pid<>, vcnc::diamond>(vcnc::pid_of, play);
        same_contour<pid<>, vcnc::circle>(vcnc::pid_of, play);
        same_contour<sliding_mode<>, vcnc::diamond>(vcnc::sliding_mode_of, play);
        same_contour<sliding_mode<>, vcnc::circle>(vcnc::sliding_mode_of, play);
    }
}
TEST_CASE(
    "xy_loop: with an accelerometer the y axis of the Virtual CNC errs along the diamond as its servo does") {
    using law = acceleration_feedback<pid<>>;
    const auto of = [](const vcnc::axis& a) {
        auto p = vcnc::pid_of(a);
        p.gain *= 1.5, p.integral_gain *= 1.5, p.derivative_gain *= 1.5;
        return law::parameters{.law = p, .gain = 0.5 / vcnc::model(a).gain, .corner = 150_Hz};
    };
    vcnc::servo<law> alone(vcnc::y_axis, of(vcnc::y_axis), 0_m, 2);
    machine table(gains_of(of(vcnc::x_axis)), gains_of(of(vcnc::y_axis)), 0_m, 7, 2);
    alone.settle(vcnc::diamond::at(0).y.position);
    table.settle(vcnc::diamond::at(0));
    double furthest = 0, largest = 0;
    for (int k = 0; k < vcnc::diamond::samples() + 100; ++k) {
        const auto r = vcnc::diamond::at(k);
        furthest = std::max(furthest, std::abs(table.y() - alone.place()));
        largest = std::max(largest, std::abs(r.y.position.value() - alone.place()));
        alone.step(r.y);
        table.step(r);
    }
    CHECK_FALSE(table.faulted());
    CHECK_FALSE(table.clipped());
    CHECK(largest > 5e-6);
    CHECK(furthest <= same * largest);
}
TEST_CASE("xy_loop: the trial of the fuzzy tuning, 100 mm forth and back on x, is the same while y rests") {
    for (const auto& from : {vcnc::fuzzy_start{0.3, 30}, vcnc::fuzzy_start{0.01, 1}}) {
        auto law = vcnc::sliding_mode_of(vcnc::x_axis);
        law.gain = from.gain * 1000_V / 1_mps;
        law.adaptation = from.adaptation * 1000_V / 1_m;
        CAPTURE(from.gain);
        const auto alone = vcnc::fuzzy_trial::run(law, 1);
        machine table(gains_of(law), gains_of(vcnc::sliding_mode_of(vcnc::y_axis)), 0_m, 1, 9);
        table.settle({});
        double furthest = 0, largest = 0;
        for (std::size_t k = 0; k < alone.error.size(); ++k) {
            const axis_motion<> r = vcnc::fuzzy_trial::at(int(k));
            furthest = std::max(furthest, std::abs(1e6 * (r.position.value() - table.x()) - alone.error[k]));
            largest = std::max(largest, std::abs(alone.error[k]));
            table.step({r, {}});
        }
        CHECK_FALSE(table.faulted());
        CHECK_FALSE(table.clipped());
        CHECK(largest > 5);
        CHECK(furthest <= same * largest);
    }
}
TEST_CASE("xy_loop: the Virtual CNC errs along its CL files, interpolated, as its two servos do") {
    using analysis::plane_position;
    for (const char* program : {quadrant_reproduce::diamond_program, quadrant_reproduce::circle_program}) {
        const auto moves = quadrant_reproduce::moves_of(program, "program");
        const auto run = [&](auto&& step) {
            return analysis::drive_contour(moves, step, quadrant_reproduce::program_limits(), vcnc::period);
        };
        const auto law = vcnc::sliding_mode_of;
        vcnc::servo<sliding_mode<>> x(vcnc::x_axis, law(vcnc::x_axis), 0_m, 2),
            y(vcnc::y_axis, law(vcnc::y_axis), 0_m, 3);
        bool started = false;
        const auto alone = run([&](const axis_motion<>& to_x, const axis_motion<>& to_y) {
            if (!std::exchange(started, true)) x.settle(to_x.position), y.settle(to_y.position);
            const plane_position at{x.place() * 1_m, y.place() * 1_m};
            x.step(to_x), y.step(to_y);
            return at;
        });
        machine table(gains_of(law(vcnc::x_axis)), gains_of(law(vcnc::y_axis)), 0_m, 2, 3);
        started = false;
        const auto whole = run([&](const axis_motion<>& to_x, const axis_motion<>& to_y) {
            if (!std::exchange(started, true)) table.settle({to_x, to_y});
            const plane_position at{table.x() * 1_m, table.y() * 1_m};
            table.step({to_x, to_y});
            return at;
        });
        REQUIRE(alone.x_error.size() > 1000);
        REQUIRE(alone.x_error.size() == whole.x_error.size());
        double furthest = 0;
        for (std::size_t k = 0; k < alone.x_error.size(); ++k)
            furthest = std::max({furthest, std::abs((alone.x_error[k] - whole.x_error[k]).value()),
                                 std::abs((alone.y_error[k] - whole.y_error[k]).value())});
        CHECK_FALSE(table.faulted());
        CHECK_FALSE(table.clipped());
        CHECK(alone.x.most > 5_um);
        CHECK(furthest <= same * alone.x.most.value());
    }
}
