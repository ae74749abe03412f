// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hal_pins.hpp"

#include <quadrant/base/make.hpp>

#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <pthread.h>
#include <thread>
#include <utility>
#include <vector>

/// A HAL component around a block of ours: `loadrt NAME count=2` gives PREFIX.0 and PREFIX.1.
///   struct Block {
///       static constexpr const char *component = "quadrant_plant", *prefix = "quadrant-plant";
///       struct parameters; static constexpr auto list();              // of `field`s
///       Block(const parameters&, duration);                           // may throw, allocate and take its time
///       struct pins { explicit pins(pin_maker&); };                   // the signals
///       bool step(const pins&) noexcept;                              // one period; false: held, the pin `fault` rises
///       bool adopt(const Block& next) noexcept;                       // goes on with other parameters; false: not now
///       struct wires; wires wire() const; static constexpr auto taps(); // what to show
///   };
/// Every parameter is an input pin. A thread beside the real-time one looks at them every few milliseconds,
/// builds a new block from what changed and offers it; the real-time thread takes the offer between two
/// periods. Nothing is allocated, locked or thrown there. What a constructor refuses is reported once, raises
/// `refused`, and the old one stays. While `apply` is FALSE changes are collected; they are then taken all at
/// once.
namespace hal {

template <class Block> class instance {
    static constexpr auto list = Block::list();
    using numbers = std::array<double, list.size()>;
    using wires = wire_pins<typename Block::wires, Block::taps().size()>;

public:
    instance(int component, int number)
        : maker_{component, std::string(Block::prefix) + "." + std::to_string(number)}, signals_(maker_),
          wires_(Block::taps(), maker_) {
        for (std::size_t i = 0; i < list.size(); ++i)
            maker_.make(parameters_[i], HAL_IN, list[i].name, list[i].standard);
        maker_.make(apply_, HAL_IN, "apply", true);
        maker_.make(fault_, HAL_OUT, "fault");
        maker_.make(refused_, HAL_OUT, "refused");
        maker_.make(pending_, HAL_OUT, "pending");
        if (maker_.error == 0)
            maker_.error = hal_export_funct(maker_.prefix.c_str(), &instance::call, this, 1, 0, component);
    }
    int error() const { return maker_.error; }

    /// Builder thread: a new block when a parameter or the period is not that of the last one.
    void look() {
        if (offered_.load(std::memory_order_acquire)) return; // not taken yet
        const long period = period_.load(std::memory_order_relaxed);
        if (period <= 0 || !apply_.get()) return;
        numbers now;
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = parameters_[i].get();
        if (built_period_ == period && bits(built_) == bits(now)) return;
        built_ = now;
        built_period_ = period;
        pending_.set(true);
        bool good = false;
        std::array<char, 300> why{};
        try {
            typename Block::parameters p{};
            for (std::size_t i = 0; i < now.size(); ++i) {
                quadrant::require_finite(list[i].name, now[i]); // before anything is designed from it
                list[i].set(p, now[i]);
            }
            good = next_.make(p, 1e-9 * static_cast<double>(period) * quadrant::duration::from_value(1));
            if (!good) next_.why().write(why.data(), why.size());
        } catch (const std::exception& e) {
            rtapi_snprintf(why.data(), why.size(), "%s", e.what());
        }
        refused_.set(!good);
        if (!good) {
            pending_.set(false);
            return rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", maker_.prefix.c_str(), why.data());
        }
        next_period_ = period;
        offered_.store(true, std::memory_order_release);
    }

private:
    static void call(void* self, long period) { static_cast<instance*>(self)->step(period); }

    void step(long period) noexcept {
        period_.store(period, std::memory_order_relaxed);
        if (offered_.load(std::memory_order_acquire)) take(period);
        if (!block_ || block_period_ != period) { // the outputs stay as they are
            fault_.set(true);
            return;
        }
        fault_.set(!block_->step(signals_));
        wires_.show(block_->wire());
    }
    void take(long period) noexcept {
        if (next_period_ == period) {
            if (!block_ || block_period_ != period)
                block_.emplace(*next_);
            else if (!block_->adopt(*next_))
                return; // later
            block_period_ = period;
            pending_.set(false);
        }
        offered_.store(false, std::memory_order_release);
    }
    /// NaN is a value like others here: reported once.
    static auto bits(const numbers& x) { return std::bit_cast<std::array<std::uint64_t, list.size()>>(x); }

    pin_maker maker_;
    typename Block::pins signals_;
    wires wires_;
    std::array<real_pin, list.size()> parameters_{};
    bit_pin apply_, fault_, refused_, pending_;

    std::atomic<long> period_{0}; // ns, as the thread calls
    std::atomic<bool> offered_{false};
    quadrant::made<Block> next_; // the builder's until offered, then the real-time thread's until taken
    long next_period_ = 0;
    numbers built_{}; // builder only
    long built_period_ = 0;
    std::optional<Block> block_; // real-time thread only
    long block_period_ = 0;
};

/// All instances and the thread that builds for them.
template <class Block> class component {
public:
    int start(int count) {
        id_ = hal_init(Block::component);
        if (id_ < 0) return id_;
        if (count < 1 || count > 16) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: count=%d: must lie between 1 and 16\n", Block::component,
                            count);
            return stop(-1);
        }
        try {
            for (int i = 0; i < count; ++i) {
                instances_.push_back(std::make_unique<instance<Block>>(id_, i));
                if (const int error = instances_.back()->error(); error != 0) return stop(error);
            }
            builder_ = std::thread([this] {
                const sched_param lowest{}; // whatever LinuxCNC started us with: never before its own threads
                pthread_setschedparam(pthread_self(), SCHED_OTHER, &lowest);
                for (; !stopping_; std::this_thread::sleep_for(std::chrono::milliseconds(5)))
                    for (auto& each : instances_) each->look();
            });
        } catch (const std::exception& e) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", Block::component, e.what());
            return stop(-1);
        }
        hal_ready(id_);
        return 0;
    }
    int stop(int result = 0) {
        stopping_ = true;
        if (builder_.joinable()) builder_.join();
        if (id_ > 0) hal_exit(id_);
        instances_.clear();
        return result;
    }

private:
    int id_ = -1;
    std::atomic<bool> stopping_{false};
    std::vector<std::unique_ptr<instance<Block>>> instances_;
    std::thread builder_;
};

} // namespace hal
