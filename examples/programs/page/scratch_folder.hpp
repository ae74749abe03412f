// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <csignal>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>
#include <unistd.h>

/// Folders of a program's own that go with it, also when it is interrupted.
namespace quadrant_page {

namespace detail {

struct scratch_list {
    std::mutex guard;
    std::set<std::filesystem::path> folders;

    void remove_all() {
        constexpr int tries = 5; // a child that ends may still write
        const std::lock_guard held(guard);
        for (int i = 0; i < tries; ++i)
            for (const auto& folder : folders) {
                std::error_code ignored;
                std::filesystem::remove_all(folder, ignored);
            }
    }
};
inline scratch_list& scratch() {
    static auto* const list = new scratch_list; // outlives every thread
    return *list;
}

inline sigset_t interruptions() {
    sigset_t all;
    sigemptyset(&all);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&all, signal);
    return all;
}

} // namespace detail

/// A folder that is removed at the end of its scope, and when the program is interrupted after
/// remove_scratch_when_interrupted().
class scratch_folder {
public:
    explicit scratch_folder(std::filesystem::path path) : path_(std::move(path)) {
        const std::lock_guard held(detail::scratch().guard);
        detail::scratch().folders.insert(path_);
    }
    ~scratch_folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
        const std::lock_guard held(detail::scratch().guard);
        detail::scratch().folders.erase(path_);
    }
    scratch_folder(const scratch_folder&) = delete;
    scratch_folder& operator=(const scratch_folder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// From now on an interruption (SIGINT, SIGTERM, SIGHUP) removes the scratch folders and then ends the program
/// as ever. To be called before any thread is started; children begin with undo_interruption_mask() or an empty
/// mask.
inline void remove_scratch_when_interrupted() {
    const sigset_t waited = detail::interruptions();
    detail::scratch();
    pthread_sigmask(SIG_BLOCK, &waited, nullptr);
    std::thread([waited] {
        int received = 0;
        if (sigwait(&waited, &received) != 0) return;
        detail::scratch().remove_all();
        std::signal(received, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &waited, nullptr);
        kill(getpid(), received);
    }).detach();
}

/// In a child: it is interrupted as any program.
inline void undo_interruption_mask() {
    const sigset_t waited = detail::interruptions();
    sigprocmask(SIG_UNBLOCK, &waited, nullptr);
}

} // namespace quadrant_page
