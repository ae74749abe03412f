// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../friction/maxwell_slip.hpp"
#include "../../loop/milling_axis_boxes.hpp"
#include "../../memory/repetitive.hpp"
#include "../../observer/disturbance_observer.hpp"
#include "kind.hpp"

#include <numeric>

namespace quadrant::inline v0::diagnosis::detail {

/// A box that a machine file may have or not. Without it a notch passes on what comes in, another box gives
/// nothing.
template <class Box, bool passes> class optional_box {
public:
    using input = typename Box::input;
    using output = typename Box::output;
    using argument = quantity_of<input>;
    using value = quantity_of<output>;
    using parameters = std::optional<typename Box::parameters>;

    optional_box(const parameters& p, duration period) {
        if (p) box_ = std::make_unique<Box>(*p, period);
    }
    optional_box(const optional_box& other) : box_(other.box_ ? std::make_unique<Box>(*other.box_) : nullptr) {}
    optional_box(optional_box&&) noexcept = default;
    optional_box& operator=(const optional_box& other) { return *this = optional_box(other); }
    optional_box& operator=(optional_box&&) noexcept = default;
    ~optional_box() = default;

    value operator()(argument x) noexcept {
        if (box_) return (*box_)(x);
        if constexpr (passes)
            return x;
        else
            return {};
    }
    void reset() noexcept {
        if (box_) box_->reset();
    }
    void settle(argument x) noexcept {
        if (box_) box_->settle(x);
    }
    void settle(argument x, value y) noexcept requires requires(Box& b) { b.settle(x, y); }
    {
        if (box_) box_->settle(x, y);
    }
    bool faulted() const noexcept { return box_ && box_->faulted(); }

private:
    std::unique_ptr<Box> box_; ///< apart, because a memory is large
};

using slip_feedforward = maxwell_slip<4, signal::velocity, signal::voltage>;
using learning_memory = repetitive<signal::position, 1 << 15, 3>;

/// The boxes of a `milling_axis` with feedforwards of their own and a notch, friction and memory that may be
/// absent.
template <class Observer> struct described_milling_boxes {
    using velocity_notch = optional_box<notch<signal::velocity>, true>;

    proportional<signal::position, signal::velocity> position_loop;
    filtered_derivative<signal::position, signal::velocity> reference_velocity;
    velocity_notch reference_notch;
    filtered_derivative<signal::position, signal::velocity> measured_velocity;
    velocity_notch measured_notch;
    proportional_integral<signal::velocity, signal::voltage> velocity_loop;
    proportional<signal::acceleration, signal::voltage> inertia;
    proportional<signal::velocity, signal::voltage> drag;
    Observer disturbance;
    backward_difference<signal::position, signal::velocity> travel;
    optional_box<slip_feedforward, false> friction;
    optional_box<learning_memory, false> memory;
    limiter<signal::voltage> amplifier;
    quantizer<signal::voltage> dac;
};

/// The elements of the contact, split until there are as many as the block has: two halves slip together.
inline std::optional<slip_feedforward::parameters> slip_of(const given_values& v) {
    if (!v.has_box("friction")) return {};
    const auto given = v.list("friction.gms_weights"), stiff = v.list("friction.gms_stiffness_V_per_m");
    std::array<double, 4> weights{}, stiffness{};
    std::copy(given.begin(), given.end(), weights.begin());
    std::copy(stiff.begin(), stiff.end(), stiffness.begin());
    for (std::size_t n = given.size(); n < weights.size(); ++n) {
        const auto largest = static_cast<std::size_t>(
            std::max_element(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(n)) -
            weights.begin());
        weights[n] = weights[largest] /= 2;
        stiffness[n] = stiffness[largest] /= 2;
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    slip_feedforward::parameters p;
    p.curve = {in_si(v["friction.coulomb_V"]), in_si(v["friction.static_V"]),
               in_si(v["friction.stribeck_velocity_m_per_s"]), in_si(v["friction.viscous_V_s_per_m"])};
    for (std::size_t i = 0; i < weights.size(); ++i) {
        p.weights[i] = weights[i] / sum;
        p.stiffness[i] = in_si(stiffness[i]);
    }
    p.attraction = in_si(v["friction.gms_attraction_V_per_s"]);
    return p;
}

inline std::optional<learning_memory::parameters> memory_of(const given_values& v) {
    if (!v.has_box("memory")) return {};
    learning_memory::parameters p{.cycle = in_si(v["memory.cycle_s"])};
    const auto fill = [](auto& out, std::span<const double> entries, std::size_t from) {
        if (entries.empty()) return;
        out.fill(0);
        std::copy(entries.begin(), entries.end(), out.begin() + static_cast<std::ptrdiff_t>(from));
    };
    const auto smoothing = v.list("memory.smoothing");
    fill(p.weights, v.list("memory.weights"), 0);
    fill(p.learning, v.list("memory.learning"), 0);
    fill(p.smoothing, smoothing, (p.smoothing.size() - std::min(smoothing.size(), p.smoothing.size())) / 2);
    p.ahead = static_cast<std::size_t>(v["memory.ahead"]);
    p.fade = in_si(v["memory.fade_s"]);
    return p;
}

/// A `milling_axis` as it runs.
template <class Observer> class milling_loop final : public running_controller {
    using boxes = described_milling_boxes<Observer>;

public:
    milling_loop(const given_values& v, const actuator_description& a, double period, Observer observer)
        : axis_{.box = boxes_of(v, stage_of(a), duration::from_value(period), std::move(observer))},
          past_(rows_to_see(v, period)), learns_(v.has_box("memory")) {}

    std::unique_ptr<running_controller> copy() const override { return std::make_unique<milling_loop>(*this); }
    double step(const axis_motion<>& asked, const axis_measurement<>& measured) override {
        return axis_({asked.position, asked.velocity, asked.acceleration}, measured.position).value();
    }
    void applied(double command) override {
        if constexpr (requires(Observer & o, quantity_of<signal::voltage> u) { o.applied(u); }) {
            const auto u = quantity_of<signal::voltage>::from_value(command);
            if (u != axis_.wire.command)
                axis_.box.disturbance.applied(axis_.wire.compensated + (u - axis_.wire.wanted));
        }
    }
    bool fixed_by_last_row() const override { return true; } // its observer takes a constant for a disturbance
    double show(const axis_motion<>& asked, const axis_measurement<>& measured, double command) override {
        if (learns_) return running_controller::show(asked, measured, command); // what is tracked is not learnt
        axis_.track({asked.position, asked.velocity, asked.acceleration}, measured.position, in_si(command));
        return command;
    }
    void settle(const loop_start& row) override { axis_.settle(in_si(row.measured), in_si(row.command)); }
    std::size_t past() const override { return past_; }
    double due() const override { return axis_.wire.reference.value(); }
    bool limited() const override { return axis_.limited(); }
    bool faulted() const override { return axis_.faulted(); }

private:
    /// 50 ms, or until what is left of the observer's initial state is a ten-thousandth: (1 + x) exp(-x) at x =
    /// 12.
    static std::size_t rows_to_see(const given_values& v, double period) {
        const double of_observer =
            v.has_box("observer") ? 12 / (2 * std::numbers::pi * v["observer.corner_Hz"]) : 0;
        return std::max<std::size_t>(100, static_cast<std::size_t>(std::max(0.05, of_observer) / period));
    }
    static boxes boxes_of(const given_values& v, const output_stage& out, duration T, Observer observer) {
        const filtered_derivative<signal::position, signal::velocity> speed(
            {.corner = in_si(v["velocity_filter_Hz"])}, T);
        typename boxes::velocity_notch::parameters notched;
        if (v.has_box("notch")) notched = {.centre = in_si(v["notch.frequency_Hz"]), .width = v["notch.width"]};
        return {.position_loop = {{.gain = in_si(v["position_gain_per_s"])}, T},
                .reference_velocity = speed,
                .reference_notch = {notched, T},
                .measured_velocity = speed,
                .measured_notch = {notched, T},
                .velocity_loop = {{in_si(v["velocity_gain_V_s_per_m"]), in_si(v["velocity_integral_V_per_m"]),
                                   in_si(out.limit)},
                                  T},
                .inertia = {{.gain = in_si(v["acceleration_feedforward_V_s2_per_m"])}, T},
                .drag = {{.gain = in_si(v["viscous_feedforward_V_s_per_m"])}, T},
                .disturbance = std::move(observer),
                .travel = {{}, T},
                .friction = {slip_of(v), T},
                .memory = {memory_of(v), T},
                .amplifier = {{in_si(-out.limit), in_si(out.limit)}, T},
                .dac = {{.step = in_si(out.dac_step)}, T}};
    }

    milling_axis<boxes> axis_;
    std::size_t past_;
    bool learns_;
};

} // namespace quadrant::inline v0::diagnosis::detail
