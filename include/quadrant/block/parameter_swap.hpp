// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <atomic>
#include <type_traits>

namespace quadrant::inline v0 {

/// Hands a whole set from the thread that tunes to the thread that controls, between two samples: all of it or
/// nothing.
///   parameter_swap<boxes> tuning{first};
///   tuning.offer(boxes{parameters, period});                       // slow thread: checks, may throw, takes its time
///   if (const boxes* next = tuning.take()) axis.retune(*next);     // servo thread, before its sample
/// A set is parameters or, better, the boxes made of them: what is checked and designed in a constructor then
/// runs in the slow thread, and the servo thread only copies coefficients. The last set offered wins; one that
/// was never taken is lost.
/// Threads: one that offers, one that takes; neither ever waits for the other (three slots, one atomic exchange
/// each).
/// Two axes that have to change in the same sample: put the boxes of both into one set.
/// State: `take` gives each set once, null when there is nothing new; what it points at stays until the next
/// take.
/// Range: Set can be copied and has nothing to release. It lives where both threads see it; it cannot be copied
/// itself.
/// Cost: `take` one load, an exchange when there is a set; `offer` a copy. 3 sizes of Set. The first set is
/// that of the start.
template <class Set> class parameter_swap {
    static_assert(std::is_trivially_destructible_v<Set>, "a set holds nothing that has to be released");
    static_assert(std::atomic<unsigned>::is_always_lock_free, "no thread may wait for the other");

public:
    explicit parameter_swap(const Set& first) : slot_{first, first, first} {}

    void offer(const Set& next) noexcept { ///< the thread that tunes
        slot_[writes_] = next;
        writes_ = between_.exchange(writes_ | fresh, std::memory_order_acq_rel) & ~fresh;
    }
    const Set* take() noexcept { ///< the thread that controls
        if (!pending()) return nullptr;
        reads_ = between_.exchange(reads_, std::memory_order_acq_rel) & ~fresh;
        return &slot_[reads_];
    }
    bool pending() const noexcept { ///< offered and not yet taken; either thread
        return (between_.load(std::memory_order_relaxed) & fresh) != 0;
    }

private:
    static constexpr unsigned fresh = 4;

    std::array<Set, 3> slot_;
    unsigned writes_ = 0, reads_ = 1; // each known to its own thread only
    std::atomic<unsigned> between_{2};
};

} // namespace quadrant::inline v0
