// SPDX-License-Identifier: BSL-1.0
// The precision stage run again as an axis of an xy_loop. Its law plans ten samples ahead from a filtered
// state, so it stands whole in the slot of the disturbance, which is fed the measured position, and is told
// what is coming.
#include "quadrant_reproduce/stage.hpp"

#include <quadrant/control/limiter.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/loop/xy_loop.hpp>

#include <doctest/doctest.h>

namespace stage_through_xy_loop { // named: templates of the program are made of its types
using namespace quadrant;
using namespace quadrant::literals;

/// What the controller of a stage believes, and how it is tuned.
struct beliefs {
    stage::machine thought = stage::believed;
    stage::tuning tuned = stage::tight;
};

/// The controller of the stage: its command with the sign of something to be subtracted.
template <class Compensation> class stage_law {
public:
    using input = signal::position;
    using output = signal::voltage;
    stage_law(const beliefs& c, duration) : control_(c.thought, c.tuned) {}
    quantity_of<signal::voltage> operator()(quantity_of<signal::position> measured) noexcept {
        return -control_(measured, due_later);
    }
    void reset() noexcept { settle({}); }
    void settle(quantity_of<signal::position> x) noexcept { control_.settle(x); }
    axis_motion<> due_later{}; ///< what is asked for `horizon` samples from now

private:
    stage::controller<Compensation> control_;
};

template <class Compensation> struct boxes {
    using parameters = beliefs;
    boxes(const parameters& c, duration T)
        : memory({}, T), position_loop({}, T), reference_velocity({}, T), measured_velocity({}, T),
          reference_notch({}, T), measured_notch({}, T), velocity_loop({{}, {}, 8_V}, T), inertia({}, T),
          drag({}, T), disturbance(c, T), travel({}, T), friction({}, T), amplifier({-8_V, 8_V}, T),
          dac({}, T) {}
    absent<signal::position, signal::position> memory;
    absent<signal::position, signal::velocity> position_loop, reference_velocity, measured_velocity;
    through<signal::velocity> reference_notch, measured_notch;
    proportional_integral<signal::velocity, signal::voltage> velocity_loop; // no gain
    absent<signal::acceleration, signal::voltage> inertia;
    absent<signal::velocity, signal::voltage> drag;
    stage_law<Compensation> disturbance;
    absent<signal::position, signal::velocity> travel;
    absent<signal::velocity, signal::voltage> friction;
    limiter<signal::voltage> amplifier;
    through<signal::voltage> dac;
};
static_assert(milling_boxes<boxes<stage::fed_forward>>);

/// Two stages as the table of an `xy_loop`.
template <class Machine> class two_stages {
public:
    using commands = xy<quantity_of<signal::voltage>>;
    using forces = xy<quantity_of<signal::force>>;
    using positions = xy<quantity_of<signal::position>>;
    struct parameters {
        stage::machine x, y;
    };
    two_stages(const parameters& p, duration) : x_(p.x), y_(p.y) {}
    positions operator()(const commands& u, const forces& f) noexcept {
        x_.step(u.x.plain(), f.x.plain());
        y_.step(u.y.plain(), f.y.plain());
        return reading();
    }
    positions reading() const noexcept { return {.x = on_x(x_.measured()), .y = on_y(y_.measured())}; }
    void settle(const positions& at) noexcept {
        x_.settle(at.x.plain());
        y_.settle(at.y.plain());
    }
    void reset() noexcept { settle({}); }
    bool faulted() const noexcept { return x_.faulted() || y_.faulted(); }
    double x() const { return x_.now().x.value(); }

private:
    stage::driven<Machine> x_, y_;
};

struct move_of {
    double length, time;
    axis_motion<> operator()(double at) const {
        const auto m = trajectory::s_curve({length * 1_m, time * 1_s})(at * 1_s);
        return {m.position, m.velocity, m.acceleration};
    }
};

/// Every sample of a stage by itself, and of the x axis of a loop in which another one moves as y.
template <class Compensation, class Machine = stage::lugre_machine, class Reference>
void same_run(const stage::machine& is, const beliefs& c, const Reference& reference, double end) {
    stage::axis<Compensation, Machine> alone(is, c.thought, c.tuned);
    xy_loop<boxes<Compensation>, boxes<Compensation>, two_stages<Machine>> loop(
        {.control = {c, {stage::believed, stage::moderate}}, .table = {is, stage::real}}, stage::period);
    const double T = stage::period.value();
    const move_of beside{-0.02, 0.3};
    long different = 0, samples = 0;
    double largest = 0;
    for (long k = -static_cast<long>(stage::horizon); k <= static_cast<long>(end / T + 0.5); ++k) {
        const double now = static_cast<double>(k) * T, later = now + static_cast<double>(stage::horizon) * T;
        const stage::moment m = alone.step(now, reference(later));
        loop.control().x().box.disturbance.due_later = reference(later);
        loop.control().y().box.disturbance.due_later = beside(later);
        const double place = loop.table().x();
        loop({reference(now), beside(now)});
        const double command = loop.control().x().wire.command.value();
        different += place != m.position || command != m.command;
        largest = std::max(largest, std::abs(m.command));
        ++samples;
    }
    CHECK_FALSE(alone.faulted());
    CHECK_FALSE(loop.faulted());
    CHECK(largest > 0.1);
    CHECK(samples > 100);
    CHECK(different == 0);
}
} // namespace stage_through_xy_loop
using namespace stage_through_xy_loop;

TEST_CASE(
    "xy_loop: the precision stage moves as an axis of it as it does by itself, bit for bit, with each way of "
    "compensating its friction") {
    for (const move_of& move : {move_of{0.3, 1.0}, {0.02, 0.5}, {500e-6, 0.2}}) {
        CAPTURE(move.length);
        const double until = move.time + 0.2;
        same_run<stage::no_feedforward>(stage::real, {}, move, until);
        same_run<stage::fed_forward>(stage::real, {}, move, until);
        same_run<stage::observed>(stage::real, {stage::believed, stage::moderate}, move, until);
    }
    same_run<stage::fed_forward>(stage::real, {}, stage::linear_cycle(), stage::linear_cycle::end());
}
TEST_CASE("xy_loop: so do the stage with its current loops, another stage, and one that is being tuned") {
    stage::machine with_loops = stage::real, heavier = stage::real, thought = stage::believed;
    with_loops.current_loops = true;
    heavier.mass = 1.5 * stage::believed.mass;
    thought.coulomb *= 0.6;
    same_run<stage::fed_forward>(with_loops, {}, move_of{0.3, 1.0}, 1.2);
    const auto even_speed = [](double t) { // as the friction map is measured, 5 mm/s
        return axis_motion<>{std::max(t, 0.0) * 5e-3 * 1_m, (t > 0 ? 5e-3 : 0.0) * 1_mps, {}};
    };
    same_run<stage::fed_forward>(stage::real, {}, even_speed, 1.0);
    same_run<stage::fed_forward, stage::springs_machine>(heavier, {stage::believed, stage::moderate},
                                                         move_of{500e-6, 0.2}, 1.0);
    same_run<stage::fed_forward>(stage::real, {thought, {2e-5, 6e-3, 0.02, 12}}, move_of{500e-6, 0.2}, 0.3);
}
