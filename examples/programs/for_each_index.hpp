// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace quadrant_programs {

/// work(k) for every k below n on several threads; the first exception ends it and is thrown on.
template <class Work> void for_each_index(std::size_t n, std::size_t jobs, Work&& work) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failed;
    std::mutex failing;
    const auto loop = [&] {
        for (std::size_t k; (k = next++) < n;) try {
                work(k);
            } catch (...) {
                const std::lock_guard lock(failing);
                if (!failed) failed = std::current_exception();
                next = n;
            }
    };
    {
        std::vector<std::jthread> others;
        for (std::size_t j = 1; j < jobs; ++j) others.emplace_back(loop);
        loop();
    }
    if (failed) std::rethrow_exception(failed);
}

} // namespace quadrant_programs
