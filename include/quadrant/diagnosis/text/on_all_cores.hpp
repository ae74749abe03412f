// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/portable.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Threads that are waited for where they end; std::jthread is not in every C++20 library.
struct joined_threads {
    std::vector<std::thread> all{};

    joined_threads() = default;
    joined_threads(const joined_threads&) = delete;
    joined_threads& operator=(const joined_threads&) = delete;
    ~joined_threads() {
        for (std::thread& t : all) t.join();
    }
};

/// Calls work(i) for i = 0 ... count - 1 on up to `threads` threads, this one among them; 0: as many as there
/// are cores. What work(i) writes belongs to i alone, so that the result does not depend on the threads. After
/// the first exception no further work begins; it is thrown here when all threads have ended. Where there are
/// no threads (WebAssembly), all of them on this one.
template <class Work> void on_all_cores(std::size_t count, std::size_t threads, const Work& work) {
    if constexpr (!quadrant::detail::has_threads) threads = 1;
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failed;
    std::mutex guard;
    const auto take = [&] {
        for (std::size_t i = 0; (i = next++) < count;) try {
                work(i);
            } catch (...) {
                const std::lock_guard held(guard);
                if (!failed) failed = std::current_exception();
                next = count; // nothing more begins
            }
    };
    {
        joined_threads others;
        for (std::size_t i = 1; i < std::min(threads, count); ++i) others.all.emplace_back(take);
        take();
    }
    if (failed) std::rethrow_exception(failed);
}

} // namespace quadrant::inline v0::diagnosis
