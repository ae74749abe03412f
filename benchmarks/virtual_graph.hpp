// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/loop/milling_axis_boxes.hpp>

#include <memory>
#include <utility>
#include <vector>

/// The diagram of `milling_axis` as it is without types: wires by number in an array, nodes called through one
/// virtual function each, in the order in which they were added. The blocks in the nodes are the same, with
/// their flags.
namespace virtual_graph {

using namespace quadrant;

class node {
public:
    virtual ~node() = default;
    virtual void step(double* wire) noexcept = 0;
    virtual bool faulted() const noexcept { return false; }
};

enum wire : std::size_t {
    reference,
    velocity,
    acceleration,
    measured,
    reference_rate,
    reference_velocity,
    measured_rate,
    measured_velocity,
    position_error,
    learned,
    corrected,
    proportional,
    demand,
    velocity_error,
    feedback,
    inertia,
    drag,
    with_inertia,
    linear,
    disturbance,
    compensated,
    travel,
    friction,
    wanted,
    clipped,
    command,
    cut_off,
    applied,
    wires
};

/// A block from a wire to a wire.
template <class Block> class box final : public node {
public:
    box(Block block, wire in, wire out) : block_(std::move(block)), in_(in), out_(out) {}
    void step(double* w) noexcept override { w[out_] = block_(Block::argument::from_value(w[in_])).value(); }
    bool faulted() const noexcept override { return block_.faulted(); }

private:
    Block block_;
    wire in_, out_;
};
/// a + sign b.
class sum final : public node {
public:
    sum(wire a, double sign, wire b, wire out) : a_(a), b_(b), out_(out), sign_(sign) {}
    void step(double* w) noexcept override { w[out_] = w[a_] + sign_ * w[b_]; }

private:
    wire a_, b_, out_;
    double sign_;
};
template <class Observer> class observing final : public node {
public:
    explicit observing(Observer block) : block_(std::move(block)) {}
    void step(double* w) noexcept override {
        w[disturbance] =
            block_(Observer::argument::from_value(w[measured]), Observer::value::from_value(w[linear])).value();
    }
    bool faulted() const noexcept override { return block_.faulted(); }
    void told(double u) noexcept { block_.applied(Observer::value::from_value(u)); }

private:
    Observer block_;
};
template <class Observer> class telling final : public node {
public:
    explicit telling(observing<Observer>& to) : to_(to) {}
    void step(double* w) noexcept override { to_.told(w[applied]); }

private:
    observing<Observer>& to_;
};

class axis {
public:
    template <class Boxes> explicit axis(const Boxes& b) {
        add(b.reference_velocity, reference, reference_rate);
        add(b.reference_notch, reference_rate, reference_velocity);
        add(b.measured_velocity, measured, measured_rate);
        add(b.measured_notch, measured_rate, measured_velocity);
        add(reference, -1, measured, position_error);
        add(b.memory, position_error, learned);
        add(position_error, 1, learned, corrected);
        add(b.position_loop, corrected, proportional);
        add(proportional, 1, reference_velocity, demand);
        add(demand, -1, measured_velocity, velocity_error);
        add(b.velocity_loop, velocity_error, feedback);
        add(b.inertia, acceleration, inertia);
        add(b.drag, velocity, drag);
        add(feedback, 1, inertia, with_inertia);
        add(with_inertia, 1, drag, linear);
        auto observer = std::make_unique<observing<decltype(b.disturbance)>>(b.disturbance);
        auto teller = std::make_unique<telling<decltype(b.disturbance)>>(*observer);
        nodes_.push_back(std::move(observer));
        add(linear, -1, disturbance, compensated);
        add(b.travel, reference, travel);
        add(b.friction, travel, friction);
        add(compensated, 1, friction, wanted);
        add(b.amplifier, wanted, clipped);
        add(b.dac, clipped, command);
        add(command, -1, wanted, cut_off);
        add(compensated, 1, cut_off, applied);
        nodes_.push_back(std::move(teller));
    }

    double step(double at, double speed, double rate, double seen) noexcept {
        if (!finite(at, at, speed, rate, seen)) {
            fault_ = true;
            return wire_[command];
        }
        wire_[reference] = at;
        wire_[velocity] = speed;
        wire_[acceleration] = rate;
        wire_[measured] = seen;
        for (const auto& each : nodes_) each->step(wire_);
        return wire_[command];
    }
    double last() const noexcept { return wire_[command]; }
    bool limited() const noexcept { return wire_[clipped] != wire_[wanted]; }
    bool faulted() const noexcept {
        for (const auto& each : nodes_)
            if (each->faulted()) return true;
        return fault_;
    }

private:
    template <class Block> void add(const Block& b, wire in, wire out) {
        nodes_.push_back(std::make_unique<box<Block>>(b, in, out));
    }
    void add(wire a, double sign, wire b, wire out) {
        nodes_.push_back(std::make_unique<sum>(a, sign, b, out));
    }

    std::vector<std::unique_ptr<node>> nodes_;
    double wire_[wires] = {};
    bool fault_ = false;
};

} // namespace virtual_graph
